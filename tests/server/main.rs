//! The language server at the other end of a connection in memory.

mod client;
mod edits;
mod findings;
mod requests;
mod robust;

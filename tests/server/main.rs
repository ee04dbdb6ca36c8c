//! The language server at the other end of a connection in memory.

mod client;
mod edits;
mod findings;
#[path = "../common/numbers.rs"]
mod numbers;
mod rename;
mod requests;
mod robust;

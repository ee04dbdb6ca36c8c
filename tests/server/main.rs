//! The language server at the other end of a connection in memory.

mod client;
mod edits;
mod findings;
#[path = "../common/numbers.rs"]
mod numbers;
mod requests;
mod robust;

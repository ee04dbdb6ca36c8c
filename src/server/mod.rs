//! The language server: findings while typing, from the same queries as the command line.
//!
//! **Invariant:** only this module knows the protocol, and it knows no rule and no language: what it shows comes from the
//! database. One file a request, below `requests`.
//! **Invariant:** the main thread alone writes to databases, in the order in which the client sends its messages. Reads
//! run on snapshots in other threads; a write makes those that still run give up, and then they are asked anew or answered
//! with `ContentModified`.

mod capabilities;
mod client;
mod convert;
mod cursor;
mod describe;
mod diagnostics;
mod document;
mod edits;
mod main_loop;
mod names;
mod requests;
mod snapshot;
mod state;
mod transport;
mod workers;

pub use main_loop::{Ended, run};
pub use transport::serve;

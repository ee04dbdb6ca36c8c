//! `plclint server`: the language server on standard input and output.

use std::io;

use super::{Exit, Failure};
use crate::server::{self, Ended};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Speak on standard input and output; there is no other way, and editors say it out of habit
    #[arg(long, hide = true)]
    stdio: bool,
}

pub(super) fn run(_: &Arguments) -> Result<Exit, Failure> {
    match server::serve(io::BufReader::new(io::stdin()), io::stdout())? {
        Ended::Properly => Ok(Exit::Clean),
        Ended::Abruptly => Ok(Exit::Findings),
    }
}

//! `plclint completions SHELL`.

use clap_complete::Shell;

use super::{Exit, Failure, print};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments, command: &mut clap::Command) -> Result<Exit, Failure> {
    // The generator panics when its writer fails, so that it writes to memory first.
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, command, "plclint", &mut script);
    print(|out| out.write_all(&script))?;
    Ok(Exit::Clean)
}

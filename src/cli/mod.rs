//! The command line: one file per subcommand.

use std::io::{self, IsTerminal, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use anstream::{AutoStream, ColorChoice};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{CommandFactory, Parser, Subcommand, ValueEnum};

mod check;
mod completions;
mod config;
mod draw;
mod read;
mod rule;
mod rules;
mod server;
mod tree;

use crate::load::WrongConfig;
use crate::source::detect::Dialect;

/// Finds mistakes in PLC programs as they lie on disk: Schneider PL7 and PL7-2, Siemens STEP 7 (AWL) and STEP 5.
#[derive(Debug, Parser)]
#[command(name = "plclint", version, propagate_version = true, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 nothing to report, 1 findings, 2 wrong usage or configuration, 3 internal error."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// When to use colours
    #[arg(long, global = true, value_enum, default_value_t = Colour::Auto, value_name = "WHEN")]
    color: Colour,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Check programs and report what is wrong with them
    Check(Box<check::Arguments>),
    /// Draw Grafcet charts, sequences coded with bits, ladder networks and the graph of calls
    Draw(Box<draw::Arguments>),
    /// Show the page of a rule
    Rule(rule::Arguments),
    /// List the rules
    Rules(rules::Arguments),
    /// Show the syntax tree of a file
    Tree(tree::Arguments),
    /// Serve an editor: the language server, on standard input and output
    Server(server::Arguments),
    /// Print a completion script for a shell
    Completions(completions::Arguments),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Colour {
    /// On a terminal, unless the environment says otherwise (`NO_COLOR`)
    Auto,
    Always,
    Never,
}

impl Colour {
    /// Whether standard output takes colours.
    fn stdout(self) -> bool {
        match self {
            Self::Always => true,
            Self::Never => false,
            Self::Auto => AutoStream::choice(&io::stdout()) != ColorChoice::Never,
        }
    }
}

/// Reads the value of `--dialect`.
fn dialect() -> impl TypedValueParser<Value = Dialect> {
    PossibleValuesParser::new(Dialect::ALL.map(Dialect::as_str)).try_map(|it| it.parse::<Dialect>())
}

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    Clean = 0,
    Findings = 1,
    Usage = 2,
    Internal = 3,
}

/// What keeps a command from its work.
#[derive(Debug)]
enum Failure {
    /// Wrong usage or configuration: a sentence for the user.
    Usage(String),
    /// Output failed.
    Output(io::Error),
}

impl From<WrongConfig> for Failure {
    fn from(error: WrongConfig) -> Self {
        Self::Usage(error.to_string())
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let exit = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| {
        complain("internal error: please report it with the file that was checked");
        Exit::Internal
    });
    ExitCode::from(exit as u8)
}

fn run() -> Exit {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // A closed pipe is no reason to fail.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage } else { Exit::Clean };
        }
    };
    let colour = arguments.color;
    let result = match arguments.command {
        Command::Check(arguments) => check::run(*arguments, colour),
        Command::Draw(arguments) => draw::run(&arguments),
        Command::Rule(arguments) => rule::run(&arguments, colour),
        Command::Rules(arguments) => rules::run(&arguments),
        Command::Tree(arguments) => tree::run(&arguments),
        Command::Server(arguments) => server::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments, &mut Arguments::command()),
    };
    match result {
        Ok(exit) => exit,
        Err(Failure::Usage(message)) => {
            complain(&message);
            Exit::Usage
        }
        Err(Failure::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => Exit::Clean,
        Err(Failure::Output(error)) => {
            complain(&format!("output failed: {error}"));
            Exit::Usage
        }
    }
}

/// Tells the user what is wrong.
fn complain(message: &str) {
    // There is nobody left to tell when this fails.
    let _ = writeln!(io::stderr(), "plclint: {message}");
}

/// Writes to standard output through a buffer. A reader that goes away early is no error.
fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let stdout = io::stdout();
    let result = if stdout.is_terminal() {
        // The terminal may need its colour sequences translated.
        let mut out = io::BufWriter::new(AutoStream::always(stdout.lock()));
        write(&mut out).and_then(|()| out.flush())
    } else {
        let mut out = io::BufWriter::new(stdout.lock());
        write(&mut out).and_then(|()| out.flush())
    };
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }
}

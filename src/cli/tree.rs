//! `plclint tree`: the syntax tree of a file, for those who work on the grammars.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use rowan::TextSize;

use super::{Exit, Failure, dialect, print};
use crate::source::decode::Encoding;
use crate::source::detect::{Dialect, FileHint, load};
use crate::source::split::{SplitHint, split};
use crate::syntax::{self, Parse, WalkEvent};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The file
    path: PathBuf,
    /// What the file is, whatever it looks like
    #[arg(long, value_name = "DIALECT", default_value = "auto", value_parser = dialect())]
    dialect: Dialect,
    /// Encoding of the file, whatever it looks like
    #[arg(long, value_name = "NAME", value_parser = Encoding::parse_option)]
    encoding: Option<Option<Encoding>>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let path = &arguments.path;
    let bytes =
        fs::read(path).map_err(|it| Failure::Usage(format!("{}: the file cannot be read: {it}", path.display())))?;
    let hint = FileHint { path: Some(path), explicit: true, dialect: arguments.dialect, family: None };
    let (source, detected) = load(hint, &bytes, arguments.encoding.flatten());
    print(|out| {
        for unit in split(&source.text, detected, &SplitHint::default()) {
            match unit.unsupported {
                Some(form) => writeln!(out, "{} @{:?}: {form}", unit.entity, unit.range)?,
                None => {
                    writeln!(out, "{} @{:?}: {:?}", unit.entity, unit.range, unit.language)?;
                    let text = source.text.get(std::ops::Range::<usize>::from(unit.range)).unwrap_or_default();
                    write(&syntax::parse(unit.language, text), unit.range.start(), out)?;
                }
            }
        }
        Ok(())
    })?;
    Ok(Exit::Clean)
}

/// Writes a tree with the ranges of the file, then what is wrong with the text.
fn write(parse: &Parse, start: TextSize, out: &mut dyn Write) -> io::Result<()> {
    let mut depth = 1;
    for event in parse.syntax().walk() {
        match event {
            WalkEvent::Leave(_) => depth -= 1,
            WalkEvent::Enter(node) => {
                writeln!(out, "{:indent$}{:?}@{:?}", "", node.kind(), node.text_range() + start, indent = 2 * depth)?;
                depth += 1;
            }
            WalkEvent::Token(token) => {
                let (kind, range, text) = (token.kind(), token.text_range() + start, token.text());
                writeln!(out, "{:indent$}{kind:?}@{range:?} {text:?}", "", indent = 2 * depth)?;
            }
        }
    }
    for error in parse.errors() {
        writeln!(out, "  error @{:?}: {}", error.range + start, error.message)?;
    }
    Ok(())
}

//! An [`Outcome`](crate::lint::Outcome) as text, one file per format. Nothing else prints findings.
//!
//! **Invariant:** a report is a function of the outcome and of its options: no clock, no environment, no file is read.
//! Rendering never fails but for the writer.

use std::io;
use std::path::PathBuf;

use crate::lint::Outcome;

mod cite;
mod concise;
mod fingerprint;
mod human;
mod json;
pub mod position;
mod sarif;
mod summary;
#[cfg(test)]
pub(crate) mod testing;

pub use cite::citation;
pub use summary::{Summary, write_statistics};

/// The formats, by the names that the command line takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Format {
    /// With excerpts of the source, for reading
    Human,
    /// A line for each finding
    Concise,
    /// A document for other programs
    Json,
    /// SARIF 2.1.0, for code scanning
    Sarif,
}

impl Format {
    /// Whether people read it, so that the run's last line belongs at its end.
    pub fn is_text(self) -> bool {
        matches!(self, Self::Human | Self::Concise)
    }
}

/// What a report depends on besides the outcome.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Whether to write the terminal's colour sequences; only text formats have any.
    pub colour: bool,
    /// Folder that relative paths start from, absolute: SARIF says it.
    pub root: Option<PathBuf>,
}

/// Writes the findings of a run in one format.
pub fn write(format: Format, outcome: &Outcome, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    match format {
        Format::Human => human::write(outcome, options, out),
        Format::Concise => concise::write(outcome, options, out),
        Format::Json => json::write(outcome, out),
        Format::Sarif => sarif::write(outcome, options, out),
    }
}

/// Text of a program or a path for a terminal: control characters, which could move its cursor, become their
/// pictures (`␛`). The number of characters stays.
fn visible(text: &str) -> std::borrow::Cow<'_, str> {
    // Nearly all texts are plain ASCII, so that it pays to look at all of one at once.
    let is_plain = text.bytes().fold(true, |plain, it| plain & matches!(it, b'\t' | b' '..=b'~'));
    if !is_plain && text.chars().any(is_hazard) { text.chars().map(visible_char).collect() } else { text.into() }
}

fn is_hazard(character: char) -> bool {
    visible_char(character) != character
}

fn visible_char(character: char) -> char {
    match character {
        '\t' => character,
        '\0'..='\u{1f}' => char::from_u32(0x2400 + u32::from(character)).unwrap_or('\u{fffd}'),
        '\u{7f}' => '\u{2421}',
        // Second set of controls, line separators, and the marks that turn the direction of text.
        '\u{80}'..='\u{9f}' | '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        _ => character,
    }
}

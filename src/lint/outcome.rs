//! What a run found: the one value that every report is rendered from.

use std::sync::Arc;
use std::time::Duration;

use super::finding::{Finding, Location};
use super::rule::Rule;
use crate::model::entity::Family;

/// A file as it was read, for showing excerpts and for counting columns.
#[derive(Debug, Clone)]
pub struct SourceView {
    /// Path as the user gave it, with forward slashes.
    pub path: String,
    /// Decoded text.
    pub text: Arc<str>,
    /// IANA name of the encoding that it was read with: `utf-8`, `windows-1252`.
    pub encoding: &'static str,
    /// What the file was recognised as: `STEP 7 AWL (German mnemonics)`, `PL7 exchange`.
    pub dialect: String,
    /// Programs and blocks found in it.
    pub entities: usize,
    /// Bytes in units of a language that is not read yet, or that the syntax could not place.
    pub not_understood: usize,
    /// For a text that is not the file's own but made of its tables: lines and columns of it mean nothing to others.
    pub made_of: Option<MadeOf>,
    /// Other files of its folder define parts that it defines too, so that it was checked by itself.
    pub is_variant: bool,
    /// The configuration, which is among the files when a finding names a place in it. It is no part of any program.
    pub is_configuration: bool,
}

/// What the text of a binary file was made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MadeOf {
    /// Whether the project has a cross-reference: without one, nothing is known of its code.
    pub cross_reference: bool,
}

/// A finding with everything that a report shows of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    pub finding: Finding<Location>,
    /// The unit that holds the primary place, in the vendor's own addressing: `MAST - SR10`, `FC1`.
    pub entity: String,
    /// Whose code holds it.
    pub family: Option<Family>,
    /// Present when a comment or a baseline suppresses it; holds the reason given, which may be empty.
    pub suppressed: Option<String>,
}

/// A file that a run could not lint, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unread {
    pub path: String,
    pub reason: UnreadReason,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UnreadReason {
    /// The operating system's message.
    Io(String),
    /// A PLC file of a kind that is not read, by name: `PL7 ladder (.LD)`.
    Unsupported(String),
    /// Not a PLC program: left out and counted.
    NotPlc,
}

/// The outcome of `check`. Findings are sorted by path, position, code: the same for any number of threads.
#[derive(Debug, Default)]
pub struct Outcome {
    /// In path order; `Location::file` is an index into it.
    pub files: Vec<SourceView>,
    pub diagnostics: Vec<Diagnostic>,
    /// In path order.
    pub unread: Vec<Unread>,
    /// Every rule that was switched on.
    pub active: Vec<&'static Rule>,
    /// Families of the programs that were read without a controller, when some rule would find more with one; sorted.
    pub untargeted: Vec<Family>,
    /// Rules that panicked, with the file: the run went on without them.
    pub internal_errors: Vec<String>,
    pub elapsed: Duration,
}

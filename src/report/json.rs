//! A document for other programs; its schema is described in `docs/output.md`.
//!
//! The schema is stable within a major version of the program: keys may be added, none changes its meaning.

use std::io;

use rowan::{TextRange, TextSize};
use serde::Serialize;

use super::position::{LineCol, Positions, clamp};
use super::summary::Summary;
use crate::lint::{Applicability, Diagnostic, Location, Outcome, Related, UnreadReason};

/// Number of the schema; it changes when a key changes its meaning.
const VERSION: u32 = 1;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Document<'a> {
    version: u32,
    tool: Tool,
    findings: Vec<FindingView<'a>>,
    files: Vec<FileView<'a>>,
    unread: Vec<UnreadView<'a>>,
    internal_errors: &'a [String],
    summary: SummaryView,
}

#[derive(Serialize)]
struct Tool {
    name: &'static str,
    version: &'static str,
}

#[derive(Serialize)]
struct Position {
    line: u32,
    column: u32,
    /// In bytes of the decoded text.
    offset: u32,
}

#[derive(Serialize)]
struct Place<'a> {
    path: &'a str,
    /// None in a file that is no text.
    start: Option<Position>,
    end: Option<Position>,
    /// In such a file, what stands there.
    #[serde(skip_serializing_if = "Option::is_none")]
    entry: Option<String>,
}

#[derive(Serialize)]
struct FindingView<'a> {
    code: &'static str,
    name: &'static str,
    severity: &'static str,
    message: &'a str,
    entity: &'a str,
    #[serde(flatten)]
    place: Place<'a>,
    label: Option<&'a str>,
    related: Vec<RelatedView<'a>>,
    notes: &'a [String],
    help: &'static str,
    sources: &'static [&'static str],
    fixes: Vec<FixView<'a>>,
    suppressed: Option<Suppressed<'a>>,
}

#[derive(Serialize)]
struct RelatedView<'a> {
    message: &'a str,
    #[serde(flatten)]
    place: Place<'a>,
}

#[derive(Serialize)]
struct FixView<'a> {
    title: &'a str,
    safe: bool,
    edits: Vec<EditView<'a>>,
}

#[derive(Serialize)]
struct EditView<'a> {
    #[serde(flatten)]
    place: Place<'a>,
    text: &'a str,
}

#[derive(Serialize)]
struct Suppressed<'a> {
    reason: &'a str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct FileView<'a> {
    path: &'a str,
    dialect: &'a str,
    encoding: &'static str,
    entities: usize,
    bytes: usize,
    bytes_not_understood: usize,
    /// Another file of the folder defines parts that it defines too.
    variant: bool,
}

#[derive(Serialize)]
struct UnreadView<'a> {
    path: &'a str,
    reason: &'static str,
    detail: Option<&'a str>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct SummaryView {
    files: usize,
    entities: usize,
    lines: usize,
    bytes: usize,
    bytes_not_understood: usize,
    errors: usize,
    warnings: usize,
    notes: usize,
    suppressed: usize,
    unreadable: usize,
    unsupported: usize,
    not_plc: usize,
}

pub(super) fn write(outcome: &Outcome, out: &mut dyn io::Write) -> io::Result<()> {
    let positions = Positions::new(outcome);
    let summary = Summary::of(outcome);
    let document = Document {
        version: VERSION,
        tool: Tool { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") },
        findings: outcome.diagnostics.iter().filter_map(|it| finding(&positions, it)).collect(),
        files: outcome
            .files
            .iter()
            .map(|it| FileView {
                path: &it.path,
                dialect: &it.dialect,
                encoding: it.encoding,
                entities: it.entities,
                bytes: it.text.len(),
                bytes_not_understood: it.not_understood,
                variant: it.is_variant,
            })
            .collect(),
        unread: outcome
            .unread
            .iter()
            .map(|it| {
                let (reason, detail) = match &it.reason {
                    UnreadReason::Io(error) => ("io", Some(error.as_str())),
                    UnreadReason::Unsupported(kind) => ("unsupported", Some(kind.as_str())),
                    UnreadReason::NotPlc => ("not-plc", None),
                };
                UnreadView { path: &it.path, reason, detail }
            })
            .collect(),
        internal_errors: &outcome.internal_errors,
        summary: SummaryView {
            files: summary.files,
            entities: summary.entities,
            lines: summary.lines,
            bytes: summary.bytes,
            bytes_not_understood: summary.not_understood,
            errors: summary.errors,
            warnings: summary.warnings,
            notes: summary.notes,
            suppressed: summary.suppressed,
            unreadable: summary.unreadable,
            unsupported: summary.unsupported.iter().map(|it| it.1).sum(),
            not_plc: summary.not_plc,
        },
    };
    serde_json::to_writer_pretty(&mut *out, &document).map_err(io::Error::from)?;
    writeln!(out)
}

fn place<'a>(positions: &Positions<'a>, location: &Location) -> Option<Place<'a>> {
    let file = positions.file(location.file)?;
    let range: TextRange = clamp(&file.text, location.range);
    let span = positions.span(location.file, range)?;
    if let Some(entry) = positions.entry(location.file, range) {
        return Some(Place { path: &file.path, start: None, end: None, entry: Some(entry.to_string()) });
    }
    let at = |it: LineCol, offset: TextSize| Some(Position { line: it.line, column: it.column, offset: offset.into() });
    let (start, end) = (at(span.start, range.start()), at(span.end, range.end()));
    Some(Place { path: &file.path, start, end, entry: None })
}

fn finding<'a>(positions: &Positions<'a>, diagnostic: &'a Diagnostic) -> Option<FindingView<'a>> {
    let finding = &diagnostic.finding;
    let related = |it: &'a Related<Location>| {
        place(positions, &it.place).map(|place| RelatedView { message: &it.message, place })
    };
    let mut fixes = Vec::new();
    for fix in &finding.fixes {
        let edit = |it: &'a crate::lint::Edit<Location>| {
            place(positions, &it.place).map(|place| EditView { place, text: &it.replacement })
        };
        // A fix that lacks an edit is another fix.
        if let Some(edits) = fix.edits.iter().map(edit).collect() {
            fixes.push(FixView { title: &fix.title, safe: fix.applicability == Applicability::Safe, edits });
        }
    }
    Some(FindingView {
        code: finding.rule.code,
        name: finding.rule.name,
        severity: finding.severity.as_str(),
        message: &finding.message,
        entity: &diagnostic.entity,
        place: place(positions, &finding.place)?,
        label: finding.label.as_deref(),
        related: finding.related.iter().filter_map(related).collect(),
        notes: &finding.notes,
        help: finding.rule.help_for(diagnostic.family),
        sources: finding.rule.sources,
        fixes,
        suppressed: diagnostic.suppressed.as_deref().map(|reason| Suppressed { reason }),
    })
}

#[cfg(test)]
mod tests {
    use crate::report::testing::sample;
    use crate::report::{Format, Options, write};

    #[test]
    fn the_document_says_everything() {
        let mut out = Vec::new();
        write(Format::Json, &sample(), &Options::default(), &mut out).unwrap();
        insta::assert_snapshot!(String::from_utf8(out).unwrap());
    }
}

//! Findings with excerpts of the source, for a terminal.
//!
//! Excerpts are drawn by `ariadne`, which breaks lines at more characters than we count, counts offsets in bytes or in
//! characters but not reliably in bytes across files, and prints what it is given. So it is given a picture of each
//! file: our lines, with controls made visible and very long lines cut, and offsets in characters of that picture.

use std::fmt;
use std::io;

use anstyle::{AnsiColor, Style};
use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use rustc_hash::FxHashMap;

use super::position::{LineCol, LineIndex, Positions};
use super::{Options, citation, visible, visible_char};
use crate::lint::{Applicability, Diagnostic, Location, Outcome, Severity, UnreadReason};

/// Characters of a line that an excerpt shows.
const LINE_LIMIT: usize = 240;
/// Places of one finding that are shown; the rest is counted.
const PLACE_LIMIT: usize = 12;
/// A place of more lines is shown by its first one.
const SPAN_LIMIT: u32 = 40;
/// Places of one file further apart than this many lines are shown as excerpts of their own.
const GAP: u32 = 12;
/// Pictures kept at a time.
const PICTURES: usize = 16;
/// Columns of a help text.
const WIDTH: usize = 96;

pub(super) fn write(outcome: &Outcome, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let positions = Positions::new(outcome);
    let mut pictures = Pictures { positions: &positions, made: FxHashMap::default() };
    for diagnostic in outcome.diagnostics.iter().filter(|it| it.suppressed.is_none()) {
        render(diagnostic, &mut pictures, options, out)?;
    }
    let style = if options.colour { style(Severity::Warning) } else { Style::new() };
    for unread in &outcome.unread {
        let path = visible(&unread.path);
        match &unread.reason {
            UnreadReason::Io(error) => writeln!(out, "{style}not read{style:#}: {path}: {}", visible(error))?,
            UnreadReason::Unsupported(kind) => {
                writeln!(out, "{style}not read{style:#}: {path}: {} is not supported", visible(kind))?;
            }
            UnreadReason::NotPlc => {}
        }
    }
    for error in &outcome.internal_errors {
        writeln!(out, "{style}internal error{style:#}: {}", visible(error))?;
    }
    Ok(())
}

/// How a severity looks on a terminal.
pub(super) fn style(severity: Severity) -> Style {
    let colour = match severity {
        Severity::Error => AnsiColor::Red,
        Severity::Warning => AnsiColor::Yellow,
        Severity::Advice => AnsiColor::Cyan,
    };
    Style::new().bold().fg_color(Some(colour.into()))
}

/// A file as excerpts show it.
struct Picture {
    source: Source<String>,
    /// Offset in characters, and number of characters that are shown, of each line.
    lines: Vec<(usize, usize)>,
}

impl Picture {
    fn new(text: &str, index: &LineIndex) -> Self {
        let mut shown = String::with_capacity(text.len());
        let mut bounds = Vec::new();
        let mut offset = 0;
        for number in 1..=index.line_count() {
            let mut characters = index.line_text(text, number).unwrap_or_default().chars();
            let before = shown.len();
            shown.extend(characters.by_ref().take(LINE_LIMIT).map(visible_char));
            let mut length = shown[before..].chars().count();
            bounds.push((offset, length));
            if characters.next().is_some() {
                shown.push('…');
                length += 1;
            }
            shown.push('\n');
            offset += length + 1;
        }
        // Without this, the last line would be followed by one that the file does not have.
        shown.pop();
        Self { source: Source::from(shown), lines: bounds }
    }

    /// Offset in the picture; a place on the part of a line that is cut off becomes the ellipsis.
    fn offset(&self, place: LineCol) -> usize {
        let (start, shown) = self.lines.get(place.line as usize - 1).copied().unwrap_or_default();
        start + (place.column as usize - 1).min(shown)
    }
}

struct Pictures<'a> {
    positions: &'a Positions<'a>,
    made: FxHashMap<u32, Picture>,
}

impl Pictures<'_> {
    fn make(&mut self, file: u32) -> Option<&Picture> {
        if !self.made.contains_key(&file) {
            let text = &self.positions.file(file)?.text;
            let picture = Picture::new(text, self.positions.index(file)?);
            self.made.insert(file, picture);
        }
        self.made.get(&file)
    }
}

/// An excerpt: a file, and which of its excerpts in a report.
type Id = (u32, u32);

impl ariadne::Cache<Id> for &mut Pictures<'_> {
    type Storage = String;

    fn fetch(&mut self, id: &Id) -> Result<&Source<String>, impl fmt::Debug> {
        self.made.get(&id.0).map(|it| &it.source).ok_or("no such file")
    }

    fn display<'a>(&self, id: &'a Id) -> Option<impl fmt::Display + 'a> {
        self.positions.file(id.0).map(|it| visible(&it.path).into_owned())
    }
}

/// A place of a finding, on its picture.
struct Mark {
    file: u32,
    line: u32,
    range: std::ops::Range<usize>,
    message: String,
    primary: bool,
}

impl Pictures<'_> {
    fn mark(&mut self, place: &Location, message: &str, primary: bool) -> Option<Mark> {
        let span = self.positions.span(place.file, place.range)?;
        let picture = self.make(place.file)?;
        let start = picture.offset(span.start);
        let mut end = picture.offset(span.end);
        if span.end.line - span.start.line > SPAN_LIMIT {
            let line = picture.lines.get(span.start.line as usize - 1).copied().unwrap_or_default();
            end = line.0 + line.1;
        }
        let cut = (span.start.column as usize).saturating_sub(1) > LINE_LIMIT;
        let mut message = visible(message).into_owned();
        if cut && !primary {
            message = format!("{message} (column {})", span.start.column);
        }
        Some(Mark { file: place.file, line: span.start.line, range: start..end.max(start), message, primary })
    }
}

fn render(
    diagnostic: &Diagnostic,
    pictures: &mut Pictures<'_>,
    options: &Options,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let finding = &diagnostic.finding;
    if pictures.positions.entry(finding.place.file, finding.place.range).is_some() {
        return render_entry(diagnostic, pictures.positions, options, out);
    }
    if pictures.made.len() > PICTURES {
        pictures.made.clear();
    }
    let label = finding.label.as_deref().unwrap_or("here");
    let Some(primary) = pictures.mark(&finding.place, label, true) else { return Ok(()) };
    let Some(span) = pictures.positions.span(finding.place.file, finding.place.range) else { return Ok(()) };

    let mut marks = Vec::new();
    for related in finding.related.iter().take(PLACE_LIMIT) {
        marks.extend(pictures.mark(&related.place, &related.message, false));
    }
    let at = (primary.file, primary.line);
    let primary_range = primary.range.clone();
    marks.push(primary);
    marks.sort_by_key(|it| (it.file, it.line, it.range.start, !it.primary));
    let (colour, related_colour) = match finding.severity {
        Severity::Error => (Color::Red, Color::Blue),
        Severity::Warning => (Color::Yellow, Color::Blue),
        Severity::Advice => (Color::Cyan, Color::Blue),
    };
    // Excerpts: runs of marks of one file that are near one another, the one with the primary place first.
    let mut excerpts: Vec<Vec<Mark>> = Vec::new();
    for mark in marks {
        match excerpts.last_mut().and_then(|it| it.last().map(|last| (last.file, last.line)).map(|at| (at, it))) {
            Some(((file, line), excerpt)) if file == mark.file && mark.line - line <= GAP => excerpt.push(mark),
            _ => excerpts.push(vec![mark]),
        }
    }
    excerpts.sort_by_key(|it| !it.iter().any(|it| it.primary));

    let config = Config::default().with_index_type(IndexType::Char).with_color(options.colour).with_cross_gap(false);
    let mut report = Report::build(ReportKind::Error, ((at.0, 0), primary_range)).with_config(config);
    for (number, excerpt) in (0..).zip(excerpts) {
        for mark in excerpt {
            let colour = if mark.primary { colour } else { related_colour };
            let priority = i32::from(mark.primary);
            report.add_label(
                Label::new(((mark.file, number), mark.range))
                    .with_message(mark.message)
                    .with_color(colour)
                    .with_priority(priority),
            );
        }
    }
    let help = first_paragraph(finding.rule.help_for(diagnostic.family));
    if !help.is_empty() {
        report.add_help(help);
    }
    report.add_note(notes(diagnostic));

    let style = if options.colour { style(finding.severity) } else { Style::new() };
    let (severity, rule) = (finding.severity.as_str(), finding.rule);
    writeln!(out, "{style}{severity}[{} {}]{style:#}: {}", rule.code, rule.name, visible(&finding.message))?;
    let mut text = Vec::new();
    report.finish().write(&mut *pictures, &mut text)?;
    let text = String::from_utf8_lossy(&text);
    // The first line is the title, which takes no colour of ours.
    for (number, line) in text.lines().skip(1).enumerate() {
        if number == 0 && span.start.column as usize > LINE_LIMIT + 1 {
            // The header names the ellipsis; the place is further on.
            let shown = format!(":{}:{} ", span.start.line, LINE_LIMIT + 1);
            let place = format!(":{}:{} ", span.start.line, span.start.column);
            writeln!(out, "{}", line.replacen(&shown, &place, 1).trim_end())?;
        } else {
            writeln!(out, "{}", line.trim_end())?;
        }
    }
    writeln!(out)
}

/// A finding in a text that was made of tables: entries instead of excerpts.
fn render_entry(
    diagnostic: &Diagnostic,
    positions: &Positions<'_>,
    options: &Options,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let finding = &diagnostic.finding;
    let shown = |place: &Location| {
        positions.entry(place.file, place.range).map_or_else(String::new, |it| visible(&it.to_string()).into_owned())
    };
    let style = if options.colour { style(finding.severity) } else { Style::new() };
    let (severity, rule) = (finding.severity.as_str(), finding.rule);
    writeln!(out, "{style}{severity}[{} {}]{style:#}: {}", rule.code, rule.name, visible(&finding.message))?;
    let path = positions.file(finding.place.file).map_or("", |it| &it.path);
    writeln!(out, "   ╭─[ {} ]", visible(path))?;
    let label = finding.label.as_deref().map_or_else(String::new, |it| format!("  ({})", visible(it)));
    writeln!(out, "   │ {}{label}", shown(&finding.place))?;
    for related in finding.related.iter().take(PLACE_LIMIT) {
        writeln!(out, "   │ {}  ({})", shown(&related.place), visible(&related.message))?;
    }
    writeln!(out, "   │")?;
    let help = first_paragraph(finding.rule.help_for(diagnostic.family));
    for (title, text) in [("Help", help), ("Note", notes(diagnostic))] {
        for (number, line) in text.lines().enumerate() {
            let title = if number == 0 { format!("{title}: ") } else { " ".repeat(title.len() + 2) };
            writeln!(out, "   │ {title}{line}")?;
        }
    }
    writeln!(out, "───╯")?;
    writeln!(out)
}

/// What stands below the excerpts, a line each.
fn notes(diagnostic: &Diagnostic) -> String {
    let finding = &diagnostic.finding;
    let mut lines = vec![format!("in {}", visible(&diagnostic.entity))];
    if let Some(more) = finding.related.len().checked_sub(PLACE_LIMIT).filter(|&it| it > 0) {
        lines.push(format!("and {more} more places"));
    }
    lines.extend(finding.notes.iter().map(|it| wrap(&visible(it))));
    lines.extend(finding.rule.sources.iter().map(|it| format!("source: {}", citation(it))));
    for fix in &finding.fixes {
        let caution = match fix.applicability {
            Applicability::Safe => "",
            Applicability::Unsafe => " (may change what the program does)",
        };
        lines.push(format!("fix: {}{caution}", visible(&fix.title)));
    }
    lines.join("\n")
}

/// The first paragraph of a Markdown text, wrapped.
fn first_paragraph(text: &str) -> String {
    let lines: Vec<&str> = text.trim().lines().take_while(|it| !it.trim().is_empty()).collect();
    wrap(&lines.join(" "))
}

fn wrap(text: &str) -> String {
    let mut out = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > WIDTH {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += width;
    }
    out
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rowan::TextRange;

    use crate::lint::{Finding, Location, Outcome, Related};
    use crate::report::testing::{diagnostic, place, rule, sample, view};
    use crate::report::{Format, Options, write};

    fn render(outcome: &Outcome, colour: bool) -> String {
        let mut out = Vec::new();
        write(Format::Human, outcome, &Options { colour, root: None }, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    fn one(text: &str, word: &str) -> Outcome {
        let files = vec![view("a.awl", text, "utf-8")];
        let finding = Finding::new(rule("W001"), place(&files, 0, word, 0), "a message");
        Outcome { files, diagnostics: vec![diagnostic(finding)], ..Outcome::default() }
    }

    #[test]
    fn findings_are_drawn() {
        insta::assert_snapshot!(render(&sample(), false));
    }

    #[test]
    fn colour_only_when_asked() {
        assert!(!render(&sample(), false).contains('\u{1b}'));
        assert!(render(&sample(), true).contains("\u{1b}["));
    }

    #[test]
    fn lines_are_ours() {
        // A form feed, a next-line and a line separator end no line of ours.
        let text = "A\u{c}B\u{85}C\u{2028}D\nX 1\n";
        let report = render(&one(text, "X"), false);
        assert!(report.contains("a.awl:2:1 "), "{report}");
        assert!(report.contains("2 │ X 1"), "{report}");
    }

    #[test]
    fn the_terminal_is_not_written_to_by_the_program_text() {
        let report = render(&one("\u{1b}]0;title\u{7} X \u{202e}abc\n", "X"), false);
        assert!(!report.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{report}");
        assert!(report.contains("␛]0;title␇"), "{report}");
    }

    #[test]
    fn a_very_long_line_is_cut() {
        let text = format!("{}X{}\n", "a ".repeat(50_000), " b".repeat(50_000));
        let report = render(&one(&text, "X"), false);
        assert!(report.contains("a.awl:1:100001 "), "{report}");
        assert!(report.len() < 4000, "{} bytes", report.len());
    }

    #[test]
    fn distant_places_have_their_own_excerpt() {
        let text = format!("X0\n{}X1\n", "\n".repeat(5000));
        let mut outcome = one(&text, "X1");
        let related = Related { place: place(&outcome.files, 0, "X0", 0), message: "first".into() };
        outcome.diagnostics[0].finding.related.push(related);
        let report = render(&outcome, false);
        assert!(report.contains("a.awl:5002:1 ") && report.contains("a.awl:1:1 "), "{report}");
        assert!(report.lines().count() < 40, "{report}");
    }

    #[test]
    fn many_places_are_counted() {
        let mut outcome = one("X0\n", "X0");
        let related = Related { place: place(&outcome.files, 0, "0", 0), message: "again".into() };
        outcome.diagnostics[0].finding.related = vec![related; 1000];
        assert!(render(&outcome, false).contains("and 988 more places"));
    }

    proptest! {
        #[test]
        fn any_place_of_any_text_is_drawn(
            text in "[a-zß\u{1F600}\t\n\r\u{c}\u{2028}\u{1b} ]{0,60}",
            places in prop::collection::vec((0u32..80, 0u32..80), 1..6),
        ) {
            let files = vec![view("a.awl", &text, "utf-8"), view("b.awl", &text, "utf-8")];
            let mut places = places.iter().zip(0u32..).map(|(&(l, r), at)| Location {
                file: at % 3,
                range: TextRange::new(l.min(r).into(), l.max(r).into()),
            });
            let mut finding = Finding::new(rule("W001"), places.next().unwrap(), "message");
            finding.related = places.map(|place| Related { place, message: "too".into() }).collect();
            let outcome = Outcome { files, diagnostics: vec![diagnostic(finding)], ..Outcome::default() };
            for format in [Format::Human, Format::Concise, Format::Json, Format::Sarif] {
                let mut out = Vec::new();
                write(format, &outcome, &Options::default(), &mut out).unwrap();
            }
        }
    }
}

//! Lines and columns as every report shows them.

use std::cell::OnceCell;

use rowan::{TextRange, TextSize};

use crate::lint::{Outcome, SourceView};
pub use crate::source::line_index::{LineCol, LineIndex};

fn number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Lines of a text as a person counts them: an end of line at the end of the text begins no further one.
pub fn count_lines(text: &str) -> usize {
    let count = |byte: u8| memchr::memchr_iter(byte, text.as_bytes()).count();
    let breaks = match count(b'\r') {
        0 => count(b'\n'),
        returns => count(b'\n') + returns - memchr::memmem::find_iter(text.as_bytes(), "\r\n").count(),
    };
    breaks + usize::from(!text.is_empty() && !text.ends_with(['\n', '\r']))
}

/// Line indexes of the files of a run, made when first asked for.
pub struct Positions<'a> {
    outcome: &'a Outcome,
    indexes: Vec<OnceCell<LineIndex>>,
    headings: Vec<OnceCell<Headings>>,
}

/// A line of a project's tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry<'a> {
    /// `%M10 W`, `Pump AT %Q2.0`.
    pub text: &'a str,
    /// `MAST - module 0`; `[DATA_UNIT]` for declarations.
    pub module: &'a str,
    /// Number of the place in the module, as the project counts them.
    pub place: Option<&'a str>,
}

impl std::fmt::Display for Entry<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if !self.module.starts_with('[') && self.module != self.text {
            f.write_str(self.module)?;
            if let Some(place) = self.place {
                write!(f, ", place {place}")?;
            }
            f.write_str(": ")?;
        }
        f.write_str(self.text)
    }
}

/// A range to show; the end is exclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Span {
    pub start: LineCol,
    pub end: LineCol,
}

impl<'a> Positions<'a> {
    pub fn new(outcome: &'a Outcome) -> Self {
        Self {
            outcome,
            indexes: outcome.files.iter().map(|_| OnceCell::new()).collect(),
            headings: outcome.files.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    pub fn file(&self, file: u32) -> Option<&'a SourceView> {
        self.outcome.files.get(file as usize)
    }

    pub fn index(&self, file: u32) -> Option<&LineIndex> {
        let text = &self.file(file)?.text;
        Some(self.indexes.get(file as usize)?.get_or_init(|| LineIndex::new(text)))
    }

    /// Of a place in a text that was made of tables, in which lines and columns mean nothing: what stands there, and
    /// where in the project. `None` for the text of a file.
    pub fn entry(&self, file: u32, range: TextRange) -> Option<Entry<'a>> {
        let view = self.file(file).filter(|it| it.made_of.is_some())?;
        let headings = self.headings.get(file as usize)?.get_or_init(|| Headings::new(&view.text));
        Some(headings.entry(&view.text, range))
    }

    /// The path and the span of a place; `None` when the run has no such file.
    pub fn span(&self, file: u32, range: TextRange) -> Option<Span> {
        let range = clamp(&self.file(file)?.text, range);
        let index = self.index(file)?;
        Some(Span { start: index.line_col(range.start()), end: index.line_col(range.end()) })
    }
}

/// Of a text made of tables: offsets of the lines that name a module, and of those that number a place in it.
#[derive(Debug)]
pub struct Headings {
    modules: Vec<u32>,
    places: Vec<u32>,
}

impl Headings {
    pub fn new(text: &str) -> Self {
        Self { modules: lines_with(text, "["), places: lines_with(text, "@") }
    }

    /// What stands at a place of the text, and where in the project.
    pub fn entry<'a>(&self, text: &'a str, range: TextRange) -> Entry<'a> {
        let start = clamp(text, range).start();
        let own = line_at(text, start.into()).trim_end_matches(';');
        let above =
            |lines: &[u32]| lines.get(lines.partition_point(|&it| it <= u32::from(start)).checked_sub(1)?).copied();
        let module = above(&self.modules);
        let place = above(&self.places).filter(|it| module.is_none_or(|module| module < *it));
        let line = |at: u32| line_at(text, at as usize);
        let place = place.and_then(|it| line(it).strip_prefix('@'));
        let module = module.map_or("", |it| line(it).strip_prefix("[XREF] ").unwrap_or(line(it)));
        let is_heading = own.starts_with(['[', '@']);
        Entry { text: if is_heading { module } else { own }, module, place }
    }
}

/// Offsets of the lines of a text that begin with a mark.
fn lines_with(text: &str, mark: &str) -> Vec<u32> {
    let starts = std::iter::once(0).chain(memchr::memchr_iter(b'\n', text.as_bytes()).map(|it| it + 1));
    starts.filter(|&it| text.get(it..).is_some_and(|it| it.starts_with(mark))).map(number).collect()
}

/// The line that begins at or goes through an offset, without its end.
fn line_at(text: &str, offset: usize) -> &str {
    let start = text.get(..offset).and_then(|it| it.rfind('\n')).map_or(0, |it| it + 1);
    text.get(start..).and_then(|it| it.lines().next()).unwrap_or_default().trim()
}

/// A range widened to whole characters and held inside the text.
pub fn clamp(text: &str, range: TextRange) -> TextRange {
    let mut start = usize::from(range.start()).min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = usize::from(range.end()).min(text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    TextRange::new(TextSize::new(number(start)), TextSize::new(number(end.max(start))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_person_counts_fewer_lines() {
        let counts = ["", "a", "a\n", "a\nb", "\r\n\r\n", "a\rb\r"].map(count_lines);
        assert_eq!(counts, [0, 1, 1, 2, 2, 2]);
    }

    #[test]
    fn ranges_are_held_to_characters() {
        let range = |start: u32, end: u32| TextRange::new(start.into(), end.into());
        assert_eq!(clamp("aßb", range(2, 2)), range(1, 3));
        assert_eq!(clamp("aßb", range(0, 99)), range(0, 4));
        assert_eq!(clamp("", range(5, 9)), range(0, 0));
    }
}

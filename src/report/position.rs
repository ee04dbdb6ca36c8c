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
    let bytes = text.as_bytes();
    let breaks = memchr::memchr2_iter(b'\n', b'\r', bytes)
        .filter(|&at| bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n'))
        .count();
    breaks + usize::from(!bytes.is_empty() && !text.ends_with(['\n', '\r']))
}

/// Line indexes of the files of a run, made when first asked for.
pub struct Positions<'a> {
    outcome: &'a Outcome,
    indexes: Vec<OnceCell<LineIndex>>,
}

/// A range to show; the end is exclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Span {
    pub start: LineCol,
    pub end: LineCol,
}

impl<'a> Positions<'a> {
    pub fn new(outcome: &'a Outcome) -> Self {
        Self { outcome, indexes: outcome.files.iter().map(|_| OnceCell::new()).collect() }
    }

    pub fn file(&self, file: u32) -> Option<&'a SourceView> {
        self.outcome.files.get(file as usize)
    }

    pub fn index(&self, file: u32) -> Option<&LineIndex> {
        let text = &self.file(file)?.text;
        Some(self.indexes.get(file as usize)?.get_or_init(|| LineIndex::new(text)))
    }

    /// The path and the span of a place; `None` when the run has no such file.
    pub fn span(&self, file: u32, range: TextRange) -> Option<Span> {
        let range = clamp(&self.file(file)?.text, range);
        let index = self.index(file)?;
        Some(Span { start: index.line_col(range.start()), end: index.line_col(range.end()) })
    }
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

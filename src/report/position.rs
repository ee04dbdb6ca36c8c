//! Lines and columns as every report shows them.

use std::cell::OnceCell;
use std::ops::Range;

use rowan::{TextRange, TextSize};

use crate::lint::{Outcome, SourceView};

/// A place to show. Both count from 1; columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LineCol {
    pub line: u32,
    pub column: u32,
}

/// Where the lines of a text begin. Lines end with LF, CRLF or a lone CR, as editors and code hosts count them.
#[derive(Debug, Clone)]
pub struct LineIndex {
    /// Offset of each line's first byte; the first is 0.
    starts: Vec<u32>,
    /// Offsets of the bytes that begin no character.
    continuations: Vec<u32>,
    length: u32,
}

impl LineIndex {
    /// Texts are shorter than 4 GiB, which reading sees to.
    pub fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for at in memchr::memchr2_iter(b'\n', b'\r', bytes) {
            if bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n') {
                starts.push(number(at + 1));
            }
        }
        let continuations = if text.is_ascii() {
            Vec::new()
        } else {
            bytes.iter().enumerate().filter(|it| it.1 & 0xC0 == 0x80).map(|it| number(it.0)).collect()
        };
        Self { starts, continuations, length: number(bytes.len()) }
    }

    /// Line and column of a byte offset; one past the end is held to the end.
    pub fn line_col(&self, offset: TextSize) -> LineCol {
        let offset = u32::from(offset).min(self.length);
        let line = self.starts.partition_point(|&it| it <= offset).saturating_sub(1);
        let start = self.starts.get(line).copied().unwrap_or(0);
        let before = |it: u32| number(self.continuations.partition_point(|&at| at < it));
        let column = (offset - start) - (before(offset) - before(start));
        LineCol { line: number(line + 1), column: column + 1 }
    }

    /// Byte ranges of the lines, their ends included. There is always one at least.
    pub fn lines(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.starts.iter().skip(1).copied().chain([self.length]);
        self.starts.iter().copied().zip(ends).map(|(start, end)| start as usize..end as usize)
    }
}

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

    fn line_col(text: &str, offset: usize) -> (u32, u32) {
        let it = LineIndex::new(text).line_col(TextSize::new(offset as u32));
        (it.line, it.column)
    }

    #[test]
    fn columns_count_characters() {
        let text = "U E 0.0 // Größe\r\n= A 4.0\rx\n\ty";
        assert_eq!(line_col(text, 0), (1, 1));
        assert_eq!(line_col(text, text.find("ße").unwrap()), (1, 15));
        assert_eq!(line_col(text, text.find('=').unwrap()), (2, 1));
        assert_eq!(line_col(text, text.find('x').unwrap()), (3, 1));
        assert_eq!(line_col(text, text.find('y').unwrap()), (4, 2));
        assert_eq!(line_col(text, 10_000), (4, 3));
        assert_eq!(line_col("", 0), (1, 1));
        assert_eq!(line_col("a\n", 2), (2, 1));
    }

    #[test]
    fn lines_cover_the_text() {
        for text in ["", "a", "a\n", "a\r\nb\rc\n\n", "\r\n\r\n"] {
            let joined: String = LineIndex::new(text).lines().map(|it| &text[it]).collect();
            assert_eq!(joined, text);
        }
    }

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

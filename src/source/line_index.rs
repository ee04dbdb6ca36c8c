//! Offsets of a text to lines and columns, and back.

use rowan::{TextRange, TextSize};

use super::scan::equal_bytes;

/// A place as an editor shows it. Both count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LineCol {
    pub line: u32,
    /// In characters (Unicode scalar values), or in UTF-16 code units where the method says so.
    pub column: u32,
}

/// Where the lines of a text start, and which of its bytes do not start a character.
///
/// Lines end with LF, CRLF or CR. Every lookup takes time logarithmic in the size of the text at most. Memory: four
/// bytes a line, and four for each byte that continues a character.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineIndex {
    /// Starts with 0 and rises.
    line_starts: Vec<u32>,
    len: u32,
    /// Bytes that continue a character.
    continuation: Vec<u32>,
    /// First bytes of characters that UTF-16 stores as two units.
    astral: Vec<u32>,
}

impl LineIndex {
    /// Reads the text once. Offsets are 32 bits wide, so of a text beyond 4 GiB only the start is indexed.
    pub fn new(text: &str) -> Self {
        let bytes = indexed(text);
        let mut line_starts = Vec::with_capacity(bytes.len() / 24 + 1);
        line_starts.push(0);
        // Lines are short: a vector search for each break costs more than looking at eight bytes at a time.
        for (word, at) in words(bytes).zip((0..).step_by(8)) {
            let mut found = equal_bytes(word, b'\n') | equal_bytes(word, b'\r');
            while found != 0 {
                let start = at + found.trailing_zeros() as usize / 8 + 1;
                if is_line_start(bytes, start) {
                    line_starts.push(start as u32);
                }
                found &= found - 1;
            }
        }
        let (continuation, astral) = wide(bytes, 0..bytes.len());
        Self { line_starts, len: bytes.len() as u32, continuation, astral }
    }

    /// Follows an edit that has put `length` bytes in the place of the `removed` ones, and made `text`. Takes time for what
    /// was put there; what lies behind it is moved alone.
    pub fn edit(&mut self, removed: std::ops::Range<usize>, length: usize, text: &str) {
        let bytes = indexed(text);
        if bytes.len() < text.len() {
            *self = Self::new(text);
            return;
        }
        let added = removed.start..removed.start + length;
        let (from, to) = (removed.start as u32, removed.end as u32);
        let delta = (length as u32).wrapping_sub(to - from);
        // Whether a line starts somewhere hangs on the bytes before and behind.
        let starts = (added.start..=added.end).filter(|&at| is_line_start(bytes, at)).map(|at| at as u32);
        splice(&mut self.line_starts, from, to + 1, starts.collect(), delta);
        let (continuation, astral) = wide(bytes, added);
        splice(&mut self.continuation, from, to, continuation, delta);
        splice(&mut self.astral, from, to, astral, delta);
        self.len = bytes.len() as u32;
    }

    /// Number of lines. A text that ends with a line break ends with an empty line; there is always one.
    pub fn line_count(&self) -> u32 {
        self.line_starts.len() as u32
    }

    /// Line and column, in characters, of the character that holds the byte at `offset`. Offsets beyond the text are
    /// its end.
    pub fn line_col(&self, offset: TextSize) -> LineCol {
        let (line, start, offset) = self.locate(offset);
        LineCol { line: line + 1, column: self.characters(start, offset) + 1 }
    }

    /// As [`Self::line_col`], with the column in UTF-16 code units.
    pub fn line_col_utf16(&self, offset: TextSize) -> LineCol {
        let (line, start, offset) = self.locate(offset);
        LineCol { line: line + 1, column: self.utf16_units(start, offset) + 1 }
    }

    /// The offset of a place; `None` for a line or column that the text does not have. The column after the last
    /// character of a line, before its line break, is one that it has.
    pub fn offset(&self, place: LineCol) -> Option<TextSize> {
        self.find(place, Self::characters)
    }

    /// As [`Self::offset`], with the column in UTF-16 code units. Between the units of one character is its start.
    pub fn offset_utf16(&self, place: LineCol) -> Option<TextSize> {
        self.find(place, Self::utf16_units)
    }

    /// The line that `number`, counted from 1, says, with its line break.
    pub fn line_range(&self, number: u32) -> Option<TextRange> {
        let index = number.checked_sub(1)? as usize;
        let start = *self.line_starts.get(index)?;
        let end = self.line_starts.get(index + 1).copied().unwrap_or(self.len);
        Some(TextRange::new(start.into(), end.into()))
    }

    /// The line that `number`, counted from 1, says, without its line break. `text` is the one that was indexed.
    pub fn line_text<'t>(&self, text: &'t str, number: u32) -> Option<&'t str> {
        let line = text.get(std::ops::Range::<usize>::from(self.line_range(number)?))?;
        Some(line.strip_suffix("\r\n").or_else(|| line.strip_suffix(['\n', '\r'])).unwrap_or(line))
    }

    /// Line counted from 0, its start, and the start of the character at `offset`.
    fn locate(&self, offset: TextSize) -> (u32, u32, u32) {
        let offset = self.floor(offset);
        let line = self.line_starts.partition_point(|&start| start <= offset).saturating_sub(1);
        (line as u32, self.line_starts.get(line).copied().unwrap_or(0), offset)
    }

    /// The start of the character that holds the byte at `offset`.
    fn floor(&self, offset: TextSize) -> u32 {
        let mut offset = u32::from(offset).min(self.len);
        let mut before = self.continuation.partition_point(|&it| it <= offset);
        while before > 0 && self.continuation[before - 1] == offset {
            (before, offset) = (before - 1, offset - 1);
        }
        offset
    }

    fn characters(&self, start: u32, end: u32) -> u32 {
        end - start - between(&self.continuation, start, end)
    }

    fn utf16_units(&self, start: u32, end: u32) -> u32 {
        self.characters(start, end) + between(&self.astral, start, end)
    }

    fn find(&self, place: LineCol, width: impl Fn(&Self, u32, u32) -> u32) -> Option<TextSize> {
        let wanted = place.column.checked_sub(1)?;
        let range = self.line_range(place.line)?;
        let (start, end) = (u32::from(range.start()), u32::from(range.end()));
        // The last offset up to which the line is not wider than wanted.
        let (mut low, mut high) = (start, end);
        while low < high {
            let middle = low + (high - low).div_ceil(2);
            if width(self, start, self.floor(middle.into())) <= wanted { low = middle } else { high = middle - 1 }
        }
        let found = self.floor(low.into());
        (width(self, start, self.floor(end.into())) >= wanted).then_some(found.into())
    }
}

/// As much of a text as offsets of 32 bits reach.
fn indexed(text: &str) -> &[u8] {
    text.as_bytes().get(..u32::MAX as usize).unwrap_or(text.as_bytes())
}

/// Whether a line starts at an offset.
fn is_line_start(bytes: &[u8], at: usize) -> bool {
    match at.checked_sub(1).map(|it| bytes.get(it)) {
        None | Some(Some(b'\n')) => true,
        Some(Some(b'\r')) => bytes.get(at) != Some(&b'\n'),
        _ => false,
    }
}

/// Of some bytes of a text, those that continue a character, and those that start one of two units.
fn wide(bytes: &[u8], range: std::ops::Range<usize>) -> (Vec<u32>, Vec<u32>) {
    let (mut continuation, mut astral) = (Vec::new(), Vec::new());
    for (chunk, at) in bytes.get(range.clone()).unwrap_or_default().chunks(64).zip((range.start..).step_by(64)) {
        if chunk.is_ascii() {
            continue;
        }
        for (&byte, at) in chunk.iter().zip(at as u32..) {
            match byte {
                0x80..0xC0 => continuation.push(at),
                0xF0.. => astral.push(at),
                _ => {}
            }
        }
    }
    (continuation, astral)
}

/// Puts offsets in the place of those from one up to another, and moves those behind.
fn splice(offsets: &mut Vec<u32>, from: u32, to: u32, by: Vec<u32>, delta: u32) {
    let place = |limit: u32| offsets.partition_point(|&it| it < limit);
    let (start, end) = (place(from), place(to));
    offsets.iter_mut().skip(end).for_each(|it| *it = it.wrapping_add(delta));
    offsets.splice(start..end, by);
}

/// Number of offsets from one up to another.
fn between(offsets: &[u32], start: u32, end: u32) -> u32 {
    let before = |limit: u32| offsets.partition_point(|&it| it < limit) as u32;
    before(end) - before(start)
}

/// The text by eight bytes, the first one lowest; the last of them is filled up with zeros.
fn words(bytes: &[u8]) -> impl Iterator<Item = u64> {
    bytes.chunks(8).map(|it| {
        it.try_into()
            .map(u64::from_le_bytes)
            .unwrap_or_else(|_| it.iter().rfold(0, |word, &it| word << 8 | u64::from(it)))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn place(line: u32, column: u32) -> LineCol {
        LineCol { line, column }
    }

    #[test]
    fn lines_end_with_any_break() {
        let text = "a\nb\r\nc\rd\r\r\ne\n\r";
        let index = LineIndex::new(text);
        let lines: Vec<_> = (1..=index.line_count()).map(|line| index.line_text(text, line).unwrap()).collect();
        assert_eq!(lines, ["a", "b", "c", "d", "", "e", "", ""]);
        assert_eq!(index.line_col(4.into()), place(2, 3));
        assert_eq!(index.line_col(5.into()), place(3, 1));
        assert_eq!(index.line_range(2), Some(TextRange::new(2.into(), 5.into())));
        assert_eq!((index.line_range(0), index.line_range(9)), (None, None));
    }

    #[test]
    fn empty_text_has_one_line() {
        let index = LineIndex::new("");
        assert_eq!(index.line_count(), 1);
        assert_eq!(index.line_col(0.into()), place(1, 1));
        assert_eq!(index.line_col(7.into()), place(1, 1));
        assert_eq!(index.offset(place(1, 1)), Some(0.into()));
        assert_eq!(index.line_text("", 1), Some(""));
    }

    #[test]
    fn columns_count_characters() {
        let text = "U « été » // 😀!\n= A";
        let index = LineIndex::new(text);
        let at = TextSize::of(text.split('!').next().unwrap());
        assert_eq!(index.line_col(at), place(1, 15));
        assert_eq!(index.line_col_utf16(at), place(1, 16));
        assert_eq!(index.offset(place(1, 15)), Some(at));
        assert_eq!(index.offset_utf16(place(1, 16)), Some(at));
        assert_eq!(index.offset_utf16(place(1, 15)), Some(at - TextSize::of('😀')), "between the halves of a pair");
        assert_eq!(index.line_col(3.into()), place(1, 3), "inside «");
        assert_eq!(index.offset(place(2, 4)), Some(TextSize::of(text)));
        assert_eq!(index.offset(place(2, 5)), None);
        assert_eq!(index.offset(place(3, 1)), None);
    }

    #[test]
    fn one_long_line() {
        let text = "é".repeat(1 << 20);
        let index = LineIndex::new(&text);
        for n in (0..1 << 20).step_by(1 << 10) {
            assert_eq!(index.line_col((2 * n).into()), place(1, n + 1));
            assert_eq!(index.offset(place(1, n + 1)), Some((2 * n).into()));
        }
    }

    proptest! {
        #[test]
        fn agrees_with_counting(pieces in prop::collection::vec("[a-zé€😀\r\n]{0,90}|\\PC*", 0..8)) {
            let text = pieces.concat();
            let index = LineIndex::new(&text);
            let (mut line, mut column, mut units) = (1, 1, 1);
            let mut previous = ' ';
            for (offset, character) in text.char_indices() {
                if previous == '\n' || previous == '\r' && character != '\n' {
                    (line, column, units) = (line + 1, 1, 1);
                }
                let offset = TextSize::new(offset as u32);
                prop_assert_eq!(index.line_col(offset), place(line, column));
                prop_assert_eq!(index.line_col_utf16(offset), place(line, units));
                prop_assert_eq!(index.offset(place(line, column)), Some(offset));
                prop_assert_eq!(index.offset_utf16(place(line, units)), Some(offset));
                let last = offset + TextSize::of(character) - TextSize::new(1);
                prop_assert_eq!(index.line_col(last), place(line, column));
                column += 1;
                units += character.len_utf16() as u32;
                previous = character;
            }
            let ranges = (1..=index.line_count()).map(|line| index.line_range(line).unwrap());
            let mut end = TextSize::new(0);
            for range in ranges {
                prop_assert_eq!(range.start(), end);
                end = range.end();
            }
            prop_assert_eq!(end, TextSize::of(text.as_str()));
        }

        #[test]
        fn edits_are_followed(
            text in "([a\r\né😀]{0,9}){0,9}",
            edits in prop::collection::vec((any::<(prop::sample::Index, prop::sample::Index)>(), "[b\r\né😀]{0,4}"), 1..9),
        ) {
            let mut text = text;
            let mut index = LineIndex::new(&text);
            for ((start, end), by) in edits {
                let places: Vec<usize> = text.char_indices().map(|it| it.0).chain([text.len()]).collect();
                let (start, end) = (*start.get(&places), *end.get(&places));
                let removed = start.min(end)..start.max(end);
                text.replace_range(removed.clone(), &by);
                index.edit(removed, by.len(), &text);
                prop_assert_eq!(&index, &LineIndex::new(&text));
            }
        }

        #[test]
        fn any_place_is_answered(text: String, offset: u32, line: u32, column: u32) {
            let index = LineIndex::new(&text);
            let _ = (index.line_col(offset.into()), index.line_col_utf16(offset.into()));
            for place in [place(line, column), place(line % 8, column % 32)] {
                for found in [index.offset(place), index.offset_utf16(place)].into_iter().flatten() {
                    prop_assert!(text.is_char_boundary(found.into()));
                }
            }
        }
    }
}

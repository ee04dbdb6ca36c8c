//! Places and paths, as the client and as the database name them.

use std::path::Path;

use lsp_types::{Position, PositionEncodingKind, Range, Uri};
use rowan::{TextRange, TextSize};

use crate::load;
use crate::source::line_index::{LineCol, LineIndex};

/// What the client counts columns in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Encoding {
    Utf8,
    /// What every client knows.
    #[default]
    Utf16,
    Utf32,
}

impl Encoding {
    /// The best of those that the client knows: no conversion, else what all clients know.
    pub(super) fn negotiate(known: &[PositionEncodingKind]) -> Self {
        if known.contains(&PositionEncodingKind::UTF8) {
            Self::Utf8
        } else if known.contains(&PositionEncodingKind::UTF32) && !known.contains(&PositionEncodingKind::UTF16) {
            Self::Utf32
        } else {
            Self::Utf16
        }
    }

    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// Length of a text on one line.
    pub(super) fn length(self, text: &str) -> u32 {
        let length = match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
            Self::Utf32 => text.chars().count(),
        };
        u32::try_from(length).unwrap_or(u32::MAX)
    }

    pub(super) fn position(self, lines: &LineIndex, at: TextSize) -> Position {
        let place = match self {
            Self::Utf8 => {
                let LineCol { line, .. } = lines.line_col(at);
                let start = lines.line_range(line).map_or(at, |it| it.start());
                return Position::new(line - 1, u32::from(at.max(start) - start));
            }
            Self::Utf16 => lines.line_col_utf16(at),
            Self::Utf32 => lines.line_col(at),
        };
        Position::new(place.line - 1, place.column - 1)
    }

    pub(super) fn range(self, lines: &LineIndex, range: TextRange) -> Range {
        Range::new(self.position(lines, range.start()), self.position(lines, range.end()))
    }

    /// The place in a text. A column beyond the end of its line is that end, as the protocol says; a line beyond the text
    /// is its end.
    pub(super) fn offset(self, lines: &LineIndex, text: &str, position: Position) -> TextSize {
        let end = TextSize::of(text);
        let Some(line) = position.line.checked_add(1) else { return end };
        let (Some(range), Some(content)) = (lines.line_range(line), lines.line_text(text, line)) else { return end };
        let last = range.start() + TextSize::of(content);
        let column = position.character.saturating_add(1);
        let found = match self {
            Self::Utf8 => {
                let wanted = usize::from(range.start()).saturating_add(position.character as usize);
                let mut at = wanted.min(last.into());
                while !text.is_char_boundary(at) {
                    at -= 1;
                }
                return TextSize::try_from(at).unwrap_or(last);
            }
            Self::Utf16 => lines.offset_utf16(LineCol { line, column }),
            Self::Utf32 => lines.offset(LineCol { line, column }),
        };
        found.unwrap_or(last).min(last)
    }

    /// The stretch of a text; one that ends before it starts is empty.
    pub(super) fn text_range(self, lines: &LineIndex, text: &str, range: Range) -> TextRange {
        let start = self.offset(lines, text, range.start);
        TextRange::new(start, self.offset(lines, text, range.end).max(start))
    }
}

/// The path by which the database knows a document: as findings show it, or the address of what is no file.
pub(super) fn path_of(uri: &Uri) -> String {
    match (uri.scheme(), uri.to_file_path()) {
        ("file", Ok(path)) => load::shown(&path),
        _ => uri.to_string(),
    }
}

/// The address of a path of the database.
pub(super) fn uri_of(path: &str) -> Option<Uri> {
    if Path::new(path).is_absolute() { Uri::from_file_path(path).ok() } else { Uri::parse(path).ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_of_the_client() {
        let text = "=\té😀 A\r\nx";
        let lines = LineIndex::new(text);
        let at = TextSize::of("=\té😀 ");
        for (encoding, column) in [(Encoding::Utf8, 9), (Encoding::Utf16, 6), (Encoding::Utf32, 5)] {
            assert_eq!(encoding.position(&lines, at), Position::new(0, column), "{encoding:?}");
            assert_eq!(encoding.offset(&lines, text, Position::new(0, column)), at, "{encoding:?}");
            let end = TextSize::of("=\té😀 A");
            assert_eq!(encoding.offset(&lines, text, Position::new(0, 99)), end, "beyond the line");
            assert_eq!(encoding.offset(&lines, text, Position::new(0, u32::MAX)), end);
            assert_eq!(encoding.offset(&lines, text, Position::new(7, 0)), TextSize::of(text), "beyond the text");
            assert_eq!(encoding.offset(&lines, text, Position::new(u32::MAX, 0)), TextSize::of(text));
            assert_eq!(encoding.offset(&lines, text, Position::new(1, 1)), TextSize::of(text));
        }
        let inside = Encoding::Utf8.offset(&lines, text, Position::new(0, 3));
        assert_eq!(inside, TextSize::of("=\t"), "inside of a character");
    }

    #[test]
    fn a_position_beyond_a_last_line_without_break_is_its_end() {
        let lines = LineIndex::new("ab");
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32] {
            assert_eq!(encoding.offset(&lines, "ab", Position::new(0, 9)), TextSize::new(2), "{encoding:?}");
        }
    }

    #[test]
    fn the_client_chooses_the_encoding() {
        use PositionEncodingKind as Kind;
        assert_eq!(Encoding::negotiate(&[]), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(&[Kind::UTF16, Kind::UTF8]), Encoding::Utf8);
        assert_eq!(Encoding::negotiate(&[Kind::UTF32]), Encoding::Utf32);
        assert_eq!(Encoding::negotiate(&[Kind::UTF32, Kind::UTF16]), Encoding::Utf16);
    }

    #[test]
    fn paths_and_addresses() {
        let uri = Uri::parse("file:///tmp/a%20b.awl").unwrap();
        assert_eq!(path_of(&uri), "/tmp/a b.awl");
        assert_eq!(uri_of("/tmp/a b.awl"), Some(uri));
        let untitled = Uri::parse("untitled:Untitled-1").unwrap();
        assert_eq!(uri_of(&path_of(&untitled)), Some(untitled));
        assert_eq!(uri_of("no address"), None);
    }
}

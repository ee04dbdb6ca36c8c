//! A cheap cut of a text into lines that knows comments, as unit boundaries and dialect detection need it.

use memchr::{memchr, memchr2, memchr3};

/// One line of text, or several if a comment holds the breaks between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Line<'t> {
    /// Offset of the line in the text.
    pub(super) start: usize,
    /// Offset after the line break.
    pub(super) end: usize,
    /// Offset of `code`.
    pub(super) code_start: usize,
    /// What is neither blank nor comment, up to the first `(*` comment after it or the end of the line. A line comment
    /// may follow. Empty if there is nothing but blanks and comments.
    pub(super) code: &'t str,
}

/// The lines of a text. They tile it. `(* *)` comments do not nest; quotes, which hide the start of a comment, end with
/// their line at the latest.
///
/// Runs in time linear in the text: every byte is looked at twice at most.
pub(super) struct Lines<'t> {
    text: &'t str,
    pos: usize,
    dialect: Comments,
}

/// Which comments a dialect has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Comments {
    /// `(* *)`.
    Pl7,
    /// `(* *)`, `//` to the end of the line, and titles that are free text.
    Step7,
}

impl<'t> Lines<'t> {
    pub(super) fn new(text: &'t str, dialect: Comments) -> Self {
        Self { text, pos: 0, dialect }
    }

    /// Goes on at an offset, outside of comments: the start of a line.
    pub(super) fn skip_to(&mut self, offset: usize) {
        self.pos = offset;
    }

    /// The end of the line that contains `from`, which is outside of comments, and its first `(*`.
    fn plain_line(&self, from: usize) -> (usize, Option<usize>) {
        let bytes = self.text.as_bytes();
        let rest = bytes.get(from..).unwrap_or_default();
        let mut searched = 0;
        loop {
            match find_break_or_asterisk(rest, searched) {
                None => return (bytes.len(), None),
                Some((hit, b'*')) if hit > 0 && rest[hit - 1] == b'(' => {
                    // Quotes and line comments before it may hide it; without any, it opens a comment.
                    match memchr3(b'\'', b'"', b'/', &rest[..hit]) {
                        Some(_) => break,
                        None => return (from + hit - 1, Some(from + hit - 1)),
                    }
                }
                Some((hit, b'*')) => searched = hit + 1,
                Some((hit, _)) => return (after_break(bytes, from + hit), None),
            }
        }
        let mut at = 0;
        let mut quote = None;
        while let Some(&byte) = rest.get(at) {
            match (byte, quote) {
                (b'\n' | b'\r', _) => return (after_break(bytes, from + at), None),
                (b'\'' | b'"', None) => quote = Some(byte),
                (_, Some(open)) if byte == open => quote = None,
                (b'(', None) if rest.get(at + 1) == Some(&b'*') => return (from + at, Some(from + at)),
                (b'/', None) if self.dialect == Comments::Step7 && rest.get(at + 1) == Some(&b'/') => {
                    return (line_end(bytes, from + at), None);
                }
                _ => {}
            }
            at += 1;
        }
        (bytes.len(), None)
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = Line<'t>;

    fn next(&mut self) -> Option<Line<'t>> {
        let bytes = self.text.as_bytes();
        let start = self.pos;
        if start >= bytes.len() {
            return None;
        }
        // Most lines are empty, or code without comments.
        let first = skip_blanks(self.text, start);
        let mut plain = None;
        match bytes.get(first) {
            Some(b'\n') => {
                self.pos = first + 1;
                return Some(Line { start, end: self.pos, code_start: self.pos, code: "" });
            }
            Some(b'(' | b'/' | b'T' | b't' | b'N' | b'n' | b'\r') | None => {}
            Some(_) => {
                let (end, comment) = self.plain_line(first);
                if comment.is_none() {
                    self.pos = end;
                    return Some(Line { start, end, code_start: first, code: trim_end(self.text, first, end) });
                }
                plain = Some((end, comment));
            }
        }
        let mut code: Option<(usize, usize)> = None;
        let mut from = start;
        let end = loop {
            let first = skip_blanks(self.text, from);
            let is_comment = |mark: &[u8]| bytes.get(first..).is_some_and(|rest| rest.starts_with(mark));
            if self.dialect == Comments::Step7
                && (is_comment(b"//") || code.is_none() && starts_title(bytes.get(first..).unwrap_or_default()))
            {
                let end = line_end(bytes, first);
                if !is_comment(b"//") && code.is_none() {
                    code = Some((first, end));
                }
                break end;
            }
            let (stop, comment) = plain.take().unwrap_or_else(|| self.plain_line(first));
            if code.is_none() && first < comment.unwrap_or_else(|| before_break(bytes, stop)) {
                code = Some((first, comment.unwrap_or(stop)));
            }
            let Some(comment) = comment else { break stop };
            match after_comment(bytes, comment + 2) {
                Some(after) => from = after,
                None => break bytes.len(),
            }
        };
        self.pos = end;
        let (code_start, code_end) = code.unwrap_or((end, end));
        Some(Line { start, end, code_start, code: trim_end(self.text, code_start, code_end) })
    }
}

/// The offset after the `*)` that ends the comment whose text starts at `from`.
fn after_comment(bytes: &[u8], from: usize) -> Option<usize> {
    let mut at = from;
    loop {
        at = find_any(bytes, at, [b'*'])? + 1;
        if bytes.get(at) == Some(&b')') {
            return Some(at + 1);
        }
    }
}

/// The first line break or asterisk at or after `from`, and which it is.
fn find_break_or_asterisk(bytes: &[u8], from: usize) -> Option<(usize, u8)> {
    let at = find_any(bytes, from, [b'\n', b'\r', b'*'])?;
    Some((at, bytes[at]))
}

/// The first of some bytes at or after `from`. Lines are short, so that the first bytes are looked at eight at a time
/// before a vector search, which is slow to start.
fn find_any<const N: usize>(bytes: &[u8], from: usize, wanted: [u8; N]) -> Option<usize> {
    const SHORT: usize = 6;
    let mut at = from;
    for word in bytes.get(from..)?.chunks_exact(8).take(SHORT) {
        let word = word.try_into().map_or(0, u64::from_le_bytes);
        let found = wanted.iter().fold(0, |found, &byte| found | equal_bytes(word, byte));
        if found != 0 {
            return Some(at + found.trailing_zeros() as usize / 8);
        }
        at += 8;
    }
    let rest = bytes.get(at..)?;
    let found = match *wanted.as_slice() {
        [a] => memchr(a, rest),
        [a, b] => memchr2(a, b, rest),
        [a, b, c] => memchr3(a, b, c, rest),
        _ => rest.iter().position(|it| wanted.contains(it)),
    };
    found.map(|length| at + length)
}

/// Sets the high bit of the first byte of the word, counted from the lowest, that equals `byte`. Higher bytes may be
/// marked although they differ.
pub(super) fn equal_bytes(word: u64, byte: u8) -> u64 {
    const ONES: u64 = u64::from_le_bytes([1; 8]);
    let zeros = word ^ (ONES * byte as u64);
    zeros.wrapping_sub(ONES) & !zeros & (ONES << 7)
}

/// A piece of text without the blanks at its end.
fn trim_end(text: &str, start: usize, end: usize) -> &str {
    let mut last = end;
    while let Some(b' ' | b'\t' | b'\n' | b'\r' | b'\x0b' | b'\x0c') =
        text.as_bytes().get(start..last).and_then(<[u8]>::last)
    {
        last -= 1;
    }
    let piece = text.get(start..last).unwrap_or_default();
    if piece.ends_with(|c: char| c.is_ascii()) { piece } else { piece.trim_end() }
}

/// Whether a line is a title, whose text is free: parentheses and apostrophes in it mean nothing.
fn starts_title(line: &[u8]) -> bool {
    let word = |line: &[u8], word: &[u8]| line.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
    let rest = if word(line, b"TITLE") {
        line.get(5..)
    } else if word(line, b"NETWORK") {
        let rest = line.get(7..).unwrap_or_default().trim_ascii_start();
        if word(rest, b"TITLE") { rest.get(5..) } else { None }
    } else {
        None
    };
    rest.is_some_and(|rest| rest.iter().find(|byte| !matches!(byte, b' ' | b'\t')) == Some(&b'='))
}

/// The first character at or after `from` that is not blank; line breaks are not blank.
fn skip_blanks(text: &str, from: usize) -> usize {
    let mut at = from;
    while let Some(&byte) = text.as_bytes().get(at) {
        match byte {
            b' ' | b'\t' | b'\x0b' | b'\x0c' => at += 1,
            // No-break spaces come with text that was pasted from documents.
            0x80.. => match text.get(at..).and_then(|rest| rest.chars().next()) {
                Some(character) if character.is_whitespace() || character == '\u{feff}' => at += character.len_utf8(),
                _ => break,
            },
            _ => break,
        }
    }
    at
}

/// The offset after the line break that starts at `at`.
fn after_break(bytes: &[u8], at: usize) -> usize {
    if bytes.get(at..).is_some_and(|rest| rest.starts_with(b"\r\n")) { at + 2 } else { at + 1 }
}

/// The offset of the line break that ends at `end`.
fn before_break(bytes: &[u8], end: usize) -> usize {
    match bytes.get(..end) {
        Some([.., b'\r', b'\n']) => end - 2,
        Some([.., b'\r' | b'\n']) => end - 1,
        _ => end,
    }
}

/// The end of the line that contains `from`, its break included.
fn line_end(bytes: &[u8], from: usize) -> usize {
    match memchr2(b'\n', b'\r', bytes.get(from..).unwrap_or_default()) {
        Some(length) => after_break(bytes, from + length),
        None => bytes.len(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[track_caller]
    fn check(dialect: Comments, text: &str, expected: &[&str]) {
        let codes: Vec<_> = Lines::new(text, dialect).map(|line| line.code).collect();
        assert_eq!(codes, expected, "{text:?}");
    }

    #[test]
    fn lines_and_comments() {
        check(Comments::Pl7, "a\r\n\r b \u{a0}\n\n", &["a", "", "b", ""]);
        check(Comments::Pl7, "(* x *) a (* y\nz *) b\nc", &["a", "c"]);
        check(Comments::Pl7, "(* x\n[EOF]\n", &[""]);
        check(Comments::Pl7, "(*)\n*) a", &["a"]);
        check(Comments::Pl7, "a // (* b\nc *) d", &["a //"]);
        check(Comments::Pl7, "L '(*'\nb \"(*\nc", &["L '(*'", "b \"(*", "c"]);
        check(Comments::Step7, "a // (* b\nc", &["a // (* b", "c"]);
        check(Comments::Step7, "// (* b\n//\n *I", &["", "", "*I"]);
        check(Comments::Step7, "(* // *) a\n", &["a"]);
        check(
            Comments::Step7,
            "title = l'eau (* x\nTITLE=(*\nNETWORK title = (*\nNETWORK (* x\n*)\nx",
            &["title = l'eau (* x", "TITLE=(*", "NETWORK title = (*", "NETWORK", "x"],
        );
    }

    proptest! {
        #[test]
        fn lines_tile_any_text(text in "([(*)'\"/ a\r\né]|TITLE =){0,60}|\\PC*") {
            for dialect in [Comments::Pl7, Comments::Step7] {
                let mut end = 0;
                for line in Lines::new(&text, dialect) {
                    prop_assert_eq!(line.start, end);
                    prop_assert!(line.end > line.start && line.code_start >= line.start);
                    prop_assert!(text[line.code_start..line.end].starts_with(line.code));
                    end = line.end;
                }
                prop_assert_eq!(end, text.len());
            }
        }
    }
}

//! Characters to tokens, in one pass over each line.
//!
//! What a word is depends on its place: at the start of an instruction it is a mnemonic, behind one the letters of an
//! operand, which are one token with its number (`M 0.0`, `KF +5`).

use crate::syntax::SyntaxKind;
use crate::syntax::tokens::Tokens;

use SyntaxKind::*;

/// Splits a unit into tokens, whose lengths add up to the text.
pub(super) fn lex(text: &str) -> Tokens {
    let mut lexer = Lexer { text, at: 0, tokens: Tokens::with_capacity(text.len() / 3) };
    let (mut line_start, mut at_start) = (true, true);
    while let Some(next) = lexer.peek() {
        match next {
            '\n' | '\r' => {
                lexer.line_break();
                (line_start, at_start) = (true, true);
                continue;
            }
            _ if is_blank(next) => {
                let end = lexer.run(lexer.at, is_blank);
                lexer.push_to(Whitespace, end);
                continue;
            }
            ';' => lexer.comment(),
            '/' if lexer.rest().starts_with("//") => lexer.comment(),
            _ if is_word_start(next) => {
                let end = lexer.run(lexer.at, is_word);
                let after = lexer.run(end, is_blank);
                let labelled = lexer.byte(after) == Some(b':');
                let word = &text[lexer.at..end];
                if line_start && labelled && is_name_line(word) {
                    lexer.push_to(Ident, end);
                    lexer.free_text();
                } else {
                    let operand = || operand(text, lexer.at, end, at_start);
                    let (kind, end) = (!line_start || !labelled).then(operand).flatten().unwrap_or((Ident, end));
                    lexer.push_to(kind, end);
                }
                at_start = false;
            }
            _ if next.is_ascii_digit() => {
                let end = number_end(text.as_bytes(), lexer.at, line_start);
                lexer.push_to(Number, end);
                // The address that a print puts before each instruction.
                at_start = line_start;
                continue;
            }
            '-' if !at_start && lexer.char_at(lexer.at + 1).is_some_and(is_word_start) => {
                let end = lexer.run(lexer.at + 1, |it| is_word(it) || matches!(it, '-' | '.' | '/'));
                lexer.push_to(QuotedSymbol, end);
            }
            _ => at_start = lexer.punctuation(at_start),
        }
        line_start = false;
    }
    lexer.tokens
}

fn is_blank(it: char) -> bool {
    matches!(it, ' ' | '\t' | '\x0B' | '\x0C' | '\u{A0}' | '\u{202F}' | '\u{FEFF}')
}

fn is_word_start(it: char) -> bool {
    it.is_alphabetic() || it == '_'
}

/// Documents write `X1↑` for an edge and `KH????` for a value that the reader fills in.
fn is_word(it: char) -> bool {
    it.is_alphanumeric() || matches!(it, '_' | '?' | '↑' | '↓')
}

/// `NAME :INITG1`, in the languages of the programming device.
fn is_name_line(word: &str) -> bool {
    ["NAME", "NOM", "NOMBRE", "NOME"].iter().any(|it| it.eq_ignore_ascii_case(word))
}

/// Whether letters are those of operands that have a number, in either mnemonic set.
pub(super) fn is_area(letters: &str) -> bool {
    match *letters.as_bytes() {
        [a] => {
            matches!(a.to_ascii_uppercase(), b'E' | b'I' | b'A' | b'Q' | b'M' | b'F' | b'S' | b'D' | b'T' | b'Z' | b'C')
        }
        [a, b] => matches!(
            [a.to_ascii_uppercase(), b.to_ascii_uppercase()],
            [b'E' | b'I' | b'A' | b'Q' | b'M', b'B' | b'W' | b'D']
                | [b'F' | b'S', b'B' | b'Y' | b'W' | b'D']
                | [b'D', b'B' | b'L' | b'R' | b'W' | b'D']
                | [b'F' | b'D', b'X']
                | [b'P' | b'O', b'B' | b'Y' | b'W']
                | [b'R', b'S' | b'I' | b'T']
                | [b'B', b'S' | b'A']
        ),
        _ => false,
    }
}

/// Whether a word begins a constant: `KF`, `KH0000`.
pub(crate) fn is_constant(word: &str) -> bool {
    constant_kind(word).is_some()
}

/// Letters of the blocks.
pub(super) fn is_block(letters: &str) -> bool {
    let [a, b] = *letters.as_bytes() else { return false };
    let upper = [a.to_ascii_uppercase(), b.to_ascii_uppercase()];
    matches!(upper, [b'O' | b'P' | b'S' | b'F' | b'D', b'B'] | [b'F' | b'D', b'X'])
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Constant {
    /// `KF +5`, `KG +1234567+02`: signs and digits.
    Signed,
    /// `KH 00FF`: letters and digits.
    Word,
    /// `KT 200.1`, `KY 12,34`: digits and what parts them.
    Digits,
    /// `KM 00000000 11111111`
    Bits,
    /// `KC AB`, `KS 'AB'`
    Text,
}

/// The kind of constant that a word such as `KF`, or `KH0000`, begins with its first two letters.
fn constant_kind(word: &str) -> Option<Constant> {
    let &[a, b, ref rest @ ..] = word.as_bytes() else { return None };
    let kind = match &[a.to_ascii_uppercase(), b.to_ascii_uppercase()] {
        b"KF" | b"KG" | b"BF" => Constant::Signed,
        b"DF" if rest.is_empty() => Constant::Signed,
        b"KH" => Constant::Word,
        b"DH" if rest.is_empty() => Constant::Word,
        b"KT" | b"KY" | b"KZ" | b"KB" => Constant::Digits,
        b"KM" => Constant::Bits,
        b"KC" | b"KS" if rest.is_empty() => Constant::Text,
        _ => return None,
    };
    // `KTRL` is a name.
    let fits = |it: &u8| it.is_ascii_digit() || *it == b'?' || kind == Constant::Word && it.is_ascii_hexdigit();
    rest.iter().all(fits).then_some(kind)
}

/// The operand, and where it ends, that the word from `start` to `end` begins: the letters of an area and a number, or a
/// constant. At the start of an instruction a word is a mnemonic, unless what follows it at once says otherwise (`E0.0`).
fn operand(text: &str, start: usize, end: usize, at_start: bool) -> Option<(SyntaxKind, usize)> {
    let word = &text[start..end];
    let bytes = text.as_bytes();
    let blanks = |from: usize| from + bytes[from..].iter().take_while(|it| matches!(it, b' ' | b'\t')).count();
    let run = |from: usize, fits: fn(&u8) -> bool| from + bytes[from..].iter().take_while(|it| fits(it)).count();
    let constant = if at_start { None } else { constant_kind(word) };
    if let Some(kind) = constant {
        let from = blanks(start + 2);
        let stop = match kind {
            Constant::Signed => run(from, |it| it.is_ascii_digit() || matches!(it, b'+' | b'-' | b'?')),
            Constant::Word => run(from, |it| it.is_ascii_alphanumeric() || *it == b'?'),
            Constant::Digits => run(from, |it| it.is_ascii_digit() || matches!(it, b'.' | b',' | b'?')),
            Constant::Bits => {
                let first = run(from, |it| matches!(it, b'0' | b'1' | b'?'));
                let second = run(blanks(first), |it| matches!(it, b'0' | b'1' | b'?'));
                if second > blanks(first) { second } else { first }
            }
            Constant::Text => run(from, |it| it.is_ascii_graphic() && *it != b';').min(from + 4),
        };
        return (stop > from).then_some((TypedConstant, stop));
    }
    let letters = word.bytes().take_while(u8::is_ascii_alphabetic).count();
    if at_start && letters == word.len() || !is_area(&word[..letters]) {
        return None;
    }
    let digits = if letters == word.len() { blanks(end) } else { start + letters };
    let number = run(digits, u8::is_ascii_digit);
    // A name such as `T1a`, `S1`.
    if number == digits || letters < word.len() && number != end {
        return None;
    }
    let bit = match bytes.get(number) {
        Some(b'.' | b',') => run(number + 1, u8::is_ascii_digit),
        _ => number,
    };
    let has_bit = bit > number + 1;
    if !has_bit && (at_start || letters < word.len() && word.starts_with(['S', 's'])) {
        return None;
    }
    Some((Address, if has_bit { bit } else { number }))
}

/// Digits with a fraction; at the start of a line, those of an address, which is hexadecimal.
fn number_end(bytes: &[u8], at: usize, line_start: bool) -> usize {
    let run = |from: usize, fits: fn(&u8) -> bool| from + bytes[from..].iter().take_while(|it| fits(it)).count();
    if line_start {
        return run(at, u8::is_ascii_hexdigit);
    }
    let end = run(at, u8::is_ascii_digit);
    match bytes.get(end) {
        Some(b'.' | b',') => match run(end + 1, u8::is_ascii_digit) {
            fraction if fraction > end + 1 => fraction,
            _ => end,
        },
        _ => end,
    }
}

struct Lexer<'t> {
    text: &'t str,
    at: usize,
    tokens: Tokens,
}

impl<'t> Lexer<'t> {
    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn byte(&self, at: usize) -> Option<u8> {
        self.text.as_bytes().get(at).copied()
    }

    fn char_at(&self, at: usize) -> Option<char> {
        self.text.get(at..)?.chars().next()
    }

    /// Where a run of characters ends that starts at an offset.
    fn run(&self, from: usize, fits: impl Fn(char) -> bool) -> usize {
        let is_part = |it: &&u8| it.is_ascii() && fits(char::from(**it));
        let end = from + self.text.as_bytes()[from..].iter().take_while(is_part).count();
        // Nearly all characters are of ASCII.
        match self.byte(end) {
            Some(it) if !it.is_ascii() => self.text[end..].find(|it| !fits(it)).map_or(self.text.len(), |it| end + it),
            _ => end,
        }
    }

    fn push_to(&mut self, kind: SyntaxKind, end: usize) {
        self.tokens.push(kind, end - self.at);
        self.at = end;
    }

    /// With the blanks that indent the next line.
    fn line_break(&mut self) {
        let crlf = self.rest().starts_with("\r\n");
        let start = self.at + if crlf { 2 } else { 1 };
        let end = self.run(start, |it| matches!(it, ' ' | '\t'));
        self.push_to(Newline, end);
    }

    fn line_end(&self) -> usize {
        memchr::memchr2(b'\n', b'\r', self.rest().as_bytes()).map_or(self.text.len(), |it| self.at + it)
    }

    fn comment(&mut self) {
        let end = self.line_end();
        self.push_to(Comment, end);
    }

    /// The colon after `NAME`, and the name, to the end of the line or a comment.
    fn free_text(&mut self) {
        let colon = self.run(self.at, is_blank);
        self.push_to(Whitespace, colon);
        self.push_to(Colon, colon + 1);
        let start = self.run(self.at, is_blank);
        self.push_to(Whitespace, start);
        let line = &self.text[start..self.line_end()];
        let end = line.find(';').unwrap_or(line.len());
        self.push_to(FreeText, start + line[..end].trim_end().len());
    }

    /// An operator, a bracket, or a run of what the language does not have. Whether an instruction may start behind it.
    fn punctuation(&mut self, at_start: bool) -> bool {
        let bytes = &self.text.as_bytes()[self.at..];
        let stars = bytes.iter().take_while(|it| **it == b'*').count();
        if stars >= 3 {
            self.push_to(SegmentEnd, self.at + stars);
            return true;
        }
        if let Some(len) = operator(bytes, at_start) {
            self.push_to(Operator, self.at + len);
            return false;
        }
        let (kind, len) = match bytes {
            [b':', ..] => (Colon, 1),
            [b'.', b'.', b'.', ..] => (Elision, bytes.iter().take_while(|it| **it == b'.').count()),
            [b'.', b'.', ..] => (Elision, 2),
            [b'(', ..] => (LParen, 1),
            [b')', ..] => (RParen, 1),
            [b'[', ..] => (LBrack, 1),
            [b']', ..] => (RBrack, 1),
            [b'=', ..] => (Eq, 1),
            [b',', ..] => (Comma, 1),
            [b'.', ..] => (Dot, 1),
            [b'+', ..] => (Plus, 1),
            [b'-', ..] => (Minus, 1),
            [b'/', ..] => (Slash, 1),
            [b'*', ..] => (Star, 1),
            _ => (Unknown, self.peek().map_or(1, char::len_utf8)),
        };
        self.push_to(kind, self.at + len);
        matches!(kind, Colon | LParen | Elision) || at_start && kind == RParen
    }
}

/// Length of `!=F`, `><G`, `>= D`, and at the start of an instruction of `+F`, `-G` and `:F`.
fn operator(bytes: &[u8], at_start: bool) -> Option<usize> {
    let sign = match bytes {
        [b'!', b'=', ..] | [b'>', b'<' | b'=', ..] | [b'<', b'=' | b'>', ..] => 2,
        [b'>' | b'<', ..] => 1,
        [b'+' | b'-' | b':', ..] if at_start => 1,
        _ => return None,
    };
    let is_arithmetic = sign == 1 && !matches!(bytes[0], b'>' | b'<');
    let blanks =
        if is_arithmetic { 0 } else { bytes[sign..].iter().take_while(|it| matches!(it, b' ' | b'\t')).count() };
    let (letter, rest) = bytes[sign + blanks..].split_first()?;
    let is_letter = matches!(letter, b'F' | b'G' | b'D' | b'f' | b'g' | b'd');
    let ends = !rest.first().is_some_and(|it| it.is_ascii_alphanumeric() || *it == b'_' || *it >= 0x80);
    // `:D 5` decrements, `:G DB 5` makes a data block.
    let behind = rest.iter().find(|it| !matches!(it, b' ' | b'\t'));
    let has_operand = bytes[0] == b':' && behind.is_some_and(|it| !matches!(it, b'\n' | b'\r' | b';'));
    (is_letter && ends && !has_operand).then_some(sign + blanks + 1)
}

//! Characters to tokens.
//!
//! Throughput is per token, so tokens are coarse: an absolute operand (`M 0.0`, `DB5.DBW 0`), a constant, a pointer and
//! the free text of a title are one token each. Three of these depend on their place, which is why a thin loop runs
//! over the state machine: free text follows certain keywords, `L 5` is an operand anywhere but at the start of an
//! instruction, and `...` leaves code out only there.

use logos::Logos;

use crate::syntax::SyntaxKind;
use crate::syntax::tokens::{Tokens, comment_length};

#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq)]
#[logos(extras = Extras)]
enum Lexeme {
    // No-break spaces stand inside French quotes.
    #[regex(r"[ \t\x0B\x0C\u{A0}\u{202F}\u{FEFF}]+")]
    Blanks,
    // With the blanks that indent the next line: one token the less for each line.
    #[regex(r"(\r\n|\n|\r)[ \t]*")]
    Newline,
    #[regex(r"//[^\r\n]*", allow_greedy = true)]
    // The symbol comment of a listing printed with symbol information.
    #[regex(r"--[^\r\n]*", allow_greedy = true)]
    LineComment,
    #[token("(*", block_comment)]
    BlockComment(bool),

    #[regex(
        r"[A-Za-z_\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{24F}\u{370}-\u{52F}\u{4E00}-\u{9FFF}][0-9A-Za-z_\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{24F}\u{370}-\u{52F}\u{4E00}-\u{9FFF}]*",
        priority = 1
    )]
    #[regex(r"[rR][nN][dD][+-]")]
    Word,
    #[token("TITLE", priority = 20, ignore(case))]
    Title,
    #[token("AUTHOR", priority = 20, ignore(case))]
    #[token("FAMILY", priority = 20, ignore(case))]
    #[token("NAME", priority = 20, ignore(case))]
    #[token("VERSION", priority = 20, ignore(case))]
    HeaderKey,
    #[token("ORGANIZATION_BLOCK", priority = 20, ignore(case))]
    #[token("FUNCTION_BLOCK", priority = 20, ignore(case))]
    #[token("FUNCTION", priority = 20, ignore(case))]
    #[token("DATA_BLOCK", priority = 20, ignore(case))]
    #[token("TYPE", priority = 20, ignore(case))]
    BlockKeyword,
    #[token("VAR", priority = 20, ignore(case))]
    #[token("VAR_INPUT", priority = 20, ignore(case))]
    #[token("VAR_OUTPUT", priority = 20, ignore(case))]
    #[token("VAR_IN_OUT", priority = 20, ignore(case))]
    #[token("VAR_TEMP", priority = 20, ignore(case))]
    #[token("STRUCT", priority = 20, ignore(case))]
    Declarations,
    #[token("BEGIN", priority = 20, ignore(case))]
    Begin,
    #[token("NETWORK", priority = 20, ignore(case))]
    #[token("NETZWERK", priority = 20, ignore(case))]
    #[token("RÉSEAU", priority = 20, ignore(case))]
    #[token("SEGMENT", priority = 20, ignore(case))]
    #[token("SEGMENTO", priority = 20, ignore(case))]
    Network,

    #[regex(r"[0-9][0-9_]*(\.[0-9][0-9_]*)?([eE][+-]?[0-9]+|[ \t]+[eE][+-][0-9]+)?")]
    Number,
    #[regex(r"([A-Za-z][0-9A-Za-z_]*#[+-]?)?[0-9][0-9A-Za-z_]*#[0-9A-Za-z_]+(\.[0-9A-Za-z_]+)*")]
    #[regex(r"[A-Za-z][0-9A-Za-z_]*#[+-]?[0-9][0-9A-Za-z_]*([.+-][0-9A-Za-z_]+)*")]
    #[regex(r"[A-Za-z]+#\([0-9A-Za-z#, \t]*\)")]
    #[regex(r"#[0-9]+")]
    Constant,
    #[token("P#", ignore(case))]
    Pointer,
    #[regex(r"'([^'$\r\n]|\$[^\r\n])*'")]
    CharString,
    #[regex(r#""[^"\r\n]*""#)]
    #[regex(r"«[^»\r\n]*»")]
    #[regex(r"“[^”\r\n]*”")]
    QuotedSymbol,
    /// To the end of the line.
    #[regex(r#""[^"\r\n]*"#)]
    #[regex(r"«[^»\r\n]*")]
    #[regex(r"“[^”\r\n]*")]
    #[regex(r"'([^'$\r\n]|\$[^\r\n])*")]
    Unclosed,
    #[regex(
        r"#[A-Za-z_\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{24F}\u{370}-\u{52F}\u{4E00}-\u{9FFF}][0-9A-Za-z_\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{24F}\u{370}-\u{52F}\u{4E00}-\u{9FFF}]*"
    )]
    #[regex(r##"#"[^"\r\n]*""##)]
    LocalName,
    #[token("{", attribute)]
    Attribute,

    #[regex(r"(==|<>|>=|<=|>|<|\+|-|\*|/)[IDRidr]")]
    #[regex(r"\+[aA][rR][12]")]
    // A status bit as an operand: `U >=0`.
    #[regex(r"(==|<>|>=|<=|>|<)[ \t]*0")]
    #[token("==")]
    Operator,
    #[token("!")]
    Bang,
    #[token("%")]
    Percent,
    #[token(":")]
    Colon,
    #[token(";")]
    Semicolon,
    #[token(",")]
    Comma,
    #[token(".")]
    Dot,
    #[token("..")]
    DotDot,
    #[regex(r"\.\.\.+")]
    #[regex("…+")]
    Dots,
    #[token("(")]
    LParen,
    #[token(")")]
    RParen,
    #[token("[")]
    LBrack,
    #[token("]")]
    RBrack,
    #[token("}")]
    RBrace,
    #[token(":=")]
    Assign,
    #[token("=")]
    Eq,
    #[token("<>")]
    Ne,
    #[token("<")]
    Lt,
    #[token("<=")]
    Le,
    #[token(">")]
    Gt,
    #[token(">=")]
    Ge,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("*")]
    Star,
    #[token("/")]
    Slash,
    #[token("#")]
    Hash,
}

/// Keeps the search for closing delimiters linear.
#[derive(Default)]
struct Extras {
    /// No `}` follows, as an earlier search found.
    no_brace: bool,
}

/// Extends the token to the `*)`; whether there is one.
fn block_comment(lexer: &mut logos::Lexer<'_, Lexeme>) -> bool {
    let rest = lexer.remainder();
    let length = comment_length(rest);
    lexer.bump(length.unwrap_or(rest.len()));
    length.is_some()
}

fn attribute(lexer: &mut logos::Lexer<'_, Lexeme>) -> Option<()> {
    if lexer.extras.no_brace {
        return None;
    }
    match memchr::memchr(b'}', lexer.remainder().as_bytes()) {
        Some(end) => {
            lexer.bump(end + 1);
            Some(())
        }
        None => {
            lexer.extras.no_brace = true;
            None
        }
    }
}

/// Splits a unit into tokens, whose lengths add up to the text.
pub(super) fn lex(text: &str) -> Tokens {
    let mut out = Tokens::with_capacity(text.len() / 3);
    let mut lexer = Lexeme::lexer(text);
    // Whether the next token starts an instruction: `L 5` is one, `L L 5` has one.
    let mut at_start = true;
    // Between the keyword of a block and its declarations `NAME : text` is free text.
    let mut in_header = false;
    while let Some(lexeme) = lexer.next() {
        let kind = match lexeme {
            Ok(Lexeme::Blanks) => {
                out.push(SyntaxKind::Whitespace, lexer.slice().len());
                continue;
            }
            Ok(Lexeme::Newline) => {
                at_start = true;
                out.push(SyntaxKind::Newline, lexer.slice().len());
                continue;
            }
            Ok(Lexeme::LineComment | Lexeme::BlockComment(true)) => {
                out.push(SyntaxKind::Comment, lexer.slice().len());
                at_start |= begin_line(&mut out, &mut lexer);
                continue;
            }
            Ok(Lexeme::BlockComment(false)) => {
                out.push(SyntaxKind::UnclosedComment, lexer.slice().len());
                continue;
            }
            Ok(Lexeme::Word) if at_start => SyntaxKind::Ident,
            Ok(Lexeme::Word) => match address_rest(lexer.slice().as_bytes(), lexer.remainder().as_bytes()) {
                Some(rest) => {
                    lexer.bump(rest);
                    SyntaxKind::Address
                }
                None => SyntaxKind::Ident,
            },
            Ok(Lexeme::Title) => {
                out.push(SyntaxKind::Ident, lexer.slice().len());
                free_text(&mut out, &mut lexer, b'=', line_end);
                at_start = begin_line(&mut out, &mut lexer);
                continue;
            }
            Ok(Lexeme::HeaderKey) if in_header => {
                out.push(SyntaxKind::Ident, lexer.slice().len());
                free_text(&mut out, &mut lexer, b':', value_end);
                at_start = false;
                continue;
            }
            Ok(Lexeme::Network) => {
                out.push(SyntaxKind::Ident, lexer.slice().len());
                let numbered = skip_blanks(lexer.remainder().as_bytes(), 0);
                let digits = count_digits(lexer.remainder().as_bytes(), numbered);
                if digits > 0 {
                    out.push(SyntaxKind::Whitespace, numbered);
                    out.push(SyntaxKind::Number, digits);
                    lexer.bump(numbered + digits);
                    free_text(&mut out, &mut lexer, b':', line_end);
                }
                begin_line(&mut out, &mut lexer);
                in_header = false;
                at_start = true;
                continue;
            }
            Ok(Lexeme::BlockKeyword) => {
                let rest = lexer.remainder().as_bytes();
                in_header |= at_start && rest.get(skip_blanks(rest, 0)) != Some(&b':');
                SyntaxKind::Ident
            }
            Ok(Lexeme::HeaderKey) => SyntaxKind::Ident,
            Ok(Lexeme::Declarations) => {
                in_header = false;
                SyntaxKind::Ident
            }
            Ok(Lexeme::Begin) => {
                in_header = false;
                out.push(SyntaxKind::Ident, lexer.slice().len());
                at_start = true;
                continue;
            }
            Ok(Lexeme::Number) => SyntaxKind::Number,
            Ok(Lexeme::Constant) => {
                let (word, rest) = (lexer.slice().as_bytes(), lexer.remainder().as_bytes());
                if word[0].eq_ignore_ascii_case(&b'p') && word[1] == b'#' {
                    let pointer = pointer_rest(&text.as_bytes()[lexer.span().start + 2..]);
                    let more = (pointer.unwrap_or(0) + 2).saturating_sub(word.len());
                    lexer.bump(more);
                    SyntaxKind::PointerConstant
                } else {
                    let more = if is_clock(word) { clock_rest(rest) } else { 0 };
                    lexer.bump(more);
                    SyntaxKind::TypedConstant
                }
            }
            Ok(Lexeme::Pointer) => {
                let more = pointer_rest(lexer.remainder().as_bytes()).unwrap_or(0);
                lexer.bump(more);
                SyntaxKind::PointerConstant
            }
            Ok(Lexeme::CharString) => SyntaxKind::CharString,
            Ok(Lexeme::QuotedSymbol) => SyntaxKind::QuotedSymbol,
            Ok(Lexeme::LocalName) => SyntaxKind::LocalName,
            Ok(Lexeme::Attribute) => SyntaxKind::Attribute,
            Ok(Lexeme::Operator) => SyntaxKind::Operator,
            Ok(Lexeme::Dots) if at_start => {
                let rest = lexer.remainder();
                let line = line_end(rest.as_bytes());
                let end = memchr::memmem::find(&rest.as_bytes()[..line], b"//").unwrap_or(line);
                lexer.bump(rest[..end].trim_end_matches([' ', '\t']).len());
                SyntaxKind::Elision
            }
            Ok(Lexeme::Dots | Lexeme::Unclosed) | Err(()) => {
                out.push(SyntaxKind::Unknown, lexer.slice().len());
                at_start = false;
                continue;
            }
            Ok(Lexeme::Semicolon) => {
                out.push(SyntaxKind::Semicolon, 1);
                at_start = true;
                let (blanks, _) = out.push_blanks(lexer.remainder());
                lexer.bump(blanks);
                continue;
            }
            Ok(Lexeme::Colon) => {
                out.push(SyntaxKind::Colon, 1);
                at_start = true;
                continue;
            }
            Ok(Lexeme::LParen) => {
                out.push(SyntaxKind::LParen, 1);
                at_start = true;
                continue;
            }
            Ok(Lexeme::Bang) => SyntaxKind::Bang,
            Ok(Lexeme::Percent) => SyntaxKind::Percent,
            Ok(Lexeme::Comma) => SyntaxKind::Comma,
            Ok(Lexeme::Dot) => SyntaxKind::Dot,
            Ok(Lexeme::DotDot) => SyntaxKind::DotDot,
            Ok(Lexeme::RParen) => SyntaxKind::RParen,
            Ok(Lexeme::LBrack) => SyntaxKind::LBrack,
            Ok(Lexeme::RBrack) => SyntaxKind::RBrack,
            Ok(Lexeme::RBrace) => SyntaxKind::RBrace,
            Ok(Lexeme::Assign) => SyntaxKind::Assign,
            Ok(Lexeme::Eq) => SyntaxKind::Eq,
            Ok(Lexeme::Ne) => SyntaxKind::Ne,
            Ok(Lexeme::Lt) => SyntaxKind::Lt,
            Ok(Lexeme::Le) => SyntaxKind::Le,
            Ok(Lexeme::Gt) => SyntaxKind::Gt,
            Ok(Lexeme::Ge) => SyntaxKind::Ge,
            Ok(Lexeme::Plus) => SyntaxKind::Plus,
            Ok(Lexeme::Minus) => SyntaxKind::Minus,
            Ok(Lexeme::Star) => SyntaxKind::Star,
            Ok(Lexeme::Slash) => SyntaxKind::Slash,
            Ok(Lexeme::Hash) => SyntaxKind::Hash,
        };
        out.push(kind, lexer.slice().len());
        let (blanks, begins_line) = out.push_blanks(lexer.remainder());
        lexer.bump(blanks);
        at_start = begins_line;
    }
    out
}

/// The line feed behind a token, if code goes on behind it.
fn begin_line(out: &mut Tokens, lexer: &mut logos::Lexer<'_, Lexeme>) -> bool {
    let is_end = matches!(lexer.remainder().as_bytes(), [b'\n' | b'\r', ..]);
    let (blanks, begins_line) = if is_end { out.push_blanks(lexer.remainder()) } else { (0, false) };
    lexer.bump(blanks);
    begins_line
}

/// After a keyword: if `separator` follows on the line, the separator and the text after it.
fn free_text(out: &mut Tokens, lexer: &mut logos::Lexer<'_, Lexeme>, separator: u8, end: fn(&[u8]) -> usize) {
    let rest = lexer.remainder();
    let bytes = rest.as_bytes();
    let at = skip_blanks(bytes, 0);
    let assigns = separator == b':' && bytes.get(at + 1) == Some(&b'=');
    if bytes.get(at) != Some(&separator) || assigns {
        return;
    }
    let start = skip_blanks(bytes, at + 1);
    let text = rest[start..start + end(&bytes[start..])].trim_end_matches([' ', '\t']);
    out.push(SyntaxKind::Whitespace, at);
    out.push(if separator == b':' { SyntaxKind::Colon } else { SyntaxKind::Eq }, 1);
    out.push(SyntaxKind::Whitespace, start - at - 1);
    out.push(SyntaxKind::FreeText, text.len());
    lexer.bump(start + text.len());
}

/// The value of AUTHOR, FAMILY, NAME and VERSION ends before a comment, a `;` and what else a header on one line has.
/// Reads no further than that: a line can have any number of them.
fn value_end(bytes: &[u8]) -> usize {
    const KEYS: [&str; 4] = ["AUTHOR", "FAMILY", "NAME", "VERSION"];
    const FLAGS: [&str; 13] = [
        "KNOW_HOW_PROTECT",
        "STANDARD",
        "UNLINKED",
        "READ_ONLY",
        "NON_RETAIN",
        "VAR",
        "VAR_INPUT",
        "VAR_OUTPUT",
        "VAR_IN_OUT",
        "VAR_TEMP",
        "STRUCT",
        "BEGIN",
        "NETWORK",
    ];
    if let [b'\'', rest @ ..] = bytes {
        let end = memchr::memchr3(b'\'', b'\n', b'\r', rest).unwrap_or(rest.len());
        return 1 + end + usize::from(rest.get(end) == Some(&b'\''));
    }
    let mut at = 0;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'\n' | b'\r' | b';' | b'{' => return at,
            b'/' if bytes.get(at + 1) == Some(&b'/') => return at,
            b' ' | b'\t' => {
                let start = skip_blanks(bytes, at);
                let len = bytes[start..].iter().take_while(|it| it.is_ascii_alphanumeric() || **it == b'_').count();
                let is_next = |it: &&str| it.as_bytes().eq_ignore_ascii_case(&bytes[start..start + len]);
                let has_value = bytes.get(skip_blanks(bytes, start + len)) == Some(&b':');
                if (has_value && KEYS.iter().any(is_next)) || FLAGS.iter().any(is_next) {
                    return at;
                }
                at = start + len;
            }
            _ => at += 1,
        }
    }
    at
}

/// A title is all of its line.
fn line_end(bytes: &[u8]) -> usize {
    memchr::memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len())
}

fn skip_blanks(bytes: &[u8], from: usize) -> usize {
    let blanks = bytes.get(from..).map_or(0, |it| it.iter().take_while(|it| matches!(it, b' ' | b'\t')).count());
    from + blanks
}

fn count_digits(bytes: &[u8], from: usize) -> usize {
    bytes.get(from..).map_or(0, |it| it.iter().take_while(|it| it.is_ascii_digit()).count())
}

/// Whether the letters name a memory area, a block kind, timers or counters in either mnemonic set.
pub(super) fn is_area(word: &[u8]) -> bool {
    let mut lower = [0; 3];
    let Some(lower) = lower.get_mut(..word.len()) else { return false };
    lower.copy_from_slice(word);
    lower.make_ascii_lowercase();
    matches!(
        lower,
        [b'm' | b'e' | b'a' | b'i' | b'q' | b'l' | b't' | b'z' | b'c']
            | [b'm' | b'e' | b'a' | b'i' | b'q' | b'l', b'b' | b'w' | b'd']
            | [b'd', b'b' | b'i']
            | [b'f', b'b' | b'c']
            | [b'o', b'b']
            | [b'p', b'e' | b'a' | b'i' | b'q']
            | [b'p', b'e' | b'a' | b'i' | b'q', b'b' | b'w' | b'd']
            | [b'd', b'b' | b'i', b'x' | b'b' | b'w' | b'd']
            | [b's', b'f', b'b' | b'c']
            | [b'u', b'd', b't']
    )
}

/// How many bytes of `rest` complete `word` to an absolute operand; `None` if it is none.
fn address_rest(word: &[u8], rest: &[u8]) -> Option<usize> {
    if word.len() > 9 {
        return None;
    }
    let letters = word.iter().take_while(|it| it.is_ascii_alphabetic()).count();
    if !is_area(&word[..letters]) {
        return None;
    }
    let mut at = 0;
    if letters == word.len() {
        let digits = skip_blanks(rest, 0);
        at = digits + count_digits(rest, digits);
        if at == digits {
            return None;
        }
    } else if !word[letters..].iter().all(u8::is_ascii_digit) {
        return None;
    }
    if rest.get(at) == Some(&b'.') {
        let fraction = count_digits(rest, at + 1);
        if fraction > 0 {
            at += 1 + fraction;
        } else if letters == 2 && matches!(word[0], b'd' | b'D') {
            at = db_element(rest, at).unwrap_or(at);
        }
    }
    // `T 5x`, `C 16#FF`: not an address.
    match rest.get(at) {
        Some(next) if next.is_ascii_alphanumeric() || matches!(next, b'_' | b'#') || *next >= 0x80 => None,
        _ => Some(at),
    }
}

/// End of `.DBW 10` or `.DBX0.0` at `dot`.
fn db_element(bytes: &[u8], dot: usize) -> Option<usize> {
    let [b'd' | b'D', b'b' | b'B' | b'i' | b'I', width] = *bytes.get(dot + 1..dot + 4)? else { return None };
    if !matches!(width.to_ascii_lowercase(), b'x' | b'b' | b'w' | b'd') {
        return None;
    }
    let digits = skip_blanks(bytes, dot + 4);
    let mut at = digits + count_digits(bytes, digits);
    if at == digits {
        return None;
    }
    if bytes.get(at) == Some(&b'.') {
        let fraction = count_digits(bytes, at + 1);
        at += if fraction > 0 { 1 + fraction } else { 0 };
    }
    Some(at)
}

/// How much of `bytes`, which follow `P#`, is an absolute pointer: `0.0`, `M 0.0`, `DB1.DBX 0.0 BYTE 10`.
fn pointer_rest(bytes: &[u8]) -> Option<usize> {
    let mut at = skip_blanks(bytes, 0);
    let letters =
        |from: usize| bytes.get(from..).map_or(0, |it| it.iter().take_while(|it| it.is_ascii_alphabetic()).count());
    let number = |from: usize| {
        let digits = count_digits(bytes, from);
        let fraction = match bytes.get(from + digits) {
            Some(b'.') => count_digits(bytes, from + digits + 1),
            _ => 0,
        };
        (digits > 0).then_some(from + digits + if fraction > 0 { fraction + 1 } else { 0 })
    };
    let area = letters(at);
    if area > 3 {
        return None;
    }
    if area > 0 {
        let word = &bytes[at..at + area];
        if !is_area(word) && !matches!(word, [b'p' | b'P' | b'v' | b'V']) {
            return None;
        }
    }
    at = number(skip_blanks(bytes, at + area))?;
    if area == 2 && bytes.get(at) == Some(&b'.') {
        at = db_element(bytes, at)?;
    }
    if matches!(bytes.get(at), Some(b'_' | b'#' | b'a'..=b'z' | b'A'..=b'Z')) {
        return None;
    }
    // The repetition of an ANY pointer.
    let unit = skip_blanks(bytes, at);
    let len = bytes[unit..].iter().take_while(|it| it.is_ascii_alphanumeric() || **it == b'_').count();
    if unit > at && is_repetition(&bytes[unit..unit + len]) {
        let count = skip_blanks(bytes, unit + len);
        let digits = count_digits(bytes, count);
        if digits > 0 {
            return Some(count + digits);
        }
    }
    Some(at)
}

fn is_repetition(word: &[u8]) -> bool {
    const UNITS: [&str; 19] = [
        "BOOL",
        "BYTE",
        "CHAR",
        "WORD",
        "INT",
        "DWORD",
        "DINT",
        "REAL",
        "DATE",
        "TIME",
        "S5TIME",
        "TOD",
        "TIME_OF_DAY",
        "DT",
        "DATE_AND_TIME",
        "STRING",
        "TIMER",
        "COUNTER",
        "VOID",
    ];
    UNITS.iter().any(|it| it.as_bytes().eq_ignore_ascii_case(word))
}

/// Whether a constant has a time of day, whose colons continue it.
fn is_clock(constant: &[u8]) -> bool {
    const PREFIXES: [&str; 4] = ["TOD#", "TIME_OF_DAY#", "DT#", "DATE_AND_TIME#"];
    PREFIXES.iter().any(|it| constant.get(..it.len()).is_some_and(|head| head.eq_ignore_ascii_case(it.as_bytes())))
}

/// Extent of `:12:25.356`; blanks around the colons come from scanned documents (S7:1301).
fn clock_rest(bytes: &[u8]) -> usize {
    let mut end = 0;
    loop {
        let colon = skip_blanks(bytes, end);
        if bytes.get(colon) != Some(&b':') {
            return end;
        }
        let digits = skip_blanks(bytes, colon + 1);
        let len = count_digits(bytes, digits);
        if len == 0 {
            return end;
        }
        end = digits + len;
        if bytes.get(end) == Some(&b'.') {
            let fraction = count_digits(bytes, end + 1);
            end += if fraction > 0 { fraction + 1 } else { 0 };
        }
    }
}

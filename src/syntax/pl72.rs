//! PL7-2: the lexer of its networks and charts. The grammar is that of PL7's.
//!
//! An address with its commas, string length or index is one token, whether there is such an object or not: `I0,05`,
//! `W5(W10)`, `B0[16]`, `D1,W3`. So is `%MW10.X4`, which a program converted by hand may keep.

use logos::{Lexer, Logos};

use super::SyntaxKind;
use super::memo::{Memo, Pieces};
use super::tokens::{Tokens, comment_length};

#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq)]
enum Lexeme {
    #[regex(r"[ \t\x0B\x0C\u{85}\u{A0}\u{1680}\u{2000}-\u{200B}\u{2028}\u{2029}\u{202F}\u{205F}\u{3000}\u{FEFF}]+")]
    Whitespace,
    // With the blanks and line breaks that follow: a token less a line.
    #[regex(
        r"[\r\n][ \t\r\n\x0B\x0C\u{85}\u{A0}\u{1680}\u{2000}-\u{200B}\u{2028}\u{2029}\u{202F}\u{205F}\u{3000}\u{FEFF}]*"
    )]
    Newline,
    #[token("(*", comment)]
    Comment,
    UnclosedComment,
    #[token("*)")]
    Unknown,
    SentenceStart,
    SentenceEnd,

    // Words: operations (PL72:1022-1053) and those of the form around the blocks.
    #[regex(
        r"[A-Za-z_\u{AA}\u{B5}\u{BA}\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{2AF}\u{370}-\u{52F}][A-Za-z0-9_\u{AA}\u{B5}\u{BA}\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{2AF}\u{300}-\u{52F}]*"
    )]
    // `SLC3`, `SRC3` as PL72:1964 prints them: an operation and its number of bits.
    #[regex(r"(?i:SLC|SRC)[0-9]+", priority = 40)]
    Ident,
    #[regex(r"[0-9]+")]
    Number,
    // PL72:981-983. The closing quote may be missing: the grammar says so.
    #[regex(r"[LlHhMm]'[^'\r\n]*'?")]
    TypedConstant,
    // Names of the form around the program: `PROGRAM MAST 'Chart'`.
    #[regex(r"'[^'\r\n]*'?")]
    CharString,
    #[regex(r"%?[A-Za-z][A-Za-z]?[A-Za-z]?[0-9]+", address, priority = 20)]
    #[regex(r"(?i:FC|DT|DTP)", address, priority = 20)]
    ObjectAddress,
    #[regex(r"%?[Ll][0-9]+", priority = 30)]
    LabelAddress,
    #[regex(r"(\.|\u{2026})([ \t\u{A0}]*(\.|\u{2026}))+|\u{2026}")]
    Elision,

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
    #[token("(")]
    LParen,
    #[token(")")]
    RParen,
    #[token("[")]
    LBrack,
    #[token("]")]
    RBrack,
    #[token(":=")]
    Assign,
    #[token("=")]
    Eq,
    #[token("<>")]
    Ne,
    #[token("<")]
    Lt,
    // PL72:957 prints a blank inside.
    #[regex(r"<[ \t]*=")]
    Le,
    #[token(">")]
    Gt,
    #[regex(r">[ \t]*=")]
    Ge,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("*")]
    Star,
    #[token("/")]
    Slash,
    #[regex(r"-->|->|\u{2192}")]
    Arrow,
}

macro_rules! same_names {
    ($($name:ident)*) => {
        impl From<Lexeme> for SyntaxKind {
            fn from(lexeme: Lexeme) -> Self {
                match lexeme { $(Lexeme::$name => Self::$name),* }
            }
        }
    };
}

same_names! {
    Whitespace Newline Comment UnclosedComment Unknown SentenceStart SentenceEnd Ident Number TypedConstant CharString
    ObjectAddress LabelAddress Elision Bang Percent Colon Semicolon Comma Dot LParen RParen LBrack RBrack Assign Eq Ne Lt Le Gt Ge Plus Minus Star Slash Arrow
}

/// A comment ends at the first `*)`.
fn comment(lexer: &mut Lexer<'_, Lexeme>) -> Lexeme {
    let rest = lexer.remainder();
    match comment_length(rest) {
        Some(length) => {
            lexer.bump(length);
            let inner = rest.get(..length - 2).unwrap_or_default();
            if inner.eq_ignore_ascii_case("PHRASE") {
                Lexeme::SentenceStart
            } else if inner.eq_ignore_ascii_case("END_PHRASE") {
                Lexeme::SentenceEnd
            } else {
                Lexeme::Comment
            }
        }
        None => {
            lexer.bump(rest.len());
            Lexeme::UnclosedComment
        }
    }
}

/// Whether these are the letters before the number of an object: of PL7-2 (PL72:253-310), then those that PL7 gives to
/// the same objects.
fn are_object_letters(letters: &[u8]) -> bool {
    let mut upper = [0; 3];
    let Some(upper) = upper.get_mut(..letters.len()) else { return false };
    upper.copy_from_slice(letters);
    upper.make_ascii_uppercase();
    matches!(
        &*upper,
        [b'I' | b'O' | b'B' | b'X' | b'S' | b'W' | b'T' | b'C' | b'M' | b'R' | b'D' | b'E' | b'A' | b'Q' | b'K']
            | b"SY"
            | b"CW"
            | b"SW"
            | b"COM"
            | b"IW"
            | b"OW"
            | b"FC"
            | b"DT"
            | b"DTP"
            | b"TXT"
            | b"MW"
            | b"KW"
            | b"QW"
            | b"MB"
            | b"KB"
            | b"ID"
            | b"QD"
            | b"MD"
            | b"KD"
            | b"TM"
            | b"MN"
            | b"DR"
            | b"XM"
    )
}

/// Whether a word starts an address. Letters that are PL7's or the other vendor's alone need an item behind, for names of
/// actions look like them: `A1`.
fn is_object(word: &str, rest: &str) -> bool {
    let letters = word.trim_end_matches(|it: char| it.is_ascii_digit()).as_bytes();
    let is_foreign = matches!(letters, [b'E' | b'e' | b'A' | b'a' | b'Q' | b'q' | b'K' | b'k']);
    word.starts_with('%')
        || are_object_letters(letters)
            && (!is_foreign || matches!(rest.as_bytes(), [b',' | b'.', digit, ..] if digit.is_ascii_digit()))
}

/// Takes what belongs to an address after its number: at most two items, then a length or an index.
///
/// A comma also separates the cells of a network, so an item is taken only where it is a whole word that can be one.
fn address(lexer: &mut Lexer<'_, Lexeme>) -> Lexeme {
    if !is_object(lexer.slice(), lexer.remainder()) {
        return Lexeme::Ident;
    }
    let is_drum = matches!(lexer.slice().as_bytes(), [b'D' | b'd', digit, ..] if digit.is_ascii_digit());
    let rest = lexer.remainder().as_bytes();
    let mut end = 0;
    for _ in 0..2 {
        let Some((separator @ (b',' | b'.' | b':'), tail)) = rest.get(end..).and_then(<[u8]>::split_first) else {
            break;
        };
        // The steps of `FROM (X1,X2)` are two.
        let is_pl7 = *separator != b',';
        let length = tail.iter().take_while(|it| it.is_ascii_alphanumeric() || **it == b'_').count();
        let is_item = match tail.get(..length).unwrap_or_default() {
            [_] | [b'0'..=b'9', b'0'..=b'9'] => true,
            [b'X' | b'x', b'0'..=b'9'] | [b'X' | b'x', b'0'..=b'9', b'0'..=b'9'] => is_pl7,
            [b'W' | b'w', digits @ ..] => is_drum && digits.len() < 3 && digits.iter().all(u8::is_ascii_digit),
            _ => false,
        };
        if !is_item {
            break;
        }
        end += 1 + length;
    }
    let close = match rest.get(end) {
        Some(b'[') => b']',
        Some(b'(') => b')',
        _ => 0,
    };
    if close != 0 {
        let inner = rest.get(end + 1..).unwrap_or_default();
        let length = inner.iter().take_while(|it| it.is_ascii_alphanumeric()).count();
        // Of `O1,3(S)` in a chart, the qualifier is none; of `W5(10)`, the index is no address.
        let is_word = matches!(inner.first(), Some(b'W' | b'w' | b'0'..=b'9' | b'C' | b'c' | b'B' | b'b'))
            && inner.get(length.wrapping_sub(1)).is_some_and(u8::is_ascii_digit);
        if (close == b']' || is_word) && length > 0 && inner.get(length) == Some(&close) {
            end += length + 2;
        }
    }
    lexer.bump(end);
    Lexeme::ObjectAddress
}

/// The tokens of the content of a block. Their lengths add up to the text, for every text.
pub(super) fn lex(text: &str, pieces: Option<Pieces>, memo: &mut Memo) -> Tokens {
    Tokens::of_pl7::<Lexeme>(text, pieces, memo, |_, _| 0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::syntax::tokens::Token;
    use SyntaxKind::*;

    fn lex(text: &str) -> Tokens {
        super::lex(text, Some(Pieces::Pl72Ld), &mut Memo::for_text(text))
    }

    fn kinds(text: &str) -> Vec<SyntaxKind> {
        lex(text).iter().map(|it| it.kind).filter(|it| *it != Whitespace).collect()
    }

    /// Every form of address of PL72:253-310 and of the pages of the blocks is one token.
    #[test]
    fn addresses_are_one_token() {
        for text in [
            "I0,05", "O1,3", "I01,B", "O17,F", "O2,S", "S1,3", "B12", "B5[10]", "O0,00[8]", "I1,0[16]", "SY21", "X3",
            "X3,V", "W5", "W5,A", "W0[60]", "W5(W10)", "CW10(W0)", "CW7,F", "SW16", "COM2,1", "COM2,1,A", "IW1,3",
            "IW01,3,F", "T0", "T0,P", "C1,E", "M2,R", "R0,F", "D1,F", "D1,W15", "TXT0,L", "FC", "FC,P", "DT", "DTP",
            "w5(w10)", "%MW10.X4", "%M5", "I0.05", "W5:X12", "T0.D",
        ] {
            let len = u32::try_from(text.len()).unwrap();
            assert_eq!(lex(text).iter().collect::<Vec<_>>(), [Token { kind: ObjectAddress, len }], "{text}");
        }
    }

    #[test]
    fn what_is_no_part_of_an_address() {
        assert_eq!(kinds("B5,H_LINK(2)"), [ObjectAddress, Comma, Ident, LParen, Number, RParen]);
        assert_eq!(kinds("W1,W2"), [ObjectAddress, Comma, ObjectAddress]);
        assert_eq!(kinds("I0,05),COIL(B1)"), [ObjectAddress, RParen, Comma, Ident, LParen, ObjectAddress, RParen]);
        assert_eq!(kinds("COM1,2,3,4"), [ObjectAddress, Comma, Number]);
        assert_eq!(kinds("W5(W1 + 2)"), [ObjectAddress, LParen, ObjectAddress, Plus, Number, RParen]);
        assert_eq!(kinds("W5 (W1)"), [ObjectAddress, LParen, ObjectAddress, RParen]);
        assert_eq!(kinds("W5()"), [ObjectAddress, LParen, RParen]);
        assert_eq!(kinds("B5x FCX DTA T"), [Ident, Ident, Ident, Ident]);
        assert_eq!(kinds("W5:=3"), [ObjectAddress, Assign, Number]);
        assert_eq!(kinds("(X1,X2)"), [LParen, ObjectAddress, Comma, ObjectAddress, RParen]);
        assert_eq!(
            kinds("O1,3(S) B5(N1)"),
            [ObjectAddress, LParen, Ident, RParen, ObjectAddress, LParen, Ident, RParen]
        );
        assert_eq!(kinds("A1(N) E1,0 Q2.3"), [Ident, LParen, Ident, RParen, ObjectAddress, ObjectAddress]);
        assert_eq!(kinds("N1 P0 PL7 EVT3 AB5 SR1"), [Ident; 6]);
        assert_eq!(kinds("'Chart' MAST'PRL'"), [CharString, Ident, CharString]);
        assert_eq!(kinds("(*PHRASE*) B1 (*END_PHRASE*) ..."), [SentenceStart, ObjectAddress, SentenceEnd, Elision]);
        assert_eq!(kinds("L10: %L999"), [LabelAddress, Colon, LabelAddress]);
    }

    /// The examples of PL72:1023-1109.
    #[test]
    fn operations() {
        let operation = [ObjectAddress, Plus, ObjectAddress, Arrow, ObjectAddress];
        for text in ["W1 + W2 -> W3", "W1+W2->W3", "W1 + W2 → W3", "W1 + W2 --> W3"] {
            assert_eq!(kinds(text), operation, "{text}");
        }
        assert_eq!(kinds("127 -> W10"), [Number, Arrow, ObjectAddress]);
        assert_eq!(kinds("-5 -> T1,P"), [Minus, Number, Arrow, ObjectAddress]);
        for text in ["I1,0[16] -> W4(W50)", "W512[60] -> W0[60]", "CW10(W0) -> W10(W1)", "W3->O4,5[5]"] {
            assert_eq!(kinds(text), [ObjectAddress, Arrow, ObjectAddress], "{text}");
        }
        for (text, sign) in [("*", Star), ("/", Slash), ("-", Minus), ("REM", Ident), ("XOR", Ident)] {
            let text = format!("W1 {text} H'524D' -> OW1,3");
            assert_eq!(kinds(&text), [ObjectAddress, sign, TypedConstant, Arrow, ObjectAddress], "{text}");
        }
        assert_eq!(kinds("BTA W0 -> W10"), [Ident, ObjectAddress, Arrow, ObjectAddress]);
        assert_eq!(kinds("SLC 3 W1 -> W1"), [Ident, Number, ObjectAddress, Arrow, ObjectAddress]);
        assert_eq!(kinds("src15 W1->W1"), [Ident, ObjectAddress, Arrow, ObjectAddress]);
        assert_eq!(kinds("L'1010' M'MR' h'5' L'1"), [TypedConstant; 4]);
    }

    /// PL72:957.
    #[test]
    fn comparisons() {
        for (sign, kind) in
            [(">", Gt), ("<", Lt), ("=", Eq), (">=", Ge), ("> =", Ge), ("<=", Le), ("< =", Le), ("<>", Ne)]
        {
            assert_eq!(kinds(&format!("W5 {sign} 10")), [ObjectAddress, kind, Number], "{sign}");
        }
    }

    #[test]
    fn comments_and_unknown_characters() {
        assert_eq!(kinds("(* a (* b *) W1"), [Comment, ObjectAddress]);
        assert_eq!(kinds("W1 (* open"), [ObjectAddress, UnclosedComment]);
        assert_eq!(kinds("§§ \"\r\n*)"), [Unknown, Unknown, Newline, Unknown]);
    }

    proptest! {
        #[test]
        fn tokens_tile_the_text(text in r"([IOBWCTMRDX%L][0-9]{1,3}|[,.:()\[\]'W]|[a-zé→]|->|\(\*|\*\)| |\n|\PC){0,24}") {
            let tokens = lex(&text);
            let mut at = 0;
            for token in tokens.iter() {
                prop_assert!(token.len > 0);
                at += token.len as usize;
                prop_assert!(text.is_char_boundary(at));
            }
            prop_assert_eq!(at, text.len());
        }
    }
}

//! One lexer for instruction list and structured text.
//!
//! Tokens are coarse: a direct object is one token whatever it addresses, because the time of a parse goes by the token.
//! What an address means, and whether the controller has it, is not the lexer's affair: `%I.5` is one token too.

use logos::{Lexer, Logos};

use crate::syntax::SyntaxKind;
use crate::syntax::memo::{Memo, Pieces};
use crate::syntax::tokens::{Tokens, comment_length};

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
    // The end of a comment that has ended before: `(* a (* b *) c *)`.
    #[token("*)")]
    Unknown,
    SentenceStart,
    SentenceEnd,

    // Letters of symbols (PL7:1198-1207): those of Latin-1 and of the other code pages that texts are decoded from.
    #[regex(
        r"[A-Za-z_\u{AA}\u{B5}\u{BA}\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{2AF}\u{370}-\u{52F}][A-Za-z0-9_\u{AA}\u{B5}\u{BA}\u{C0}-\u{D6}\u{D8}-\u{F6}\u{F8}-\u{2AF}\u{300}-\u{52F}]*"
    )]
    Ident,
    #[regex(r"[0-9][0-9_]*(\.[0-9]+)?([eE][+-]?[0-9]+)?")]
    Number,
    #[regex(r"[0-9]+#[0-9A-Za-z_]+")]
    #[regex(r"[A-Za-z][A-Za-z_]*#-?[0-9A-Za-z_.]+")]
    #[regex(r"(?i:D|DATE|TOD|TIME_OF_DAY|DT|DATE_AND_TIME)#[0-9][0-9_.:\-]*", priority = 100)]
    #[regex(r"(?i:ADR)#[0-9A-Za-z_.{}\\]+", priority = 101)]
    TypedConstant,
    // The closing quote may be missing: the grammar says so, and the line ends the text.
    #[regex(r"'([^'$\r\n]|\$[^\r\n])*'?")]
    CharString,

    // `\` separates the connection point of FIPIO (PL7:748) and the slave of AS-i (PL7:826), `{}` the network and
    // station of a common word (PL7:912); `:` opens a length (PL7:1010) or an extracted bit (PL7:638).
    #[regex(r"%[A-KM-Za-km-z][A-Za-z0-9]*(\{[0-9.]*\}[A-Za-z0-9]*)?([.\\][A-Za-z0-9]+)*(:[Xx]?[0-9]+)?")]
    ObjectAddress,
    #[regex(r"%[Ll][A-Za-z0-9]*")]
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
    #[token("{")]
    LBrace,
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
    #[regex("-->|->>?|=>")]
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
    ObjectAddress LabelAddress Elision Bang Percent Colon Semicolon Comma Dot LParen RParen LBrack RBrack LBrace RBrace
    Assign Eq Ne Lt Le Gt Ge Plus Minus Star Slash Hash Arrow
}

/// A comment ends at the first `*)`, because comments do not nest (PL7:3549).
fn comment(lexer: &mut Lexer<'_, Lexeme>) -> Lexeme {
    let rest = lexer.remainder();
    let Some(length) = comment_length(rest) else {
        lexer.bump(rest.len());
        return Lexeme::UnclosedComment;
    };
    lexer.bump(length);
    let inner = &rest[..length - 2];
    if inner.eq_ignore_ascii_case("PHRASE") {
        Lexeme::SentenceStart
    } else if inner.eq_ignore_ascii_case("END_PHRASE") {
        Lexeme::SentenceEnd
    } else {
        Lexeme::Comment
    }
}

/// The lengths of the tokens add up to the text, for every text.
pub(super) fn lex(text: &str, pieces: Option<Pieces>, memo: &mut Memo) -> Tokens {
    Tokens::of_pl7::<Lexeme>(text, pieces, memo, suffix_length)
}

/// Length of what belongs to a token and only there, `:4` or `.T`: `Pump:X4`, `%MW50[%MW5]:10`.
#[inline]
fn suffix_length(before: SyntaxKind, rest: &[u8]) -> usize {
    let has_suffix = matches!(before, SyntaxKind::Ident | SyntaxKind::RBrack | SyntaxKind::Number);
    if has_suffix && matches!(rest, [b':' | b'.', ..]) { suffix(rest, before == SyntaxKind::RBrack) } else { 0 }
}

/// Length of `:10`, `:X4`, and after an index also `.T` or `.T:8`; 0 if there is none.
fn suffix(rest: &[u8], after_index: bool) -> usize {
    let mut end = 0;
    loop {
        let (first, digits_only) = match rest.get(end..) {
            Some([b':', b'X' | b'x', b'0'..=b'9', ..]) => (end + 2, true),
            Some([b':', b'0'..=b'9', ..]) => (end + 1, true),
            Some([b'.', b'0'..=b'9' | b'A'..=b'Z' | b'a'..=b'z', ..]) if after_index => (end + 1, false),
            _ => return end,
        };
        let belongs = |byte: &&u8| byte.is_ascii_digit() || !digits_only && byte.is_ascii_alphanumeric();
        end = first + rest[first..].iter().take_while(belongs).count();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::tokens::Token;
    use SyntaxKind::*;

    fn lex(text: &str) -> Tokens {
        super::lex(text, None, &mut Memo::for_text(text))
    }

    fn kinds(text: &str) -> Vec<SyntaxKind> {
        lex(text).iter().map(|it| it.kind).filter(|it| *it != Whitespace).collect()
    }

    /// Every form of address in PL7:560-1240 is one token.
    #[test]
    fn addresses_are_one_token() {
        for text in [
            "%I23.5",
            "%Q51.2",
            "%M200",
            "%S10",
            "%TM8.Q",
            "%MW10:X5",
            "%X21",
            "%X5.9",
            "%IW23.5",
            "%QW51.1",
            "%MD45",
            "%KW30",
            "%SW5",
            "%TM2.P",
            "%NW2.3",
            "%X5.T",
            "%QW5.1:X10",
            "%I.5",
            "%MW2.0.3",
            "%I5.MOD.ERR",
            "%I102.MOD.ERR",
            "%I204.3.ERR",
            r"%MW\0.2.1\0.5.2",
            r"%I\0.2.1\0.7",
            r"%Q\0.2.1\1.2",
            r"%I\0.2.2\0.MOD.ERR",
            r"%Q\1.2.3\0.0.ERR",
            r"%I3.0\2.1",
            r"%Q3.0\4.3",
            "%MF20",
            "%KD26",
            "%NW{2.3}1",
            "%KD543",
            "%DR0.W5",
            "%R0.I",
            "%M10:6",
            "%I25.1:8",
            "%X50:30",
            "%X5.3:4",
            "%KW10:5",
            "%X12.T:8",
            "%X5.2.T:8",
            "%MB10:5",
            "%XM3",
            "%X2.IN",
            "%X2.OUT.T",
            "%CH3.0",
            "%mw10:x4",
        ] {
            let len = u32::try_from(text.len()).unwrap();
            assert_eq!(lex(text).iter().collect::<Vec<_>>(), [Token { kind: ObjectAddress, len }], "{text}");
        }
        assert_eq!(kinds("%L20"), [LabelAddress]);
        assert_eq!(kinds("%MW10:=%MW2"), [ObjectAddress, Assign, ObjectAddress]);
        assert_eq!(kinds("%M20..."), [ObjectAddress, Elision]);
    }

    #[test]
    fn suffixes_follow_indices_and_names() {
        assert_eq!(kinds("%MW50[%MW5]:10"), [ObjectAddress, LBrack, ObjectAddress, RBrack, ObjectSuffix]);
        assert_eq!(kinds("%X2[3].T:8+1"), [ObjectAddress, LBrack, Number, RBrack, ObjectSuffix, Plus, Number]);
        assert_eq!(kinds("Température:12 Etat_pompe:X1"), [Ident, ObjectSuffix, Ident, ObjectSuffix]);
        assert_eq!(kinds("Pump:=5"), [Ident, Assign, Number]);
        assert_eq!(kinds("[%MW0:=1]..."), [LBrack, ObjectAddress, Assign, Number, RBrack, Elision]);
    }

    #[test]
    fn constants() {
        for text in ["2#1010", "16#AB20", "T#5s", "T#-1h20m", "D#2001-12-31", "TOD#12:30:00", "dt#2001-01-01-12:30:00"]
        {
            assert_eq!(kinds(text), [TypedConstant], "{text}");
        }
        for text in ["10", "1506", "1285.28", "12.8528E2", "1.32E12", "1e-5", "1_000"] {
            assert_eq!(kinds(text), [Number], "{text}");
        }
        assert_eq!(kinds("-5"), [Minus, Number]);
        assert_eq!(kinds("'abc$'d'"), [CharString]);
        assert_eq!(kinds("'abc\n5"), [CharString, Newline, Number]);
        assert_eq!(kinds("ADR#{1.4}SYS"), [TypedConstant]);
        assert_eq!(kinds("T#5s-3"), [TypedConstant, Minus, Number]);
    }

    #[test]
    fn comments_and_sentence_marks() {
        assert_eq!(kinds("(*PHRASE*)(* a (* b *)(*END_PHRASE*)"), [SentenceStart, Comment, SentenceEnd]);
        assert_eq!(kinds("(*)*)"), [Comment]);
        assert_eq!(kinds("(*"), [UnclosedComment]);
        assert_eq!(kinds("%M0 (* On boucle\n tant que"), [ObjectAddress, UnclosedComment]);
        assert_eq!(kinds("(* PHRASE *)"), [Comment]);
        assert_eq!(kinds("(* a (* b *) c *)"), [Comment, Ident, Unknown]);
    }

    #[test]
    fn unknown_characters_are_one_run() {
        assert_eq!(kinds("\0\0\"§\u{1F600}~"), [Unknown]);
        assert_eq!(kinds("\u{A0}\u{FEFF}%M0"), [ObjectAddress]);
        assert_eq!(kinds(". . . ."), [Elision]);
        assert_eq!(kinds("…"), [Elision]);
    }
}

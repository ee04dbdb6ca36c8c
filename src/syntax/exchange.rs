//! The blocks around the program in a PL7 exchange file, and files of variables.
//!
//! A block begins with its name in brackets and holds `KEY = value` pairs; what else it holds is kept as tokens, without
//! complaint, because the vendor has published no more than a part of the format. Declarations of variables are read.

use SyntaxKind::{
    BlockMark, CharString, Colon, Comment, Eq, ExchangeBlock, Ident, InitValue, KeyValue, ObjectAddress, ObjectRef,
    Semicolon, TypeRef, VarDecl, VarName, VarSection,
};
use logos::{Lexer, Logos};

use super::tokens::Tokens;
use super::{AstNode, Language, Memo, Parse, Parser, SyntaxKind, SyntaxNode, SyntaxToken};

#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq)]
enum Lexeme {
    #[regex(r"[ \t\x0B\x0C\u{A0}\u{FEFF}]+")]
    Whitespace,
    #[regex(r"\r\n|\n|\r")]
    Newline,
    #[token("(*", comment)]
    Comment,
    UnclosedComment,
    #[regex(r"\[[A-Za-z][A-Za-z0-9_ ]*\]")]
    BlockMark,
    // Also `MAST`, `16#FF`, `date#2024-03-01`, `V4.0` and whatever else a value is made of.
    #[regex(r"[A-Za-z_\u{AA}-\u{2AF}\u{370}-\u{52F}][A-Za-z0-9_\u{AA}-\u{52F}]*")]
    Ident,
    #[regex(r"[0-9][0-9_]*(\.[0-9]+)?")]
    Number,
    // A symbol cannot begin with a digit (PL7:1213); who declares one so shall be told.
    #[regex(r"[0-9][0-9_]*[A-Za-z_\u{AA}-\u{2AF}][A-Za-z0-9_\u{AA}-\u{52F}]*")]
    DigitWord,
    #[regex(r"[A-Za-z0-9_]+#[0-9A-Za-z_.:\-]+")]
    TypedConstant,
    #[regex(r"'[^'\r\n]*'?")]
    CharString,
    #[regex(r"%[A-Za-z][A-Za-z0-9]*(\{[0-9.]*\}[A-Za-z0-9]*)?([.\\][A-Za-z0-9]+)*(:[Xx]?[0-9]+)?")]
    ObjectAddress,
    #[token(":=")]
    Assign,
    #[token("=")]
    Eq,
    #[token(":")]
    Colon,
    #[token(";")]
    Semicolon,
    #[token(",")]
    Comma,
    #[token(".")]
    Dot,
}

impl From<Lexeme> for SyntaxKind {
    fn from(lexeme: Lexeme) -> Self {
        match lexeme {
            Lexeme::Whitespace => Self::Whitespace,
            Lexeme::Newline => Self::Newline,
            Lexeme::Comment => Comment,
            Lexeme::UnclosedComment => Self::UnclosedComment,
            Lexeme::BlockMark => BlockMark,
            Lexeme::Ident | Lexeme::DigitWord => Ident,
            Lexeme::Number => Self::Number,
            Lexeme::TypedConstant => Self::TypedConstant,
            Lexeme::CharString => CharString,
            Lexeme::ObjectAddress => ObjectAddress,
            Lexeme::Assign => Self::Assign,
            Lexeme::Eq => Eq,
            Lexeme::Colon => Colon,
            Lexeme::Semicolon => Semicolon,
            Lexeme::Comma => Self::Comma,
            Lexeme::Dot => Self::Dot,
        }
    }
}

fn comment(lexer: &mut Lexer<'_, Lexeme>) -> Lexeme {
    let rest = lexer.remainder();
    match memchr::memmem::find(rest.as_bytes(), b"*)") {
        Some(inner) => {
            lexer.bump(inner + 2);
            Lexeme::Comment
        }
        None => {
            lexer.bump(rest.len());
            Lexeme::UnclosedComment
        }
    }
}

/// Length of a value whose closing quote is missing: up to the next `KEY =` of the line.
fn unclosed_length(text: &str) -> usize {
    let Some(eq) = text.find('=') else { return text.len() };
    let key = text[..eq].trim_end();
    let before = key.trim_end_matches(|it: char| it.is_ascii_alphanumeric() || it == '_');
    let value = before.trim_end();
    if before.len() < key.len() && value.len() < before.len() && value.len() > 1 { value.len() } else { text.len() }
}

fn lex(text: &str) -> Tokens {
    let mut tokens = Tokens::with_capacity(text.len() / 4 + 1);
    let mut offset = 0;
    // A value without closing quote is cut back, after which the lexer goes on inside its token.
    while offset < text.len() {
        let mut lexer = Lexeme::lexer(&text[offset..]);
        let start = offset;
        while let Some(lexeme) = lexer.next() {
            let slice = lexer.slice();
            offset = start + lexer.span().end;
            let is_open = lexeme == Ok(Lexeme::CharString) && (slice.len() < 2 || !slice.ends_with('\''));
            let len = if is_open { unclosed_length(slice) } else { slice.len() };
            tokens.push(lexeme.map_or(SyntaxKind::Unknown, SyntaxKind::from), len);
            if len < slice.len() {
                offset -= slice.len() - len;
                break;
            }
        }
    }
    tokens
}

/// Parses the text around programs. Total and linear for every text; nothing in it is an error.
pub fn parse(text: &str) -> Parse {
    super::parse(Language::Exchange, text)
}

pub(super) fn parse_with(text: &str, memo: &mut Memo) -> Parse {
    let tokens = lex(text);
    let mut p = Parser::new(text, &tokens, memo);
    while !p.at_end() {
        if p.at(BlockMark) {
            block(&mut p);
        } else {
            item(&mut p);
        }
    }
    p.finish()
}

fn block(p: &mut Parser<'_>) {
    let m = p.start();
    // The configuration: its content is not published.
    let is_private = p.at_text("[VENDOR]");
    p.bump();
    if is_private {
        unread(p, |p| p.at(BlockMark));
    }
    while !p.at_end() && !p.at(BlockMark) {
        item(p);
    }
    p.complete(m, ExchangeBlock);
}

/// Keeps tokens that mean nothing to us, up to one where `stop` holds. They are no mistake of the file.
fn unread(p: &mut Parser<'_>, stop: impl Fn(&Parser<'_>) -> bool) {
    if p.at_end() || stop(p) {
        return;
    }
    let m = p.start();
    while !p.at_end() && !stop(p) {
        p.bump();
    }
    p.complete(m, SyntaxKind::Error);
}

fn at_item(p: &Parser<'_>) -> bool {
    p.at(BlockMark) || at_key(p) || at_var_section(p) || at_declaration(p)
}

fn at_key(p: &Parser<'_>) -> bool {
    p.at(Ident) && p.nth(1) == Some(Eq)
}

fn at_var_section(p: &Parser<'_>) -> bool {
    const SECTIONS: [&str; 9] = [
        "VAR",
        "VAR_GLOBAL",
        "VAR_EXTERNAL",
        "VAR_INPUT",
        "VAR_OUTPUT",
        "VAR_IN_OUT",
        "VAR_PUBLIC",
        "VAR_PRIVATE",
        "VAR_TEMP",
    ];
    p.at(Ident) && SECTIONS.iter().any(|it| p.at_text(it)) && p.nth(1) != Some(Colon) && name_length(p) != Some(1)
}

fn item(p: &mut Parser<'_>) {
    if at_key(p) {
        key_value(p);
    } else if at_var_section(p) {
        var_section(p);
    } else if at_declaration(p) {
        declaration(p);
    } else {
        unread(p, at_item);
    }
}

/// `NAME = 'MAST_SR1'`: the value goes to the end of its line or the next key.
fn key_value(p: &mut Parser<'_>) {
    let m = p.start();
    p.bump();
    p.bump();
    while !(p.newline_before() || p.at(BlockMark) || (p.at(Ident) && p.nth(1) == Some(Eq))) {
        p.bump();
    }
    p.complete(m, KeyValue);
}

/// `VAR_GLOBAL ... END_VAR`.
fn var_section(p: &mut Parser<'_>) {
    let m = p.start();
    p.bump();
    while !p.at_end() && !p.at(BlockMark) {
        if p.at_text("END_VAR") {
            p.bump();
            break;
        }
        if at_declaration(p) {
            declaration(p);
        } else if !p.eat(Semicolon) {
            unread(p, |p| p.at(BlockMark) || p.at(Semicolon) || p.at_text("END_VAR") || at_declaration(p));
        }
    }
    p.complete(m, VarSection);
}

/// Tokens that a name with characters which no name has may consist of.
const LONGEST_NAME: usize = 8;

/// `Pump AT %M0 : EBOOL`, and an instance of a DFB, which has no address: `Cpt_vis : Cpt_pieces`.
fn at_declaration(p: &Parser<'_>) -> bool {
    p.at(Ident) && p.nth(1) == Some(Colon) || name_length(p).is_some()
}

/// Tokens of the longest address, and of what may stand in its place.
const LONGEST_ADDRESS: usize = 8;

/// How many tokens an address takes: `%M0`, and of PL7-2 `B3`, `%I0,05`, `COM15,3,F`, `B0[16]`. The letters and digits that
/// stand first tell it from other words; what follows is part of it up to what ends it.
fn address_length(p: &Parser<'_>, at: usize) -> Option<usize> {
    match p.nth(at)? {
        ObjectAddress if p.nth(at + 1) != Some(SyntaxKind::Comma) => return Some(1),
        ObjectAddress => {}
        Ident => {
            let text = p.nth_text(at);
            let letters = text.trim_end_matches(|it: char| it.is_ascii_digit());
            let is_short = (1..=3).contains(&letters.len()) && letters.bytes().all(|it| it.is_ascii_alphabetic());
            if !is_short || letters.len() == text.len() {
                return None;
            }
        }
        _ => return None,
    }
    let ends = |it: usize| {
        matches!(p.nth(it), None | Some(Semicolon | Colon | SyntaxKind::Assign | BlockMark)) || p.nth_newline_before(it)
    };
    (1..LONGEST_ADDRESS).find(|&it| ends(at + it))
}

/// How many tokens stand before `AT %M0`. More than one when the name is none, such as `Pump-1`.
fn name_length(p: &Parser<'_>) -> Option<usize> {
    let ends = |at: usize| {
        p.nth(at) == Some(Ident) && p.nth_text(at).eq_ignore_ascii_case("AT") && address_length(p, at + 1).is_some()
    };
    for at in 0..LONGEST_NAME {
        if at > 0 && ends(at) {
            return Some(at);
        }
        let inside = !matches!(p.nth(at)?, Semicolon | Colon | Eq | SyntaxKind::Assign | BlockMark | ObjectAddress);
        if !inside || at > 0 && p.nth_newline_before(at) {
            return None;
        }
    }
    None
}

fn declaration(p: &mut Parser<'_>) {
    let m = p.start();
    let name = p.start();
    let length = name_length(p);
    for _ in 0..length.unwrap_or(1) {
        p.bump();
    }
    p.complete(name, VarName);
    if length.is_some() {
        p.bump();
        let (address, length) = (p.start(), address_length(p, 0).unwrap_or(1));
        for _ in 0..length {
            p.bump();
        }
        p.complete(address, ObjectRef);
    }
    if p.eat(Colon) && p.at(Ident) && !at_next(p) {
        let kind = p.start();
        p.bump();
        while !at_end_of_declaration(p) && !p.at(SyntaxKind::Assign) {
            p.bump();
        }
        p.complete(kind, TypeRef);
    }
    if p.at(SyntaxKind::Assign) {
        p.bump();
        let value = p.start();
        while !at_end_of_declaration(p) {
            p.bump();
        }
        p.complete(value, InitValue);
    }
    p.eat(Semicolon);
    p.complete(m, VarDecl);
}

fn at_end_of_declaration(p: &Parser<'_>) -> bool {
    p.at_end() || p.at(Semicolon) || p.at(BlockMark) || p.at_text("END_VAR") || at_next(p)
}

/// Whether a declaration begins though the one before lacks its semicolon: what may belong to that one does.
fn at_next(p: &Parser<'_>) -> bool {
    // `AR_W:20` is a type.
    let is_instance = p.nth(1) == Some(Colon) && p.nth(2) != Some(SyntaxKind::Number);
    p.at(Ident) && (is_instance || name_length(p) == Some(1))
}

/// `[SOURCE_UNIT]` and what belongs to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Block<'t>(SyntaxNode<'t>);

impl<'t> AstNode<'t> for Block<'t> {
    fn can_cast(kind: SyntaxKind) -> bool {
        kind == ExchangeBlock
    }

    fn cast(node: SyntaxNode<'t>) -> Option<Self> {
        Self::can_cast(node.kind()).then_some(Self(node))
    }

    fn syntax(self) -> SyntaxNode<'t> {
        self.0
    }
}

impl<'t> Block<'t> {
    /// The blocks of a unit, in order.
    pub fn all(root: SyntaxNode<'t>) -> impl Iterator<Item = Self> {
        root.children().filter_map(Self::cast)
    }

    /// `[SOURCE_UNIT]`, brackets included.
    pub fn mark(self) -> Option<SyntaxToken<'t>> {
        self.child_token(BlockMark)
    }

    /// Whether the block has that name, written without brackets and in any case.
    pub fn is_called(self, name: &str) -> bool {
        self.mark().is_some_and(|it| it.text().trim_matches(['[', ']']).trim().eq_ignore_ascii_case(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MODULE: &str = "[HEADER]\nDATE = date#2024-03-01\nSTANDARD = 'IEC'   SENDER = 'x'\n[APPLICATION]\n\
        NAME = 'Peinture\nVERSION='1.0'\n[VENDOR]\n{any} 12 ; content\n[SOURCE_UNIT]\nSU_TYPE = PROG NAME = 'MAST_SR1 \
        LANGUAGE = IL BODY =\n  ADDRESS = MAST SR1\nPROGRAM MAST'SR1'\n";

    /// Value of the first `key` among the children of a block or a root, in any case: the text behind the `=` without
    /// quotes, comments and blanks around it. `None` if the key is not there, empty if it has no value.
    fn value(parent: SyntaxNode<'_>, key: &str) -> Option<String> {
        let is_key = |it: &SyntaxNode<'_>| {
            let mut words = it.tokens().filter(|it| it.kind() == Ident);
            it.kind() == KeyValue && words.next().is_some_and(|it| it.text().eq_ignore_ascii_case(key))
        };
        let pair = parent.children().find(is_key)?;
        let behind = pair.tokens().skip_while(|it| it.kind() != Eq).skip(1);
        let text: String = behind.filter(|it| it.kind() != Comment).map(SyntaxToken::text).collect();
        let trimmed = text.trim();
        let inner = trimmed.strip_prefix('\'').map_or(trimmed, |it| it.strip_suffix('\'').unwrap_or(it));
        Some(inner.trim().to_owned())
    }

    #[test]
    fn keys_and_values() {
        let parse = parse(MODULE);
        assert_eq!(parse.errors(), []);
        let blocks: Vec<_> = Block::all(parse.syntax()).collect();
        assert_eq!(blocks.len(), 4);
        let [header, application, vendor, unit] = &blocks[..] else { panic!("four blocks") };
        assert!(header.is_called("header") && unit.is_called("SOURCE_UNIT"));
        assert_eq!(value(header.0, "DATE").as_deref(), Some("date#2024-03-01"));
        assert_eq!(value(header.0, "standard").as_deref(), Some("IEC"));
        assert_eq!(value(header.0, "SENDER").as_deref(), Some("x"));
        assert_eq!(value(application.0, "NAME").as_deref(), Some("Peinture"));
        assert_eq!(value(application.0, "VERSION").as_deref(), Some("1.0"));
        assert_eq!(value(vendor.0, "content"), None);
        assert_eq!(value(unit.0, "SU_TYPE").as_deref(), Some("PROG"));
        assert_eq!(value(unit.0, "NAME").as_deref(), Some("MAST_SR1"));
        assert_eq!(value(unit.0, "LANGUAGE").as_deref(), Some("IL"));
        assert_eq!(value(unit.0, "BODY").as_deref(), Some(""));
        assert_eq!(value(unit.0, "ADDRESS").as_deref(), Some("MAST SR1"));
        assert_eq!(value(unit.0, "PROG_LANGAGE"), None);
    }

    #[test]
    fn variables() {
        let text = "[DATA_UNIT]\nVAR_GLOBAL\nPump AT %M0 : EBOOL (*a (b) *); Cpt_vis : Cpt_pieces;\n\
            Lim AT %KW3 : WORD := 16#FF;\nEND_VAR\n[EOF]\n";
        let parse = parse(text);
        let root = parse.syntax();
        let declarations: Vec<_> = root.descendants().filter(|it| it.kind() == VarDecl).collect();
        let parts = |at: usize| {
            let texts = declarations[at].children().map(|it| (it.kind(), it.text().to_string()));
            texts.collect::<Vec<_>>()
        };
        assert_eq!(declarations.len(), 3);
        assert_eq!(parts(0), [(VarName, "Pump".into()), (ObjectRef, "%M0".into()), (TypeRef, "EBOOL".into())]);
        assert_eq!(parts(1), [(VarName, "Cpt_vis".into()), (TypeRef, "Cpt_pieces".into())]);
        assert_eq!(parts(2)[2..], [(TypeRef, "WORD".into()), (InitValue, "16#FF".into())]);
        assert_eq!(Block::all(root).count(), 2);
    }

    #[test]
    fn linear_on_hostile_input() {
        for text in [
            "'a B=".repeat(400_000),
            "'".repeat(1_000_000),
            "A=".repeat(500_000),
            "[".repeat(1_000_000),
            "(*".repeat(500_000),
            "VAR a:".repeat(200_000),
            "\0".repeat(1_000_000),
        ] {
            assert_eq!(parse(&text).syntax().text(), text.as_str());
        }
    }

    proptest! {
        #[test]
        fn tree_is_the_text(text in "\\PC*") {
            let parse = parse(&text);
            prop_assert_eq!(parse.syntax().text(), text.as_str());
        }

        #[test]
        fn cut_and_mutated_text_is_kept(from in 0..400_usize, to in 0..400_usize, junk in "['=\\[\\]a (*;:]{0,4}") {
            let (from, to) = (from.min(MODULE.len()), to.min(MODULE.len()));
            let text = format!("{}{junk}{}", &MODULE[..from], &MODULE[to..]);
            let parse = parse(&text);
            prop_assert_eq!(parse.syntax().text(), text.as_str());
            prop_assert_eq!(parse.errors(), &[]);
        }
    }
}

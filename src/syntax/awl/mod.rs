//! STEP 7 AWL: sources with block headers and bare listings, German and English mnemonics.
//!
//! The tree: `Root > (Block | Listing)*`.
//!
//! - `Block > BlockHeader, (TitleLine | BlockAttribute | VarSection | TypeRef)*, (DataInit* | Network*)`. The `STRUCT`
//!   of a data block or type is a [`VarSection`](SyntaxKind::VarSection) with that keyword.
//! - `Listing > BlockHeader?, Network*`; the header is a line such as `Bloc FC1 :`.
//! - `Network > NetworkHeader?, (Instr | Elision)*`; only a first network can lack its header.
//! - `Instr > Label?, mnemonic tokens, Operand*, ArgList?`. The mnemonic is an `Ident` or `Operator`, plus the `(` of
//!   `U(`; or the `)` that closes it, plus the `Ident` of `)MCR`. A label alone on its line is an `Instr` of its own.
//! - `Operand` holds all tokens of one operand; in its brackets stand further operands.

mod grammar;
mod lexer;
mod vote;

pub mod ast;
pub mod instruction;

#[cfg(test)]
mod tests;

use super::{Language, Memo, Mnemonics, Parse, Parser};

pub(in crate::syntax) use grammar::keywords;
pub use vote::vote;

/// Parses one unit: a block, a listing, or several of them.
pub fn parse(text: &str, mnemonics: Mnemonics) -> Parse {
    super::parse(Language::Awl(mnemonics), text)
}

pub(super) fn parse_with(text: &str, mnemonics: Mnemonics, memo: &mut Memo) -> Parse {
    let tokens = lexer::lex(text);
    let mut parser = Parser::new(text, &tokens, memo);
    grammar::root(&mut parser, mnemonics);
    if let Some(len) = tokens.unclosed_comment() {
        grammar::unclosed_comment(&mut parser, text.len(), len);
    }
    parser.finish()
}

//! STEP 5 statement list: printed blocks and bare listings, German and English mnemonics, with and without the colon
//! before each instruction.
//!
//! The language is that of lines: a comment, an instruction that nothing understands, a parameter end with theirs. The
//! tree has the nodes of STEP 7 where it is the same thing: `Root > (Block | Listing)*`.
//!
//! - `Block > BlockHeader, (BlockAttribute | VarSection)*, (Network* | DataInit*)`: the heading `PB 10`; the line `NAME :`;
//!   a formal operand, `BEZ :EIN  E/A/D/B/T/Z: E  BI/BY/W/D: BI` with its kind and its size as types.
//! - `Listing > Network*`; `Network > NetworkHeader?, Instr*` up to its `***`, the segment end.
//! - `Instr > Label?, mnemonic tokens, Operand?, ArgList?`. The label holds the address that a print puts before it, and
//!   the colon, even where there is no name. Formal operands (`=EIN`) and symbols (`-START`) are operands.
//! - The `ArgList` of a call of a function block is the lines below it: its name, then `EIN : E 0.0`.
//!
//! Assumed, for no program is public: that text behind a tab or three blanks is a comment, as in the last column of a
//! print; that `;` and `//` start one; that instructions which share a line, as in tables of documents (GRF:222), follow
//! one another; the shapes `0: KH = 0000;` of data blocks; the words for formal operands (`BEZ`, `DEZ`, `DES`, `DECL`).

mod grammar;
mod lexer;

pub mod instruction;
pub mod symbols;

#[cfg(test)]
mod tests;

use super::{Language, Memo, Mnemonics, Parse, Parser, SyntaxKind};

pub(crate) use lexer::is_constant;

/// Which mnemonic set a text is written in: by the words and operands that STEP 7 has too, and where these say nothing, by
/// the letters of flags (`F 1.0`, `FW 2`, or `M`). The German set where nothing does.
pub fn vote(text: &str) -> Mnemonics {
    super::awl::vote(text).unwrap_or_else(|| {
        let tokens = lexer::lex(text);
        let mut at = 0;
        let has_flag = tokens.iter().any(|it| {
            let word = &text[at..at + it.len as usize];
            at += it.len as usize;
            let letters = word.split(|it: char| !it.is_ascii_alphabetic()).next().unwrap_or_default();
            it.kind == SyntaxKind::Address && ["F", "FY", "FW", "FD"].contains(&letters)
        });
        if has_flag { Mnemonics::English } else { Mnemonics::German }
    })
}

/// Parses one unit: a block, a listing, or several of them.
pub fn parse(text: &str, mnemonics: Mnemonics) -> Parse {
    super::parse(Language::Step5(mnemonics), text)
}

pub(super) fn parse_with(text: &str, mnemonics: Mnemonics, memo: &mut Memo) -> Parse {
    let tokens = lexer::lex(text);
    let mut parser = Parser::new(text, &tokens, memo);
    grammar::root(&mut parser, mnemonics);
    parser.finish()
}

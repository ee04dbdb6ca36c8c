//! PL7 instruction list, structured text, ladder and Grafcet, in the exchange form and as pasted in documents.
//!
//! One lexer, one expression grammar and one frame of sentences serve the first two. The tree is
//! `Root > Sentence > (LabelDef | IlInstr | statement)*`, of ladder `Root > Rung > (LabelDef | RungRow > Cell)*`; [`ast`]
//! gives it types.
//!
//! The networks and charts of PL7-2 are read by the same grammar, with a lexer, operands and operations of their own.

pub mod ast;
pub mod chart;
mod dfb;
mod expr;
pub mod functions;
mod grammar;
mod il;
pub mod instructions;
mod ladder;
pub mod ladder_words;
mod lexer;
mod operation;
mod st;
mod word;

#[cfg(test)]
mod tests;

use super::{Language, Parse};
pub(super) use grammar::parse_with;

/// Parses one unit of instruction list. Total and linear for every text.
pub fn parse_il(text: &str) -> Parse {
    super::parse(Language::Pl7Il, text)
}

/// Parses one unit of ladder. Total and linear for every text.
pub fn parse_ld(text: &str) -> Parse {
    super::parse(Language::Pl7Ld, text)
}

/// Parses one unit of structured text. Total and linear for every text.
pub fn parse_st(text: &str) -> Parse {
    super::parse(Language::Pl7St, text)
}

/// Whether a word means something in the language, in any case: a keyword, an instruction, a function, a subroutine.
pub fn is_reserved(text: &str) -> bool {
    word::Keyword::of(text).is_some()
        || instructions::lookup(text).is_some()
        || functions::lookup(text).is_some()
        || word::subroutine(text).is_some()
}

/// Words that structure a text or an expression.
pub(super) fn keywords() -> impl Iterator<Item = &'static str> {
    word::Keyword::WORDS.iter().copied()
}

/// Words around the interface of a DFB type.
pub(super) fn dfb_words() -> impl Iterator<Item = &'static str> {
    dfb::SECTIONS.into_iter().chain(["FUNCTION_BLOCK", dfb::END, "END_VAR"])
}

/// Operations of PL7-2 on one operand.
pub(super) fn operation_codes() -> impl Iterator<Item = &'static str> {
    operation::CODES.into_iter().chain(operation::ROTATIONS)
}

/// Parses one page of a chart, or a chart in the textual form of IEC 61131-3. Total and linear for every text.
pub fn parse_chart(text: &str) -> Parse {
    super::parse(Language::Pl7Gr7, text)
}

/// Parses one unit of PL7-2 ladder. Total and linear for every text.
pub fn parse_pl7_2_ld(text: &str) -> Parse {
    super::parse(Language::Pl72Ld, text)
}

/// As [`parse_chart`], with the operands and operations of PL7-2.
pub fn parse_pl7_2_chart(text: &str) -> Parse {
    super::parse(Language::Pl72Gr7, text)
}

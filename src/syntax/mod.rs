//! Text to lossless tree. One [`SyntaxKind`], one parser kit, and one lexer and grammar a language.
//!
//! **Invariant:** parsing never fails and never loses a byte: the tree's text is the input, for every input; what is
//! wrong is an error node and an entry in [`Parse::errors`]. Time is linear in the input, depth is limited.
//! **Invariant:** this module knows no database, no configuration, no controller and no rule.

use rowan::TextRange;

mod builder;
mod kind;
mod memo;
mod node;
mod packed;
mod parser;
mod tokens;

pub mod awl;
pub mod exchange;
pub mod pl7;
mod pl72;
pub mod step5;
pub mod symbol_table;
pub mod words;
pub mod xref;

pub use kind::SyntaxKind;
pub use memo::Memo;
pub use node::{AstChildren, AstNode, Elements, SyntaxElement, SyntaxNode, SyntaxToken, Walk, WalkEvent};
pub use parser::{Completed, MAX_DEPTH, Marker, Parse, Parser, SyntaxError};
use tokens::Tokens;

/// Mnemonic set of a Siemens program: the same word means different things in the two (`SE`, `A`, `AD`, `E`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mnemonics {
    /// `U`, `E 0.0`, `AUF`, `SPA`: the set called SIMATIC.
    German,
    /// `A`, `I 0.0`, `OPN`, `JU`: the set called international.
    English,
}

/// What a unit of text is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Language {
    /// STEP 7 statement list, sources and bare listings.
    Awl(Mnemonics),
    /// STEP 5 statement list, printed blocks and bare listings.
    Step5(Mnemonics),
    /// The symbol table of a STEP 5 program (`Z0.SEQ`).
    Step5Symbols,
    /// PL7 instruction list.
    Pl7Il,
    /// PL7 structured text.
    Pl7St,
    /// PL7 ladder, as exchange files write it.
    Pl7Ld,
    /// PL7 Grafcet: a page of a chart in the exchange form, with the code of its actions and receptivities.
    Pl7Gr7,
    /// IEC 61131-3 sequential function chart as text, with PL7 code.
    Sfc,
    /// PL7-2 ladder, in the form of PL7's.
    Pl72Ld,
    /// PL7-2 Grafcet, in the form of PL7's pages.
    Pl72Gr7,
    /// IEC 61131-3 sequential function chart as text, with PL7-2 code.
    Pl72Sfc,
    /// The blocks around the program in a PL7 exchange file: `[HEADER]`, `[APPLICATION]`, the keys of `[SOURCE_UNIT]`.
    Exchange,
    /// A symbol table of STEP 7.
    SymbolTable,
    /// The cross-reference of a PL7 project whose code is not readable.
    Pl7Xref,
}

impl Language {
    /// Whether the text is a chart, which holds code of other languages.
    pub fn is_chart(self) -> bool {
        matches!(self, Self::Pl7Gr7 | Self::Sfc | Self::Pl72Gr7 | Self::Pl72Sfc)
    }

    /// Whether the text declares symbols for the programs around it.
    pub fn declares_symbols(self) -> bool {
        matches!(self, Self::Exchange | Self::SymbolTable | Self::Step5Symbols)
    }

    /// Whether the text is a statement list of Siemens.
    pub fn is_statement_list(self) -> bool {
        matches!(self, Self::Awl(_) | Self::Step5(_))
    }

    /// Whether operands and operations are those of PL7-2.
    pub fn is_pl7_2(self) -> bool {
        matches!(self, Self::Pl72Ld | Self::Pl72Gr7 | Self::Pl72Sfc)
    }
}

/// Parses one unit. Total and linear for every text. Who parses many keeps a [`Memo`].
pub fn parse(language: Language, text: &str) -> Parse {
    parse_with(language, text, &mut Memo::for_text(text))
}

fn parse_with(language: Language, text: &str, memo: &mut Memo) -> Parse {
    match language {
        Language::Awl(mnemonics) => awl::parse_with(text, mnemonics, memo),
        Language::Step5(mnemonics) => step5::parse_with(text, mnemonics, memo),
        Language::Step5Symbols => step5::symbols::parse_with(text, memo),
        Language::Pl7Il
        | Language::Pl7St
        | Language::Pl7Ld
        | Language::Pl7Gr7
        | Language::Sfc
        | Language::Pl72Ld
        | Language::Pl72Gr7
        | Language::Pl72Sfc => pl7::parse_with(text, language, memo),
        Language::Exchange => exchange::parse_with(text, memo),
        Language::SymbolTable => symbol_table::parse_with(text, memo),
        Language::Pl7Xref => xref::parse_with(text, memo),
    }
}

/// The tree of text in a language that is not read: one error node, and where that is an error, its place and message.
pub fn opaque(text: &str, error: Option<(TextRange, &str)>) -> Parse {
    let mut tokens = Tokens::default();
    tokens.push(SyntaxKind::Unknown, text.len());
    let mut memo = Memo::for_text("");
    let mut parser = Parser::new(text, &tokens, &mut memo);
    let node = parser.start();
    parser.bump();
    parser.complete(node, SyntaxKind::Error);
    if let Some((range, message)) = error {
        parser.error_at(range, message);
    }
    parser.finish()
}

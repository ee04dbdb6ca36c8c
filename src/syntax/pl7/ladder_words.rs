//! The words of rungs in the exchange form. The one table of them, with every spelling that is read.
//!
//! The form is not published. What is *seen* stands in real exchange files; what is *assumed* takes the names that the
//! successor's XML form gives to the same elements (`closedContact`, `setCoil`, `compareBlock`, `effectiveParameter`),
//! written as the seen words are. Where a real file disagrees, one line here changes.
//!
//! Of a DFB the manual says that what its pins are given stands in the cells that face them (PL7:5623, 5646). Assumed: the
//! block is `BLOCK(Instance)` of three columns, its first pin in its first row, and such a cell is
//! `EFFECTIVE_PARAMETER(%MW10)`, left of the block for inputs and in/outs, right of it for outputs.

use crate::syntax::packed::{Index, index};

/// What stands in the parentheses behind a word, or up to the `END_BLOCK` of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Nothing; empty parentheses pass.
    Bare,
    /// A number of cells or rows, 1 when left out.
    Count,
    /// A bit, a function block.
    Object,
    /// `%L10`.
    Label,
    /// `SR5`.
    Subroutine,
    /// An expression up to `END_BLOCK`.
    Comparison,
    /// Assignments and calls up to `END_BLOCK`.
    Operation,
    /// An object or expression.
    Expression,
}

/// An element of a rung (PL7:2700-2767).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Element {
    /// Contact that conducts when the bit is 1.
    Open,
    /// Contact that conducts when the bit is 0.
    Closed,
    Rising,
    Falling,
    /// A horizontal link over some cells.
    HLink,
    /// An empty cell with a vertical link at its right edge.
    VLink,
    /// A horizontal link over some cells, with a vertical link at the right edge of the last one.
    ShortCircuit,
    EmptyCell,
    /// Whole rows without anything.
    EmptyLine,
    Coil,
    NotCoil,
    SetCoil,
    ResetCoil,
    /// Coil of PL7-2 that keeps the state of its bit at a warm start (PL72:412).
    SaveCoil,
    /// `(#)`: lets the transition be crossed (PL7:2741).
    HashCoil,
    Jump,
    Call,
    Return,
    Halt,
    Compare,
    Operate,
    Block,
    /// What a pin of a DFB is given, in the cell that faces it (PL7:5623, 5646).
    Actual,
}

impl Element {
    pub fn shape(self) -> Shape {
        match self {
            Self::Open | Self::Closed | Self::Rising | Self::Falling => Shape::Object,
            Self::Coil | Self::NotCoil | Self::SetCoil | Self::ResetCoil => Shape::Object,
            Self::SaveCoil | Self::Block => Shape::Object,
            Self::HLink | Self::ShortCircuit | Self::EmptyCell | Self::EmptyLine => Shape::Count,
            Self::VLink | Self::HashCoil | Self::Return | Self::Halt => Shape::Bare,
            Self::Jump => Shape::Label,
            Self::Call => Shape::Subroutine,
            Self::Compare => Shape::Comparison,
            Self::Operate => Shape::Operation,
            Self::Actual => Shape::Expression,
        }
    }

    /// Whether it makes or breaks a path, from its left edge to its right edge: belongs to the test zone (PL7:2781).
    pub fn is_test(self) -> bool {
        matches!(self, Self::Open | Self::Closed | Self::Rising | Self::Falling | Self::Compare | Self::Block)
    }

    /// Whether networks of PL7-2 have it. They have neither calls nor a way to stop (PL72:401-419).
    pub fn is_of_pl7_2(self) -> bool {
        !matches!(self, Self::Call | Self::Return | Self::Halt)
    }

    /// Whether rungs of PL7 have it.
    pub fn is_of_pl7(self) -> bool {
        self != Self::SaveCoil
    }

    /// Whether it applies a result: belongs to the action zone (PL7:2783, 2825).
    pub fn is_action(self) -> bool {
        matches!(
            self,
            Self::Coil
                | Self::NotCoil
                | Self::SetCoil
                | Self::ResetCoil
                | Self::SaveCoil
                | Self::HashCoil
                | Self::Jump
                | Self::Call
                | Self::Return
                | Self::Halt
                | Self::Operate
        )
    }
}

/// Whether a spelling stands in real files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Evidence {
    Seen,
    Assumed,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    pub text: &'static str,
    pub element: Element,
    pub evidence: Evidence,
}

const fn seen(text: &'static str, element: Element) -> Word {
    Word { text, element, evidence: Evidence::Seen }
}

const fn assumed(text: &'static str, element: Element) -> Word {
    Word { text, element, evidence: Evidence::Assumed }
}

const WORDS: &[Word] = &[
    seen("H_LINK", Element::HLink),
    seen("OPEN_CONTACT", Element::Open),
    assumed("CLOSED_CONTACT", Element::Closed),
    assumed("CLOSE_CONTACT", Element::Closed),
    seen("COIL", Element::Coil),
    seen("P_CONTACT", Element::Rising),
    assumed("N_CONTACT", Element::Falling),
    seen("V_LINK", Element::VLink),
    assumed("SHORT_CIRCUIT", Element::ShortCircuit),
    assumed("EMPTY_CELL", Element::EmptyCell),
    seen("EMPTY_LINE", Element::EmptyLine),
    assumed("NOT_COIL", Element::NotCoil),
    assumed("SET_COIL", Element::SetCoil),
    assumed("RESET_COIL", Element::ResetCoil),
    assumed("SAVE_COIL", Element::SaveCoil),
    assumed("SAVED_COIL", Element::SaveCoil),
    seen("HASH_COIL", Element::HashCoil),
    assumed("JUMP_COIL", Element::Jump),
    assumed("CALL_COIL", Element::Call),
    assumed("RETURN_COIL", Element::Return),
    assumed("HALT_COIL", Element::Halt),
    assumed("COMPARE", Element::Compare),
    seen("OPERATE", Element::Operate),
    seen("BLOCK", Element::Block),
    assumed("EFFECTIVE_PARAMETER", Element::Actual),
];

/// Every word.
pub fn all() -> &'static [Word] {
    WORDS
}

/// The word of that spelling, in any case.
pub fn lookup(text: &str) -> Option<&'static Word> {
    static INDEX: Index<{ WORDS.len() }> = index!(WORDS, text);
    INDEX.find(text).map(|it| &WORDS[it])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_are_unique_and_found_in_any_case() {
        for word in WORDS {
            assert_eq!(lookup(&word.text.to_ascii_lowercase()), Some(word));
        }
        for text in ["", "CONTACT", "OPEN_CONTACT_", "OPENCONTACT", "END_BLOCK", "RUNG"] {
            assert_eq!(lookup(text), None, "{text}");
        }
    }

    #[test]
    fn no_element_belongs_to_both_zones() {
        for word in WORDS {
            assert!(!(word.element.is_test() && word.element.is_action()), "{}", word.text);
        }
    }
}

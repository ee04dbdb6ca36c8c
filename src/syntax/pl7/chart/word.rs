//! Words of charts: every spelling that is read, in one table.

use super::ast::{ConnectorKind, LinkKind, StepKind};
use crate::syntax::packed::{Index, index};

/// What a word of a chart means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::syntax::pl7) enum Word {
    PageCount,
    Page,
    EndPage,
    Step(StepKind),
    EndStep,
    Action,
    EndAction,
    Transition,
    EndTransition,
    Link(LinkKind),
    /// A part of the line of a link. True: along a line of the page.
    Segment(bool),
    Connector(ConnectorKind),
    Comment,
    EndComment,
    /// Says where an element stands.
    At,
    From,
    To,
}

/// How sure a spelling is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Evidence {
    /// Seen in the exchange form, or a word of IEC 61131-3.
    Known,
    /// By analogy with known words. A file that spells it otherwise gets one clear error for the word.
    Assumed,
}

use Evidence::{Assumed, Known};

/// Every spelling, in upper case; case does not matter.
pub(super) const WORDS: &[(&str, Word, Evidence)] = &[
    ("NB_PAGES", Word::PageCount, Known),
    ("PAGE", Word::Page, Known),
    ("END_PAGE", Word::EndPage, Known),
    ("INITIAL_STEP", Word::Step(StepKind::Initial), Known),
    ("INIT_STEP", Word::Step(StepKind::Initial), Assumed),
    ("STEP", Word::Step(StepKind::Simple), Known),
    ("MACRO_STEP", Word::Step(StepKind::Macro), Assumed),
    ("MACROSTEP", Word::Step(StepKind::Macro), Assumed),
    ("IN_STEP", Word::Step(StepKind::In), Assumed),
    ("STEP_IN", Word::Step(StepKind::In), Assumed),
    ("INPUT_STEP", Word::Step(StepKind::In), Assumed),
    ("OUT_STEP", Word::Step(StepKind::Out), Assumed),
    ("STEP_OUT", Word::Step(StepKind::Out), Assumed),
    ("OUTPUT_STEP", Word::Step(StepKind::Out), Assumed),
    ("END_STEP", Word::EndStep, Known),
    ("END_INITIAL_STEP", Word::EndStep, Assumed),
    ("END_MACRO_STEP", Word::EndStep, Assumed),
    ("END_IN_STEP", Word::EndStep, Assumed),
    ("END_OUT_STEP", Word::EndStep, Assumed),
    ("ACTION", Word::Action, Known),
    ("END_ACTION", Word::EndAction, Known),
    ("TRANSITION", Word::Transition, Known),
    ("END_TRANSITION", Word::EndTransition, Known),
    ("T_S_OR_LINK", Word::Link(LinkKind::OrConvergence), Known),
    ("S_T_OR_LINK", Word::Link(LinkKind::OrDivergence), Assumed),
    ("T_S_AND_LINK", Word::Link(LinkKind::AndDivergence), Assumed),
    ("S_T_AND_LINK", Word::Link(LinkKind::AndConvergence), Assumed),
    ("H_LINK", Word::Segment(true), Known),
    ("V_LINK", Word::Segment(false), Known),
    ("SOURCE_CONNECTOR", Word::Connector(ConnectorKind::Origin), Assumed),
    ("SRC_CONNECTOR", Word::Connector(ConnectorKind::Origin), Assumed),
    ("ORIGIN_CONNECTOR", Word::Connector(ConnectorKind::Origin), Assumed),
    ("DEST_CONNECTOR", Word::Connector(ConnectorKind::Destination), Assumed),
    ("DESTINATION_CONNECTOR", Word::Connector(ConnectorKind::Destination), Assumed),
    ("COMMENT", Word::Comment, Assumed),
    ("END_COMMENT", Word::EndComment, Assumed),
    ("AT", Word::At, Known),
    ("FROM", Word::From, Known),
    ("TO", Word::To, Known),
];

impl Word {
    pub(in crate::syntax::pl7) fn of(text: &str) -> Option<Self> {
        // Mnemonics, by far the most words of a chart, are shorter than its words but for two.
        if text.len() < 4 && !text.eq_ignore_ascii_case("AT") && !text.eq_ignore_ascii_case("TO") {
            return None;
        }
        static INDEX: Index<{ WORDS.len() }> = index!(WORDS, 0);
        INDEX.find(text).map(|it| WORDS[it].1)
    }

    /// Whether the word ends what another opens.
    pub(in crate::syntax::pl7) fn is_end(self) -> bool {
        matches!(self, Self::EndPage | Self::EndStep | Self::EndAction | Self::EndTransition | Self::EndComment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_are_told_apart() {
        for (at, (text, word, _)) in WORDS.iter().enumerate() {
            assert_eq!(Word::of(&text.to_lowercase()), Some(*word), "{text}");
            assert!(WORDS[..at].iter().all(|it| it.0 != *text), "{text} twice");
        }
        for text in ["", "END", "STEPS", "LD", "AND", "É", "LINK", "T_S_OR_LINKS"] {
            assert_eq!(Word::of(text), None, "{text}");
        }
    }

    /// What the published example shows is enough to read that example.
    #[test]
    fn words_of_the_example_are_known() {
        let known = |text: &str| WORDS.iter().any(|it| it.0 == text && it.2 == Evidence::Known);
        for text in ["NB_PAGES", "PAGE", "INITIAL_STEP", "STEP", "TRANSITION", "T_S_OR_LINK", "H_LINK", "V_LINK"] {
            assert!(known(text), "{text}");
        }
    }
}

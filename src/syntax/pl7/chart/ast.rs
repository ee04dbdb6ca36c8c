//! Typed views of charts. Every accessor returns `None` where the text lacks the part.

use super::word::Word;
use crate::syntax::node::nodes;
use crate::syntax::pl7::ast::{Rung, Sentence};
use crate::syntax::{AstChildren, AstNode as _, SyntaxElement, SyntaxKind, SyntaxToken};

/// Which step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StepKind {
    Simple,
    /// Active when the chart is initialised.
    Initial,
    /// Stands for its expansion.
    Macro,
    /// First and last step of an expansion.
    In,
    Out,
}

/// A link by what it joins: the vertical neighbours of a page are joined without one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LinkKind {
    /// From a step to one of several transitions.
    OrDivergence,
    /// From one of several transitions to a step.
    OrConvergence,
    /// From a transition to several steps.
    AndDivergence,
    /// From several steps to a transition.
    AndConvergence,
}

/// A connector by the step that it names (PL7:4198-4201).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ConnectorKind {
    /// Names the step where one comes from.
    Origin,
    /// Names the step where one goes.
    Destination,
}

/// When the code of an action runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ActionKind {
    /// Once, when the step becomes active: `P1`.
    Activation,
    /// In each scan while the step is active: `N1`.
    Continuous,
    /// Once, when the step becomes inactive: `P0`.
    Deactivation,
    /// From the activation on until a reset: `S` of IEC 61131-3.
    Stored,
    /// Ends a stored action: `R` of IEC 61131-3.
    Reset,
    /// Delayed or limited in time: `L`, `D`, `SD`, `DS`, `SL` of IEC 61131-3.
    Timed,
}

impl ActionKind {
    /// Reads a qualifier, of PL7 (PL7:4541) or of IEC 61131-3.
    pub fn of(text: &str) -> Option<Self> {
        let all = [
            ("P1", Self::Activation),
            ("P", Self::Activation),
            ("N1", Self::Continuous),
            ("N", Self::Continuous),
            ("P0", Self::Deactivation),
            ("S", Self::Stored),
            ("R", Self::Reset),
            ("L", Self::Timed),
            ("D", Self::Timed),
            ("SD", Self::Timed),
            ("DS", Self::Timed),
            ("SL", Self::Timed),
        ];
        all.into_iter().find(|it| it.0.eq_ignore_ascii_case(text)).map(|it| it.1)
    }
}

/// Language of an action or a receptivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CodeLanguage {
    Ladder,
    Il,
    St,
}

impl CodeLanguage {
    pub fn of(text: &str) -> Option<Self> {
        let all = [("LD", Self::Ladder), ("IL", Self::Il), ("ST", Self::St)];
        all.into_iter().find(|it| it.0.eq_ignore_ascii_case(text)).map(|it| it.1)
    }
}

nodes! {
    /// `NB_PAGES = 8`.
    PageCount,
    Page,
    ChartStep,
    StepName,
    ChartAction,
    Association,
    Transition,
    TransitionEnd,
    ChartLink,
    Segment,
    Connector,
    ChartComment,
    PageCell,
}

impl PageCount<'_> {
    pub fn count(self) -> Option<u32> {
        self.child_token(SyntaxKind::Number)?.text().parse().ok()
    }
}

impl<'t> Page<'t> {
    pub fn number_token(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Number)
    }

    pub fn number(self) -> Option<u32> {
        self.number_token()?.text().parse().ok()
    }
}

impl<'t> ChartStep<'t> {
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    pub fn kind(self) -> Option<StepKind> {
        match Word::of(self.keyword()?.text())? {
            Word::Step(kind) => Some(kind),
            _ => None,
        }
    }

    pub fn name(self) -> Option<StepName<'t>> {
        self.child()
    }

    pub fn cell(self) -> Option<PageCell<'t>> {
        self.child()
    }

    pub fn actions(self) -> AstChildren<'t, ChartAction<'t>> {
        self.children()
    }

    pub fn associations(self) -> AstChildren<'t, Association<'t>> {
        self.children()
    }
}

/// Language that an action or transition says: a word in its first parentheses.
fn code_language<'t>(tokens: impl Iterator<Item = SyntaxToken<'t>>) -> Option<CodeLanguage> {
    in_parentheses(tokens).find_map(|it| CodeLanguage::of(it.text()))
}

/// The words in the first parentheses.
fn in_parentheses<'t>(tokens: impl Iterator<Item = SyntaxToken<'t>>) -> impl Iterator<Item = SyntaxToken<'t>> {
    tokens
        .skip_while(|it| it.kind() != SyntaxKind::LParen)
        .take_while(|it| it.kind() != SyntaxKind::RParen)
        .filter(|it| it.kind() == SyntaxKind::Ident)
}

impl<'t> ChartAction<'t> {
    /// `Fill`, of an action that steps name.
    pub fn name(self) -> Option<SyntaxToken<'t>> {
        self.significant().nth(1).filter(|it| it.kind() == SyntaxKind::Ident)
    }

    pub fn kind(self) -> Option<ActionKind> {
        if self.name().is_some() {
            return None;
        }
        in_parentheses(self.significant()).find_map(|it| ActionKind::of(it.text()))
    }

    pub fn language(self) -> Option<CodeLanguage> {
        code_language(self.significant())
    }

    pub fn sentences(self) -> AstChildren<'t, Sentence<'t>> {
        self.children()
    }

    pub fn rungs(self) -> AstChildren<'t, Rung<'t>> {
        self.children()
    }
}

impl<'t> Association<'t> {
    /// The action's name, or a bit: `Fill`, `%Q2.0`.
    pub fn target(self) -> Option<SyntaxToken<'t>> {
        self.significant().next().filter(|it| matches!(it.kind(), SyntaxKind::Ident | SyntaxKind::ObjectAddress))
    }

    /// `N` when none is written.
    pub fn kind(self) -> Option<ActionKind> {
        match in_parentheses(self.significant()).next() {
            Some(it) => ActionKind::of(it.text()),
            None => Some(ActionKind::Continuous),
        }
    }
}

impl<'t> Transition<'t> {
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    pub fn cell(self) -> Option<PageCell<'t>> {
        self.child()
    }

    pub fn language(self) -> Option<CodeLanguage> {
        code_language(self.significant())
    }

    /// Lists that `FROM` and `TO` begin.
    pub fn ends(self) -> AstChildren<'t, TransitionEnd<'t>> {
        self.children()
    }

    pub fn sentences(self) -> AstChildren<'t, Sentence<'t>> {
        self.children()
    }

    pub fn rungs(self) -> AstChildren<'t, Rung<'t>> {
        self.children()
    }

    /// Whether part of the code was not understood.
    pub fn has_error(self) -> bool {
        self.syntax().has_error()
    }
}

impl<'t> TransitionEnd<'t> {
    /// Whether the list names the steps before the transition.
    pub fn is_source(self) -> bool {
        self.significant().next().is_some_and(|it| Word::of(it.text()) == Some(Word::From))
    }

    pub fn names(self) -> AstChildren<'t, StepName<'t>> {
        self.children()
    }
}

impl<'t> StepName<'t> {
    /// As written, blanks removed: `3`, `X3`, `%X2.1`, `IN`.
    pub fn text(self) -> String {
        self.significant().map(SyntaxToken::text).collect()
    }
}

impl<'t> ChartLink<'t> {
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    pub fn kind(self) -> Option<LinkKind> {
        match Word::of(self.keyword()?.text())? {
            Word::Link(kind) => Some(kind),
            _ => None,
        }
    }

    pub fn from(self) -> impl Iterator<Item = PageCell<'t>> {
        cells(self.syntax().children_with_tokens(), false)
    }

    pub fn to(self) -> impl Iterator<Item = PageCell<'t>> {
        cells(self.syntax().children_with_tokens(), true)
    }

    pub fn segments(self) -> AstChildren<'t, Segment<'t>> {
        self.children()
    }
}

/// Cells before `TO`, or behind it.
fn cells<'t>(elements: impl Iterator<Item = SyntaxElement<'t>>, behind: bool) -> impl Iterator<Item = PageCell<'t>> {
    let mut passed = false;
    elements.filter_map(move |it| match it {
        SyntaxElement::Token(it) => {
            passed |= it.kind() == SyntaxKind::Ident && Word::of(it.text()) == Some(Word::To);
            None
        }
        SyntaxElement::Node(it) => PageCell::cast(it).filter(|_| passed == behind),
    })
}

impl<'t> Segment<'t> {
    /// Whether it runs along a line of the page.
    pub fn is_horizontal(self) -> bool {
        let keyword = self.significant().next();
        keyword.is_some_and(|it| Word::of(it.text()) == Some(Word::Segment(true)))
    }

    pub fn from(self) -> Option<PageCell<'t>> {
        cells(self.syntax().children_with_tokens(), false).next()
    }

    pub fn to(self) -> Option<PageCell<'t>> {
        cells(self.syntax().children_with_tokens(), true).next()
    }
}

impl<'t> Connector<'t> {
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    pub fn kind(self) -> Option<ConnectorKind> {
        match Word::of(self.keyword()?.text())? {
            Word::Connector(kind) => Some(kind),
            _ => None,
        }
    }

    pub fn name(self) -> Option<StepName<'t>> {
        self.child()
    }

    pub fn cell(self) -> Option<PageCell<'t>> {
        self.child()
    }
}

impl PageCell<'_> {
    /// Column and line, from 0: `(C 4,L 3)`, whose letters may be glued to their numbers or left out.
    pub fn place(self) -> Option<(u32, u32)> {
        let (mut column, mut line) = (None, None);
        let mut next_is_line = false;
        for token in self.significant() {
            match token.kind() {
                SyntaxKind::Comma => {
                    next_is_line = true;
                    continue;
                }
                SyntaxKind::LParen | SyntaxKind::RParen => continue,
                _ => {}
            }
            let text = token.text();
            match text.as_bytes() {
                [b'C' | b'c', ..] => next_is_line = false,
                [b'L' | b'l', ..] => next_is_line = true,
                _ => {}
            }
            let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
            if let Ok(number) = text[letters..].parse() {
                *(if next_is_line { &mut line } else { &mut column }) = Some(number);
            }
        }
        column.zip(line)
    }
}

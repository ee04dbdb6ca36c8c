//! Grammar of charts. The code of actions and receptivities is read by the grammars of its language.

use SyntaxKind::{
    Arrow, Assign, Association, Bang, CharString, ChartAction, ChartComment, ChartLink, ChartStep, Colon, Comma,
    Connector, Elision, Eq, Error, Ident, LBrack, LParen, LabelAddress, Number, ObjectAddress, Page, PageCell,
    PageCount, RBrack, RParen, Segment, Semicolon, SentenceEnd, SentenceStart, StepName, Transition, TransitionEnd,
};

use super::ast::{ActionKind, CodeLanguage, StepKind};
use super::word::Word;
use crate::syntax::pl7::grammar::{Dialect, Grammar, Part};
use crate::syntax::pl7::instructions::IlOp;
use crate::syntax::pl7::word::Keyword;
use crate::syntax::{Parser, SyntaxKind};

/// For each significant token: whether code of an action or a receptivity ends before it. A word alone is not enough,
/// because symbols may be called `Step` or `Action`.
pub(in crate::syntax::pl7) fn stops(parser: &Parser<'_>) -> Vec<bool> {
    let kind = |n: usize| parser.nth(n);
    let words = parser.words(Word::of);
    let word = |n: usize| words.get(n).copied().flatten();
    let stops = |n: usize| {
        let Some(found) = word(n) else { return false };
        let next = kind(n + 1);
        match found {
            _ if found.is_end() => true,
            Word::PageCount => next == Some(Eq),
            Word::Page => next == Some(Number),
            Word::Step(StepKind::In | StepKind::Out) => next == Some(Colon) || word(n + 1) == Some(Word::At),
            Word::Step(_) | Word::Connector(_) => {
                let has_name = matches!(next, Some(Number | Ident | ObjectAddress));
                has_name && (word(n + 2) == Some(Word::At) || kind(n + 2) == Some(Colon))
            }
            Word::Transition => match next {
                Some(LParen) => CodeLanguage::of(parser.nth_text(n + 2)).is_some(),
                Some(Ident) => matches!(word(n + 1), Some(Word::At | Word::From)) || word(n + 2) == Some(Word::From),
                _ => false,
            },
            Word::Action => match next {
                Some(LParen) => {
                    ActionKind::of(parser.nth_text(n + 2)).is_some()
                        && matches!(kind(n + 3), Some(Comma | RParen))
                        && (4..7).any(|it| kind(n + it) == Some(Colon))
                }
                Some(Ident) => kind(n + 2) == Some(Colon),
                _ => false,
            },
            Word::Link(_) => word(n + 1) == Some(Word::From),
            Word::Comment => word(n + 1) == Some(Word::At) || next == Some(CharString),
            _ => false,
        }
    };
    words.iter().enumerate().map(|(n, it)| it.is_some() && stops(n)).collect()
}

impl<'t> Grammar<'_, 't> {
    /// chart = (heading | program line | page count | page | element)*
    ///
    /// Elements outside of a page are those of a textual chart, which has none.
    pub(in crate::syntax::pl7) fn chart(&mut self) {
        if self.at_task_line() {
            self.heading();
        }
        while !self.p.at_end() {
            self.state.muted = false;
            if self.at_heading() {
                self.heading();
            } else if self.at_program_line() {
                self.program_line();
            } else {
                match self.word() {
                    Some(Word::PageCount) => self.page_count(),
                    Some(Word::Page) => self.page(),
                    _ => self.element(),
                }
            }
        }
    }

    fn nth_word(&self, n: usize) -> Option<Word> {
        if self.p.nth(n) == Some(Ident) { Word::of(self.p.nth_text(n)) } else { None }
    }

    fn word(&self) -> Option<Word> {
        self.nth_word(0)
    }

    fn eat_word(&mut self, word: Word) -> bool {
        let found = self.word() == Some(word);
        if found {
            self.p.bump();
        }
        found
    }

    /// Whether no element of the chart goes on here.
    fn at_chart_end(&self) -> bool {
        self.p.at_end() || self.at_program_line() || self.at_heading()
    }

    /// `NB_PAGES = 8`
    fn page_count(&mut self) {
        let m = self.p.start();
        self.p.bump();
        if !self.p.eat(Eq) {
            self.expected("`=`");
        }
        if !self.p.eat(Number) {
            self.expected("the number of pages");
        }
        self.p.eat(Semicolon);
        self.p.complete(m, PageCount);
    }

    /// page = 'PAGE' number element* 'END_PAGE'
    fn page(&mut self) {
        let m = self.p.start();
        self.p.bump();
        if !self.p.eat(Number) {
            self.expected("the number of the page");
        }
        self.p.eat(Colon);
        let is_closed = loop {
            self.state.muted = false;
            match self.word() {
                Some(Word::EndPage) => {
                    self.p.bump();
                    break true;
                }
                Some(Word::Page | Word::PageCount) => break false,
                _ if self.at_chart_end() => break false,
                _ => self.element(),
            }
        };
        if !is_closed {
            self.expected("`END_PAGE`");
        }
        self.p.complete(m, Page);
    }

    /// One element of a page or a textual chart. Consumes at least one token.
    fn element(&mut self) {
        let known = self.p.piece().filter(|it| self.nth_stops(it.len));
        let known = known.map(|it| (self.context(Part::Element, &it), it));
        if let Some((context, piece)) = &known
            && self.p.recall(piece, *context)
        {
            return;
        }
        let word = self.word();
        match word {
            Some(Word::Step(kind)) => self.step(kind),
            Some(Word::Action) => self.chart_action(),
            Some(Word::Transition) => self.transition(),
            Some(Word::Link(_)) => self.link(),
            Some(Word::Connector(_)) => self.connector(),
            Some(Word::Comment) => self.chart_comment(),
            Some(it) if it.is_end() && !self.ends_unknown() => {
                self.error(format!("`{}` belongs to nothing that is open", self.p.current_text()));
                self.bump_error();
            }
            _ => self.unknown(),
        }
        if let (Some(Word::Step(_) | Word::Link(_) | Word::Connector(_)), Some((context, piece))) = (word, known) {
            self.p.remember(&piece, context, true);
        }
    }

    /// Whether the word is the end of what an unknown word, reported before, opened.
    fn ends_unknown(&self) -> bool {
        let end = self.p.current_text().get(..4).filter(|it| it.eq_ignore_ascii_case("END_"));
        let name = end.and_then(|_| self.p.current_text().get(4..));
        name.is_some_and(|it| self.state.unknown.is_some_and(|unknown| unknown.eq_ignore_ascii_case(it)))
    }

    /// What is no word of a chart: one report for a word however often it stands there, and the rest is read.
    fn unknown(&mut self) {
        let text = self.p.current_text();
        let is_known = self.state.unknown.is_some_and(|it| it.eq_ignore_ascii_case(text)) || self.ends_unknown();
        if !is_known {
            if self.p.at(Ident) && text.len() <= 40 {
                self.error(format!("`{text}` is no word of a chart that plclint knows"));
                self.state.unknown = Some(text);
            } else {
                self.expected("a step, a transition, a link or a connector");
            }
        }
        self.skip_element();
    }

    /// The current token and all up to the next element, as one error node.
    fn skip_element(&mut self) {
        let m = self.p.start();
        self.p.bump();
        while !self.at_stop() && !self.at_chart_end() && !self.ends_unknown() {
            self.p.bump();
        }
        self.p.complete(m, Error);
    }

    /// Tokens that do not belong where they are, up to where `stop` holds or an element starts.
    fn skip_to(&mut self, stop: impl Fn(&Self) -> bool) {
        if stop(self) || self.at_stop() || self.at_chart_end() {
            return;
        }
        let m = self.p.start();
        while !(stop(self) || self.at_stop() || self.at_chart_end()) {
            self.p.bump();
        }
        self.p.complete(m, Error);
    }

    /// `AT (C 4,L 3)`
    fn place(&mut self) {
        self.p.bump();
        self.page_cell();
    }

    /// `(C 4,L 3)`
    fn page_cell(&mut self) {
        if !self.p.at(LParen) {
            self.expected("a cell, such as `(C 4,L 3)`");
            return;
        }
        let m = self.p.start();
        let start = self.p.position();
        self.p.bump();
        // `C4,L3` is an address and a label in PL7-2.
        while matches!(self.p.current(), Some(Ident | Number | Comma | ObjectAddress | LabelAddress))
            && self.p.position() < start + 6
            && !self.at_stop()
        {
            self.p.bump();
        }
        if !self.p.eat(RParen) {
            self.expected("`)`");
        }
        self.p.complete(m, PageCell);
    }

    /// Number or name of a step: `3`, `X3`, `%X2.1`, `M 2`, `Init`.
    fn step_name(&mut self) -> bool {
        let is_name = match self.p.current() {
            Some(Number | ObjectAddress) => true,
            Some(Ident) => self.word().is_none() || !matches!(self.word(), Some(Word::At | Word::From | Word::To)),
            _ => false,
        };
        if !is_name || self.at_stop() {
            return false;
        }
        let m = self.p.start();
        let is_prefix = self.p.at(Ident) && self.p.current_text().eq_ignore_ascii_case("M");
        self.p.bump();
        if is_prefix && self.p.at(Number) {
            self.p.bump();
        }
        self.p.complete(m, StepName);
        true
    }

    /// step = ('STEP' | 'INITIAL_STEP' | ...) name ['AT' cell] ':' (action | association)* 'END_STEP'
    fn step(&mut self, kind: StepKind) {
        let m = self.p.start();
        self.p.bump();
        if !self.step_name() && !matches!(kind, StepKind::In | StepKind::Out) {
            self.expected("the number of the step");
        }
        self.placement();
        let has_body = self.p.eat(Colon);
        let mut is_closed = false;
        loop {
            self.state.muted = false;
            match self.word() {
                Some(Word::EndStep) => {
                    self.p.bump();
                    self.p.eat(Semicolon);
                    is_closed = true;
                    break;
                }
                Some(Word::Action) => self.chart_action(),
                _ if self.at_stop() || self.at_chart_end() || !has_body => break,
                _ => self.association(),
            }
        }
        // Steps that only the assumed words name may have nothing behind their place.
        if !is_closed && (has_body || matches!(kind, StepKind::Initial | StepKind::Simple)) {
            self.expected("`END_STEP`");
        }
        self.p.complete(m, ChartStep);
    }

    /// Place and comment of an element, in any order.
    fn placement(&mut self) {
        loop {
            match self.word() {
                Some(Word::At) => self.place(),
                _ if self.p.at(CharString) => self.p.bump(),
                _ => return,
            }
        }
    }

    /// association = (name | bit) ['(' qualifier [',' time] ')'] ';'
    fn association(&mut self) {
        let m = self.p.start();
        if !matches!(self.p.current(), Some(Ident | ObjectAddress)) {
            self.expected("an action or `END_STEP`");
            self.skip_to(|_| false);
            self.p.abandon(m);
            return;
        }
        self.p.bump();
        if self.p.eat(LParen) {
            if ActionKind::of(self.p.current_text()).is_none() {
                self.expected("a qualifier, such as `N`");
            }
            while !matches!(self.p.current(), None | Some(RParen | Semicolon)) && !self.at_stop() {
                self.p.bump();
            }
            if !self.p.eat(RParen) {
                self.expected("`)`");
            }
        }
        if !self.p.eat(Semicolon) && !self.at_stop() {
            self.expected("`;`");
            self.skip_to(|g| g.p.at(Semicolon));
            self.p.eat(Semicolon);
        }
        self.p.complete(m, Association);
    }

    /// action = 'ACTION' ('(' qualifier ',' language ')' | name) ':' code 'END_ACTION'
    fn chart_action(&mut self) {
        let m = self.p.start();
        self.p.bump();
        let mut language = None;
        if self.p.eat(LParen) {
            let is_qualifier = ActionKind::of(self.p.current_text()).is_some();
            let is_language = CodeLanguage::of(self.p.current_text()).is_some();
            if !is_qualifier && !is_language {
                self.expected("`P1`, `N1` or `P0`");
            }
            while !matches!(self.p.current(), None | Some(RParen | Colon)) && !self.at_stop() {
                language = language.or(CodeLanguage::of(self.p.current_text()));
                self.p.bump();
            }
            if !self.p.eat(RParen) {
                self.expected("`)`");
            }
        } else if self.p.at(Ident) && self.word().is_none() {
            self.p.bump();
        } else {
            self.expected("`(P1,ST)`, or the name of the action");
        }
        self.placement();
        if !self.p.eat(Colon) {
            self.expected("`:`");
        }
        self.code(language);
        self.state.muted = false;
        if self.eat_word(Word::EndAction) {
            self.p.eat(Semicolon);
        } else {
            self.expected("`END_ACTION`");
        }
        self.p.complete(m, ChartAction);
    }

    /// transition = 'TRANSITION' [name] ['(' language ')'] ['AT' cell] ['FROM' steps 'TO' steps] (':' | ':=') code
    /// 'END_TRANSITION'
    fn transition(&mut self) {
        let m = self.p.start();
        self.p.bump();
        let mut language = None;
        // Behind its place, no name of it follows.
        let mut is_placed = false;
        loop {
            match (self.p.current(), self.word()) {
                (_, Some(Word::At)) => {
                    self.place();
                    is_placed = true;
                }
                (_, Some(Word::From | Word::To)) => {
                    self.transition_end();
                    is_placed = true;
                }
                (Some(LParen), _) => {
                    self.p.bump();
                    if CodeLanguage::of(self.p.current_text()).is_none() {
                        self.expected("`LD`, `IL` or `ST`");
                    }
                    while !matches!(self.p.current(), None | Some(RParen | Colon)) && !self.at_stop() {
                        language = language.or(CodeLanguage::of(self.p.current_text()));
                        self.p.bump();
                    }
                    if !self.p.eat(RParen) {
                        self.expected("`)`");
                        break;
                    }
                }
                (Some(CharString | Number | Arrow), _) => self.p.bump(),
                (Some(Ident | ObjectAddress), None) if !is_placed => self.p.bump(),
                _ => break,
            }
        }
        if !self.p.eat(Colon) && !self.p.eat(Assign) && self.word() != Some(Word::EndTransition) {
            self.expected("`:`");
        }
        self.state.is_receptivity = true;
        self.code(language);
        self.state.is_receptivity = false;
        self.state.muted = false;
        if self.eat_word(Word::EndTransition) {
            self.p.eat(Semicolon);
        } else {
            self.expected("`END_TRANSITION`");
        }
        self.p.complete(m, Transition);
    }

    /// `FROM X1`, `TO (X3,X4)`
    fn transition_end(&mut self) {
        let m = self.p.start();
        self.p.bump();
        let is_list = self.p.eat(LParen);
        loop {
            if !self.step_name() {
                self.expected("a step");
                break;
            }
            if !is_list || !self.p.eat(Comma) {
                break;
            }
        }
        if is_list && !self.p.eat(RParen) {
            self.expected("`)`");
            self.skip_to(|g| {
                matches!(g.p.current(), Some(RParen | Colon | Assign))
                    || matches!(g.word(), Some(Word::To | Word::From))
            });
            self.p.eat(RParen);
        }
        self.p.complete(m, TransitionEnd);
    }

    /// link = word 'FROM' cell 'TO' cell [':=' '[' segment (',' segment)* ']']
    fn link(&mut self) {
        let m = self.p.start();
        self.p.bump();
        self.link_ends();
        if self.p.eat(Assign) || self.p.at(LBrack) {
            if self.p.eat(LBrack) {
                while !matches!(self.p.current(), None | Some(RBrack)) && !self.at_stop() {
                    self.segment();
                    if !self.p.eat(Comma) && !self.p.at(RBrack) {
                        self.expected("`,` or `]`");
                        self.skip_to(|g| matches!(g.p.current(), Some(Comma | RBrack)));
                        self.p.eat(Comma);
                    }
                }
                if !self.p.eat(RBrack) {
                    self.expected("`]`");
                }
            } else {
                self.expected("`[`");
            }
        }
        self.p.eat(Semicolon);
        self.p.complete(m, ChartLink);
    }

    fn link_ends(&mut self) {
        for (word, name) in [(Word::From, "`FROM`"), (Word::To, "`TO`")] {
            if !self.eat_word(word) {
                self.expected(name);
                // A cell in its place is the end that the word belongs to.
                if !self.p.at(LParen) {
                    return;
                }
            }
            self.page_cell();
            while self.p.at(Comma) && self.p.nth(1) == Some(LParen) {
                self.p.bump();
                self.page_cell();
            }
        }
    }

    /// `H_LINK FROM (C 4,L 4) TO (C 5,L 4)`. Consumes at least one token.
    fn segment(&mut self) {
        if !matches!(self.word(), Some(Word::Segment(_))) {
            self.expected("`H_LINK` or `V_LINK`");
            let m = self.p.start();
            self.p.bump();
            while !matches!(self.p.current(), None | Some(RBrack)) && !self.at_stop() {
                if self.p.at(Comma) && self.p.nth(1) == Some(Ident) {
                    break;
                }
                self.p.bump();
            }
            self.p.complete(m, Error);
            return;
        }
        let m = self.p.start();
        self.p.bump();
        self.link_ends();
        self.p.complete(m, Segment);
    }

    /// connector = word step ['AT' cell]
    fn connector(&mut self) {
        let m = self.p.start();
        self.p.bump();
        if !self.step_name() {
            self.expected("the number of the step");
        }
        self.placement();
        self.p.eat(Colon);
        self.p.eat(Semicolon);
        self.p.complete(m, Connector);
    }

    /// A comment of the page: its text is a comment or in quotes.
    fn chart_comment(&mut self) {
        let m = self.p.start();
        self.p.bump();
        loop {
            match self.word() {
                Some(Word::At) => self.place(),
                Some(Word::EndComment) => {
                    self.p.bump();
                    break;
                }
                _ if matches!(self.p.current(), Some(CharString | Colon | Semicolon | Assign)) => self.p.bump(),
                _ => break,
            }
        }
        self.p.complete(m, ChartComment);
    }

    /// The code of an action or a receptivity, up to where an element ends or starts.
    fn code(&mut self, language: Option<CodeLanguage>) {
        match language.unwrap_or_else(|| self.guess_language()) {
            CodeLanguage::Ladder => self.ladder(),
            CodeLanguage::Il => self.sentences(Dialect::Il),
            CodeLanguage::St => self.sentences(Dialect::St),
        }
    }

    /// The language of code that does not say it.
    fn guess_language(&self) -> CodeLanguage {
        let mut n = 0;
        while matches!(self.p.nth(n), Some(SentenceStart | Bang | LabelAddress | Colon)) {
            n += 1;
        }
        let text = self.p.nth_text(n);
        let is_word = self.p.nth(n) == Some(Ident);
        if self.nth_keyword(n) == Some(Keyword::Rung) {
            return CodeLanguage::Ladder;
        }
        let has_operand = matches!(self.p.nth(n + 1), Some(ObjectAddress | Ident | LBrack | Number));
        if is_word && IlOp::of_word(text).is_some() && has_operand { CodeLanguage::Il } else { CodeLanguage::St }
    }

    fn ladder(&mut self) {
        while !self.at_stop() && !self.at_chart_end() {
            self.state.muted = false;
            if self.at_keyword(Keyword::Rung) {
                self.rungs();
            } else {
                self.unexpected("`RUNG`");
                self.skip_to(|g| g.at_keyword(Keyword::Rung));
            }
        }
    }

    fn sentences(&mut self, dialect: Dialect) {
        let outer = std::mem::replace(&mut self.state.dialect, dialect);
        while !self.at_stop() && !self.at_chart_end() {
            self.state.muted = false;
            let start = self.p.position();
            if self.p.at(SentenceEnd) {
                self.error("`(*END_PHRASE*)` without `(*PHRASE*)`");
                self.bump_error();
            } else if self.p.at(Elision) {
                self.p.bump();
            } else {
                self.sentence();
            }
            if self.p.position() == start {
                self.bump_error();
            }
        }
        self.state.dialect = outer;
    }
}

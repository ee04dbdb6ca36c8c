//! What the grammars of the languages share: errors, depth, recovery, the frame of a unit and its sentences.

use SyntaxKind::{
    Bang, CharString, Colon, Comma, Elision, Error, Heading, Ident, LBrack, LParen, LabelAddress, LabelDef, Minus,
    ObjectAddress, Percent, RBrack, RParen, Semicolon, Sentence, SentenceEnd, SentenceStart,
};
use rowan::TextRange;

use super::chart;
use super::dfb;
use super::functions;
use super::lexer::lex;
use super::word::{self, Keyword};
use crate::syntax::memo::Pieces;
use crate::syntax::parser::Known;
use crate::syntax::{Language, MAX_DEPTH, Marker, Memo, Parse, Parser, SyntaxKind, pl72};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    Il,
    St,
    Ld,
}

/// Whose operands and operations the text has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Code {
    Pl7,
    Pl72,
}

/// How many control structures of each kind are open.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Open {
    pub(super) ifs: u8,
    pub(super) whiles: u8,
    pub(super) repeats: u8,
    pub(super) fors: u8,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct State<'t> {
    /// The word that each significant token is: asked for often, told apart once.
    words: &'t [Option<Keyword>],
    pub(super) dialect: Dialect,
    pub(super) code: Code,
    /// Whether the statement or instruction at hand has been reported already: one error each.
    pub(super) muted: bool,
    /// Whether an unclosed comment hides the rest of the unit: nothing is missing at its end then.
    open_end: bool,
    depth: u32,
    pub(super) open: Open,
    /// Position of the token that ends the statement at hand, once a statement has asked.
    pub(super) next_end: usize,
    pub(super) is_scanned: bool,
    /// In a chart: the tokens before which the code of an action or a receptivity ends. Empty elsewhere.
    stops: &'t [bool],
    /// Whether the code at hand is a receptivity, where nothing is assigned.
    pub(super) is_receptivity: bool,
    /// The last word of a chart that was not known, which has been reported.
    pub(super) unknown: Option<&'t str>,
}

pub(super) struct Grammar<'p, 't> {
    pub(super) p: &'p mut Parser<'t>,
    pub(super) state: State<'t>,
}

/// Parses a unit. The actions and receptivities of a chart say their own languages.
pub(in crate::syntax) fn parse_with(text: &str, language: Language, memo: &mut Memo) -> Parse {
    let is_chart = language.is_chart();
    let dialect = match language {
        Language::Pl7Il => Dialect::Il,
        Language::Pl7Ld | Language::Pl72Ld => Dialect::Ld,
        _ => Dialect::St,
    };
    let (code, ladder, chart) = match language.is_pl7_2() {
        false => (Code::Pl7, Pieces::Ld, Pieces::Chart),
        true => (Code::Pl72, Pieces::Pl72Ld, Pieces::Pl72Chart),
    };
    let pieces = is_chart.then_some(chart).or((dialect == Dialect::Ld).then_some(ladder));
    let tokens = match code {
        Code::Pl7 => lex(text, pieces, memo),
        Code::Pl72 => pl72::lex(text, pieces, memo),
    };
    let open_end = tokens.unclosed_comment().is_some();
    let mut parser = Parser::new(text, &tokens, memo);
    let has_rungs = is_chart || dialect == Dialect::Ld;
    let words = parser.words(|text| Keyword::of(text).filter(|it| has_rungs || !it.is_of_ladder()));
    let is_dfb = !is_chart && code == Code::Pl7 && dfb::is_type(&parser);
    let stops = if is_chart {
        chart::stops(&parser)
    } else if is_dfb {
        dfb::stops(&parser)
    } else {
        Vec::new()
    };
    let state = State {
        words: &words,
        dialect,
        code,
        muted: false,
        open_end,
        depth: 0,
        open: Open::default(),
        next_end: 0,
        is_scanned: false,
        stops: &stops,
        is_receptivity: false,
        unknown: None,
    };
    let mut grammar = Grammar { p: &mut parser, state };
    if is_chart {
        grammar.chart();
    } else if is_dfb {
        grammar.dfb();
    } else {
        grammar.unit();
    }
    parser.finish()
}

impl<'t> Grammar<'_, 't> {
    /// dfb = head code 'END_FUNCTION_BLOCK'
    fn dfb(&mut self) {
        self.dfb_head();
        self.body();
        if self.at_stop() {
            self.dfb_end();
        } else {
            self.state.muted = false;
            self.expected("`END_FUNCTION_BLOCK`");
        }
    }

    /// unit = [heading] code
    fn unit(&mut self) {
        if self.at_task_line() {
            self.heading();
        }
        self.body();
    }

    /// code = (heading | program line | sentence | rung)*
    fn body(&mut self) {
        while !(self.p.at_end() || self.at_stop()) {
            self.state.muted = false;
            if self.at_heading() {
                self.heading();
            } else if self.at_program_line() {
                self.program_line();
            } else if self.p.at(SentenceEnd) {
                self.error("`(*END_PHRASE*)` without `(*PHRASE*)`");
                self.bump_error();
            } else if self.at_keyword(Keyword::Rung) {
                self.rungs();
            } else if self.state.dialect == Dialect::Ld {
                self.between_rungs();
            } else {
                self.sentence();
            }
        }
    }

    /// What the node of a piece depends on beside its text, where it is read as a `part`.
    pub(super) fn context(&self, part: Part, piece: &Known) -> u32 {
        let dialect = match self.state.dialect {
            Dialect::Il => 0,
            Dialect::St => 1,
            Dialect::Ld => 2,
        };
        // A piece has no more tokens than bits are left.
        let here = self.p.position();
        let stops = self.state.stops.get(here..here + piece.len).unwrap_or_default();
        let stops = stops.iter().fold(0, |stops, it| stops << 1 | u32::from(*it));
        (stops << 2 | dialect) << 4 | u32::from(self.state.is_receptivity) << 3 | part as u32
    }

    /// sentence = ['(*PHRASE*)'] ['!'] [label] content ['(*END_PHRASE*)']
    ///
    /// A label opens a sentence even where its `!` is missing, because it stands nowhere else (PL7:2989, 3489).
    pub(super) fn sentence(&mut self) {
        let known = self.p.piece().map(|it| (self.context(Part::Sentence, &it), it));
        if let Some((context, piece)) = &known
            && self.p.recall(piece, *context)
        {
            return;
        }
        let m = self.p.start();
        let start = self.p.position();
        let is_framed = self.p.eat(SentenceStart);
        self.p.eat(Bang);
        let mut is_closed = false;
        let mut content = Content::default();
        loop {
            self.state.muted = false;
            match self.p.current() {
                None | Some(Bang | SentenceStart) => break,
                Some(SentenceEnd) => {
                    if is_framed {
                        self.p.bump();
                        is_closed = true;
                    }
                    break;
                }
                Some(Elision) => self.p.bump(),
                Some(_) if self.at_label() => {
                    let is_first = content == Content::default();
                    if !is_first && !is_framed && content.parentheses == 0 {
                        break;
                    }
                    if !is_first && content.parentheses == 0 {
                        self.error("a label stands at the beginning of its sentence");
                    }
                    self.label();
                    content.has_label = true;
                }
                Some(Ident) if self.at_heading() || self.at_program_line() || self.at_stop() => break,
                Some(_) => match self.state.dialect {
                    Dialect::Il => self.instruction(&mut content),
                    Dialect::St | Dialect::Ld => {
                        self.statement(!content.has_code);
                        content.has_code = true;
                    }
                },
            }
        }
        if is_framed && !is_closed {
            self.state.muted = false;
            self.expected("`(*END_PHRASE*)`");
        }
        if self.p.position() == start {
            self.p.abandon(m);
        } else {
            self.p.complete(m, Sentence);
            if is_framed
                && is_closed
                && let Some((context, piece)) = known
            {
                self.p.remember(&piece, context, false);
            }
        }
    }

    /// `%L20` and `%L20 :`; the colon may be missing (PL7:3532).
    pub(super) fn at_label(&self) -> bool {
        match self.p.current() {
            Some(LabelAddress) => true,
            Some(Ident) => self.p.nth(1) == Some(Colon) && is_bare_label(self.p.current_text()),
            _ => false,
        }
    }

    pub(super) fn label(&mut self) {
        let m = self.p.start();
        self.p.bump_as(LabelAddress);
        self.p.eat(Colon);
        self.p.complete(m, LabelDef);
    }

    /// `ST : MAST - SR10`.
    pub(super) fn at_heading(&self) -> bool {
        self.p.at(Ident)
            && self.p.nth(1) == Some(Colon)
            && self.p.nth(2) == Some(Ident)
            && self.p.newline_before()
            && !self.p.nth_newline_before(2)
            && ["ST", "IL", "LD", "GR7"].iter().any(|it| self.p.at_text(it))
    }

    /// `MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)` (PL7:4650): a heading that names no language.
    pub(super) fn at_task_line(&self) -> bool {
        self.p.at(Ident)
            && self.p.nth(1) == Some(Minus)
            && self.p.nth(2) == Some(Ident)
            && !self.p.nth_newline_before(2)
            && ["MAST", "FAST"].iter().any(|it| self.p.at_text(it))
    }

    /// One that is understood starts a unit: what stands further down is none.
    pub(super) fn heading(&mut self) {
        if self.p.position() > 0 {
            self.error("this heading names no part of a program");
        }
        let m = self.p.start();
        self.p.bump();
        while !self.p.newline_before() && !self.p.at(SentenceStart) && !self.p.at(Bang) {
            self.p.bump();
        }
        self.p.complete(m, Heading);
    }

    /// `PROGRAM MAST'SR1'`, whose blanks may be missing, and `END_PROGRAM`.
    pub(super) fn at_program_line(&self) -> bool {
        if !self.p.at(Ident) {
            return false;
        }
        match self.keyword() {
            Some(Keyword::EndProgram) => true,
            Some(Keyword::Program) => self.p.newline_before(),
            Some(_) => false,
            None => {
                self.p.nth(1) == Some(CharString)
                    && self.p.current_text().get(..7).is_some_and(|it| it.eq_ignore_ascii_case("PROGRAM"))
            }
        }
    }

    pub(super) fn program_line(&mut self) {
        let is_end = self.keyword() == Some(Keyword::EndProgram);
        self.p.bump();
        if is_end {
            return;
        }
        while !self.p.newline_before() && matches!(self.p.current(), Some(Ident | CharString)) {
            let is_name = self.p.at(CharString);
            self.p.bump();
            if is_name {
                break;
            }
        }
    }

    pub(super) fn keyword(&self) -> Option<Keyword> {
        self.nth_keyword(0)
    }

    pub(super) fn nth_keyword(&self, n: usize) -> Option<Keyword> {
        self.state.words.get(self.p.position() + n).copied().flatten()
    }

    pub(super) fn at_keyword(&self, keyword: Keyword) -> bool {
        self.keyword() == Some(keyword)
    }

    pub(super) fn eat_keyword(&mut self, keyword: Keyword) -> bool {
        let found = self.at_keyword(keyword);
        if found {
            self.p.bump();
        }
        found
    }

    /// Whether nothing of this sentence follows.
    pub(super) fn at_boundary(&self) -> bool {
        match self.p.current() {
            None | Some(Bang | SentenceStart | SentenceEnd) => true,
            Some(Ident) => {
                self.keyword().is_some_and(Keyword::is_of_ladder) || self.at_program_line() || self.at_stop()
            }
            _ => false,
        }
    }

    /// Whether an element of a chart ends or starts here.
    pub(super) fn at_stop(&self) -> bool {
        self.nth_stops(0)
    }

    pub(super) fn nth_stops(&self, n: usize) -> bool {
        self.state.stops.get(self.p.position() + n).copied().unwrap_or(false)
    }

    /// Reports the current token, unless the statement has been reported.
    pub(super) fn error(&mut self, message: impl Into<String>) {
        self.error_at(self.p.current_range(), message);
    }

    pub(super) fn error_at(&mut self, range: TextRange, message: impl Into<String>) {
        if !self.state.muted {
            self.p.error_at(range, message);
            self.state.muted = true;
        }
    }

    /// Reports what is missing here: at the token that stands in its place, or behind the line that ends without it.
    pub(super) fn expected(&mut self, what: &str) {
        if self.state.muted || (self.p.at_end() && self.state.open_end) {
            self.p.fault();
            self.state.muted = true;
        } else if self.p.newline_before() && self.p.position() > 0 {
            self.error_at(self.p.previous_range(), format!("expected {what} after this"));
        } else {
            self.unexpected(what);
        }
    }

    /// Reports the current token, in the place of which something else must stand.
    pub(super) fn unexpected(&mut self, what: &str) {
        let found = self.p.current_text();
        let end = found.char_indices().nth(24).map_or(found.len(), |(at, _)| at);
        let found = if self.p.at_end() { "the end" } else { &found[..end] };
        self.error(format!("expected {what}, found `{found}`"));
    }

    /// The current token as an error node, without a report.
    pub(super) fn bump_error(&mut self) {
        let m = self.p.start();
        self.p.bump();
        self.p.complete(m, Error);
    }

    /// Runs `inner` one level deeper; `None`, after one report a statement, where that is too deep.
    pub(super) fn nested<T>(&mut self, inner: impl FnOnce(&mut Grammar<'_, 't>) -> T) -> Option<T> {
        if self.state.depth >= MAX_DEPTH && self.state.muted {
            return None;
        }
        let mut state = State { depth: self.state.depth + 1, ..self.state };
        let result = self.p.nested(|p| {
            let mut grammar = Grammar { p, state };
            let value = inner(&mut grammar);
            state = grammar.state;
            value
        });
        self.state = State { depth: self.state.depth, muted: state.muted || result.is_none(), ..state };
        result
    }

    /// Whether the n-th token from here can be the first of an operand.
    pub(super) fn nth_starts_operand(&self, n: usize) -> bool {
        matches!(self.p.nth(n), Some(ObjectAddress | Ident | Percent))
    }

    /// Whether a statement of its own starts here; a guess that is good enough to go on after an error.
    pub(super) fn at_statement_start(&self) -> bool {
        let assigns = |from| {
            (from..from + 12)
                .map_while(|it| self.p.nth(it).filter(|it| !matches!(it, Semicolon | Bang | SentenceEnd)))
                .any(|it| it == SyntaxKind::Assign)
        };
        match self.p.current() {
            Some(Ident) => match self.keyword() {
                Some(
                    Keyword::If
                    | Keyword::While
                    | Keyword::Repeat
                    | Keyword::For
                    | Keyword::Exit
                    | Keyword::Jump
                    | Keyword::Return
                    | Keyword::Halt,
                ) => true,
                Some(_) => false,
                None => {
                    let text = self.p.current_text();
                    self.p.nth(1) == Some(SyntaxKind::Assign)
                        || (self.nth_starts_operand(1) && functions::is_statement_word(text))
                        || (self.p.newline_before()
                            && (matches!(self.p.nth(1), Some(LParen | Semicolon))
                                || word::subroutine(text).is_some()
                                || assigns(1)))
                }
            },
            Some(ObjectAddress | Percent) => {
                self.p.nth(1) == Some(SyntaxKind::Assign) || (self.p.newline_before() && assigns(1))
            }
            Some(LabelAddress) => self.p.nth(1) == Some(Colon) || self.p.newline_before(),
            _ => false,
        }
    }

    /// Whether the current word ends or divides a control structure.
    pub(super) fn at_closer(&self) -> bool {
        matches!(
            self.keyword(),
            Some(
                Keyword::Elsif
                    | Keyword::Elseif
                    | Keyword::Else
                    | Keyword::EndIf
                    | Keyword::EndWhile
                    | Keyword::Until
                    | Keyword::EndRepeat
                    | Keyword::EndFor
            )
        )
    }

    /// Puts the tokens up to where `stop` holds, a statement ends or another starts into an error node.
    pub(super) fn skip_until(&mut self, stop: impl Fn(&Self) -> bool) {
        let mut marker: Option<Marker> = None;
        while !(stop(self)
            || self.p.at(Semicolon)
            || self.at_boundary()
            || self.at_closer()
            || self.at_statement_start())
        {
            marker.get_or_insert_with(|| self.p.start());
            self.p.bump();
        }
        if let Some(marker) = marker {
            self.p.complete(marker, Error);
        }
    }

    /// Like [`Self::skip_until`] inside parentheses: stops at the `,`, `)` or `]` that is not opened in between.
    pub(super) fn skip_item(&mut self) {
        let mut marker: Option<Marker> = None;
        let mut open = 0_u32;
        while !(self.p.at(Semicolon)
            || self.at_boundary()
            || self.at_closer()
            || self.at_header_end()
            || self.at_fresh_start())
        {
            match self.p.current() {
                Some(LParen | LBrack) => open += 1,
                Some(RParen | RBrack | Comma) if open == 0 => break,
                Some(RParen | RBrack) => open -= 1,
                _ => {}
            }
            marker.get_or_insert_with(|| self.p.start());
            self.p.bump();
        }
        if let Some(marker) = marker {
            self.p.complete(marker, Error);
        }
    }

    /// Whether a line begins with what does not go on with the line before.
    fn at_fresh_start(&self) -> bool {
        self.p.newline_before()
            && match self.state.dialect {
                Dialect::Il => true,
                Dialect::St => self.at_statement_start(),
                Dialect::Ld => false,
            }
    }

    fn at_header_end(&self) -> bool {
        matches!(self.keyword(), Some(Keyword::Then | Keyword::Do | Keyword::To))
    }
}

/// What may be a piece of text that is read before.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part {
    /// With its frame.
    Sentence,
    Cell,
    Row,
    /// Step, link or connector of a chart, before what starts an element.
    Element,
}

/// What a sentence holds so far.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Content {
    pub(super) has_label: bool,
    pub(super) has_code: bool,
    /// Parentheses that instructions of a list opened and none closed.
    pub(super) parentheses: u32,
    pub(super) block: BlockPart,
}

/// Part of the structured form of a function block (PL7:3294-3303).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum BlockPart {
    #[default]
    Outside,
    /// From `BLK` to `OUT_BLK`: instructions are named after the inputs.
    Inputs,
    /// From `OUT_BLK` to `END_BLK`: operands are named after the outputs.
    Outputs,
}

/// `L20`: a label whose `%` is missing.
fn is_bare_label(text: &str) -> bool {
    matches!(text.as_bytes(), [b'L' | b'l', digits @ ..] if !digits.is_empty() && digits.iter().all(u8::is_ascii_digit))
}

//! Rungs of ladder diagrams in the exchange form (PL7:2640-2840 for what they mean).
//!
//! A rung is rows of cells: `RUNG (*comment*) %L10: cell,cell,...; cell,...; END_RUNG`. What a cell is called, and what
//! stands in its parentheses, is in [`super::ladder_words`]; what stands there is read by the grammars of structured text.

use SyntaxKind::{
    Cell, CharString, Colon, Comma, Error, ExprStmt, Ident, LParen, LabelAddress, Number, ObjectAddress, Percent,
    RParen, Rung, RungRow, Semicolon,
};

use super::grammar::{Code, Dialect, Grammar, Part};
use super::ladder_words::{self, Shape};
use super::word::{self, Keyword};
use crate::syntax::SyntaxKind;

impl Grammar<'_, '_> {
    /// Rungs, as many as follow each other: the code of a section, of an action, of a receptivity. Stops at the first
    /// token that starts none; may be called whatever the dialect at hand.
    pub(super) fn rungs(&mut self) {
        let outer = std::mem::replace(&mut self.state.dialect, Dialect::Ld);
        while self.at_keyword(Keyword::Rung) {
            self.rung();
        }
        self.state.dialect = outer;
    }

    /// What stands between rungs and is none, up to the next one.
    pub(super) fn between_rungs(&mut self) {
        self.unexpected("`RUNG`");
        let m = self.p.start();
        self.p.bump();
        while !(self.p.at_end()
            || self.at_stop()
            || self.at_keyword(Keyword::Rung)
            || self.at_heading()
            || self.at_program_line())
        {
            self.p.bump();
        }
        self.p.complete(m, Error);
    }

    /// rung = 'RUNG' [label] row* 'END_RUNG'
    fn rung(&mut self) {
        let m = self.p.start();
        self.state.muted = false;
        self.p.bump();
        if self.at_label() {
            self.label();
        } else {
            self.p.eat(Colon);
        }
        loop {
            self.state.muted = false;
            if self.eat_keyword(Keyword::EndRung) {
                self.p.eat(Semicolon);
                break;
            }
            if self.ends_rung() {
                self.expected("`END_RUNG`");
                break;
            }
            self.row();
        }
        self.p.complete(m, Rung);
    }

    /// Whether nothing of this rung follows.
    fn ends_rung(&self) -> bool {
        match self.keyword() {
            Some(Keyword::EndRung | Keyword::Rung) => true,
            Some(Keyword::EndBlock) => false,
            _ => self.at_boundary() || self.at_heading() || self.p.at_end(),
        }
    }

    /// row = cell (',' cell)* ';'
    ///
    /// Consumes at least one token.
    fn row(&mut self) {
        let known = self.p.piece().map(|it| (self.context(Part::Row, &it), it));
        if let Some((context, piece)) = &known
            && self.p.recall(piece, *context)
        {
            return;
        }
        let m = self.p.start();
        loop {
            self.state.muted = false;
            match self.p.current() {
                Some(Semicolon) => {
                    self.p.bump();
                    break;
                }
                Some(Comma) => {
                    self.expected("an element of a rung");
                    self.bump_error();
                    continue;
                }
                _ if self.ends_rung() => {
                    self.expected("`;`");
                    break;
                }
                _ => self.cell(),
            }
            match self.p.current() {
                Some(Comma) => {
                    self.p.bump();
                    if self.p.at(Semicolon) {
                        self.expected("an element of a rung");
                    }
                }
                Some(Semicolon) => {}
                _ if self.ends_rung() => {}
                _ => {
                    self.expected("`,` or `;`");
                    if !self.is_cell_at(0) {
                        self.skip_cell();
                        self.p.eat(Comma);
                    }
                }
            }
        }
        self.p.complete(m, RungRow);
        if let Some((context, piece)) = known {
            self.p.remember(&piece, context, false);
        }
    }

    /// One cell. Consumes at least one token that ends neither row nor rung.
    fn cell(&mut self) {
        let known = self.p.piece().map(|it| (self.context(Part::Cell, &it), it));
        if let Some((context, piece)) = &known
            && self.p.recall(piece, *context)
        {
            return;
        }
        let m = self.p.start();
        let word = if self.p.at(Ident) { ladder_words::lookup(self.p.current_text()) } else { None };
        let Some(word) = word else {
            let text = self.p.current_text();
            if self.p.at(Ident) && text.len() <= 24 {
                self.error(format!("`{text}` is no element of a rung"));
            } else {
                self.expected("an element of a rung");
            }
            let junk = self.p.start();
            self.p.bump();
            self.skip_tokens();
            self.p.complete(junk, Error);
            self.p.complete(m, Cell);
            return;
        };
        match self.state.code {
            Code::Pl7 if !word.element.is_of_pl7() => self.error(format!("PL7 has no `{}`", word.text)),
            Code::Pl72 if !word.element.is_of_pl7_2() => self.error(format!("PL7-2 has no `{}`", word.text)),
            _ => {}
        }
        self.p.bump();
        match word.element.shape() {
            Shape::Comparison => {
                match self.state.code {
                    Code::Pl7 => {
                        self.expr();
                    }
                    Code::Pl72 => self.word_comparison(),
                }
                self.end_block();
            }
            Shape::Operation => {
                match self.state.code {
                    Code::Pl7 => self.operations(),
                    Code::Pl72 => self.word_operations(),
                }
                self.end_block();
            }
            shape => self.cell_operand(shape),
        }
        self.p.complete(m, Cell);
        if let Some((context, piece)) = known {
            self.p.remember(&piece, context, false);
        }
    }

    /// What stands in the parentheses behind a word.
    fn cell_operand(&mut self, shape: Shape) {
        let is_optional = matches!(shape, Shape::Bare | Shape::Count);
        if !self.p.eat(LParen) {
            if is_optional {
                return;
            }
            self.expected("`(`");
            // Where the other one closes the cell, this one alone is missing.
            if self.p.nth(1) != Some(RParen) {
                return;
            }
        }
        let is_read = match shape {
            Shape::Count => {
                self.p.at(Number) && {
                    self.literal();
                    true
                }
            }
            Shape::Label => {
                let is_label = self.p.at(LabelAddress);
                if is_label {
                    self.p.bump();
                } else if !self.p.at(RParen) {
                    self.expected("a label, such as `%L10`");
                    self.skip_cell();
                }
                is_label
            }
            Shape::Subroutine => {
                let is_call = matches!(self.p.current(), Some(Ident | ObjectAddress))
                    && word::subroutine(self.p.current_text()).is_some();
                if is_call {
                    self.p.bump_as(Ident);
                }
                is_call
            }
            Shape::Object => match self.p.current() {
                Some(CharString) => false,
                Some(Ident | ObjectAddress | Percent) => self.operand().is_some(),
                // The immediate bit (PL7:577).
                Some(Number) => self.operand().is_some(),
                _ => false,
            },
            Shape::Expression => self.expr().is_some(),
            Shape::Bare | Shape::Comparison | Shape::Operation => true,
        };
        if !is_read {
            self.expected(match shape {
                Shape::Count => "a number of cells",
                Shape::Label => "a label, such as `%L10`",
                Shape::Subroutine => "a subroutine",
                Shape::Expression => "an object or expression",
                _ => "an object",
            });
        }
        if !self.p.eat(RParen) {
            self.expected("`)`");
            let junk = self.p.start();
            let before = self.p.position();
            self.skip_tokens();
            self.p.eat(RParen);
            if self.p.position() == before {
                self.p.abandon(junk);
            } else {
                self.p.complete(junk, Error);
            }
        }
    }

    /// The statements of an operation block, up to its end.
    fn operations(&mut self) {
        loop {
            let statement = self.p.start();
            match self.action(false) {
                Some(ExprStmt) => {
                    self.p.complete(statement, ExprStmt);
                    self.expected("`:=`");
                }
                Some(kind) => {
                    self.p.complete(statement, kind);
                }
                None => {
                    self.p.abandon(statement);
                    self.expected("an operation");
                }
            }
            if !self.p.at(Semicolon) || self.at_row_end() {
                break;
            }
            self.p.bump();
            if self.at_keyword(Keyword::EndBlock) {
                break;
            }
        }
    }

    /// Whether the `;` at hand ends the row of a block that is not closed, rather than a statement in it.
    pub(super) fn at_row_end(&self) -> bool {
        self.p.nth(1).is_none()
            || matches!(self.nth_keyword(1), Some(Keyword::EndRung | Keyword::Rung))
            || self.is_cell_at(1)
    }

    fn end_block(&mut self) {
        if self.eat_keyword(Keyword::EndBlock) {
            return;
        }
        self.expected("`END_BLOCK`");
        let junk = self.p.start();
        let before = self.p.position();
        self.skip_tokens();
        if self.p.position() == before {
            self.p.abandon(junk);
        } else {
            self.p.complete(junk, Error);
        }
        self.eat_keyword(Keyword::EndBlock);
    }

    fn skip_cell(&mut self) {
        let m = self.p.start();
        let before = self.p.position();
        self.skip_tokens();
        if self.p.position() == before {
            self.p.bump();
        }
        self.p.complete(m, Error);
    }

    /// Up to the `,` or `;` that ends a cell, the end of a block, or the end of the rung.
    fn skip_tokens(&mut self) {
        let mut open = 0_u32;
        while !(self.ends_rung() || self.p.at(Semicolon) || self.at_keyword(Keyword::EndBlock)) {
            match self.p.current() {
                Some(LParen) => open += 1,
                Some(RParen) if open == 0 => return,
                Some(RParen) => open -= 1,
                Some(Comma) if open == 0 || self.is_cell_at(1) => return,
                _ => {}
            }
            self.p.bump();
        }
    }

    fn is_cell_at(&self, n: usize) -> bool {
        self.p.nth(n) == Some(Ident) && ladder_words::lookup(self.p.nth_text(n)).is_some()
    }
}

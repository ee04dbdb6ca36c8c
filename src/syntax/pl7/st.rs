//! Structured text (PL7:3402-4114).

use SyntaxKind::{
    Assign, AssignStmt, Bang, CallExpr, CallStmt, ElseArm, EmptyStmt, Eq, Error, ExprStmt, ForStmt, HaltStmt, Ident,
    IfArm, IfStmt, JumpStmt, LParen, LabelAddress, Number, ObjectAddress, Percent, RepeatStmt, ReturnStmt, Semicolon,
    SentenceEnd, SentenceStart, StmtList, WhileStmt,
};

use super::expr::Node;
use super::functions;
use super::grammar::{Grammar, Open};
use super::word::{self, Keyword};
use crate::syntax::SyntaxKind;

impl Grammar<'_, '_> {
    /// One statement with its `;`. `is_first` says that nothing stands before it in its sentence, so that it may be
    /// the expression of a receptivity (PL7:4733). Consumes at least one token.
    pub(super) fn statement(&mut self, is_first: bool) {
        let outer = std::mem::replace(&mut self.state.muted, false);
        let start = self.p.position();
        match self.p.current() {
            Some(Semicolon) => {
                let m = self.p.start();
                self.p.bump();
                self.p.complete(m, EmptyStmt);
            }
            Some(Ident) if self.at_keyword_statement() => self.keyword_statement(),
            Some(SyntaxKind::Elision) => self.p.bump(),
            Some(_) if self.at_label() => {
                self.error("a label stands at the beginning of a sentence, not inside a structure");
                self.label();
            }
            Some(_) => self.simple_statement(is_first),
            None => {}
        }
        if self.p.position() == start && !self.p.at_end() {
            self.expected("a statement");
            self.bump_error();
        }
        self.state.muted = outer;
    }

    /// Whether a word that only a statement of its own starts with, or one that closes what is not open, is next.
    fn at_keyword_statement(&self) -> bool {
        match self.keyword() {
            None | Some(Keyword::True | Keyword::False | Keyword::Not | Keyword::Re | Keyword::Fe) => false,
            Some(_) => true,
        }
    }

    fn keyword_statement(&mut self) {
        let Some(keyword) = self.keyword() else { return };
        let is_structure = match keyword {
            Keyword::If => self.structure(|g| g.if_statement()),
            Keyword::While => self.structure(|g| g.while_statement()),
            Keyword::Repeat => self.structure(|g| g.repeat_statement()),
            Keyword::For => self.structure(|g| g.for_statement()),
            Keyword::Exit => return self.word_statement(SyntaxKind::ExitStmt),
            Keyword::Return => return self.word_statement(ReturnStmt),
            Keyword::Halt => return self.word_statement(HaltStmt),
            Keyword::Jump => return self.jump_statement(),
            _ if self.at_closer() => return self.stray_closer(),
            _ => return self.junk("a statement"),
        };
        if !is_structure {
            self.skip_structure();
        }
    }

    /// Reads a control structure one level deeper; false, and nothing consumed, where that is too deep.
    fn structure(&mut self, inner: impl FnOnce(&mut Grammar<'_, '_>)) -> bool {
        let open = self.state.open;
        let is_read = self.nested(|g| inner(g)).is_some();
        self.state.open = open;
        is_read
    }

    /// if = 'IF' expr 'THEN' list ('ELSIF' expr 'THEN' list)* ['ELSE' list] 'END_IF'
    ///
    /// The manual writes `ELSIF` in its text and `ELSEIF` in its listing (PL7:3859, 3873).
    fn if_statement(&mut self) {
        let m = self.p.start();
        self.state.open.ifs += 1;
        loop {
            let arm = self.p.start();
            self.p.bump();
            self.header(Keyword::Then, "`THEN`");
            self.list();
            self.p.complete(arm, IfArm);
            if !matches!(self.keyword(), Some(Keyword::Elsif | Keyword::Elseif)) {
                break;
            }
        }
        while matches!(self.keyword(), Some(Keyword::Else | Keyword::Elsif | Keyword::Elseif)) {
            // Only one `ELSE`, and as the last arm: `list` of the first one stops in front of what is wrong.
            let arm = self.p.start();
            let is_else = self.at_keyword(Keyword::Else);
            self.p.bump();
            if !is_else {
                self.header(Keyword::Then, "`THEN`");
            }
            self.list();
            self.p.complete(arm, if is_else { ElseArm } else { IfArm });
            if matches!(self.keyword(), Some(Keyword::Else | Keyword::Elsif | Keyword::Elseif)) {
                self.error("nothing but `END_IF` follows the `ELSE` part");
            }
        }
        self.end(Keyword::EndIf, "`END_IF`");
        self.p.complete(m, IfStmt);
    }

    /// while = 'WHILE' expr 'DO' list 'END_WHILE'
    fn while_statement(&mut self) {
        let m = self.p.start();
        self.state.open.whiles += 1;
        self.p.bump();
        self.header(Keyword::Do, "`DO`");
        self.list();
        self.end(Keyword::EndWhile, "`END_WHILE`");
        self.p.complete(m, WhileStmt);
    }

    /// repeat = 'REPEAT' list 'UNTIL' expr 'END_REPEAT'
    fn repeat_statement(&mut self) {
        let m = self.p.start();
        self.state.open.repeats += 1;
        self.p.bump();
        self.list();
        if self.eat_keyword(Keyword::Until) {
            self.expr();
            self.p.eat(Semicolon);
            if !self.at_keyword(Keyword::EndRepeat) {
                self.expected("`END_REPEAT`");
                self.skip_until(|_| false);
                self.p.eat(Semicolon);
            }
        } else {
            self.expected("`UNTIL`");
        }
        self.end(Keyword::EndRepeat, "`END_REPEAT`");
        self.p.complete(m, RepeatStmt);
    }

    /// for = 'FOR' operand (':=' | '=') expr 'TO' expr 'DO' list 'END_FOR'
    ///
    /// The manual's own listing has the `=` (PL7:3949).
    fn for_statement(&mut self) {
        let m = self.p.start();
        self.state.open.fors += 1;
        self.p.bump();
        if self.operand().is_none() {
            self.expected("the index of the loop");
        }
        if !self.p.eat(Assign) && !self.p.eat(Eq) {
            self.expected("`:=`");
            self.skip_until(|g| matches!(g.keyword(), Some(Keyword::To | Keyword::Do)));
        } else {
            self.value();
        }
        if self.eat_keyword(Keyword::To) {
            self.value();
        } else {
            self.expected("`TO`");
        }
        self.reach(Keyword::Do, "`DO`");
        self.list();
        self.end(Keyword::EndFor, "`END_FOR`");
        self.p.complete(m, ForStmt);
    }

    /// Condition of a structure, up to the word behind it.
    fn header(&mut self, word: Keyword, name: &str) {
        self.expr();
        self.reach(word, name);
    }

    fn reach(&mut self, word: Keyword, name: &str) {
        if !self.eat_keyword(word) {
            self.expected(name);
            self.skip_until(|g| g.at_keyword(word));
            self.eat_keyword(word);
        }
    }

    /// Statements up to the word that continues or closes a structure which is open.
    fn list(&mut self) {
        let m = self.p.start();
        while !self.at_boundary() && !self.closes_open_structure() {
            self.statement(false);
        }
        self.p.complete(m, StmtList);
    }

    fn closes_open_structure(&self) -> bool {
        let Open { ifs, whiles, repeats, fors } = self.state.open;
        match self.keyword() {
            Some(Keyword::Elsif | Keyword::Elseif | Keyword::Else | Keyword::EndIf) => ifs > 0,
            Some(Keyword::EndWhile) => whiles > 0,
            Some(Keyword::Until | Keyword::EndRepeat) => repeats > 0,
            Some(Keyword::EndFor) => fors > 0,
            _ => false,
        }
    }

    /// Last word of a structure, with its `;`. A word that closes an outer structure is left to that one.
    fn end(&mut self, word: Keyword, name: &str) {
        if self.eat_keyword(word) {
            self.end_statement();
        } else {
            self.expected(name);
        }
    }

    /// `END_IF` and its like where nothing of the kind is open.
    fn stray_closer(&mut self) {
        self.error(format!("`{}` belongs to nothing that is open", self.p.current_text()));
        let m = self.p.start();
        self.p.bump();
        self.p.eat(Semicolon);
        self.p.complete(m, Error);
    }

    /// Reads a structure that is nested too deep flat, up to its end.
    fn skip_structure(&mut self) {
        let m = self.p.start();
        let mut open = 0_u32;
        while !self.at_boundary() {
            match self.keyword() {
                Some(Keyword::If | Keyword::While | Keyword::Repeat | Keyword::For) => open += 1,
                Some(Keyword::EndIf | Keyword::EndWhile | Keyword::EndRepeat | Keyword::EndFor) => {
                    open = open.saturating_sub(1);
                }
                _ => {}
            }
            self.p.bump();
            if open == 0 {
                break;
            }
        }
        self.p.eat(Semicolon);
        self.p.complete(m, Error);
    }

    fn word_statement(&mut self, kind: SyntaxKind) {
        let m = self.p.start();
        self.p.bump();
        self.end_statement();
        self.p.complete(m, kind);
    }

    fn jump_statement(&mut self) {
        let m = self.p.start();
        self.p.bump();
        if self.p.at(LabelAddress) {
            self.p.bump();
        } else if self.p.at(Ident) && self.keyword().is_none() && !self.p.newline_before() {
            self.name();
        } else {
            self.expected("a label");
        }
        self.end_statement();
        self.p.complete(m, JumpStmt);
    }

    /// An assignment, a call or an expression, with its `;`.
    fn simple_statement(&mut self, is_first: bool) {
        let m = self.p.start();
        let is_receptivity = is_first && (self.state.is_receptivity || self.is_last_of_sentence());
        let Some(kind) = self.action(is_receptivity) else {
            self.p.abandon(m);
            return self.junk("a statement");
        };
        if kind == ExprStmt && !(is_first && self.ends_sentence()) {
            self.expected("`:=` or `(`");
        }
        self.end_statement();
        self.p.complete(m, kind);
    }

    /// Whether no `;` separates what is at hand from the end of its sentence.
    fn is_last_of_sentence(&mut self) -> bool {
        let here = self.p.position();
        if self.state.next_end < here || !self.state.is_scanned {
            let is_end = |n: usize| match self.p.nth(n) {
                Some(Semicolon | Bang | SentenceStart | SentenceEnd | LabelAddress) | None => true,
                Some(Ident) => self.nth_stops(n) || self.p.nth_newline_before(n) && is_end_word(self.nth_keyword(n)),
                Some(_) => false,
            };
            // The place is kept, so that however many sentences ask, each token is looked at once.
            self.state.next_end = here + (0..).find(|n| is_end(*n)).unwrap_or(0);
            self.state.is_scanned = true;
        }
        self.p.nth(self.state.next_end - here) != Some(Semicolon)
    }

    fn ends_sentence(&self) -> bool {
        let n = usize::from(self.p.at(Semicolon));
        match self.p.nth(n) {
            None | Some(Bang | SentenceStart | SentenceEnd | LabelAddress) => true,
            Some(Ident) => self.nth_stops(n) || is_end_word(self.nth_keyword(n)),
            _ => false,
        }
    }

    /// What a statement or an action bracket holds, without `;`. The node is the caller's to complete under the kind
    /// that is returned; `None`, and nothing consumed, if nothing fits.
    ///
    /// `=` reads as the assignment that was meant (the rule that reports it has the fix), except in a receptivity.
    pub(super) fn action(&mut self, is_receptivity: bool) -> Option<SyntaxKind> {
        let text = self.p.current_text();
        let is_object = match self.p.current()? {
            Ident => self.keyword().is_none() && self.p.nth(1) != Some(LParen),
            kind => matches!(kind, ObjectAddress | Percent),
        };
        let lhs = match self.p.current()? {
            Ident if self.keyword().is_none() => match self.p.nth(1) {
                Some(Assign) => self.name(),
                Some(LParen) => {
                    let callee = self.p.start();
                    self.p.bump();
                    let height = self.arguments();
                    if !self.at_operator() {
                        self.p.abandon(callee);
                        return Some(CallStmt);
                    }
                    Node { completed: self.p.complete(callee, CallExpr), height }
                }
                Some(Number) if text.eq_ignore_ascii_case("SR") => {
                    self.p.bump();
                    self.literal();
                    return Some(CallStmt);
                }
                Some(ObjectAddress | Ident | Percent) if functions::is_statement_word(text) => {
                    self.p.bump();
                    if self.operand().is_none() {
                        self.expected("an operand");
                    } else if self.p.at(LParen) {
                        // `SMOVE %CH3.0 (1,90,...)`.
                        self.arguments();
                    }
                    return Some(CallStmt);
                }
                _ if word::subroutine(text).is_some() => {
                    self.p.bump();
                    return Some(CallStmt);
                }
                _ if functions::is_statement_word(text) && !self.nth_is_operator(1) => {
                    self.p.bump();
                    self.expected("an operand");
                    return Some(CallStmt);
                }
                _ => self.name(),
            },
            ObjectAddress if word::subroutine(text).is_some() && self.p.nth(1) != Some(Assign) => {
                self.p.bump_as(Ident);
                return Some(CallStmt);
            }
            _ => match self.operand() {
                Some(lhs) => lhs,
                None if self.starts_expression() => {
                    self.expr();
                    return Some(ExprStmt);
                }
                None => return None,
            },
        };
        if self.p.at(Assign) || (self.p.at(Eq) && !is_receptivity) {
            if !is_object {
                self.error(format!("`{}` needs an object on its left", self.p.current_text()));
            }
            self.p.bump();
            self.value();
            return Some(AssignStmt);
        }
        self.condition_from(lhs);
        Some(ExprStmt)
    }

    fn nth_is_operator(&self, n: usize) -> bool {
        matches!(self.p.nth(n), Some(Assign | Eq | SyntaxKind::Dot | SyntaxKind::LBrack | SyntaxKind::ObjectSuffix))
    }

    fn starts_expression(&self) -> bool {
        matches!(self.p.current(), Some(LParen | SyntaxKind::LBrack | SyntaxKind::Plus | SyntaxKind::Minus))
            || matches!(self.keyword(), Some(Keyword::Not | Keyword::Re | Keyword::Fe))
    }

    /// Tokens that start no statement, up to where the next one is likely.
    fn junk(&mut self, wanted: &str) {
        self.expected(wanted);
        let m = self.p.start();
        self.p.bump();
        self.p.complete(m, Error);
        self.skip_until(|_| false);
        self.p.eat(Semicolon);
    }

    /// The `;`. It separates (PL7:3478), so that the last statement of a list or a sentence may go without.
    fn end_statement(&mut self) {
        if self.p.eat(Semicolon) || self.at_boundary() || self.at_closer() || self.p.at(SyntaxKind::Elision) {
            return;
        }
        if self.p.at(LabelAddress) && self.p.newline_before() {
            return;
        }
        self.expected("`;`");
        if !self.at_statement_start() {
            self.skip_until(|_| false);
            self.p.eat(Semicolon);
        }
    }
}

fn is_end_word(word: Option<Keyword>) -> bool {
    matches!(word, Some(Keyword::Program | Keyword::EndProgram))
}

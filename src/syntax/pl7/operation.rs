//! Operands, comparisons and operations of PL7-2 (PL72:945-1109).
//!
//! They take the same nodes as those of PL7: `W1 + W2 -> W3` is an assignment whose target stands last, `BTA W0` a call
//! without parentheses.

use SyntaxKind::{
    Arrow, AssignStmt, BinExpr, CallExpr, Comma, Eq, ExprStmt, Ge, Gt, Ident, LBrack, LParen, Le, Lt, Minus, Ne,
    Number, ObjectAddress, Percent, Plus, RBrack, RParen, Semicolon, Slash, Star, UnaryExpr,
};

use super::expr::Node;
use super::grammar::Grammar;
use super::word::Keyword;
use crate::syntax::SyntaxKind;

/// Operations on one operand, by their code; a rotation says its number of bits, in the code or behind it.
pub(super) const CODES: [&str; 5] = ["CPL", "BIN", "BCD", "BTA", "ATB"];
pub(super) const ROTATIONS: [&str; 2] = ["SLC", "SRC"];

/// Whether a word is the code of an operation on one operand: `CPL`, `SLC`, `SLC3`.
pub(super) fn is_code(text: &str) -> bool {
    let letters = text.trim_end_matches(|it: char| it.is_ascii_digit());
    let is_rotation = ROTATIONS.iter().any(|it| it.eq_ignore_ascii_case(letters));
    is_rotation || letters.len() == text.len() && CODES.iter().any(|it| it.eq_ignore_ascii_case(text))
}

impl Grammar<'_, '_> {
    /// An address, which blanks may part before its string length or index, and before its item where nothing else can
    /// be meant: `W5 (W10)`, `OPEN_CONTACT(D1, F)` (PL72:884 prints the blank).
    pub(super) fn word_address(&mut self) {
        if self.p.at(Percent) {
            self.p.bump_as(ObjectAddress);
            if !matches!(self.p.current(), Some(Ident | ObjectAddress)) || self.p.newline_before() {
                return;
            }
        }
        self.p.bump_as(ObjectAddress);
        let is_index = self.p.at(LParen) && self.p.nth(1) == Some(ObjectAddress) && self.p.nth(2) == Some(RParen);
        let is_length = self.p.at(LBrack) && self.p.nth(1) == Some(Number) && self.p.nth(2) == Some(RBrack);
        let is_item =
            self.p.at(Comma) && matches!(self.p.nth(1), Some(Ident | Number)) && self.p.nth(2) == Some(RParen);
        if (is_index || is_length) && !self.p.newline_before() {
            for _ in 0..3 {
                self.p.bump_as(ObjectAddress);
            }
        } else if is_item && !self.p.nth_newline_before(1) && self.p.nth_text(1).len() <= 3 {
            self.p.bump_as(ObjectAddress);
            self.p.bump_as(ObjectAddress);
        }
    }

    /// comparison = operand ('>' | '<' | '=' | '>=' | '<=' | '<>') operand
    pub(super) fn word_comparison(&mut self) {
        let Some(lhs) = self.word_operand() else { return };
        if !matches!(self.p.current(), Some(Gt | Lt | Eq | Ge | Le | Ne)) {
            return self.expected("a comparison");
        }
        let m = self.p.precede(lhs.completed);
        self.p.bump();
        self.word_operand();
        self.p.complete(m, BinExpr);
    }

    /// The operation of a block. What is written as several is read, and reported.
    pub(super) fn word_operations(&mut self) {
        self.word_operation();
        while self.p.at(Semicolon) && !self.at_row_end() && !self.nth_is_end_block(1) {
            self.error("a block of PL7-2 holds one operation");
            self.p.bump();
            self.word_operation();
        }
        if self.p.at(Semicolon) && self.nth_is_end_block(1) {
            self.p.bump();
        }
    }

    fn nth_is_end_block(&self, n: usize) -> bool {
        self.nth_keyword(n) == Some(Keyword::EndBlock)
    }

    /// operation = value '->' object
    fn word_operation(&mut self) {
        let m = self.p.start();
        let start = self.p.position();
        self.operation_value();
        if self.p.position() == start {
            return self.p.abandon(m);
        }
        if !self.p.eat(Arrow) {
            self.expected("`->`");
            self.p.complete(m, ExprStmt);
            return;
        }
        if matches!(self.p.current(), Some(Ident | ObjectAddress | Percent)) && self.operand().is_some() {
            self.p.complete(m, AssignStmt);
        } else {
            self.expected("an object");
            self.p.complete(m, AssignStmt);
        }
    }

    /// value = code operand | operand [operator operand]
    fn operation_value(&mut self) {
        if self.p.at(Ident) && is_code(self.p.current_text()) {
            let m = self.p.start();
            let needs_count = ROTATIONS.iter().any(|it| self.p.at_text(it));
            self.p.bump();
            if needs_count {
                if self.p.at(Number) {
                    self.literal();
                } else {
                    self.expected("a number of bits");
                }
            }
            self.word_operand();
            self.p.complete(m, CallExpr);
            return;
        }
        let Some(lhs) = self.word_operand() else { return };
        let is_operator = matches!(self.p.current(), Some(Plus | Minus | Star | Slash))
            || matches!(self.keyword(), Some(Keyword::And | Keyword::Or | Keyword::Xor | Keyword::Rem));
        if is_operator {
            let m = self.p.precede(lhs.completed);
            self.p.bump();
            self.word_operand();
            self.p.complete(m, BinExpr);
        }
    }

    /// An object or a value, which may have a sign.
    fn word_operand(&mut self) -> Option<Node> {
        if matches!(self.p.current(), Some(Minus | Plus)) && self.p.nth(1) == Some(Number) {
            let m = self.p.start();
            self.p.bump();
            self.literal();
            return Some(Node { completed: self.p.complete(m, UnaryExpr), height: 2 });
        }
        let operand = self.operand();
        if operand.is_none() {
            self.expected("a word or a value");
        }
        operand
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::AstNode as _;
    use crate::syntax::pl7::ast::ObjectRef;
    use crate::target::pl72::OPERATIONS;

    #[test]
    fn codes_are_those_of_the_table() {
        for it in OPERATIONS {
            assert_eq!(is_code(it.code), !it.binary, "{}", it.code);
        }
        assert!(is_code("SLC3") && is_code("src15") && !is_code("BTA1") && !is_code("W1") && !is_code(""));
    }

    /// The messages for a network with one cell of a kind.
    fn errors(row: &str) -> Vec<String> {
        let text = format!("RUNG L1:\n{row}\nEND_RUNG\nRUNG L2:\nH_LINK(9),COIL(B0);\nEND_RUNG\n");
        let parse = crate::syntax::pl7::parse_pl7_2_ld(&text);
        assert_eq!(parse.syntax().text(), text.as_str());
        parse.errors().iter().map(|it| it.message.clone()).collect()
    }

    #[test]
    fn one_error_for_what_is_wrong_in_a_block() {
        for cell in ["127 -> W10", "W1+W2->W3", "CPL W1 → W2", "SLC3 W1 -> W1", "SRC 15 W1 -> W1", "W5 (W10) -> W1"] {
            assert_eq!(errors(&format!("H_LINK(7),OPERATE {cell} END_BLOCK;")), [""; 0], "{cell}");
        }
        for cell in [
            "W1",
            "-> W1",
            "W1 ->",
            "W1 + -> W2",
            "W1 + W2 + W3 -> W4",
            "SLC W1 -> W2",
            "BTA -> W2",
            "W3 := W1",
            "",
            "W1 -> 5",
            "W1 -> W2; W3 -> W4",
            "W5(W1 + 2) -> W1",
        ] {
            assert_eq!(errors(&format!("H_LINK(7),OPERATE {cell} END_BLOCK;")).len(), 1, "{cell}");
        }
        for cell in ["W1 > ", "W1 + 5", "> 5", "W1 > 5 AND W2 > 5"] {
            assert_eq!(errors(&format!("COMPARE {cell} END_BLOCK,H_LINK(7),COIL(B0);")).len(), 1, "{cell}");
        }
    }

    #[test]
    fn elements_that_only_one_language_has() {
        for cell in ["CALL_COIL(SR5)", "RETURN_COIL", "HALT_COIL"] {
            assert_eq!(errors(&format!("H_LINK(9),{cell};")).len(), 1, "{cell}");
        }
        assert_eq!(errors("H_LINK(9),SAVE_COIL(B5);"), [""; 0]);
        let pl7 = crate::syntax::pl7::parse_ld("RUNG\nH_LINK(10),SAVE_COIL(%M5);\nEND_RUNG\n");
        assert_eq!(pl7.errors().len(), 1);
    }

    #[test]
    fn blanks_in_addresses() {
        let address = |operand: &str| {
            let text = format!("RUNG L1:\nOPEN_CONTACT({operand}),H_LINK(8),COIL(B0);\nEND_RUNG\n");
            let parse = crate::syntax::pl7::parse_pl7_2_ld(&text);
            assert_eq!(parse.errors(), [], "{operand}");
            let object = parse.syntax().descendants().find_map(ObjectRef::cast);
            object.map(|it| it.address().to_string())
        };
        for (text, expected) in
            [("D1, F", "D1,F"), ("W5 (W10)", "W5(W10)"), ("B0 [8]", "B0[8]"), ("% B5", "%B5"), ("I0,05", "I0,05")]
        {
            assert_eq!(address(text).as_deref(), Some(expected), "{text}");
        }
    }
}

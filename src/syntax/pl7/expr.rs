//! Expressions, which brackets share between the languages.

use SyntaxKind::{
    Assign, BinExpr, CallExpr, CharString, Colon, Comma, Dot, Eq, Error, Ge, Gt, Ident, Index, LBrack, LParen, Le,
    Literal, Lt, Minus, NameRef, Ne, Number, ObjectAddress, ObjectRef, ObjectSuffix, ParenExpr, Percent, Plus, RBrack,
    RParen, Semicolon, Slash, Star, TypedConstant, UnaryExpr,
};

use super::grammar::{Code, Dialect, Grammar};
use super::instructions::IlOp;
use super::word::Keyword;
use crate::syntax::{Completed, SyntaxKind};

/// Operators in a row beyond this are reported and read flat, so that whoever walks a tree needs no more stack than
/// this and the depth of parentheses ask for.
pub(super) const MAX_HEIGHT: u16 = 256;

/// A finished expression, and how many levels it is high.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) completed: Completed,
    pub(super) height: u16,
}

/// Binding power, weakest first (PL7:4056-4086). Operators of one level are taken from the left (PL7:4088).
const ASSIGN: u8 = 1;
const OR: u8 = 2;
const XOR: u8 = 3;
const AND: u8 = 4;
const EQUALITY: u8 = 5;
const ORDER: u8 = 6;
const SUM: u8 = 7;
const PRODUCT: u8 = 8;

impl Grammar<'_, '_> {
    /// An expression in a condition, an argument or an index. `:=` is read as the weakest operator there, because
    /// the rule that reports it knows more than the grammar.
    pub(super) fn expr(&mut self) -> Option<Node> {
        self.expr_above(ASSIGN)
    }

    /// The value of an assignment, in which a second `:=` has no meaning.
    pub(super) fn value(&mut self) -> Option<Node> {
        self.expr_above(OR)
    }

    fn expr_above(&mut self, weakest: u8) -> Option<Node> {
        let lhs = self.prefix()?;
        Some(self.expr_from(lhs, weakest))
    }

    /// Goes on with the operators behind an operand that has been read.
    pub(super) fn condition_from(&mut self, lhs: Node) -> Node {
        self.expr_from(lhs, ASSIGN)
    }

    fn expr_from(&mut self, mut lhs: Node, weakest: u8) -> Node {
        while let Some(power) = self.operator().filter(|it| *it >= weakest) {
            if lhs.height >= MAX_HEIGHT {
                self.error(format!("more than {MAX_HEIGHT} operators in a row are not read"));
                self.skip_item();
                break;
            }
            let m = self.p.precede(lhs.completed);
            self.p.bump();
            let rhs = self.expr_above(power + 1);
            let height = rhs.map_or(0, |it| it.height).max(lhs.height) + 1;
            lhs = Node { completed: self.p.complete(m, BinExpr), height };
        }
        lhs
    }

    /// Binding power of the operator at hand.
    pub(super) fn operator(&self) -> Option<u8> {
        Some(match self.p.current()? {
            Plus | Minus => SUM,
            Star | Slash => PRODUCT,
            Lt | Le | Gt | Ge => ORDER,
            Eq | Ne => EQUALITY,
            Assign => ASSIGN,
            Ident => match self.keyword()? {
                Keyword::And => AND,
                Keyword::Or => OR,
                Keyword::Xor => XOR,
                Keyword::Rem => PRODUCT,
                _ => return None,
            },
            _ => return None,
        })
    }

    pub(super) fn at_operator(&self) -> bool {
        self.operator().is_some()
    }

    fn at_prefix_operator(&self) -> bool {
        matches!(self.p.current(), Some(Plus | Minus))
            || matches!(self.keyword(), Some(Keyword::Not | Keyword::Re | Keyword::Fe))
    }

    /// prefix = ('NOT' | '-' | '+' | 'RE' | 'FE') prefix | '(' expr ')' | '[' expr ']' | operand
    fn prefix(&mut self) -> Option<Node> {
        if self.at_prefix_operator() {
            let m = self.p.start();
            self.p.bump();
            let operand = self.nested(|g| g.prefix());
            if operand.is_none() && self.at_prefix_operator() {
                let junk = self.p.start();
                while self.at_prefix_operator() {
                    self.p.bump();
                }
                self.p.complete(junk, Error);
            }
            let height = operand.flatten().map_or(0, |it| it.height) + 1;
            return Some(Node { completed: self.p.complete(m, UnaryExpr), height });
        }
        match self.p.current() {
            Some(LParen) => Some(self.parentheses(RParen, "`)`")),
            Some(LBrack) => Some(self.parentheses(RBrack, "`]`")),
            Some(SyntaxKind::Elision) => {
                // The tables of the manual write `LD[.....]` (PL7:3124).
                let m = self.p.start();
                self.p.bump();
                Some(Node { completed: self.p.complete(m, Literal), height: 1 })
            }
            _ => {
                let operand = self.operand();
                if operand.is_none() {
                    self.expected("an operand");
                }
                operand
            }
        }
    }

    fn parentheses(&mut self, close: SyntaxKind, name: &str) -> Node {
        let m = self.p.start();
        self.p.bump();
        let inner = self.nested(|g| g.expr());
        self.close(close, name);
        let height = inner.flatten().map_or(0, |it| it.height).saturating_add(1);
        Node { completed: self.p.complete(m, ParenExpr), height }
    }

    /// The closing token, if need be after junk.
    fn close(&mut self, close: SyntaxKind, name: &str) {
        if self.p.eat(close) {
            return;
        }
        self.expected(name);
        self.skip_item();
        // A comma that separates nothing is junk as well.
        while self.p.at(Comma) {
            self.bump_error();
            self.skip_item();
        }
        self.p.eat(close);
    }

    /// operand = literal | object | name | name '(' arguments ')'
    ///
    /// Nothing is consumed and nothing reported if there is none.
    pub(super) fn operand(&mut self) -> Option<Node> {
        match self.p.current()? {
            Number | TypedConstant => Some(self.literal()),
            CharString => {
                if !is_closed(self.p.current_text()) {
                    self.error("the text has no closing quote");
                }
                Some(self.literal())
            }
            ObjectAddress | Percent => Some(self.object()),
            Ident => match self.keyword() {
                Some(Keyword::True | Keyword::False) => Some(self.literal()),
                Some(_) => None,
                None if self.starts_next_instruction() => None,
                None if self.p.nth(1) == Some(LParen) => Some(self.call_expr()),
                None => Some(self.name()),
            },
            _ => None,
        }
    }

    /// In a list, a mnemonic at the start of a line is the next instruction, not what is missing in this one.
    fn starts_next_instruction(&self) -> bool {
        self.state.dialect == Dialect::Il && self.p.newline_before() && IlOp::of_word(self.p.current_text()).is_some()
    }

    pub(super) fn literal(&mut self) -> Node {
        let m = self.p.start();
        self.p.bump();
        Node { completed: self.p.complete(m, Literal), height: 1 }
    }

    /// object = address [index] [suffix]
    ///
    /// Documents print blanks inside addresses: `%MW 99`, `%C8 .D`, `%X20 .T[%MW5]`. All pieces of the address
    /// become `ObjectAddress` tokens, so that together they say what one token usually does.
    pub(super) fn object(&mut self) -> Node {
        let m = self.p.start();
        if self.state.code == Code::Pl72 {
            self.word_address();
            return Node { completed: self.p.complete(m, ObjectRef), height: 1 };
        }
        if self.p.at(Percent) {
            self.p.bump_as(ObjectAddress);
            if self.p.at(Ident) && !self.p.newline_before() {
                self.address_word();
            }
        } else {
            self.address_word();
        }
        while self.at_item() {
            self.p.bump_as(ObjectAddress);
            self.p.bump_as(ObjectAddress);
        }
        let height = self.index_and_suffix();
        Node { completed: self.p.complete(m, ObjectRef), height }
    }

    /// `%MW10`, or `%MW` with its number behind a blank.
    fn address_word(&mut self) {
        let has_number = self.p.current_text().contains(|it: char| it.is_ascii_digit());
        self.p.bump_as(ObjectAddress);
        if !has_number && self.p.at(Number) && !self.p.newline_before() {
            self.p.bump_as(ObjectAddress);
        }
    }

    /// `.D`, if need be with blanks, on the same line.
    fn at_item(&self) -> bool {
        self.p.at(Dot)
            && matches!(self.p.nth(1), Some(Ident | Number))
            && !self.p.newline_before()
            && !self.p.nth_newline_before(1)
    }

    /// name = ident ('.' item)* [index] [suffix]
    ///
    /// Addresses without their `%` read as names: `MW108[%MW2]`, `X3.T`, `I1.0`.
    pub(super) fn name(&mut self) -> Node {
        let m = self.p.start();
        self.p.bump();
        while self.at_item() {
            self.p.bump();
            self.p.bump();
        }
        let height = self.index_and_suffix();
        Node { completed: self.p.complete(m, NameRef), height }
    }

    fn index_and_suffix(&mut self) -> u16 {
        self.suffixes();
        let mut height = 1;
        if self.at_index() {
            let m = self.p.start();
            self.p.bump();
            let inner = self.nested(|g| g.expr());
            height = inner.flatten().map_or(0, |it| it.height).saturating_add(2);
            self.close(RBrack, "`]`");
            self.p.complete(m, Index);
            self.suffixes();
        }
        height
    }

    fn suffixes(&mut self) {
        loop {
            if self.p.newline_before() {
                break;
            }
            match self.p.current() {
                Some(ObjectSuffix) => self.p.bump(),
                Some(Colon) if !self.p.nth_newline_before(1) && is_suffix_word(self.p.nth(1), self.p.nth_text(1)) => {
                    self.p.bump_as(ObjectSuffix);
                    self.p.bump_as(ObjectSuffix);
                }
                _ => break,
            }
        }
    }

    /// In a list, `LD %M0 [%MW0:=5]` are two instructions on one line, but `%MW100 [%MW99]` is one object.
    fn at_index(&self) -> bool {
        if !self.p.at(LBrack) {
            return false;
        }
        if self.state.dialect != Dialect::Il || !self.p.nth_gap_before(0) {
            return true;
        }
        let is_operand = |n| matches!(self.p.nth(n), Some(ObjectAddress | Ident | Number));
        !self.p.newline_before()
            && is_operand(1)
            && (self.p.nth(2) == Some(RBrack)
                || (matches!(self.p.nth(2), Some(Plus | Minus)) && is_operand(3) && self.p.nth(4) == Some(RBrack)))
    }

    fn call_expr(&mut self) -> Node {
        let m = self.p.start();
        self.p.bump();
        let height = self.arguments();
        Node { completed: self.p.complete(m, CallExpr), height }
    }

    /// arguments = '(' [expr] (',' [expr])* ')'
    ///
    /// A position may be empty: the pin of a DFB that is left open.
    pub(super) fn arguments(&mut self) -> u16 {
        self.p.bump();
        let highest = self.nested(|g| {
            let mut highest = 0;
            loop {
                match g.p.current() {
                    None | Some(RParen | Semicolon) => return highest,
                    Some(Comma) => g.p.bump(),
                    Some(_) => {
                        let before = g.p.position();
                        highest = highest.max(g.expr().map_or(0, |it| it.height));
                        if !matches!(g.p.current(), Some(Comma | RParen)) {
                            g.expected("`,` or `)`");
                            g.skip_item();
                        }
                        if g.p.position() == before {
                            return highest;
                        }
                    }
                }
            }
        });
        self.close(RParen, "`)`");
        highest.unwrap_or(0).saturating_add(1)
    }
}

fn is_closed(text: &str) -> bool {
    // An escaped quote is not the closing one.
    let Some(inner) = text.strip_prefix('\'').and_then(|it| it.strip_suffix('\'')) else { return false };
    let mut chars = inner.chars();
    while let Some(char) = chars.next() {
        if char == '$' && chars.next().is_none() {
            return false;
        }
    }
    true
}

/// What stands behind a `:` that blanks separate from its object: `10`, `X4`.
fn is_suffix_word(kind: Option<SyntaxKind>, text: &str) -> bool {
    match kind {
        Some(Number) => true,
        Some(Ident) => {
            matches!(text.as_bytes(), [b'X' | b'x', digits @ ..] if !digits.is_empty() && digits.iter().all(u8::is_ascii_digit))
        }
        _ => false,
    }
}

//! Instruction list (PL7:2918-3370).

use SyntaxKind::{
    Bang, Bracket, CharString, Colon, Elision, Error, ExprStmt, Ident, IlInstr, LBrack, LParen, LabelAddress, Literal,
    Number, ObjectAddress, Percent, RBrack, RParen, SentenceEnd, SentenceStart, TypedConstant,
};

use super::grammar::{BlockPart, Content, Grammar};
use super::instructions::{Class, IlOp, Operand};
use super::word::{self, Keyword};
use crate::syntax::SyntaxKind;

impl Grammar<'_, '_> {
    /// One instruction, or what stands where one should. Consumes at least one token.
    pub(super) fn instruction(&mut self, content: &mut Content) {
        content.has_code = true;
        let m = self.p.start();
        match self.p.current() {
            Some(RParen) => {
                self.p.bump();
                content.parentheses = content.parentheses.saturating_sub(1);
            }
            Some(LBrack) => self.bracket(true),
            Some(_) => match self.mnemonic() {
                Some(op) => self.operation(op, content),
                None => {
                    let text = self.p.current_text();
                    if self.p.at(Ident) && text.len() <= 24 {
                        self.error(format!("`{text}` is no instruction"));
                    } else {
                        self.expected("an instruction");
                    }
                    self.skip_line();
                    self.p.complete(m, Error);
                    return;
                }
            },
            None => {}
        }
        if !self.at_next_instruction() {
            self.expected("the next instruction");
            let junk = self.p.start();
            self.skip_line();
            self.p.complete(junk, Error);
        }
        self.p.complete(m, IlInstr);
    }

    /// Operation of the current token, if it is a mnemonic or `%SR5`.
    fn mnemonic(&self) -> Option<IlOp> {
        let text = self.p.current_text();
        match self.p.current()? {
            Ident => IlOp::of_word(text),
            ObjectAddress if word::subroutine(text).is_some() => Some(IlOp::Sr),
            _ => None,
        }
    }

    /// Whether what follows does not belong to the instruction at hand: several may share a line.
    fn at_next_instruction(&self) -> bool {
        self.p.newline_before()
            || matches!(
                self.p.current(),
                None | Some(RParen | LBrack | LabelAddress | Elision | Bang | SentenceStart | SentenceEnd)
            )
            || self.mnemonic().is_some()
            || self.at_boundary()
    }

    /// The rest of a line that makes no sense, up to a mnemonic that is hardly a word by chance.
    fn skip_line(&mut self) {
        self.p.bump();
        while !self.at_next_instruction() || (self.p.current_text().len() == 1 && self.p.at(Ident)) {
            if self.p.newline_before() {
                break;
            }
            self.p.bump();
        }
    }

    fn operation(&mut self, op: IlOp, content: &mut Content) {
        let is_numbered = !self.p.current_text().eq_ignore_ascii_case("SR");
        self.p.bump_as(Ident);
        if self.p.at(LParen) && !self.p.newline_before() && op.info().class == Class::Test {
            if !matches!(op, IlOp::And | IlOp::Or) {
                self.error("only `AND` and `OR` open a parenthesis");
            }
            self.p.bump();
            content.parentheses += 1;
            if self.at_modifier() {
                self.p.bump();
            }
        }
        match op {
            IlOp::Blk => content.block = BlockPart::Inputs,
            IlOp::OutBlk => content.block = BlockPart::Outputs,
            IlOp::EndBlk => content.block = BlockPart::Outside,
            _ => {}
        }
        match op.info().operand {
            Operand::None => {}
            Operand::Label => self.label_operand(),
            Operand::Subroutine => {
                if !is_numbered {
                    if self.p.at(Number) && !self.p.newline_before() {
                        self.literal();
                    } else {
                        self.expected("the number of a subroutine");
                    }
                }
            }
            Operand::BitOrBlock | Operand::Input if content.block == BlockPart::Inputs => {
                if !self.p.newline_before() && self.mnemonic().is_none() {
                    self.il_operand();
                }
            }
            _ => {
                if !self.il_operand() {
                    self.expected("an operand");
                }
            }
        }
    }

    /// `N`, `R` or `F` behind `AND(` or `OR(`, with its operand on the same line (PL7:3174-3181).
    fn at_modifier(&self) -> bool {
        self.p.at(Ident)
            && ["N", "R", "F"].iter().any(|it| self.p.at_text(it))
            && !self.p.newline_before()
            && !self.p.nth_newline_before(1)
            && matches!(self.p.nth(1), Some(ObjectAddress | Percent | Ident | LBrack | Number))
    }

    fn label_operand(&mut self) {
        let is_definition = self.p.newline_before() && self.p.nth(1) == Some(Colon);
        if self.p.at(LabelAddress) && !is_definition {
            self.p.bump();
        } else if self.p.at(Ident) && !self.p.newline_before() && self.mnemonic().is_none() {
            self.name();
        } else {
            self.expected("a label");
        }
    }

    /// Operand of an instruction; false, and nothing consumed, if there is none.
    fn il_operand(&mut self) -> bool {
        let is_fresh_line = self.p.newline_before();
        match self.p.current() {
            Some(ObjectAddress) if is_fresh_line && self.mnemonic().is_some() => return false,
            Some(ObjectAddress | Percent | Number | TypedConstant | CharString) => {
                self.operand();
            }
            Some(LBrack) if !is_fresh_line => self.bracket(false),
            Some(Ident) if !is_fresh_line => {
                if matches!(self.keyword(), Some(Keyword::True | Keyword::False)) {
                    self.literal();
                } else if self.mnemonic().is_none_or(|op| self.is_output_name(op)) && self.keyword().is_none() {
                    self.name();
                } else {
                    return false;
                }
            }
            Some(Elision) if !is_fresh_line => {
                let m = self.p.start();
                self.p.bump();
                self.p.complete(m, Literal);
            }
            _ => return false,
        }
        true
    }

    /// Whether a word that is also a mnemonic names the output of a block: `LD R` behind `OUT_BLK` of a monostable.
    fn is_output_name(&self, op: IlOp) -> bool {
        let is_short = matches!(op, IlOp::N | IlOp::S | IlOp::R | IlOp::I | IlOp::O | IlOp::U);
        let has_operand = !self.p.nth_newline_before(1)
            && match self.p.nth(1) {
                Some(Ident) => IlOp::of_word(self.p.nth_text(1)).is_none(),
                Some(RParen | Bang | SentenceStart | SentenceEnd) | None => false,
                Some(_) => true,
            };
        is_short && !has_operand
    }

    /// `[%MW10:=%MW0+100]` as an action, `[%MW10<1000]` as the operand of a test (PL7:3119-3127).
    fn bracket(&mut self, is_action: bool) {
        let m = self.p.start();
        self.p.bump();
        if is_action {
            let statement = self.p.start();
            match self.action(false) {
                Some(ExprStmt) => {
                    self.p.abandon(statement);
                    self.expected("`:=`");
                }
                Some(kind) => {
                    self.p.complete(statement, kind);
                }
                None if self.p.at(Elision) => {
                    self.p.abandon(statement);
                    self.p.bump();
                }
                None => {
                    self.p.abandon(statement);
                    self.expected("an operation");
                }
            }
        } else {
            self.expr();
        }
        if !self.p.eat(RBrack) {
            self.expected("`]`");
            self.skip_item();
            self.p.eat(RBrack);
        }
        self.p.complete(m, Bracket);
    }
}

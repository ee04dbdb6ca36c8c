//! Recursive descent over the tokens of a unit. No construct nests but the index of a table's bit, which is read flat.
//!
//! Recovery: a fault costs its line.

use super::instruction;
use super::lexer::{is_area, is_block, is_constant};
use crate::syntax::awl::instruction::{Op, OperandRule};
use crate::syntax::{Mnemonics, Parser, SyntaxKind};

use SyntaxKind::*;

pub(super) fn root(p: &mut Parser<'_>, mnemonics: Mnemonics) {
    let mut grammar = Grammar { p, mnemonics };
    while !grammar.p.at_end() {
        match grammar.heading() {
            Some(heading) => grammar.block(heading),
            None => grammar.listing(),
        }
    }
}

/// The tokens of a heading.
#[derive(Debug, Clone, Copy)]
struct Heading {
    /// Of `BLOC` and its colon.
    before: usize,
    /// Of the name: `PB 10`, `PB10`.
    name: usize,
    is_data: bool,
}

struct Grammar<'p, 't> {
    p: &'p mut Parser<'t>,
    mnemonics: Mnemonics,
}

impl Grammar<'_, '_> {
    // Lines and recovery.

    /// Behind the last token of a line, or before what ends the segment.
    fn at_line_end(&self) -> bool {
        self.p.newline_before()
    }

    fn skip_line(&mut self) {
        if self.at_line_end() {
            return;
        }
        let error = self.p.start();
        while !self.at_line_end() {
            self.p.bump();
        }
        self.p.complete(error, Error);
    }

    /// Reports and skips a line from its current token on, which is at least that.
    fn bad_line(&mut self, message: impl Into<String>) {
        self.p.error(message);
        let error = self.p.start();
        self.p.bump();
        while !self.at_line_end() {
            self.p.bump();
        }
        self.p.complete(error, Error);
    }

    /// The remark in the last column of a print.
    fn remark(&mut self) {
        while !self.at_line_end() {
            self.p.bump_as(Comment);
        }
    }

    /// Behind an instruction: the end of the line, a remark, or the next instruction.
    fn end_instruction(&mut self) {
        if self.at_line_end() || self.p.at(SegmentEnd) || self.op_here().is_some() && !self.p.in_next_column() {
            return;
        }
        if self.p.in_next_column() {
            return self.remark();
        }
        self.p.error("expected the end of the instruction");
        self.skip_line();
    }

    // Blocks.

    /// `PB 10`, `FB5`, `BAUSTEIN : OB 1`, alone on its line, or with what a print says of it behind.
    fn heading(&self) -> Option<Heading> {
        if !self.p.newline_before() || !matches!(self.p.current(), Some(Ident)) {
            return None;
        }
        let says_block = ["BAUSTEIN", "BLOCK", "BLOC", "BLOQUE"].into_iter().any(|it| self.p.at_text(it));
        let before = match (says_block, self.p.nth(1)) {
            (true, Some(Colon)) => 2,
            (true, _) => 1,
            (false, _) => 0,
        };
        let same_line = |at: usize| !self.p.nth_newline_before(at);
        let word = self.p.nth_text(before);
        let letters = word.get(..2).filter(|it| is_block(it))?;
        let name = match (self.p.nth(before), self.p.nth(before + 1)) {
            (Some(Address), _) => 1,
            (Some(Ident), _) if word.len() > 2 && word[2..].bytes().all(|it| it.is_ascii_digit()) => 1,
            (Some(Ident), Some(Number)) if word.len() == 2 && same_line(before + 1) => 2,
            _ => return None,
        };
        if (1..before + name).any(|at| !same_line(at)) {
            return None;
        }
        let after = before + name;
        let ends = !same_line(after)
            || self.p.nth(after) == Some(Colon) && !same_line(after + 1)
            || self.p.nth(after) == Some(Ident) && self.p.nth(after + 1) == Some(Eq)
            || self.p.nth(after) == Some(Comma);
        let is_data = letters.starts_with(['D', 'd']);
        ends.then_some(Heading { before, name, is_data })
    }

    fn block(&mut self, heading: Heading) {
        let block = self.p.start();
        let header = self.p.start();
        for _ in 0..heading.before {
            self.p.bump();
        }
        let name = self.p.start();
        for _ in 0..heading.name {
            self.p.bump();
        }
        self.p.complete(name, BlockName);
        // `LAE=22  BLATT 1`
        while !self.at_line_end() {
            self.p.bump();
        }
        self.p.complete(header, BlockHeader);
        while !self.p.at_end() && self.heading().is_none() {
            if self.p.at(Ident) && self.p.nth(1) == Some(Colon) && self.p.nth(2) == Some(FreeText) {
                self.attribute();
            } else if self.at_formal_operand() {
                self.formal_operand();
            } else if heading.is_data {
                self.data_line();
            } else {
                self.network(true);
            }
        }
        self.p.complete(block, Block);
    }

    fn listing(&mut self) {
        let listing = self.p.start();
        while !self.p.at_end() && self.heading().is_none() {
            self.network(false);
        }
        self.p.complete(listing, Listing);
    }

    /// `NAME :INITG1`
    fn attribute(&mut self) {
        let attribute = self.p.start();
        self.p.bump();
        self.p.bump();
        self.p.eat(FreeText);
        self.p.complete(attribute, BlockAttribute);
    }

    fn at_formal_operand(&self) -> bool {
        const WORDS: [&str; 6] = ["BEZ", "DEZ", "DES", "DECL", "DESI", "BEZEICHNUNG"];
        self.p.newline_before()
            && self.p.nth(1) == Some(Colon)
            && self.p.nth(2) == Some(Ident)
            && !self.p.nth_newline_before(2)
            && WORDS.into_iter().any(|it| self.p.at_text(it))
    }

    /// `BEZ :EIN  E/A/D/B/T/Z: E  BI/BY/W/D: BI`, or the letters alone: `DECL :EIN  I BI`.
    fn formal_operand(&mut self) {
        let section = self.p.start();
        self.p.bump();
        self.p.bump();
        let decl = self.p.start();
        let name = self.p.start();
        self.p.bump();
        self.p.complete(name, VarName);
        while !self.at_line_end() {
            let is_choice = matches!(self.p.nth(1), Some(Slash | Colon)) && !self.p.nth_newline_before(1);
            if self.p.at(Ident) && !is_choice {
                let ty = self.p.start();
                self.p.bump();
                self.p.complete(ty, TypeRef);
            } else {
                self.p.bump();
                // The last of several to choose from: `E/A/D/B/T/Z:`.
                if self.p.at(Ident) && !self.at_line_end() && self.p.nth(1) == Some(Colon) {
                    self.p.bump();
                }
            }
        }
        self.p.complete(decl, VarDecl);
        self.p.complete(section, VarSection);
    }

    /// `0: KH = 0000;`: words of a data block.
    fn data_line(&mut self) {
        if matches!(self.p.current(), Some(SegmentEnd | Elision)) || self.p.at(Ident) && self.p.at_text("BE") {
            return self.p.bump();
        }
        let init = self.p.start();
        if self.p.at(Number) && self.p.nth(1) == Some(Colon) {
            let operand = self.p.start();
            self.p.bump();
            self.p.complete(operand, Operand);
            self.p.bump();
        }
        let starts = self.p.at(Ident) && self.p.nth(1) == Some(Eq) || self.p.at(TypedConstant);
        if !starts || self.p.newline_before() && !matches!(self.p.current(), Some(Ident | TypedConstant)) {
            self.bad_line("expected words of the data block such as `0: KH = 0000;`");
        } else {
            let value = self.p.start();
            self.p.bump();
            while !self.at_line_end() {
                self.p.bump();
            }
            self.p.complete(value, InitValue);
        }
        self.p.complete(init, DataInit);
    }

    // Code.

    /// One segment, up to its `***`. Consumes a token at least, unless a heading stands here.
    fn network(&mut self, in_block: bool) {
        let network = self.p.start();
        if self.at_segment_heading() {
            let header = self.p.start();
            while {
                self.p.bump();
                !self.at_line_end()
            } {}
            self.p.complete(header, NetworkHeader);
        }
        while let Some(kind) = self.p.current() {
            if self.heading().is_some() || in_block && self.at_formal_operand() {
                break;
            }
            if let Some(tokens) = self.at_label().filter(|it| self.p.nth(*it) == Some(SegmentEnd))
                && !self.p.nth_newline_before(tokens)
                && self.p.nth(tokens.saturating_sub(2)) != Some(Ident)
            {
                // `0010 :***`
                for _ in 0..tokens {
                    self.p.bump();
                }
                continue;
            }
            match kind {
                SegmentEnd => {
                    self.p.bump();
                    if !self.at_line_end() && self.op_here().is_none() {
                        self.remark();
                    }
                    break;
                }
                Elision => self.p.bump(),
                _ if self.at_segment_heading() => break,
                _ if self.p.newline_before() && self.p.nth(1) == Some(Colon) && self.p.nth(2) == Some(FreeText) => {
                    self.attribute();
                }
                _ => self.instruction(),
            }
        }
        self.p.complete(network, Network);
    }

    /// `NETZWERK 1`, `SEGMENT 2   0010`
    fn at_segment_heading(&self) -> bool {
        const WORDS: [&str; 6] = ["NETZWERK", "SEGMENT", "NETWORK", "RESEAU", "RÉSEAU", "SEGMENTO"];
        self.p.newline_before()
            && self.p.at(Ident)
            && self.p.nth(1) == Some(Number)
            && !self.p.nth_newline_before(1)
            && WORDS.into_iter().any(|it| self.p.at_text(it))
    }

    /// Address, label and colon before an instruction.
    fn at_label(&self) -> Option<usize> {
        if !self.p.newline_before() {
            return None;
        }
        let address = usize::from(self.p.at(Number));
        let name = usize::from(self.p.nth(address) == Some(Ident));
        let colon = address + name;
        let on_line = (1..=colon).all(|at| !self.p.nth_newline_before(at));
        (on_line && self.p.nth(colon) == Some(Colon)).then_some(colon + 1)
    }

    fn instruction(&mut self) {
        let instr = self.p.start();
        if let Some(tokens) = self.at_label() {
            let label = self.p.start();
            for _ in 0..tokens {
                self.p.bump();
            }
            self.p.complete(label, Label);
            if self.at_line_end() || self.p.at(SegmentEnd) {
                self.p.complete(instr, Instr);
                return;
            }
        } else if self.p.newline_before() && self.p.at(Number) && !self.p.nth_newline_before(1) {
            // An address without a colon.
            self.p.bump();
        }
        match self.op_here() {
            Some((op, tokens)) => self.known(op, tokens),
            None => self.unknown(),
        }
        self.p.complete(instr, Instr);
    }

    /// The instruction that starts here, and the tokens of its mnemonic.
    fn op_here(&self) -> Option<(Op, usize)> {
        let text = self.p.current_text();
        let next = if self.p.nth_newline_before(1) { None } else { self.p.nth(1) };
        match self.p.current()? {
            Ident => {
                let with = |last: u8| instruction::lookup_before(text, last, self.mnemonics).map(|it| (it, 2));
                let longer = match next {
                    Some(LParen) => with(b'('),
                    Some(Eq) => with(b'='),
                    _ => None,
                };
                longer.or_else(|| instruction::lookup(text, self.mnemonics).map(|it| (it, 1)))
            }
            Operator => {
                let (sign, letter) = text.split_at(text.len() - 1);
                let bare = [sign.trim_end(), letter].concat();
                instruction::lookup(&bare, self.mnemonics).map(|it| (it, 1))
            }
            Eq => Some((Op::Assign, 1)),
            RParen => Some((Op::Close, 1)),
            _ => None,
        }
    }

    fn known(&mut self, op: Op, tokens: usize) {
        let word = self.p.current_text();
        self.p.bump_as(if self.p.at(Eq) { Operator } else { self.p.current().unwrap_or(Ident) });
        if tokens == 2 {
            self.p.bump_as(if self.p.at(Eq) { Operator } else { LParen });
        }
        let callee = self.p.current_text();
        let rule = match op {
            Op::Nop if word.len() == 4 => OperandRule::None,
            // `LIR 0`, but a print may leave the number out.
            _ => op.operand(),
        };
        match rule {
            OperandRule::None => {}
            OperandRule::Optional(_) if !self.at_operand() || self.op_is_next() => {}
            OperandRule::Optional(kind) | OperandRule::Required(kind) => {
                if !self.operand() {
                    let range = if self.at_line_end() { self.p.previous_range() } else { self.p.current_range() };
                    self.p.error_at(range, format!("`{word}` needs {} as its operand", kind.describe()));
                    return self.skip_line();
                }
            }
        }
        let calls_function_block =
            matches!(op, Op::CallUnconditional | Op::CallConditional) && callee.starts_with(['F', 'f', '-', '=']);
        if matches!(op, Op::AndOpen | Op::OrOpen) && !self.at_line_end() && self.op_here().is_some() {
            return;
        }
        self.end_instruction();
        if calls_function_block {
            self.parameters();
        }
    }

    /// Behind an `O` that may have an operand: whether the next instruction stands there (`O U X20`, GRF:370).
    fn op_is_next(&self) -> bool {
        self.op_here().is_some() && !self.at_line_end() && self.p.nth(1).is_some() && !self.p.nth_newline_before(1)
    }

    fn at_operand(&self) -> bool {
        !self.at_line_end()
            && matches!(
                self.p.current(),
                Some(Address | TypedConstant | Number | Ident | QuotedSymbol | Eq | Plus | Minus)
            )
    }

    /// Whether an operand stood here.
    fn operand(&mut self) -> bool {
        if !self.at_operand() {
            return false;
        }
        let operand = self.p.start();
        let on_line = !self.p.nth_newline_before(1);
        match self.p.current() {
            Some(Eq) if on_line && matches!(self.p.nth(1), Some(Ident | Address)) => {
                self.p.bump();
                self.p.bump_as(Ident);
            }
            Some(Plus | Minus) if on_line && self.p.nth(1) == Some(Number) => {
                self.p.bump();
                self.p.bump();
            }
            Some(Eq | Plus | Minus) => {
                self.p.abandon(operand);
                return false;
            }
            Some(Ident) => {
                // `M Ts[100]`: the letter of the area, and the table (GRF:382).
                if is_area(self.p.current_text())
                    && on_line
                    && self.p.nth(1) == Some(Ident)
                    && self.p.nth(2) == Some(LBrack)
                {
                    self.p.bump();
                }
                self.p.bump();
                self.table_index();
            }
            _ => self.p.bump(),
        }
        self.p.complete(operand, Operand);
        true
    }

    /// `[20]` of a bit of a table, without brackets in it.
    fn table_index(&mut self) {
        if self.at_line_end() || !self.p.at(LBrack) {
            return;
        }
        self.p.bump();
        while !self.at_line_end() && !matches!(self.p.current(), Some(LBrack | RBrack) | None) {
            self.p.bump();
        }
        if !self.at_line_end() {
            self.p.eat(RBrack);
        }
    }

    fn unknown(&mut self) {
        let word = self.p.current_text();
        let message = match self.p.current() {
            Some(Ident | Operator) => {
                let hint = match (instruction::only_in(word), self.mnemonics) {
                    (Some(Mnemonics::German), Mnemonics::English) => {
                        "; it is a German mnemonic, and this program is read with the international ones"
                    }
                    (Some(Mnemonics::English), Mnemonics::German) => {
                        "; it is an international mnemonic, and this program is read with the German ones"
                    }
                    _ => "",
                };
                format!("unknown instruction `{word}`{hint}")
            }
            _ => "expected an instruction".to_owned(),
        };
        self.bad_line(message);
    }

    /// The lines below the call of a function block: its name, and its parameters.
    fn parameters(&mut self) {
        if !self.at_parameter() {
            return;
        }
        let list = self.p.start();
        while self.at_parameter() {
            if self.p.nth(2) == Some(FreeText) {
                self.attribute();
                continue;
            }
            let arg = self.p.start();
            if self.p.at(Number) {
                self.p.bump();
            }
            self.p.bump();
            self.p.bump();
            let operand = self.p.start();
            self.p.bump();
            while !self.at_line_end() && !self.p.in_next_column() {
                self.p.bump();
            }
            self.p.complete(operand, Operand);
            self.remark();
            self.p.complete(arg, Arg);
        }
        self.p.complete(list, ArgList);
    }

    /// `EIN :E 0.0`, and not an instruction behind a label: one operand stands behind the colon.
    fn at_parameter(&self) -> bool {
        let Some(at) = self.at_label().filter(|it| *it >= 2 && self.p.nth(it - 2) == Some(Ident)) else { return false };
        if self.p.nth_newline_before(at) {
            return false;
        }
        let word = self.p.nth_text(at);
        let next = if self.p.nth_newline_before(at + 1) { None } else { self.p.nth(at + 1) };
        let is_mnemonic = |text: &str| instruction::lookup(text, self.mnemonics).is_some();
        match (self.p.nth(at), next) {
            (Some(FreeText | Address | TypedConstant), _) => true,
            (Some(Ident), Some(Number)) => {
                let counts = matches!(word, "I" | "D" | "i" | "d") && !self.p.nth_text(at + 1).contains('.');
                (is_area(word) || is_constant(word)) && !counts
            }
            (Some(Ident), Some(Plus | Minus | Ident)) if is_constant(word) => true,
            (Some(Ident), None) => !is_mnemonic(word),
            (Some(Minus), Some(Ident)) => true,
            (Some(Eq), Some(Ident)) => !is_area(self.p.nth_text(at + 1)) && self.p.nth_newline_before(at + 2),
            _ => false,
        }
    }
}

//! The result of logic operation: logic strings, nesting, and what acts on it.

use rowan::TextRange;
use smol_str::SmolStr;

use super::operands::Operand;
use super::{Machine, mnemonic_text};
use crate::model::expr::ExprId;
use crate::model::object::{Class, Type};
use crate::model::unit::{OddityKind, Pin};
use crate::syntax::AstNode as _;
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::Op;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RloState {
    Known,
    /// Nothing of the block set it.
    FromCaller,
    /// A called block left it.
    AfterCall,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Rlo {
    pub(super) state: RloState,
    pub(super) value: ExprId,
}

/// A logic string whose result nothing has used yet.
#[derive(Debug, Clone)]
pub(super) struct LogicString {
    /// From the first check on.
    pub(super) range: TextRange,
    /// First instruction since that does not depend on the RLO.
    pub(super) ignoring: Option<(TextRange, SmolStr)>,
}

#[derive(Debug, Clone)]
pub(super) struct Nest {
    pub(super) op: Op,
    pub(super) range: TextRange,
    pub(super) rlo: Rlo,
    pub(super) fresh: bool,
    pub(super) or_base: Option<ExprId>,
    pub(super) string: Option<LogicString>,
}

impl Machine {
    /// The value that an instruction which uses the RLO sees.
    pub(super) fn rlo_value(&mut self) -> ExprId {
        match self.or_base {
            Some(base) => {
                let term = self.rlo.value;
                self.b.exprs().or(base, term)
            }
            None => self.rlo.value,
        }
    }

    /// Ends the logic string: its result was used.
    pub(super) fn limit(&mut self) {
        let value = self.rlo_value();
        self.rlo.value = value;
        self.or_base = None;
        self.fresh = true;
        self.string = None;
    }

    /// An instruction acts on the RLO: reports one that nothing in the block computed.
    pub(super) fn use_rlo(&mut self, range: TextRange, text: &str) -> ExprId {
        if self.fresh && self.b.is_reachable() {
            let kind = match self.rlo.state {
                RloState::Known => None,
                RloState::FromCaller => Some(OddityKind::RloFromCaller),
                RloState::AfterCall => Some(OddityKind::RloAfterCall),
            };
            if let Some(kind) = kind {
                self.b.oddity(kind, range, text);
                // One report a cause: what follows acts on the same RLO.
                let value = self.b.exprs().opaque();
                self.rlo = Rlo { state: RloState::Known, value };
            }
        }
        self.rlo_value()
    }

    /// A new value overwrites the RLO, or the block ends: a string that nothing used is lost.
    pub(super) fn discard(&mut self, by: TextRange) {
        let Some(string) = self.string.take() else { return };
        if self.fresh || !self.b.is_reachable() {
            return;
        }
        match string.ignoring {
            Some((range, text)) => {
                let oddity = self.b.oddity(OddityKind::UnconditionalAfterTest, range, text);
                oddity.related.push((string.range, "the test"));
            }
            None => {
                let oddity = self.b.oddity(OddityKind::RloUnused, string.range, "");
                oddity.related.push((by, "the result is lost here"));
            }
        }
    }

    /// A check of a bit: combines it with the RLO.
    pub(super) fn check(&mut self, op: Op, value: ExprId, range: TextRange) {
        let negated = matches!(op, Op::AndNot | Op::OrNot | Op::XorNot);
        let value = if negated { self.b.exprs().not(value) } else { value };
        let combined = if self.fresh {
            value
        } else {
            let left = self.rlo.value;
            match op {
                Op::Or | Op::OrNot => {
                    let left = self.rlo_value();
                    self.or_base = None;
                    self.b.exprs().or(left, value)
                }
                Op::Xor | Op::XorNot => {
                    let left = self.rlo_value();
                    self.or_base = None;
                    self.b.exprs().xor(left, value)
                }
                _ => self.b.exprs().and(left, value),
            }
        };
        if self.fresh {
            self.or_base = None;
        }
        self.overwrite(combined, range);
    }

    pub(super) fn overwrite(&mut self, value: ExprId, range: TextRange) {
        match &mut self.string {
            Some(string) if !self.fresh => string.range = string.range.cover(range),
            _ => self.string = Some(LogicString { range, ignoring: None }),
        }
        self.rlo = Rlo { state: RloState::Known, value };
        self.fresh = false;
    }

    /// An instruction that neither uses nor changes the RLO stands here.
    pub(super) fn ignores_rlo(&mut self, range: TextRange, instr: &ast::Instr) {
        if let Some(string) = self.string.as_mut().filter(|it| it.ignoring.is_none()) {
            string.ignoring = Some((range, mnemonic_text(instr)));
        }
    }

    pub(super) fn bit_check(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        let value = match instr.operand() {
            Some(node) => match self.operand(&node) {
                Operand::Object(object) => {
                    let at = node.range();
                    let object = self.resolve(object, at);
                    let status = self.b.model.objects[object.0 as usize].class == Class::Status;
                    match status {
                        true if is_binary_result(&self.b.model.objects[object.0 as usize].text) => self.br,
                        // The other bits change with every instruction.
                        true => self.b.exprs().opaque(),
                        false => self.read(object, at),
                    }
                }
                Operand::Constant(value) => value,
                Operand::Other => self.b.exprs().opaque(),
            },
            None => self.b.exprs().opaque(),
        };
        self.check(op, value, range);
    }

    pub(super) fn close(&mut self, range: TextRange) {
        let Some(nest) = self.nesting.pop() else {
            self.b.oddity(OddityKind::UnopenedParenthesis, range, ")");
            return;
        };
        let inner = self.rlo_value();
        let op = match nest.op {
            Op::AndNotOpen => Op::AndNot,
            Op::OrOpen => Op::Or,
            Op::OrNotOpen => Op::OrNot,
            Op::XorOpen => Op::Xor,
            Op::XorNotOpen => Op::XorNot,
            _ => Op::And,
        };
        self.rlo = nest.rlo;
        self.fresh = nest.fresh;
        self.or_base = nest.or_base;
        self.string = nest.string;
        self.check(op, inner, nest.range.cover(range));
    }

    pub(super) fn set_or_reset(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        let rlo = self.use_rlo(range, &mnemonic_text(instr));
        if let Some((object, at)) = self.object_operand(instr) {
            let class = self.b.model.objects[object.0 as usize].class;
            let is_block = matches!(class, Class::Timer | Class::Counter)
                || self.b.model.objects[object.0 as usize].ty == Type::Block;
            match (op, is_block) {
                (Op::Set, true) => {
                    let preset = self.accumulator(0);
                    self.b.drive(object, Pin::Preset, rlo, Some(preset), at, range);
                }
                (Op::Set, false) => self.b.set(object, rlo, at, range),
                (_, true) => self.b.drive(object, Pin::Reset, rlo, None, at, range),
                (_, false) => self.b.reset(object, rlo, at, range),
            }
            self.note_write(object);
            // A symbol may be a counter, which takes its preset from the accumulator.
            if op == Op::Set && matches!(class, Class::Symbol | Class::LocalName) {
                self.use_loads(0);
            }
        }
        self.limit();
    }
}

pub(super) fn is_binary_result(text: &str) -> bool {
    text.eq_ignore_ascii_case("BR") || text.eq_ignore_ascii_case("BIE")
}

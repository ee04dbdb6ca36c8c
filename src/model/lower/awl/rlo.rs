//! The result of logic operation: logic strings, nesting, and what acts on it.

use rowan::TextRange;
use smol_str::SmolStr;

use super::operands::Operand;
use super::{Machine, mnemonic_text};
use crate::model::expr::{ExprId, Exprs};
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

/// Whether a check is a first check, which overwrites the RLO.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum First {
    Yes,
    No,
    /// On some ways here, and not on others: what a check makes of the RLO is not known.
    Either,
}

impl First {
    pub(super) fn meet(self, other: Self) -> Self {
        if self == other { self } else { Self::Either }
    }
}

/// What an `O` without operand has put aside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OrTerm {
    /// The terms before it.
    pub(super) base: ExprId,
    pub(super) stage: OrStage,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OrStage {
    /// No check stands behind it yet: the RLO is what it was.
    Open,
    /// The RLO is the base or the term that [`Rlo`] holds.
    Term,
    /// `NOT` made the RLO what [`Rlo`] holds; the base is added again with the next AND check.
    Negated,
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
    pub(super) first: First,
    pub(super) or: Option<OrTerm>,
    pub(super) string: Option<LogicString>,
}

type Logic = (Rlo, First, Option<OrTerm>);

/// What is known of the RLO where two ways meet.
pub(super) fn meet_logic(exprs: &mut Exprs, a: Logic, b: Logic) -> Logic {
    let state = if a.0.state == RloState::Known { b.0.state } else { a.0.state };
    let first = a.1.meet(b.1);
    if (a.0.value, a.2) == (b.0.value, b.2) {
        return (Rlo { state, value: a.0.value }, first, a.2);
    }
    let mut value = |(rlo, _, or): Logic| match or {
        Some(OrTerm { base, stage: OrStage::Term }) => exprs.or(base, rlo.value),
        _ => rlo.value,
    };
    let (here, there) = (value(a), value(b));
    let value = if here == there { here } else { exprs.opaque() };
    // What the next AND check adds is not the same on both ways.
    let first = if a.2.or(b.2).is_some() { First::Either } else { first };
    (Rlo { state, value }, first, None)
}

impl Machine {
    /// The value that an instruction which uses the RLO sees.
    pub(super) fn rlo_value(&mut self) -> ExprId {
        let value = self.rlo.value;
        match self.or {
            Some(OrTerm { base, stage: OrStage::Term }) => self.b.exprs().or(base, value),
            _ => value,
        }
    }

    /// Ends the logic string: its result was used.
    pub(super) fn limit(&mut self) {
        let value = self.rlo_value();
        self.rlo.value = value;
        self.or = None;
        self.first = First::Yes;
        self.string = None;
    }

    /// An instruction acts on the RLO: reports one that nothing in the block computed.
    pub(super) fn use_rlo(&mut self, range: TextRange, instr: &ast::Instr) -> ExprId {
        if self.first != First::No && self.b.is_reachable() {
            let kind = match self.rlo.state {
                RloState::Known => None,
                RloState::FromCaller => Some(OddityKind::RloFromCaller),
                RloState::AfterCall => Some(OddityKind::RloAfterCall),
            };
            if let Some(kind) = kind {
                self.b.oddity(kind, range, mnemonic_text(instr));
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
        if self.first != First::No || !self.b.is_reachable() {
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
        let left = self.rlo.value;
        let combined = match (self.first, op) {
            (First::Yes, _) => value,
            (First::Either, _) => self.b.exprs().opaque(),
            (First::No, Op::Or | Op::OrNot | Op::Xor | Op::XorNot) => {
                let left = match self.or {
                    // Where the terms before are 0, this is a first check.
                    Some(OrTerm { base, stage: OrStage::Open }) => self.b.exprs().and(base, left),
                    _ => self.rlo_value(),
                };
                match op {
                    Op::Or | Op::OrNot => self.b.exprs().or(left, value),
                    _ => self.b.exprs().xor(left, value),
                }
            }
            (First::No, _) => match &mut self.or {
                Some(or) => {
                    let is_first = or.stage == OrStage::Open;
                    or.stage = OrStage::Term;
                    if is_first { value } else { self.b.exprs().and(left, value) }
                }
                None => self.b.exprs().and(left, value),
            },
        };
        if self.first != First::No || matches!(op, Op::Or | Op::OrNot | Op::Xor | Op::XorNot) {
            self.or = None;
        }
        self.overwrite(combined, range);
    }

    pub(super) fn overwrite(&mut self, value: ExprId, range: TextRange) {
        match &mut self.string {
            Some(string) if self.first == First::No => string.range = string.range.cover(range),
            _ => self.string = Some(LogicString { range, ignoring: None }),
        }
        self.rlo = Rlo { state: RloState::Known, value };
        self.first = First::No;
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
        self.first = nest.first;
        self.or = nest.or;
        self.string = nest.string;
        self.check(op, inner, nest.range.cover(range));
    }

    pub(super) fn set_or_reset(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        let rlo = self.use_rlo(range, instr);
        if let Some((object, at)) = self.object_operand(instr) {
            let class = self.b.model.objects[object.0 as usize].class;
            let is_block = matches!(class, Class::Timer | Class::Counter)
                || self.b.model.objects[object.0 as usize].ty == Type::Block;
            match (op, is_block) {
                (Op::Set, true) => {
                    let preset = self.accumulator(0);
                    self.b.drive(object, Pin::Preset, rlo, Some(preset), at, range);
                }
                (Op::Set, false) => {
                    let when = self.under_relay(rlo);
                    self.b.set(object, when, at, range);
                }
                (_, true) => self.b.drive(object, Pin::Reset, rlo, None, at, range),
                (_, false) => {
                    let when = self.under_relay(rlo);
                    self.b.reset(object, when, at, range);
                }
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

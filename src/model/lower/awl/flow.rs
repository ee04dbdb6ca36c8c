//! Labels, jumps and the ends of blocks.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::accumulators::Accumulator;
use super::operands::bare_text;
use super::relay::Relay;
use super::rlo::{First, Nest, OrTerm, Rlo, RloState, meet_logic};
use super::{Machine, op_of};
use crate::model::entity::BlockName;
use crate::model::expr::{ExprId, Exprs};
use crate::model::unit::{DeadCause, Leave, StatementKind};
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::{JumpIf, Op};
use crate::syntax::{AstNode as _, Language, SyntaxNode};

/// Of more open parentheses, or of more loads that one accumulator may stem from, jumps carry nothing along.
pub(super) const MOST_CARRIED: usize = 16;

/// The machine where a jump arrives.
#[derive(Debug, Clone)]
pub(super) struct Arrival {
    pub(super) rlo: Rlo,
    pub(super) first: First,
    pub(super) or: Option<OrTerm>,
    pub(super) nesting: Vec<Nest>,
    pub(super) accumulators: [Accumulator; 2],
    pub(super) br: ExprId,
    pub(super) relay: Relay,
    pub(super) shared: Option<Option<BlockName>>,
}

impl Machine {
    pub(super) fn arrival(&self) -> Arrival {
        Arrival {
            rlo: self.rlo,
            first: self.first,
            or: self.or,
            nesting: self.nesting.clone(),
            accumulators: self.accumulators.clone(),
            br: self.br,
            relay: self.relay.clone(),
            shared: self.open.shared.clone(),
        }
    }

    pub(super) fn label(&mut self, text: &SmolStr, range: TextRange) {
        let reachable = self.b.is_reachable();
        self.b.label(text.clone(), text.clone(), range);
        let arrival = self.arrivals.remove(text);
        let is_entered = reachable || arrival.is_some();
        if let Some(arrival) = arrival {
            if reachable { self.meet(arrival) } else { self.become_arrival(arrival) }
        }
        if let Some(&jumps) = self.back_targets.labels.get(text) {
            self.string = None;
            let value = self.b.exprs().opaque();
            self.rlo = Rlo { state: RloState::Known, value };
            let or = self.or.take();
            self.first = if or.is_some() { First::Either } else { self.first.meet(jumps) };
            self.br = self.b.exprs().opaque();
            if self.back_targets.relays || self.relay != Relay::default() {
                self.relay = Relay::unknown(self.b.exprs().opaque());
            }
            let entry = self.accumulators[0].value.filter(|_| is_entered);
            self.keep_accumulators();
            let turn = self.b.exprs().opaque();
            self.accumulators = [Accumulator::computed(turn), Accumulator::unknown()];
            if let Some(entry) = entry {
                self.counted.insert(text.clone(), (entry, turn));
            }
        }
    }

    pub(super) fn become_arrival(&mut self, arrival: Arrival) {
        self.rlo = arrival.rlo;
        self.first = arrival.first;
        self.or = arrival.or;
        self.nesting = arrival.nesting;
        self.accumulators = arrival.accumulators;
        self.br = arrival.br;
        self.relay = arrival.relay;
        self.open.shared = arrival.shared;
        self.string = None;
    }

    pub(super) fn meet(&mut self, arrival: Arrival) {
        if self.first != arrival.first {
            self.string = None;
        }
        let (here, there) = ((self.rlo, self.first, self.or), (arrival.rlo, arrival.first, arrival.or));
        (self.rlo, self.first, self.or) = meet_logic(self.b.exprs(), here, there);
        // Of parentheses that are not open on both ways nothing is known.
        let is_same_depth = self.nesting.len() == arrival.nesting.len();
        let mut others = arrival.nesting;
        if others.len() > self.nesting.len() {
            std::mem::swap(&mut others, &mut self.nesting);
        }
        for (nest, other) in self.nesting.iter_mut().zip(&others) {
            let (here, there) = ((nest.rlo, nest.first, nest.or), (other.rlo, other.first, other.or));
            (nest.rlo, nest.first, nest.or) = meet_logic(self.b.exprs(), here, there);
            if nest.op != other.op {
                nest.first = First::Either;
            }
        }
        if !is_same_depth {
            for nest in &mut self.nesting {
                nest.first = First::Either;
            }
        }
        self.relay.meet(&arrival.relay, self.b.exprs());
        for (accumulator, other) in self.accumulators.iter_mut().zip(&arrival.accumulators) {
            accumulator.meet(other);
            if accumulator.loads.len() > MOST_CARRIED {
                for load in accumulator.loads.drain(..) {
                    self.loads[load as usize].used = true;
                }
            }
        }
        if self.br != arrival.br {
            self.br = self.b.exprs().opaque();
        }
        if self.open.shared != arrival.shared {
            let either = self.open.shared.is_some() || arrival.shared.is_some();
            self.open.shared = either.then_some(None);
        }
    }

    pub(super) fn jump(&mut self, instr: &ast::Instr, when: ExprId, range: TextRange) {
        let Some((text, at)) = label_operand(instr) else { return };
        if self.b.has_label(&text) || self.nesting.len() > MOST_CARRIED {
            self.keep_accumulators();
        } else if !self.b.is_reachable() {
            // Nothing goes from here to there.
        } else {
            match self.arrivals.remove(&text) {
                Some(before) => {
                    let here = self.arrival();
                    let string = self.string.clone();
                    let reported = self.open.reported;
                    self.meet(before);
                    let met = self.arrival();
                    self.become_arrival(here);
                    self.string = string;
                    self.open.reported = reported;
                    self.arrivals.insert(text.clone(), met);
                }
                None => {
                    let arrival = self.arrival();
                    self.arrivals.insert(text.clone(), arrival);
                }
            }
        }
        self.b.jump(text.clone(), text, at, when, range);
    }

    pub(super) fn conditional(&mut self, instr: &ast::Instr, range: TextRange, negated: bool, save: bool) {
        let rlo = self.use_rlo(range, instr);
        self.limit();
        if save {
            self.br = rlo;
        }
        let when = if negated { self.b.exprs().not(rlo) } else { rlo };
        // Taken or not, the RLO is 1 afterwards.
        self.rlo = Rlo { state: RloState::Known, value: Exprs::TRUE };
        self.jump(instr, when, range);
    }

    pub(super) fn end(&mut self, when: ExprId, range: TextRange) {
        if when == Exprs::TRUE {
            self.discard(range);
        }
        if self.b.is_reachable() {
            self.hand_over();
        }
        self.b.statement(StatementKind::Return { when, how: Leave::Unit }, range);
        self.b.leave(when, DeadCause::End, range);
    }

    pub(super) fn jump_instruction(&mut self, condition: JumpIf, instr: &ast::Instr, range: TextRange) {
        match condition {
            JumpIf::Always => {
                // The RLO goes along; where it arrives is another matter.
                self.string = None;
                // The number in accumulator 1 selects one entry of a list.
                let when = if self.jump_list { self.b.exprs().opaque() } else { Exprs::TRUE };
                self.jump(instr, when, range);
            }
            JumpIf::Rlo => self.conditional(instr, range, false, false),
            JumpIf::NotRlo => self.conditional(instr, range, true, false),
            JumpIf::RloSave => self.conditional(instr, range, false, true),
            JumpIf::NotRloSave => self.conditional(instr, range, true, true),
            JumpIf::Br | JumpIf::NotBr => {
                let br = self.br;
                let when = if condition == JumpIf::Br { br } else { self.b.exprs().not(br) };
                self.limit();
                self.jump(instr, when, range);
            }
            JumpIf::Overflow
            | JumpIf::StoredOverflow
            | JumpIf::Zero
            | JumpIf::NotZero
            | JumpIf::Plus
            | JumpIf::Minus
            | JumpIf::PlusOrZero
            | JumpIf::MinusOrZero
            | JumpIf::Unordered => {
                self.ignores_rlo(range, instr);
                let when = self.b.exprs().opaque();
                // A result that is only tested is used.
                self.keep_accumulators();
                self.jump(instr, when, range);
            }
        }
    }
}

/// What is known before the walk of the labels that a jump below them goes to.
#[derive(Default)]
pub(super) struct BackTargets {
    /// Whether those jumps end the logic string, as the order of the text has it.
    pub(super) labels: FxHashMap<SmolStr, First>,
    /// Below a label, something acts on the master control relay.
    pub(super) relays: bool,
}

impl BackTargets {
    pub(super) fn of(block: SyntaxNode<'_>, language: Language) -> Self {
        let mut found = Self::default();
        let mut labels: FxHashSet<SmolStr> = FxHashSet::default();
        let mut first = First::Yes;
        for instr in block.children().filter_map(ast::Network::cast).flat_map(ast::Network::instrs) {
            if let Some((text, _)) = label(&instr) {
                labels.insert(text);
            }
            if labels.is_empty() {
                continue;
            }
            let Some(op) = op_of(&instr, language) else { continue };
            first = first_behind(op).unwrap_or(first);
            found.relays |= matches!(op, Op::McrOpen | Op::McrClose | Op::McrActivate | Op::McrDeactivate);
            if matches!(op, Op::Jump(_) | Op::JumpList | Op::Loop)
                && let Some((text, _)) = label_operand(&instr)
                && labels.contains(&text)
            {
                found.labels.entry(text).and_modify(|it| *it = it.meet(first)).or_insert(first);
            }
        }
        found
    }
}

/// Whether the check behind an instruction is a first check; `None` where it is what it was before.
fn first_behind(op: Op) -> Option<First> {
    match op {
        Op::And | Op::AndNot | Op::Or | Op::OrNot | Op::Xor | Op::XorNot | Op::Close => Some(First::No),
        Op::EdgePositive | Op::EdgeNegative | Op::Compare(..) | Op::TestBit(_) => Some(First::No),
        Op::AndOpen | Op::AndNotOpen | Op::OrOpen | Op::OrNotOpen | Op::XorOpen | Op::XorNotOpen => Some(First::Yes),
        Op::Assign | Op::Set | Op::Reset | Op::SetRlo | Op::ClearRlo | Op::Timer(_) | Op::Enable => Some(First::Yes),
        Op::CountUp | Op::CountDown | Op::Call | Op::CallUnconditional | Op::CallConditional => Some(First::Yes),
        Op::McrOpen | Op::McrClose | Op::BlockEndConditional => Some(First::Yes),
        Op::Jump(JumpIf::Rlo | JumpIf::NotRlo | JumpIf::RloSave | JumpIf::NotRloSave | JumpIf::Br | JumpIf::NotBr) => {
            Some(First::Yes)
        }
        _ => None,
    }
}

pub(super) fn label(instr: &ast::Instr) -> Option<(SmolStr, TextRange)> {
    let name = instr.label()?.name()?;
    Some((name.text().into(), name.text_range()))
}

/// The target of a jump.
pub(super) fn label_operand(instr: &ast::Instr) -> Option<(SmolStr, TextRange)> {
    let operand = instr.operand()?;
    Some((bare_text(&operand), operand.range()))
}

//! Labels, jumps and the ends of blocks.

use rowan::TextRange;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::accumulators::Accumulator;
use super::operands::bare_text;
use super::rlo::{Nest, Rlo, RloState};
use super::{Machine, mnemonic_text, op_of};
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
    pub(super) fresh: bool,
    pub(super) or_base: Option<ExprId>,
    pub(super) nesting: Vec<Nest>,
    pub(super) accumulators: [Accumulator; 2],
    pub(super) br: ExprId,
    pub(super) shared: Option<Option<BlockName>>,
}

impl Machine {
    pub(super) fn arrival(&self) -> Arrival {
        Arrival {
            rlo: self.rlo,
            fresh: self.fresh,
            or_base: self.or_base,
            nesting: self.nesting.clone(),
            accumulators: self.accumulators.clone(),
            br: self.br,
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
        if self.back_targets.contains(text) {
            self.string = None;
            let value = self.b.exprs().opaque();
            self.rlo = Rlo { state: RloState::Known, value };
            self.or_base = None;
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
        self.fresh = arrival.fresh;
        self.or_base = arrival.or_base;
        self.nesting = arrival.nesting;
        self.accumulators = arrival.accumulators;
        self.br = arrival.br;
        self.open.shared = arrival.shared;
        self.string = None;
    }

    pub(super) fn meet(&mut self, arrival: Arrival) {
        let here = self.rlo_value();
        let there = match arrival.or_base {
            Some(base) => self.b.exprs().or(base, arrival.rlo.value),
            None => arrival.rlo.value,
        };
        self.or_base = None;
        if here != there {
            self.rlo.value = self.b.exprs().opaque();
        }
        if self.rlo.state == RloState::Known {
            self.rlo.state = arrival.rlo.state;
        }
        if self.fresh != arrival.fresh {
            self.string = None;
        }
        self.fresh |= arrival.fresh;
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
        let rlo = self.use_rlo(range, &mnemonic_text(instr));
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

/// Labels that a jump below them goes to.
pub(super) fn back_targets(block: SyntaxNode<'_>, language: Language) -> FxHashSet<SmolStr> {
    let mut labels: FxHashSet<SmolStr> = FxHashSet::default();
    let mut back = FxHashSet::default();
    for network in block.children().filter_map(ast::Network::cast) {
        for instr in network.instrs() {
            if let Some((text, _)) = label(&instr) {
                labels.insert(text);
            }
            if !labels.is_empty()
                && matches!(op_of(&instr, language), Some(Op::Jump(_) | Op::JumpList | Op::Loop))
                && let Some((text, _)) = label_operand(&instr)
                && labels.contains(&text)
            {
                back.insert(text);
            }
        }
    }
    back
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

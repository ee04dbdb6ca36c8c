//! The accumulators, and which loads they stem from.

use rowan::TextRange;
use smol_str::SmolStr;

use super::operands::{Operand, bare_text};
use super::{Machine, index, mnemonic_text};
use crate::model::entity::BlockKind;
use crate::model::expr::{Comparison, ExprId};
use crate::model::unit::OddityKind;
use crate::syntax::AstNode as _;
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::Relation;

/// An accumulator: its value and the loads it may stem from.
#[derive(Debug, Clone)]
pub(super) struct Accumulator {
    pub(super) value: Option<ExprId>,
    pub(super) loads: Vec<u32>,
    /// Nothing of the block has put a value there.
    pub(super) entry: bool,
}

impl Accumulator {
    pub(super) fn entry() -> Self {
        Self { value: None, loads: Vec::new(), entry: true }
    }

    pub(super) fn unknown() -> Self {
        Self { value: None, loads: Vec::new(), entry: false }
    }

    pub(super) fn computed(value: ExprId) -> Self {
        Self { value: Some(value), loads: Vec::new(), entry: false }
    }

    pub(super) fn meet(&mut self, other: &Self) {
        if self.value != other.value {
            self.value = None;
        }
        for &load in &other.loads {
            if !self.loads.contains(&load) {
                self.loads.push(load);
            }
        }
        self.entry &= other.entry;
    }
}

pub(super) struct Load {
    pub(super) range: TextRange,
    pub(super) text: SmolStr,
    pub(super) used: bool,
    /// What overwrote it; the end of the block when nothing did.
    pub(super) lost_at: Option<TextRange>,
    /// The load right before, which this one pushed out of accumulator 1.
    pub(super) follows: Option<u32>,
    /// It lies in accumulator 1 where the block goes back to its caller, who may read it there.
    pub(super) returned: bool,
}

impl Machine {
    /// Loads in a row that are lost are one finding, at the last of them.
    pub(super) fn dead_loads(&mut self) {
        let mut group: Vec<TextRange> = Vec::new();
        for (at, load) in self.loads.iter().enumerate() {
            if load.used {
                continue;
            }
            let continues = self.loads.get(at + 1).is_some_and(|next| !next.used && next.follows == Some(index(at)));
            if continues {
                group.push(load.range);
                continue;
            }
            let before = std::mem::take(&mut group);
            if load.returned && before.is_empty() {
                continue;
            }
            let oddity = self.b.oddity(OddityKind::DeadLoad, load.range, load.text.clone());
            oddity.related.extend(before.into_iter().map(|it| (it, LOST_TOO)));
            oddity.related.extend(load.lost_at.map(|it| (it, "the value is lost here")));
        }
    }

    /// The block goes back to its caller, who finds the accumulators as they are. An organization block has none.
    pub(super) fn hand_over(&mut self) {
        if self.b.model.entity.block_kind() == Some(BlockKind::Ob) {
            return;
        }
        for &load in &self.accumulators[0].loads {
            self.loads[load as usize].returned = true;
        }
    }

    pub(super) fn use_loads(&mut self, which: usize) {
        for &load in &self.accumulators[which].loads {
            self.loads[load as usize].used = true;
        }
    }

    pub(super) fn keep_accumulators(&mut self) {
        self.use_loads(0);
        self.use_loads(1);
    }

    pub(super) fn lose(&mut self, which: usize, at: TextRange) {
        for &load in &self.accumulators[which].loads {
            let load = &mut self.loads[load as usize];
            load.lost_at.get_or_insert(at);
        }
    }

    pub(super) fn load(&mut self, value: ExprId, range: TextRange, text: SmolStr) {
        self.lose(1, range);
        let used = !self.b.is_reachable();
        let follows = self.last_load.take();
        self.loads.push(Load { range, text, used, lost_at: None, follows, returned: false });
        let load = index(self.loads.len() - 1);
        self.last_load = Some(load);
        let loaded = Accumulator { value: Some(value), loads: vec![load], entry: false };
        let before = std::mem::replace(&mut self.accumulators[0], loaded);
        self.accumulators[1] = before;
    }

    pub(super) fn accumulator(&mut self, which: usize) -> ExprId {
        self.use_loads(which);
        match self.accumulators[which].value {
            Some(value) => value,
            None => {
                let value = self.b.exprs().opaque();
                self.accumulators[which].value = Some(value);
                value
            }
        }
    }

    /// Both operands of a two-operand instruction: accumulator 2, then 1.
    pub(super) fn two_operands(&mut self, range: TextRange, instr: &ast::Instr) -> (ExprId, ExprId) {
        self.want_two(range, instr);
        let left = self.accumulator(1);
        let right = self.accumulator(0);
        (left, right)
    }

    /// Reports an instruction that needs both accumulators where the block has not filled them.
    pub(super) fn want_two(&mut self, range: TextRange, instr: &ast::Instr) {
        let missing = self.accumulators.iter().filter(|it| it.entry).count();
        // A listing may show the middle of a block; only a block's start is really one.
        if missing > 0 && self.b.is_reachable() && self.closed {
            let loaded = 2 - index(missing);
            self.b.oddity(OddityKind::MissingOperand(loaded), range, mnemonic_text(instr));
            for accumulator in &mut self.accumulators {
                accumulator.entry = false;
            }
        }
    }

    pub(super) fn result(&mut self, value: ExprId) {
        self.accumulators[0] = Accumulator::computed(value);
    }

    pub(super) fn opaque_result(&mut self) {
        self.use_loads(0);
        let value = self.b.exprs().opaque();
        self.result(value);
    }

    pub(super) fn load_instruction(&mut self, instr: &ast::Instr, range: TextRange) {
        self.ignores_rlo(range, instr);
        let Some(node) = instr.operand() else { return };
        let at = node.range();
        let value = match self.operand(&node) {
            Operand::Object(object) => {
                let object = self.resolve(object, at);
                self.read(object, at)
            }
            Operand::Constant(value) => value,
            Operand::Other => self.b.exprs().opaque(),
        };
        self.load(value, range, bare_text(&node));
    }

    pub(super) fn constant_operand(&mut self, instr: &ast::Instr) -> ExprId {
        let operand = instr.operand().map(|it| self.operand(&it));
        match operand {
            Some(Operand::Constant(value)) => value,
            _ => self.b.exprs().opaque(),
        }
    }

    pub(super) fn address_register(&mut self, instr: &ast::Instr) {
        match instr.operand() {
            Some(node) => {
                if let Operand::Object(object) = self.operand(&node) {
                    let at = node.range();
                    let object = self.resolve(object, at);
                    self.read(object, at);
                }
            }
            None => self.use_loads(0),
        }
    }
}

/// Part of a load in a row of lost ones.
pub(super) const LOST_TOO: &str = "this value is lost too";

pub(super) fn comparison(relation: Relation) -> Comparison {
    match relation {
        Relation::Eq => Comparison::Eq,
        Relation::Ne => Comparison::Ne,
        Relation::Gt => Comparison::Gt,
        Relation::Lt => Comparison::Lt,
        Relation::Ge => Comparison::Ge,
        Relation::Le => Comparison::Le,
    }
}

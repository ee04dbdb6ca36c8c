//! The master control relay, as the vendor's general documentation has it: between `MCRA` and `MCRD`, in a zone that
//! `MCR(` opened with RLO 0, `=` and `T` write 0, and `S` and `R` of bits do nothing. A zone in a zone is on when both
//! are. A block begins outside, and its caller finds its own relay again.

use super::Machine;
use crate::model::expr::{ExprId, Exprs};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Relay {
    /// Whether writes depend on it: between `MCRA` and `MCRD`.
    pub(super) active: ExprId,
    /// Whether power flows in the zones that are open, each with those around it.
    zones: Vec<ExprId>,
    /// Ways with different zones open met.
    lost: bool,
}

impl Default for Relay {
    fn default() -> Self {
        Self { active: Exprs::FALSE, zones: Vec::new(), lost: false }
    }
}

impl Relay {
    /// Nothing is known of it.
    pub(super) fn unknown(active: ExprId) -> Self {
        Self { active, zones: Vec::new(), lost: true }
    }

    pub(super) fn close(&mut self) {
        self.zones.pop();
    }

    pub(super) fn meet(&mut self, other: &Self, exprs: &mut Exprs) {
        if self == other {
            return;
        }
        if self.active != other.active {
            self.active = exprs.opaque();
        }
        self.lost |= other.lost || self.zones.len() != other.zones.len();
        for (zone, it) in self.zones.iter_mut().zip(&other.zones) {
            if zone != it {
                *zone = exprs.opaque();
            }
        }
    }

    /// The condition under which writes work as usual.
    fn power(&self, exprs: &mut Exprs) -> ExprId {
        if self.active == Exprs::FALSE {
            return Exprs::TRUE;
        }
        if self.lost {
            return exprs.opaque();
        }
        let power = self.zones.last().copied().unwrap_or(Exprs::TRUE);
        let off = exprs.not(self.active);
        exprs.or(off, power)
    }
}

impl Machine {
    /// `MCR(`
    pub(super) fn open_relay(&mut self, rlo: ExprId) {
        let around = self.relay.zones.last().copied().unwrap_or(Exprs::TRUE);
        let power = self.b.exprs().and(around, rlo);
        self.relay.zones.push(power);
    }

    /// What a bit takes, or the condition under which it is set or reset, where the relay may be off.
    pub(super) fn under_relay(&mut self, value: ExprId) -> ExprId {
        let power = self.relay.power(self.b.exprs());
        self.b.exprs().and(value, power)
    }

    /// What a word takes.
    pub(super) fn stored_under_relay(&mut self, value: ExprId) -> ExprId {
        match self.relay.power(self.b.exprs()) {
            Exprs::TRUE => value,
            Exprs::FALSE => self.b.exprs().int(0),
            _ => self.b.exprs().opaque(),
        }
    }
}

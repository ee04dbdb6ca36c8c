//! Models to facts: what rules ask.
//!
//! **Invariant:** what leaves a unit ([`facts`]) holds no position, so that an edit that only moves code stops there.

pub mod apart;
pub mod calls;
pub mod capacity;
pub mod channels;
pub mod chart;
pub mod coactive;
pub mod conditions;
pub mod connectors;
pub mod cost;
pub mod counts;
pub mod decided;
pub mod drives;
pub mod edges;
pub mod facts;
pub mod features;
pub mod fields;
pub mod flow;
pub mod gaps;
pub mod islands;
pub mod known;
pub mod liveness;
pub mod modules;
pub mod nesting;
pub mod operands;
pub mod outline;
pub mod parameters;
pub mod priority;
pub mod processing;
pub mod program;
pub mod ranges;
pub mod reach;
pub mod repeats;
pub mod sequences;
pub mod size;
pub mod stated;
pub mod stretches;
pub mod stuck;
pub mod symbols;
pub mod turns;
pub mod unseen;
pub mod used;

/// A place of a program without its position: the `anchor`-th place that the unit's facts name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Site {
    /// Index of the unit in its program.
    pub unit: u32,
    /// Index into the anchors of the unit's model.
    pub anchor: u32,
}

impl Site {
    /// Instead of a unit: the file of the configuration.
    const CONFIGURATION: u32 = u32::MAX;

    /// A key or value of the configuration, by its number among them.
    pub fn configured(anchor: u32) -> Self {
        Self { unit: Self::CONFIGURATION, anchor }
    }

    pub fn is_configured(self) -> bool {
        self.unit == Self::CONFIGURATION
    }
}

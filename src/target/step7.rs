//! SIMATIC S7-300 and S7-400.

use super::{Counted, Limit, Numbered, Range};
use crate::model::entity::BlockKind;

/// Longest jump label, in characters.
pub const LABEL_LENGTH: Limit = Limit::new(4, "S7:315");

/// Longest symbol, and longest name that a block declares, in characters.
pub const SYMBOL_LENGTH: Limit = Limit::new(24, GENERAL);

/// Nesting expressions `U( O( X(` open at once. Not in the source manual.
pub const PARENTHESIS_DEPTH: Limit = Limit::new(7, "the vendor's general documentation");

/// A counter counts from 0 to this.
pub const COUNTER_MAX: Limit = Limit::new(999, "S7:591");
/// What a counter can be set to.
pub const COUNTER_PRESETS: Range = Range::new(0, COUNTER_MAX.value, COUNTER_MAX.source);

/// Number of timers and counters that a CPU usually has; it varies with the CPU.
pub const USUAL_TIMERS: Limit = Limit::new(256, "S7:477");
pub const USUAL_COUNTERS: Limit = Limit::new(256, "S7:591");

/// The source manual leaves the rest open.
const GENERAL: &str = "the vendor's general documentation";

/// What has a number and is counted. Numbers start at 0.
pub static NUMBERED: &[Numbered] = &[
    Numbered { what: Counted::Bytes, key: "M", prefix: "MB ", plural: "bytes of memory" },
    Numbered { what: Counted::Timers, key: "T", prefix: "T ", plural: "timers" },
    Numbered { what: Counted::Counters, key: "Z", prefix: "Z ", plural: "counters" },
];

/// Numbers of the blocks of a kind on the largest CPUs.
pub fn block_numbers(kind: BlockKind) -> Option<Range> {
    match kind {
        BlockKind::Fb | BlockKind::Fc => Some(Range::new(0, 7999, GENERAL)),
        BlockKind::Db => Some(Range::new(1, 16_000, GENERAL)),
        _ => None,
    }
}

/// Watchdog of the cycle of the CPU that the manual describes, in milliseconds.
pub const WATCHDOG_MS: Limit = Limit::new(150, "S7:74");

/// What one CPU has. `None` where no source tells.
#[derive(Debug, PartialEq, Eq)]
pub struct Cpu {
    pub name: &'static str,
    /// Nesting of block calls.
    pub call_depth: Option<Limit>,
    /// Bytes of M that keep their value at a restart.
    pub retentive_bytes: Option<Range>,
    /// Watchdog of the cycle, in milliseconds.
    pub watchdog_ms: Option<Limit>,
    /// Accumulators and bits of each.
    pub accumulators: Option<Limit>,
    pub accumulator_bits: Option<Limit>,
    /// Bytes of M, at most.
    pub memory_bytes: Option<Limit>,
    pub timers: Option<Limit>,
    pub counters: Option<Limit>,
}

impl Cpu {
    /// How many of something the CPU has at most; `None` where no source tells.
    pub fn count(&self, what: Counted) -> Option<Limit> {
        match what {
            Counted::Bytes => self.memory_bytes,
            Counted::Timers => self.timers,
            Counted::Counters => self.counters,
            _ => None,
        }
    }
}

/// The most that any CPU has of something.
pub fn largest_count(what: Counted) -> Option<Limit> {
    CPUS.iter().filter_map(|it| it.count(what)).max_by_key(|it| it.value)
}

/// The CPU that the manual describes; the series names stand for the others, of which it says only that they vary.
pub static CPUS: &[Cpu] = &[
    Cpu {
        name: "CPU 314",
        call_depth: Some(Limit::new(8, "S7:107")),
        retentive_bytes: Some(Range::new(0, 15, "S7:115")),
        watchdog_ms: Some(WATCHDOG_MS),
        accumulators: Some(Limit::new(2, "S7:348")),
        accumulator_bits: Some(Limit::new(32, "S7:348")),
        memory_bytes: Some(Limit::new(256, GENERAL)),
        timers: Some(USUAL_TIMERS),
        counters: Some(USUAL_COUNTERS),
    },
    // Of its largest CPU, the 319.
    series("S7-300", 8192),
    // Of its largest CPUs, the 417.
    series("S7-400", 16_384),
];

const fn series(name: &'static str, memory_bytes: u32) -> Cpu {
    Cpu {
        name,
        call_depth: None,
        retentive_bytes: None,
        watchdog_ms: None,
        accumulators: None,
        accumulator_bits: None,
        memory_bytes: Some(Limit::new(memory_bytes, GENERAL)),
        timers: Some(Limit::new(2048, GENERAL)),
        counters: Some(Limit::new(2048, GENERAL)),
    }
}

//! SIMATIC S5-95U and S5-100U, and what holds for every S5 controller.

use super::{Counted, Limit, Numbered, Range};
use crate::model::entity::{BlockKind, BlockName};

/// The source document leaves the rest open.
const GENERAL: &str = "the vendor's general documentation";

/// Longest jump label, in characters.
pub const LABEL_LENGTH: Limit = Limit::new(4, GENERAL);

/// Longest symbol, in characters.
pub const SYMBOL_LENGTH: Limit = Limit::new(24, GENERAL);

/// Longest formal operand of a function block, in characters.
pub const FORMAL_LENGTH: Limit = Limit::new(4, GENERAL);

/// Nesting expressions `U( O(` open at once.
pub const PARENTHESIS_DEPTH: Limit = Limit::new(6, GENERAL);

/// A counter counts from 0 to this.
pub const COUNTER_PRESETS: Range = Range::new(0, 999, GENERAL);

/// Organization blocks that are functions of the operating system, which the program calls: the trigger of the cycle
/// time, and those with higher numbers.
const FUNCTION_OBS: [Range; 2] = [Range::new(31, 31, GENERAL), Range::new(110, 255, GENERAL)];
/// Function blocks that the operating system has, so that no program contains them.
const FUNCTION_FBS: Range = Range::new(238, 255, GENERAL);

/// Whether a block is part of the operating system.
pub fn is_function(name: &BlockName) -> bool {
    match name {
        BlockName::Number(BlockKind::Ob, number) => FUNCTION_OBS.iter().any(|it| it.contains(*number)),
        BlockName::Number(BlockKind::Fb, number) => FUNCTION_FBS.contains(*number),
        _ => false,
    }
}

/// What has a number and is counted. Numbers start at 0.
pub static NUMBERED: &[Numbered] = &[
    Numbered { what: Counted::Bytes, key: "M", prefix: "MB ", plural: "bytes of flags" },
    Numbered { what: Counted::Timers, key: "T", prefix: "T ", plural: "timers" },
    Numbered { what: Counted::Counters, key: "Z", prefix: "Z ", plural: "counters" },
];

/// What one CPU has.
#[derive(Debug, PartialEq, Eq)]
pub struct Cpu {
    pub name: &'static str,
    /// Blocks of each kind.
    pub blocks: Limit,
    pub function_blocks: FunctionBlocks,
    pub flag_bytes: Limit,
    pub timers: Limit,
    pub counters: Limit,
}

/// Whether a CPU has function blocks, and who says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FunctionBlocks {
    None(&'static str),
    /// With parameters and names.
    Full(&'static str),
}

impl Cpu {
    /// How many of something the CPU has at most.
    pub fn count(&self, what: Counted) -> Option<Limit> {
        match what {
            Counted::Bytes => Some(self.flag_bytes),
            Counted::Timers => Some(self.timers),
            Counted::Counters => Some(self.counters),
            _ => None,
        }
    }
}

/// The most that any CPU has of something.
pub fn largest_count(what: Counted) -> Option<Limit> {
    matches!(what, Counted::Bytes | Counted::Timers | Counted::Counters).then_some(Limit::new(256, GENERAL))
}

/// Blocks of each kind that any CPU has at most.
pub const LARGEST_BLOCKS: Limit = Limit::new(256, GENERAL);

/// The CPUs that the source document names. It says what all of them have at least, which is what the small ones have.
pub static CPUS: &[Cpu] = &[
    Cpu { timers: Limit::new(16, GENERAL), counters: Limit::new(16, GENERAL), ..small("CPU 100") },
    Cpu { timers: Limit::new(32, GENERAL), counters: Limit::new(32, GENERAL), ..small("CPU 102") },
    large("CPU 103"),
    large("CPU 95U"),
];

const fn small(name: &'static str) -> Cpu {
    Cpu {
        name,
        blocks: Limit::new(64, "GRF:1159"),
        function_blocks: FunctionBlocks::None("GRF:507"),
        flag_bytes: Limit::new(128, "GRF:1159"),
        timers: Limit::new(32, GENERAL),
        counters: Limit::new(32, GENERAL),
    }
}

const fn large(name: &'static str) -> Cpu {
    Cpu {
        name,
        blocks: LARGEST_BLOCKS,
        function_blocks: FunctionBlocks::Full("GRF:1222"),
        flag_bytes: Limit::new(256, GENERAL),
        timers: Limit::new(128, GENERAL),
        counters: Limit::new(128, GENERAL),
    }
}

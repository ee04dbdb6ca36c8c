//! TSX Micro and Premium, programmed with PL7.

pub mod block;
mod memory;

pub use memory::Memory;

use super::{ChartBits, ClearedBit, Counted, Limit, Numbered, Range};

/// Labels `%Li`.
pub const LABELS: Range = Range::new(0, 999, "PL7:2676");
/// Levels of parentheses in instruction list (also PL7:3185).
pub const PARENTHESIS_DEPTH: Limit = Limit::new(8, "PL7:3084");
/// Booleans on the stack of `MPS`, `MRD`, `MPP`.
pub const STACK_DEPTH: Limit = Limit::new(3, "PL7:3232");
/// Levels of subroutine calls; the section is level 0.
pub const SUBROUTINE_DEPTH: Limit = Limit::new(8, "PL7:1964");
/// Subroutine numbers of the language.
pub const SUBROUTINES: Range = Range::new(0, 253, "PL7:2004");
/// The program editor takes one number more than [`SUBROUTINES`]: a number above this one exists nowhere.
pub const SUBROUTINE_LAST_IN_EDITOR: Limit = Limit::new(254, "the vendor's general documentation");
/// Default of the watchdog of the master task, in milliseconds, and its maximum.
pub const WATCHDOG_DEFAULT_MS: Limit = Limit::new(250, "PL7:2275");
pub const WATCHDOG_MAX_MS: Limit = Limit::new(500, "PL7:2275");
/// Period of a periodic master task, in milliseconds.
pub const MASTER_PERIOD_MS: Range = Range::new(1, 255, "PL7:2215");
/// Period of the fast task, in milliseconds.
pub const FAST_PERIOD_MS: Range = Range::new(1, 255, "PL7:2023");
/// Timers `%TM` and `%T` together.
pub const TIMERS_MICRO: Limit = Limit::new(64, "PL7:999");
pub const TIMERS_PREMIUM: Limit = Limit::new(255, "PL7:999");
/// What initialises, clears and freezes charts, and resets macro-steps.
pub static CHART_BITS: ChartBits = ChartBits {
    bits: Range::new(21, 24, "PL7:4939"),
    cleared: &[
        ClearedBit { bit: 22, is_forbidden: false, source: "PL7:5039" },
        ClearedBit { bit: 24, is_forbidden: true, source: "PL7:5094" },
    ],
    only_set: None,
};
/// Times of steps, in units of 100 ms.
pub const STEP_TIMES: Range = Range::new(0, 9999, "PL7:4248");
pub const STEP_TIME_UNIT_MS: Limit = Limit::new(100, "PL7:4248");
/// Transitions of a chart, of which at most 64 may close or open AND branches (PL7:4286).
pub const TRANSITIONS: Limit = Limit::new(1024, "PL7:4190");
pub const AND_CONVERGENCES: Limit = Limit::new(64, "PL7:4286");
/// Branches of one divergence or convergence.
pub const BRANCHES: Limit = Limit::new(11, "PL7:4191-4196");
/// Lines and columns of a page of a chart.
pub const PAGE_LINES: Limit = Limit::new(14, "PL7:4322");
pub const PAGE_COLUMNS: Limit = Limit::new(11, "PL7:4322");
/// Columns of a rung.
pub const LADDER_COLUMNS: Limit = Limit::new(11, "PL7:2660");
/// Columns of a comparison block on one line, and of an operation block.
pub const COMPARE_COLUMNS: Limit = Limit::new(2, "PL7:2766");
pub const OPERATE_COLUMNS: Limit = Limit::new(4, "PL7:2767");
/// Characters in one of them.
pub const BLOCK_TEXT: Limit = Limit::new(4096, "PL7:2766-2767");
/// Pages of the chart, and of each macro-step.
pub const CHART_PAGES: Limit = Limit::new(8, "PL7:4265");
/// Macro-steps `%XMj`.
pub const MACRO_STEPS: Range = Range::new(0, 63, "PL7:4215");

/// A preset of a timer, counter or monostable. Volume 1 tells only which presets a program may write (PL7:977-995).
pub const PRESETS: Range = Range::new(0, 9999, "the vendor's general documentation; PL72:668, 748 for PL7-2");

// Parts of addresses. Positions and racks are the processor's.

/// Channels of a module, and ranks of a channel, in a rack of a Premium.
pub const CHANNELS: Range = Range::new(0, 127, "PL7:755");
pub const RANKS: Range = Range::new(0, 127, "PL7:756");
/// Position of the processor whose FIPIO link an address names, and the channel of that link.
pub const FIPIO_POSITIONS: Range = Range::new(0, 1, "PL7:806");
pub const FIPIO_LINK: Range = Range::new(2, 2, "PL7:807");
pub const FIPIO_POINTS: Range = Range::new(1, 127, "PL7:808");
/// Base module and extension.
pub const FIPIO_MODULES: Range = Range::new(0, 1, "PL7:809");
pub const FIPIO_RANKS: Range = Range::new(0, 255, "PL7:811");
pub const ASI_CHANNELS: Range = Range::new(0, 0, "PL7:852");
pub const ASI_SLAVES: Range = Range::new(0, 31, "PL7:853");
pub const ASI_RANKS: Range = Range::new(0, 3, "PL7:854");
pub const NETWORKS: Range = Range::new(0, 127, "PL7:912");
pub const NETWORK_STATIONS: Range = Range::new(0, 31, "PL7:912");
pub const NETWORK_WORDS: Range = Range::new(0, 3, "PL7:912");
/// Bits that can be extracted from a word.
pub const WORD_BITS: Range = Range::new(0, 15, "PL7:631");

// Lengths, in characters.

pub const SYMBOL_LENGTH: Limit = Limit::new(32, "PL7:1198");
/// Of a symbol that a module gives its objects: what the user chooses, and what the module appends.
pub const SYMBOL_COMMENT_LENGTH: Limit = Limit::new(508, "PL7:1222");
pub const SECTION_NAME_LENGTH: Limit = Limit::new(24, "PL7:1979");
/// The program editor takes fewer characters than [`SECTION_NAME_LENGTH`].
pub const SECTION_NAME_LENGTH_IN_EDITOR: Limit = Limit::new(16, "the vendor's general documentation");
pub const SECTION_COMMENT_LENGTH: Limit = Limit::new(250, "PL7:1985");
/// Short and long name of a functional module.
pub const RUNG_COMMENT_LENGTH: Limit = Limit::new(222, "PL7:2695");
pub const IL_COMMENT_LENGTH: Limit = Limit::new(222, "PL7:3032");
pub const ST_COMMENT_LENGTH: Limit = Limit::new(256, "PL7:3548");
pub const CHART_COMMENT_LENGTH: Limit = Limit::new(64, "PL7:4466");
/// Name of a parameter or variable of a DFB (also PL7:1254, 5448).
pub const DFB_ITEM_NAME_LENGTH: Limit = Limit::new(8, "PL7:5371");
pub const DFB_ITEM_COMMENT_LENGTH: Limit = Limit::new(80, "PL7:5373");

// Interface of a DFB type, which only a Premium has (PL7:5304).

/// Inputs and in/outs together.
pub const DFB_INPUTS_AND_IN_OUTS: Limit = Limit::new(15, "PL7:5418");
/// Outputs and in/outs together.
pub const DFB_OUTPUTS_AND_IN_OUTS: Limit = Limit::new(15, "PL7:5419");
pub const DFB_PUBLIC_VARIABLES: Limit = Limit::new(100, "PL7:5435");
pub const DFB_PRIVATE_VARIABLES: Limit = Limit::new(100, "PL7:5436");
/// Columns between two DFBs in series.
pub const DFB_GAP: Limit = Limit::new(2, "PL7:5625");
/// Channels of one module: 0 to 127.
pub const MODULE_CHANNELS: Limit = Limit::new(128, "PL7:755");

/// What has a number and is counted. Numbers start at 0, and how many there are is set when the application is
/// configured (PL7:622, 895, 1498-1499), but for the system bits.
pub static NUMBERED: &[Numbered] = &[
    Numbered { what: Counted::Bits, key: "M", prefix: "%M", plural: "internal bits" },
    Numbered { what: Counted::Words, key: "MW", prefix: "%MW", plural: "internal words" },
    Numbered { what: Counted::Constants, key: "KW", prefix: "%KW", plural: "constant words" },
    Numbered { what: Counted::SystemBits, key: "", prefix: "%S", plural: "system bits" },
    Numbered { what: Counted::Steps, key: "X", prefix: "%X", plural: "steps of the main chart" },
    Numbered { what: Counted::MacroSteps, key: "XM", prefix: "%XM", plural: "macro-steps" },
    Numbered { what: Counted::Timers, key: "TM", prefix: "%TM", plural: "timers" },
    Numbered { what: Counted::OldTimers, key: "T", prefix: "%T", plural: "series-7 timers" },
    Numbered { what: Counted::Counters, key: "C", prefix: "%C", plural: "counters" },
    Numbered { what: Counted::Monostables, key: "MN", prefix: "%MN", plural: "monostables" },
    Numbered { what: Counted::Registers, key: "R", prefix: "%R", plural: "registers" },
    Numbered { what: Counted::Drums, key: "DR", prefix: "%DR", plural: "drum controllers" },
];

/// How much an event may exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exchanges {
    /// Modules before the event, and modules after it.
    Modules { inputs: Limit, outputs: Limit },
    /// Exchanges: groups of 8 discrete channels (PL7:2502), channels of analog and of other modules (PL7:2504).
    Channels { discrete: Limit, analog: Limit, other: Limit },
}

const EXCHANGES_MICRO: Exchanges =
    Exchanges::Modules { inputs: Limit::new(2, "PL7:2491"), outputs: Limit::new(2, "PL7:2491") };

const fn exchanges(discrete: u32, analog: u32, other: u32) -> Exchanges {
    Exchanges::Channels {
        discrete: Limit::new(discrete, "PL7:2498"),
        analog: Limit::new(analog, "PL7:2499"),
        other: Limit::new(other, "PL7:2500"),
    }
}

const EXCHANGES_57_1: Exchanges = exchanges(32, 8, 4);
const EXCHANGES_57_2: Exchanges = exchanges(128, 16, 16);

/// The two series of controllers that the manual tells apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Series {
    /// TSX 37.
    Micro,
    /// TSX 57, PMX 57, PCX 57 (PL7:352).
    Premium,
}

impl Series {
    /// Lines of a rung.
    pub const fn ladder_lines(self) -> Limit {
        match self {
            Self::Micro => Limit::new(7, "PL7:2661"),
            Self::Premium => Limit::new(16, "PL7:2660"),
        }
    }

    /// Timers `%TM` and `%T` together.
    pub const fn timers(self) -> Limit {
        match self {
            Self::Micro => TIMERS_MICRO,
            Self::Premium => TIMERS_PREMIUM,
        }
    }

    /// Whether an index may be a constant word or an immediate value (PL7:1077-1080).
    pub const fn has_constant_index(self) -> bool {
        matches!(self, Self::Premium)
    }
}

/// How many function blocks of a kind there may be.
#[derive(Debug, PartialEq, Eq)]
pub struct BlockCount {
    pub symbol: &'static str,
    pub what: Counted,
    pub micro: Limit,
    pub premium: Limit,
    /// On a Premium unless configured.
    pub premium_default: Limit,
}

const fn block(
    symbol: &'static str,
    what: Counted,
    source: &'static str,
    [micro, premium, default]: [u32; 3],
) -> BlockCount {
    BlockCount {
        symbol,
        what,
        micro: Limit::new(micro, source),
        premium: Limit::new(premium, source),
        premium_default: Limit::new(default, source),
    }
}

/// PL7:975-997.
pub static BLOCK_COUNTS: &[BlockCount] = &[
    block("TM", Counted::Timers, "PL7:976", [64, 255, 128]),
    block("C", Counted::Counters, "PL7:979", [32, 255, 64]),
    block("MN", Counted::Monostables, "PL7:983", [8, 255, 32]),
    block("R", Counted::Registers, "PL7:986", [4, 255, 4]),
    block("DR", Counted::Drums, "PL7:990", [8, 255, 8]),
    block("T", Counted::OldTimers, "PL7:994", [64, 255, 0]),
];

/// What a chart may have (PL7:4277-4284).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChartLimits {
    pub main_steps: Limit,
    pub macro_steps: Limit,
    /// Steps of all macro-steps, `IN` and `OUT` not counted (PL7:4189).
    pub macro_step_steps: Limit,
    pub all_steps: Limit,
    pub active_steps: Limit,
    pub valid_transitions: Limit,
}

const fn chart(counts: [u32; 6]) -> ChartLimits {
    let [main, macros, of_macros, all, active, valid] = counts;
    ChartLimits {
        main_steps: Limit::new(main, "PL7:4279"),
        macro_steps: Limit::new(macros, "PL7:4280"),
        macro_step_steps: Limit::new(of_macros, "PL7:4281"),
        all_steps: Limit::new(all, "PL7:4282"),
        active_steps: Limit::new(active, "PL7:4283"),
        valid_transitions: Limit::new(valid, "PL7:4284"),
    }
}

/// Columns of PL7:4277-4284: TSX 37-10, TSX 37-20, TSX 57.
const CHART_37_10: (ChartLimits, ChartLimits) = (chart([96, 0, 0, 96, 16, 20]), chart([96, 0, 0, 96, 96, 192]));
const CHART_37_20: (ChartLimits, ChartLimits) = (chart([128, 0, 0, 128, 20, 24]), chart([128, 0, 0, 128, 128, 256]));
const CHART_57: (ChartLimits, ChartLimits) = (chart([128, 8, 64, 640, 40, 48]), chart([250, 64, 250, 1024, 250, 400]));

/// What one processor has. `None` where the manual does not tell.
#[derive(Debug, PartialEq, Eq)]
pub struct Processor {
    pub name: &'static str,
    pub series: Series,
    /// `%S`.
    pub system_bits: Limit,
    /// `%M`, at most.
    pub internal_bits: Option<Limit>,
    /// `%MW` without configuration; can be extended at the expense of the program.
    pub internal_words_default: Option<Limit>,
    /// `%MW` with the cartridge that gives most.
    pub internal_words: Option<Limit>,
    /// Without a cartridge, and with each that it takes; empty where the manual does not tell.
    pub memory: &'static [Memory],
    /// Bits of steps, those of macro-steps included.
    pub step_bits: Option<Limit>,
    pub chart_default: ChartLimits,
    pub chart_max: ChartLimits,
    /// Positions of a module.
    pub positions: Range,
    /// Racks, on a Premium.
    pub racks: Option<Range>,
    /// Events `EVTi`.
    pub events: Option<Range>,
    /// What one event may exchange.
    pub exchanges: Exchanges,
}

/// Figures of the Micro models that share a column of the tables.
struct Micro {
    source_words: &'static str,
    words: Option<Limit>,
    memory: &'static [Memory],
    steps: u32,
    chart: (ChartLimits, ChartLimits),
    positions: u32,
    events: Range,
}

const fn micro(name: &'static str, it: Micro) -> Processor {
    Processor {
        name,
        series: Series::Micro,
        system_bits: Limit::new(128, "PL7:1521"),
        internal_bits: Some(Limit::new(256, "PL7:1523")),
        internal_words_default: Some(Limit::new(512, it.source_words)),
        internal_words: it.words,
        memory: it.memory,
        step_bits: Some(Limit::new(it.steps, "PL7:1524")),
        chart_default: it.chart.0,
        chart_max: it.chart.1,
        positions: Range::new(0, it.positions, "PL7:677"),
        racks: None,
        events: Some(it.events),
        exchanges: EXCHANGES_MICRO,
    }
}

/// TSX 37-05, 37-08 and 37-10 take no cartridge that gives words (PL7:1532-1535).
const fn micro_10(memory: &'static [Memory]) -> Micro {
    Micro {
        source_words: "PL7:1535",
        words: None,
        memory,
        steps: 96,
        chart: CHART_37_10,
        positions: 8,
        events: Range::new(1, 8, "PL7:2060"),
    }
}

const fn micro_20(source_words: &'static str, memory: &'static [Memory]) -> Micro {
    Micro {
        source_words,
        // 17.5 K words.
        words: Some(Limit::new(17_920, source_words)),
        memory,
        steps: 128,
        chart: CHART_37_20,
        positions: 10,
        events: Range::new(0, 15, "PL7:2061"),
    }
}

/// Figures of the Premium models that share a column of the tables.
struct Premium {
    bits: Option<Limit>,
    words_default: Option<Limit>,
    words: Option<Limit>,
    memory: &'static [Memory],
    step_bits: Option<Limit>,
    last_rack: u32,
    events: Option<Range>,
    exchanges: Exchanges,
}

const fn premium(name: &'static str, it: Premium) -> Processor {
    Processor {
        name,
        series: Series::Premium,
        system_bits: Limit::new(128, "PL7:575"),
        internal_bits: it.bits,
        internal_words_default: it.words_default,
        internal_words: it.words,
        memory: it.memory,
        step_bits: it.step_bits,
        chart_default: CHART_57.0,
        chart_max: CHART_57.1,
        positions: Range::new(0, 14, "PL7:750"),
        racks: Some(Range::new(0, it.last_rack, "PL7:749")),
        events: it.events,
        exchanges: it.exchanges,
    }
}

/// The events that some processor has.
pub const EVENTS_LARGEST: Option<Range> = EVENTS_57_2;
/// The largest chart.
pub const CHART_LARGEST: ChartLimits = CHART_57.1;

const EVENTS_57_1: Option<Range> = Some(Range::new(0, 31, "PL7:2062"));
const EVENTS_57_2: Option<Range> = Some(Range::new(0, 63, "PL7:2063"));

/// 30.5 K words, the most of every Premium but the 57-1.
const fn words_30(source: &'static str) -> Option<Limit> {
    Some(Limit::new(31_232, source))
}

/// TSX 57-103, 57-153: racks 0 and 1 only.
const PREMIUM_1: Premium = Premium {
    bits: Some(Limit::new(3962, "PL7:1593")),
    words_default: Some(Limit::new(512, "PL7:1609")),
    // 26 K words.
    words: Some(Limit::new(26_624, "PL7:1609")),
    memory: memory::TSX_57_1,
    step_bits: Some(Limit::new(1024, "PL7:1594")),
    last_rack: 1,
    events: EVENTS_57_1,
    exchanges: EXCHANGES_57_1,
};

const fn premium_2(bits: u32, memory: &'static [Memory]) -> Premium {
    Premium {
        bits: Some(Limit::new(bits, "PL7:1593")),
        words_default: Some(Limit::new(1024, "PL7:1609")),
        words: words_30("PL7:1609"),
        memory,
        step_bits: Some(Limit::new(1024, "PL7:1594")),
        last_rack: 7,
        events: EVENTS_57_2,
        exchanges: EXCHANGES_57_2,
    }
}

const fn premium_3(memory: &'static [Memory]) -> Premium {
    Premium {
        bits: Some(Limit::new(16_250, "PL7:1642")),
        words_default: Some(Limit::new(1024, "PL7:1654")),
        words: words_30("PL7:1654"),
        memory,
        step_bits: Some(Limit::new(1024, "PL7:1643")),
        last_rack: 7,
        events: EVENTS_57_2,
        exchanges: EXCHANGES_57_2,
    }
}

const PREMIUM_4: Premium = Premium {
    bits: Some(Limit::new(32_634, "PL7:1691")),
    words_default: Some(Limit::new(1024, "PL7:1705")),
    words: words_30("PL7:1705"),
    memory: memory::TSX_57_4,
    step_bits: Some(Limit::new(1024, "PL7:1692")),
    last_rack: 7,
    events: EVENTS_57_2,
    exchanges: EXCHANGES_57_2,
};

/// Named for its racks alone (PL7:749); its memory is in no table.
const PREMIUM_102: Premium = Premium {
    bits: None,
    words_default: None,
    words: None,
    memory: &[],
    step_bits: None,
    last_rack: 1,
    events: EVENTS_57_1,
    exchanges: EXCHANGES_57_1,
};

/// A Premium of which nothing more is said: the largest figures.
const PREMIUM_ANY: Premium = PREMIUM_4;

/// Every processor that the manual names, the families that its headings name (PL7:1582, 1633, 1680), and the series for a
/// program whose processor is not known.
pub static PROCESSORS: &[Processor] = &[
    micro("TSX 37-05", micro_10(memory::TSX_37_05)),
    micro("TSX 37-08", micro_10(memory::TSX_37_05)),
    micro("TSX 37-10", micro_10(memory::TSX_37_10)),
    // Named for its charts alone (PL7:4277), which the TSX 37-21 and 37-22 share with it.
    micro("TSX 37-20", micro_20("PL7:1535", memory::TSX_37_21)),
    micro("TSX 37-21", micro_20("PL7:1535", memory::TSX_37_21)),
    micro("TSX 37-22", micro_20("PL7:1560", memory::TSX_37_22)),
    premium("TSX 57-10", PREMIUM_1),
    premium("TSX 57-102", PREMIUM_102),
    premium("PMX 57-102", PREMIUM_102),
    premium("PCX 57-1012", PREMIUM_102),
    premium("TSX 57-103", PREMIUM_1),
    premium("TSX 57-15", PREMIUM_1),
    premium("TSX 57-153", PREMIUM_1),
    premium("TSX 57-20", premium_2(8056, memory::TSX_57_203)),
    premium("TSX 57-203", premium_2(8056, memory::TSX_57_203)),
    premium("TSX 57-25", premium_2(8056, memory::TSX_57_253)),
    premium("TSX 57-253", premium_2(8056, memory::TSX_57_253)),
    premium("TSX 57-26", premium_2(8056, memory::TSX_57_203)),
    premium("TSX 57-2623", premium_2(8056, memory::TSX_57_203)),
    premium("TSX 57-28", premium_2(8056, memory::TSX_57_253)),
    premium("TSX 57-2823", premium_2(8056, memory::TSX_57_253)),
    // PL7:1590 puts it with the bits of the TSX 57-103, PL7:1606 with the words of the TSX 57-203.
    premium("PCX 57-203", premium_2(3962, memory::TSX_57_203)),
    premium("TSX 57-30", premium_3(memory::TSX_57_303)),
    premium("TSX 57-303", premium_3(memory::TSX_57_303)),
    premium("TSX 57-35", premium_3(memory::TSX_57_353)),
    premium("TSX 57-353", premium_3(memory::TSX_57_353)),
    premium("TSX 57-36", premium_3(memory::TSX_57_303)),
    premium("TSX 57-3623", premium_3(memory::TSX_57_303)),
    premium("PCX 57-353", premium_3(memory::TSX_57_353)),
    premium("TSX 57-453", PREMIUM_4),
    premium("TSX 57-4823", PREMIUM_4),
    micro("TSX 37", micro_20("PL7:1535", memory::TSX_37_21)),
    premium("TSX 57", PREMIUM_ANY),
    premium("PMX 57", PREMIUM_ANY),
    premium("PCX 57", PREMIUM_ANY),
];

impl Processor {
    /// How many of something the processor can have at most; `None` where the manual gives no end.
    pub fn count(&self, what: Counted) -> Option<Limit> {
        match what {
            Counted::Bits => self.internal_bits,
            // Data lies in the RAM of the processor (PL7:1344, 1403): where the table gives a default alone, that is the end.
            Counted::Words => self.internal_words.or_else(|| {
                let ram = self.memory.iter().map(|it| it.ram).max()?;
                Some(Limit::new(ram * 1024, "PL7:1534"))
            }),
            Counted::SystemBits => Some(self.system_bits),
            Counted::Steps => Some(self.chart_max.main_steps),
            Counted::MacroSteps => Some(self.chart_max.macro_steps),
            Counted::Constants | Counted::Bytes | Counted::SystemWords | Counted::FastCounters | Counted::Texts => None,
            Counted::Timers
            | Counted::OldTimers
            | Counted::Counters
            | Counted::Monostables
            | Counted::Registers
            | Counted::Drums => {
                let row = BLOCK_COUNTS.iter().find(|it| it.what == what)?;
                Some(match self.series {
                    Series::Micro => row.micro,
                    Series::Premium => row.premium,
                })
            }
        }
    }
}

/// The most that any processor has of something.
pub fn largest_count(what: Counted) -> Option<Limit> {
    PROCESSORS.iter().filter_map(|it| it.count(what)).max_by_key(|it| it.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::Target;

    fn processor(name: &str) -> &'static Processor {
        let target: Target = name.parse().unwrap_or_else(|error| panic!("{error}"));
        target.processor().unwrap_or_else(|| panic!("{name} is no PL7 processor"))
    }

    #[test]
    fn counts_of_the_tables() {
        let cases = [
            ("TSX 37-10", 256, 512, None, 96, (1, 8)),
            ("TSX 37-21", 256, 512, Some(17_920), 128, (0, 15)),
            ("TSX 37-22", 256, 512, Some(17_920), 128, (0, 15)),
            ("TSX 57-103", 3962, 512, Some(26_624), 1024, (0, 31)),
            ("PCX 57-203", 3962, 1024, Some(31_232), 1024, (0, 63)),
            ("TSX 57-253", 8056, 1024, Some(31_232), 1024, (0, 63)),
            ("TSX 57-353", 16_250, 1024, Some(31_232), 1024, (0, 63)),
            ("TSX 57-453", 32_634, 1024, Some(31_232), 1024, (0, 63)),
        ];
        for (name, bits, words_default, words, steps, events) in cases {
            let it = processor(name);
            let value = |limit: Option<Limit>| limit.map(|it| it.value);
            assert_eq!(value(it.internal_bits), Some(bits), "{name}");
            assert_eq!(value(it.internal_words_default), Some(words_default), "{name}");
            assert_eq!(value(it.internal_words), words, "{name}");
            assert_eq!(value(it.step_bits), Some(steps), "{name}");
            assert_eq!(it.events.map(|it| (it.first, it.last)), Some(events), "{name}");
            assert_eq!(it.system_bits.value, 128);
        }
    }

    #[test]
    fn charts_racks_and_ladder() {
        let (small, micro, premium) = (processor("TSX 37-10"), processor("TSX 37-22"), processor("TSX 57-353"));
        assert_eq!((small.chart_max.main_steps.value, small.chart_max.valid_transitions.value), (96, 192));
        assert_eq!((micro.chart_default.active_steps.value, micro.chart_max.active_steps.value), (20, 128));
        assert_eq!((premium.chart_max.macro_steps.value, premium.chart_max.all_steps.value), (64, 1024));
        assert!(!micro.series.has_constant_index() && premium.series.has_constant_index());
        assert_eq!((micro.series.ladder_lines().value, premium.series.ladder_lines().value), (7, 16));
        assert_eq!((micro.series.timers().value, premium.series.timers().value), (64, 255));
        assert_eq!((small.positions.last, micro.positions.last, premium.positions.last), (8, 10, 14));
        let racks = |name| processor(name).racks.map(|it| it.last);
        let found = [racks("TSX 37-22"), racks("TSX 57-153"), racks("PMX 57-102"), racks("TSX 57-203")];
        assert_eq!(found, [None, Some(1), Some(1), Some(7)]);
    }

    #[test]
    fn defaults_never_exceed_the_maximum() {
        for it in PROCESSORS {
            if let (Some(default), Some(max)) = (it.internal_words_default, it.internal_words) {
                assert!(default.value <= max.value, "{}", it.name);
            }
            let (default, max) = (it.chart_default, it.chart_max);
            assert!(
                default.all_steps.value <= max.all_steps.value && default.active_steps.value <= max.active_steps.value
            );
        }
        for it in BLOCK_COUNTS {
            assert!(it.premium_default.value <= it.premium.value, "{}", it.symbol);
        }
    }

    #[test]
    fn exchanges_of_an_event() {
        let channels = |name| match processor(name).exchanges {
            Exchanges::Channels { discrete, analog, other } => [discrete, analog, other].map(|it| it.value),
            Exchanges::Modules { .. } => panic!("{name}"),
        };
        assert_eq!(channels("TSX 57-153"), [32, 8, 4]);
        assert_eq!(channels("TSX 57-203"), [128, 16, 16]);
        assert_eq!(channels("TSX 57-4823"), [128, 16, 16]);
        let micro = Exchanges::Modules { inputs: Limit::new(2, "PL7:2491"), outputs: Limit::new(2, "PL7:2491") };
        assert_eq!(processor("TSX 37-05").exchanges, micro);
    }

    #[test]
    fn each_processor_has_its_columns() {
        let cells = |name| {
            let last = processor(name).memory.last().unwrap_or_else(|| panic!("{name}"));
            (processor(name).memory.len(), last.cartridge, last.ram, last.words, last.constants)
        };
        assert_eq!(cells("TSX 37-08"), (1, None, 9, 512, 128));
        assert_eq!(cells("TSX 37-22"), (4, Some(128), 148, 17_920, 512));
        assert_eq!(cells("TSX 57-103"), (3, Some(64), 32, 26_624, 512));
        assert_eq!(cells("TSX 57-2823"), (4, Some(128), 64, 31_232, 512));
        assert_eq!(cells("PCX 57-203"), (4, Some(128), 48, 31_232, 512));
        assert_eq!(cells("TSX 57-3623"), (6, Some(384), 80, 31_232, 1024));
        assert_eq!(cells("PCX 57-353"), (6, Some(384), 96, 31_232, 1024));
        assert_eq!(cells("TSX 57-453"), (8, Some(960), 176, 31_232, 1024));
        assert!(processor("TSX 57-102").memory.is_empty());
        for it in PROCESSORS.iter().filter(|it| !it.memory.is_empty()) {
            let words = it.memory.iter().map(|it| it.words).max();
            let most = it.internal_words.or(it.internal_words_default).map(|it| it.value);
            assert_eq!(words, most, "{}", it.name);
            assert_eq!(
                it.memory.first().map(|it| it.words),
                it.internal_words_default.map(|it| it.value),
                "{}",
                it.name
            );
        }
    }

    #[test]
    fn keys_of_a_configuration_are_unique() {
        let mut keys: Vec<&str> = NUMBERED.iter().map(|it| it.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), NUMBERED.len());
        for it in BLOCK_COUNTS {
            let numbered = NUMBERED.iter().find(|row| row.what == it.what).unwrap();
            assert_eq!((numbered.key, numbered.prefix.trim_start_matches('%')), (it.symbol, it.symbol));
        }
    }
}

//! TSX Micro and Premium, programmed with PL7.

use super::{Limit, Range};

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
/// Times of steps, in units of 100 ms.
pub const STEP_TIMES: Range = Range::new(0, 9999, "PL7:4248");
/// Only these system words can be a table.
pub const SYSTEM_WORD_TABLE: Range = Range::new(50, 53, "PL7:1045");
/// Transitions of a chart, of which at most 64 may close or open AND branches (PL7:4286).
pub const TRANSITIONS: Limit = Limit::new(1024, "PL7:4190");
pub const AND_CONVERGENCES: Limit = Limit::new(64, "PL7:4286");
/// Branches of one divergence or convergence.
pub const BRANCHES: Limit = Limit::new(11, "PL7:4191-4196");
/// Characters of a symbol.
pub const SYMBOL_LENGTH: Limit = Limit::new(32, "PL7:1198");
/// Characters of the comment of a symbol, and of a section (also PL7:2007: subroutine).
pub const SYMBOL_COMMENT: Limit = Limit::new(508, "PL7:1222");
pub const MODULE_COMMENT: Limit = Limit::new(250, "PL7:1985");
/// Columns of a rung.
pub const LADDER_COLUMNS: Limit = Limit::new(11, "PL7:2660");

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

    /// Whether charts may have macro-steps (PL7:4280, PL7:4804).
    pub const fn has_macro_steps(self) -> bool {
        matches!(self, Self::Premium)
    }
}

/// How many function blocks of a kind there may be.
#[derive(Debug, PartialEq, Eq)]
pub struct BlockCount {
    pub symbol: &'static str,
    pub micro: Limit,
    pub premium: Limit,
    /// On a Premium unless configured.
    pub premium_default: Limit,
}

const fn block(symbol: &'static str, source: &'static str, micro: u32, premium: u32, default: u32) -> BlockCount {
    BlockCount {
        symbol,
        micro: Limit::new(micro, source),
        premium: Limit::new(premium, source),
        premium_default: Limit::new(default, source),
    }
}

/// PL7:975-997.
pub static BLOCK_COUNTS: &[BlockCount] = &[
    block("TM", "PL7:976", 64, 255, 128),
    block("C", "PL7:979", 32, 255, 64),
    block("MN", "PL7:983", 8, 255, 32),
    block("R", "PL7:986", 4, 255, 4),
    block("DR", "PL7:990", 8, 255, 8),
    block("T", "PL7:994", 64, 255, 0),
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
}

/// Figures of the Micro models that share a column of the tables.
struct Micro {
    source_words: &'static str,
    words: Option<Limit>,
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
        step_bits: Some(Limit::new(it.steps, "PL7:1524")),
        chart_default: it.chart.0,
        chart_max: it.chart.1,
        positions: Range::new(0, it.positions, "PL7:677"),
        racks: None,
        events: Some(it.events),
    }
}

/// TSX 37-05, 37-08 and 37-10 take no cartridge that gives words (PL7:1532-1535).
const MICRO_10: Micro = Micro {
    source_words: "PL7:1535",
    words: None,
    steps: 96,
    chart: CHART_37_10,
    positions: 8,
    events: Range::new(1, 8, "PL7:2060"),
};

const fn micro_20(source_words: &'static str) -> Micro {
    Micro {
        source_words,
        // 17.5 K words.
        words: Some(Limit::new(17_920, source_words)),
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
    step_bits: Option<Limit>,
    last_rack: u32,
    events: Option<Range>,
}

const fn premium(name: &'static str, it: Premium) -> Processor {
    Processor {
        name,
        series: Series::Premium,
        system_bits: Limit::new(128, "PL7:575"),
        internal_bits: it.bits,
        internal_words_default: it.words_default,
        internal_words: it.words,
        step_bits: it.step_bits,
        chart_default: CHART_57.0,
        chart_max: CHART_57.1,
        positions: Range::new(0, 14, "PL7:750"),
        racks: Some(Range::new(0, it.last_rack, "PL7:749")),
        events: it.events,
    }
}

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
    step_bits: Some(Limit::new(1024, "PL7:1594")),
    last_rack: 1,
    events: EVENTS_57_1,
};

const fn premium_2(bits: u32) -> Premium {
    Premium {
        bits: Some(Limit::new(bits, "PL7:1593")),
        words_default: Some(Limit::new(1024, "PL7:1609")),
        words: words_30("PL7:1609"),
        step_bits: Some(Limit::new(1024, "PL7:1594")),
        last_rack: 7,
        events: EVENTS_57_2,
    }
}

const PREMIUM_3: Premium = Premium {
    bits: Some(Limit::new(16_250, "PL7:1642")),
    words_default: Some(Limit::new(1024, "PL7:1654")),
    words: words_30("PL7:1654"),
    step_bits: Some(Limit::new(1024, "PL7:1643")),
    last_rack: 7,
    events: EVENTS_57_2,
};

const PREMIUM_4: Premium = Premium {
    bits: Some(Limit::new(32_634, "PL7:1691")),
    words_default: Some(Limit::new(1024, "PL7:1705")),
    words: words_30("PL7:1705"),
    step_bits: Some(Limit::new(1024, "PL7:1692")),
    last_rack: 7,
    events: EVENTS_57_2,
};

/// Named for its racks alone (PL7:749); its memory is in no table.
const PREMIUM_102: Premium =
    Premium { bits: None, words_default: None, words: None, step_bits: None, last_rack: 1, events: EVENTS_57_1 };

/// A Premium of which nothing more is said: the largest figures.
const PREMIUM_ANY: Premium = PREMIUM_4;

/// Every processor that the manual names, and the two series for a program whose processor is not known.
pub static PROCESSORS: &[Processor] = &[
    micro("TSX 37-05", MICRO_10),
    micro("TSX 37-08", MICRO_10),
    micro("TSX 37-10", MICRO_10),
    micro("TSX 37-21", micro_20("PL7:1535")),
    micro("TSX 37-22", micro_20("PL7:1560")),
    premium("TSX 57-102", PREMIUM_102),
    premium("PMX 57-102", PREMIUM_102),
    premium("PCX 57-1012", PREMIUM_102),
    premium("TSX 57-103", PREMIUM_1),
    premium("TSX 57-153", PREMIUM_1),
    premium("TSX 57-203", premium_2(8056)),
    premium("TSX 57-253", premium_2(8056)),
    premium("TSX 57-2623", premium_2(8056)),
    premium("TSX 57-2823", premium_2(8056)),
    // PL7:1590 puts it with the bits of the TSX 57-103, PL7:1606 with the words of the TSX 57-203.
    premium("PCX 57-203", premium_2(3962)),
    premium("TSX 57-303", PREMIUM_3),
    premium("TSX 57-353", PREMIUM_3),
    premium("TSX 57-3623", PREMIUM_3),
    premium("PCX 57-353", PREMIUM_3),
    premium("TSX 57-453", PREMIUM_4),
    premium("TSX 57-4823", PREMIUM_4),
    micro("TSX 37", micro_20("PL7:1535")),
    premium("TSX 57", PREMIUM_ANY),
];

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
        assert!(!micro.series.has_macro_steps() && premium.series.has_macro_steps());
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
}

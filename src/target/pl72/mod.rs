//! TSX 17-20, TSX 27 and TSX 47, programmed with PL7-2.
//!
//! The document tells controllers apart by [`Series`], software by [`Release`]. Where the controller or its version is not
//! known, a [`Model`] has all releases that it may be, and a question about it gets the answer of the most capable one.

mod block;
mod channel;
mod cost;
mod operation;
mod release;
mod system;

pub use block::{
    BLOCKS, Block, BlockKind, CLOCK_WORDS, CLOCKS, DRUM_STEP, PRESETS, Pin, TEXT_BYTES, TEXT_KINDS, TEXT_PARTNERS,
    TEXT_STATIONS, TextKind, of_address,
};
pub use channel::{Channels, Misfit, Modules, RUN_STOP_INPUT, SECURITY_OUTPUT};
pub use cost::{
    COSTS, Cost, Element, InstructionCost, NEAR_BITS, NETWORK_COMMENT_BYTES, SYSTEM_COSTS, SystemCost, SystemTask,
    TimeRange, Triggered,
};
pub use operation::{
    ARITHMETIC, ASCII_DIGITS, ASCII_WORDS, BCD_MAX, BIT_STRING, COMPARE_COLUMNS, OPERATE_COLUMNS, OPERATIONS, Operand,
    OperandRange, Operation, OperationKind, SHIFT, TRANSFERS, Transfer,
};
pub use release::{Feature, RELEASES, Release, UnknownVersion, Version};
pub use system::{Manager, SYSTEM_BITS, SYSTEM_WORDS, SystemObject, Writer, system_bit, system_word};

use super::{ChartBits, Counted, Limit, Numbered, Range};

/// Watchdog of the master task, which is not periodic, in milliseconds (also PL72:534).
pub const WATCHDOG_MS: Limit = Limit::new(150, "PL72:477");

/// Labels of networks; each network has one.
pub const LABELS: Range = Range::new(1, 999, "PL72:600");
/// Characters of the comment of a network, an action or a receptivity (also PL72:1425, PL72:1481).
pub const COMMENT_LENGTH: Limit = Limit::new(15, "PL72:601");
/// Characters of the comment of a step.
pub const STEP_COMMENT_LENGTH: Limit = Limit::new(15, "PL72:1425");
/// Lines of a network, and contacts in a line of its test zone.
pub const LADDER_LINES: Limit = Limit::new(4, "PL72:606");
pub const LADDER_CONTACTS: Limit = Limit::new(9, "PL72:606");
/// Columns of a network: those of contacts, then that of coils.
pub const LADDER_COLUMNS: Limit = Limit::new(LADDER_CONTACTS.value + 1, "PL72:606-607");
/// Columns of a block whose size the document does not tell: those of all others.
pub const BLOCK_COLUMNS: Limit = Limit::new(2, "PL72:662");

/// `Wi` and `CWi` that an instruction reaches directly; the others, by transfer of a table alone.
pub const DIRECT_WORDS: Range = Range::new(0, 127, "PL72:289");
/// Words of a page of the memory of `Wi` or `CWi` (PL72:1092-1101).
pub const PAGE_WORDS: Limit = Limit::new(128, "PL72:1094-1101");
/// Words that can be indexed.
pub const INDEXED_WORDS: Range = Range::new(0, 127, "PL72:994");

pub const JUMPS: Limit = Limit::new(42, "PL72:418");
/// Pages of a chart, P0 to P7.
pub const CHART_PAGES: Limit = Limit::new(8, "PL72:1346-1347");
pub const CHART_COLUMNS: Limit = Limit::new(8, "PL72:1341");
/// In one column of a page.
pub const COLUMN_STEPS: Limit = Limit::new(6, "PL72:1342");
pub const COLUMN_TRANSITIONS: Limit = Limit::new(6, "PL72:1343");
pub const COLUMN_ORIGINS: Limit = Limit::new(1, "PL72:1344");
pub const COLUMN_DESTINATIONS: Limit = Limit::new(1, "PL72:1345");
/// What initialises, clears and prepositions or freezes charts. All are reset by the system.
pub static CHART_BITS: ChartBits =
    ChartBits { bits: Range::new(21, 23, "PL72:1824"), cleared: &[], only_set: Some("PL72:1824") };
/// Lines of a page: those of its origin connectors, steps, transitions and destination connectors.
pub const CHART_LINES: Limit = Limit::new(
    COLUMN_ORIGINS.value + COLUMN_STEPS.value + COLUMN_TRANSITIONS.value + COLUMN_DESTINATIONS.value,
    "PL72:1341-1345",
);
/// Steps of a chart, the initial ones included.
pub const STEPS: Limit = Limit::new(96, "PL72:1407");
pub const STEP_NUMBERS: Range = Range::new(0, 95, "PL72:1409");
pub const INITIAL_STEPS: Limit = Limit::new(16, "PL72:1407");
pub const ACTIVE_STEPS: Limit = Limit::new(16, "PL72:1413");
pub const TRANSITIONS: Limit = Limit::new(128, "PL72:1471");
pub const VALID_TRANSITIONS: Limit = Limit::new(24, "PL72:1471");
/// Connectors of each kind (also PL72:428-429).
pub const DESTINATION_CONNECTORS: Limit = Limit::new(42, "PL72:1393");
pub const ORIGIN_CONNECTORS: Limit = Limit::new(42, "PL72:1397");
/// Transitions after an OR divergence, and before an OR convergence.
pub const OR_BRANCHES_OUT: Limit = Limit::new(4, "PL72:1373");
/// Times of steps, in seconds (also PL72:1793).
pub const STEP_TIMES_S: Range = Range::new(0, 9999, "PL72:1451");
pub const STEP_TIME_UNIT_MS: Limit = Limit::new(1000, "PL72:1451");

/// The fast task of TSX 27 and TSX 47, which is periodic: what one setting of SY03 makes of it (PL72:547-549).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FastTask {
    /// State of SY03.
    pub sy03: bool,
    pub period_ms: Limit,
    /// Longest execution that leaves the controller working as it should.
    pub duration_us: Limit,
    pub networks: Limit,
    /// Not with an intelligent coupler or a TELWAY coupler in the configuration of a TSX 47-20 (PL72:553).
    pub excludes_couplers: bool,
}

pub static FAST_TASKS: &[FastTask] = &[
    FastTask {
        sy03: true,
        period_ms: Limit::new(5, "PL72:548"),
        duration_us: Limit::new(1_000, "PL72:548"),
        networks: Limit::new(10, "PL72:548"),
        excludes_couplers: true,
    },
    FastTask {
        sy03: false,
        period_ms: Limit::new(10, "PL72:549"),
        duration_us: Limit::new(2_000, "PL72:549"),
        networks: Limit::new(20, "PL72:549"),
        excludes_couplers: false,
    },
];

/// Channels that the fast task of a controller may own. The fast task shares its outputs with the master task (PL72:522,
/// PL72:563).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FastTaskChannels {
    /// One byte of inputs and one byte of outputs of the base unit, each configured: first channel of each choice.
    Bytes { inputs: &'static [u32], outputs: &'static [u32], source: &'static str },
    /// Always these two modules.
    Modules { input: u32, output: u32, source: &'static str },
    /// That many modules, configured.
    Configured { modules: Limit },
}

/// The columns of most tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Series {
    Tsx17,
    Tsx27,
    Tsx47,
}

impl Series {
    pub const ALL: [Self; 3] = [Self::Tsx17, Self::Tsx27, Self::Tsx47];

    pub const fn fast_task_channels(self) -> FastTaskChannels {
        match self {
            Self::Tsx17 => FastTaskChannels::Bytes { inputs: &[0, 8, 16], outputs: &[0, 8], source: "PL72:520" },
            Self::Tsx27 => FastTaskChannels::Modules { input: 1, output: 0, source: "PL72:559" },
            Self::Tsx47 => FastTaskChannels::Configured { modules: Limit::new(2, "PL72:561") },
        }
    }

    /// Place in a row of the tables.
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// Kinds of objects that the tables count (PL72:255-310).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    Input,
    Output,
    EventInput,
    /// `Bi`.
    Bit,
    /// `SYi`.
    SystemBit,
    /// `Xi`.
    Step,
    /// `Sx,j`.
    ModuleFault,
    /// `Ixy,S`.
    InputFault,
    /// `Oy,S`, `Oxy,S`.
    OutputFault,
    /// `Wi`.
    Word,
    /// `CWi`.
    Constant,
    /// `SWi`.
    SystemWord,
    /// `COMi,j`.
    CommonWord,
    /// `Xi,V`.
    StepTime,
    InputWord,
    OutputWord,
    WordBit,
    ConstantBit,
    SystemWordBit,
    CommonWordBit,
    InputWordBit,
    OutputWordBit,
}

/// How many objects of a kind there are; 0 where there are none.
#[derive(Debug, PartialEq, Eq)]
pub struct ObjectCount {
    pub kind: Kind,
    /// By series: TSX 17-20, TSX 27, TSX 47.
    pub counts: [u32; 3],
    pub source: &'static str,
}

const fn count(kind: Kind, counts: [u32; 3], source: &'static str) -> ObjectCount {
    ObjectCount { kind, counts, source }
}

/// PL72:255-310. Of words and constants this is the most; [`Release`] has the count of each version.
pub static OBJECT_COUNTS: &[ObjectCount] = &[
    count(Kind::Input, [96, 48, 256], "PL72:257-259"),
    count(Kind::Output, [64, 32, 256], "PL72:258-260"),
    count(Kind::EventInput, [2, 0, 0], "PL72:261-262"),
    count(Kind::Bit, [256; 3], "PL72:263"),
    count(Kind::SystemBit, [24; 3], "PL72:264"),
    count(Kind::Step, [96; 3], "PL72:266"),
    count(Kind::ModuleFault, [4 * 8, 0, 0], "PL72:267"),
    count(Kind::InputFault, [0, 0, 16], "PL72:269"),
    count(Kind::OutputFault, [0, 4, 16], "PL72:268-270"),
    count(Kind::Word, [1024, 128, 1024], "PL72:276"),
    count(Kind::Constant, [1024; 3], "PL72:277"),
    count(Kind::SystemWord, [64, 0, 4], "PL72:278"),
    count(Kind::CommonWord, [16 * 4, 0, 16 * 4], "PL72:279-280"),
    count(Kind::StepTime, [96; 3], "PL72:283"),
    count(Kind::InputWord, [4 * 8, 0, 4 * 8], "PL72:284-286"),
    count(Kind::OutputWord, [4 * 8, 0, 4 * 8], "PL72:285-287"),
    count(Kind::WordBit, [128 * 16; 3], "PL72:301"),
    count(Kind::ConstantBit, [128 * 16; 3], "PL72:302"),
    count(Kind::SystemWordBit, [64 * 16, 0, 4 * 16], "PL72:303-304"),
    count(Kind::CommonWordBit, [64 * 16, 0, 64 * 16], "PL72:305-306"),
    count(Kind::InputWordBit, [32 * 16, 0, 32 * 16], "PL72:307-309"),
    count(Kind::OutputWordBit, [32 * 16, 0, 32 * 16], "PL72:308-310"),
];

const fn numbered(what: Counted, prefix: &'static str, plural: &'static str) -> Numbered {
    Numbered { what, key: "", prefix, plural }
}

/// What the tables count, and programs number from 0. No configuration changes how many there are.
pub static NUMBERED: &[Numbered] = &[
    numbered(Counted::Bits, "B", "internal bits"),
    numbered(Counted::Words, "W", "internal words"),
    numbered(Counted::Constants, "CW", "constant words"),
    numbered(Counted::SystemBits, "SY", "system bits"),
    numbered(Counted::SystemWords, "SW", "system words"),
    numbered(Counted::Steps, "X", "steps"),
    numbered(Counted::Timers, "T", "timers"),
    numbered(Counted::Counters, "C", "counters"),
    numbered(Counted::FastCounters, "FC", "fast counters"),
    numbered(Counted::Monostables, "M", "monostables"),
    numbered(Counted::Registers, "R", "registers"),
    numbered(Counted::Drums, "D", "drum controllers"),
    numbered(Counted::Texts, "TXT", "text blocks"),
];

/// What the block of a symbol is counted as: `T`, `TXT`.
pub fn block_of_symbol(symbol: &str) -> Option<Counted> {
    NUMBERED.iter().find(|it| it.what.is_block() && it.prefix == symbol).map(|it| it.what)
}

/// A controller as a configuration names it.
#[derive(Debug, PartialEq, Eq)]
pub struct Controller {
    pub name: &'static str,
    pub series: Series,
    pub channels: &'static Channels,
    /// Oldest first.
    pub releases: &'static [&'static Release],
}

pub static CONTROLLERS: &[Controller] = &[
    Controller {
        name: "TSX 17-20",
        series: Series::Tsx17,
        channels: &channel::CHANNELS_17,
        releases: &[&release::TSX_17_20],
    },
    Controller {
        name: "TSX 27",
        series: Series::Tsx27,
        channels: &channel::CHANNELS_27,
        releases: &[&release::TSX_27_V2, &release::TSX_27_V3],
    },
    Controller {
        name: "TSX 47-J",
        series: Series::Tsx47,
        channels: &channel::CHANNELS_47_J,
        releases: &[&release::TSX_47_V2, &release::TSX_47_10_V3],
    },
    Controller {
        name: "TSX 47-10",
        series: Series::Tsx47,
        channels: &channel::CHANNELS_47_10,
        releases: &[&release::TSX_47_V2, &release::TSX_47_10_V3],
    },
    Controller {
        name: "TSX 47-20",
        series: Series::Tsx47,
        channels: &channel::CHANNELS_47_20,
        releases: &[&release::TSX_47_V2, &release::TSX_47_20_V3, &release::TSX_47_20_V4],
    },
];

/// A controller and its version, each as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Model {
    pub controller: Option<&'static Controller>,
    /// Says nothing without a controller: versions of different controllers do not compare.
    pub version: Option<Version>,
}

impl Model {
    /// What the software may be; at least one release.
    pub fn releases(&self) -> impl Iterator<Item = &'static Release> {
        let (all, version) = match self.controller {
            Some(controller) => (controller.releases, self.version),
            None => (RELEASES.as_slice(), None),
        };
        let is_meant = move |it: &&'static Release| {
            version.is_none_or(|version| it.from <= version && it.before.is_none_or(|next| version < next))
        };
        all.iter().copied().filter(is_meant)
    }

    /// What the controller may be.
    pub fn series(&self) -> impl Iterator<Item = Series> {
        let own = self.controller.map(|it| it.series);
        Series::ALL.into_iter().filter(move |it| own.is_none_or(|own| own == *it))
    }

    /// Whether the software has a feature.
    pub fn has(&self, feature: Feature) -> bool {
        self.releases().any(|it| it.features.contains(&feature))
    }

    /// The controller with its version, as a message names it; `None` when no controller is known.
    pub fn name(&self) -> Option<String> {
        let controller = self.controller?;
        Some(self.version.map_or_else(|| controller.name.to_owned(), |it| format!("{} {it}", controller.name)))
    }

    /// The first version of the same controller that has a feature, later than its own.
    pub fn first_with(&self, feature: Feature) -> Option<Version> {
        let releases = self.controller?.releases.iter();
        let first = releases.filter(|it| it.features.contains(&feature)).map(|it| it.from).min()?;
        (first > Version::new(0, 0)).then_some(first)
    }

    /// Whether the complete text block has an item, `T` of `TXT0,T`, on the controller.
    pub fn has_text_item(&self, item: &str) -> bool {
        let Some(controller) = self.controller else { return true };
        let mut kinds = TEXT_KINDS.iter().filter(|it| it.items.contains(&item)).peekable();
        kinds.peek().is_none() || kinds.any(|it| it.controllers.contains(&controller.name))
    }

    /// Whether there is a clock (also PL72:618, PL72:1243).
    pub fn has_clock(&self) -> bool {
        self.series().any(|it| it == Series::Tsx17)
    }

    /// How many objects of a kind there are: 0 where the controller has none.
    pub fn count(&self, kind: Kind) -> Limit {
        let by_release = |count: fn(&Release) -> Limit| self.releases().map(count).max_by_key(|it| it.value);
        let by_release = match kind {
            Kind::Word => by_release(|it| it.words),
            Kind::Constant => by_release(|it| it.constants),
            _ => None,
        };
        by_release.unwrap_or_else(|| {
            let row = OBJECT_COUNTS.iter().find(|it| it.kind == kind);
            let count = row.map(|it| self.series().map(|series| it.counts[series.index()]).max().unwrap_or(0));
            Limit::new(count.unwrap_or(0), row.map_or("", |it| it.source))
        })
    }

    /// How many there are of what programs number.
    pub fn numbered(&self, what: Counted) -> Option<Limit> {
        let kind = match what {
            Counted::Bits => Kind::Bit,
            Counted::Words => Kind::Word,
            Counted::Constants => Kind::Constant,
            Counted::SystemBits => Kind::SystemBit,
            Counted::SystemWords => Kind::SystemWord,
            Counted::Steps => Kind::Step,
            _ => return self.block_count(NUMBERED.iter().find(|it| it.what == what)?.prefix),
        };
        Some(self.count(kind))
    }

    /// How many blocks there are of a symbol (`T`, `C`, `M`, `R`, `D`, `FC`, `TXT`).
    pub fn block_count(&self, symbol: &str) -> Option<Limit> {
        let rows = BLOCKS.iter().filter(|it| it.symbol == Some(symbol));
        rows.flat_map(|row| self.series().filter_map(|it| row.count(it))).max_by_key(|it| it.value)
    }

    /// Whether a system bit has a function. `None` where no row of the table is about it.
    pub fn has_system_bit(&self, number: u32) -> Option<bool> {
        let version = self.controller.and(self.version);
        let mut rows = SYSTEM_BITS.iter().filter(|it| it.number == number).peekable();
        rows.peek()?;
        Some(rows.any(|row| {
            self.series().any(|series| {
                row.since[series.index()].is_some_and(|since| version.is_none_or(|version| since <= version))
            })
        }))
    }

    /// Whether an operation is one of the controller's.
    pub fn has_operation(&self, operation: &Operation) -> bool {
        let has_feature = operation.feature.is_none_or(|it| self.has(it));
        has_feature && self.series().any(|series| operation.series.contains(&series))
    }

    /// Range of the operands of an operation, the widest of what the controller may be.
    pub fn operand_range(&self, operation: &Operation) -> Option<OperandRange> {
        self.series()
            .filter_map(|series| operation.range(series))
            .max_by_key(|it| i64::from(it.last) - i64::from(it.first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::Target;

    fn model(name: &str, version: Option<&str>) -> Model {
        let target: Target = name.parse().unwrap_or_else(|error| panic!("{error}"));
        let target = target.with_version(version).unwrap_or_else(|error| panic!("{error}"));
        target.pl72().unwrap_or_else(|| panic!("{name} is not programmed with PL7-2"))
    }

    #[test]
    fn every_controller_is_exactly_one_release_in_each_version() {
        for controller in CONTROLLERS {
            for (major, minor) in [(0, 0), (2, 9), (3, 0), (3, 1), (4, 0), (9, 0)] {
                let version = Some(Version::new(major, minor));
                let found = Model { controller: Some(controller), version }.releases().count();
                assert_eq!(found, 1, "{} V{major}.{minor}", controller.name);
            }
            assert!(controller.releases.iter().all(|it| it.series == controller.series), "{}", controller.name);
        }
        assert_eq!(Model::default().releases().count(), 7);
        assert_eq!(Model { controller: None, version: Some(Version::new(4, 0)) }.releases().count(), 7);
    }

    /// The table of PL72:571-585, row by row.
    #[test]
    fn features() {
        let columns = [
            ("TSX 27", "V2"),
            ("TSX 27", "V3"),
            ("TSX 47-10", "V2"),
            ("TSX 47-J", "V3"),
            ("TSX 47-20", "V3"),
            ("TSX 47-20", "V4"),
            ("TSX 17-20", "V3"),
        ];
        let table = [
            (Feature::PeriodicFastTask, ".*.***."),
            (Feature::EventFastTask, "......*"),
            (Feature::WordBits, ".*.****"),
            (Feature::WordTables, ".*.****"),
            (Feature::AsciiConversion, ".*.****"),
            (Feature::SimpleText, "*.*...."),
            (Feature::CompleteText, ".*.****"),
            (Feature::Network, "..*****"),
            (Feature::UniTelway, ".....**"),
            (Feature::Couplers, "....***"),
        ];
        assert_eq!(table.map(|it| it.0), Feature::ALL);
        for (feature, row) in table {
            let found: String = columns
                .iter()
                .map(|&(name, version)| if model(name, Some(version)).has(feature) { '*' } else { '.' })
                .collect();
            assert_eq!(found, row, "{feature:?}");
        }
        let words = columns.map(|(name, version)| model(name, Some(version)).count(Kind::Word));
        assert_eq!(words.map(|it| it.value), [128, 128, 128, 1024, 1024, 1024, 1024]);
        assert!(words.iter().all(|it| it.source == "PL72:577"));
        let constants = columns.map(|(name, version)| model(name, Some(version)).count(Kind::Constant).value);
        assert_eq!(constants, [128, 1024, 128, 1024, 1024, 1024, 1024]);
    }

    #[test]
    fn an_unknown_version_has_what_any_has() {
        let any = model("TSX 27", None);
        assert!(any.has(Feature::SimpleText) && any.has(Feature::CompleteText) && !any.has(Feature::Couplers));
        assert_eq!((any.count(Kind::Word).value, any.count(Kind::Constant).value), (128, 1024));
        let unknown = Model::default();
        assert_eq!((unknown.count(Kind::Word).value, unknown.count(Kind::Input).value), (1024, 256));
        assert!(Feature::ALL.into_iter().all(|it| unknown.has(it)));
    }

    #[test]
    fn counts_of_objects_and_blocks() {
        let models = ["TSX 17-20", "TSX 27", "TSX 47-20"].map(|it| model(it, Some("V3")));
        let counts = |kind| models.map(|it| it.count(kind).value);
        assert_eq!(counts(Kind::Input), [96, 48, 256]);
        assert_eq!(counts(Kind::Output), [64, 32, 256]);
        assert_eq!(counts(Kind::EventInput), [2, 0, 0]);
        assert_eq!(counts(Kind::SystemWord), [64, 0, 4]);
        assert_eq!(counts(Kind::CommonWord), [64, 0, 64]);
        assert_eq!(counts(Kind::ModuleFault), [32, 0, 0]);
        assert_eq!(counts(Kind::OutputFault), [0, 4, 16]);
        assert_eq!(counts(Kind::OutputWord), [32, 0, 32]);
        assert_eq!(counts(Kind::SystemWordBit), [1024, 0, 64]);
        let blocks = |symbol| models.map(|it| it.block_count(symbol).map(|it| it.value));
        assert_eq!(blocks("T"), [Some(32), Some(16), Some(16)]);
        assert_eq!(blocks("C"), [Some(31), Some(16), Some(16)]);
        assert_eq!(blocks("M"), [Some(8); 3]);
        assert_eq!(blocks("R"), [Some(4); 3]);
        assert_eq!(blocks("D"), [Some(8); 3]);
        assert_eq!(blocks("FC"), [Some(1), Some(0), Some(0)]);
        assert_eq!(blocks("TXT"), [Some(8); 3]);
        assert_eq!(blocks("TM"), [None; 3]);
        let mut kinds: Vec<_> = OBJECT_COUNTS.iter().map(|it| it.kind).collect();
        let rows = kinds.len();
        kinds.sort_unstable();
        kinds.dedup();
        assert_eq!(kinds.len(), rows);
    }

    #[test]
    fn channels() {
        let channels = |name| model(name, None).controller.unwrap_or_else(|| panic!("{name}")).channels;
        let small = channels("TSX 27");
        let modules = |it: &Modules| (0..9).filter(|&module| it.contains(module)).collect::<Vec<_>>();
        assert_eq!(modules(&small.input_modules), [1, 3, 5, 7]);
        assert_eq!(modules(&small.output_modules), [0, 2, 4, 6]);
        // As many as the table of objects counts.
        assert_eq!((4 * (small.inputs.last + 1), 4 * (small.outputs.last + 1)), (48, 32));
        let large = channels("TSX 47-20");
        assert_eq!(large.racks.map(|it| it.last), Some(1));
        assert_eq!(2 * 8 * (large.inputs.last + 1), 256);
        let compact = channels("TSX 47-J");
        assert_eq!((compact.racks.map(|it| it.last), compact.input_modules.range.last), (Some(0), 4));
        assert_eq!((compact.words, channels("TSX 47-10").words), (None, None));
        assert_eq!(large.word_modules.map(|it| (it.first, it.last)), Some((0, 3)));
        let micro = channels("TSX 17-20");
        assert_eq!(4 * (micro.inputs.last + 1), 96);
        assert_eq!(micro.word_modules.map(|it| (it.first, it.last)), Some((1, 3)));
        assert_eq!(micro.misfit(false, None, 0, 25), None);
        assert!(matches!(micro.misfit(false, None, 1, 25), Some(Misfit::Channel(it)) if it.last == 23));
        assert!(matches!(micro.misfit(true, None, 4, 0), Some(Misfit::Module(it)) if it.range.last == 3));
        assert_eq!(micro.misfit(true, Some(0), 1, 0), Some(Misfit::NoRacks));
        assert_eq!((small.misfit(true, None, 2, 7), small.misfit(false, None, 1, 0xB)), (None, None));
        assert!(matches!(small.misfit(false, None, 2, 0), Some(Misfit::Module(_))));
        assert!(matches!(small.misfit(true, None, 2, 8), Some(Misfit::Channel(it)) if it.source == "PL72:176"));
        assert_eq!((large.misfit(true, Some(1), 7, 15), large.misfit(false, None, 7, 15)), (None, None));
        assert!(matches!(compact.misfit(true, Some(1), 0, 0), Some(Misfit::Rack(it)) if it.source == "PL72:206"));
    }

    #[test]
    fn system_objects_of_controllers() {
        let bit = |name, version, number| model(name, version).has_system_bit(number);
        assert_eq!(bit("TSX 17-20", None, 13), Some(true));
        assert_eq!(bit("TSX 27", None, 13), Some(false));
        assert_eq!((bit("TSX 27", Some("V2"), 19), bit("TSX 27", Some("V3"), 19)), (Some(false), Some(true)));
        assert_eq!((bit("TSX 47-20", Some("V3"), 20), bit("TSX 47-20", Some("V3.1"), 20)), (Some(false), Some(true)));
        assert_eq!((bit("TSX 27", None, 11), bit("TSX 47-10", None, 11)), (Some(false), Some(true)));
        assert_eq!((bit("TSX 17-20", None, 2), bit("TSX 17-20", None, 4)), (None, None));
        // SY03 means different things, so every controller has it but the old ones.
        assert_eq!((bit("TSX 17-20", None, 3), bit("TSX 27", Some("V2"), 3)), (Some(true), Some(false)));
    }

    #[test]
    fn fast_tasks() {
        assert_eq!(
            FAST_TASKS.iter().map(|it| (it.period_ms.value, it.networks.value)).collect::<Vec<_>>(),
            [(5, 10), (10, 20)]
        );
        assert!(FAST_TASKS.iter().all(|it| it.duration_us.value * 5 == it.period_ms.value * 1_000));
    }
}

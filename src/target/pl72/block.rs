//! Function blocks: shapes, pins, counts and parameters.

use super::Series;
use crate::target::{Limit, Range};

/// A pin of a block in a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pin {
    pub name: &'static str,
    /// The block acts on the rising edge, not on the state.
    pub edge: bool,
}

const fn pin(name: &'static str) -> Pin {
    Pin { name, edge: false }
}

const fn edge(name: &'static str) -> Pin {
    Pin { name, edge: true }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BlockKind {
    Monostable,
    Timer,
    Counter,
    FastCounter,
    Register,
    Drum,
    SimpleText,
    CompleteText,
    /// `Week`, `Year`: the block has no number and no objects.
    Clock,
}

/// What a kind of block is.
#[derive(Debug, PartialEq, Eq)]
pub struct Block {
    pub kind: BlockKind,
    /// Letters of its objects: `T`, `FC`, `TXT`.
    pub symbol: Option<&'static str>,
    /// How many there are, by series: TSX 17-20, TSX 27, TSX 47. `None` where any number may be programmed.
    pub counts: Option<[u32; 3]>,
    pub count_source: &'static str,
    /// Columns and lines of a network that it takes. `None`: the document does not tell.
    pub columns: Option<Limit>,
    pub lines: Option<Limit>,
    /// From top to bottom. Outputs carry the names of the bits `Ti,D`.
    pub inputs: &'static [Pin],
    pub outputs: &'static [&'static str],
    pub source: &'static str,
}

impl Block {
    /// How many a series has; `None` where any number may be programmed.
    pub fn count(&self, series: Series) -> Option<Limit> {
        self.counts.map(|it| Limit::new(it[series.index()], self.count_source))
    }
}

const fn columns(source: &'static str) -> Option<Limit> {
    Some(Limit::new(2, source))
}

const fn lines(value: u32, source: &'static str) -> Option<Limit> {
    Some(Limit::new(value, source))
}

/// The document lacks the page of the monostable: its pins here are its one input and the bit of PL72:265.
pub static BLOCKS: &[Block] = &[
    Block {
        kind: BlockKind::Monostable,
        symbol: Some("M"),
        counts: Some([8, 8, 8]),
        count_source: "PL72:441",
        columns: None,
        lines: None,
        inputs: &[edge("S")],
        outputs: &["R"],
        source: "PL72:265, the vendor's general documentation for the input",
    },
    Block {
        kind: BlockKind::Timer,
        symbol: Some("T"),
        counts: Some([32, 16, 16]),
        count_source: "PL72:651-653",
        columns: columns("PL72:662"),
        lines: lines(3, "PL72:662"),
        inputs: &[pin("E"), pin("C")],
        outputs: &["D", "R"],
        source: "PL72:658-660",
    },
    Block {
        kind: BlockKind::Counter,
        symbol: Some("C"),
        counts: Some([31, 16, 16]),
        count_source: "PL72:730-732",
        columns: columns("PL72:743"),
        lines: lines(4, "PL72:743"),
        inputs: &[pin("R"), pin("P"), edge("U"), edge("D")],
        outputs: &["E", "D", "F"],
        source: "PL72:737-741",
    },
    Block {
        kind: BlockKind::FastCounter,
        symbol: Some("FC"),
        counts: Some([1, 0, 0]),
        count_source: "PL72:446",
        columns: columns("PL72:791"),
        lines: lines(4, "PL72:791"),
        inputs: &[pin("R"), pin("P"), pin("V"), pin("C")],
        outputs: &["E", "D", "F"],
        source: "PL72:790-794",
    },
    Block {
        kind: BlockKind::Register,
        symbol: Some("R"),
        counts: Some([4, 4, 4]),
        count_source: "PL72:697-699",
        columns: columns("PL72:705"),
        lines: lines(3, "PL72:705"),
        inputs: &[pin("R"), edge("I"), edge("O")],
        outputs: &["F", "E"],
        source: "PL72:704-707",
    },
    Block {
        kind: BlockKind::Drum,
        symbol: Some("D"),
        counts: Some([8, 8, 8]),
        count_source: "PL72:878-879",
        columns: columns("PL72:887"),
        lines: lines(3, "PL72:887"),
        inputs: &[pin("R"), edge("U")],
        outputs: &["F"],
        source: "PL72:881-885",
    },
    Block {
        kind: BlockKind::SimpleText,
        symbol: Some("TXT"),
        counts: Some([0, 8, 8]),
        count_source: "PL72:464",
        columns: columns("PL72:1129"),
        lines: lines(3, "PL72:1129"),
        inputs: &[pin("R"), edge("S")],
        outputs: &["D", "E"],
        source: "PL72:1125-1127",
    },
    Block {
        kind: BlockKind::CompleteText,
        symbol: Some("TXT"),
        counts: Some([8, 8, 8]),
        count_source: "PL72:465",
        columns: columns("PL72:1173"),
        lines: lines(4, "PL72:1173"),
        inputs: &[pin("R"), edge("S"), pin("O"), pin("I")],
        outputs: &["D", "E"],
        source: "PL72:1167-1171",
    },
    Block {
        kind: BlockKind::Clock,
        symbol: None,
        counts: None,
        count_source: "PL72:1264",
        columns: columns("PL72:1267"),
        lines: lines(3, "PL72:1267"),
        inputs: &[pin("E")],
        outputs: &["<", "=", ">"],
        source: "PL72:1266-1267",
    },
];

/// The words for blocks without a number (PL72:490-494).
pub const CLOCKS: [&str; 2] = ["WEEK", "YEAR"];

/// The kind of block that an address or word names: `T0`, `FC`, `WEEK`. Of the two text blocks the complete one, whose pins
/// start with those of the other.
pub fn of_address(address: &str) -> Option<&'static Block> {
    if CLOCKS.iter().any(|it| it.eq_ignore_ascii_case(address)) {
        return BLOCKS.iter().find(|it| it.kind == BlockKind::Clock);
    }
    let letters = address.trim_start_matches('%').trim_end_matches(|it: char| it.is_ascii_digit());
    let is_meant = |it: &&Block| it.symbol.is_some_and(|it| it.eq_ignore_ascii_case(letters));
    BLOCKS.iter().filter(is_meant).find(|it| it.kind != BlockKind::SimpleText)
}

/// Presets of timers, counters and the fast counter (also PL72:748, PL72:799).
pub const PRESETS: Range = Range::new(0, 9999, "PL72:668");
/// Current values of counters and of the fast counter (also PL72:800).
pub const COUNTER_VALUES: Range = Range::new(0, 9999, "PL72:749");
/// Time bases of timers and drums, in milliseconds, the default first (PL72:667, PL72:897).
pub const TIME_BASES_MS: [u32; 4] = [60_000, 1_000, 100, 10];
/// What the fast counter measures as a timer, in microseconds.
pub const FAST_TIMER_MIN_US: Limit = Limit::new(555, "PL72:446");
pub const FAST_TIMER_MAX_US: Limit = Limit::new(5_550_000, "PL72:446");
/// Words of a register; the default is the most.
pub const REGISTER_LENGTH: Range = Range::new(1, 16, "PL72:713");
/// Steps of a drum; the default is the most.
pub const DRUM_STEPS: Range = Range::new(1, 16, "PL72:892");
/// `Di,S`.
pub const DRUM_STEP: Range = Range::new(0, 15, "PL72:893");
/// Bits `Bi` or `Oxy,i` that a drum drives.
pub const DRUM_ORDER_BITS: Limit = Limit::new(16, "PL72:895");
/// `Di,V`, in units of the time base.
pub const DRUM_TIME: Range = Range::new(0, 9999, "PL72:896");
/// Days of a week block, Monday first.
pub const CLOCK_DAYS: Range = Range::new(1, 7, "PL72:1272");
/// `SW58`, minutes of the current day, and `SW59`, its number in the year, both as decimal values.
pub const MINUTES: Range = Range::new(0, 1439, "PL72:1327");
pub const DAYS: Range = Range::new(1, 366, "PL72:1328");
/// Causes of the last stop in `SW57` (PL72:1313-1314).
pub const STOP_CODES: [(u32, &str); 2] = [(1, "controller stopped"), (4, "power failure")];
/// Words of `DT` and `DTP`, date and time as characters.
pub const CLOCK_WORDS: Limit = Limit::new(11, "PL72:1307-1308");

/// An exchange of the simple text block (PL72:1137-1142).
#[derive(Debug, PartialEq, Eq)]
pub struct SimpleText {
    pub name: &'static str,
    /// The program sends. Then the table may lie in `CWi` too.
    pub sends: bool,
    /// The words hold numbers that the device shows as characters.
    pub converts: bool,
    /// `TXTi,L`, in bytes.
    pub length: Range,
}

pub const TEXT_LENGTH_SIMPLE: Range = Range::new(1, 30, "PL72:1139-1140");
pub const TEXT_NUMBER_BYTES: Range = Range::new(1, 6, "PL72:1141-1142");

pub static SIMPLE_TEXTS: &[SimpleText] = &[
    SimpleText { name: "READ", sends: false, converts: false, length: TEXT_LENGTH_SIMPLE },
    SimpleText { name: "WRITE", sends: true, converts: false, length: TEXT_LENGTH_SIMPLE },
    SimpleText { name: "READ/NUM", sends: false, converts: true, length: TEXT_NUMBER_BYTES },
    SimpleText { name: "WRITE/NUM", sends: true, converts: true, length: TEXT_NUMBER_BYTES },
];

/// Length of the tables of a complete text block, in bytes: reception `[n]` and emission `TXTi,L`.
pub const TEXT_BYTES: Range = Range::new(0, 30, "PL72:1187-1188");
/// First word of such a table.
pub const TEXT_TABLE_START: Range = Range::new(0, 126, "PL72:1186");
/// `TXTi,T`, and where the partner is programmed with PL7-2 too.
pub const TEXT_PARTNERS: Range = Range::new(0, 63, "PL72:1202");
pub const TEXT_PARTNERS_PL7_2: Range = Range::new(0, 7, "PL72:1207");
/// `TXTi,A`.
pub const TEXT_STATIONS: Range = Range::new(0, 0xF, "PL72:1203");

/// `TXTi,M` of a TSX 47-20, `H'0x..'`: position of the coupler and its logical address.
pub const COUPLER_POSITIONS: Range = Range::new(0, 3, "PL72:1216");
pub const COUPLER_ADDRESSES: Range = Range::new(0, 0x7F, "PL72:1216");
/// `TXTi,M` of a TSX 17-20, `H'00yy'`: 0 is the master.
pub const UNI_TELWAY_ADDRESSES: Range = Range::new(0, 0xFD, "PL72:1225");
/// High byte of `TXTi,C` of a TSX 17-20, `H'07xx'`.
pub const UNI_TELWAY_REQUEST: Limit = Limit::new(0x07, "PL72:1226");

/// A type of the complete text block (PL72:1156-1161).
#[derive(Debug, PartialEq, Eq)]
pub struct TextKind {
    pub name: &'static str,
    /// Controllers that have it.
    pub controllers: &'static [&'static str],
    /// Objects that it has beside `TXTi,L` and `TXTi,S`.
    pub items: &'static [&'static str],
    pub source: &'static str,
}

pub static TEXT_KINDS: &[TextKind] = &[
    TextKind {
        name: "TER",
        controllers: &["TSX 17-20", "TSX 27", "TSX 47-J", "TSX 47-10", "TSX 47-20"],
        items: &[],
        source: "PL72:1158",
    },
    TextKind {
        name: "TXT",
        controllers: &["TSX 17-20", "TSX 47-J", "TSX 47-10", "TSX 47-20"],
        items: &["T", "A"],
        source: "PL72:1159",
    },
    TextKind {
        name: "CPL",
        controllers: &["TSX 17-20", "TSX 47-20"],
        items: &["M", "C", "R"],
        source: "PL72:1160-1161",
    },
];

/// What `TXTi,S` says when `TXTi,E` is 1 (PL72:1148, PL72:1189).
#[derive(Debug, PartialEq, Eq)]
pub struct TextError {
    pub code: u32,
    pub meaning: &'static str,
    /// Known of these controllers alone.
    pub only: &'static [&'static str],
}

pub static TEXT_ERRORS: &[TextError] = &[
    TextError { code: 1, meaning: "exchange cancelled by RESET", only: &[] },
    TextError { code: 2, meaning: "wrong length of a table", only: &[] },
    TextError { code: 3, meaning: "message refused", only: &["TSX 17-20", "TSX 47-10", "TSX 47-20"] },
    TextError { code: 7, meaning: "wrong conversion", only: &[] },
    TextError { code: 11, meaning: "type of text block that is not managed", only: &["TSX 17-20"] },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::pl72::{CONTROLLERS, LADDER_CONTACTS, LADDER_LINES};

    /// The list of PL72:437-446 and the pages of the blocks say the same.
    #[test]
    fn counts_agree_with_the_list() {
        let list = [("M", [8, 8]), ("T", [32, 16]), ("C", [31, 16]), ("R", [4, 4]), ("D", [8, 8]), ("FC", [1, 0])];
        for (symbol, [micro, others]) in list {
            let block = BLOCKS.iter().find(|it| it.symbol == Some(symbol)).unwrap_or_else(|| panic!("{symbol}"));
            let counts = Series::ALL.map(|it| block.count(it).map(|it| it.value));
            assert_eq!(counts, [Some(micro), Some(others), Some(others)], "{symbol}");
        }
    }

    #[test]
    fn blocks_are_found_by_their_address() {
        let kind = |address| of_address(address).map(|it| it.kind);
        assert_eq!(kind("T0"), Some(BlockKind::Timer));
        assert_eq!(kind("%c30"), Some(BlockKind::Counter));
        assert_eq!(kind("FC"), Some(BlockKind::FastCounter));
        assert_eq!(kind("TXT7"), Some(BlockKind::CompleteText));
        assert_eq!(kind("week"), Some(BlockKind::Clock));
        assert_eq!((kind("W0"), kind(""), kind("T0,D"), kind("WEEK1")), (None, None, None, None));
    }

    #[test]
    fn blocks_fit_a_network() {
        for block in BLOCKS {
            assert!(block.columns.is_none_or(|it| it.value < LADDER_CONTACTS.value));
            let pins = u32::try_from(block.inputs.len().max(block.outputs.len())).unwrap_or(u32::MAX);
            let lines = block.lines.map_or(LADDER_LINES.value, |it| it.value);
            assert!(pins <= lines && lines <= LADDER_LINES.value, "{:?}", block.kind);
        }
    }

    #[test]
    fn controllers_of_text_blocks_are_known() {
        let names = TEXT_KINDS.iter().flat_map(|it| it.controllers).chain(TEXT_ERRORS.iter().flat_map(|it| it.only));
        for name in names {
            assert!(CONTROLLERS.iter().any(|it| it.name == *name), "{name}");
        }
    }
}

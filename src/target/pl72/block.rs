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
/// `Di,S`.
pub const DRUM_STEP: Range = Range::new(0, 15, "PL72:893");
/// Words of `DT` and `DTP`, date and time as characters.
pub const CLOCK_WORDS: Limit = Limit::new(11, "PL72:1307-1308");

/// Length of the tables of a complete text block, in bytes: reception `[n]` and emission `TXTi,L`.
pub const TEXT_BYTES: Range = Range::new(0, 30, "PL72:1187-1188");
/// `TXTi,T`, and where the partner is programmed with PL7-2 too.
pub const TEXT_PARTNERS: Range = Range::new(0, 63, "PL72:1202");
/// `TXTi,A`.
pub const TEXT_STATIONS: Range = Range::new(0, 0xF, "PL72:1203");

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
        let names = TEXT_KINDS.iter().flat_map(|it| it.controllers);
        for name in names {
            assert!(CONTROLLERS.iter().any(|it| it.name == *name), "{name}");
        }
    }
}

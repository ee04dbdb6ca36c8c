//! Execution times and memory (PL72:1894-1976).

use super::Series;
use crate::target::Range;

/// A time in nanoseconds: from `min` to `max`, and `each` for every unit of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cost {
    pub min_ns: u32,
    pub max_ns: u32,
    pub each_ns: u32,
}

impl Cost {
    const fn us(microseconds: u32) -> Self {
        Self::ns(microseconds * 1_000)
    }

    const fn ns(nanoseconds: u32) -> Self {
        Self { min_ns: nanoseconds, max_ns: nanoseconds, each_ns: 0 }
    }

    const fn between(min_us: u32, max_us: u32) -> Self {
        Self { min_ns: min_us * 1_000, max_ns: max_us * 1_000, each_ns: 0 }
    }

    const fn with_each(base_us: u32, each_us: u32) -> Self {
        Self { each_ns: each_us * 1_000, ..Self::us(base_us) }
    }

    pub fn range(self, quantity: u32) -> TimeRange {
        let each = u64::from(self.each_ns) * u64::from(quantity);
        TimeRange { min_ns: u64::from(self.min_ns) + each, max_ns: u64::from(self.max_ns) + each }
    }
}

/// A time in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TimeRange {
    pub min_ns: u64,
    pub max_ns: u64,
}

/// An element of a network, as the table tells them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Element {
    /// Contact on an input or output of a TSX 27 or 47, by rack.
    ContactRack0,
    ContactRack1,
    /// Contact on an input or output of a TSX 17-20.
    ContactInput17,
    ContactOutput17,
    /// Contact on B0 to B127, a step, a bit of a block other than a text block, a system bit.
    ContactBit,
    /// Contact on B128 to B255, a fault bit, a bit of a text block, a bit of a word.
    ContactFarBit,
    Timer,
    Monostable,
    Counter,
    FastCounter,
    Register,
    Drum,
    Clock,
    SimpleText,
    CompleteText,
    Comparison,
    VerticalLink,
    /// Coil on an output of a TSX 27 or 47, by rack.
    CoilRack0,
    CoilRack1,
    /// Coil on an output of a TSX 17-20.
    CoilOutput17,
    /// Coil on B0 to B127.
    CoilBit,
    /// Coil on B128 to B255.
    CoilFarBit,
    /// Coil on a step or a system bit.
    CoilStepOrSystem,
    CoilWordBit,
    /// What an inverse, set or reset coil takes beside the coil.
    CoilSupplement,
    Jump,
    /// `+`, `-`, `AND`, `OR`, `XOR`.
    AddOrLogic,
    Multiply,
    /// `/`; the table has no row for `REM`.
    Divide,
    Complement,
    BcdToBinary,
    BinaryToBcd,
    /// Quantity: digits.
    AsciiConversion,
    /// Quantity: bits to rotate.
    Rotate,
    WordToWord,
    ValueToWord,
    WordToIndexed,
    /// A string of 16 bits to a word.
    BitsToWord,
    /// Quantity: bits.
    BitsToBits,
    /// Quantity: words.
    WordsToWords,
    /// What each network takes beside its elements.
    Network,
}

impl Element {
    /// The row of the element. The rows stand in the order of the elements.
    pub fn row(self) -> Option<&'static InstructionCost> {
        COSTS.get(self as usize)
    }
}

/// A row of the two tables of elements.
#[derive(Debug, PartialEq, Eq)]
pub struct InstructionCost {
    pub element: Element,
    /// `None` where the controllers do not have it.
    pub tsx_17: Option<Cost>,
    /// TSX 27 and TSX 47.
    pub tsx_27_47: Option<Cost>,
    /// In the memory of the program.
    pub bytes: u32,
    /// Its time when the block does something.
    pub triggered: Option<Triggered>,
    pub source: &'static str,
}

impl InstructionCost {
    pub fn time(&self, series: Series) -> Option<Cost> {
        match series {
            Series::Tsx17 => self.tsx_17,
            Series::Tsx27 | Series::Tsx47 => self.tsx_27_47,
        }
    }

    /// Longest time in nanoseconds; `quantity` is what the time of the element grows with, of blocks that do something too.
    /// `None` where the controllers do not have it.
    pub fn longest_ns(&self, series: Series, quantity: u32) -> Option<u64> {
        let time = self.time(series)?.range(quantity).max_ns;
        Some(self.triggered.map_or(time, |it| it.cost.range(quantity).max_ns.max(time)))
    }
}

/// What a block takes when it has something to do: `base` and `each` for a quantity (PL72:1937). Whether instead of its usual
/// time or beside it, the document does not say: instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triggered {
    pub cost: Cost,
    /// Of what `each` is the time, and when.
    pub each: &'static str,
    pub when: &'static str,
}

const fn triggered(base_us: u32, each_us: u32, each: &'static str, when: &'static str) -> Triggered {
    Triggered { cost: Cost::with_each(base_us, each_us), each, when }
}

const ORDER_BITS: Triggered = triggered(400, 40, "order bit", "the drum changes its step");
const SIMPLE_TEXT: Triggered = triggered(220, 8, "active text block", "the block is active");
const COMPLETE_TEXT: Triggered = triggered(270, 8, "active text block", "the block is active");

/// Internal bits that are reached faster than the others (also PL72:1950).
pub const NEAR_BITS: Range = Range::new(0, 127, "PL72:1923");

/// For the comments of networks: one byte a character (PL72:1972-1974).
pub const NETWORK_COMMENT_BYTES: u32 = 1;

const fn row(
    element: Element,
    tsx_17: Option<Cost>,
    tsx_27_47: Option<Cost>,
    bytes: u32,
    source: &'static str,
) -> InstructionCost {
    InstructionCost { element, tsx_17, tsx_27_47, bytes, triggered: None, source }
}

const fn us(microseconds: u32) -> Option<Cost> {
    Some(Cost::us(microseconds))
}

const fn between(min_us: u32, max_us: u32) -> Option<Cost> {
    Some(Cost::between(min_us, max_us))
}

const fn each(base_us: u32, each_us: u32) -> Option<Cost> {
    Some(Cost::with_each(base_us, each_us))
}

/// PL72:1919-1935 and PL72:1947-1972.
pub static COSTS: &[InstructionCost] = &[
    row(Element::ContactRack0, None, us(2), 2, "PL72:1919"),
    row(Element::ContactRack1, None, us(10), 12, "PL72:1920"),
    row(Element::ContactInput17, us(2), None, 2, "PL72:1921"),
    row(Element::ContactOutput17, us(4), None, 5, "PL72:1922"),
    row(Element::ContactBit, us(4), Some(Cost::ns(4_500)), 5, "PL72:1923"),
    row(Element::ContactFarBit, us(10), us(10), 12, "PL72:1924"),
    row(Element::Timer, between(44, 78), us(60), 10, "PL72:1925"),
    row(Element::Monostable, between(36, 68), us(55), 10, "PL72:1926"),
    row(Element::Counter, between(46, 93), us(75), 10, "PL72:1927"),
    row(Element::FastCounter, between(76, 132), None, 10, "PL72:1928"),
    row(Element::Register, between(72, 141), us(100), 16, "PL72:1929"),
    InstructionCost { triggered: Some(ORDER_BITS), ..row(Element::Drum, between(69, 116), us(75), 14, "PL72:1930") },
    row(Element::Clock, between(53, 247), None, 11, "PL72:1931"),
    // The two text blocks share one figure of bytes.
    InstructionCost { triggered: Some(SIMPLE_TEXT), ..row(Element::SimpleText, None, us(50), 7, "PL72:1932-1933") },
    InstructionCost { triggered: Some(COMPLETE_TEXT), ..row(Element::CompleteText, us(65), us(65), 7, "PL72:1933") },
    row(Element::Comparison, between(129, 143), us(150), 14, "PL72:1934"),
    row(Element::VerticalLink, us(10), us(10), 8, "PL72:1935"),
    row(Element::CoilRack0, None, us(10), 5, "PL72:1947"),
    row(Element::CoilRack1, None, us(20), 16, "PL72:1948"),
    row(Element::CoilOutput17, us(12), None, 9, "PL72:1949"),
    row(Element::CoilBit, us(12), us(12), 9, "PL72:1950"),
    row(Element::CoilFarBit, us(21), us(21), 16, "PL72:1951"),
    row(Element::CoilStepOrSystem, us(3), us(3), 6, "PL72:1952"),
    row(Element::CoilWordBit, us(12), us(12), 13, "PL72:1953"),
    row(Element::CoilSupplement, us(2), us(2), 2, "PL72:1954"),
    row(Element::Jump, us(24), us(24), 16, "PL72:1955"),
    row(Element::AddOrLogic, us(163), us(200), 19, "PL72:1956-1957"),
    row(Element::Multiply, between(207, 227), us(200), 19, "PL72:1956-1958"),
    row(Element::Divide, between(196, 733), us(200), 19, "PL72:1956-1959"),
    row(Element::Complement, us(170), us(170), 17, "PL72:1960"),
    row(Element::BcdToBinary, us(285), us(285), 17, "PL72:1961"),
    row(Element::BinaryToBcd, us(400), us(400), 17, "PL72:1962"),
    row(Element::AsciiConversion, each(175, 70), each(120, 70), 10, "PL72:1963"),
    row(Element::Rotate, each(175, 13), each(175, 13), 19, "PL72:1964"),
    row(Element::WordToWord, us(145), us(145), 14, "PL72:1966"),
    row(Element::ValueToWord, us(140), us(140), 14, "PL72:1967"),
    row(Element::WordToIndexed, us(195), us(195), 16, "PL72:1968"),
    row(Element::BitsToWord, us(500), us(500), 23, "PL72:1969"),
    row(Element::BitsToBits, each(150, 20), each(150, 20), 19, "PL72:1970"),
    row(Element::WordsToWords, each(150, 60), each(150, 60), 13, "PL72:1971"),
    row(Element::Network, us(16), us(16), 22, "PL72:1972"),
];

/// What the system does in each scan beside the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SystemTask {
    Terminal,
    Controller,
    /// A module of that many inputs and outputs.
    Module {
        inputs: u32,
        outputs: u32,
    },
    ReadInputs,
    WriteOutputs,
}

impl SystemTask {
    /// What it takes at least, in nanoseconds; `None` where the controllers do not do it.
    pub fn shortest_ns(self, series: Series) -> Option<u64> {
        let row = SYSTEM_COSTS.iter().find(|it| it.task == self)?;
        row.times[series.index()].map(|it| u64::from(it.min_ns))
    }

    /// The quickest exchange of a module with at least so many inputs and outputs.
    pub fn module_ns(series: Series, least_inputs: u32, least_outputs: u32) -> Option<u64> {
        let fits = |it: &&SystemCost| match it.task {
            Self::Module { inputs, outputs } => inputs >= least_inputs && outputs >= least_outputs,
            _ => false,
        };
        let times = SYSTEM_COSTS.iter().filter(fits).filter_map(|it| it.times[series.index()]);
        times.map(|it| u64::from(it.min_ns)).min()
    }
}

#[derive(Debug, PartialEq, Eq)]
pub struct SystemCost {
    pub task: SystemTask,
    /// By series: TSX 17-20, TSX 27, TSX 47. A range depends on the configuration.
    pub times: [Option<Cost>; 3],
    pub source: &'static str,
}

const fn system(task: SystemTask, times: [Option<Cost>; 3], source: &'static str) -> SystemCost {
    SystemCost { task, times, source }
}

const fn module(inputs: u32, outputs: u32) -> SystemTask {
    SystemTask::Module { inputs, outputs }
}

/// PL72:1900-1911.
pub static SYSTEM_COSTS: &[SystemCost] = &[
    system(SystemTask::Terminal, [us(100), us(100), us(100)], "PL72:1900"),
    system(SystemTask::Controller, [between(700, 830), us(2100), us(2100)], "PL72:1901"),
    system(module(4, 4), [None, None, us(340)], "PL72:1902"),
    system(module(8, 0), [None, None, us(260)], "PL72:1903"),
    system(module(12, 0), [None, us(400), None], "PL72:1904"),
    system(module(16, 0), [None, None, us(400)], "PL72:1905"),
    system(module(32, 0), [None, None, us(800)], "PL72:1906"),
    system(module(0, 8), [None, us(280), us(220)], "PL72:1907"),
    system(module(0, 16), [None, None, us(320)], "PL72:1908"),
    system(module(0, 32), [None, None, us(640)], "PL72:1909"),
    system(SystemTask::ReadInputs, [between(148, 490), None, None], "PL72:1910"),
    system(SystemTask::WriteOutputs, [between(64, 250), None, None], "PL72:1911"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::pl72::CONTROLLERS;

    fn time(name: &str, element: Element, quantity: u32) -> Option<(u64, u64)> {
        let controller = CONTROLLERS.iter().find(|it| it.name == name);
        assert!(controller.is_some(), "{name}");
        let row = COSTS.iter().find(|it| it.element == element)?;
        let range = row.time(controller?.series)?.range(quantity);
        Some((range.min_ns, range.max_ns))
    }

    #[test]
    fn times_by_controller_and_quantity() {
        assert_eq!(time("TSX 17-20", Element::Timer, 0), Some((44_000, 78_000)));
        assert_eq!(time("TSX 27", Element::Timer, 0), Some((60_000, 60_000)));
        assert_eq!(time("TSX 27", Element::ContactBit, 0), Some((4_500, 4_500)));
        assert_eq!(time("TSX 27", Element::FastCounter, 0), None);
        assert_eq!(time("TSX 17-20", Element::SimpleText, 0), None);
        assert_eq!(time("TSX 17-20", Element::AsciiConversion, 5), Some((525_000, 525_000)));
        assert_eq!(time("TSX 47-20", Element::AsciiConversion, 5), Some((470_000, 470_000)));
        assert_eq!(time("TSX 47-10", Element::WordsToWords, 60), Some((3_750_000, 3_750_000)));
        assert_eq!(time("TSX 17-20", Element::Divide, 0), Some((196_000, 733_000)));
        // No quantity is too large.
        assert!(time("TSX 47-10", Element::WordsToWords, u32::MAX).is_some());
    }

    #[test]
    fn the_system_at_its_shortest() {
        let module = |inputs, outputs| SystemTask::module_ns(Series::Tsx47, inputs, outputs);
        assert_eq!(
            (module(8, 0), module(9, 0), module(0, 16), module(3, 2)),
            (Some(260_000), Some(400_000), Some(320_000), Some(340_000))
        );
        assert_eq!((module(33, 0), SystemTask::module_ns(Series::Tsx27, 12, 0)), (None, Some(400_000)));
        assert_eq!(SystemTask::Controller.shortest_ns(Series::Tsx17), Some(700_000));
        assert_eq!(SystemTask::ReadInputs.shortest_ns(Series::Tsx27), None);
    }

    #[test]
    fn each_element_has_one_row_in_order() {
        assert!(COSTS.iter().all(|it| it.element.row() == Some(it)));
        assert!(COSTS.is_sorted_by(|a, b| a.element < b.element));
        assert_eq!(COSTS.len(), Element::Network as usize + 1);
        assert!(COSTS.iter().all(|it| it.bytes > 0 && (it.tsx_17.is_some() || it.tsx_27_47.is_some())));
    }

    /// A drum of ten order bits that changes its step: 400 + 40 x 10 microseconds.
    #[test]
    fn blocks_that_do_something_take_longer() {
        let triggered = |element| COSTS.iter().find(|it| it.element == element).and_then(|it| it.triggered);
        let max = |element, quantity| triggered(element).map(|it| it.cost.range(quantity).max_ns);
        assert_eq!(max(Element::Drum, 10), Some(800_000));
        assert_eq!(max(Element::CompleteText, 3), Some(294_000));
        assert_eq!(max(Element::SimpleText, 0), Some(220_000));
        assert_eq!(max(Element::Timer, 0), None);
    }
}

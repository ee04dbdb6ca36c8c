//! What a program numbers, and how many of it there are.

/// A kind of object that programs number from 0. Which kinds there are, and what they are called, is the family's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Counted {
    /// Internal bits: `%M`.
    Bits,
    /// Internal words: `%MW`.
    Words,
    /// Bytes of memory: `MB`.
    Bytes,
    /// Constant words: `%KW`.
    Constants,
    SystemBits,
    /// Steps of the main chart: `%X`.
    Steps,
    MacroSteps,
    /// `%TM`, `T`.
    Timers,
    /// Timers of series 7, which PL7 keeps beside its own: `%T`.
    OldTimers,
    Counters,
    Monostables,
    Registers,
    Drums,
    /// `FC` of PL7-2.
    FastCounters,
    /// `TXT` of PL7-2.
    Texts,
    /// `SW` of PL7-2, of which some controllers have none.
    SystemWords,
}

impl Counted {
    pub const ALL: [Self; 16] = [
        Self::Bits,
        Self::Words,
        Self::Bytes,
        Self::Constants,
        Self::SystemBits,
        Self::Steps,
        Self::MacroSteps,
        Self::Timers,
        Self::OldTimers,
        Self::Counters,
        Self::Monostables,
        Self::Registers,
        Self::Drums,
        Self::FastCounters,
        Self::Texts,
        Self::SystemWords,
    ];

    /// Whether it is a timer, a counter or another function block, and not memory.
    pub const fn is_block(self) -> bool {
        matches!(
            self,
            Self::Timers
                | Self::OldTimers
                | Self::Counters
                | Self::Monostables
                | Self::Registers
                | Self::Drums
                | Self::FastCounters
                | Self::Texts
        )
    }
}

/// How a family calls what it counts.
#[derive(Debug, PartialEq, Eq)]
pub struct Numbered {
    pub what: Counted,
    /// Key in `[objects]` of a configuration; empty when the number is the same everywhere.
    pub key: &'static str,
    /// What stands before the number in an address.
    pub prefix: &'static str,
    pub plural: &'static str,
}

/// Who says how many there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CountedBy {
    /// The configuration of the application.
    Configuration,
    /// The controller of that name, which has no more.
    Controller(&'static str),
    /// No controller of the family has more.
    Family,
}

/// How many objects of a kind a program may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    pub value: u32,
    pub by: CountedBy,
    /// The place that gives it; for a configuration, the key.
    pub source: &'static str,
}

/// Configured counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Counts([Option<u32>; Counted::ALL.len()]);

impl Counts {
    pub(super) fn new(of: impl Fn(Counted) -> Option<u32>) -> Self {
        Self(Counted::ALL.map(of))
    }

    pub(super) fn get(&self, what: Counted) -> Option<u32> {
        let (_, value) = Counted::ALL.iter().zip(self.0).find(|it| *it.0 == what)?;
        value
    }
}

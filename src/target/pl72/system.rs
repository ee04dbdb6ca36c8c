//! System bits and words (PL72:320-399, PL72:1296-1328).

use super::Version;

/// Who writes an object (PL72:349-362, PL72:393-399).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Manager {
    /// The system alone.
    System,
    /// The user alone.
    User,
    /// Set by the system, reset by the user.
    SystemThenUser,
    /// Set by the user, reset by the system.
    UserThenSystem,
    /// By the system, or by the user and then reset by the system.
    SystemOrUser,
}

/// Whether a program may write an object, and the place that says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Writer {
    Program,
    NotProgram(&'static str),
}

/// A system bit or word.
#[derive(Debug, PartialEq, Eq)]
pub struct SystemObject {
    pub number: u32,
    /// What it is for. For a bit: what state 1 means, unless it says otherwise.
    pub function: &'static str,
    /// State of a bit at a cold start.
    pub initial: Option<bool>,
    pub manager: Manager,
    pub writer: Writer,
    /// First version that has it, by series: TSX 17-20, TSX 27, TSX 47.
    pub since: [Option<Version>; 3],
    pub source: &'static str,
}

const ALWAYS: Option<Version> = Some(Version::new(0, 0));
const V3: Option<Version> = Some(Version::new(3, 0));
const V3_1: Option<Version> = Some(Version::new(3, 1));

const ALL: [Option<Version>; 3] = [ALWAYS; 3];
const TSX_17: [Option<Version>; 3] = [ALWAYS, None, None];
const NOT_27: [Option<Version>; 3] = [ALWAYS, None, ALWAYS];

const fn object(
    number: u32,
    initial: Option<bool>,
    manager: Manager,
    since: [Option<Version>; 3],
    source: &'static str,
    function: &'static str,
) -> SystemObject {
    let writer = match manager {
        Manager::System => Writer::NotProgram(source),
        _ => Writer::Program,
    };
    SystemObject { number, function, initial, manager, writer, since, source }
}

const ZERO: Option<bool> = Some(false);
const ONE: Option<bool> = Some(true);

/// The rows of PL72:322-347. SY02 and SY04 are in none. SY03 has two: what it does depends on the series.
pub static SYSTEM_BITS: &[SystemObject] = &[
    object(0, ZERO, Manager::SystemOrUser, ALL, "PL72:324", "cold start: power returns, data are lost"),
    object(1, ZERO, Manager::SystemOrUser, ALL, "PL72:325", "warm start: power returns, data are kept"),
    object(3, ZERO, Manager::User, [None, V3, V3], "PL72:327", "period of the fast task: 0 is 10 ms, 1 is 5 ms"),
    object(3, ZERO, Manager::User, TSX_17, "PL72:328", "stops the clock"),
    object(5, None, Manager::System, ALL, "PL72:329", "time base of 100 ms"),
    object(6, None, Manager::System, ALL, "PL72:330", "time base of 1 s"),
    object(7, None, Manager::System, ALL, "PL72:331", "time base of 1 min"),
    object(8, ONE, Manager::User, ALL, "PL72:332", "state 0 keeps the outputs when the controller stops"),
    object(9, ZERO, Manager::User, ALL, "PL72:333", "resets the outputs while the controller runs"),
    object(10, ONE, Manager::System, ALL, "PL72:334", "state 0 is a fault of inputs or outputs"),
    object(11, ZERO, Manager::SystemThenUser, NOT_27, "PL72:335", "common words sent by the station are refreshed"),
    object(12, ZERO, Manager::System, NOT_27, "PL72:336", "network, coupler and station are in order"),
    object(13, None, Manager::System, TSX_17, "PL72:337", "the battery is missing or faulty"),
    object(14, ZERO, Manager::User, TSX_17, "PL72:338", "the front panel shows SW16"),
    object(15, ZERO, Manager::SystemThenUser, TSX_17, "PL72:339", "the fast counter has reached its preset"),
    object(16, ZERO, Manager::UserThenSystem, TSX_17, "PL72:340", "rearms tripped static outputs every 10 s"),
    object(17, ZERO, Manager::SystemThenUser, ALL, "PL72:341", "overflow of an unsigned calculation, or of a rotation"),
    object(18, ZERO, Manager::SystemThenUser, ALL, "PL72:342", "overflow of a calculation in 16 bits"),
    object(19, ONE, Manager::User, [ALWAYS, V3, V3], "PL72:343", "inhibits the fast task"),
    object(20, ZERO, Manager::SystemThenUser, [ALWAYS, V3_1, V3_1], "PL72:344", "overflow of an index"),
    object(21, ZERO, Manager::UserThenSystem, ALL, "PL72:345", "initialises the chart"),
    object(22, ZERO, Manager::UserThenSystem, ALL, "PL72:346", "resets the chart"),
    object(23, ZERO, Manager::UserThenSystem, ALL, "PL72:347", "validates a prepositioned chart; held, freezes it"),
];

const fn word(
    number: u32,
    manager: Manager,
    since: [Option<Version>; 3],
    source: &'static str,
    function: &'static str,
) -> SystemObject {
    object(number, None, manager, since, source, function)
}

/// The clock: PL72:382-385 says that the system writes it, PL72:1297-1300 gives the program access to write, which sets it.
const fn clock(number: u32, source: &'static str, function: &'static str) -> SystemObject {
    SystemObject { writer: Writer::Program, ..word(number, Manager::System, TSX_17, source, function) }
}

/// The rows of PL72:370-391. The TSX 27 has no system words (PL72:278). Words without a row are in none.
pub static SYSTEM_WORDS: &[SystemObject] = &[
    word(0, Manager::SystemThenUser, NOT_27, "PL72:372", "common words that were refreshed, one bit a station"),
    word(1, Manager::System, NOT_27, "PL72:373", "reserved"),
    word(2, Manager::System, NOT_27, "PL72:374-375", "network number in the high byte, station number in the low one"),
    word(3, Manager::System, NOT_27, "PL72:376", "couplers of stations 0 to 15 that work"),
    word(4, Manager::System, TSX_17, "PL72:376", "couplers of stations 16 to 31 that work"),
    word(5, Manager::System, TSX_17, "PL72:376", "couplers of stations 32 to 47 that work"),
    word(6, Manager::System, TSX_17, "PL72:376", "couplers of stations 48 to 63 that work"),
    word(16, Manager::User, TSX_17, "PL72:377", "word that the front panel can show"),
    word(17, Manager::System, TSX_17, "PL72:378", "checksum of the program in RAM"),
    word(18, Manager::System, TSX_17, "PL72:379", "checksum of the backup cartridge, 0 without one"),
    word(24, Manager::System, TSX_17, "PL72:380", "UNI-TELWAY address of the terminal port"),
    word(41, Manager::System, TSX_17, "PL72:381", "longest scan since the last cold start, in units of 10 ms"),
    clock(50, "PL72:382", "century and year, BCD"),
    clock(51, "PL72:383", "month and day, BCD"),
    clock(52, "PL72:384", "hour and minute, BCD"),
    clock(53, "PL72:385", "seconds, tenths of seconds, day of the week, BCD"),
    word(54, Manager::System, TSX_17, "PL72:386", "century and year of the last stop, BCD"),
    word(55, Manager::System, TSX_17, "PL72:387", "month and day of the last stop, BCD"),
    word(56, Manager::System, TSX_17, "PL72:388", "hour and minute of the last stop, BCD"),
    word(57, Manager::System, TSX_17, "PL72:389", "seconds, tenths of seconds and cause of the last stop, BCD"),
    word(58, Manager::System, TSX_17, "PL72:390", "minute of the current day, BCD"),
    word(59, Manager::System, TSX_17, "PL72:391", "number of the current day in its year, BCD"),
];

/// The first row about a system bit.
pub fn system_bit(number: u32) -> Option<&'static SystemObject> {
    SYSTEM_BITS.iter().find(|it| it.number == number)
}

/// The row about a system word.
pub fn system_word(number: u32) -> Option<&'static SystemObject> {
    SYSTEM_WORDS.iter().find(|it| it.number == number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_writes() {
        let read_only: Vec<u32> =
            SYSTEM_BITS.iter().filter(|it| it.writer != Writer::Program).map(|it| it.number).collect();
        assert_eq!(read_only, [5, 6, 7, 10, 12, 13]);
        let written: Vec<u32> =
            SYSTEM_WORDS.iter().filter(|it| it.writer == Writer::Program).map(|it| it.number).collect();
        assert_eq!(written, [0, 16, 50, 51, 52, 53]);
        assert_eq!(system_bit(6).map(|it| it.writer), Some(Writer::NotProgram("PL72:330")));
        assert_eq!((system_bit(2), system_word(7)), (None, None));
    }

    #[test]
    fn rows_are_in_order_and_within_the_counts() {
        for (rows, count) in [(SYSTEM_BITS, 24), (SYSTEM_WORDS, 64)] {
            assert!(rows.is_sorted_by_key(|it| it.number));
            assert!(rows.iter().all(|it| it.number < count && !it.function.is_empty()));
            assert!(rows.iter().all(|it| it.since.iter().any(Option::is_some)));
        }
        // The rows of one number are for different series.
        let [fast, clock] = [2, 3].map(|it| SYSTEM_BITS[it].since);
        assert!(fast.iter().zip(clock).all(|(a, b)| a.is_some() != b.is_some()));
    }
}

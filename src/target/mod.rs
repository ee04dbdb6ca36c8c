//! What each controller has: counts, ranges, depths, times. Every figure names the place that gives it.
//!
//! **Invariant:** a vendor's number lives here (or on a rule's page), never in a rule's code.

pub mod pl7;
pub mod step7;

use std::fmt;
use std::str::FromStr;

use crate::model::entity::Family;

/// A figure and the place that gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Limit {
    pub value: u32,
    pub source: &'static str,
}

impl Limit {
    pub const fn new(value: u32, source: &'static str) -> Self {
        Self { value, source }
    }
}

/// A range, both ends included, and the place that gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Range {
    pub first: u32,
    pub last: u32,
    pub source: &'static str,
}

impl Range {
    pub const fn new(first: u32, last: u32, source: &'static str) -> Self {
        Self { first, last, source }
    }

    pub fn contains(&self, value: u32) -> bool {
        (self.first..=self.last).contains(&value)
    }
}

/// The controller that a program is for, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    family: Family,
    controller: Option<Controller>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Controller {
    Pl7(&'static pl7::Processor),
    Step7(&'static step7::Cpu),
}

/// Why a controller's name is not one: it is in no table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownController {
    pub name: String,
}

impl fmt::Display for UnknownController {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown controller \"{}\"; known: ", self.name)?;
        for (index, name) in Target::known().enumerate() {
            write!(f, "{}{name}", if index == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownController {}

/// Reads a name as a configuration gives it: `TSX 37-22`, `TSX 57-353`, `CPU 314`. Case, blanks and hyphens do not matter.
impl FromStr for Target {
    type Err = UnknownController;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let key = key(name);
        let of_pl7 = pl7::PROCESSORS.iter().find(|it| self::key(it.name) == key).map(Self::pl7);
        let of_step7 = || step7::CPUS.iter().find(|it| self::key(it.name) == key).map(Self::step7);
        of_pl7.or_else(of_step7).ok_or_else(|| UnknownController { name: name.to_owned() })
    }
}

fn key(name: &str) -> String {
    name.chars().filter(|it| it.is_alphanumeric()).flat_map(char::to_uppercase).collect()
}

impl Target {
    /// A controller of the family about which nothing more is known.
    pub const fn any(family: Family) -> Self {
        Self { family, controller: None }
    }

    /// The PL7 processor that a project names: `TSX 57103`. One that no table has counts as one of its series.
    pub fn of_project(name: &str) -> Option<Self> {
        let key = key(name);
        let exact = pl7::PROCESSORS.iter().find(|it| self::key(it.name) == key);
        let series = || {
            let of_micro = key.starts_with("TSX37");
            let of_premium = ["TSX57", "PCX57", "PMX57"].iter().any(|it| key.starts_with(it));
            let name = if of_micro { "TSX 37" } else { "TSX 57" };
            pl7::PROCESSORS.iter().find(|it| (of_micro || of_premium) && it.name == name)
        };
        exact.or_else(series).map(Self::pl7)
    }

    fn pl7(processor: &'static pl7::Processor) -> Self {
        Self { family: Family::Pl7, controller: Some(Controller::Pl7(processor)) }
    }

    fn step7(cpu: &'static step7::Cpu) -> Self {
        Self { family: Family::Step7, controller: Some(Controller::Step7(cpu)) }
    }

    pub const fn family(&self) -> Family {
        self.family
    }

    /// The controller as the tables spell it; `None` when none is known.
    pub fn controller(&self) -> Option<&'static str> {
        Some(match self.controller? {
            Controller::Pl7(it) => it.name,
            Controller::Step7(it) => it.name,
        })
    }

    /// Every name that a configuration may give.
    pub fn known() -> impl Iterator<Item = &'static str> {
        let of_pl7 = pl7::PROCESSORS.iter().map(|it| it.name);
        of_pl7.chain(step7::CPUS.iter().map(|it| it.name))
    }

    /// The PL7 processor's own table, `None` for another family or an unknown controller.
    pub fn processor(&self) -> Option<&'static pl7::Processor> {
        match self.controller? {
            Controller::Pl7(it) => Some(it),
            Controller::Step7(_) => None,
        }
    }

    /// The S7 CPU's own table, `None` for another family or an unknown controller.
    pub fn cpu(&self) -> Option<&'static step7::Cpu> {
        match self.controller? {
            Controller::Pl7(_) => None,
            Controller::Step7(it) => Some(it),
        }
    }

    /// Deepest nesting of subroutine or block calls. A STEP 7 CPU has its own, so an unknown one has none.
    pub fn call_depth(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::SUBROUTINE_DEPTH),
            Family::Step7 => self.cpu()?.call_depth,
        }
    }

    /// Deepest nesting of parentheses in instruction list.
    pub const fn parenthesis_depth(&self) -> Limit {
        match self.family {
            Family::Pl7 => pl7::PARENTHESIS_DEPTH,
            Family::Step7 => step7::PARENTHESIS_DEPTH,
        }
    }

    /// Number of labels `%Li`; `None` where labels are names.
    pub const fn label_numbers(&self) -> Option<Range> {
        match self.family {
            Family::Pl7 => Some(pl7::LABELS),
            Family::Step7 => None,
        }
    }

    /// Longest label, in characters; `None` where labels are numbers.
    pub const fn label_length(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => None,
            Family::Step7 => Some(step7::LABEL_LENGTH),
        }
    }

    /// Values on the stack of `MPS`; `None` where there is no such stack.
    pub const fn stack_depth(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::STACK_DEPTH),
            Family::Step7 => None,
        }
    }

    /// Watchdog of the cyclic program in milliseconds, as it is unless configured.
    pub fn watchdog_ms(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::WATCHDOG_DEFAULT_MS),
            Family::Step7 => self.cpu()?.watchdog_ms,
        }
    }

    /// Bytes of M that keep their value at a restart.
    pub fn retentive_bytes(&self) -> Option<Range> {
        self.cpu()?.retentive_bytes
    }

    /// How many function blocks of a PL7 symbol (`TM`, `C`, `MN`, `R`, `DR`, `T`) the controller has, the larger series of the
    /// two if it is unknown. `None` for another symbol or family.
    pub fn block_count(&self, symbol: &str) -> Option<Limit> {
        if self.family != Family::Pl7 {
            return None;
        }
        let row = pl7::BLOCK_COUNTS.iter().find(|it| it.symbol == symbol)?;
        Some(match self.processor().map(|it| it.series) {
            Some(pl7::Series::Micro) => row.micro,
            Some(pl7::Series::Premium) | None => row.premium,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(name: &str) -> Target {
        name.parse().unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn names_in_any_spelling() {
        for name in ["TSX 37-22", "tsx37-22", "TSX 37 22", "TSX3722"] {
            assert_eq!(target(name).controller(), Some("TSX 37-22"));
            assert_eq!(target(name).family(), Family::Pl7);
        }
        for name in ["CPU 314", "cpu314", "CPU-314"] {
            assert_eq!((target(name).controller(), target(name).family()), (Some("CPU 314"), Family::Step7));
        }
        assert_eq!(target("TSX 57-353").controller(), Some("TSX 57-353"));
    }

    #[test]
    fn every_known_name_reads_back() {
        for name in Target::known() {
            assert_eq!(target(name).controller(), Some(name));
        }
    }

    #[test]
    fn unknown_names_list_the_known_ones() {
        for name in ["TSX 37-99", "", "CPU", "TSX 17-20"] {
            let error = name.parse::<Target>().expect_err(name);
            let message = error.to_string();
            assert!(message.contains(&format!("\"{name}\"")) && message.contains("TSX 37-22, "), "{message}");
            assert!(message.contains("CPU 314"));
        }
    }

    #[test]
    fn limits_of_a_family_and_of_a_controller() {
        let (pl7, step7) = (Target::any(Family::Pl7), Target::any(Family::Step7));
        assert_eq!(pl7.call_depth(), Some(Limit::new(8, "PL7:1964")));
        assert_eq!(step7.call_depth(), None);
        assert_eq!(target("CPU 314").call_depth(), Some(Limit::new(8, "S7:107")));
        assert_eq!(target("S7-300").call_depth(), None);
        assert_eq!((pl7.parenthesis_depth().value, step7.parenthesis_depth().value), (8, 7));
        assert_eq!(pl7.label_numbers().map(|it| (it.contains(999), it.contains(1000))), Some((true, false)));
        assert_eq!((pl7.label_length(), step7.label_numbers(), step7.stack_depth()), (None, None, None));
        assert_eq!(step7.label_length(), Some(Limit::new(4, "S7:315")));
        assert_eq!(pl7.stack_depth(), Some(Limit::new(3, "PL7:3232")));
        assert_eq!(target("CPU 314").watchdog_ms().map(|it| it.value), Some(150));
        assert_eq!(pl7.watchdog_ms().map(|it| it.value), Some(250));
        let retentive = target("CPU 314").retentive_bytes();
        assert_eq!(retentive.map(|it| (it.contains(0), it.contains(15), it.contains(16))), Some((true, true, false)));
        assert_eq!((pl7.retentive_bytes(), step7.retentive_bytes()), (None, None));
        assert_eq!((pl7.cpu(), pl7.processor(), step7.cpu()), (None, None, None));
    }

    #[test]
    fn function_blocks_of_a_controller() {
        let micro = target("TSX 37-22");
        let premium = target("TSX 57-353");
        let counts = |target: Target| {
            ["TM", "C", "MN", "R", "DR", "T"].map(|it| target.block_count(it).map(|it| it.value)).map(Option::unwrap)
        };
        assert_eq!(counts(micro), [64, 32, 8, 4, 8, 64]);
        assert_eq!(counts(premium), [255; 6]);
        assert_eq!(counts(Target::any(Family::Pl7)), [255; 6]);
        assert_eq!((micro.block_count("X"), target("CPU 314").block_count("T")), (None, None));
    }
}

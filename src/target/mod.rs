//! What each controller has: counts, ranges, depths, times. Every figure names the place that gives it.
//!
//! **Invariant:** a vendor's number lives here (or on a rule's page), never in a rule's code.

mod count;
pub mod pl7;
pub mod pl72;
pub mod step5;
pub mod step7;

use std::fmt;
use std::str::FromStr;

use count::Counts;
pub use count::{Count, Counted, CountedBy, Numbered};

use crate::model::entity::{BlockKind, Family};

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

/// System bits that command a chart as a whole: they initialise, clear or freeze it.
#[derive(Debug, PartialEq, Eq)]
pub struct ChartBits {
    pub bits: Range,
    pub cleared: &'static [ClearedBit],
    /// Who says that nothing but a set coil may write them.
    pub only_set: Option<&'static str>,
}

/// A system bit that the system itself resets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClearedBit {
    pub bit: u32,
    /// Whether the program must not reset it; else there is just no need to.
    pub is_forbidden: bool,
    pub source: &'static str,
}

/// What all charts of a program may have at most: in their drawing, and at one time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChartCapacity {
    /// Those of expansions too, but for `IN` and `OUT`.
    pub steps: Limit,
    /// Those among them that are initial.
    pub initial_steps: Option<Limit>,
    pub transitions: Limit,
    pub and_convergences: Option<Limit>,
    /// Origin and destination.
    pub connectors: Option<(Limit, Limit)>,
    pub active_steps: Limit,
    pub valid_transitions: Limit,
    /// The last two as they are unless configured, of a known controller where they are configured.
    pub default: Option<(Limit, Limit)>,
}

/// The controller that a program is for, as far as it is known, and what the application configures on it.
///
/// Of an unknown controller, a figure is the one that holds for every controller of the family: the largest count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    family: Family,
    controller: Option<Controller>,
    counts: Counts,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Controller {
    Pl7(&'static pl7::Processor),
    Pl72(&'static pl72::Controller, Option<pl72::Version>),
    Step5(&'static step5::Cpu),
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

/// Reads a name as a configuration gives it: `TSX 37-22`, `TSX 57-353`, `TSX 47-20`, `CPU 314`. Case, blanks and hyphens do
/// not matter.
impl FromStr for Target {
    type Err = UnknownController;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let key = key(name);
        let of_pl7 = pl7::PROCESSORS.iter().find(|it| self::key(it.name) == key).map(Self::pl7);
        let of_pl72 = || pl72::CONTROLLERS.iter().find(|it| self::key(it.name) == key).map(Self::of_pl72);
        let of_step7 = || step7::CPUS.iter().find(|it| self::key(it.name) == key).map(Self::step7);
        let of_step5 = || step5::CPUS.iter().find(|it| self::key(it.name) == key).map(Self::of_step5);
        of_pl7
            .or_else(of_pl72)
            .or_else(of_step7)
            .or_else(of_step5)
            .ok_or_else(|| UnknownController { name: name.to_owned() })
    }
}

fn key(name: &str) -> String {
    name.chars().filter(|it| it.is_alphanumeric()).flat_map(char::to_uppercase).collect()
}

impl Target {
    /// A controller of the family about which nothing more is known.
    pub fn any(family: Family) -> Self {
        Self { family, controller: None, counts: Counts::default() }
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
        Self { controller: Some(Controller::Pl7(processor)), ..Self::any(Family::Pl7) }
    }

    fn of_pl72(controller: &'static pl72::Controller) -> Self {
        Self { controller: Some(Controller::Pl72(controller, None)), ..Self::any(Family::Pl72) }
    }

    fn of_step5(cpu: &'static step5::Cpu) -> Self {
        Self { controller: Some(Controller::Step5(cpu)), ..Self::any(Family::Step5) }
    }

    fn step7(cpu: &'static step7::Cpu) -> Self {
        Self { controller: Some(Controller::Step7(cpu)), ..Self::any(Family::Step7) }
    }

    /// The target with the counts that an application configures, by their key in `[objects]`.
    pub fn with_counts(self, of: impl Fn(&str) -> Option<u32>) -> Self {
        let counts = Counts::new(|what| {
            let key = self.numbered(what)?.key;
            (!key.is_empty()).then(|| of(key)).flatten()
        });
        Self { counts, ..self }
    }

    /// What controllers of the family count.
    pub fn all_numbered(&self) -> &'static [Numbered] {
        match self.family {
            Family::Pl7 => pl7::NUMBERED,
            Family::Pl72 => pl72::NUMBERED,
            Family::Step5 => step5::NUMBERED,
            Family::Step7 => step7::NUMBERED,
        }
    }

    /// How the family calls what it counts; `None` when it has no such thing.
    pub fn numbered(&self, what: Counted) -> Option<&'static Numbered> {
        self.all_numbered().iter().find(|it| it.what == what)
    }

    /// How many objects of a kind a program may use: the configured number, else the most that the controller, or every
    /// controller of the family, can have. `None` when the family has no such thing, or when nothing says where it ends.
    pub fn count(&self, what: Counted) -> Option<Count> {
        let numbered = self.numbered(what)?;
        if let Some(value) = self.counts.get(what) {
            return Some(Count { value, by: CountedBy::Configuration, source: numbered.key });
        }
        let (own, largest) = match self.controller {
            Some(Controller::Pl7(it)) => (it.count(what), pl7::largest_count(what)),
            Some(Controller::Step5(it)) => (it.count(what), step5::largest_count(what)),
            Some(Controller::Step7(it)) => (it.count(what), step7::largest_count(what)),
            Some(Controller::Pl72(controller, version)) => {
                let model = pl72::Model { controller: Some(controller), version };
                (model.numbered(what), pl72::Model::default().numbered(what))
            }
            None => match self.family {
                Family::Pl7 => (None, pl7::largest_count(what)),
                Family::Pl72 => (None, pl72::Model::default().numbered(what)),
                Family::Step5 => (None, step5::largest_count(what)),
                Family::Step7 => (None, step7::largest_count(what)),
            },
        };
        let name = self.controller();
        let (limit, by) = match own.zip(name) {
            Some((limit, name)) => (limit, CountedBy::Controller(name)),
            None => (largest?, CountedBy::Family),
        };
        Some(Count { value: limit.value, by, source: limit.source })
    }

    /// How many timers of both kinds there may be together, and whose limit it is; `None` where each kind has its own.
    pub fn all_timers(&self) -> Option<Count> {
        if self.family != Family::Pl7 {
            return None;
        }
        let (limit, by) = match self.processor() {
            Some(it) => (it.series.timers(), CountedBy::Controller(it.name)),
            None => (pl7::TIMERS_PREMIUM, CountedBy::Family),
        };
        Some(Count { value: limit.value, by, source: limit.source })
    }

    /// Numbers of events, those of every controller when it is unknown; `None` where events have no numbers.
    pub fn events(&self) -> Option<Range> {
        match self.family {
            Family::Pl7 => self.processor().and_then(|it| it.events).or(pl7::EVENTS_LARGEST),
            Family::Pl72 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Numbers of subroutines that the language has; `None` where they are blocks.
    pub const fn subroutines(&self) -> Option<Range> {
        match self.family {
            Family::Pl7 => Some(pl7::SUBROUTINES),
            Family::Pl72 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Number of a subroutine above which no tool takes one.
    pub const fn last_subroutine(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::SUBROUTINE_LAST_IN_EDITOR),
            Family::Pl72 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Longest name of a section: what the language allows, and what the program editor takes.
    pub const fn section_name_length(&self) -> Option<(Limit, Limit)> {
        match self.family {
            Family::Pl7 => Some((pl7::SECTION_NAME_LENGTH, pl7::SECTION_NAME_LENGTH_IN_EDITOR)),
            Family::Pl72 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Preset of a timer, counter or monostable.
    pub const fn preset(&self, what: Counted) -> Option<Range> {
        match (self.family, what) {
            (Family::Pl7, Counted::Timers | Counted::OldTimers | Counted::Counters | Counted::Monostables) => {
                Some(pl7::PRESETS)
            }
            (Family::Pl72, Counted::Timers | Counted::Counters | Counted::FastCounters | Counted::Monostables) => {
                Some(pl72::PRESETS)
            }
            (Family::Step5, Counted::Counters) => Some(step5::COUNTER_PRESETS),
            (Family::Step7, Counted::Counters) => Some(step7::COUNTER_PRESETS),
            _ => None,
        }
    }

    /// Whether an index may be a constant word or an immediate value, as it may on some controller when it is unknown.
    pub fn has_constant_index(&self) -> bool {
        self.family == Family::Pl7 && self.processor().is_none_or(|it| it.series.has_constant_index())
    }

    /// Lines of a rung, the most that any controller has when it is unknown.
    pub fn ladder_lines(&self) -> Option<Limit> {
        let series = || self.processor().map_or(pl7::Series::Premium, |it| it.series);
        match self.family {
            Family::Pl7 => Some(series().ladder_lines()),
            Family::Pl72 => Some(pl72::LADDER_LINES),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// What a chart may have at most.
    pub fn chart(&self) -> Option<pl7::ChartLimits> {
        let largest = (self.family == Family::Pl7).then_some(pl7::CHART_LARGEST);
        self.processor().map(|it| it.chart_max).or(largest)
    }

    /// Elements of all charts of a program.
    pub fn chart_capacity(&self) -> Option<ChartCapacity> {
        match self.family {
            Family::Pl7 => {
                let most = self.processor().map_or(pl7::CHART_LARGEST, |it| it.chart_max);
                let default = self.processor().map(|it| it.chart_default);
                Some(ChartCapacity {
                    steps: most.all_steps,
                    initial_steps: None,
                    transitions: pl7::TRANSITIONS,
                    and_convergences: Some(pl7::AND_CONVERGENCES),
                    connectors: None,
                    active_steps: most.active_steps,
                    valid_transitions: most.valid_transitions,
                    default: default.map(|it| (it.active_steps, it.valid_transitions)),
                })
            }
            Family::Pl72 => Some(ChartCapacity {
                steps: pl72::STEPS,
                initial_steps: Some(pl72::INITIAL_STEPS),
                transitions: pl72::TRANSITIONS,
                and_convergences: None,
                connectors: Some((pl72::ORIGIN_CONNECTORS, pl72::DESTINATION_CONNECTORS)),
                active_steps: pl72::ACTIVE_STEPS,
                valid_transitions: pl72::VALID_TRANSITIONS,
                default: None,
            }),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// Branches of one divergence or convergence of a chart.
    pub const fn chart_branches(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::BRANCHES),
            Family::Pl72 => Some(pl72::OR_BRANCHES_OUT),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// Pages of a chart, then lines and columns of a page.
    pub const fn chart_pages(&self) -> Option<(Limit, Limit, Limit)> {
        match self.family {
            Family::Pl7 => Some((pl7::CHART_PAGES, pl7::PAGE_LINES, pl7::PAGE_COLUMNS)),
            Family::Pl72 => Some((pl72::CHART_PAGES, pl72::CHART_LINES, pl72::CHART_COLUMNS)),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// The system bits that command a chart as a whole; `None` where there are no charts.
    pub const fn chart_bits(&self) -> Option<&'static ChartBits> {
        match self.family {
            Family::Pl7 => Some(&pl7::CHART_BITS),
            Family::Pl72 => Some(&pl72::CHART_BITS),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// Values that the time of a step takes, and its unit in milliseconds.
    pub const fn step_times(&self) -> Option<(Range, Limit)> {
        match self.family {
            Family::Pl7 => Some((pl7::STEP_TIMES, pl7::STEP_TIME_UNIT_MS)),
            Family::Pl72 => Some((pl72::STEP_TIMES_S, pl72::STEP_TIME_UNIT_MS)),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// What one event may exchange; `None` when the controller is unknown: the series count differently.
    pub fn exchanges(&self) -> Option<pl7::Exchanges> {
        self.processor().map(|it| it.exchanges)
    }

    /// The same controller in a version of its software. Only the documents of PL7-2 distinguish versions.
    ///
    /// # Errors
    /// A text that names no version, for a controller that has versions.
    pub fn with_version(self, version: Option<&str>) -> Result<Self, pl72::UnknownVersion> {
        let (Some(Controller::Pl72(controller, _)), Some(version)) = (self.controller, version) else {
            return Ok(self);
        };
        let version = version.parse()?;
        Ok(Self { controller: Some(Controller::Pl72(controller, Some(version))), ..self })
    }

    pub const fn family(&self) -> Family {
        self.family
    }

    /// The controller as the tables spell it; `None` when none is known.
    pub fn controller(&self) -> Option<&'static str> {
        Some(match self.controller? {
            Controller::Pl7(it) => it.name,
            Controller::Pl72(it, _) => it.name,
            Controller::Step5(it) => it.name,
            Controller::Step7(it) => it.name,
        })
    }

    /// Every name that a configuration may give.
    pub fn known() -> impl Iterator<Item = &'static str> {
        let of_pl7 = pl7::PROCESSORS.iter().map(|it| it.name);
        let of_pl72 = pl72::CONTROLLERS.iter().map(|it| it.name);
        let of_step7 = step7::CPUS.iter().map(|it| it.name);
        of_pl7.chain(of_pl72).chain(of_step7).chain(step5::CPUS.iter().map(|it| it.name))
    }

    /// The PL7 processor's own table, `None` for another family or an unknown controller.
    pub fn processor(&self) -> Option<&'static pl7::Processor> {
        match self.controller? {
            Controller::Pl7(it) => Some(it),
            Controller::Pl72(..) | Controller::Step5(_) | Controller::Step7(_) => None,
        }
    }

    /// What is known of the controller of a PL7-2 program; `None` for another family.
    pub fn pl72(&self) -> Option<pl72::Model> {
        match self.controller {
            Some(Controller::Pl72(controller, version)) => Some(pl72::Model { controller: Some(controller), version }),
            _ => (self.family == Family::Pl72).then(pl72::Model::default),
        }
    }

    /// The S7 CPU's own table, `None` for another family or an unknown controller.
    pub fn cpu(&self) -> Option<&'static step7::Cpu> {
        match self.controller? {
            Controller::Pl7(_) | Controller::Pl72(..) | Controller::Step5(_) => None,
            Controller::Step7(it) => Some(it),
        }
    }

    /// The S5 CPU's own table, `None` for another family or an unknown controller.
    pub fn step5(&self) -> Option<&'static step5::Cpu> {
        match self.controller? {
            Controller::Step5(it) => Some(it),
            Controller::Pl7(_) | Controller::Pl72(..) | Controller::Step7(_) => None,
        }
    }

    /// Numbers of the blocks of a kind, those of every controller of the family when it is unknown. `None` where no source
    /// tells.
    pub fn block_numbers(&self, kind: BlockKind) -> Option<Range> {
        match self.family {
            Family::Pl7 | Family::Pl72 => None,
            Family::Step5 => {
                let blocks = self.step5().map_or(step5::LARGEST_BLOCKS, |it| it.blocks);
                matches!(kind, BlockKind::Pb | BlockKind::Sb | BlockKind::Fb | BlockKind::Fx | BlockKind::Db)
                    .then(|| Range::new(0, blocks.value.saturating_sub(1), blocks.source))
            }
            Family::Step7 => step7::block_numbers(kind),
        }
    }

    /// Deepest nesting of subroutine or block calls. A STEP 7 CPU has its own, so an unknown one has none; PL7-2 has no
    /// calls.
    pub fn call_depth(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::SUBROUTINE_DEPTH),
            Family::Pl72 | Family::Step5 => None,
            Family::Step7 => self.cpu()?.call_depth,
        }
    }

    /// Deepest nesting of parentheses in instruction list. PL7-2 has no list of its own.
    pub const fn parenthesis_depth(&self) -> Limit {
        match self.family {
            Family::Pl7 | Family::Pl72 => pl7::PARENTHESIS_DEPTH,
            Family::Step5 => step5::PARENTHESIS_DEPTH,
            Family::Step7 => step7::PARENTHESIS_DEPTH,
        }
    }

    /// Number of labels `%Li`, `Li`; `None` where labels are names.
    pub const fn label_numbers(&self) -> Option<Range> {
        match self.family {
            Family::Pl7 => Some(pl7::LABELS),
            Family::Pl72 => Some(pl72::LABELS),
            Family::Step5 | Family::Step7 => None,
        }
    }

    /// Jumps of a program, and so of each of its parts; `None` where nothing limits them.
    pub const fn jumps(&self) -> Option<Limit> {
        match self.family {
            Family::Pl72 => Some(pl72::JUMPS),
            Family::Pl7 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Longest label, in characters; `None` where labels are numbers.
    pub const fn label_length(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 | Family::Pl72 => None,
            Family::Step5 => Some(step5::LABEL_LENGTH),
            Family::Step7 => Some(step7::LABEL_LENGTH),
        }
    }

    /// Longest symbol, in characters.
    pub const fn symbol_length(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::SYMBOL_LENGTH),
            Family::Pl72 => None,
            Family::Step5 => Some(step5::SYMBOL_LENGTH),
            Family::Step7 => Some(step7::SYMBOL_LENGTH),
        }
    }

    /// Longest name of a parameter or variable that a block or a DFB declares, in characters.
    pub const fn field_length(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::DFB_ITEM_NAME_LENGTH),
            Family::Pl72 => None,
            Family::Step5 => Some(step5::FORMAL_LENGTH),
            Family::Step7 => Some(step7::SYMBOL_LENGTH),
        }
    }

    /// Values on the stack of `MPS`; `None` where there is no such stack.
    pub const fn stack_depth(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::STACK_DEPTH),
            Family::Pl72 | Family::Step5 | Family::Step7 => None,
        }
    }

    /// Watchdog of the cyclic program in milliseconds, as it is unless configured.
    pub fn watchdog_ms(&self) -> Option<Limit> {
        match self.family {
            Family::Pl7 => Some(pl7::WATCHDOG_DEFAULT_MS),
            Family::Pl72 => Some(pl72::WATCHDOG_MS),
            Family::Step5 => None,
            Family::Step7 => self.cpu()?.watchdog_ms,
        }
    }

    /// Bytes of M that keep their value at a restart.
    pub fn retentive_bytes(&self) -> Option<Range> {
        self.cpu()?.retentive_bytes
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
        for name in ["TSX 47-J", "tsx47j", "TSX 47 J"] {
            assert_eq!((target(name).controller(), target(name).family()), (Some("TSX 47-J"), Family::Pl72));
        }
    }

    #[test]
    fn versions_of_controllers_that_have_them() {
        let with = |name: &str, version| target(name).with_version(version);
        let version = |it: Result<Target, pl72::UnknownVersion>| it.map(|it| it.pl72().and_then(|it| it.version));
        assert_eq!(version(with("TSX 27", Some("V3.1"))), Ok(Some(pl72::Version::new(3, 1))));
        assert_eq!(version(with("TSX 27", None)), Ok(None));
        assert_eq!(version(with("TSX 27", Some("new"))), Err(pl72::UnknownVersion("new".to_owned())));
        assert_eq!(with("TSX 37-22", Some("new")), Ok(target("TSX 37-22")));
        assert_eq!(Target::any(Family::Pl72).pl72(), Some(pl72::Model::default()));
        assert_eq!((Target::any(Family::Pl7).pl72(), target("CPU 314").pl72()), (None, None));
    }

    #[test]
    fn limits_of_pl7_2() {
        let any = Target::any(Family::Pl72);
        assert_eq!((any.call_depth(), any.stack_depth(), any.label_length()), (None, None, None));
        assert_eq!(any.label_numbers().map(|it| (it.contains(0), it.contains(1))), Some((false, true)));
        assert_eq!(any.watchdog_ms(), Some(Limit::new(150, "PL72:477")));
        assert_eq!((any.retentive_bytes(), any.processor()), (None, None));
    }

    #[test]
    fn every_known_name_reads_back() {
        for name in Target::known() {
            assert_eq!(target(name).controller(), Some(name));
        }
    }

    #[test]
    fn unknown_names_list_the_known_ones() {
        for name in ["TSX 37-99", "", "CPU", "TSX 17"] {
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
        assert_eq!(pl7.symbol_length(), Some(Limit::new(32, "PL7:1198")));
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
        let counts = |target: Target| {
            pl7::BLOCK_COUNTS.iter().map(|it| (it.symbol, target.count(it.what).map(|it| it.value))).collect::<Vec<_>>()
        };
        let of_micro = [("TM", 64), ("C", 32), ("MN", 8), ("R", 4), ("DR", 8), ("T", 64)];
        assert_eq!(counts(target("TSX 37-22")), of_micro.map(|(symbol, count)| (symbol, Some(count))));
        for target in [target("TSX 57-353"), Target::any(Family::Pl7)] {
            assert!(counts(target).iter().all(|it| it.1 == Some(255)));
        }
    }

    #[test]
    fn the_most_that_there_is() {
        use Counted::*;

        let count = |target: Target, what| target.count(what).map(|it| (it.value, it.source));
        let any = Target::any(Family::Pl7);
        assert_eq!(count(any, Bits), Some((32_634, "PL7:1691")));
        assert_eq!(count(any, Words), Some((31_232, "PL7:1705")));
        assert_eq!(count(any, Steps), Some((250, "PL7:4279")));
        assert_eq!(count(any, MacroSteps), Some((64, "PL7:4280")));
        assert_eq!(count(any, SystemBits).map(|it| it.0), Some(128));
        assert_eq!((count(any, Constants), count(any, Bytes)), (None, None));
        assert_eq!(count(any, Drums), Some((255, "PL7:990")));
        assert_eq!(count(target("TSX 37-10"), Words), Some((14_336, "PL7:1534")));
        assert_eq!(count(target("TSX 37-05"), Words), Some((9216, "PL7:1534")));
        assert_eq!(count(target("TSX 37-22"), Words), Some((17_920, "PL7:1560")));
        assert_eq!(count(target("TSX 57-103"), Words), Some((26_624, "PL7:1609")));
        assert_eq!(count(target("TSX 37-22"), MacroSteps), Some((0, "PL7:4280")));
        assert_eq!(count(target("TSX 37-22"), Registers), Some((4, "PL7:986")));
        // Its memory is in no table: no controller has more than the largest.
        let unknown = target("PCX 57-1012").count(Bits).unwrap();
        assert_eq!((unknown.value, unknown.by), (32_634, CountedBy::Family));
        let known = target("TSX 57-153").count(Bits).unwrap();
        assert_eq!((known.value, known.by), (3962, CountedBy::Controller("TSX 57-153")));
        let step7 = Target::any(Family::Step7);
        assert_eq!([Bytes, Timers, Counters].map(|it| count(step7, it).map(|it| it.0)), [16_384, 2048, 2048].map(Some));
        let cpu = target("CPU 314");
        assert_eq!((count(cpu, Timers), count(cpu, Counters)), (Some((256, "S7:477")), Some((256, "S7:591"))));
        assert_eq!((count(step7, Words), count(step7, Steps)), (None, None));
    }

    #[test]
    fn what_every_controller_of_the_family_has_is_never_less_than_what_one_has() {
        for name in Target::known() {
            let one = target(name);
            let any = Target::any(one.family());
            for it in one.all_numbered() {
                let (one, any) = (one.count(it.what), any.count(it.what));
                assert!(one.map(|it| it.value) <= any.map(|it| it.value), "{name}: {}", it.plural);
            }
            assert!(one.events().map(|it| it.last) <= any.events().map(|it| it.last));
            assert!(one.chart().map(|it| it.all_steps.value) <= any.chart().map(|it| it.all_steps.value));
        }
    }

    #[test]
    fn configured_counts_come_first() {
        let target = target("TSX 37-22").with_counts(|key| (key == "MW").then_some(100));
        let words = Count { value: 100, by: CountedBy::Configuration, source: "MW" };
        assert_eq!(target.count(Counted::Words), Some(words));
        assert_eq!(target.count(Counted::Bits).map(|it| it.value), Some(256));
        // The number of system bits is not configured.
        let all = Target::any(Family::Pl7).with_counts(|_| Some(1));
        assert_eq!(all.count(Counted::SystemBits).map(|it| it.value), Some(128));
        assert_eq!(all.count(Counted::Constants).map(|it| it.value), Some(1));
    }

    #[test]
    fn events_timers_indexes_and_presets() {
        let events = |target: Target| target.events().map(|it| (it.first, it.last, it.source));
        assert_eq!(events(target("TSX 37-08")), Some((1, 8, "PL7:2060")));
        assert_eq!(events(target("TSX 37-21")), Some((0, 15, "PL7:2061")));
        assert_eq!(events(target("PCX 57-1012")), Some((0, 31, "PL7:2062")));
        assert_eq!(events(Target::any(Family::Pl7)), Some((0, 63, "PL7:2063")));
        assert_eq!(events(Target::any(Family::Step7)), None);
        let timers = |target: Target| target.all_timers().map(|it| it.value);
        assert_eq!((timers(target("TSX 37-10")), timers(Target::any(Family::Pl7))), (Some(64), Some(255)));
        assert_eq!(timers(target("CPU 314")), None);
        assert!(Target::any(Family::Pl7).has_constant_index() && !target("TSX 37").has_constant_index());
        assert!(!target("CPU 314").has_constant_index());
        let preset = |target: Target, what| target.preset(what).map(|it| it.last);
        let pl7 = Target::any(Family::Pl7);
        assert_eq!((preset(pl7, Counted::Monostables), preset(pl7, Counted::Drums)), (Some(9999), None));
        let step7 = Target::any(Family::Step7);
        assert_eq!((preset(step7, Counted::Counters), preset(step7, Counted::Timers)), (Some(999), None));
        let lines = |target: Target| target.ladder_lines().map(|it| it.value);
        assert_eq!((lines(pl7), lines(target("TSX 37-22")), lines(step7)), (Some(16), Some(7), None));
        assert_eq!((pl7.exchanges(), step7.chart()), (None, None));
    }
}

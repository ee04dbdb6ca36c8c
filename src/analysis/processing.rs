//! Where code stands relative to a chart: in the preliminary processing, or in the action of a step (PL7:4895-4901).

use std::cell::OnceCell;

use super::Site;
use super::chart::{ChartFacts, FactAction};
use super::facts::UnitFacts;
use super::program::{GlobalCall, GlobalUse, ObjectUses, ProgramIndex};
use super::reach::{Net, Node};
use crate::model::chart::{ActionKind, Graph, StepName};
use crate::model::entity::{Entity, Part, Task};
use crate::model::unit::Mode;
use crate::syntax::Language;

/// How code comes to run outside the preliminary processing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outside {
    /// The part of the program that it belongs to, or that calls it.
    pub entry: u32,
    /// The call in that part, where the code is a subroutine's.
    pub call: Option<Site>,
}

/// Tells the preliminary processing from the rest of a program.
pub struct Preliminary<'p, 'a> {
    program: &'p ProgramIndex<'a>,
    /// Of each unit, once one was asked for.
    outside: OnceCell<Vec<Option<Outside>>>,
}

impl<'p, 'a> Preliminary<'p, 'a> {
    pub fn new(program: &'p ProgramIndex<'a>) -> Self {
        Self { program, outside: OnceCell::new() }
    }

    /// How a unit surely runs outside the preliminary processing. A text without heading may be that, and so may a
    /// subroutine that nothing calls; the listing of a project does not tell.
    pub fn outside(&self, unit: u32) -> Option<Outside> {
        self.outside.get_or_init(|| self.find()).get(unit as usize).copied().flatten()
    }

    fn find(&self) -> Vec<Option<Outside>> {
        let program = self.program;
        let mut calls: Vec<Vec<&GlobalCall<'_>>> = vec![Vec::new(); program.units.len()];
        for call in program.calls.iter().filter(|it| it.it.reachable) {
            calls[call.unit as usize].push(call);
        }
        let is_preliminary = |it: &Entity| matches!(it, Entity::Pl7 { part: Part::Preliminary, .. });
        let is_named = program.units.iter().any(|it| is_preliminary(&it.entity));
        let mut found: Vec<Option<Outside>> = vec![None; program.units.len()];
        let mut open: Vec<(u32, Outside)> = (0..u32::try_from(program.units.len()).unwrap_or(u32::MAX))
            .rev()
            .filter(|&it| program.is_entry(it) && self.is_outside(it, is_named))
            .map(|entry| (entry, Outside { entry, call: None }))
            .collect();
        while let Some((at, outside)) = open.pop() {
            if found[at as usize].is_some() {
                continue;
            }
            found[at as usize] = Some(outside);
            for call in calls[at as usize].iter().rev() {
                // The preliminary processing is called by nothing.
                let Some(target) = call.target.filter(|&it| !program.is_entry(it)) else { continue };
                open.push((target, Outside { call: outside.call.or(Some(call.site())), ..outside }));
            }
        }
        found
    }

    /// Whether a part is not the preliminary processing. `is_named`: that one is named somewhere, so that a part without
    /// a name is another.
    fn is_outside(&self, unit: u32, is_named: bool) -> bool {
        let facts = self.program.units[unit as usize];
        let Entity::Pl7 { task, section, part } = &facts.entity else { return false };
        match part {
            _ if facts.language == Language::Pl7Xref => false,
            // That of a chart outside MAST is wrong as a whole.
            Part::Preliminary | Part::Subroutine(_) => false,
            Part::Chart(_) | Part::Posterior | Part::Event => true,
            Part::Main => *task != Task::Mast || section.is_some() || is_named,
        }
    }
}

/// The action of a chart that a use stands in.
#[derive(Debug, Clone, Copy)]
pub struct InAction<'a> {
    chart: &'a ChartFacts,
    action: &'a FactAction,
}

impl<'a> InAction<'a> {
    pub fn of(program: &ProgramIndex<'a>, it: &GlobalUse<'_>) -> Option<Self> {
        Self::at(program.units.get(it.unit as usize)?, it.it.anchor)
    }

    /// The action that a place of a unit stands in.
    pub fn at(unit: &'a UnitFacts, anchor: u32) -> Option<Self> {
        let chart = unit.chart.as_deref()?;
        Some(Self { chart, action: chart.action_at(anchor)? })
    }

    /// Whether it runs in no scan in which none of its steps is active.
    pub fn is_while_active(&self) -> bool {
        matches!(self.action.kind, Some(ActionKind::Continuous | ActionKind::Activation))
    }

    /// Whether it runs while its steps are active.
    pub fn is_continuous(&self) -> bool {
        self.action.kind == Some(ActionKind::Continuous)
    }

    /// Whether it runs when its steps go off.
    pub fn is_at_end(&self) -> bool {
        self.action.kind == Some(ActionKind::Deactivation)
    }

    /// The steps that run it, in a net that has them.
    pub fn nodes(&self, program: &ProgramIndex<'_>, unit: u32, net: &Net<'_, '_>) -> Vec<Node> {
        let section = program.units.get(unit as usize).and_then(|it| super::chart::section(&it.entity));
        section.map_or_else(Vec::new, |section| net.named(section, self.chart.graph, self.names()))
    }

    fn names(&self) -> impl Iterator<Item = &'a StepName> {
        let chart = self.chart;
        self.action.steps.iter().filter_map(|&it| chart.steps.get(it as usize)?.name.as_ref())
    }

    /// Whether the steps that run it are those that run the other. Those of more than a few are told apart by the action.
    pub fn has_steps_of(&self, other: &Self) -> bool {
        const MOST: usize = 64;
        let count = self.action.steps.len();
        std::ptr::eq(self.action, other.action)
            || self.chart.graph == other.chart.graph
                && count == other.action.steps.len()
                && count <= MOST
                && self.names().eq(other.names())
    }

    /// Whether it runs in each scan while one step is active.
    pub fn is_continuous_of_one_step(&self) -> bool {
        self.is_continuous() && self.action.steps.len() == 1
    }

    /// ``step `3` ``, ``steps `3` and `5` ``, of an expansion ``step `M2.3` ``; of many steps, the first.
    pub fn describe(&self) -> String {
        const MOST: usize = 8;
        let name = |it: &StepName| match self.chart.graph {
            Graph::Main => format!("`{it}`"),
            Graph::Macro(number) => format!("`M{number}.{it}`"),
        };
        let names: Vec<String> = self.names().take(MOST).map(name).collect();
        match &names[..] {
            [] => "a step".to_owned(),
            [one] => format!("step {one}"),
            several => format!("steps {}", several.join(" and ")),
        }
    }
}

/// Whether a write can make a bit 1, as far as the value is known.
pub fn may_raise(it: &GlobalUse<'_>) -> bool {
    match (it.mode, it.it.constant()) {
        (Mode::Reset, _) => false,
        (Mode::Assign, Some(value)) => value != 0,
        (Mode::AssignNot, Some(value)) => value == 0,
        _ => true,
    }
}

/// Whether a write always makes a bit 0 when it takes effect.
pub fn is_reset(it: &GlobalUse<'_>) -> bool {
    !may_raise(it)
}

/// Whether a write gives a bit a value of its own, which it then keeps: set and reset, or a constant.
pub fn is_stored(it: &GlobalUse<'_>) -> bool {
    matches!(it.mode, Mode::Set | Mode::Reset) || it.it.constant().is_some()
}

/// A bit that actions of several steps raise, and nothing else of the program does.
pub struct Several<'a> {
    /// In order; the steps of the second differ from those of the first.
    pub places: Vec<(GlobalUse<'a>, InAction<'a>)>,
    /// Index of the first place whose steps are others than those of the first place.
    pub second: usize,
}

/// The places in actions of several steps that raise a bit, unless it is gathered elsewhere.
pub fn raised_by_several<'a>(program: &ProgramIndex<'a>, uses: &ObjectUses<'a>) -> Option<Several<'a>> {
    let mut places = Vec::new();
    for it in uses.with_mode(Mode::writes).filter(|it| may_raise(it)) {
        places.push((*it, InAction::of(program, it)?));
    }
    let (_, first) = places.first()?;
    let second = places.iter().position(|it| !it.1.has_steps_of(first))?;
    Some(Several { places, second })
}

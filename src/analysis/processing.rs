//! Where code stands relative to a chart: in the preliminary processing, or in the action of a step (PL7:4895-4901).

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

use super::Site;
use super::program::{GlobalUse, ObjectUses, ProgramIndex};
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
    /// Whether the program's text has it, so that a part without a name is another.
    is_named: bool,
    known: FxHashMap<u32, Option<Outside>>,
}

impl<'p, 'a> Preliminary<'p, 'a> {
    pub fn new(program: &'p ProgramIndex<'a>) -> Self {
        let is_preliminary = |it: &Entity| matches!(it, Entity::Pl7 { part: Part::Preliminary, .. });
        let is_named = program.units.iter().any(|it| is_preliminary(&it.entity));
        Self { program, is_named, known: FxHashMap::default() }
    }

    /// How a unit surely runs outside the preliminary processing. A text without heading may be that, and so may a
    /// subroutine that nothing calls; the listing of a project does not tell.
    pub fn outside(&mut self, unit: u32) -> Option<Outside> {
        if let Some(&known) = self.known.get(&unit) {
            return known;
        }
        let found = self.find(unit);
        self.known.insert(unit, found);
        found
    }

    fn find(&self, unit: u32) -> Option<Outside> {
        let mut seen = FxHashSet::from_iter([unit]);
        let mut open = vec![(unit, None)];
        while let Some((at, call)) = open.pop() {
            if self.program.is_entry(at) {
                if self.is_outside(at) {
                    return Some(Outside { entry: at, call });
                }
                continue;
            }
            for call in self.program.callers[at as usize].iter().map(|&it| &self.program.calls[it as usize]) {
                if seen.insert(call.unit) {
                    open.push((call.unit, Some(call.site())));
                }
            }
        }
        None
    }

    fn is_outside(&self, unit: u32) -> bool {
        let facts = self.program.units[unit as usize];
        let Entity::Pl7 { task, section, part } = &facts.entity else { return false };
        match part {
            _ if facts.language == Language::Pl7Xref => false,
            // That of a chart outside MAST is wrong as a whole.
            Part::Preliminary | Part::Subroutine(_) => false,
            Part::Chart(_) | Part::Posterior | Part::Event => true,
            Part::Main => *task != Task::Mast || section.is_some() || self.is_named,
        }
    }
}

/// The action of a chart that a use stands in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InAction {
    /// Names of the steps that run it: `3`, of an expansion `M2.3`.
    pub steps: Vec<SmolStr>,
    pub kind: Option<ActionKind>,
}

impl InAction {
    /// `step `3``, `steps `3` and `5``.
    pub fn describe(&self) -> String {
        let names: Vec<String> = self.steps.iter().map(|it| format!("`{it}`")).collect();
        match &names[..] {
            [] => "a step".to_owned(),
            [one] => format!("step {one}"),
            several => format!("steps {}", several.join(" and ")),
        }
    }
}

/// The name of a step over all graphs of a section: `3`, of an expansion `M2.3`.
pub fn step_name(graph: Graph, name: &StepName) -> SmolStr {
    match graph {
        Graph::Main => format_smolstr!("{name}"),
        Graph::Macro(number) => format_smolstr!("M{number}.{name}"),
    }
}

/// The action of a step that a use stands in.
pub fn action_of(program: &ProgramIndex<'_>, it: &GlobalUse<'_>) -> Option<InAction> {
    let chart = program.units.get(it.unit as usize)?.chart.as_ref()?;
    let action = chart.action_at(it.it.anchor)?;
    let name = |&step: &u32| Some(step_name(chart.graph, chart.steps.get(step as usize)?.name.as_ref()?));
    Some(InAction { steps: action.steps.iter().filter_map(name).collect(), kind: action.kind })
}

/// Whether a write can make a bit 1, as far as the value is known.
pub fn may_raise(it: &GlobalUse<'_>) -> bool {
    match (it.mode, it.it.constant) {
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
    matches!(it.mode, Mode::Set | Mode::Reset) || it.it.constant.is_some()
}

/// A bit that actions of several steps raise, and nothing else of the program does.
pub struct Several<'a> {
    /// In order; the steps of the second differ from those of the first.
    pub places: Vec<(GlobalUse<'a>, InAction)>,
    /// Index of the first place whose steps are others than those of the first place.
    pub second: usize,
}

/// The places in actions of several steps that raise a bit, unless it is gathered elsewhere.
pub fn raised_by_several<'a>(program: &ProgramIndex<'a>, uses: &ObjectUses<'a>) -> Option<Several<'a>> {
    let mut places = Vec::new();
    for it in uses.with_mode(Mode::writes).filter(|it| may_raise(it)) {
        places.push((*it, action_of(program, it)?));
    }
    let first = places.first()?.1.steps.clone();
    let second = places.iter().position(|it| it.1.steps != first)?;
    Some(Several { places, second })
}

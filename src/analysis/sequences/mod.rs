//! Sequences that a program codes with bits: recovered as charts, and compared with the rules of evolution.
//!
//! [`code`] is what a unit tells. [`trace`] follows one scan of the program through its blocks; what each bit is at its end
//! becomes a condition over what the bits were at its start. [`set_reset`] and [`tables`] find steps and transitions in it,
//! [`judge`] asks where the scan does something else than the five rules say (GRF:128-152).

pub mod code;
pub(super) mod gate;
pub mod judge;
pub mod set_reset;
pub mod tables;
pub mod trace;

use self::code::How;
use self::judge::{Deviation, Judge};
use self::set_reset::{Found, FoundTransition};
use self::trace::{Event, Trace};
use super::Site;
use super::chart::{Chart, FactReceptivity, FactStep, FactTransition, RecoveredTransition, Step};
use super::program::ProgramIndex;
use super::reach::{Net, Node, Study};
use crate::model::chart::{StepKind, StepName};
use crate::model::entity::Family;
use crate::model::expr::ObjectId;
use crate::model::object::{Class, Object};

/// The sequences of a program.
#[derive(Debug, Default)]
pub struct Sequences<'a> {
    /// The scan that they are coded in.
    pub trace: Option<Trace<'a>>,
    pub list: Vec<Sequence<'a>>,
    /// What is wrong with tables.
    pub faults: Vec<tables::Fault>,
}

/// A sequence as a chart.
#[derive(Debug)]
pub struct Sequence<'a> {
    pub steps: Vec<SequenceStep<'a>>,
    pub transitions: Vec<SequenceTransition>,
    /// Steps that the program puts: at start-up, or under a condition that asks for no step.
    pub starts: Vec<Vec<Node>>,
    /// Something may put a step that is not seen: the program is not complete, or it writes places computed at run time.
    pub has_gaps: bool,
    /// Where the code does something else than the rules of evolution say.
    pub deviations: Vec<Deviation>,
    /// Pairs of transitions behind one step that a scan can cross both, by index, the earlier first.
    pub together: Vec<(usize, usize)>,
    /// Words that are counted on in each scan while a step is on: the event, and the step.
    pub counts: Vec<(usize, usize)>,
    /// Several steps of one branch can be on together.
    is_fed: bool,
    /// The scan computes all steps from what they were when it began.
    in_tables: bool,
    /// Objects that the receptivities name.
    objects: Vec<&'a Object>,
}

#[derive(Debug)]
pub struct SequenceStep<'a> {
    pub object: &'a Object,
    pub id: ObjectId,
    pub unit: u32,
    pub fact: FactStep,
    /// Where it was recognised by: one sentence.
    pub note: String,
}

#[derive(Debug)]
pub struct SequenceTransition {
    pub found: FoundTransition,
    pub unit: u32,
    pub fact: FactTransition,
}

impl SequenceTransition {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.fact.anchor }
    }
}

impl SequenceStep<'_> {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.fact.anchor }
    }
}

impl<'a> Sequences<'a> {
    pub fn new(program: &ProgramIndex<'a>) -> Self {
        if !gate::may_evolve(program) {
            return Self::default();
        }
        let mut trace = Trace::of_scan(program);
        let mut found = set_reset::find(&mut trace);
        // A bit that sets others and stays is a mode with its flags, and no step.
        found.retain(|it| !it.transitions.iter().any(FoundTransition::keeps_a_source));
        let mut faults = Vec::new();
        for it in tables::find(program, &mut trace) {
            found.push(it.found);
            faults.extend(it.faults);
        }
        if found.is_empty() {
            return Self::default();
        }
        let mut startup = Trace::of_startup(program);
        let mut list: Vec<Sequence<'a>> =
            found.into_iter().map(|it| Sequence::new(program, &mut trace, &mut startup, it)).collect();
        for it in &mut list {
            let in_tables = it.in_tables;
            let mut judge = Judge::new(&mut trace, it);
            let (deviations, together, counts) =
                (if in_tables { Vec::new() } else { judge.deviations() }, judge.together(), judge.counts());
            (it.deviations, it.together, it.counts) = (deviations, together, counts);
        }
        Self { trace: Some(trace), list, faults }
    }

    /// A write of the scan.
    pub fn event(&self, at: usize) -> Option<&Event> {
        self.trace.as_ref()?.events.get(at)
    }

    /// Where the first transition of a deviation sets the step.
    pub fn set_of(&self, sequence: &Sequence<'_>, it: &Deviation) -> Option<Site> {
        let event = sequence.transitions.get(it.first)?.found.set_of(it.step)?;
        self.event(event).map(|it| it.site)
    }

    /// Where the second one resets it.
    pub fn reset_of(&self, sequence: &Sequence<'_>, it: &Deviation) -> Option<Site> {
        let event = sequence.transitions.get(it.second)?.found.reset_of(it.step)?;
        self.event(event).map(|it| it.site)
    }

    /// The sequences as charts, in their order.
    pub fn charts(&'a self) -> Vec<Chart<'a>> {
        self.list.iter().map(Sequence::chart).collect()
    }
}

impl<'a> Sequence<'a> {
    fn new(program: &ProgramIndex<'a>, trace: &mut Trace<'a>, startup: &mut Trace<'a>, found: Found) -> Self {
        /// A receptivity of more expressions than this is not looked into.
        const MOST: usize = 1000;
        let initial: Vec<Node> = (0..).zip(&found.steps).filter(|it| is_set(startup, *it.1)).map(|it| it.0).collect();
        let mut starts: Vec<Vec<Node>> = vec![initial];
        starts.extend(found.starts.iter().map(|it| it.iter().filter_map(|it| Node::try_from(*it).ok()).collect()));
        starts.retain(|it| !it.is_empty());
        starts.dedup();
        let first = starts.first().cloned().unwrap_or_default();
        let event = |how: How, id: ObjectId| trace.events.iter().find(|it| it.how == how && it.object == id);
        let mut steps = Vec::new();
        for (node, &id) in (0..).zip(&found.steps) {
            let object = trace.object(id);
            let (set, reset) = (event(How::Set, id), event(How::Reset, id));
            let site = set.map_or(Site { unit: 0, anchor: 0 }, |it| it.site);
            steps.push(SequenceStep {
                object,
                id,
                unit: site.unit,
                fact: FactStep {
                    name: Some(StepName::Number(node)),
                    text: object.text.clone(),
                    kind: if first.contains(&node) { StepKind::Initial } else { StepKind::Simple },
                    anchor: site.anchor,
                    commented: true,
                },
                note: recognised(program, trace, &found, node as usize, set, reset),
            });
        }
        let mut transitions = Vec::new();
        for it in &found.transitions {
            let site = trace.events.get(it.place()).map_or(Site { unit: 0, anchor: 0 }, |it| it.site);
            let receptivity = trace.exprs.cut(it.receptivity, MOST);
            transitions.push(SequenceTransition {
                unit: site.unit,
                fact: FactTransition {
                    sources: Vec::new(),
                    targets: Vec::new(),
                    receptivity: receptivity.map_or(FactReceptivity::Unread, FactReceptivity::Guard),
                    room: None,
                    anchor: site.anchor,
                },
                found: it.clone(),
            });
        }
        let is_hidden = |it: &SequenceStep<'_>| {
            !matches!(it.object.class, Class::Memory | Class::Symbol) || program.unseen_of(it.object).is_written()
        };
        let has_gaps = !program.complete || program.partial || trace.is_cut || steps.iter().any(is_hidden);
        let objects = trace.objects.clone();
        Self {
            steps,
            transitions,
            starts,
            has_gaps,
            deviations: Vec::new(),
            together: Vec::new(),
            counts: Vec::new(),
            is_fed: found.is_fed,
            in_tables: found.in_tables,
            objects,
        }
    }

    /// The sequence as a chart, whose steps are numbered as [`Self::steps`].
    pub fn chart(&self) -> Chart<'_> {
        let steps = self.steps.iter().map(|it| Step { unit: it.unit, it: &it.fact }).collect();
        let nodes = |it: &[usize]| it.iter().filter_map(|it| u32::try_from(*it).ok()).collect();
        let transition = |it: &'_ SequenceTransition| (it.unit, nodes(&it.found.sources), nodes(&it.found.targets));
        let transitions = self
            .transitions
            .iter()
            .map(|it| {
                let (unit, sources, targets) = transition(it);
                RecoveredTransition { unit, it: &it.fact, sources, targets }
            })
            .collect();
        Chart::recovered(steps, transitions, self.has_gaps)
    }

    fn net<'p>(&'p self, family: Family, chart: &'p Chart<'p>) -> Net<'p, 'p> {
        let ids: Vec<ObjectId> = self.steps.iter().map(|it| it.id).collect();
        let objects: Vec<&'p Object> = self.objects.to_vec();
        Net::recovered(family, chart, objects, &ids, self.starts.clone())
    }

    /// What it reaches, as a chart.
    pub fn study<'p>(&'p self, family: Family, chart: &'p Chart<'p>) -> Study<'p, 'p> {
        Study::new(self.net(family, chart))
    }

    pub fn name(&self, step: usize) -> &str {
        self.steps.get(step).map_or("", |it| it.fact.text.as_str())
    }

    /// Steps as a message names them.
    pub fn names(&self, steps: &[usize]) -> String {
        steps.iter().map(|it| format!("`{}`", self.name(*it))).collect::<Vec<_>>().join(" and ")
    }

    /// How a step was recognised.
    pub fn note(&self, step: usize) -> &str {
        self.steps.get(step).map_or("", |it| it.note.as_str())
    }
}

/// Whether the start-up blocks can leave a bit at 1.
fn is_set(startup: &mut Trace<'_>, bit: ObjectId) -> bool {
    let (start, end) = (startup.start(bit), startup.end(bit));
    start != end && !startup.solve(&[(end, true), (start, false)]).is_never()
}

/// How a bit was recognised as a step.
fn recognised(
    program: &ProgramIndex<'_>,
    trace: &Trace<'_>,
    found: &Found,
    step: usize,
    set: Option<&Event>,
    reset: Option<&Event>,
) -> String {
    let text = |id: ObjectId| trace.object(id).text.as_str();
    let place = |it: &Event| format!("in network {} of {}", it.network, program.entity(it.unit));
    let into = found.transitions.iter().find(|it| it.targets.contains(&step) && it.set_of(step).is_some());
    let out = found.transitions.iter().find(|it| it.reset_of(step).is_some());
    let name = found.steps.get(step).map_or("", |it| text(*it));
    let list = |steps: &[usize]| -> String {
        let names: Vec<String> =
            steps.iter().filter_map(|it| found.steps.get(*it)).map(|it| format!("`{}`", text(*it))).collect();
        names.join(" and ")
    };
    let event = |at: Option<usize>, other| at.and_then(|it| trace.events.get(it)).or(other);
    let mut parts: Vec<String> = Vec::new();
    if let Some(event) = event(into.and_then(|it| it.set_of(step)), set) {
        let from = into.map(|it| format!(" under {}", list(&it.sources))).unwrap_or_default();
        parts.push(format!("set{from} {}", place(event)));
    }
    if let Some(event) = event(out.and_then(|it| it.reset_of(step)), reset) {
        let to = out.filter(|it| !it.targets.is_empty());
        let to = to.map(|it| format!(" when {} is set", list(&it.targets))).unwrap_or_default();
        parts.push(format!("reset{to} {}", place(event)));
    }
    format!("`{name}` is taken for a step: {}", parts.join(", "))
}

//! The situations that a chart can reach, by the rules of evolution (GRF:128-152, PL7:5123-5186).
//!
//! All transitions that can be crossed are crossed at once; the steps before them go off, those behind them go on, and a
//! step that does both stays on. Receptivities are free, but for what [`conditions`] excludes: which of those that are valid
//! together can be true together. Transitions that share no step and no object are independent: crossing them one after
//! the other reaches what crossing them together reaches.
//!
//! Charts that nothing connects are looked at apart. What is too large is said to be not decided.

use std::cell::{Cell, OnceCell};
use std::collections::BTreeMap;
use std::sync::Arc;

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::chart::{Chart, FactReceptivity, Step, Transition};
use super::conditions::{Answer, Lessons, Objects, Space, Verdict};
use super::facts::{self, UnitFacts};
use super::program::ProgramIndex;
use super::stuck::Stuck;
use crate::model::chart::{Graph, StepKind, StepName};
use crate::model::entity::{Family, Task};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Area, Class, Object};
use crate::model::unit::Mode;

/// A chart with more situations than this is not looked at to the end.
const MAX_SITUATIONS: usize = 20_000;

/// Of more divergences than this, the cause of what is wrong behind them is not looked for.
const MOST_OPENINGS: usize = 256;

/// Of so many situations without an end, and lost activations, the cause is looked for.
pub const MAX_CAUSES: usize = 32;

/// Valid transitions are compared pair by pair: so many comparisons in all, hundreds of times what charts need.
const MAX_COMPARISONS: usize = 20_000_000;

/// What the questions of one exploration are made of, expressions counted once for each question: some tenths of a second.
const MAX_EFFORT: usize = 500_000;

/// Of more transitions than this that depend on one another, only single ones and pairs are crossed.
const MAX_TOGETHER: usize = 7;

/// A step of some graph of a section, numbered over all of them.
pub type Node = u32;

/// A transition with the steps of all graphs that it concerns: crossing into a macro-step starts its expansion, and what
/// follows a macro-step waits for the last step of the expansion.
#[derive(Debug)]
pub struct Crossing {
    /// Which chart, and which of its transitions.
    pub chart: usize,
    pub transition: usize,
    pub from: Vec<Node>,
    pub to: Vec<Node>,
    pub guard: Guarded,
    /// The same in the component: places of the steps, and the step bits that the receptivity asks for.
    route: Route,
}

#[derive(Debug, Default)]
struct Route {
    from: Vec<usize>,
    to: Vec<usize>,
    asked: Vec<(usize, ExprId)>,
}

/// What is known of a receptivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guarded {
    By(ExprId),
    /// Not programmed: never crossed.
    Never,
    /// Not understood.
    Unknown,
}

/// The graphs of one section.
pub struct Net<'p, 'a> {
    pub charts: Vec<&'p Chart<'a>>,
    /// Which chart, and which of its steps.
    pub nodes: Vec<(usize, u32)>,
    pub crossings: Vec<Crossing>,
    /// Some of the section was not understood.
    pub has_gaps: bool,
    /// Steps that the program itself sets, those of one place and condition together.
    presets: Vec<Vec<Node>>,
    /// Steps that the program itself resets.
    resets: FxHashSet<Node>,
    /// The charts are drawn, not recovered from code.
    is_drawn: bool,
    /// The program writes step bits in a way that does not tell which.
    writes_anywhere: bool,
    /// The program sets, resets or freezes the chart as a whole (%S21 to %S24).
    is_commanded: bool,
    exprs: Exprs,
    objects: Vec<&'a Object>,
    family: Family,
    lessons: Lessons,
    /// Objects that a receptivity depends on, by groups of objects that share memory.
    supports: Vec<Vec<u32>>,
    /// How many expressions each receptivity is made of.
    weights: Vec<usize>,
    /// By node: the crossings that it is before, and those that it is behind.
    leaving: Vec<Vec<usize>>,
    entering: Vec<Vec<usize>>,
    /// Reads of step bits of this net.
    steps_read: FxHashMap<ExprId, Node>,
    /// Steps that share their number with another one of their chart.
    drawn_twice: FxHashSet<Node>,
}

/// Steps that transitions connect.
#[derive(Debug, Default)]
pub struct Component {
    /// Sorted.
    pub nodes: Vec<Node>,
    pub crossings: Vec<usize>,
    pub initial: Vec<Node>,
    /// By the place of a step: crossings whose first step it is.
    behind: Vec<Vec<usize>>,
}

/// A connected chart with what it reaches.
#[derive(Debug)]
pub struct Part {
    pub component: Component,
    /// From the initial situation, branches of one step apart.
    pub own: Arc<Reached>,
    /// From there and from what the program sets, as receptivities allow. Of most charts the same.
    pub all: Arc<Reached>,
    /// Steps that none of these situations holds. Sorted.
    pub never_active: Vec<Node>,
    /// Once that was asked.
    stuck: OnceCell<Stuck>,
}

/// The charts of a section, and what they reach.
pub struct Study<'p, 'a> {
    pub net: Net<'p, 'a>,
    pub parts: Vec<Part>,
    /// By node: the part that has it.
    part_of: Vec<Option<usize>>,
}

impl<'p, 'a> Study<'p, 'a> {
    /// Of each section with charts.
    pub fn all(program: &'p ProgramIndex<'a>) -> Vec<Self> {
        Net::all(program).into_iter().map(Self::new).collect()
    }

    pub fn new(mut net: Net<'p, 'a>) -> Self {
        let components = net.components();
        let part = |component: Component| {
            let (own, all) = net.reach(&component);
            let never_active = all.never_active(&component);
            Part { component, own, all, never_active, stuck: OnceCell::new() }
        };
        let parts: Vec<Part> = components.into_iter().map(part).collect();
        let mut part_of = vec![None; net.nodes.len()];
        for (at, part) in parts.iter().enumerate() {
            part.component.nodes.iter().for_each(|it| part_of[*it as usize] = Some(at));
        }
        Self { net, parts, part_of }
    }

    /// Whether receptivities of a part can have the values wanted of them in some situation in which all their transitions
    /// are valid, with the values of objects that do it. The other charts of the section are in situations that they reach,
    /// as far as these are known. Never where no situation is such, or a receptivity is not known.
    pub fn can_be(&self, part: &Part, wanted: &[(usize, bool)]) -> Answer {
        let space = self.net.space();
        self.ask(part, wanted, |_| false, |it| space.solve(it))
    }

    /// Whether they never can, where some steps have any state whatever the situation.
    pub fn is_never(&self, part: &Part, wanted: &[(usize, bool)], is_free: impl Fn(Node) -> bool) -> bool {
        let space = self.net.space();
        self.ask(part, wanted, is_free, |it| space.possible(it).into()).is_never()
    }

    /// What is stuck in a part.
    pub fn stuck<'s>(&self, part: &'s Part) -> &'s Stuck {
        part.stuck.get_or_init(|| Stuck::of(self, part))
    }

    /// [`Self::can_be`], by the answers that are given to conditions of one moment.
    fn ask<W>(
        &self,
        part: &Part,
        wanted: &[(usize, bool)],
        is_free: impl Fn(Node) -> bool,
        solve: impl Fn(&[(ExprId, bool)]) -> Answer<W>,
    ) -> Answer<W> {
        /// More ways for the other charts to stand are not told apart.
        const MOST: usize = 256;
        let free = self.net.can_be_beside(part, wanted, &[], &is_free, &solve);
        if !matches!(free, Answer::Possible(_)) {
            return free;
        }
        let beside = self.states_beside(part, wanted, &is_free);
        if beside.is_empty() {
            return free;
        }
        let mut ways: Vec<Vec<(ExprId, bool)>> = vec![Vec::new()];
        for states in beside {
            if states.len() * ways.len() > MOST {
                return free;
            }
            let with = |way: &Vec<(ExprId, bool)>| -> Vec<Vec<(ExprId, bool)>> {
                states.iter().map(|it| way.iter().chain(it).copied().collect()).collect()
            };
            ways = ways.iter().flat_map(with).collect();
        }
        let mut answer = Answer::Never;
        for way in ways {
            match self.net.can_be_beside(part, wanted, &way, &is_free, &solve) {
                Answer::Never => {}
                Answer::NotDecided => answer = Answer::NotDecided,
                found @ Answer::Possible(_) => return found,
            }
        }
        answer
    }

    /// Whether a step of another part is never active: that is a finding of its own there.
    pub fn is_dead_beside(&self, part: &Part, node: Node) -> bool {
        let of = self.part_of.get(node as usize).copied().flatten().and_then(|it| self.parts.get(it));
        of.is_some_and(|it| !std::ptr::eq(it, part) && it.never_active.binary_search(&node).is_ok())
    }

    /// For each other part whose steps the receptivities ask for: the states that these steps can have. Left out where the
    /// program may set them.
    fn states_beside(
        &self,
        part: &Part,
        wanted: &[(usize, bool)],
        is_free: impl Fn(Node) -> bool,
    ) -> Vec<Vec<Vec<(ExprId, bool)>>> {
        let net = &self.net;
        // By part.
        let mut asked: BTreeMap<usize, Vec<(Node, ExprId)>> = BTreeMap::new();
        for (it, _) in wanted.iter().filter(|_| net.is_drawn) {
            let Guarded::By(guard) = net.crossings[*it].guard else { continue };
            net.exprs.each_read(guard, |read| {
                let Some(&node) = net.steps_read.get(&read).filter(|it| !is_free(**it)) else { return };
                let of = self.part_of.get(node as usize).copied().flatten();
                if let Some(of) = of.filter(|it| !std::ptr::eq(&raw const self.parts[*it], part)) {
                    asked.entry(of).or_default().push((node, read));
                }
            });
        }
        let states = |(of, mut asked): (usize, Vec<(Node, ExprId)>)| {
            asked.sort_unstable();
            asked.dedup();
            let (nodes, reads): (Vec<Node>, Vec<ExprId>) = asked.into_iter().unzip();
            let other = &self.parts[of];
            let states = self.states(other, &other.all, &nodes, &[])?;
            Some(states.into_iter().map(|it| reads.iter().copied().zip(it).collect()).collect())
        };
        asked.into_iter().filter_map(states).collect()
    }

    /// The states that some steps of a part have together, in situations with a step of each list of `active`. `None`
    /// where that is not known: the program may set steps, or something was not understood or not looked at to the end.
    pub fn states(&self, part: &Part, reached: &Reached, asked: &[Node], active: &[&[Node]]) -> Option<Vec<Vec<bool>>> {
        /// Of more steps, not every subset is looked at.
        const MOST_STEPS: usize = 6;
        let (net, nodes) = (&self.net, &part.component.nodes);
        let is_set = net.presets.iter().flatten().any(|it| nodes.binary_search(it).is_ok());
        let loses_steps = net.is_commanded || nodes.iter().any(|it| net.resets.contains(it));
        // What nothing starts is in no situation, and its bits are 0: a finding of its own.
        let is_known = self.knows_all() && !reached.is_partial && !reached.situations.is_empty();
        if is_set || !is_known || loses_steps && asked.len() > MOST_STEPS {
            return None;
        }
        let places =
            |all: &[Node]| -> Vec<usize> { all.iter().filter_map(|it| nodes.binary_search(it).ok()).collect() };
        let (asked, active): (Vec<usize>, Vec<Vec<usize>>) =
            (places(asked), active.iter().map(|it| places(it)).collect());
        let mut states: FxHashSet<Vec<bool>> = FxHashSet::default();
        for situation in &reached.situations {
            if !active.iter().all(|it| it.iter().any(|at| has(situation, *at))) {
                continue;
            }
            let state: Vec<bool> = asked.iter().map(|it| has(situation, *it)).collect();
            // What the program resets may be missing from any situation.
            let subsets = if loses_steps { 1 << state.len() } else { 1 };
            states.extend((0..subsets).map(|lost: usize| {
                (0..).zip(&state).map(|(at, it)| *it && lost >> at & 1 == 0).collect::<Vec<bool>>()
            }));
        }
        let mut states: Vec<Vec<bool>> = states.into_iter().collect();
        states.sort_unstable();
        Some(states)
    }

    /// The parts that some steps belong to.
    pub fn parts_of(&self, nodes: impl Iterator<Item = Node>) -> impl Iterator<Item = &Part> {
        let mut parts: Vec<usize> = nodes.filter_map(|it| *self.part_of.get(it as usize)?).collect();
        parts.sort_unstable();
        parts.dedup();
        parts.into_iter().filter_map(|it| self.parts.get(it))
    }

    /// Whether a step that no situation holds is surely never active.
    pub fn knows_all(&self) -> bool {
        !self.net.has_gaps && self.net.knows_presets()
    }
}

impl Part {
    /// The first situation found, of those from the initial one on, in which one step of each list is active, two different
    /// ones. Branches of one step are not taken together in it.
    pub fn active_together(&self, a: &[Node], b: &[Node]) -> Option<(u32, [Node; 2])> {
        let places = |nodes: &[Node]| -> Vec<(usize, Node)> {
            nodes.iter().filter_map(|it| Some((self.component.nodes.binary_search(it).ok()?, *it))).collect()
        };
        let (a, b) = (places(a), places(b));
        if a.is_empty() || b.is_empty() {
            return None;
        }
        (0..).zip(&self.own.situations).find_map(|(at, situation)| {
            let mut active = a.iter().filter(|it| has(situation, it.0));
            let both = active.find_map(|x| Some((x, b.iter().find(|y| y.0 != x.0 && has(situation, y.0))?)));
            both.map(|(x, y)| (at, [x.1, y.1]))
        })
    }
}

/// A set of steps of a component, by their places in it.
pub type Situation = Box<[u64]>;

/// Situations that are reached, in the order in which they were found.
#[derive(Debug, Default)]
pub struct Reached {
    pub situations: Vec<Situation>,
    /// By crossing: the situations in which it is valid.
    valid_in: FxHashMap<usize, Vec<u32>>,
    /// Where each was reached from, by crossing what.
    from: Vec<Option<(u32, Vec<usize>)>>,
    /// Not all situations were looked at.
    pub is_partial: bool,
    /// Branches of one step were taken together.
    takes_branches: bool,
    /// Situations that nothing leaves.
    pub dead: Vec<u32>,
    /// A step that is activated while it is active: in which situation, by crossing what, which step.
    pub lost: Vec<(u32, usize, Node)>,
}

impl Reached {
    /// Steps that no situation holds.
    fn never_active(&self, component: &Component) -> Vec<Node> {
        let mut active = vec![0_u64; component.nodes.len().div_ceil(64)];
        for situation in &self.situations {
            active.iter_mut().zip(situation).for_each(|(all, it)| *all |= it);
        }
        component.nodes.iter().enumerate().filter(|it| !has(&active, it.0)).map(|it| *it.1).collect()
    }
}

impl<'p, 'a> Net<'p, 'a> {
    /// One for each section with charts, in the order of the program.
    pub fn all(program: &'p ProgramIndex<'a>) -> Vec<Self> {
        let mut sections: Vec<Vec<&'p Chart<'a>>> = Vec::new();
        for chart in program.charts() {
            let same =
                |it: &&mut Vec<&Chart<'_>>| it.iter().any(|it| it.task == chart.task && it.section == chart.section);
            match sections.iter_mut().find(same) {
                Some(section) => section.push(chart),
                None => sections.push(vec![chart]),
            }
        }
        sections.into_iter().map(|it| Self::new(program, it)).collect()
    }

    fn new(program: &'p ProgramIndex<'a>, charts: Vec<&'p Chart<'a>>) -> Self {
        let mut net = Self::empty(program.family, charts);
        let mut ids = Ids::default();
        net.cross(|unit, it| ids.of(unit, program.units[unit as usize], it));
        net.objects = ids.objects;
        net.find_steps();
        net.find_supports();
        net.find_presets(program);
        net.is_drawn = true;
        net
    }

    /// Of a chart that was recovered from code. `objects` are those that its receptivities name, `steps` which of them are
    /// the bits of its steps, `presets` the steps that the code itself sets, those of one condition together.
    pub fn recovered(
        family: Family,
        chart: &'p Chart<'a>,
        objects: Vec<&'a Object>,
        steps: &[ObjectId],
        presets: Vec<Vec<Node>>,
    ) -> Self {
        let mut net = Self::empty(family, vec![chart]);
        net.cross(|_, it| it);
        net.objects = objects;
        for (node, &step) in (0..).zip(steps) {
            net.steps_read.extend(net.exprs.find_read(step, 0).map(|it| (it, node)));
        }
        net.find_supports();
        net.presets = presets;
        net
    }

    fn empty(family: Family, charts: Vec<&'p Chart<'a>>) -> Self {
        let has_gaps = charts.iter().any(|it| it.has_gaps);
        let count = |(at, chart): (usize, &&Chart<'_>)| (0..).take(chart.steps.len()).map(move |step| (at, step));
        let nodes: Vec<(usize, u32)> = charts.iter().enumerate().flat_map(count).collect();
        let mut by_name: FxHashMap<(usize, &StepName), Vec<Node>> = FxHashMap::default();
        for (node, &(chart, step)) in (0..).zip(&nodes) {
            if let Some(name) = &charts[chart].steps[step as usize].it.name {
                by_name.entry((chart, name)).or_default().push(node);
            }
        }
        let drawn_twice = by_name.into_values().filter(|it| it.len() > 1).flatten().collect();
        Self {
            charts,
            nodes,
            crossings: Vec::new(),
            has_gaps,
            presets: Vec::new(),
            resets: FxHashSet::default(),
            is_drawn: false,
            writes_anywhere: false,
            is_commanded: false,
            exprs: Exprs::default(),
            objects: Vec::new(),
            lessons: Lessons::default(),
            family,
            supports: Vec::new(),
            weights: Vec::new(),
            leaving: Vec::new(),
            entering: Vec::new(),
            steps_read: FxHashMap::default(),
            drawn_twice,
        }
    }

    fn graph(&self, graph: Graph) -> Option<usize> {
        self.charts.iter().position(|it| it.graph == graph)
    }

    fn node(&self, chart: usize, step: u32) -> Node {
        let before: usize = self.charts[..chart].iter().map(|it| it.steps.len()).sum();
        u32::try_from(before).unwrap_or(u32::MAX).saturating_add(step)
    }

    /// The steps of some names in a graph of a section, where the net has them.
    pub fn named<'s>(
        &self,
        section: (Task, Option<&SmolStr>),
        graph: Graph,
        names: impl Iterator<Item = &'s StepName>,
    ) -> Vec<Node> {
        let is_it = |it: &&Chart<'_>| (it.task, it.section) == section && it.graph == graph;
        let Some((at, chart)) = self.charts.iter().enumerate().find(|it| is_it(it.1)) else { return Vec::new() };
        names.filter_map(|it| Some(self.node(at, chart.step_named(it)?))).collect()
    }

    pub fn step(&self, node: Node) -> &'p Step<'a> {
        let (chart, step) = self.nodes[node as usize];
        &self.charts[chart].steps[step as usize]
    }

    pub fn transition(&self, crossing: usize) -> &'p Transition<'a> {
        let it = &self.crossings[crossing];
        &self.charts[it.chart].transitions[it.transition]
    }

    /// Crossings that a step is before, in the order of the program.
    pub fn leaving(&self, node: Node) -> &[usize] {
        &self.leaving[node as usize]
    }

    /// Crossings that a step is behind, in the order of the program.
    pub fn entering(&self, node: Node) -> &[usize] {
        &self.entering[node as usize]
    }

    /// A step as a message names it: `3`, of an expansion `M2.3`.
    pub fn name(&self, node: Node) -> String {
        let (chart, _) = self.nodes[node as usize];
        let text = &self.step(node).it.text;
        match self.charts[chart].graph {
            Graph::Main => text.to_string(),
            Graph::Macro(number) => format!("M{number}.{text}"),
        }
    }

    pub fn family(&self) -> Family {
        self.family
    }

    /// The step whose bit an object is.
    pub fn node_at(&self, object: &Object) -> Option<Node> {
        step_of(&self.charts, object).map(|(chart, step)| self.node(chart, step))
    }

    /// Whether the program resets a step.
    pub fn is_reset(&self, node: Node) -> bool {
        self.resets.contains(&node)
    }

    pub fn space(&self) -> Space<'_> {
        Space::new(&self.exprs, Objects::Units(&self.objects), self.family).learning(&self.lessons)
    }

    /// `id`: what an object of a unit is called here.
    fn cross(&mut self, mut id: impl FnMut(u32, ObjectId) -> ObjectId) {
        let (mut exprs, mut crossings) = (Exprs::default(), Vec::new());
        for (chart, it) in self.charts.iter().enumerate() {
            // The step of an expansion that stands for a macro-step on one side.
            let inner = |step: u32, end: &StepName| {
                let Some(StepName::Macro(number)) = it.steps[step as usize].it.name else { return None };
                let of = self.graph(Graph::Macro(number))?;
                Some(self.node(of, self.charts[of].step_named(end)?))
            };
            for (transition, crossed) in it.transitions.iter().enumerate().filter(|it| it.1.is_whole) {
                let side = |steps: &[u32], end: StepName| {
                    let mut nodes: Vec<Node> = steps.iter().map(|&it| self.node(chart, it)).collect();
                    nodes.extend(steps.iter().filter_map(|&it| inner(it, &end)));
                    nodes.sort_unstable();
                    nodes.dedup();
                    nodes
                };
                let (from, to) = (side(&crossed.sources, StepName::Out), side(&crossed.targets, StepName::In));
                let guard = match &crossed.it.receptivity {
                    FactReceptivity::Missing => Guarded::Never,
                    FactReceptivity::Unread => Guarded::Unknown,
                    FactReceptivity::Guard(guard) => Guarded::By(exprs.import(guard, |it| id(crossed.unit, it))),
                };
                crossings.push(Crossing { chart, transition, from, to, guard, route: Route::default() });
            }
        }
        (self.exprs, self.crossings) = (exprs, crossings);
        (self.leaving, self.entering) = (vec![Vec::new(); self.nodes.len()], vec![Vec::new(); self.nodes.len()]);
        for (at, it) in self.crossings.iter().enumerate() {
            it.from.iter().for_each(|node| self.leaving[*node as usize].push(at));
            it.to.iter().for_each(|node| self.entering[*node as usize].push(at));
        }
    }

    /// Which receptivities ask for steps.
    fn find_steps(&mut self) {
        for (at, object) in (0..).zip(&self.objects) {
            if let Some(read) = self.exprs.find_read(ObjectId(at), 0)
                && object.class == Class::Step
                && object.is_fixed()
                && let Some(node) = self.node_at(object)
            {
                self.steps_read.insert(read, node);
            }
        }
    }

    fn find_supports(&mut self) {
        // Objects that share memory depend on one another.
        let mut order: Vec<usize> = (0..self.objects.len()).collect();
        order.sort_by_key(|&it| (&self.objects[it].footprint.area, self.objects[it].footprint.start));
        let mut group: Vec<u32> = (0..).take(self.objects.len()).collect();
        let mut last: Option<(usize, u32)> = None;
        for at in order {
            let place = &self.objects[at].footprint;
            let (first, end) = match last {
                Some((first, end)) if self.objects[first].footprint.area == place.area && place.start < end => {
                    (first, end.max(place.end()))
                }
                _ => (at, place.end()),
            };
            group[at] = as_index(first);
            last = Some((first, end));
        }
        let made_of = |it: &Crossing| {
            let (mut objects, mut weight): (Vec<u32>, usize) = (Vec::new(), 1);
            if let Guarded::By(guard) = it.guard {
                self.exprs.each_part(guard, |part| {
                    weight += 1;
                    if let Expr::Read { object, .. } | Expr::Edge { object, .. } = self.exprs.get(part) {
                        objects.extend(group.get(object.0 as usize));
                    }
                });
            }
            objects.sort_unstable();
            objects.dedup();
            (objects, weight)
        };
        (self.supports, self.weights) = self.crossings.iter().map(made_of).unzip();
    }

    fn find_presets(&mut self, program: &ProgramIndex<'a>) {
        let mut presets: FxHashMap<(u32, u32), Vec<Node>> = FxHashMap::default();
        for uses in program.objects_that(|it| matches!(it, Class::System | Class::Step), |_| true) {
            let object = uses.object;
            if object.class == Class::System && object.footprint.area == Area::SystemBits {
                self.is_commanded |= (21..=24).contains(&object.footprint.start) && uses.is_written();
            }
            if object.class != Class::Step || !uses.is_written() {
                continue;
            }
            // Another chart's step is none of ours.
            let step = self.node_at(object);
            self.writes_anywhere |= !object.is_fixed() || object.ty.is_table();
            if let Some(node) = step {
                if uses.has_mode(|it| it.writes() && it != Mode::Set) {
                    self.resets.insert(node);
                }
                for it in uses.with_mode(|it| it.writes() && it != Mode::Reset) {
                    presets.entry((it.unit, it.it.path)).or_default().push(node);
                }
            }
        }
        let mut presets: Vec<((u32, u32), Vec<Node>)> = presets.into_iter().collect();
        presets.sort_unstable();
        self.presets = presets.into_iter().map(|it| it.1).collect();
    }

    /// Whether the program itself puts the chart into situations, or takes it out of some.
    pub fn is_commanded(&self) -> bool {
        self.is_commanded || self.writes_anywhere || !self.presets.is_empty()
    }

    /// Whether which steps the program sets is known.
    pub fn knows_presets(&self) -> bool {
        !self.writes_anywhere
    }

    /// Steps that transitions connect with one another, in the order of their first steps.
    pub fn components(&mut self) -> Vec<Component> {
        let mut parent: Vec<u32> = (0..).take(self.nodes.len()).collect();
        fn root(parent: &mut [u32], mut at: u32) -> u32 {
            while parent[at as usize] != at {
                parent[at as usize] = parent[parent[at as usize] as usize];
                at = parent[at as usize];
            }
            at
        }
        for it in &self.crossings {
            let mut ends = it.from.iter().chain(&it.to);
            let Some(&first) = ends.next() else { continue };
            for &end in ends {
                let (a, b) = (root(&mut parent, first), root(&mut parent, end));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        let mut index: FxHashMap<u32, usize> = FxHashMap::default();
        let mut components: Vec<Component> = Vec::new();
        for node in (0..).take(self.nodes.len()) {
            // A step that is drawn a second time is the first one.
            let (chart, step) = self.nodes[node as usize];
            let name = self.step(node).it.name.as_ref();
            if name.and_then(|it| self.charts[chart].step_named(it)).is_some_and(|it| it != step) {
                continue;
            }
            let of = root(&mut parent, node);
            let at = *index.entry(of).or_insert_with(|| {
                components.push(Component::default());
                components.len() - 1
            });
            components[at].nodes.push(node);
            if self.step(node).it.kind == StepKind::Initial {
                components[at].initial.push(node);
            }
        }
        for (at, it) in self.crossings.iter().enumerate() {
            let of = it.from.first().and_then(|&it| index.get(&root(&mut parent, it)));
            if let Some(&of) = of {
                components[of].crossings.push(at);
            }
        }
        components.iter_mut().for_each(|it| self.find_routes(it));
        components
    }

    fn find_routes(&mut self, component: &mut Component) {
        component.behind = vec![Vec::new(); component.nodes.len()];
        for &at in &component.crossings {
            let it = &self.crossings[at];
            let place = |node: &Node| component.nodes.binary_search(node).ok();
            let mut asked: Vec<(usize, ExprId)> = Vec::new();
            if let Guarded::By(guard) = it.guard {
                self.exprs.each_read(guard, |read| {
                    asked.extend(self.steps_read.get(&read).and_then(place).map(|at| (at, read)));
                });
            }
            asked.sort_unstable();
            let (from, to) = (it.from.iter().filter_map(place).collect(), it.to.iter().filter_map(place).collect());
            let route = Route { from, to, asked };
            if let Some(&first) = route.from.first().filter(|_| it.guard != Guarded::Never) {
                component.behind[first].push(at);
            }
            self.crossings[at].route = route;
        }
    }

    /// What a component reaches from its initial situation when branches of one step are never taken together: that they
    /// can be is a finding of its own, and what follows from it is none. And what it reaches from there and from what the
    /// program sets.
    fn reach(&self, component: &Component) -> (Arc<Reached>, Arc<Reached>) {
        let starts = self.starts(component);
        let all = Arc::new(self.explore(component, &starts, false));
        if starts.len() == 1 && !all.takes_branches {
            return (all.clone(), all);
        }
        (Arc::new(self.explore(component, std::slice::from_ref(&component.initial), true)), all)
    }

    /// What it reaches from there and from what the program sets when branches of one step are never taken together.
    pub fn reach_apart(&self, component: &Component) -> Reached {
        self.explore(component, &self.starts(component), true)
    }

    fn starts(&self, component: &Component) -> Vec<Vec<Node>> {
        let own = |it: &Vec<Node>| -> Vec<Node> {
            it.iter().copied().filter(|it| component.nodes.binary_search(it).is_ok()).collect()
        };
        let presets = self.presets.iter().map(own).filter(|it| !it.is_empty());
        [component.initial.clone()].into_iter().chain(presets).collect()
    }

    fn explore(&self, component: &Component, starts: &[Vec<Node>], apart: bool) -> Reached {
        let walker = Walker { net: self, component, apart, effort: Cell::new(0) };
        let mut reached = Reached::default();
        let mut known: FxHashMap<Situation, u32> = FxHashMap::default();
        let mut lost: FxHashSet<(usize, Node)> = FxHashSet::default();
        let mut cache = Cache::default();
        for start in starts.iter().filter(|it| !it.is_empty()) {
            let situation = walker.situation(start);
            if !known.contains_key(&situation) {
                known.insert(situation.clone(), as_index(reached.situations.len()));
                reached.situations.push(situation);
                reached.from.push(None);
            }
        }
        let (mut next, mut comparisons) = (0, 0_usize);
        while next < reached.situations.len() {
            let at = as_index(next);
            let situation = reached.situations[next].clone();
            next += 1;
            let valid = walker.valid(&situation);
            valid.iter().for_each(|it| reached.valid_in.entry(*it).or_default().push(at));
            comparisons = comparisons.saturating_add(valid.len().saturating_mul(valid.len()));
            if comparisons > MAX_COMPARISONS || walker.effort.get() > MAX_EFFORT {
                reached.is_partial = true;
                return reached;
            }
            let crossed = walker.crossings(&situation, &valid, &mut cache, &mut reached);
            if valid.is_empty() || crossed.is_empty() && !reached.is_partial {
                reached.dead.push(at);
            }
            for set in crossed {
                let after = walker.after(&situation, &set, |crossing, node| {
                    if lost.insert((crossing, node)) {
                        reached.lost.push((at, crossing, node));
                    }
                });
                if known.contains_key(&after) {
                    continue;
                }
                if reached.situations.len() >= MAX_SITUATIONS {
                    reached.is_partial = true;
                    return reached;
                }
                known.insert(after.clone(), as_index(reached.situations.len()));
                reached.situations.push(after);
                reached.from.push(Some((at, set)));
            }
        }
        reached
    }

    /// Active steps of a situation.
    pub fn active<'s>(&self, component: &'s Component, situation: &'s Situation) -> impl Iterator<Item = Node> + 's {
        component.nodes.iter().enumerate().filter(|(at, _)| has(situation, *at)).map(|it| *it.1)
    }

    /// How a situation is reached, in the steps that are active: `0 -> 1 -> 3,4`.
    pub fn trace(&self, component: &Component, reached: &Reached, situation: u32) -> String {
        /// A longer way is told by its ends.
        const LONGEST: usize = 12;
        let mut way = vec![situation];
        while let Some(Some((before, _))) = reached.from.get(way[way.len() - 1] as usize) {
            way.push(*before);
        }
        way.reverse();
        let name = |&it: &u32| {
            let names: Vec<String> =
                self.active(component, &reached.situations[it as usize]).map(|it| self.name(it)).collect();
            if names.is_empty() { "none".to_owned() } else { names.join(",") }
        };
        if way.len() <= LONGEST {
            let names: Vec<String> = way.iter().map(name).collect();
            return names.join(" -> ");
        }
        let (first, last) = (&way[..LONGEST / 2], &way[way.len() - LONGEST / 2..]);
        let [first, last] = [first, last].map(|it| it.iter().map(name).collect::<Vec<_>>().join(" -> "));
        format!("{first} -> ... -> {last}")
    }

    /// Steps of its part whose bits the receptivity of a transition asks for.
    pub fn asked_of(&self, component: &Component, crossing: usize) -> impl Iterator<Item = Node> {
        let asked = self.crossings[crossing].route.asked.iter();
        asked.filter_map(|it| component.nodes.get(it.0).copied())
    }

    /// See [`Study::ask`]; `beside`: what else holds.
    fn can_be_beside<W>(
        &self,
        part: &Part,
        wanted: &[(usize, bool)],
        beside: &[(ExprId, bool)],
        is_free: &impl Fn(Node) -> bool,
        solve: &impl Fn(&[(ExprId, bool)]) -> Answer<W>,
    ) -> Answer<W> {
        let (component, reached) = (&part.component, &part.all);
        let guards: Option<Vec<(ExprId, bool)>> = wanted
            .iter()
            .map(|&(it, value)| match self.crossings[it].guard {
                Guarded::By(guard) => Some((guard, value)),
                Guarded::Never | Guarded::Unknown => None,
            })
            .collect();
        let Some(guards) = guards else { return Answer::Never };
        let crossings: Vec<usize> = wanted.iter().map(|it| it.0).collect();
        let walker = Walker { net: self, component, apart: false, effort: Cell::new(0) };
        let mut asked = walker.asked(&crossings);
        asked.retain(|it| component.nodes.get(it.0).is_none_or(|it| !is_free(*it)));
        let mut seen: FxHashSet<Vec<bool>> = FxHashSet::default();
        let mut answer = Answer::Never;
        let valid_in = crossings.first().and_then(|it| reached.valid_in.get(it)).into_iter().flatten();
        let situations = valid_in
            .map(|it| &reached.situations[*it as usize])
            .filter(|it| crossings.iter().all(|&crossing| walker.is_valid(it, crossing)));
        // Where no step bit is asked for, one situation is as good as any.
        for situation in situations.take(if asked.is_empty() { 1 } else { usize::MAX }) {
            let values: Vec<bool> = asked.iter().map(|it| has(situation, it.0)).collect();
            if !values.is_empty() && !seen.insert(values.clone()) {
                continue;
            }
            let steps = asked.iter().zip(values).map(|(it, value)| (it.1, value));
            let all: Vec<(ExprId, bool)> = guards.iter().chain(beside).copied().chain(steps).collect();
            match solve(&all) {
                Answer::Never => {}
                Answer::NotDecided => answer = Answer::NotDecided,
                found @ Answer::Possible(_) => return found,
            }
        }
        if reached.is_partial && answer.is_never() { Answer::NotDecided } else { answer }
    }

    /// The situations in which a transition is valid, as their active steps.
    pub fn valid_in<'s>(
        &'s self,
        component: &'s Component,
        reached: &'s Reached,
        crossing: usize,
    ) -> impl Iterator<Item = impl Iterator<Item = Node> + 's> + 's {
        let all = reached.valid_in.get(&crossing).into_iter().flatten();
        all.map(|it| self.active(component, &reached.situations[*it as usize]))
    }

    /// Whether a transition is valid in some situation.
    pub fn is_ever_valid(&self, reached: &Reached, crossing: usize) -> bool {
        reached.valid_in.contains_key(&crossing)
    }

    /// Whether some situation holds all of some steps.
    pub fn has_all_active(&self, part: &Part, steps: &[Node]) -> bool {
        let places: Option<Vec<usize>> = steps.iter().map(|it| part.component.nodes.binary_search(it).ok()).collect();
        places.is_some_and(|places| part.all.situations.iter().any(|it| places.iter().all(|place| has(it, *place))))
    }

    /// Whether a step is drawn more than once, so that what leaves it leaves several.
    pub fn is_drawn_twice(&self, node: Node) -> bool {
        self.drawn_twice.contains(&node)
    }

    /// Whether a receptivity says something of an object.
    pub fn has_objects(&self, crossing: usize) -> bool {
        !self.supports[crossing].is_empty()
    }

    /// Steps that a situation does not hold and a transition waits for, and those that it holds.
    pub fn waits(&self, component: &Component, situation: &Situation, crossing: usize) -> (Vec<Node>, Vec<Node>) {
        let active: FxHashSet<Node> = self.active(component, situation).collect();
        self.crossings[crossing].from.iter().partition(|it| !active.contains(it))
    }

    /// Steps that come after some, by crossings other than those of `without`, but not after the step `end`.
    fn after_steps(&self, starts: &[Node], without: &[usize], end: Option<Node>) -> FxHashSet<Node> {
        let mut seen: FxHashSet<Node> = starts.iter().copied().collect();
        let mut stack: Vec<Node> = starts.to_vec();
        while let Some(node) = stack.pop() {
            if Some(node) == end {
                continue;
            }
            for at in self.leaving[node as usize].iter().filter(|it| !without.contains(it)) {
                stack.extend(self.crossings[*at].to.iter().copied().filter(|it| seen.insert(*it)));
            }
        }
        seen
    }

    /// Of a step that is activated while it is active: the transition that opens parallel branches, two of which come
    /// together at the step by transitions of their own, as alternative ones do.
    pub fn opened_in_parallel(&self, component: &Component, step: Node) -> Option<(usize, [usize; 2])> {
        let into = self.entering(step);
        let opens = |it: &&usize| self.crossings[**it].to.len() > 1;
        for &opening in component.crossings.iter().filter(opens).take(MOST_OPENINGS) {
            let branches: Vec<FxHashSet<Node>> =
                self.crossings[opening].to.iter().map(|&it| self.after_steps(&[it], &[opening], Some(step))).collect();
            let leads = |branch: &FxHashSet<Node>, crossing: usize| {
                self.crossings[crossing].from.iter().all(|it| branch.contains(it) && *it != step)
            };
            for (at, &a) in into.iter().enumerate() {
                for &b in &into[at + 1..] {
                    let alone = |x: usize, y: usize| branches.iter().any(|it| leads(it, x) && !leads(it, y));
                    if alone(a, b) && alone(b, a) {
                        return Some((opening, [a, b]));
                    }
                }
            }
        }
        None
    }

    /// Of a transition that waits for steps on several branches: the step whose alternative branches they are.
    pub fn opened_as_alternatives(&self, component: &Component, crossing: usize) -> Option<Node> {
        let from = &self.crossings[crossing].from;
        let opens = |it: &Node| self.leaving(*it).len() > 1;
        component.nodes.iter().copied().filter(opens).take(MOST_OPENINGS).find(|&step| {
            let out: Vec<usize> = self.leaving(step).iter().copied().filter(|it| *it != crossing).collect();
            let branches: Vec<FxHashSet<Node>> =
                out.iter().map(|&it| self.after_steps(&self.crossings[it].to, &[crossing, it], Some(step))).collect();
            // Each branch leads to one of the steps, and none to all of them.
            let found = |it: &FxHashSet<Node>| from.iter().filter(|step| it.contains(step)).count();
            let led: Vec<&FxHashSet<Node>> = branches.iter().filter(|it| found(it) > 0).collect();
            led.len() > 1
                && led.iter().all(|it| found(it) < from.len())
                && from.iter().all(|step| led.iter().any(|it| it.contains(step)))
        })
    }

    /// Whether steps lead back to themselves.
    pub fn has_loop(&self, component: &Component) -> bool {
        // What is left when steps that nothing leads to are taken away again and again.
        let mut into: FxHashMap<Node, usize> = FxHashMap::default();
        for it in component.crossings.iter().map(|it| &self.crossings[*it]) {
            it.to.iter().for_each(|node| *into.entry(*node).or_default() += it.from.len());
        }
        let is_first = |node: &Node| into.get(node).is_none_or(|it| *it == 0);
        let mut open: Vec<Node> = component.nodes.iter().copied().filter(is_first).collect();
        let mut taken = 0;
        while let Some(node) = open.pop() {
            taken += 1;
            for &at in &self.leaving[node as usize] {
                for &next in &self.crossings[at].to {
                    if let Some(count) = into.get_mut(&next) {
                        *count -= 1;
                        if *count == 0 {
                            open.push(next);
                        }
                    }
                }
            }
        }
        taken < component.nodes.len()
    }
}

/// The chart and step that a step bit is of.
fn step_of(charts: &[&Chart<'_>], object: &Object) -> Option<(usize, u32)> {
    charts.iter().enumerate().find_map(|(at, it)| Some((at, it.step_at(&object.footprint)?)))
}

/// Objects of several units as one list.
#[derive(Default)]
struct Ids<'a> {
    objects: Vec<&'a Object>,
    /// Those that several units share, by hash.
    shared: FxHashMap<u64, Vec<ObjectId>>,
    own: FxHashMap<(u32, ObjectId), ObjectId>,
}

impl<'a> Ids<'a> {
    fn of(&mut self, unit: u32, facts: &'a UnitFacts, object: ObjectId) -> ObjectId {
        let Some(fact) = facts.objects.get(object.0 as usize) else { return object };
        let next = ObjectId(as_index(self.objects.len()));
        if facts::is_shared(&fact.object) {
            let same = |it: &&ObjectId| {
                let other = self.objects[it.0 as usize];
                let key = |it: &Object| (it.ty, it.indexed);
                other.footprint == fact.object.footprint && key(other) == key(&fact.object) && !other.indexed
            };
            let list = self.shared.entry(fact.hash).or_default();
            if let Some(&id) = list.iter().find(same) {
                return id;
            }
            list.push(next);
        } else if let Some(&id) = self.own.get(&(unit, object)) {
            return id;
        } else {
            self.own.insert((unit, object), next);
        }
        self.objects.push(&fact.object);
        next
    }
}

/// Groups of what belongs together, directly or through others; each sorted.
fn together(list: &[usize], belongs: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for &it in list {
        let mut joined = vec![it];
        groups.retain_mut(|group| {
            let is_own = group.iter().any(|&other| belongs(it, other));
            if is_own {
                joined.append(group);
            }
            !is_own
        });
        joined.sort_unstable();
        groups.push(joined);
    }
    groups
}

/// Which sets of crossings that depend on one another are possible, by the crossings and the step bits that they ask for.
type Cache = FxHashMap<(Vec<usize>, Vec<bool>), (Vec<Vec<usize>>, bool)>;

struct Walker<'n, 'p, 'a> {
    net: &'n Net<'p, 'a>,
    component: &'n Component,
    /// Branches of one step are not taken together.
    apart: bool,
    /// What the questions so far were made of.
    effort: Cell<usize>,
}

fn has(situation: &[u64], at: usize) -> bool {
    situation.get(at / 64).is_some_and(|it| it >> (at % 64) & 1 == 1)
}

fn as_index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

impl<'n, 'p, 'a> Walker<'n, 'p, 'a> {
    fn situation(&self, nodes: &[Node]) -> Situation {
        let mut situation = vec![0; self.component.nodes.len().div_ceil(64)].into_boxed_slice();
        let places = nodes.iter().filter_map(|it| self.component.nodes.binary_search(it).ok());
        places.for_each(|at| situation[at / 64] |= 1 << (at % 64));
        situation
    }

    fn is_valid(&self, situation: &[u64], crossing: usize) -> bool {
        let from = &self.net.crossings[crossing].route.from;
        !from.is_empty() && from.iter().all(|at| has(situation, *at))
    }

    /// Crossings whose steps are all active, but those that are never crossed.
    fn valid(&self, situation: &[u64]) -> Vec<usize> {
        let mut valid = Vec::new();
        for (word, &bits) in situation.iter().enumerate() {
            let mut bits = bits;
            while bits != 0 {
                let behind = &self.component.behind[word * 64 + bits.trailing_zeros() as usize];
                valid.extend(behind.iter().copied().filter(|it| self.is_valid(situation, *it)));
                bits &= bits - 1;
            }
        }
        valid.sort_unstable();
        valid
    }

    /// Step bits of the component that receptivities ask for: their places, and their reads.
    fn asked(&self, crossings: &[usize]) -> Vec<(usize, ExprId)> {
        let mut asked: Vec<(usize, ExprId)> =
            crossings.iter().flat_map(|it| self.net.crossings[*it].route.asked.iter().copied()).collect();
        asked.sort_unstable();
        asked.dedup();
        asked
    }

    /// Sets of crossings, each of which can be what happens next.
    fn crossings(
        &self,
        situation: &[u64],
        valid: &[usize],
        cache: &mut Cache,
        reached: &mut Reached,
    ) -> Vec<Vec<usize>> {
        let mut free: Vec<Vec<Vec<usize>>> = Vec::new();
        // Of those that depend on one another and cannot all wait, one set or the other happens.
        let mut urgent: Vec<Vec<Vec<usize>>> = Vec::new();
        for cluster in self.clusters(valid) {
            let (sets, is_partial) = self.sets(&cluster, situation, cache);
            reached.is_partial |= is_partial;
            reached.takes_branches |= sets.iter().any(|it| self.takes_branches(it));
            if sets.iter().any(Vec::is_empty) {
                free.push(sets.into_iter().filter(|it| !it.is_empty()).collect());
            } else if !sets.is_empty() {
                urgent.push(sets);
            }
        }
        /// More combinations than this are not looked at.
        const MOST: usize = 256;
        /// Transitions of a small chart.
        const EXACT: usize = 8;
        let mut bases: Vec<Vec<usize>> = vec![Vec::new()];
        for sets in &urgent {
            let combined = bases.iter().flat_map(|base| sets.iter().map(move |it| [base.as_slice(), it].concat()));
            let combined: Vec<Vec<usize>> = combined.take(MOST + 1).collect();
            reached.is_partial |= combined.len() > MOST;
            bases = combined;
        }
        // Those that can wait come one after the other. What comes first may make others valid that do not let the next
        // one come alone: in a small chart they come at once, too.
        let is_small = self.component.crossings.len() <= EXACT;
        let mut with: Vec<Vec<usize>> = Vec::new();
        for sets in &free {
            let also = if is_small { with.clone() } else { Vec::new() };
            with.extend(sets.iter().cloned());
            with.extend(also.iter().flat_map(|one| sets.iter().map(move |it| [one.as_slice(), it].concat())));
            if is_small && with.len() > MOST {
                reached.is_partial = true;
                with.truncate(MOST);
            }
        }
        let alone = bases.iter().filter(|it| !it.is_empty()).cloned();
        let with = bases.iter().flat_map(|base| with.iter().map(move |it| [base.as_slice(), it].concat()));
        alone.chain(with).collect()
    }

    /// Valid crossings that share steps or objects, together.
    fn clusters(&self, valid: &[usize]) -> Vec<Vec<usize>> {
        together(valid, |a, b| {
            let (one, other) = (&self.net.crossings[a], &self.net.crossings[b]);
            let shares = |a: &[u32], b: &[u32]| a.iter().any(|it| b.contains(it));
            // One that fills what the other empties gives another result at once than one after the other.
            shares(&one.from, &other.from)
                || shares(&one.to, &other.to)
                || shares(&one.from, &other.to)
                || shares(&one.to, &other.from)
                || shares(&self.net.supports[a], &self.net.supports[b])
        })
    }

    /// The sets of a cluster that can be true together while the rest of it is not, and whether some were left out.
    ///
    /// Receptivities that share no object are true or not whatever the others are: only those that do are compared.
    fn sets(&self, cluster: &[usize], situation: &[u64], cache: &mut Cache) -> (Vec<Vec<usize>>, bool) {
        /// More sets than this are not looked at.
        const MOST: usize = 64;
        let supports = &self.net.supports;
        let tied = |a: usize, b: usize| supports[a].iter().any(|it| supports[b].contains(it));
        let mut left_out = false;
        let mut sets: Vec<Vec<usize>> = vec![Vec::new()];
        for group in together(cluster, tied) {
            let asked = self.asked(&group);
            let key = (group, asked.iter().map(|it| has(situation, it.0)).collect::<Vec<bool>>());
            let (own, is_partial) = match cache.get(&key) {
                Some(known) => known.clone(),
                None => {
                    let steps: Vec<(ExprId, bool)> = asked.iter().map(|it| it.1).zip(key.1.iter().copied()).collect();
                    let found = self.tied_sets(&key.0, &steps);
                    cache.insert(key, found.clone());
                    found
                }
            };
            left_out |= is_partial;
            let combined = sets.iter().flat_map(|base| own.iter().map(move |it| [base.as_slice(), it].concat()));
            let combined: Vec<Vec<usize>> = combined.take(MOST + 1).collect();
            left_out |= combined.len() > MOST;
            sets = combined;
        }
        // They come by the objects that they ask for.
        sets.iter_mut().for_each(|it| it.sort_unstable());
        if self.apart {
            sets = self.apart(sets);
        }
        (sets, left_out)
    }

    /// The same of receptivities that share objects.
    fn tied_sets(&self, group: &[usize], steps: &[(ExprId, bool)]) -> (Vec<Vec<usize>>, bool) {
        let space = self.net.space();
        /// More than this are not looked at.
        const MANY: usize = 48;
        if group.len() > MANY {
            return (vec![Vec::new()], true);
        }
        let is_small = group.len() <= MAX_TOGETHER;
        let candidates: Vec<Vec<usize>> = if is_small {
            (0..1_usize << group.len())
                .map(|set| group.iter().enumerate().filter(|it| set >> it.0 & 1 == 1).map(|it| *it.1).collect())
                .collect()
        } else {
            let singles = group.iter().map(|it| vec![*it]);
            let pairs = group.iter().enumerate().flat_map(|(at, a)| group[at + 1..].iter().map(|b| vec![*a, *b]));
            [Vec::new()].into_iter().chain(singles).chain(pairs).collect()
        };
        let mut left_out = !is_small;
        let mut sets: Vec<Vec<usize>> = Vec::new();
        let weight: usize = group.iter().map(|it| self.net.weights[*it]).sum();
        for set in candidates {
            let effort = self.effort.get().saturating_add(weight);
            self.effort.set(effort);
            if effort > MAX_EFFORT {
                return (vec![Vec::new()], true);
            }
            let guards = group.iter().filter_map(|it| match self.net.crossings[*it].guard {
                Guarded::By(guard) => Some((guard, set.contains(it))),
                Guarded::Never | Guarded::Unknown => None,
            });
            let wanted: Vec<(ExprId, bool)> = guards.chain(steps.iter().copied()).collect();
            match space.possible(&wanted) {
                Verdict::Never => {}
                Verdict::NotDecided => left_out = true,
                Verdict::Possible => sets.push(set),
            }
        }
        (sets, left_out)
    }

    fn are_branches(&self, a: usize, b: usize) -> bool {
        let [a, b] = [a, b].map(|it| &self.net.crossings[it].from);
        a.iter().any(|it| b.contains(it))
    }

    /// Whether a set crosses two branches of one step.
    fn takes_branches(&self, set: &[usize]) -> bool {
        set.iter().enumerate().any(|(at, &a)| set[..at].iter().any(|&b| self.are_branches(a, b)))
    }

    /// Of sets that cross two branches of one step, what is left when the first of them is taken.
    fn apart(&self, sets: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
        let mut found: Vec<Vec<usize>> = Vec::new();
        for set in sets {
            let mut kept: Vec<usize> = Vec::new();
            for it in set {
                if !kept.iter().any(|&other| self.are_branches(it, other)) {
                    kept.push(it);
                }
            }
            if !found.contains(&kept) {
                found.push(kept);
            }
        }
        found
    }

    /// The situation after some crossings (rules 3 to 5). Tells of each step that is activated while it stays active.
    fn after(&self, situation: &[u64], crossed: &[usize], mut lost: impl FnMut(usize, Node)) -> Situation {
        let mut after: Situation = situation.into();
        for &it in crossed {
            for &at in &self.net.crossings[it].route.from {
                after[at / 64] &= !(1 << (at % 64));
            }
        }
        for &it in crossed {
            for &at in &self.net.crossings[it].route.to {
                if has(&after, at) {
                    lost(it, self.component.nodes[at]);
                }
                after[at / 64] |= 1 << (at % 64);
            }
        }
        after
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fmt::Write as _;

    use proptest::prelude::*;

    use super::*;
    use crate::model::entity::{Part as EntityPart, Task};
    use crate::model::lower;
    use crate::syntax::{self, Language};

    fn with_study<T>(text: &str, look: impl FnOnce(&Study<'_, '_>) -> T) -> T {
        let parse = syntax::parse(Language::Sfc, text);
        assert_eq!(parse.errors(), [], "{text}");
        let part = EntityPart::Chart(String::new().into());
        let entity = crate::model::entity::Entity::Pl7 { task: Task::Mast, section: None, part };
        let facts = UnitFacts::new(&lower::lower(parse.syntax(), text, entity, Language::Sfc));
        let program = ProgramIndex::new(Family::Pl7, vec![&facts]);
        look(&Study::all(&program)[0])
    }

    /// Two branches that ask for steps of another chart, what that chart does with them, and whether both can be taken.
    #[test]
    fn charts_stand_beside_one_another() {
        let loops = "TRANSITION FROM X10 TO X11 := %I2.0; END_TRANSITION\nTRANSITION FROM X11 TO X10 := %I2.1; END_TRANSITION\n";
        let both = "TRANSITION FROM X10 TO (X10,X11) := %I2.0; END_TRANSITION\n";
        let cases = [
            ("%X10", "%X11", loops, "", false),
            ("%X10", "NOT %X11", loops, "", true),
            ("NOT %X10", "NOT %X11", loops, "", false),
            ("%X10", "%X11", both, "", true),
            // Without the chart in any of its situations, without one of its steps, with more steps than it has by itself.
            ("NOT %X10", "NOT %X11", loops, "! SET %S22;\n", true),
            ("%X10", "%X11", loops, "! SET %S22;\n", false),
            ("NOT %X10", "NOT %X11", loops, "! IF %M0 THEN RESET %X11; END_IF;\n", true),
            ("%X10", "%X11", loops, "! IF %M0 THEN SET %X11; END_IF;\n", true),
        ];
        for (a, b, other, preliminary, expected) in cases {
            let chart = format!(
                "INITIAL_STEP X0 : END_STEP\nSTEP X1 : END_STEP\nSTEP X2 : END_STEP\nINITIAL_STEP X10 : END_STEP\nSTEP X11 : \
                 END_STEP\nTRANSITION FROM X0 TO X1 := {a}; END_TRANSITION\nTRANSITION FROM X0 TO X2 := {b}; \
                 END_TRANSITION\nTRANSITION FROM X1 TO X0 := %I1.0; END_TRANSITION\nTRANSITION FROM X2 TO X0 := %I1.1; \
                 END_TRANSITION\n{other}"
            );
            let entity = |address| crate::source::entity_from_address(address).unwrap();
            let unit = |address, text: &str, language| {
                let parse = syntax::parse(language, text);
                assert_eq!(parse.errors(), [], "{text}");
                UnitFacts::new(&lower::lower(parse.syntax(), text, entity(address), language))
            };
            let units = [unit("MAST - CHART", &chart, Language::Sfc), unit("MAST - PRL", preliminary, Language::Pl7St)];
            let program = ProgramIndex::new(Family::Pl7, units.iter().collect());
            let studies = Study::all(&program);
            let study = &studies[0];
            let part = &study.parts[0];
            let leaving = study.net.leaving(part.component.initial[0]);
            let branches: Vec<(usize, bool)> = leaving.iter().map(|it| (*it, true)).collect();
            let can = matches!(study.can_be(part, &branches), Answer::Possible(_));
            assert_eq!(can, expected, "{a}, {b}, {other}{preliminary}");
        }
    }

    type Steps = BTreeSet<String>;

    fn situations(study: &Study<'_, '_>, reached: &Reached, of: &Component) -> BTreeSet<Steps> {
        let names = |it: &Situation| study.net.active(of, it).map(|it| study.net.name(it)).collect();
        reached.situations.iter().map(names).collect()
    }

    /// Inputs, a word, and the chart's own step 1.
    struct Inputs {
        bits: [bool; 3],
        word: i32,
    }

    const RECEPTIVITIES: [&str; 8] = [
        "%I1.0",
        "NOT %I1.0",
        "%I1.1 AND NOT %I1.0",
        "%MW0 > 2",
        "%MW0 <= 2 AND %I1.2",
        "TRUE",
        "%X1",
        "NOT %X1 AND %I1.2",
    ];

    fn holds(receptivity: usize, inputs: &Inputs, steps: &Steps) -> bool {
        let ([a, b, c], one) = (inputs.bits, steps.contains("X1"));
        match receptivity {
            0 => a,
            1 => !a,
            2 => b && !a,
            3 => inputs.word > 2,
            4 => inputs.word <= 2 && c,
            5 => true,
            6 => one,
            _ => !one && c,
        }
    }

    #[derive(Debug, Clone)]
    struct Drawn {
        from: Vec<usize>,
        to: Vec<usize>,
        receptivity: usize,
    }

    fn drawn(steps: usize) -> impl Strategy<Value = Vec<Drawn>> {
        let ends = || prop::collection::btree_set(0..steps, 1..=2).prop_map(|it| it.into_iter().collect::<Vec<_>>());
        let one = (ends(), ends(), 0..RECEPTIVITIES.len());
        prop::collection::vec(one.prop_map(|(from, to, receptivity)| Drawn { from, to, receptivity }), 1..=6)
    }

    fn text(steps: usize, drawn: &[Drawn]) -> String {
        let mut text = String::new();
        for step in 0..steps {
            let word = if step == 0 { "INITIAL_STEP" } else { "STEP" };
            writeln!(text, "{word} X{step} : END_STEP").unwrap();
        }
        let list =
            |steps: &[usize]| format!("({})", steps.iter().map(|it| format!("X{it}")).collect::<Vec<_>>().join(","));
        for it in drawn {
            let (from, to) = (list(&it.from), list(&it.to));
            writeln!(text, "TRANSITION FROM {from} TO {to} := {}; END_TRANSITION", RECEPTIVITIES[it.receptivity])
                .unwrap();
        }
        text
    }

    /// All that scans with any inputs reach, and what of it no scan leaves.
    fn simulate(drawn: &[Drawn]) -> (BTreeSet<Steps>, BTreeSet<Steps>) {
        let name = |it: &usize| format!("X{it}");
        let mut known: BTreeSet<Steps> = BTreeSet::new();
        let mut dead: BTreeSet<Steps> = BTreeSet::new();
        let mut open: Vec<Steps> = vec![["X0".to_owned()].into()];
        while let Some(steps) = open.pop() {
            if !known.insert(steps.clone()) {
                continue;
            }
            let mut moves = false;
            for state in 0..16 {
                let bit = |n: i32| state >> n & 1 == 1;
                let inputs = Inputs { bits: [bit(0), bit(1), bit(2)], word: if bit(3) { 5 } else { 0 } };
                let crossed = |it: &&Drawn| {
                    it.from.iter().all(|it| steps.contains(&name(it))) && holds(it.receptivity, &inputs, &steps)
                };
                let crossed: Vec<&Drawn> = drawn.iter().filter(crossed).collect();
                moves |= !crossed.is_empty();
                let off: Steps = crossed.iter().flat_map(|it| it.from.iter().map(name)).collect();
                let on = crossed.iter().flat_map(|it| it.to.iter().map(name));
                open.push(steps.difference(&off).cloned().chain(on).collect());
            }
            if !moves {
                dead.insert(steps);
            }
        }
        (known, dead)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// What is computed is what running the rules of evolution with all inputs reaches: nothing less, nothing more.
        #[test]
        fn as_the_rules_of_evolution_say(drawn in drawn(5)) {
            let (known, dead) = simulate(&drawn);
            with_study(&text(5, &drawn), |study| {
                let part = study.parts.iter().find(|it| !it.component.initial.is_empty()).unwrap();
                // The steps of another chart are taken as free.
                let knows_step = part.component.nodes.iter().any(|it| study.net.name(*it) == "X1");
                if part.all.is_partial || !knows_step && drawn.iter().any(|it| it.receptivity > 5) {
                    return Ok(());
                }
                prop_assert_eq!(&situations(study, &part.all, &part.component), &known);
                let apart = study.net.reach_apart(&part.component);
                prop_assert_eq!((&apart.situations, &apart.lost), (&part.own.situations, &part.own.lost));
                let found: BTreeSet<Steps> = part.all.dead.iter().map(|&it| {
                    study.net.active(&part.component, &part.all.situations[it as usize]).map(|it| study.net.name(it)).collect()
                }).collect();
                prop_assert_eq!(found, dead);
                Ok(())
            })?;
        }
    }

    /// A chart that is put together correctly.
    #[derive(Debug, Clone)]
    enum Block {
        Step,
        Sequence(Vec<Self>),
        Alternatives(Vec<Self>),
        Parallel(Vec<Self>),
    }

    fn block() -> impl Strategy<Value = Block> {
        Just(Block::Step).prop_recursive(3, 8, 2, |inner| {
            let some = || prop::collection::vec(inner.clone(), 2..=3);
            prop_oneof![
                some().prop_map(Block::Sequence),
                some().prop_map(Block::Alternatives),
                some().prop_map(Block::Parallel),
            ]
        })
    }

    /// What a transition of such a chart asks: a bit of its own, or the value of a word.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    enum Asked {
        Bit(usize),
        Word(u32, usize),
    }

    #[derive(Debug, Clone)]
    struct Arc {
        from: Vec<u32>,
        to: Vec<u32>,
        asked: Asked,
    }

    #[derive(Debug, Clone, Default)]
    struct Writer {
        steps: u32,
        arcs: Vec<Arc>,
        /// The first divergence of a kind is closed as one of the other: parallel, or alternatives.
        wrong: Option<bool>,
        /// That was done.
        broken: bool,
        without_start: bool,
    }

    impl Writer {
        fn step(&mut self) -> u32 {
            self.steps += 1;
            self.steps - 1
        }

        fn transition(&mut self, from: &[u32], to: &[u32], word: Option<(u32, usize)>) {
            let asked = word.map_or(Asked::Bit(self.arcs.len()), |(word, value)| Asked::Word(word, value));
            self.arcs.push(Arc { from: from.to_vec(), to: to.to_vec(), asked });
        }

        /// First and last step.
        fn write(&mut self, block: &Block) -> (u32, u32) {
            match block {
                Block::Step => {
                    let step = self.step();
                    (step, step)
                }
                Block::Sequence(blocks) => {
                    let ends: Vec<(u32, u32)> = blocks.iter().map(|it| self.write(it)).collect();
                    for pair in ends.windows(2) {
                        self.transition(&[pair[0].1], &[pair[1].0], None);
                    }
                    (ends[0].0, ends[ends.len() - 1].1)
                }
                Block::Alternatives(blocks) | Block::Parallel(blocks) => {
                    let is_parallel = matches!(block, Block::Parallel(_));
                    let (first, last) = (self.step(), self.step());
                    let ends: Vec<(u32, u32)> = blocks.iter().map(|it| self.write(it)).collect();
                    let (starts, stops): (Vec<u32>, Vec<u32>) = ends.into_iter().unzip();
                    let is_wrong = self.wrong == Some(is_parallel) && !std::mem::replace(&mut self.broken, true);
                    if is_parallel {
                        self.transition(&[first], &starts, None);
                    } else {
                        let word = self.steps;
                        for (at, &start) in starts.iter().enumerate() {
                            self.transition(&[first], &[start], Some((word, at)));
                        }
                    }
                    if is_parallel != is_wrong {
                        self.transition(&stops, &[last], None);
                    } else {
                        stops.iter().for_each(|&it| self.transition(&[it], &[last], None));
                    }
                    (first, last)
                }
            }
        }

        fn new(block: &Block, wrong: Option<bool>) -> Self {
            let mut writer = Self { wrong, ..Self::default() };
            let (first, last) = writer.write(block);
            let behind = writer.step();
            writer.transition(&[last], &[behind], None);
            writer.transition(&[behind], &[first], None);
            writer
        }

        fn chart(block: &Block, wrong: Option<bool>) -> (String, bool) {
            let writer = Self::new(block, wrong);
            (writer.text(), writer.broken)
        }

        fn text(&self) -> String {
            let mut text = String::new();
            for step in 0..self.steps {
                let word = if step == 0 && !self.without_start { "INITIAL_STEP" } else { "STEP" };
                writeln!(text, "{word} X{step} : END_STEP").unwrap();
            }
            let list = |steps: &[u32]| steps.iter().map(|it| format!("X{it}")).collect::<Vec<_>>().join(",");
            for it in &self.arcs {
                let asked = match it.asked {
                    Asked::Bit(n) => format!("%M{n}"),
                    Asked::Word(word, value) => format!("%MW{word} = {value}"),
                };
                let (from, to) = (list(&it.from), list(&it.to));
                writeln!(text, "TRANSITION FROM ({from}) TO ({to}) := {asked}; END_TRANSITION").unwrap();
            }
            text
        }

        /// Whether the chart has a mistake, found by running it with everything that can be true together. `None` when that
        /// is too much.
        fn is_faulty(&self) -> Option<bool> {
            let mut known: BTreeSet<BTreeSet<u32>> = BTreeSet::new();
            let mut open: Vec<BTreeSet<u32>> = if self.without_start { Vec::new() } else { vec![[0].into()] };
            let mut faulty = false;
            while let Some(active) = open.pop() {
                if !known.insert(active.clone()) {
                    continue;
                }
                let valid: Vec<&Arc> =
                    self.arcs.iter().filter(|it| it.from.iter().all(|it| active.contains(it))).collect();
                if known.len() > 500 || valid.len() > 8 {
                    return None;
                }
                // A chart that ends, and waits for nothing, is meant to.
                let waits = self.arcs.iter().any(|it| it.from.iter().any(|it| active.contains(it)));
                faulty |= valid.is_empty() && (waits || self.has_loop());
                for set in 1..1_usize << valid.len() {
                    let is_in = |at: usize| set >> at & 1 == 1;
                    let agree = |a: usize, b: usize| match (valid[a].asked, valid[b].asked) {
                        (Asked::Bit(x), Asked::Bit(y)) if x == y => is_in(a) == is_in(b),
                        (Asked::Word(x, u), Asked::Word(y, v)) if x == y && u == v => is_in(a) == is_in(b),
                        (Asked::Word(x, _), Asked::Word(y, _)) if x == y => !(is_in(a) && is_in(b)),
                        _ => true,
                    };
                    if !(0..valid.len()).all(|a| (0..a).all(|b| agree(a, b))) {
                        continue;
                    }
                    let crossed: Vec<&Arc> = (0..valid.len()).filter(|it| is_in(*it)).map(|it| valid[it]).collect();
                    let left: Vec<u32> = crossed.iter().flat_map(|it| it.from.iter().copied()).collect();
                    let off: BTreeSet<u32> = left.iter().copied().collect();
                    let mut after: BTreeSet<u32> = active.difference(&off).copied().collect();
                    faulty |= off.len() < left.len();
                    for to in crossed.iter().flat_map(|it| &it.to) {
                        faulty |= !after.insert(*to);
                    }
                    open.push(after);
                }
            }
            let reached: BTreeSet<u32> = known.into_iter().flatten().collect();
            Some(faulty || reached.len() < self.steps as usize)
        }

        fn has_loop(&self) -> bool {
            let leads = |from: u32| self.arcs.iter().filter(move |it| it.from.contains(&from)).flat_map(|it| &it.to);
            (0..self.steps).any(|start| {
                let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
                while let Some(at) = open.pop() {
                    open.extend(leads(at).filter(|it| seen.insert(**it)));
                }
                seen.contains(&start)
            })
        }
    }

    /// A mistake of drawing, at a place that a number chooses; `None` where the chart has no such place.
    #[derive(Debug, Clone, Copy)]
    enum Slip {
        /// A transition is missing.
        Removed,
        /// It leads elsewhere.
        Misled(u32),
        /// It asks what its neighbour asks, behind one step.
        Copied,
        /// It asks what any other asks.
        Shared(usize),
        /// One of the steps behind it, or before it, is forgotten.
        Unopened,
        Unjoined,
        /// It waits for one more step.
        Overjoined(u32),
        /// There is no initial step.
        Unstarted,
    }

    fn slip() -> impl Strategy<Value = Slip> {
        prop_oneof![
            Just(Slip::Removed),
            any::<u32>().prop_map(Slip::Misled),
            Just(Slip::Copied),
            any::<usize>().prop_map(Slip::Shared),
            Just(Slip::Unopened),
            Just(Slip::Unjoined),
            any::<u32>().prop_map(Slip::Overjoined),
            Just(Slip::Unstarted),
        ]
    }

    impl Slip {
        fn make(self, chart: &mut Writer, place: usize) -> Option<()> {
            let count = chart.arcs.len();
            let steps = chart.steps;
            let places = |wanted: &dyn Fn(&Arc) -> bool| {
                let places: Vec<usize> = (0..count).filter(|it| wanted(&chart.arcs[*it])).collect();
                (!places.is_empty()).then(|| places[place % places.len()])
            };
            match self {
                Self::Removed => drop(chart.arcs.remove(place % count)),
                Self::Misled(to) => chart.arcs[place % count].to = vec![to % steps],
                Self::Copied => {
                    let at = places(&|it| chart.arcs.iter().filter(|other| other.from == it.from).count() > 1)?;
                    let from = &chart.arcs[at].from;
                    let other = (0..count).find(|it| *it != at && chart.arcs[*it].from == *from)?;
                    chart.arcs[at].asked = chart.arcs[other].asked;
                }
                Self::Shared(other) => chart.arcs[place % count].asked = chart.arcs[other % count].asked,
                Self::Unopened => {
                    let at = places(&|it| it.to.len() > 1)?;
                    chart.arcs[at].to.pop();
                }
                Self::Unjoined => {
                    let at = places(&|it| it.from.len() > 1)?;
                    chart.arcs[at].from.pop();
                }
                Self::Overjoined(step) => {
                    let from = &mut chart.arcs[place % count].from;
                    from.push(step % steps);
                    from.sort_unstable();
                    from.dedup();
                }
                Self::Unstarted => chart.without_start = true,
            }
            Some(())
        }
    }

    /// What the rules about the structure of charts say.
    fn found(text: &str) -> BTreeSet<&'static str> {
        use crate::db::{self, Input};
        use crate::lint::Settings;
        use crate::source::detect::Dialect;
        let outcome = db::check(vec![Input::from_text("a.sfc", text, Dialect::Sfc)], Settings::default());
        let codes = outcome.diagnostics.iter().map(|it| it.finding.rule.code);
        codes.filter(|it| ["G001", "G007", "G015", "G016", "G017", "G018"].contains(it)).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// A slip of drawing is found, or the chart runs as well without it as any.
        #[test]
        fn slips_are_found(block in block(), slip in slip(), place in any::<usize>()) {
            let mut chart = Writer::new(&block, None);
            prop_assert_eq!(chart.is_faulty().unwrap_or(false), false);
            prop_assume!(slip.make(&mut chart, place).is_some());
            if let Some(is_faulty) = chart.is_faulty() {
                let text = chart.text();
                prop_assert_eq!(!found(&text).is_empty(), is_faulty, "{:?} {:?}\n{}", slip, found(&text), text);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn correct_charts_are_correct(block in block()) {
            let (text, _) = Writer::chart(&block, None);
            with_study(&text, |study| {
                prop_assert_eq!(study.parts.len(), 1);
                let part = &study.parts[0];
                let apart = study.net.reach_apart(&part.component);
                prop_assert_eq!(&apart.situations, &part.own.situations);
                for reached in [&part.own, &part.all] {
                    prop_assert!(!reached.is_partial && reached.dead.is_empty() && reached.lost.is_empty(), "{}", text);
                    let active: BTreeSet<Node> =
                        reached.situations.iter().flat_map(|it| study.net.active(&part.component, it)).collect();
                    prop_assert_eq!(active.len(), part.component.nodes.len());
                }
                for (at, &a) in part.component.crossings.iter().enumerate() {
                    for &b in &part.component.crossings[..at] {
                        let from = &study.net.crossings[b].from;
                        if study.net.crossings[a].from.iter().any(|it| from.contains(it)) {
                            prop_assert!(study.can_be(part, &[(a, true), (b, true)]).is_never());
                        }
                    }
                }
                Ok(())
            })?;
        }

        #[test]
        fn what_is_closed_the_wrong_way_is_found(block in block(), parallel in any::<bool>()) {
            let (text, broken) = Writer::chart(&block, Some(parallel));
            prop_assume!(broken);
            with_study(&text, |study| {
                let part = &study.parts[0];
                let found = if parallel {
                    part.own.lost.iter().any(|it| study.net.opened_in_parallel(&part.component, it.2).is_some())
                } else {
                    part.own.dead.iter().any(|&it| {
                        let situation = &part.own.situations[it as usize];
                        part.component.crossings.iter().any(|&it| {
                            let (missing, held) = study.net.waits(&part.component, situation, it);
                            !missing.is_empty() && !held.is_empty()
                                && study.net.opened_as_alternatives(&part.component, it).is_some()
                        })
                    })
                };
                prop_assert!(found, "{}", text);
                Ok(())
            })?;
        }
    }
}

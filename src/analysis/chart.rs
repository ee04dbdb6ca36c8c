//! Whole charts: the pages of a section joined, through the connectors that lead from one to another.
//!
//! What a unit tells of its part has no position ([`ChartFacts`]). A chart is a graph of its section, the main one or the
//! expansion of a macro-step, over all of its pages; a step is found by its name wherever it is drawn.

use std::ops::Range;

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::Site;
use super::facts::{FactObject, UnitFacts, Use};
use crate::model::UnitModel;
use crate::model::chart::{self, ActionKind, CodeLanguage, ConnectorKind, Graph, Node, Room, StepKind, StepName};
use crate::model::entity::{Entity, Task};
use crate::model::expr::{Expr, Exprs, Guard};
use crate::model::object::{Area, Footprint};
use crate::model::unit::StatementKind;

/// What a unit tells of its part of a chart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChartFacts {
    pub graph: Graph,
    pub steps: Vec<FactStep>,
    pub transitions: Vec<FactTransition>,
    pub connectors: Vec<FactConnector>,
    pub actions: Vec<FactAction>,
    /// Whether the text defines steps, and does not only show the code of one.
    pub defines: bool,
    /// Number of the page, where the unit is one.
    pub page: Option<u32>,
    /// Some of the text was not understood.
    pub has_gaps: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactStep {
    /// `None` where the text lacks it.
    pub name: Option<StepName>,
    /// As written.
    pub text: SmolStr,
    pub kind: StepKind,
    pub anchor: u32,
    /// Whether a comment stands in it.
    pub commented: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactTransition {
    /// Nodes of the unit.
    pub sources: Vec<Node>,
    pub targets: Vec<Node>,
    pub receptivity: FactReceptivity,
    pub room: Option<Room>,
    pub anchor: u32,
}

/// The condition of a transition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FactReceptivity {
    /// Not programmed: always false (PL7:4651).
    Missing,
    /// Not understood, or too large.
    Unread,
    Guard(Guard),
}

impl FactReceptivity {
    fn new(it: chart::Receptivity, exprs: &Exprs) -> Self {
        /// A receptivity of more expressions than this is not looked into.
        const MOST: usize = 1000;
        match it {
            chart::Receptivity::Missing => Self::Missing,
            chart::Receptivity::Unread => Self::Unread,
            chart::Receptivity::Value(value) => exprs.cut(value, MOST).map_or(Self::Unread, Self::Guard),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactConnector {
    pub kind: ConnectorKind,
    /// The step that it names.
    pub name: Option<StepName>,
    /// As written.
    pub text: SmolStr,
    /// Of an origin connector: the steps that it leads to, as indices.
    pub steps: Vec<u32>,
    pub anchor: u32,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactAction {
    /// Steps that run it, as indices, sorted.
    pub steps: Vec<u32>,
    pub kind: Option<ActionKind>,
    /// Of its code; `None` where there is none, or a heading says it.
    pub language: Option<CodeLanguage>,
    /// Places that its code names.
    pub anchors: Range<u32>,
    /// What its last write of each bit says.
    pub left: Vec<Left>,
}

/// What an action leaves a bit at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Left {
    /// Index into [`UnitFacts::objects`].
    pub object: u32,
    /// `None` for a value that is not a constant.
    pub value: Option<bool>,
    /// Whenever the action runs, and not under some condition.
    pub is_sure: bool,
    pub anchor: u32,
}

/// What each action leaves, by the order of its code.
fn left(chart: &chart::Chart, model: &UnitModel) -> FxHashMap<u32, Vec<Left>> {
    let mut constants: FxHashMap<u32, (bool, bool)> = FxHashMap::default();
    for it in &model.statements {
        let (access, value, when) = match it.kind {
            StatementKind::Set { access, when } => (access, true, when),
            StatementKind::Reset { access, when } => (access, false, when),
            StatementKind::Assign { access, value } => match *model.exprs.get(value) {
                Expr::Bool(value) => (access, value, Exprs::TRUE),
                _ => continue,
            },
            _ => continue,
        };
        constants.insert(access, (value, when == Exprs::TRUE));
    }
    let mut left: FxHashMap<u32, Vec<Left>> = FxHashMap::default();
    let mut places: FxHashMap<(u32, u32), usize> = FxHashMap::default();
    for (at, access) in (0..).zip(&model.accesses).filter(|it| it.1.mode.writes()) {
        let Some(action) = chart.action_at(access.anchor) else { continue };
        let constant = constants.get(&at);
        let it = Left {
            object: access.object.0,
            value: constant.map(|it| it.0),
            is_sure: constant.is_some_and(|it| it.1) && access.path == action.path,
            anchor: access.anchor,
        };
        let own = left.entry(action.anchors.start).or_default();
        let place = *places.entry((action.anchors.start, it.object)).or_insert(own.len());
        match own.get_mut(place) {
            Some(before) => *before = it,
            None => own.push(it),
        }
    }
    left
}

impl ChartFacts {
    pub fn new(chart: &chart::Chart, model: &UnitModel) -> Self {
        let (entity, exprs) = (&model.entity, &model.exprs);
        let mut left = left(chart, model);
        let sorted = |steps: &[u32]| {
            let mut steps = steps.to_vec();
            steps.sort_unstable();
            steps
        };
        let mut actions: Vec<FactAction> = chart
            .actions
            .iter()
            .map(|it| FactAction {
                steps: sorted(&it.steps),
                kind: it.kind,
                language: it.language,
                anchors: it.anchors.clone(),
                left: left.remove(&it.anchors.start).filter(|_| !it.anchors.is_empty()).unwrap_or_default(),
            })
            .collect();
        actions.sort_by_key(|it| it.anchors.start);
        Self {
            graph: chart.graph,
            steps: chart
                .steps
                .iter()
                .map(|it| FactStep {
                    name: it.name.clone(),
                    text: it.text.clone(),
                    kind: it.kind,
                    anchor: it.anchor,
                    commented: it.commented,
                })
                .collect(),
            transitions: chart
                .transitions
                .iter()
                .map(|it| FactTransition {
                    sources: it.sources.clone(),
                    targets: it.targets.clone(),
                    receptivity: FactReceptivity::new(it.receptivity, exprs),
                    room: it.room,
                    anchor: it.anchor,
                })
                .collect(),
            connectors: chart
                .connectors
                .iter()
                .map(|it| FactConnector {
                    kind: it.kind,
                    name: it.name.clone(),
                    text: it.text.clone(),
                    steps: it.steps.clone(),
                    anchor: it.anchor,
                })
                .collect(),
            actions,
            defines: chart.steps.iter().any(|it| it.anchor != 0),
            page: chart::place(entity).and_then(|it| it.page),
            has_gaps: chart.has_gaps,
        }
    }

    /// The action whose code holds a place.
    pub fn action_at(&self, anchor: u32) -> Option<&FactAction> {
        let after = self.actions.partition_point(|it| it.anchors.start <= anchor);
        self.actions[..after].last().filter(|it| it.anchors.contains(&anchor))
    }

    fn names(&self, action: &FactAction) -> impl Iterator<Item = &StepName> {
        action.steps.iter().filter_map(|&it| self.steps.get(it as usize)?.name.as_ref())
    }
}

/// Task and section that a unit's chart belongs to.
pub fn section(entity: &Entity) -> Option<(Task, Option<&SmolStr>)> {
    match entity {
        Entity::Pl7 { task, section, .. } => Some((*task, section.as_ref())),
        _ => None,
    }
}

/// Whether two uses stand in actions of one section that are not known to run in one scan: those of different steps, for
/// whether such steps are active together is a matter of the chart's evolution, and those of one step at its deactivation
/// and while it is active.
pub fn in_exclusive_actions(first: &UnitFacts, a: &Use, second: &UnitFacts, b: &Use) -> bool {
    let (Some(one), Some(other)) = (&first.chart, &second.chart) else { return false };
    let (Some(x), Some(y)) = (one.action_at(a.anchor), other.action_at(b.anchor)) else { return false };
    if section(&first.entity).is_none() || section(&first.entity) != section(&second.entity) {
        return false;
    }
    /// Actions of more steps than this are not compared.
    const MOST: usize = 64;
    if one.graph != other.graph || x.steps.len().max(y.steps.len()) > MOST {
        return true;
    }
    let is_active = |it: &FactAction| matches!(it.kind, Some(ActionKind::Activation | ActionKind::Continuous));
    let is_end = |it: &FactAction| it.kind == Some(ActionKind::Deactivation);
    let is_of_one_step = x.steps.len() == 1 && y.steps.len() == 1;
    is_of_one_step && (is_end(x) && is_active(y) || is_active(x) && is_end(y))
        || !one.names(x).any(|it| other.names(y).any(|also| it == also))
}

/// An action of a program.
#[derive(Debug, Clone, Copy)]
pub struct Action<'a> {
    pub unit: u32,
    pub it: &'a FactAction,
}

impl<'a> Action<'a> {
    /// What its last write says of an object of a unit.
    pub fn left(self, units: &[&'a UnitFacts], object: &FactObject) -> Option<&'a Left> {
        let objects = &units.get(self.unit as usize)?.objects;
        self.it.left.iter().find(|it| objects.get(it.object as usize).is_some_and(|it| it.is_same(object)))
    }

    /// Whether a place stands in its code.
    pub fn holds(self, place: Site) -> bool {
        place.unit == self.unit && self.it.anchors.contains(&place.anchor)
    }
}

/// The actions of the steps of a program, whether they stand in the page of their step or under a heading of their own.
#[derive(Debug, Default)]
pub struct Actions<'a>(FxHashMap<StepKey<'a>, Vec<Action<'a>>>);

type StepKey<'a> = (Task, Option<&'a SmolStr>, Graph, &'a StepName);

impl<'a> Actions<'a> {
    pub fn new(units: &[&'a UnitFacts]) -> Self {
        let mut actions: FxHashMap<StepKey<'a>, Vec<Action<'a>>> = FxHashMap::default();
        for (unit, facts) in (0..).zip(units) {
            let (Some(part), Some((task, section))) = (facts.chart.as_deref(), section(&facts.entity)) else {
                continue;
            };
            for it in &part.actions {
                for name in part.names(it) {
                    actions.entry((task, section, part.graph, name)).or_default().push(Action { unit, it });
                }
            }
        }
        Self(actions)
    }

    /// Those of a step, in the order of the program.
    pub fn of(&self, chart: &Chart<'a>, step: u32) -> &[Action<'a>] {
        let name = chart.steps.get(step as usize).and_then(|it| it.it.name.as_ref());
        let key = name.map(|name| (chart.task, chart.section, chart.graph, name));
        key.and_then(|it| self.0.get(&it)).map_or(&[], Vec::as_slice)
    }

    /// The one of a step that runs in some way; `None` where there are several.
    pub fn only(&self, chart: &Chart<'a>, step: u32, kind: ActionKind) -> Option<Action<'a>> {
        let mut found = self.of(chart, step).iter().filter(|it| it.it.kind == Some(kind));
        let first = *found.next()?;
        found.next().is_none().then_some(first)
    }
}

/// A step of a joined chart.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    pub unit: u32,
    pub it: &'a FactStep,
}

impl Step<'_> {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.anchor }
    }
}

/// A transition of a joined chart.
#[derive(Debug, Clone)]
pub struct Transition<'a> {
    pub unit: u32,
    pub it: &'a FactTransition,
    /// Indices into [`Chart::steps`]. Ends that name no step of the chart are left out.
    pub sources: Vec<u32>,
    pub targets: Vec<u32>,
    /// Whether each of its ends is a step of the chart, and it has both.
    pub is_whole: bool,
    /// Where the connectors of its unit begin in [`Chart::connectors`].
    connectors: usize,
}

impl Transition<'_> {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.anchor }
    }
}

/// A connector of a joined chart.
#[derive(Debug, Clone)]
pub struct Connector<'a> {
    pub unit: u32,
    pub it: &'a FactConnector,
    /// Steps that it leads from and to, as indices into [`Chart::steps`].
    pub from: Vec<u32>,
    pub to: Vec<u32>,
}

impl Connector<'_> {
    pub fn name(&self) -> Option<&StepName> {
        self.it.name.as_ref()
    }

    /// Pairs of steps that it joins; `None` stands for a side that is joined with nothing. Of a connector with many steps
    /// on both sides, which is none, the first.
    fn joins(&self) -> impl Iterator<Item = (Option<u32>, Option<u32>)> {
        const MOST: usize = 64;
        let side = |steps: &[u32]| -> Vec<Option<u32>> {
            if steps.is_empty() { vec![None] } else { steps.iter().take(MOST).copied().map(Some).collect() }
        };
        let to = side(&self.to);
        side(&self.from).into_iter().flat_map(move |from| to.clone().into_iter().map(move |to| (from, to)))
    }

    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.anchor }
    }
}

/// A graph of a section, over all its pages.
#[derive(Debug, Clone)]
pub struct Chart<'a> {
    pub task: Task,
    pub section: Option<&'a SmolStr>,
    pub graph: Graph,
    /// In the order of the program.
    pub steps: Vec<Step<'a>>,
    pub transitions: Vec<Transition<'a>>,
    pub connectors: Vec<Connector<'a>>,
    /// Some of its text was not understood, or a page is missing between others: what is absent may be there.
    pub has_gaps: bool,
    by_name: FxHashMap<&'a StepName, u32>,
    /// Connectors that are joined on one side alone.
    loose: FxHashSet<(ConnectorKind, Option<u32>, Option<u32>)>,
}

impl<'a> Chart<'a> {
    /// The connectors that stand in the place of steps before, or behind, a transition, as indices into
    /// [`Self::connectors`].
    pub fn connectors_at(&self, transition: &Transition<'_>, ends: &[Node]) -> Vec<usize> {
        let index = |node: &Node| match node {
            Node::Connector(at) => Some(transition.connectors + *at as usize).filter(|&it| it < self.connectors.len()),
            Node::Step(_) | Node::Named(_) => None,
        };
        ends.iter().filter_map(index).collect()
    }

    /// The first step of a name, an index into [`Self::steps`].
    pub fn step_named(&self, name: &StepName) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    /// The step whose bit or time lies at an address: `%X3`, `%X2.1.T`.
    pub fn step_at(&self, place: &Footprint) -> Option<u32> {
        let name = match &place.area {
            Area::Steps => step_name(self.graph, place.start)?,
            Area::StepTimes => step_name(self.graph, place.start / 16)?,
            Area::MacroSteps => StepName::Macro(place.start),
            Area::Symbol(text) => {
                let name = text.strip_suffix(".x").or_else(|| text.strip_suffix(".t"))?;
                StepName::Symbol(name.into())
            }
            _ => return None,
        };
        self.step_named(&name)
    }

    /// The transitions that leave each step.
    pub fn leaving(&self) -> Vec<Vec<&Transition<'a>>> {
        let mut leaving = vec![Vec::new(); self.steps.len()];
        for it in &self.transitions {
            for &source in &it.sources {
                if let Some(list) = leaving.get_mut(source as usize) {
                    list.push(it);
                }
            }
        }
        leaving
    }

    /// Connectors without the other one of their pair (PL7:4392): one of the other kind that goes on from the same step to
    /// the same step. What a connector is not joined with, because it is misplaced, is not asked for.
    pub fn unpaired(&self) -> impl Iterator<Item = &Connector<'a>> {
        let mut joins: FxHashSet<(ConnectorKind, Option<u32>, Option<u32>)> = FxHashSet::default();
        for it in &self.connectors {
            for (from, to) in it.joins() {
                joins.extend([(from, to), (None, to), (from, None)].map(|(from, to)| (it.it.kind, from, to)));
            }
        }
        let other = |kind| match kind {
            ConnectorKind::Origin => ConnectorKind::Destination,
            ConnectorKind::Destination => ConnectorKind::Origin,
        };
        self.connectors.iter().filter(move |it| {
            let kind = other(it.it.kind);
            let is_met = |(from, to): (Option<u32>, Option<u32>)| {
                // The other one may be the misplaced one.
                let loose = [(kind, from, None), (kind, None, to)];
                joins.contains(&(kind, from, to)) || loose.iter().any(|it| self.loose.contains(it))
            };
            it.name().is_none_or(|name| self.step_named(name).is_none()) || !it.joins().any(is_met)
        })
    }
}

/// The name of a step by its number in [`Area::Steps`], in the graph that has it.
fn step_name(graph: Graph, number: u32) -> Option<StepName> {
    const STRIDE: u32 = 1024;
    let (of, number) = match number / STRIDE {
        0 => (Graph::Main, number),
        stride => (Graph::Macro(stride - 1), number % STRIDE),
    };
    let name = match (of, number) {
        (Graph::Macro(_), 1000) => StepName::In,
        (Graph::Macro(_), 1001) => StepName::Out,
        _ => StepName::Number(number),
    };
    (of == graph).then_some(name)
}

/// The charts of a program, in the order of their first units.
pub fn join<'a>(units: &[&'a UnitFacts]) -> Vec<Chart<'a>> {
    let mut charts: Vec<Chart<'a>> = Vec::new();
    let mut pages: Vec<Vec<u32>> = Vec::new();
    let mut index: FxHashMap<(Task, Option<&SmolStr>, Graph), usize> = FxHashMap::default();
    let mut parts: Vec<(usize, u32, &'a ChartFacts, usize)> = Vec::new();
    for (unit, facts) in (0..).zip(units) {
        let (Some(part), Some((task, section))) = (facts.chart.as_deref(), section(&facts.entity)) else { continue };
        if !part.defines && part.transitions.is_empty() && part.connectors.is_empty() {
            continue;
        }
        let at = *index.entry((task, section, part.graph)).or_insert_with(|| {
            pages.push(Vec::new());
            charts.push(Chart {
                task,
                section,
                graph: part.graph,
                steps: Vec::new(),
                transitions: Vec::new(),
                connectors: Vec::new(),
                has_gaps: false,
                by_name: FxHashMap::default(),
                loose: FxHashSet::default(),
            });
            charts.len() - 1
        });
        let chart = &mut charts[at];
        chart.has_gaps |= part.has_gaps;
        pages[at].extend(part.page);
        let first = chart.steps.len();
        for it in &part.steps {
            if let Some(name) = &it.name {
                let next = u32::try_from(chart.steps.len()).unwrap_or(u32::MAX);
                chart.by_name.entry(name).or_insert(next);
            }
            chart.steps.push(Step { unit, it });
        }
        parts.push((at, unit, part, first));
    }
    for (chart, mut pages) in charts.iter_mut().zip(pages) {
        pages.sort_unstable();
        pages.dedup();
        chart.has_gaps |= pages.last().is_some_and(|&last| last as usize >= pages.len());
    }
    // Ends are looked up when all pages are there.
    for (at, unit, part, first) in parts {
        let chart = &charts[at];
        let resolve = |nodes: &[Node]| -> Vec<Option<u32>> {
            let name = |node: &Node| match node {
                Node::Step(at) => part.steps.get(*at as usize)?.name.clone(),
                Node::Connector(at) => part.connectors.get(*at as usize)?.name.clone(),
                Node::Named(name) => Some(name.clone()),
            };
            nodes.iter().map(|it| chart.step_named(&name(it)?)).collect()
        };
        let transitions: Vec<Transition<'a>> = part
            .transitions
            .iter()
            .map(|it| {
                let (sources, targets) = (resolve(&it.sources), resolve(&it.targets));
                let whole = |ends: &[Option<u32>]| !ends.is_empty() && ends.iter().all(Option::is_some);
                let is_whole = whole(&sources) && whole(&targets);
                let known = |ends: Vec<Option<u32>>| ends.into_iter().flatten().collect();
                let connectors = chart.connectors.len();
                Transition { unit, it, sources: known(sources), targets: known(targets), is_whole, connectors }
            })
            .collect();
        let mut connectors: Vec<Connector<'a>> = part
            .connectors
            .iter()
            .map(|it| {
                let named: Vec<u32> = it.name.as_ref().and_then(|it| chart.step_named(it)).into_iter().collect();
                match it.kind {
                    ConnectorKind::Destination => Connector { unit, it, from: Vec::new(), to: named },
                    ConnectorKind::Origin => {
                        let own =
                            it.steps.iter().filter_map(|&it| chart.steps.get(first + it as usize)?.it.name.as_ref());
                        Connector { unit, it, from: named, to: own.filter_map(|it| chart.step_named(it)).collect() }
                    }
                }
            })
            .collect();
        for transition in &transitions {
            for target in &transition.it.targets {
                if let Node::Connector(at) = target
                    && let Some(connector) = connectors.get_mut(*at as usize)
                {
                    connector.from.extend(&transition.sources);
                }
            }
        }
        for it in connectors.iter().filter(|it| it.from.is_empty() != it.to.is_empty()) {
            charts[at].loose.extend(it.joins().map(|(from, to)| (it.it.kind, from, to)));
        }
        charts[at].connectors.extend(connectors);
        charts[at].transitions.extend(transitions);
    }
    charts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::lower;
    use crate::source::entity_from_address;
    use crate::syntax::{self, Language};

    fn facts(address: &str, text: &str) -> UnitFacts {
        let parse = syntax::parse(Language::Pl7Gr7, text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
        UnitFacts::new(&lower::lower(parse.syntax(), text, entity, Language::Pl7Gr7))
    }

    const FIRST: &str = "PAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) : END_STEP\nTRANSITION (ST) AT (C 0,L 2) : %I1.0 END_TRANSITION\n\
                         STEP 9 AT (C 0,L 3) : END_STEP\nTRANSITION (ST) AT (C 0,L 4) : %I1.1 END_TRANSITION\n\
                         DEST_CONNECTOR 10 AT (C 0,L 5)\nEND_PAGE\n";
    const SECOND: &str = "PAGE 1\nSOURCE_CONNECTOR 9 AT (C 0,L 0)\nSTEP 10 AT (C 0,L 1) : END_STEP\n\
                          TRANSITION (ST) AT (C 0,L 2) : %X10.T > 5 END_TRANSITION\nDEST_CONNECTOR 0 AT (C 0,L 13)\nEND_PAGE\n";

    #[test]
    fn pages_are_joined_through_their_connectors() {
        let units = [facts("MAST - P - CHART - PAGE 0", FIRST), facts("MAST - P - CHART - PAGE 1", SECOND)];
        let units: Vec<&UnitFacts> = units.iter().collect();
        let charts = join(&units);
        let [chart] = &charts[..] else { panic!("one chart") };
        let steps: Vec<_> = chart.steps.iter().map(|it| it.it.text.as_str()).collect();
        assert_eq!(steps, ["0", "9", "10"]);
        let ends: Vec<_> = chart.transitions.iter().map(|it| (&it.sources[..], &it.targets[..], it.is_whole)).collect();
        assert_eq!(ends, [(&[0][..], &[1][..], true), (&[1], &[2], true), (&[2], &[], false)]);
        let unpaired: Vec<_> = chart.unpaired().map(|it| (it.unit, it.it.kind, it.it.text.as_str())).collect();
        assert_eq!(unpaired, [(1, ConnectorKind::Destination, "0")]);
        let footprint = |text: &str| crate::model::object::pl7::parse(text).unwrap().footprint;
        assert_eq!(chart.step_at(&footprint("%X10.T")), Some(2));
        assert_eq!(chart.step_at(&footprint("%X9")), Some(1));
        assert_eq!(chart.step_at(&footprint("%X3.9")), None);
    }

    #[test]
    fn an_expansion_is_a_chart_of_its_own() {
        let text = "PAGE 0\nIN_STEP AT (C 0,L 1)\nTRANSITION (ST) AT (C 0,L 2) : %I1.0 END_TRANSITION\nOUT_STEP AT (C 0,L 3)\nEND_PAGE\n";
        let units = [facts("MAST - P - CHART - PAGE 0", FIRST), facts("MAST - P - MACRO2 - PAGE 0", text)];
        let units: Vec<&UnitFacts> = units.iter().collect();
        let charts = join(&units);
        assert_eq!(charts.iter().map(|it| it.graph).collect::<Vec<_>>(), [Graph::Main, Graph::Macro(2)]);
        assert_eq!((charts[1].step_named(&StepName::In), charts[1].step_named(&StepName::Out)), (Some(0), Some(1)));
        let footprint = |text: &str| crate::model::object::pl7::parse(text).unwrap().footprint;
        assert_eq!(charts[1].step_at(&footprint("%X2.OUT")), Some(1));
        assert!(charts[1].transitions[0].is_whole);
    }

    /// Moving an element in the text, or writing a comment, changes nothing that crosses units.
    #[test]
    fn facts_have_no_position() {
        let moved = FIRST.replace("STEP 9", "\n(* remplissage *)  STEP 9").replace("(C 0,", "(C 3,");
        assert_eq!(facts("MAST - P - CHART", FIRST).chart, facts("MAST - P - CHART", &moved).chart);
    }
}

//! Charts of sequences that a program codes with bits: the steps and transitions that `analysis::sequences` recovered, with
//! what is driven under the steps.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{Action, Item, ItemKind, Picture, pages};
use crate::analysis::program::ProgramIndex;
use crate::analysis::sequences::{Sequence, SequenceTransition, Sequences};
use crate::draw::{Unit, words};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Footprint};
use crate::model::unit::{Pin, StatementKind};

/// The recovered charts of a program, in the order of its scan.
pub(in crate::draw) fn sequences(units: &[Unit<'_>], index: &ProgramIndex<'_>) -> Vec<Picture> {
    let all = index.sequences();
    let Some(trace) = all.trace.as_ref().filter(|_| !all.list.is_empty()) else { return Vec::new() };
    let symbols = symbols(units);
    let mut actions = Actions::new(all);
    for (at, unit) in (0..).zip(units) {
        actions.collect(at, unit.model, index);
    }
    let mut places = Places::new(units);
    let name = |it: ObjectId| trace.object(it).text.as_str();
    let receptivity = |sequence: &Sequence<'_>, it: &SequenceTransition| {
        let text = own_receptivity(units, index, all, sequence, it);
        text.unwrap_or_else(|| match it.found.receptivity {
            Exprs::TRUE => "TRUE".to_owned(),
            it => words::all_of(&trace.exprs, &name, &[it]),
        })
    };
    let build = |sequence| Builder { sequence, symbols: &symbols }.build(index, &actions.of, receptivity);
    let mut pictures: Vec<Picture> = all.list.iter().map(build).collect();
    for (at, sequence) in all.list.iter().enumerate() {
        places.claim(at, all, sequence);
    }
    places.mark(units, &mut pictures);
    pictures.into_iter().map(Picture::laid_out).collect()
}

/// What a transition asks for besides its steps, as the network asks that crosses it. `None` where that does not tell: the
/// scan computes the step in several places.
fn own_receptivity(
    units: &[Unit<'_>],
    index: &ProgramIndex<'_>,
    all: &Sequences<'_>,
    sequence: &Sequence<'_>,
    transition: &SequenceTransition,
) -> Option<String> {
    let site = all.event(transition.found.event())?.site;
    let (unit, facts) = (units.get(site.unit as usize)?, index.units.get(site.unit as usize)?);
    let model = unit.model;
    let (when, path) = model.statements.iter().find_map(|it| match it.kind {
        StatementKind::Set { access, when } | StatementKind::Reset { access, when } => {
            let is_it = model.accesses.get(access as usize).is_some_and(|it| it.anchor == site.anchor);
            is_it.then_some((when, it.path))
        }
        _ => None,
    })?;
    let sources: Vec<&Footprint> =
        transition.found.sources.iter().filter_map(|it| Some(&sequence.steps.get(*it)?.object.footprint)).collect();
    let steps: FxHashSet<ObjectId> = (0..)
        .map(ObjectId)
        .zip(&facts.objects)
        .filter(|it| sources.contains(&&it.1.object.footprint))
        .map(|it| it.0)
        .collect();
    let is_source = |it: &ExprId| matches!(model.exprs.get(*it), Expr::Read { object, .. } if steps.contains(object));
    let mut ways = ways(&model.exprs, &[path, when], &steps);
    ways.retain(|it| it.iter().filter(|it| is_source(it)).count() == sources.len());
    let [way] = &mut ways[..] else { return None };
    way.retain(|it| !is_source(it));
    let name = |it: ObjectId| model.object(it).text.as_str();
    Some(if way.is_empty() { "TRUE".to_owned() } else { words::all_of(&model.exprs, &name, way) })
}

/// The symbol of a place, with its address and its comment.
struct Known<'a> {
    name: &'a str,
    address: &'a str,
    comment: Option<&'a str>,
}

fn symbols<'a>(units: &[Unit<'a>]) -> FxHashMap<&'a Footprint, Known<'a>> {
    let mut known = FxHashMap::default();
    for symbol in units.iter().flat_map(|it| &it.model.symbols) {
        if let Some(object) = &symbol.object {
            let comment = symbol.comment.as_deref().filter(|it| !it.is_empty());
            let it = Known { name: &symbol.name, address: &object.text, comment };
            known.entry(&object.footprint).or_insert(it);
        }
    }
    known
}

struct Builder<'s, 'a> {
    sequence: &'s Sequence<'a>,
    symbols: &'s FxHashMap<&'s Footprint, Known<'s>>,
}

impl Builder<'_, '_> {
    fn build(
        &self,
        index: &ProgramIndex<'_>,
        actions: &FxHashMap<Footprint, Vec<Action>>,
        receptivity: impl Fn(&Sequence<'_>, &SequenceTransition) -> String,
    ) -> Picture {
        let chart = self.sequence.chart();
        let mut items = Vec::with_capacity(self.sequence.steps.len() + self.sequence.transitions.len());
        for (step, drawn) in self.sequence.steps.iter().zip(&chart.steps) {
            let place = &step.object.footprint;
            let kind = ItemKind::Step {
                kind: drawn.it.kind,
                name: drawn.it.text.to_string(),
                actions: actions.get(place).cloned().unwrap_or_default(),
            };
            items.push(item(kind, self.comment(&drawn.it.text, place)));
        }
        let first = u32::try_from(items.len()).unwrap_or(u32::MAX);
        let mut arcs = Vec::new();
        for ((at, drawn), it) in (first..).zip(&chart.transitions).zip(&self.sequence.transitions) {
            let names = |steps: &[u32]| {
                let names = steps.iter().map(|it| self.sequence.name(*it as usize));
                names.collect::<Vec<_>>().join(",")
            };
            let name = format!("{}→{}", names(&drawn.sources), names(&drawn.targets));
            items.push(item(ItemKind::Transition { name, receptivity: Some(receptivity(self.sequence, it)) }, None));
            arcs.extend(drawn.sources.iter().map(|&step| (step, at)));
            arcs.extend(drawn.targets.iter().map(|&step| (at, step)));
        }
        let unit = self.sequence.transitions.first().map_or(0, |it| it.unit);
        let first = self.sequence.steps.first().map_or("", |it| it.fact.text.as_str());
        let title = format!("{} - {first}", index.entity(unit));
        Picture { title, pages: vec![super::Page { items, arcs, ..super::Page::default() }], marks: Vec::new() }
    }

    /// The other name of a step, with the comment of its symbol.
    fn comment(&self, text: &str, place: &Footprint) -> Option<String> {
        let known = self.symbols.get(place)?;
        let is_named = text.trim_matches('"').eq_ignore_ascii_case(known.name);
        let other = if is_named { known.address } else { known.name };
        Some(known.comment.map_or_else(|| other.to_owned(), |it| format!("{other}: {it}")))
    }
}

fn item(kind: ItemKind, comment: Option<String>) -> Item {
    Item { kind, cell: None, comment, marks: Vec::new(), entries: Vec::new() }
}

impl Picture {
    /// The same with its one page laid out.
    fn laid_out(mut self) -> Self {
        for page in std::mem::take(&mut self.pages) {
            let arcs: Vec<(usize, usize)> = page.arcs.iter().map(|it| (it.0 as usize, it.1 as usize)).collect();
            pages(page.items.into_iter().map(|it| (it, None)).collect(), &arcs, false, &mut self);
        }
        self
    }
}

/// What is driven under steps.
struct Actions<'s> {
    steps: FxHashSet<&'s Footprint>,
    of: FxHashMap<Footprint, Vec<Action>>,
}

/// One way for a condition to be true: what is asked for together.
type Way = Vec<ExprId>;

impl<'s> Actions<'s> {
    fn new(all: &'s Sequences<'_>) -> Self {
        let steps = all.list.iter().flat_map(|it| &it.steps).map(|it| &it.object.footprint);
        Self { steps: steps.collect(), of: FxHashMap::default() }
    }

    /// Adds what a unit does when steps are active: outputs, timers, counters, words and calls. Bits of memory are what
    /// transitions and steps are made of.
    fn collect(&mut self, at: u32, model: &UnitModel, index: &ProgramIndex<'_>) {
        let Some(facts) = index.units.get(at as usize) else { return };
        let place = |it: ObjectId| facts.objects.get(it.0 as usize).map(|it| &it.object);
        let step_of = |it: ExprId| match model.exprs.get(it) {
            Expr::Read { object, .. } => place(*object).map(|it| &it.footprint).filter(|it| self.steps.contains(it)),
            _ => None,
        };
        let has_step: FxHashSet<ObjectId> = (0..)
            .map(ObjectId)
            .zip(&facts.objects)
            .filter(|it| self.steps.contains(&it.1.object.footprint))
            .map(|it| it.0)
            .collect();
        if has_step.is_empty() {
            return;
        }
        let mut found: Vec<(Footprint, Action)> = Vec::new();
        for it in &model.statements {
            let (access, when) = match it.kind {
                StatementKind::Assign { access, value } => (Some(access), value),
                StatementKind::Set { access, when }
                | StatementKind::Reset { access, when }
                | StatementKind::Drive { access, when, .. } => (Some(access), when),
                StatementKind::Store { access, .. } => (Some(access), Exprs::TRUE),
                StatementKind::Call(call) => match model.calls.get(call as usize) {
                    Some(call) => (None, call.when),
                    None => continue,
                },
                _ => continue,
            };
            let object = access.and_then(|it| model.accesses.get(it as usize)).map(|it| it.object);
            let is_inner = object.and_then(place).is_some_and(|object| {
                !matches!(it.kind, StatementKind::Store { .. }) && matches!(object.class, Class::Memory | Class::Symbol)
                    || self.steps.contains(&object.footprint)
            });
            if is_inner || it.path == Exprs::FALSE {
                continue;
            }
            let name = || object.map_or("", |it| model.object(it).text.as_str());
            let text = match it.kind {
                StatementKind::Set { .. } => format!("SET {}", name()),
                StatementKind::Reset { .. } => format!("RESET {}", name()),
                StatementKind::Store { value, .. } => format!("{} := {}", name(), words::condition(model, value)),
                StatementKind::Drive { pin, .. } if pin != Pin::Whole => format!("{} {}", name(), pin.describe()),
                StatementKind::Call(call) => {
                    model.calls.get(call as usize).map(|it| it.text.to_string()).unwrap_or_default()
                }
                _ => name().to_owned(),
            };
            for way in ways(&model.exprs, &[it.path, when], &has_step) {
                for (at, step) in way.iter().enumerate().filter_map(|(at, it)| Some((at, step_of(*it)?))) {
                    let mut others = way.clone();
                    others.remove(at);
                    let text = match &others[..] {
                        [] => text.clone(),
                        others => {
                            let name = |it: ObjectId| model.object(it).text.as_str();
                            format!("{text} when {}", words::all_of(&model.exprs, &name, others))
                        }
                    };
                    found.push((step.clone(), Action { qualifier: "N".to_owned(), text }));
                }
            }
        }
        for (step, action) in found {
            let list = self.of.entry(step).or_default();
            if !list.contains(&action) {
                list.push(action);
            }
        }
    }
}

/// The ways in which conditions are true together, as far as they tell steps apart: an alternative that asks for no step
/// stays one part.
fn ways(exprs: &Exprs, all: &[ExprId], steps: &FxHashSet<ObjectId>) -> Vec<Way> {
    /// Of more ways, a condition is taken as one part.
    const MOST: usize = 32;
    let mut ways: Vec<Way> = vec![Vec::new()];
    for part in all.iter().flat_map(|it| chain(exprs, *it, true)) {
        let alternatives: Vec<Way> = match exprs.get(part) {
            Expr::Or(..) => {
                let alternatives = chain(exprs, part, false);
                let all: Vec<Way> = alternatives.into_iter().map(|it| chain(exprs, it, true)).collect();
                let asks = |it: &Way| {
                    it.iter().any(|it| matches!(exprs.get(*it), Expr::Read { object, .. } if steps.contains(object)))
                };
                if all.iter().any(asks) && all.len() * ways.len() <= MOST { all } else { vec![vec![part]] }
            }
            _ => vec![vec![part]],
        };
        let with = |way: &Way| {
            let way = way.clone();
            alternatives.iter().map(move |it| way.iter().chain(it).copied().collect::<Way>()).collect::<Vec<_>>()
        };
        ways = ways.iter().flat_map(with).collect();
    }
    ways
}

/// The parts of a chain of `AND`, or of `OR`, each once, in the order of the text; `TRUE` is no part of the former.
fn chain(exprs: &Exprs, id: ExprId, is_and: bool) -> Vec<ExprId> {
    let mut parts = Vec::new();
    let mut seen = FxHashSet::default();
    let mut open = vec![id];
    while let Some(id) = open.pop() {
        if !seen.insert(id) {
            continue;
        }
        match exprs.get(id) {
            Expr::And(a, b) if is_and => open.extend([*b, *a]),
            Expr::Or(a, b) if !is_and => open.extend([*b, *a]),
            _ if id == Exprs::TRUE && is_and => {}
            _ => parts.push(id),
        }
    }
    parts
}

/// Where the elements of recovered charts stand in the text: at the statements that activate and deactivate steps.
struct Places<'u, 't> {
    units: &'u [Unit<'t>],
    /// By unit: the statements that write, by where they begin, with what they belong to.
    statements: Vec<Vec<(TextRange, Option<Claim>)>>,
}

/// Of a chart, by index: the step that a statement writes, and the transition that it is part of, as items.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Claim {
    picture: usize,
    step: usize,
    transition: usize,
}

impl<'u, 't> Places<'u, 't> {
    fn new(units: &'u [Unit<'t>]) -> Self {
        let written = |unit: &Unit<'t>| {
            let model = unit.model;
            let writes = model.accesses.iter().filter(|it| it.mode.writes());
            let mut all: Vec<_> = writes.map(|it| (model.place(it.anchor), None)).collect();
            all.sort_by_key(|it| (it.0.start(), it.0.end()));
            all.dedup();
            all
        };
        Self { units, statements: units.iter().map(written).collect() }
    }

    /// Notes what a sequence is made of.
    fn claim(&mut self, picture: usize, all: &Sequences<'_>, sequence: &Sequence<'_>) {
        for (transition, it) in (sequence.steps.len()..).zip(&sequence.transitions) {
            for &(step, event) in it.found.sets.iter().chain(&it.found.resets) {
                let Some(site) = all.event(event).map(|it| it.site) else { continue };
                let Some(unit) = self.units.get(site.unit as usize) else { continue };
                let range = unit.model.place(site.anchor);
                let Some(list) = self.statements.get_mut(site.unit as usize) else { continue };
                let at = list.partition_point(|it| it.0.start() < range.start());
                if let Some(place) = list.get_mut(at).filter(|it| it.0 == range) {
                    place.1.get_or_insert(Claim { picture, step, transition });
                }
            }
        }
    }

    /// Gives each element the findings that lie in its code: what is said of a statement that writes a step belongs to that
    /// step, what is said of the condition before it to the transition.
    fn mark(&self, units: &[Unit<'_>], pictures: &mut [Picture]) {
        for (unit, statements) in units.iter().zip(&self.statements) {
            for (range, mark) in unit.marks {
                let at = statements.partition_point(|it| it.0.start() < range.start());
                let Some((place, Some(claim))) = statements.get(at) else { continue };
                let is_step = place.start() == range.start();
                let item = if is_step { claim.step } else { claim.transition };
                let items = pictures.get_mut(claim.picture).and_then(|it| it.pages.first_mut());
                if let Some(item) = items.and_then(|it| it.items.get_mut(item)) {
                    item.marks.push(mark.clone());
                }
            }
        }
    }
}

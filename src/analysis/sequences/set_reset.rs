//! Sequences coded with set and reset (GRF:193-283): a transition is a condition that asks for its step, sets the next one
//! and resets its own.
//!
//! A bit is a step when conditions hand over to it and from it: what sets it resets a bit that the same condition asks for.
//! Latches set by one button and reset by another ask for no bit that they reset, and bits that all lead to one flag, as
//! alarms that an acknowledgement takes back, lead to nothing behind it.

use rustc_hash::{FxHashMap, FxHashSet};

use super::code::How;
use super::trace::{Event, Trace, may_be_bit};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Footprint};

/// A sequence as it was found.
#[derive(Debug, Default)]
pub struct Found {
    /// Bits of the steps, in the order in which the code comes to them.
    pub steps: Vec<ObjectId>,
    pub transitions: Vec<FoundTransition>,
    /// Steps that the code puts without asking for one, those of one condition together: indices into `steps`.
    pub starts: Vec<Vec<usize>>,
    /// Some of those comes in whatever other steps are on: several steps of one branch can be on together.
    pub is_fed: bool,
    /// The scan computes all steps from what they were when it began.
    pub in_tables: bool,
}

/// Steps are indices into [`Found::steps`], events into [`Trace::events`].
#[derive(Debug, Clone)]
pub struct FoundTransition {
    pub sources: Vec<usize>,
    pub targets: Vec<usize>,
    /// Under which the code crosses it.
    pub condition: ExprId,
    /// What it asks for besides its steps.
    pub receptivity: ExprId,
    /// Where its targets go on, and its sources off.
    pub sets: Vec<(usize, usize)>,
    pub resets: Vec<(usize, usize)>,
}

impl FoundTransition {
    /// Its first event.
    pub fn event(&self) -> usize {
        self.sets.iter().chain(&self.resets).map(|it| it.1).min().unwrap_or(0)
    }

    /// Whether one of the steps before it is a step behind it as well.
    pub fn keeps_a_source(&self) -> bool {
        self.sources.iter().any(|it| self.targets.contains(it))
    }

    /// Where it stands: its first set, or its first reset.
    pub fn place(&self) -> usize {
        self.sets.iter().map(|it| it.1).min().unwrap_or_else(|| self.event())
    }

    pub fn set_of(&self, step: usize) -> Option<usize> {
        self.sets.iter().find(|it| it.0 == step).map(|it| it.1)
    }

    pub fn reset_of(&self, step: usize) -> Option<usize> {
        self.resets.iter().find(|it| it.0 == step).map(|it| it.1)
    }
}

/// What is set and reset under one condition.
struct Firing {
    condition: ExprId,
    /// Bits that the condition asks to be 1, with the part of it that asks.
    asks: Vec<(ObjectId, ExprId)>,
    sets: Vec<(ObjectId, usize)>,
    resets: Vec<(ObjectId, usize)>,
}

impl Firing {
    fn asks_for(&self, bit: ObjectId) -> bool {
        self.asks.iter().any(|it| it.0 == bit)
    }

    fn reset_of(&self, bit: ObjectId) -> Option<usize> {
        self.resets.iter().find(|it| it.0 == bit).map(|it| it.1)
    }

    /// From each bit that it asks for and resets, to each other that it sets.
    fn hands_over(&self) -> impl Iterator<Item = (ObjectId, ObjectId)> {
        let from = self.resets.iter().map(|it| it.0).filter(|it| self.asks_for(*it));
        from.flat_map(|from| self.sets.iter().filter(|it| !self.asks_for(it.0)).map(move |to| (from, to.0)))
    }
}

/// All sequences of a scan.
pub fn find(trace: &mut Trace<'_>) -> Vec<Found> {
    let events = trace.events.clone();
    let candidates = candidates(trace, &events);
    let firings = firings(trace, &events, &candidates);
    // Resets that wait for the next step to be on.
    let mut handed: Vec<(ObjectId, ObjectId)> = firings.iter().flat_map(Firing::hands_over).collect();
    let mut apart = by_successor(&firings);
    for &(set, reset, from) in &apart {
        let to = firings[set].sets.iter().map(|it| it.0).find(|it| firings[reset].asks_for(*it));
        handed.extend(to.map(|to| (from, to)));
    }
    for (set, reset, from) in by_common_reset(trace, &firings) {
        handed.extend(firings[set].sets.iter().map(|it| (from, it.0)).filter(|it| it.0 != it.1));
        apart.push((set, reset, from));
    }
    handed.sort_unstable();
    handed.dedup();
    let components = components(&handed);
    let mut component_of: FxHashMap<ObjectId, usize> = FxHashMap::default();
    for (at, component) in components.iter().enumerate() {
        component_of.extend(component.iter().map(|it| (*it, at)));
    }
    let mut handed_in = vec![Vec::new(); components.len()];
    for it in &handed {
        if let Some(&at) = component_of.get(&it.0) {
            handed_in[at].push(*it);
        }
    }
    let mut firings_of = vec![Vec::new(); components.len()];
    for (at, it) in firings.iter().enumerate() {
        let mut of: Vec<usize> =
            it.sets.iter().chain(&it.resets).filter_map(|it| component_of.get(&it.0).copied()).collect();
        of.sort_unstable();
        of.dedup();
        of.into_iter().for_each(|it| firings_of[it].push(at));
    }
    // By the firing that sets.
    apart.sort_unstable();
    let mut found: Vec<Found> = Vec::new();
    for (at, steps) in components.into_iter().enumerate() {
        if is_sequence(steps.len(), &handed_in[at]) {
            let mine = std::mem::take(&mut firings_of[at]);
            found.push(Builder::new(trace, &firings, &apart, steps).build(&mine));
        }
    }
    found.sort_by_key(|it| it.transitions.iter().map(FoundTransition::event).min());
    found
}

/// Bits that are set and reset, and get no value in any other way but as a constant.
fn candidates(trace: &Trace<'_>, events: &[Event]) -> FxHashSet<ObjectId> {
    let is_class = |id: ObjectId| {
        let object = trace.object(id);
        may_be_bit(object)
            && matches!(
                object.class,
                Class::Memory | Class::Data | Class::InstanceData | Class::Symbol | Class::LocalName
            )
    };
    let constant = |it: &Event| {
        let value = it.value.map(|it| trace.exprs.get(it));
        matches!(value, Some(Expr::Int(_) | Expr::Bool(_)))
    };
    let of = |how: How| -> FxHashSet<ObjectId> {
        events.iter().filter(|it| it.how == how && is_class(it.object)).map(|it| it.object).collect()
    };
    let assigned: FxHashSet<ObjectId> =
        events.iter().filter(|it| it.how == How::Assign && !constant(it)).map(|it| it.object).collect();
    let mut stored: Vec<&Footprint> = events
        .iter()
        .filter(|it| it.how == How::Store && !constant(it))
        .map(|it| &trace.object(it.object).footprint)
        .collect();
    stored.sort_unstable();
    stored.dedup();
    let is_stored = |id: &ObjectId| {
        let place = &trace.object(*id).footprint;
        // Words are at most a few bytes: what begins much before does not reach the bit.
        let end = stored.partition_point(|it| (&it.area, it.start) <= (&place.area, place.start));
        stored[..end].iter().rev().take(64).any(|it| it.overlaps(place))
    };
    let (set, reset) = (of(How::Set), of(How::Reset));
    set.intersection(&reset).copied().filter(|it| !assigned.contains(it) && !is_stored(it)).collect()
}

fn firings(trace: &mut Trace<'_>, events: &[Event], candidates: &FxHashSet<ObjectId>) -> Vec<Firing> {
    let mut firings: Vec<Firing> = Vec::new();
    let mut spread: FxHashMap<ExprId, Vec<ExprId>> = FxHashMap::default();
    let mut known: FxHashMap<ExprId, usize> = FxHashMap::default();
    for (at, event) in events.iter().enumerate() {
        if !matches!(event.how, How::Set | How::Reset) || event.when == Exprs::FALSE {
            continue;
        }
        if !candidates.contains(&event.object) {
            continue;
        }
        let ways = spread.entry(event.when).or_insert_with(|| ways(trace, event.when, candidates)).clone();
        for condition in ways {
            let next = firings.len();
            let place = *known.entry(condition).or_insert(next);
            if place == next {
                let asks = asks(trace, condition, candidates);
                firings.push(Firing { condition, asks, sets: Vec::new(), resets: Vec::new() });
            }
            let list = if event.how == How::Set { &mut firings[place].sets } else { &mut firings[place].resets };
            list.push((event.object, at));
        }
    }
    firings
}

/// A condition; where it asks for one step or another, as one condition for each.
fn ways(trace: &mut Trace<'_>, condition: ExprId, candidates: &FxHashSet<ObjectId>) -> Vec<ExprId> {
    /// More ways than this are not told apart.
    const MOST: usize = 32;
    if !asks(trace, condition, candidates).is_empty() {
        return vec![condition];
    }
    let parts = trace.conjuncts(condition);
    let found = parts.iter().enumerate().find_map(|(at, part)| {
        let ways = trace.disjuncts(*part);
        let asks_each = |it: &ExprId| !asks(trace, *it, candidates).is_empty();
        ((2..=MOST).contains(&ways.len()) && ways.iter().any(asks_each)).then_some((at, ways))
    });
    let Some((at, ways)) = found else { return vec![condition] };
    let mut rest = Exprs::TRUE;
    for (_, part) in parts.iter().enumerate().filter(|it| it.0 != at) {
        rest = trace.exprs.and(rest, *part);
    }
    ways.into_iter().map(|it| trace.exprs.and(rest, it)).collect()
}

/// Candidates that a condition asks to be 1: by a read of their own, or of a timer that they start.
fn asks(trace: &Trace<'_>, condition: ExprId, candidates: &FxHashSet<ObjectId>) -> Vec<(ObjectId, ExprId)> {
    let mut asks: Vec<(ObjectId, ExprId)> = Vec::new();
    for part in trace.conjuncts(condition) {
        if let Some(started) = trace.started(part) {
            for it in trace.conjuncts(started) {
                if let Expr::Read { object, .. } = *trace.exprs.get(it)
                    && candidates.contains(&object)
                    && !asks.iter().any(|it| it.0 == object)
                {
                    asks.push((object, part));
                }
            }
        }
        if let Expr::Read { object, .. } = *trace.exprs.get(part)
            && candidates.contains(&object)
        {
            // The read itself says it better than a timer.
            asks.retain(|it| it.0 != object);
            asks.push((object, part));
        }
    }
    asks
}

/// Resets of a step under the next one: which firing sets the next one under the step, which resets the step, and the step.
fn by_successor(firings: &[Firing]) -> Vec<(usize, usize, ObjectId)> {
    let mut setters: FxHashMap<ObjectId, Vec<usize>> = FxHashMap::default();
    for (at, it) in firings.iter().enumerate() {
        it.sets.iter().for_each(|(bit, _)| setters.entry(*bit).or_default().push(at));
    }
    let mut found = Vec::new();
    for (reset, it) in firings.iter().enumerate().filter(|it| it.1.sets.is_empty()) {
        // The next step alone: with more in the condition, it is no longer the next one that takes the step back.
        let [(next, _)] = it.asks[..] else { continue };
        for &(step, _) in it.resets.iter().filter(|it| it.0 != next) {
            for &set in setters.get(&next).into_iter().flatten() {
                if firings[set].asks_for(step) && firings[set].reset_of(step).is_none() {
                    found.push((set, reset, step));
                }
            }
        }
    }
    found
}

/// The same of resets under a condition that holds whenever that of the set does: branches set one by one, and the step
/// before them reset below under all their conditions (GRF:260-265).
fn by_common_reset(trace: &mut Trace<'_>, firings: &[Firing]) -> Vec<(usize, usize, ObjectId)> {
    let mut setters: FxHashMap<ObjectId, Vec<usize>> = FxHashMap::default();
    for (at, it) in firings.iter().enumerate().filter(|it| !it.1.sets.is_empty()) {
        it.asks.iter().for_each(|(bit, _)| setters.entry(*bit).or_default().push(at));
    }
    /// So many pairs are compared.
    const MOST: usize = 10_000;
    let mut pairs = Vec::new();
    for (reset, it) in firings.iter().enumerate().filter(|it| it.1.sets.is_empty()) {
        for &(step, _) in it.resets.iter().filter(|step| it.asks_for(step.0)) {
            for &set in setters.get(&step).into_iter().flatten() {
                if firings[set].reset_of(step).is_none() && pairs.len() < MOST {
                    let conditions = [firings[set].condition, it.condition].map(|it| trace.expand(it));
                    pairs.push((conditions, (set, reset, step)));
                }
            }
        }
    }
    let space = trace.space();
    pairs.retain(|([whole, part], _)| space.implies(*whole, *part));
    pairs.into_iter().map(|it| it.1).collect()
}

/// Bits that hand over to one another, in the order of the program.
fn components(handed: &[(ObjectId, ObjectId)]) -> Vec<Vec<ObjectId>> {
    let mut beside: FxHashMap<ObjectId, Vec<ObjectId>> = FxHashMap::default();
    for &(from, to) in handed {
        beside.entry(from).or_default().push(to);
        beside.entry(to).or_default().push(from);
    }
    let mut seen: FxHashSet<ObjectId> = FxHashSet::default();
    let mut components = Vec::new();
    for &(first, _) in handed {
        let (mut component, mut stack) = (Vec::new(), vec![first]);
        while let Some(bit) = stack.pop() {
            if seen.insert(bit) {
                component.push(bit);
                stack.extend(beside.get(&bit).into_iter().flatten());
            }
        }
        if !component.is_empty() {
            component.sort_unstable();
            components.push(component);
        }
    }
    components
}

/// Whether bits that hand over to one another are steps: two that hand over to each other, or at least three, one of which
/// comes between two others.
fn is_sequence(bits: usize, handed: &[(ObjectId, ObjectId)]) -> bool {
    match bits {
        0 | 1 => false,
        2 => handed.len() == 2,
        _ => {
            let mut from: FxHashMap<ObjectId, Vec<ObjectId>> = FxHashMap::default();
            handed.iter().for_each(|it| from.entry(it.1).or_default().push(it.0));
            handed.iter().any(|it| from.get(&it.0).is_some_and(|before| before.iter().any(|before| *before != it.1)))
        }
    }
}

struct Builder<'t, 'a> {
    trace: &'t mut Trace<'a>,
    firings: &'t [Firing],
    /// Resets under another condition than the set, sorted: see [`by_successor`] and [`by_common_reset`].
    apart: &'t [(usize, usize, ObjectId)],
    steps: Vec<ObjectId>,
    places: FxHashMap<ObjectId, usize>,
}

impl<'t, 'a> Builder<'t, 'a> {
    /// Steps come in the order of their addresses.
    fn new(
        trace: &'t mut Trace<'a>,
        firings: &'t [Firing],
        apart: &'t [(usize, usize, ObjectId)],
        mut steps: Vec<ObjectId>,
    ) -> Self {
        steps.sort_by_key(|it| &trace.object(*it).footprint);
        let places = steps.iter().copied().zip(0..).collect();
        Self { trace, firings, apart, steps, places }
    }

    /// `mine`: the firings that set or reset one of the steps.
    fn build(mut self, mine: &[usize]) -> Found {
        let mut found = Found::default();
        // Resets that belong to sets under other conditions.
        let mut used: FxHashSet<usize> = FxHashSet::default();
        let resets_alone: Vec<usize> =
            mine.iter().copied().filter(|&it| self.own(&self.firings[it].sets).is_empty()).collect();
        for &at in mine {
            let firing = &self.firings[at];
            let sets = self.own(&firing.sets);
            let asks: Vec<usize> = firing.asks.iter().filter_map(|it| self.step(it.0)).collect();
            if sets.is_empty() {
                continue;
            }
            if asks.is_empty() {
                found.starts.push(sets.iter().map(|it| it.0).collect());
                let condition = self.trace.expand(firing.condition);
                let names_step = self.trace.mentions(condition, |it| self.places.contains_key(&it));
                found.is_fed |= !names_step && self.own(&firing.resets).is_empty();
                continue;
            }
            let resets = self.own(&firing.resets);
            let mut resets: Vec<(usize, usize)> = resets.into_iter().filter(|it| asks.contains(&it.0)).collect();
            if resets.is_empty() {
                resets = self.elsewhere(at, &asks, &mut used);
            }
            found.transitions.push(self.transition(firing, &asks, sets, resets));
        }
        // Steps that a sequence leaves to end.
        for at in resets_alone.into_iter().filter(|it| !used.contains(it)) {
            let firing = &self.firings[at];
            let asks: Vec<usize> = firing.asks.iter().filter_map(|it| self.step(it.0)).collect();
            let resets: Vec<(usize, usize)> =
                self.own(&firing.resets).into_iter().filter(|it| asks.contains(&it.0)).collect();
            if !resets.is_empty() {
                found.transitions.push(self.transition(firing, &asks, Vec::new(), resets));
            }
        }
        found.transitions.sort_by_key(FoundTransition::event);
        found.steps = self.steps;
        found
    }

    fn step(&self, bit: ObjectId) -> Option<usize> {
        self.places.get(&bit).copied()
    }

    fn own(&self, bits: &[(ObjectId, usize)]) -> Vec<(usize, usize)> {
        let mut own: Vec<(usize, usize)> = bits.iter().filter_map(|it| Some((self.step(it.0)?, it.1))).collect();
        own.sort_unstable();
        own.dedup_by_key(|it| it.0);
        own
    }

    /// Resets of the steps that a firing asks for which stand under other conditions.
    fn elsewhere(&self, firing: usize, asks: &[usize], used: &mut FxHashSet<usize>) -> Vec<(usize, usize)> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        let first = self.apart.partition_point(|it| it.0 < firing);
        for &(_, reset, bit) in self.apart.iter().skip(first).take_while(|it| it.0 == firing) {
            let (Some(step), Some(event)) = (self.step(bit), self.firings[reset].reset_of(bit)) else { continue };
            if asks.contains(&step) && !found.iter().any(|known| known.0 == step) {
                found.push((step, event));
                used.insert(reset);
            }
        }
        found
    }

    fn transition(
        &mut self,
        firing: &Firing,
        asks: &[usize],
        sets: Vec<(usize, usize)>,
        resets: Vec<(usize, usize)>,
    ) -> FoundTransition {
        // A step that is asked for and stays on is before and behind the transition (GRF:234-239).
        let stays = resets.is_empty();
        let sources: Vec<usize> = if stays { asks.to_vec() } else { resets.iter().map(|it| it.0).collect() };
        let mut targets: Vec<usize> = sets.iter().map(|it| it.0).collect();
        if stays {
            targets.extend(&sources);
        }
        targets.sort_unstable();
        targets.dedup();
        let mut sources = sources;
        sources.sort_unstable();
        let of_source: Vec<ExprId> = firing
            .asks
            .iter()
            .filter(|it| self.step(it.0).is_some_and(|it| sources.contains(&it)))
            .map(|it| it.1)
            .filter(|it| self.trace.started(*it).is_none())
            .collect();
        let mut receptivity = Exprs::TRUE;
        for part in self.trace.conjuncts(firing.condition) {
            if !of_source.contains(&part) {
                receptivity = self.trace.exprs.and(receptivity, part);
            }
        }
        FoundTransition { sources, targets, condition: firing.condition, receptivity, sets, resets }
    }
}

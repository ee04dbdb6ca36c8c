//! Sequences coded with tables of bits (GRF:285-560): the activities of the scan before in one word, those of this scan in
//! another one, and either an equation for each step, or the transitions one by one into a table of activations and one of
//! deactivations, which one word operation combines.
//!
//! Steps are the bits of one rank in these words. What gives the words their parts is what the program does with them: the
//! equation of all steps at once, or at least three steps that hold themselves by the bit of their rank in another word.

use rustc_hash::{FxHashMap, FxHashSet};

use super::code::How;
use super::set_reset::{Found, FoundTransition};
use super::trace::{Event, Trace};
use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs, ObjectId, Operator};
use crate::model::object::{Area, Class, Footprint};
use crate::model::unit::{Mode, Pin};

/// A sequence in tables.
#[derive(Debug)]
pub struct Table {
    pub found: Found,
    pub faults: Vec<Fault>,
}

/// What a program does to tables that it should not.
#[derive(Debug, Clone)]
pub struct Fault {
    pub kind: FaultKind,
    pub site: Site,
    pub message: String,
    pub related: Vec<(Site, String)>,
    /// The table that keeps bits.
    pub table: Option<Footprint>,
}

impl Fault {
    fn new(kind: FaultKind, site: Site, message: String, related: Vec<(Site, String)>) -> Self {
        Self { kind, site, message, related, table: None }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaultKind {
    /// The activities of the scan before are not those.
    Stale,
    /// A table keeps bits of scans before.
    NotCleared,
    /// A force to 0 wins over a force to 1.
    ForcedOff,
    /// A transition that waits for no step is passed by while no step is active.
    PassedBy,
    /// What the steps drive is computed before the steps are.
    Misplaced,
}

/// The words of a sequence: activities of this scan and of the one before; activations and deactivations, where they are.
struct Words {
    now: Footprint,
    before: Footprint,
    on: Option<Footprint>,
    off: Option<Footprint>,
    /// The event that computes all steps at once, and the one before it that used the same tables for another graph.
    equation: Option<usize>,
    since: Option<usize>,
}

/// All sequences in tables of a scan.
pub fn find(program: &ProgramIndex<'_>, trace: &mut Trace<'_>) -> Vec<Table> {
    let mut words: Vec<Words> = Vec::new();
    for (at, event) in trace.events.iter().enumerate().filter(|it| it.1.how == How::Store) {
        let found = event.value.and_then(|it| evolution(trace, it));
        if let Some((on, before, off)) = found.filter(|it| ![it.0, it.1, it.2].contains(&event.object)) {
            let place = |it: ObjectId| trace.object(it).footprint.clone();
            let now = place(event.object);
            if !words.iter().any(|it| it.now == now) {
                let (on, off) = (Some(place(on)), Some(place(off)));
                // Activations and deactivations may be common to all graphs (GRF:1120).
                let since = words.iter().filter(|it| it.on == on || it.off == off).filter_map(|it| it.equation).max();
                words.push(Words { now, before: place(before), on, off, equation: Some(at), since });
            }
        }
    }
    words.extend(by_step(trace));
    words.into_iter().filter_map(|it| Graph { trace, words: it }.build(program)).collect()
}

/// A word as one of an operation.
fn word(trace: &Trace<'_>, value: ExprId) -> Option<ObjectId> {
    match *trace.exprs.get(value) {
        Expr::Read { object, .. } if trace.object(object).footprint.bits > 1 => Some(object),
        _ => None,
    }
}

/// The word whose complement a value is.
fn complement(trace: &Trace<'_>, value: ExprId) -> Option<ObjectId> {
    let Expr::Binary(Operator::Xor, a, b) = *trace.exprs.get(value) else { return None };
    [(a, b), (b, a)].into_iter().find_map(|(of, mask)| {
        let Expr::Int(mask) = *trace.exprs.get(mask) else { return None };
        let of = word(trace, of)?;
        // The table of a document has room for more bits than an operation takes.
        let bits = Some(trace.object(of).footprint.bits).filter(|it| *it <= 32).unwrap_or(16);
        let all = (1_i64 << bits) - 1;
        (mask & all == all).then_some(of)
    })
}

fn operands(trace: &Trace<'_>, value: ExprId, wanted: Operator) -> Option<[(ExprId, ExprId); 2]> {
    match *trace.exprs.get(value) {
        Expr::Binary(op, a, b) if op == wanted => Some([(a, b), (b, a)]),
        _ => None,
    }
}

/// `A OR (B AND NOT C)`: the three words.
fn evolution(trace: &Trace<'_>, value: ExprId) -> Option<(ObjectId, ObjectId, ObjectId)> {
    operands(trace, value, Operator::Or)?.into_iter().find_map(|(one, other)| {
        let one = word(trace, one)?;
        let (kept, taken) = kept(trace, other)?;
        Some((one, word(trace, kept)?, taken))
    })
}

/// `V AND NOT C`: a value and a word.
fn kept(trace: &Trace<'_>, value: ExprId) -> Option<(ExprId, ObjectId)> {
    let all = operands(trace, value, Operator::And)?;
    all.into_iter().find_map(|(kept, taken)| Some((kept, complement(trace, taken)?)))
}

/// Reads of bits in the conjuncts of a condition.
fn reads(trace: &Trace<'_>, condition: ExprId) -> Vec<(ObjectId, ExprId)> {
    let read = |it: ExprId| match *trace.exprs.get(it) {
        Expr::Read { object, .. } if trace.object(object).footprint.bits == 1 => Some((object, it)),
        _ => None,
    };
    trace.conjuncts(condition).into_iter().filter_map(read).collect()
}

/// Words of bits that are assigned one by one, and hold themselves by the bit of the same rank in another word.
fn by_step(trace: &Trace<'_>) -> Vec<Words> {
    /// Fewer steps may hold themselves so by chance.
    const FEWEST: usize = 3;
    // By distance between the two words: bits that are assigned.
    let mut held: FxHashMap<(i64, u32), FxHashSet<ObjectId>> = FxHashMap::default();
    let mut areas: FxHashMap<&Area, u32> = FxHashMap::default();
    for event in trace.events.iter().filter(|it| it.how == How::Assign) {
        let (Some(value), place) = (event.value, &trace.object(event.object).footprint) else { continue };
        let next = u32::try_from(areas.len()).unwrap_or(u32::MAX);
        let area = *areas.entry(&place.area).or_insert(next);
        let ways = trace.disjuncts(value);
        if ways.len() < 2 {
            continue;
        }
        for way in ways {
            let parts = trace.conjuncts(way);
            if !parts.iter().any(|it| matches!(trace.exprs.get(*it), Expr::Not(_))) {
                continue;
            }
            for (bit, _) in reads(trace, way) {
                let of = &trace.object(bit).footprint;
                let distance = i64::from(of.start) - i64::from(place.start);
                if of.area == place.area && distance != 0 && distance % 8 == 0 {
                    held.entry((distance, area)).or_default().insert(event.object);
                }
            }
        }
    }
    let mut found: Vec<((i64, u32), FxHashSet<ObjectId>)> = held.into_iter().collect();
    found.sort_by_key(|it| it.0);
    found
        .into_iter()
        .filter(|it| it.1.len() >= FEWEST)
        .flat_map(|((distance, _), bits)| {
            let places = bits.iter().map(|it| &trace.object(*it).footprint);
            apart(places.collect(), distance).into_iter().map(move |it| (distance, it))
        })
        .filter_map(|(distance, (area, first, last))| {
            let bits = (last / 8 * 8 + 8).checked_sub(first)?;
            let before = u32::try_from(i64::from(first) + distance).ok()?;
            let (now, before) =
                whole(trace, Footprint::new(area.clone(), first, bits), Footprint::new(area, before, bits));
            (!now.overlaps(&before)).then_some(Words { now, before, on: None, off: None, equation: None, since: None })
        })
        .collect()
}

/// The tables that bits lie in, when those of the scan before are so many bits away: a table ends where another one
/// begins. Several graphs have their tables at one distance (GRF:1170).
fn apart(mut places: Vec<&Footprint>, distance: i64) -> Vec<(Area, u32, u32)> {
    places.sort_unstable_by_key(|it| it.start);
    let mut tables: Vec<(Area, u32, u32)> = Vec::new();
    for place in places {
        match tables.last_mut() {
            Some((_, first, last)) if i64::from(place.start) - i64::from(*first) < distance.abs() => {
                *last = place.start
            }
            _ => tables.push((place.area.clone(), place.start / 8 * 8, place.start)),
        }
    }
    tables
}

/// The words around two stretches of one size that the program names as such, else the stretches.
fn whole(trace: &Trace<'_>, now: Footprint, before: Footprint) -> (Footprint, Footprint) {
    let words = || trace.objects.iter().map(|it| &it.footprint).filter(|it| it.bits > 1);
    let pair = words().filter(|it| it.contains(&now)).find_map(|word| {
        let start = (before.start + word.start).checked_sub(now.start)?;
        let other = Footprint::new(before.area.clone(), start, word.bits);
        words().any(|it| *it == other).then(|| (word.clone(), other))
    });
    pair.unwrap_or((now, before))
}

struct Graph<'t, 'a> {
    trace: &'t mut Trace<'a>,
    words: Words,
}

/// A transition while its parts are collected.
#[derive(Default)]
struct Crossed {
    condition: Option<ExprId>,
    sources: FxHashSet<u32>,
    sets: Vec<(u32, usize)>,
    resets: Vec<(u32, usize)>,
    /// What it asks for besides steps.
    rest: Vec<ExprId>,
}

impl Graph<'_, '_> {
    /// Rank of a bit in a word.
    fn rank(&self, word: &Footprint, bit: ObjectId) -> Option<u32> {
        let place = &self.trace.object(bit).footprint;
        (place.bits == 1 && word.contains(place)).then(|| place.start - word.start)
    }

    /// The step that a read is of: its activity now, or in the scan before.
    fn step(&self, bit: ObjectId) -> Option<u32> {
        self.rank(&self.words.before, bit).or_else(|| self.rank(&self.words.now, bit))
    }

    fn build(self, program: &ProgramIndex<'_>) -> Option<Table> {
        let crossed = if self.words.on.is_some() { self.one_by_one() } else { self.step_by_step() };
        let mut ranks: Vec<u32> = crossed
            .iter()
            .flat_map(|it| it.sources.iter().copied().chain(it.sets.iter().chain(&it.resets).map(|it| it.0)))
            .collect();
        ranks.sort_unstable();
        ranks.dedup();
        let is_chart = crossed.iter().filter(|it| !it.sources.is_empty() && !it.sets.is_empty()).count() >= 2;
        if !is_chart || ranks.len() < 2 {
            return None;
        }
        let mut faults = self.faults(&crossed);
        faults.extend(self.misplaced(program));
        let bit = |rank: u32| {
            let words = [&self.words.now, &self.words.before].into_iter().chain(&self.words.on).chain(&self.words.off);
            let mut places = words.map(|it| Footprint::new(it.area.clone(), it.start + rank, 1));
            places.find_map(|place| {
                let at = self.trace.objects.iter().position(|it| it.is_bit() && it.footprint == place)?;
                Some(ObjectId(u32::try_from(at).ok()?))
            })
        };
        let steps: Vec<ObjectId> = ranks.iter().map(|it| bit(*it)).collect::<Option<_>>()?;
        let place = |rank: &u32| ranks.binary_search(rank).unwrap_or(0);
        let mut transitions: Vec<FoundTransition> = Vec::new();
        let mut starts: Vec<Vec<usize>> = Vec::new();
        for it in crossed {
            let list = |all: &[(u32, usize)]| all.iter().map(|it| (place(&it.0), it.1)).collect::<Vec<_>>();
            let (sets, resets) = (list(&it.sets), list(&it.resets));
            let mut targets: Vec<usize> = sets.iter().map(|it| it.0).collect();
            let mut sources: Vec<usize> = it.sources.iter().map(place).collect();
            sources.sort_unstable();
            targets.sort_unstable();
            targets.dedup();
            if sources.is_empty() {
                starts.push(targets);
                continue;
            }
            let receptivity = it.rest.iter().fold(Exprs::TRUE, |all, it| self.trace.exprs.and(all, *it));
            let condition = it.condition.unwrap_or(receptivity);
            transitions.push(FoundTransition { sources, targets, condition, receptivity, sets, resets });
        }
        transitions.sort_by_key(FoundTransition::event);
        Some(Table { found: Found { steps, transitions, starts, is_fed: false, in_tables: true }, faults })
    }

    /// Transitions that set bits in the tables of activations and deactivations (GRF:440-520).
    fn one_by_one(&self) -> Vec<Crossed> {
        let mut crossed: Vec<Crossed> = Vec::new();
        let mut known: FxHashMap<ExprId, usize> = FxHashMap::default();
        let is_mine =
            |at: usize| self.words.since.is_none_or(|it| it < at) && self.words.equation.is_none_or(|it| at < it);
        let events = || self.trace.events.iter().enumerate().filter(|it| it.1.how == How::Set);
        // Sets behind the equation are of the next scan, where no other graph has the tables.
        let shared = self.words.since.is_some() || self.others_follow();
        for (at, event) in events().filter(|it| !shared || is_mine(it.0)) {
            let rank = |word: &Option<Footprint>| self.rank(word.as_ref()?, event.object);
            let (on, off) = (rank(&self.words.on), rank(&self.words.off));
            if on.is_none() && off.is_none() {
                continue;
            }
            let next = crossed.len();
            let place = *known.entry(event.when).or_insert(next);
            if place == next {
                let (sources, rest) = self.split(event.when);
                crossed.push(Crossed { condition: Some(event.when), sources, rest, ..Crossed::default() });
            }
            crossed[place].sets.extend(on.map(|it| (it, at)));
            crossed[place].resets.extend(off.map(|it| (it, at)));
        }
        crossed
    }

    /// Whether another graph uses the same tables after this one.
    fn others_follow(&self) -> bool {
        let mut later = self.trace.events.iter().skip(self.words.equation.map_or(0, |it| it + 1));
        later.any(|it| {
            let found = it.value.and_then(|it| evolution(self.trace, it));
            let place = |it: ObjectId| Some(&self.trace.object(it).footprint);
            found.is_some_and(|it| place(it.0) == self.words.on.as_ref() || place(it.2) == self.words.off.as_ref())
        })
    }

    /// Steps that a condition asks for, and the rest of it.
    fn split(&self, condition: ExprId) -> (FxHashSet<u32>, Vec<ExprId>) {
        let (mut sources, mut rest) = (FxHashSet::default(), Vec::new());
        for part in self.trace.conjuncts(condition) {
            let step = match *self.trace.exprs.get(part) {
                Expr::Read { object, .. } => self.step(object),
                _ => None,
            };
            match step {
                Some(step) => {
                    sources.insert(step);
                }
                None => rest.push(part),
            }
        }
        (sources, rest)
    }

    /// Equations of steps: what activates each, or what it is held by (GRF:313-380).
    fn step_by_step(&self) -> Vec<Crossed> {
        let mut crossed: FxHashMap<Vec<ExprId>, Crossed> = FxHashMap::default();
        for (at, event) in self.trace.events.iter().enumerate().filter(|it| it.1.how == How::Assign) {
            let (Some(target), Some(value)) = (self.rank(&self.words.now, event.object), event.value) else { continue };
            for way in self.trace.disjuncts(value) {
                let (sources, rest) = self.split(way);
                if sources.contains(&target) || sources.is_empty() {
                    continue;
                }
                let mut parts = self.trace.conjuncts(way);
                parts.sort_unstable();
                let it = crossed.entry(parts).or_insert_with(|| Crossed {
                    condition: Some(way),
                    sources: sources.clone(),
                    rest,
                    ..Crossed::default()
                });
                it.sets.push((target, at));
                it.resets.extend(sources.into_iter().map(|it| (it, at)));
            }
        }
        let mut crossed: Vec<Crossed> = crossed.into_values().collect();
        for it in &mut crossed {
            it.resets.sort_unstable();
            it.resets.dedup_by_key(|it| it.0);
        }
        crossed.sort_by_key(|it| it.sets.first().map(|it| it.1));
        crossed
    }

    // What is wrong with them.

    fn faults(&self, crossed: &[Crossed]) -> Vec<Fault> {
        let mut faults = Vec::new();
        faults.extend(self.stale(crossed));
        for word in [&self.words.on, &self.words.off].into_iter().flatten() {
            faults.extend(self.not_cleared(word, self.words.since, self.words.equation));
        }
        for (at, event) in self.trace.events.iter().enumerate() {
            if event.how == How::Store && self.trace.object(event.object).footprint == self.words.now {
                faults.extend(self.forcing(at, event));
            }
        }
        faults.extend(crossed.iter().filter_map(|it| self.passed_by(it)));
        let mut tables: Vec<Footprint> = Vec::new();
        for part in crossed.iter().flat_map(|it| &it.rest) {
            if let Expr::Read { object, .. } = *self.trace.exprs.get(*part) {
                let holds = |it: &&Event| {
                    let word = &self.trace.object(it.object).footprint;
                    it.how == How::Store && word.bits > 1 && word.contains(&self.trace.object(object).footprint)
                };
                // A table of receptivities is one that is looked at as a whole, or cleared as a whole.
                let cleared = self.trace.events.iter().find(holds);
                let word = cleared.map(|it| &self.trace.object(it.object).footprint).or_else(|| self.compared(object));
                if let Some(word) = word.filter(|it| !tables.contains(it)) {
                    tables.push(word.clone());
                }
            }
        }
        for word in tables {
            faults.extend(self.not_cleared(&word, None, None));
        }
        faults
    }

    /// A word around a bit that some path compares as a whole.
    fn compared(&self, bit: ObjectId) -> Option<&Footprint> {
        let place = &self.trace.object(bit).footprint;
        let words = self.trace.objects.iter().filter(|it| it.footprint.bits > 1 && it.footprint.contains(place));
        words.map(|it| &it.footprint).find(|word| **word != self.words.now && **word != self.words.before)
    }

    fn text(&self, word: &Footprint) -> String {
        let found = self.trace.objects.iter().find(|it| it.footprint == *word);
        found.map_or_else(|| "the table".to_owned(), |it| format!("`{}`", it.text))
    }

    fn stale(&self, crossed: &[Crossed]) -> Option<Fault> {
        let (now, before) = (&self.words.now, &self.words.before);
        let events = &self.trace.events;
        let writes_before = |it: &&(usize, &Event)| self.trace.object(it.1.object).footprint.overlaps(before);
        let is_copy = |it: &(usize, &Event)| {
            let place = &self.trace.object(it.1.object).footprint;
            let from = it.1.value.and_then(|it| word(self.trace, it)).map(|it| &self.trace.object(it).footprint);
            // A table of several words is copied word by word.
            it.1.how == How::Store
                && from.is_some_and(|from| {
                    from.area == now.area
                        && i64::from(place.start) - i64::from(from.start)
                            == i64::from(before.start) - i64::from(now.start)
                })
        };
        let first = crossed.iter().flat_map(|it| it.sets.iter().chain(&it.resets)).map(|it| it.1).min()?;
        let end = crossed.iter().flat_map(|it| it.sets.iter().map(|it| it.1)).chain(self.words.equation).max()?;
        let place = events.get(self.words.equation.unwrap_or(first))?.site;
        let all: Vec<(usize, &Event)> = events.iter().enumerate().collect();
        let copy = all.iter().filter(writes_before).find(|it| is_copy(it));
        let (name, of) = (self.text(before), self.text(now));
        let what = "the table of the scan before";
        let fault = |site, message, related| Fault::new(FaultKind::Stale, site, message, related);
        let Some(copy) = copy else {
            return Some(fault(place, format!("{what}, {name}, is not copied from {of} in the scan"), Vec::new()));
        };
        if copy.0 > first {
            let related = vec![(place, "the steps are computed here".to_owned())];
            return Some(fault(
                copy.1.site,
                format!("{what}, {name}, is copied after the steps are computed"),
                related,
            ));
        }
        let late = all.iter().filter(writes_before).find(|it| it.0 > copy.0 && (it.0 < end || !is_copy(it)))?;
        let related = vec![(copy.1.site, "copied here".to_owned())];
        Some(fault(late.1.site, format!("{what}, {name}, is written after it was copied"), related))
    }

    /// A table whose bits are set and not taken back before they are set again. `since`: where another graph used it last;
    /// `use_at`: where it is used.
    fn not_cleared(&self, table: &Footprint, since: Option<usize>, use_at: Option<usize>) -> Option<Fault> {
        let is_mine = |at: usize| since.is_none_or(|since| since < at && use_at.is_none_or(|it| at <= it));
        let events = || self.trace.events.iter().enumerate().filter(|it| is_mine(it.0));
        let place = |it: &Event| &self.trace.object(it.object).footprint;
        let is_zero = |it: &Event| it.value.is_some_and(|it| matches!(self.trace.exprs.get(it), Expr::Int(0)));
        let is_mark = |it: &Event| match it.how {
            How::Set => true,
            How::Store => it.when != Exprs::TRUE && !is_zero(it),
            _ => false,
        };
        let marks: Vec<(usize, &Event)> = events().filter(|it| place(it.1).overlaps(table) && is_mark(it.1)).collect();
        let (first, last) = (*marks.first()?, marks.last()?.0);
        let clears = |it: &(usize, &Event)| it.1.how == How::Store && is_zero(it.1) && place(it.1).contains(table);
        let end = use_at.unwrap_or(last).max(last);
        let is_cleared = events().filter(clears).any(|it| it.0 < first.0 || it.0 > end);
        let by_bits =
            |it: &(usize, &Event)| matches!(it.1.how, How::Reset | How::Assign) && place(it.1).overlaps(table);
        if is_cleared || events().any(|it| by_bits(&it)) {
            return None;
        }
        let message = format!("{} is not cleared before its bits are set", self.text(table));
        let late = events().find(clears).map(|it| (it.1.site, "cleared here, too late".to_owned()));
        let site = first.1.site;
        let fault = Fault::new(FaultKind::NotCleared, site, message, late.into_iter().collect());
        Some(Fault { table: Some(table.clone()), ..fault })
    }

    /// The equation of forces: the tables of forces to 1 and to 0, and whether the latter wins.
    fn forces(&self, value: ExprId) -> Option<(ObjectId, ObjectId, bool)> {
        let is_now = |it: ObjectId| self.trace.object(it).footprint == self.words.now;
        let word_of = |it: ExprId| word(self.trace, it);
        // (T AND NOT F0) OR F1
        let good = operands(self.trace, value, Operator::Or).and_then(|all| {
            all.into_iter().find_map(|(one, other)| {
                let (of, zero) = kept(self.trace, other)?;
                is_now(word_of(of)?).then_some((word_of(one)?, zero))
            })
        });
        // (T OR F1) AND NOT F0
        let bad = kept(self.trace, value).and_then(|(of, zero)| {
            let all = operands(self.trace, of, Operator::Or)?;
            let one = all.into_iter().find_map(|(t, one)| is_now(word_of(t)?).then_some(word_of(one)?))?;
            Some((one, zero))
        });
        good.map(|it| (it.0, it.1, false)).or(bad.map(|it| (it.0, it.1, true)))
    }

    fn forcing(&self, at: usize, event: &Event) -> Vec<Fault> {
        let mut faults = Vec::new();
        let Some((one, zero, is_off)) = event.value.and_then(|it| self.forces(it)) else { return faults };
        if is_off {
            let text = |it: ObjectId| format!("`{}`", self.trace.object(it).text);
            let message = format!("a force to 0 in {} wins over one to 1 in {}", text(zero), text(one));
            faults.push(Fault::new(FaultKind::ForcedOff, event.site, message, Vec::new()));
        }
        for it in [one, zero] {
            faults.extend(self.not_cleared(&self.trace.object(it).footprint, None, Some(at)));
        }
        faults
    }

    /// A transition that waits for no step, and runs only while some step is active (GRF:964-971).
    fn passed_by(&self, crossed: &Crossed) -> Option<Fault> {
        if !crossed.sources.is_empty() || crossed.sets.is_empty() {
            return None;
        }
        let is_table = |it: ExprId| {
            let word = word(self.trace, it).map(|it| &self.trace.object(it).footprint);
            word.is_some_and(|it| *it == self.words.before || *it == self.words.now)
        };
        let is_zero = |it: ExprId| matches!(self.trace.exprs.get(it), Expr::Int(0));
        let asks = crossed.rest.iter().any(|it| match *self.trace.exprs.get(*it) {
            Expr::Compare(Comparison::Ne, a, b) => is_table(a) && is_zero(b) || is_table(b) && is_zero(a),
            _ => false,
        });
        let event = self.trace.events.get(crossed.sets.first()?.1)?;
        let message =
            format!("this transition waits for no step, and is passed by while {} is 0", self.text(&self.words.before));
        asks.then_some(Fault::new(FaultKind::PassedBy, event.site, message, Vec::new()))
    }

    /// Blocks in another order than graphs, forces, counters, timers, outputs (GRF:181-193, 618-630).
    fn misplaced(&self, program: &ProgramIndex<'_>) -> Vec<Fault> {
        const NAMES: [&str; 5] = ["steps", "forces", "counters", "timers", "outputs"];
        let mut parts: FxHashMap<u32, FxHashSet<usize>> = FxHashMap::default();
        for event in &self.trace.events {
            if self.trace.object(event.object).footprint.overlaps(&self.words.now) {
                let is_force = event.value.is_some_and(|it| self.forces(it).is_some());
                parts.entry(event.unit).or_default().insert(usize::from(is_force));
            }
        }
        for uses in &program.objects {
            let reads_step = uses.object.footprint.overlaps(&self.words.now);
            for it in uses.with_mode(|it| it == Mode::Read).filter(|_| reads_step) {
                let facts = program.units[it.unit as usize];
                if parts.get(&it.unit).is_some_and(|it| it.contains(&0) || it.contains(&1)) {
                    continue;
                }
                for other in &facts.uses {
                    let is_output = || {
                        let object = facts.objects.get(other.object as usize);
                        object.is_some_and(|it| it.object.class == Class::Output)
                    };
                    let part = match other.mode {
                        Mode::Drive(Pin::Up | Pin::Down) => 2,
                        Mode::Drive(Pin::Start) => 3,
                        mode if mode.writes() && is_output() => 4,
                        _ => continue,
                    };
                    parts.entry(it.unit).or_default().insert(part);
                }
            }
        }
        // A block that does several of these has no one place.
        let alone = parts.into_iter().filter_map(|(unit, parts)| {
            let mut parts = parts.into_iter();
            let part = parts.next()?;
            (parts.next().is_none() && !program.is_startup(unit)).then_some((program.order[unit as usize], unit, part))
        });
        let mut blocks: Vec<(u32, u32, usize)> = alone.collect();
        blocks.sort_unstable();
        let place = |unit: u32| {
            let call = program.callers[unit as usize].first().and_then(|it| program.calls.get(*it as usize));
            call.map_or(ProgramIndex::heading(unit), |it| it.site())
        };
        let mut faults = Vec::new();
        for (at, &(_, unit, part)) in blocks.iter().enumerate() {
            let Some(&(_, late, before)) = blocks[at..].iter().find(|it| it.2 < part) else { continue };
            let message = format!("the {} are computed before the {} are", NAMES[part], NAMES[before]);
            let related = vec![(place(late), format!("the {} are computed here", NAMES[before]))];
            faults.push(Fault::new(FaultKind::Misplaced, place(unit), message, related));
        }
        faults
    }
}

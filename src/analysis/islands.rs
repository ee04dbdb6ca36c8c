//! Which objects of a program an edit can make a rule judge anew.
//!
//! An island is an object with all that share memory with it, directly or by way of others, or stand at one place with it,
//! or are passed by for one cause.
//!
//! **Invariant:** a rule that looks at objects one by one says of an island what follows from its uses, from the units that
//! hold them and the calls which lead there, from the order in which these run and in which contexts, and from the program's
//! [`Summary`]; it says it at one of those uses. What it says of objects that a unit has for itself, it says of
//! [`ProgramIndex::judged_units`], at a place that no other object is used at. So an edit moves the islands of the units that it
//! touches ([`Outline::moved`](super::outline::Outline::moved)), and those to which the summary would now
//! [tell otherwise](Summary::tells_otherwise).

use std::rc::Rc;
use std::sync::Arc;

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHashSet};

use super::Site;
use super::facts::{self, FactObject, UnitFacts, Use};
use super::outline::{Moved, Numbers};
use super::program::{Modes, ObjectUses, ProgramIndex, Skeleton, actual_mode};
use super::sequences::gate::{Assigned, Told};
use super::unseen::{Access, Summary};
use crate::model::object::{Area, Class, Footprint, Object, Type};
use crate::model::unit::Mode;

/// No object of the program.
const NONE: u32 = u32::MAX;

/// An object of the program, whichever units use it.
#[derive(Debug, Clone)]
struct Known {
    /// As the unit wrote it that was the first to name it.
    fact: FactObject,
    area: u32,
    users: Vec<User>,
}

/// A unit that uses an object.
#[derive(Debug, Clone, Copy)]
struct User {
    unit: u32,
    /// Number of the object there.
    at: u32,
    modes: Modes,
}

/// What a unit holds of the objects of the program.
#[derive(Debug, Clone)]
struct Held {
    facts: Arc<UnitFacts>,
    /// Of each object of the unit, which one of the program it is.
    ids: Vec<u32>,
    /// Where in `uses` those of each object end; they begin where those of the one before end.
    ends: Vec<u32>,
    /// Indices into the uses of the unit, by object, in order.
    uses: Vec<u32>,
    /// Objects of the program that stand at one place, in pairs.
    together: Vec<(u32, u32)>,
    /// Of the uses of objects that are [`Access::is_addressed`].
    addressed: Modes,
    told: Option<Told>,
}

impl Held {
    /// Of a unit that has not entered.
    fn nothing(facts: &Arc<UnitFacts>) -> Self {
        let (ids, ends, uses, together) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { facts: facts.clone(), ids, ends, uses, together, addressed: Modes::default(), told: None }
    }

    /// The uses of an object, as indices into those of the unit, in order.
    fn indices_of(&self, object: u32) -> &[u32] {
        let at = object as usize;
        let start = at.checked_sub(1).and_then(|it| self.ends.get(it)).copied().unwrap_or_default();
        let end = self.ends.get(at).copied().unwrap_or_default();
        self.uses.get(start as usize..end as usize).unwrap_or_default()
    }

    fn modes_of(&self, skeleton: &Skeleton<'_>, unit: u32, object: u32) -> Modes {
        let mut modes = Modes::default();
        let uses = self.indices_of(object).iter().filter_map(|it| self.facts.uses.get(*it as usize));
        uses.for_each(|it| modes.insert(actual_mode(skeleton, unit, it)));
        modes
    }

    /// Finds what is told together, and how memory is used, which hang on where calls lead.
    fn tie(&mut self, skeleton: &Skeleton<'_>, unit: u32) {
        let (facts, ids) = (&self.facts, &self.ids);
        let id = |it: &Use| ids.get(it.object as usize).copied().unwrap_or(NONE);
        // What one condition, jump or call passes by has one cause, and is told in one finding: outputs that are not
        // assigned, and edges that are not seen.
        let is_output = |it: &FactObject| it.object.class == Class::Output && it.object.ty == Type::Bool;
        let outputs = facts.objects.iter().zip(ids).filter(|it| is_output(it.0));
        let missed = outputs.filter_map(|(it, &id)| Some(((1, it.missed?), id)));
        let is_passed_by = skeleton.is_passed_by(unit);
        let is_edge = |it: &&Use| it.mode.is_edge() || it.mode == Mode::EdgeMemory;
        let is_skipped = |it: &&Use| it.skipped_by().is_some() || is_passed_by;
        let skipped = facts.uses.iter().filter(is_edge).filter(is_skipped);
        let mut causes: Vec<((u8, u32), u32)> = facts.uses.iter().map(|it| ((0, it.anchor), id(it))).collect();
        causes.extend(missed);
        causes.extend(skipped.map(|it| ((2, it.skipped_by().unwrap_or(NONE)), id(it))));
        causes.retain(|it| it.1 != NONE);
        causes.sort_unstable();
        causes.dedup();
        self.together = causes.windows(2).filter(|it| it[0].0 == it[1].0).map(|it| (it[0].1, it[1].1)).collect();
        self.addressed = Modes::default();
        for it in &facts.uses {
            if facts.objects.get(it.object as usize).is_some_and(|it| Access::is_addressed(&it.object)) {
                self.addressed.insert(actual_mode(skeleton, unit, it));
            }
        }
    }

    /// The objects of the program that are used, each once for each object of the unit that it is.
    fn used(&self) -> impl Iterator<Item = (u32, u32)> {
        let is_used = |at: u32| !self.indices_of(at).is_empty();
        (0..).zip(&self.ids).filter(move |&(at, &id)| id != NONE && is_used(at)).map(|(at, &id)| (at, id))
    }
}

/// The objects of a program, kept from edit to edit.
#[derive(Debug, Clone, Default)]
pub struct Islands {
    ids: HashTable<u32>,
    objects: Vec<Known>,
    /// Of each object, beside the others: most of those who look for objects want few classes.
    classes: Vec<Class>,
    /// Of the uses of each object.
    modes: Vec<Modes>,
    /// Objects that are [`Access::is_odd`].
    odd: Vec<u32>,
    units: Vec<Held>,
    assigned: Assigned,
    areas: FxHashMap<Area, u32>,
    /// Objects that lie in each byte of each area.
    bytes: FxHashMap<(u32, u32), Vec<u32>>,
    /// Of each area, those that are too large to stand in each of their bytes.
    large: FxHashMap<u32, Vec<u32>>,
}

/// An object of more bytes is compared with all others of its area.
const MANY_BYTES: u32 = 1024;

fn bytes_of(place: &Footprint) -> std::ops::RangeInclusive<u32> {
    match place.area {
        // The items of a block are one thing.
        Area::Block(..) => 0..=0,
        _ => place.start / 8..=place.end().saturating_sub(1) / 8,
    }
}

/// Whether findings about one may speak of the other: they share memory, are items of one block, or lie in one byte of
/// words, which are missed together.
fn is_near(a: &Footprint, b: &Footprint) -> bool {
    match a.area {
        Area::Block(..) => true,
        Area::Words => bytes_of(a).start() <= bytes_of(b).end() && bytes_of(b).start() <= bytes_of(a).end(),
        _ => a.start < b.end() && b.start < a.end(),
    }
}

impl Islands {
    pub fn new(skeleton: &Skeleton<'_>, facts: &[Arc<UnitFacts>]) -> Self {
        let mut islands = Self::default();
        for (unit, facts) in (0..).zip(facts) {
            let held = islands.hold(skeleton, unit, facts);
            islands.units.push(held);
            islands.enter(skeleton, unit);
        }
        for id in 0..index(islands.objects.len()) {
            islands.set_modes(id);
        }
        islands
    }

    /// Takes new facts of the units that have changed, and looks at what moved with them. Returns the objects that all these
    /// use or used.
    pub fn update(&mut self, skeleton: &Skeleton<'_>, facts: &[Arc<UnitFacts>], by: &Moved) -> FxHashSet<u32> {
        let mut objects = FxHashSet::default();
        if !by.numbers.are_same() {
            by.numbers.gone().for_each(|it| self.leave(it, &mut objects));
            self.renumber(facts, by.numbers);
        }
        for &unit in &by.changed {
            let Some(facts) = facts.get(unit as usize) else { continue };
            let held = self.hold(skeleton, unit, facts);
            self.leave(unit, &mut objects);
            if let Some(old) = self.units.get_mut(unit as usize) {
                *old = held;
            }
            self.enter(skeleton, unit);
        }
        for &unit in &by.units {
            let Some(held) = self.units.get_mut(unit as usize) else { continue };
            if !by.changed.contains(&unit) {
                held.tie(skeleton, unit);
                for (at, id) in held.used() {
                    let users = self.objects[id as usize].users.iter_mut();
                    let modes = held.modes_of(skeleton, unit, at);
                    users.filter(|it| (it.unit, it.at) == (unit, at)).for_each(|it| it.modes = modes);
                }
            }
            objects.extend(held.used().map(|it| it.1));
        }
        objects.iter().for_each(|&it| self.set_modes(it));
        objects
    }

    /// Units that are gone have left.
    fn renumber(&mut self, facts: &[Arc<UnitFacts>], numbers: Numbers) {
        let is_there = |it: u32| (it as usize) < self.units.len();
        let gone = numbers.gone().filter(|it| is_there(*it)).count();
        let start = numbers.gone().start as usize;
        let come = numbers.come().filter_map(|it| facts.get(it as usize)).map(Held::nothing);
        self.units.splice(start..start + gone, come);
        let now = |it: &mut u32| *it = numbers.now(*it).unwrap_or(NONE);
        self.objects.iter_mut().flat_map(|it| &mut it.users).for_each(|it| now(&mut it.unit));
        self.units.iter_mut().filter_map(|it| it.told.as_mut()).for_each(|it| it.renumber(now));
        self.assigned.renumber(now);
    }

    fn hold(&mut self, skeleton: &Skeleton<'_>, unit: u32, facts: &Arc<UnitFacts>) -> Held {
        let ids: Vec<u32> =
            facts.objects.iter().map(|it| if facts::is_shared(&it.object) { self.id(it) } else { NONE }).collect();
        let mut ends = vec![0; facts.objects.len()];
        for it in &facts.uses {
            if let Some(end) = ends.get_mut(it.object as usize) {
                *end += 1;
            }
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        let mut uses = vec![0; sum as usize];
        for (at, it) in (0..).zip(&facts.uses) {
            if let Some(end) = ends.get_mut(it.object as usize) {
                uses[*end as usize] = at;
                *end += 1;
            }
        }
        let told = Told::new(unit, facts, |it, _| ids.get(it as usize).copied().unwrap_or(NONE).into());
        let (together, addressed) = (Vec::new(), Modes::default());
        let mut held = Held { facts: facts.clone(), ids, ends, uses, together, addressed, told };
        held.tie(skeleton, unit);
        held
    }

    fn id(&mut self, fact: &FactObject) -> u32 {
        let objects = &self.objects;
        let is_same = |&id: &u32| fact.is_same(&objects[id as usize].fact);
        if let Some(&id) = self.ids.find(fact.hash, is_same) {
            return id;
        }
        let id = index(self.objects.len());
        self.ids.insert_unique(fact.hash, id, |&it| objects[it as usize].fact.hash);
        let place = &fact.object.footprint;
        let next = index(self.areas.len());
        let area = match self.areas.get(&place.area) {
            Some(&area) => area,
            None => *self.areas.entry(place.area.clone()).or_insert(next),
        };
        let bytes = bytes_of(place);
        if bytes.end() - bytes.start() < MANY_BYTES {
            for byte in bytes {
                self.bytes.entry((area, byte)).or_default().push(id);
            }
        } else {
            self.large.entry(area).or_default().push(id);
        }
        if Access::is_odd(&fact.object) {
            self.odd.push(id);
        }
        self.classes.push(fact.object.class);
        self.modes.push(Modes::default());
        self.objects.push(Known { fact: fact.clone(), area, users: Vec::new() });
        id
    }

    fn enter(&mut self, skeleton: &Skeleton<'_>, unit: u32) {
        let Some(held) = self.units.get(unit as usize) else { return };
        for (at, id) in held.used() {
            let modes = held.modes_of(skeleton, unit, at);
            self.objects[id as usize].users.push(User { unit, at, modes });
        }
        if let Some(told) = &held.told {
            self.assigned.insert(unit, told);
        }
    }

    /// Takes out a unit; `objects` takes those that it used.
    fn leave(&mut self, unit: u32, objects: &mut FxHashSet<u32>) {
        let Some(held) = self.units.get(unit as usize) else { return };
        for (_, id) in held.used() {
            objects.insert(id);
            self.objects[id as usize].users.retain(|it| it.unit != unit);
        }
        if let Some(told) = &held.told {
            self.assigned.remove(unit, told);
        }
    }

    fn set_modes(&mut self, id: u32) {
        let mut modes = Modes::default();
        self.objects[id as usize].users.iter().for_each(|it| modes.join(it.modes));
        self.modes[id as usize] = modes;
    }

    /// The objects of some classes that are used, in no order.
    pub fn used(&self, class: impl Fn(Class) -> bool) -> impl Iterator<Item = &Object> {
        let of_class = self.objects.iter().zip(&self.classes).filter(move |it| class(*it.1)).map(|it| it.0);
        of_class.filter(|it| !it.users.is_empty()).map(|it| &it.fact.object)
    }

    /// Of the program whose facts were taken last.
    pub(super) fn access(&self, skeleton: &Skeleton<'_>) -> Access {
        let odd = self.odd.iter().map(|&it| (&self.objects[it as usize], self.modes[it as usize]));
        let used = odd.filter(|it| !it.0.users.is_empty());
        let mut addressed = Modes::default();
        self.units.iter().for_each(|it| addressed.join(it.addressed));
        Access::new(skeleton, used.map(|(it, modes)| (&it.fact.object, modes)), addressed)
    }

    /// Whether the program both sets and resets an object.
    pub(super) fn is_set_and_reset(&self, id: u32) -> bool {
        self.modes.get(id as usize).is_some_and(|it| it.set_and_reset())
    }

    /// What each unit tells of sequences.
    pub(super) fn told(&self) -> impl Iterator<Item = Option<&Told>> {
        self.units.iter().map(|it| it.told.as_ref())
    }

    pub(super) fn assigned(&self) -> &Assigned {
        &self.assigned
    }

    /// Adds all objects of the islands that some of them lie on.
    pub fn close(&self, objects: &mut FxHashSet<u32>) {
        let mut open: Vec<u32> = objects.iter().copied().collect();
        while let Some(id) = open.pop() {
            let it = &self.objects[id as usize];
            let place = &it.fact.object.footprint;
            let mut visit = |other: u32| {
                let near = || is_near(place, &self.objects[other as usize].fact.object.footprint);
                if !objects.contains(&other) && near() {
                    objects.insert(other);
                    open.push(other);
                }
            };
            let bytes = bytes_of(place);
            if bytes.end() - bytes.start() < MANY_BYTES {
                for byte in bytes {
                    self.bytes.get(&(it.area, byte)).into_iter().flatten().for_each(|&it| visit(it));
                }
                self.large.get(&it.area).into_iter().flatten().for_each(|&it| visit(it));
            } else {
                (0..).zip(&self.objects).filter(|other| other.1.area == it.area).for_each(|it| visit(it.0));
            }
            for user in &it.users {
                for &(a, b) in &self.units[user.unit as usize].together {
                    let other = if a == id {
                        b
                    } else if b == id {
                        a
                    } else {
                        continue;
                    };
                    if objects.insert(other) {
                        open.push(other);
                    }
                }
            }
        }
    }

    pub fn get(&self, id: u32) -> Option<&Object> {
        self.objects.get(id as usize).map(|it| &it.fact.object)
    }

    /// The object of the program that an object of a unit is: both by their numbers.
    pub fn object(&self, (unit, object): (u32, u32)) -> Option<u32> {
        self.units.get(unit as usize)?.ids.get(object as usize).copied().filter(|it| *it != NONE)
    }

    /// The objects that are used at a place.
    pub fn at(&self, site: Site) -> Vec<u32> {
        let Some(held) = self.units.get(site.unit as usize) else { return Vec::new() };
        let uses = held.facts.uses.iter().filter(|it| it.anchor == site.anchor);
        let ids = uses.filter_map(|it| held.ids.get(it.object as usize).copied());
        ids.filter(|it| *it != NONE).collect()
    }

    /// The program with some of its objects alone. `skeleton` is that of the facts which were taken last.
    pub fn part<'a>(
        &self,
        skeleton: &Rc<Skeleton<'a>>,
        objects: &FxHashSet<u32>,
        changed: &[u32],
        summary: Summary,
    ) -> ProgramIndex<'a> {
        let found = self.collect(skeleton, objects.iter().copied());
        ProgramIndex::part(skeleton.clone(), found, changed.into(), summary)
    }

    /// The objects that are wanted, in their order.
    pub fn those<'a>(
        &self,
        skeleton: &Skeleton<'a>,
        class: impl Fn(Class) -> bool,
        wanted: impl Fn(&Object) -> bool,
    ) -> Vec<ObjectUses<'a>> {
        let of_class = (0..).zip(&self.objects).zip(&self.classes).filter(|it| class(*it.1)).map(|it| it.0);
        let wanted = of_class.filter(|it| !it.1.users.is_empty() && wanted(&it.1.fact.object));
        self.collect(skeleton, wanted.map(|it| it.0))
    }

    fn collect<'a>(&self, skeleton: &Skeleton<'a>, objects: impl Iterator<Item = u32>) -> Vec<ObjectUses<'a>> {
        let rank = |unit: u32| skeleton.order.get(unit as usize).copied().unwrap_or(NONE);
        let mut found = Vec::with_capacity(objects.size_hint().0);
        let (mut users, mut all): (Vec<(u32, u32, u32)>, Vec<u32>) = (Vec::new(), Vec::new());
        for id in objects {
            users.clear();
            users.extend(self.objects[id as usize].users.iter().map(|it| (rank(it.unit), it.at, it.unit)));
            users.sort_unstable();
            let fact = |&(_, at, unit): &(u32, u32, u32)| skeleton.units.get(unit as usize)?.objects.get(at as usize);
            let Some((first, &(rank, at, _))) = users.first().and_then(|it| Some((fact(it)?, it))) else { continue };
            let count = users.iter().map(|&(_, at, unit)| self.units[unit as usize].indices_of(at).len()).sum();
            let mut uses = ObjectUses::with_capacity(&first.object, count);
            uses.number = users.iter().filter_map(fact).any(|it| it.number);
            for of_unit in users.chunk_by(|a, b| a.2 == b.2) {
                let unit = of_unit[0].2;
                let held = &self.units[unit as usize];
                let facts: &'a UnitFacts = skeleton.units[unit as usize];
                let indices = match of_unit {
                    [(_, at, _)] => held.indices_of(*at),
                    _ => {
                        all.clear();
                        of_unit.iter().for_each(|it| all.extend(held.indices_of(it.1)));
                        all.sort_unstable();
                        &all
                    }
                };
                for it in indices.iter().filter_map(|it| facts.uses.get(*it as usize)) {
                    uses.push(skeleton, unit, it);
                }
            }
            let place = &first.object.footprint;
            found.push(([self.objects[id as usize].area, place.start, u32::MAX - place.bits, rank, at], uses));
        }
        // Areas hold names: they are compared once each, not once a comparison of objects.
        let mut areas: Vec<(u32, &Area)> = found.iter().map(|it| (it.0[0], &it.1.object.footprint.area)).collect();
        areas.sort_unstable_by_key(|it| it.0);
        areas.dedup_by_key(|it| it.0);
        areas.sort_unstable_by_key(|it| it.1);
        let ranks: FxHashMap<u32, u32> = areas.into_iter().map(|it| it.0).zip(0..).collect();
        for (key, _) in &mut found {
            key[0] = ranks.get(&key[0]).copied().unwrap_or(NONE);
        }
        found.sort_unstable_by_key(|it| it.0);
        found.into_iter().map(|it| it.1).collect()
    }
}

fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(NONE)
}

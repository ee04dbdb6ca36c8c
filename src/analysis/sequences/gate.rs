//! Whether it is worth while to follow a scan: most programs set and reset bits, and few of them hand an activity over.

use std::cell::OnceCell;

use rustc_hash::{FxHashMap, FxHashSet};

use super::code::{Ask, How};
use crate::analysis::facts::{FactObject, UnitFacts};
use crate::analysis::program::ProgramIndex;
use crate::model::layout::DataType;
use crate::model::object::Class;
use crate::model::unit::Section;

/// A bit of the program, or one that a unit has for itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Bit {
    /// By its number in the program; or by the hash of what it is: two that are taken for one only open the gate.
    Shared(u64),
    Own(u32, u32),
    /// One that other blocks may know by another name.
    Open,
}

impl Bit {
    fn renumber(&mut self, now: impl Fn(&mut u32)) {
        if let Self::Own(unit, _) = self {
            now(unit);
        }
    }
}

/// A bit that is asked for.
#[derive(Debug, Clone, Copy)]
struct Asked {
    bit: Bit,
    /// Whether it is one of a data block.
    is_data: bool,
}

/// What a unit tells the gate.
#[derive(Debug, Clone)]
pub(in crate::analysis) struct Told {
    may_evolve: bool,
    may_be_step: bool,
    held: u32,
    /// Whether it sets or resets bits that other blocks may know by another name.
    gives_open: bool,
    /// Bits of its own that it both sets and resets. Sorted.
    own: Box<[u32]>,
    /// Bits that it sets or resets, with another bit that this asks for.
    handed: Box<[(Bit, Asked)]>,
    /// The same of bits that it assigns.
    assigned: Box<[(Bit, Asked)]>,
}

impl Told {
    /// `shared`: what tells an object that other units can name.
    pub(in crate::analysis) fn new(
        unit: u32,
        facts: &UnitFacts,
        shared: impl Fn(u32, &FactObject) -> u64,
    ) -> Option<Self> {
        let code = facts.code.as_deref()?;
        let class = |object: u32| facts.objects.get(object as usize).map(|it| it.object.class);
        let bit = |object: u32| bit(unit, facts, object, &shared);
        let ask = |it: &Ask| {
            let of = it.of.filter(|of| *of != it.object)?;
            Some((bit(it.object), Asked { bit: bit(of), is_data: class(of) == Some(Class::Data) }))
        };
        let (mut sets, mut resets, mut gives_open) = (Vec::new(), Vec::new(), false);
        for it in code.asks.iter().filter(|it| stores(it)) {
            match bit(it.object) {
                Bit::Own(_, object) if it.how == How::Set => sets.push(object),
                Bit::Own(_, object) => resets.push(object),
                Bit::Open => gives_open = true,
                Bit::Shared(_) => {}
            }
        }
        resets.sort_unstable();
        sets.retain(|it| resets.binary_search(it).is_ok());
        sets.sort_unstable();
        let of_assigned = |it: &&Ask| it.how == How::Assign;
        let assigned = code.asks.iter().filter(of_assigned).filter_map(|it| {
            let of = it.of?;
            Some((bit(it.object), Asked { bit: bit(of), is_data: class(of) == Some(Class::Data) }))
        });
        Some(Self {
            may_evolve: code.may_evolve,
            may_be_step: code.may_be_step,
            held: code.held,
            gives_open,
            own: sets.into(),
            handed: code.asks.iter().filter(|it| stores(it)).filter_map(ask).collect(),
            assigned: assigned.collect(),
        })
    }

    pub(in crate::analysis) fn renumber(&mut self, now: impl Fn(&mut u32)) {
        for (a, b) in self.handed.iter_mut().chain(&mut self.assigned) {
            a.renumber(&now);
            b.bit.renumber(&now);
        }
    }
}

fn stores(it: &Ask) -> bool {
    matches!(it.how, How::Set | How::Reset)
}

/// What assigned bits ask for, with the unit that says so.
#[derive(Debug, Clone, Default)]
pub(in crate::analysis) struct Assigned(FxHashMap<Bit, Vec<(u32, Asked)>>);

impl Assigned {
    pub(in crate::analysis) fn insert(&mut self, unit: u32, told: &Told) {
        for (bit, asked) in &told.assigned {
            self.0.entry(*bit).or_default().push((unit, *asked));
        }
    }

    pub(in crate::analysis) fn remove(&mut self, unit: u32, told: &Told) {
        for (bit, _) in &told.assigned {
            if let Some(list) = self.0.get_mut(bit) {
                list.retain(|it| it.0 != unit);
            }
        }
    }

    pub(in crate::analysis) fn renumber(&mut self, now: impl Fn(&mut u32)) {
        let renumbered = std::mem::take(&mut self.0).into_iter().filter(|it| !it.1.is_empty());
        self.0 = renumbered
            .map(|(mut bit, mut list)| {
                bit.renumber(&now);
                for (unit, asked) in &mut list {
                    now(unit);
                    asked.bit.renumber(&now);
                }
                (bit, list)
            })
            .collect();
    }
}

/// Whether some unit may be part of a sequence: it complements words; enough bits hold themselves; a block is called that may
/// be a step; or a bit that is both set and reset asks twice, or is asked for, in what sets and resets, by others of them. One
/// that is asked for by way of assigned bits counts for two.
pub(super) fn may_evolve(program: &ProgramIndex<'_>) -> bool {
    if let Some(islands) = program.known() {
        let is_given = |it: u64| u32::try_from(it).is_ok_and(|it| islands.is_set_and_reset(it));
        return is_open(program, islands.told(), is_given, || islands.assigned());
    }
    let units = || (0..).zip(&program.units).map(|(unit, facts)| (unit, *facts));
    let shared = |_: u32, it: &FactObject| it.hash;
    let told: Vec<Option<Told>> = units().map(|(unit, facts)| Told::new(unit, facts, shared)).collect();
    let mut given: FxHashMap<u64, [bool; 2]> = FxHashMap::default();
    for (unit, facts) in units() {
        for it in facts.code.iter().flat_map(|it| &it.asks).filter(|it| stores(it)) {
            if let Bit::Shared(hash) = bit(unit, facts, it.object, &shared) {
                given.entry(hash).or_default()[usize::from(it.how == How::Set)] = true;
            }
        }
    }
    let assigned: OnceCell<Assigned> = OnceCell::new();
    let assigned = || {
        assigned.get_or_init(|| {
            let mut found = Assigned::default();
            (0..).zip(&told).for_each(|(unit, it)| it.iter().for_each(|it| found.insert(unit, it)));
            found
        })
    };
    let is_given = |it: u64| given.get(&it) == Some(&[true; 2]);
    is_open(program, told.iter().map(Option::as_ref), is_given, assigned)
}

/// `told`: by unit. `is_given`: whether a shared bit is both set and reset.
fn is_open<'t>(
    program: &ProgramIndex<'_>,
    told: impl Iterator<Item = Option<&'t Told>>,
    is_given: impl Fn(u64) -> bool,
    assigned: impl Fn() -> &'t Assigned,
) -> bool {
    /// Fewer calls of one block are no steps that follow one another.
    const FEWEST_CALLS: usize = 2;
    /// A loop of two steps goes to each of them, and on from it.
    const FEWEST_HANDED: u32 = 2;
    /// Fewer bits that hold themselves are no table.
    const FEWEST_HELD: u32 = 3;
    let told: Vec<Option<&Told>> = told.collect();
    let all = || (0..).zip(&told).filter_map(|(unit, it): (u32, _)| Some((unit, (*it)?)));
    let is_step = |unit: u32, it: &Told| {
        it.may_be_step && program.callers.get(unit as usize).is_some_and(|it| it.len() >= FEWEST_CALLS)
    };
    if all().any(|(unit, it)| it.may_evolve || is_step(unit, it)) {
        return true;
    }
    if all().map(|it| it.1.held).fold(0, u32::saturating_add) >= FEWEST_HELD {
        return true;
    }
    let gives_open = all().any(|it| it.1.gives_open);
    let is_step = |it: &Asked| {
        let is_given = match it.bit {
            Bit::Shared(it) => is_given(it),
            Bit::Own(unit, object) => {
                let told = told.get(unit as usize).copied().flatten();
                told.is_some_and(|it| it.own.binary_search(&object).is_ok())
            }
            Bit::Open => gives_open,
        };
        is_given || gives_open && it.is_data
    };
    let mut handed: FxHashMap<Bit, u32> = FxHashMap::default();
    let mut open: Vec<Bit> = Vec::new();
    for (to, of) in all().flat_map(|it| &it.1.handed) {
        if !is_step(of) {
            open.push(of.bit);
            continue;
        }
        for it in [*to, of.bit] {
            let count = handed.entry(it).or_default();
            *count += 1;
            if *count >= FEWEST_HANDED || it == Bit::Open || gives_open {
                return true;
            }
        }
    }
    let mut seen: FxHashSet<Bit> = FxHashSet::default();
    while let Some(of) = open.pop() {
        if !seen.insert(of) {
            continue;
        }
        // What assigned bits ask for is looked up when one of them is asked for.
        for (_, it) in assigned().0.get(&of).into_iter().flatten() {
            if is_step(it) {
                return true;
            }
            open.push(it.bit);
        }
    }
    false
}

fn bit(unit: u32, facts: &UnitFacts, object: u32, shared: &impl Fn(u32, &FactObject) -> u64) -> Bit {
    let Some(fact) = facts.objects.get(object as usize) else { return Bit::Open };
    match fact.object.class {
        Class::InstanceData => Bit::Open,
        Class::LocalName if !is_temporary(facts, &fact.object.text) => Bit::Open,
        Class::LocalName | Class::LocalData => Bit::Own(unit, object),
        _ => Bit::Shared(shared(object, fact)),
    }
}

/// Whether the unit declares a name as one of its temporary variables.
fn is_temporary(facts: &UnitFacts, name: &str) -> bool {
    let name = name.trim_start_matches('#').split(['.', '[']).next().unwrap_or_default();
    let declared = facts.declared.as_deref().map_or(&[][..], DataType::fields);
    declared.iter().any(|it| it.section == Section::Temp && it.name.eq_ignore_ascii_case(name))
}

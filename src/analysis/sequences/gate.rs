//! Whether it is worth while to follow a scan: most programs set and reset bits, and few of them hand an activity over.

use rustc_hash::{FxHashMap, FxHashSet};

use super::code::{Ask, CodeFacts, How};
use crate::analysis::facts::UnitFacts;
use crate::analysis::islands::Islands;
use crate::analysis::program::ProgramIndex;
use crate::model::layout::DataType;
use crate::model::object::Class;
use crate::model::unit::Section;

/// A bit of the program, or one that a unit has for itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Bit {
    /// By the hash of what it is: two that are taken for one only open the gate.
    Shared(u64),
    Own(u32, u32),
    /// One that other blocks may know by another name.
    Open,
}

/// Whether some unit may be part of a sequence: it complements words; enough bits hold themselves; a block is called that may
/// be a step; or a bit that is both set and reset asks twice, or is asked for, in what sets and resets, by others of them. One
/// that is asked for by way of assigned bits counts for two.
pub(super) fn may_evolve(program: &ProgramIndex<'_>) -> bool {
    /// Fewer calls of one block are no steps that follow one another.
    const FEWEST_CALLS: usize = 2;
    /// A loop of two steps goes to each of them, and on from it.
    const FEWEST_HANDED: u32 = 2;
    /// Fewer bits that hold themselves are no table.
    const FEWEST_HELD: u32 = 3;
    let all = || (0..).zip(&program.units).filter_map(|(unit, facts)| Some((unit, *facts, facts.code.as_deref()?)));
    let is_step = |unit: u32, it: &CodeFacts| {
        it.may_be_step && program.callers.get(unit as usize).is_some_and(|it| it.len() >= FEWEST_CALLS)
    };
    if all().any(|(unit, _, it)| it.may_evolve || is_step(unit, it)) {
        return true;
    }
    if all().map(|it| it.2.held).fold(0, u32::saturating_add) >= FEWEST_HELD {
        return true;
    }
    let stores = |it: &&Ask| matches!(it.how, How::Set | How::Reset);
    let mut steps = Steps { islands: program.known().map(AsRef::as_ref), given: FxHashMap::default() };
    for (unit, facts, code) in all() {
        code.asks.iter().filter(stores).for_each(|it| steps.insert(bit(unit, facts, it.object), it.how));
    }
    let is_open = steps.given.contains_key(&Bit::Open);
    let is_step = |unit: u32, facts: &UnitFacts, object: u32| {
        let by_another_name = || facts.objects.get(object as usize).is_some_and(|it| it.object.class == Class::Data);
        steps.contains(unit, object, bit(unit, facts, object)) || is_open && by_another_name()
    };
    let mut handed: FxHashMap<Bit, u32> = FxHashMap::default();
    // What assigned bits ask for, looked up when one of them is asked for.
    let mut assigned: Option<FxHashMap<Bit, Vec<(u32, u32)>>> = None;
    let mut seen: FxHashSet<Bit> = FxHashSet::default();
    let mut open: Vec<(u32, u32)> = Vec::new();
    for (unit, facts, code) in all() {
        for it in code.asks.iter().filter(stores) {
            let Some(of) = it.of else { continue };
            if of != it.object && is_step(unit, facts, of) {
                for it in [it.object, of].map(|it| bit(unit, facts, it)) {
                    let count = handed.entry(it).or_default();
                    *count += 1;
                    if *count >= FEWEST_HANDED || it == Bit::Open || is_open {
                        return true;
                    }
                }
            } else if of != it.object {
                open.push((unit, of));
            }
        }
    }
    while let Some((unit, object)) = open.pop() {
        let Some(facts) = program.units.get(unit as usize) else { continue };
        let of = bit(unit, facts, object);
        if !seen.insert(of) {
            continue;
        }
        let assigned = assigned.get_or_insert_with(|| {
            let mut found: FxHashMap<Bit, Vec<(u32, u32)>> = FxHashMap::default();
            for (unit, facts, code) in all() {
                for it in code.asks.iter().filter(|it| it.how == How::Assign) {
                    let asked = it.of.map(|of| (unit, of));
                    found.entry(bit(unit, facts, it.object)).or_default().extend(asked);
                }
            }
            found
        });
        for &(unit, object) in assigned.get(&of).into_iter().flatten() {
            let Some(facts) = program.units.get(unit as usize) else { continue };
            if is_step(unit, facts, object) {
                return true;
            }
            open.push((unit, object));
        }
    }
    false
}

/// Bits that are both set and reset.
struct Steps<'p> {
    /// What is known of those that units share.
    islands: Option<&'p Islands>,
    /// Of the others, whether something resets them, and sets them.
    given: FxHashMap<Bit, [bool; 2]>,
}

impl Steps<'_> {
    fn insert(&mut self, bit: Bit, how: How) {
        if self.islands.is_none() || !matches!(bit, Bit::Shared(_)) {
            self.given.entry(bit).or_default()[usize::from(how == How::Set)] = true;
        }
    }

    fn contains(&self, unit: u32, object: u32, bit: Bit) -> bool {
        match (bit, self.islands) {
            (Bit::Open, _) => self.given.contains_key(&bit),
            (Bit::Shared(_), Some(islands)) => islands.modes(unit, object).set_and_reset(),
            _ => self.given.get(&bit) == Some(&[true; 2]),
        }
    }
}

fn bit(unit: u32, facts: &UnitFacts, object: u32) -> Bit {
    let Some(fact) = facts.objects.get(object as usize) else { return Bit::Open };
    match fact.object.class {
        Class::InstanceData => Bit::Open,
        Class::LocalName if !is_temporary(facts, &fact.object.text) => Bit::Open,
        Class::LocalName | Class::LocalData => Bit::Own(unit, object),
        _ => Bit::Shared(fact.hash),
    }
}

/// Whether the unit declares a name as one of its temporary variables.
fn is_temporary(facts: &UnitFacts, name: &str) -> bool {
    let name = name.trim_start_matches('#').split(['.', '[']).next().unwrap_or_default();
    let declared = facts.declared.as_deref().map_or(&[][..], DataType::fields);
    declared.iter().any(|it| it.section == Section::Temp && it.name.eq_ignore_ascii_case(name))
}

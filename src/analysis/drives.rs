//! Which places drive an object, and which of them can take effect in one scan.

use rustc_hash::{FxHashMap, FxHashSet};

use super::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::model::object::{Class, Type};
use crate::model::unit::{Callee, Mode};

/// Stores of words and tables that write an output bit on the way, or of bit tables that write a memory bit. Stores of
/// constants clear or preset a whole area and are left out. `neighbours`: objects that share memory with the bit.
pub fn covering<'a>(program: &ProgramIndex<'a>, bit: &ObjectUses<'a>, neighbours: &[u32]) -> Vec<GlobalUse<'a>> {
    let mut found = Vec::new();
    for whole in neighbours.iter().filter_map(|&it| program.objects.get(it as usize)) {
        let wide = whole.object.class == Class::Output || matches!(whole.object.ty, Type::BitTable(_));
        if wide && whole.object.ty != Type::Bool && whole.object.footprint.contains(&bit.object.footprint) {
            found.extend(whole.with_mode(|it| it == Mode::Store).filter(|it| it.it.constant().is_none()).copied());
        }
    }
    found
}

/// Whether the bit that a place drives lies in a table that the block clears as a whole first, so that it computes the
/// table anew: several graphs may have one table of receptivities (GRF:1191). `neighbours`: objects that share memory with
/// the bit.
pub fn is_of_cleared_table(program: &ProgramIndex<'_>, place: &GlobalUse<'_>, neighbours: &[u32]) -> bool {
    let tables = neighbours.iter().filter_map(|&it| program.objects.get(it as usize));
    let clears = |it: &GlobalUse<'_>| {
        it.unit == place.unit && it.it.anchor < place.it.anchor && it.it.constant() == Some(0) && !it.it.conditional
    };
    tables.filter(|it| it.object.ty != Type::Bool).any(|it| it.with_mode(|it| it == Mode::Store).any(clears))
}

/// Calls behind which an object is read: places in their units, by unit, in order.
#[derive(Default)]
pub struct ReadingCalls(FxHashMap<u32, Vec<u32>>);

impl ReadingCalls {
    pub fn new(program: &ProgramIndex<'_>, object: &ObjectUses<'_>) -> Self {
        let mut open: Vec<u32> = object.with_mode(Mode::reads).map(|it| it.unit).collect();
        let mut seen: FxHashSet<u32> = open.iter().copied().collect();
        let mut found = Self::default();
        while let Some(unit) = open.pop() {
            let callers = program.callers.get(unit as usize).into_iter().flatten();
            for call in callers.filter_map(|it| program.calls.get(*it as usize)) {
                found.0.entry(call.unit).or_default().push(call.it.anchor);
                if seen.insert(call.unit) {
                    open.push(call.unit);
                }
            }
        }
        found.0.values_mut().for_each(|it| it.sort_unstable());
        found
    }

    /// Whether one of them stands between two places: the value of the first is handed to the block that is called.
    pub fn between(&self, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
        let (first, last) = (a.it.anchor.min(b.it.anchor), a.it.anchor.max(b.it.anchor));
        let Some(calls) = self.0.get(&a.unit).filter(|_| a.unit == b.unit) else { return false };
        calls.get(calls.partition_point(|it| *it < first)).is_some_and(|it| *it < last)
    }
}

/// Whether one of two assignments undoes the other. Two constants under a condition store a value, as set and reset do,
/// and equal constants are one value.
pub fn override_each_other(a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    match (a.it.constant(), b.it.constant()) {
        (Some(x), Some(y)) => x != y && !a.it.conditional && !b.it.conditional,
        _ => true,
    }
}

/// Whether both are actual parameters of calls of one instance of a DFB. That it is called twice is a mistake of its own.
pub fn of_one_instance(program: &ProgramIndex<'_>, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    let instance = |it: &GlobalUse<'_>| {
        let (call, _) = it.it.parameter()?;
        match &program.units.get(it.unit as usize)?.calls.get(*call as usize)?.callee {
            Callee::Instance(name) => Some(name.clone()),
            _ => None,
        }
    };
    instance(a).is_some_and(|it| instance(b) == Some(it))
}

/// Sorts places as the controller comes across them.
pub fn in_order(program: &ProgramIndex<'_>, uses: &mut [GlobalUse<'_>]) {
    uses.sort_by_key(|it| (program.order[it.unit as usize], it.it.anchor));
}

/// The second place of the first two that can take effect in one scan, and all others. `uses` are in order. What only
/// runs at start-up is overwritten on purpose, and what gives an object its own value changes nothing: left out.
pub fn conflict<'a>(
    program: &ProgramIndex<'_>,
    uses: &[GlobalUse<'a>],
    opposed: impl Fn(&GlobalUse<'_>, &GlobalUse<'_>) -> bool,
) -> Option<(GlobalUse<'a>, Vec<GlobalUse<'a>>)> {
    /// Of more driving places of one object, only so many are compared.
    const MAX_COMPARED: usize = 256;
    if uses.len() < 2 {
        return None;
    }
    let uses: Vec<GlobalUse<'a>> = uses
        .iter()
        .filter(|it| !program.is_startup(it.unit) && (!it.it.own || it.mode == Mode::Set))
        .copied()
        .collect();
    let compared = &uses[..uses.len().min(MAX_COMPARED)];
    let at = (1..compared.len())
        .find(|&at| compared[..at].iter().any(|it| opposed(it, &compared[at]) && program.clash(it, &compared[at])))?;
    let others = uses.iter().enumerate().filter(|it| it.0 != at).map(|it| *it.1).collect();
    Some((uses[at], others))
}

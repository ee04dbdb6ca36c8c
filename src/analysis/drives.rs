//! Which places drive an object, and which of them can take effect in one scan.

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
            found.extend(whole.with_mode(|it| it == Mode::Store).filter(|it| it.it.constant.is_none()).copied());
        }
    }
    found
}

/// Whether one of two assignments undoes the other. Two constants under a condition store a value, as set and reset do,
/// and equal constants are one value.
pub fn override_each_other(a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    match (a.it.constant, b.it.constant) {
        (Some(x), Some(y)) => x != y && !a.it.conditional && !b.it.conditional,
        _ => true,
    }
}

/// Whether both are actual parameters of calls of one instance of a DFB. That it is called twice is a mistake of its own.
pub fn of_one_instance(program: &ProgramIndex<'_>, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    let instance = |it: &GlobalUse<'_>| {
        let (call, _) = it.it.parameter.as_ref()?;
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

/// Writes that may be the missing ones under another name: of a symbol that nothing resolves for an address, and of any
/// address for such a symbol.
pub struct Hidden {
    by_symbol: [bool; 2],
    by_address: [bool; 2],
}

impl Hidden {
    pub fn new(program: &ProgramIndex<'_>) -> Self {
        let gives = |missing: Mode| {
            move |mode: Mode| mode.writes() && (mode == missing || !matches!(mode, Mode::Set | Mode::Reset))
        };
        Self {
            by_symbol: [Mode::Set, Mode::Reset].map(|it| program.has_unresolved(gives(it))),
            by_address: [Mode::Set, Mode::Reset].map(|it| program.has_addressed(gives(it))),
        }
    }

    /// Whether a bit of the class may be written so: set or reset, as what is `missing`, or assigned.
    pub fn may_hold(&self, class: Class, missing: Mode) -> bool {
        let [set, reset] = if class == Class::Symbol { self.by_address } else { self.by_symbol };
        if missing == Mode::Set { set } else { reset }
    }
}

//! W006: memory written under one address and used under another.

use crate::analysis::Site;
use crate::analysis::facts::Written;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Object, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let objects = &cx.program.objects;
    // A group: a first object and all that share memory with it or with one of the group, through conflicts.
    let mut group_of: Vec<usize> = (0..objects.len()).collect();
    let mut conflicts = Vec::new();
    for &(a, b) in cx.overlaps() {
        let (a, b) = (a as usize, b as usize);
        if in_conflict(cx, &objects[a], &objects[b]) {
            // Objects are sorted by address, so a group's first object is met before the others.
            let group = group_of[a].min(group_of[b]);
            group_of[a] = group;
            group_of[b] = group;
            conflicts.push((a, b));
        }
    }
    conflicts.sort_by_key(|&(a, _)| group_of[a]);
    for group in conflicts.chunk_by(|x, y| group_of[x.0] == group_of[y.0]) {
        let mut members: Vec<usize> = group.iter().flat_map(|&(a, b)| [a, b]).collect();
        members.sort_unstable();
        members.dedup();
        report(cx, &members, sink);
    }
}

fn report(cx: &ProgramCx<'_>, members: &[usize], sink: &mut Sink<'_, Site>) {
    let objects = &cx.program.objects;
    // Of each object: every write, and the first place that reads it.
    let mut uses: Vec<(usize, GlobalUse<'_>)> = Vec::new();
    for &member in members {
        let first_read = objects[member].uses.iter().position(|it| !it.mode.writes());
        let wanted = objects[member].uses.iter().enumerate();
        uses.extend(wanted.filter(|(at, it)| it.mode.writes() || Some(*at) == first_read).map(|it| (member, *it.1)));
    }
    uses.sort_by_key(|(_, it)| (cx.program.order[it.unit as usize], it.it.anchor));
    let is_write = |it: &&(usize, GlobalUse<'_>)| it.1.mode.writes();
    let Some(first) = uses.iter().find(is_write) else { return };
    let clashes = |a: usize, b: usize| a != b && in_conflict(cx, &objects[a], &objects[b]);
    // The write that changes what another address holds; where one address alone is written, that write.
    let second = uses.iter().filter(is_write).find(|it| clashes(it.0, first.0)).unwrap_or(first);
    let Some(other) = uses.iter().find(|it| clashes(it.0, second.0)) else { return };
    let (name, other) = (&objects[second.0].object.text, &objects[other.0].object.text);
    let others = uses.iter().filter(|it| it.1.site() != second.1.site());
    sink.report(second.1.site(), format!("`{name}` shares memory with `{other}`"))
        .label(format!("changes part of `{other}`"))
        .related_all(others.map(|(object, it)| {
            (it.site(), format!("`{}` is {} here", objects[*object].object.text, it.mode.verb()))
        }));
}

/// Whether two objects that share memory disturb each other. `a` starts first, or is the wider of two that start together.
fn in_conflict(cx: &ProgramCx<'_>, a: &ObjectUses<'_>, b: &ObjectUses<'_>) -> bool {
    let relevant = |it: &Object| {
        let known = it.footprint.area != Area::OpenData;
        matches!(it.class, Class::Memory | Class::Data | Class::Output) && known && !it.extracted
    };
    if !relevant(a.object) || !relevant(b.object) || (a.is_scratch() && b.is_scratch()) {
        return false;
    }
    let (first, second) = (&a.object.footprint, &b.object.footprint);
    match (first.contains(second), second.contains(first)) {
        (true, true) => a.number && b.number && (changes(cx, a) || changes(cx, b)),
        (true, false) => part_disturbs(cx, a, b),
        (false, true) => part_disturbs(cx, b, a),
        // A table shifted along itself is one table; any other pair that shares a part is a mistake in an address.
        (false, false) => {
            let tables = a.object.ty.is_table() && b.object.ty.is_table();
            !tables && (changes(cx, a) || changes(cx, b))
        }
    }
}

/// Whether a part is written by its own address while the whole has a value of its own.
fn part_disturbs(cx: &ProgramCx<'_>, whole: &ObjectUses<'_>, part: &ObjectUses<'_>) -> bool {
    // Tables are made to be used as a whole and by element. Word stores over output bits are W001's and W002's, edge
    // memory is E009's.
    let outputs = whole.object.class == Class::Output && part.object.ty == Type::Bool;
    if whole.object.ty.is_table() || outputs || part.uses.iter().any(|it| it.mode == Mode::EdgeMemory) {
        return false;
    }
    let stores = || running(cx, whole).filter(|it| it.mode == Mode::Store);
    if whole.number {
        // A value that is computed with, given by the program itself.
        stores().any(|it| it.it.constant != Some(0)) && changes(cx, part)
    } else {
        let given = stores().any(|it| matches!(it.it.written, Written::Copy | Written::Number));
        // A whole that also takes patterns, or is put together from its parts elsewhere, is a field of bits.
        let is_field = stores().any(|it| it.it.written == Written::Other);
        let changed = running(cx, part).any(|it| it.mode.writes() && it.mode != Mode::Reset && it.it.constant.is_none());
        given && !is_field && changed
    }
}

/// Uses outside of start-up blocks.
fn running<'p, 'a>(cx: &'p ProgramCx<'_>, uses: &'p ObjectUses<'a>) -> impl Iterator<Item = &'p GlobalUse<'a>> {
    uses.uses.iter().filter(|it| !cx.program.is_startup(it.unit))
}

/// Whether something gives the object a value other than 0.
fn changes(cx: &ProgramCx<'_>, uses: &ObjectUses<'_>) -> bool {
    running(cx, uses).any(|it| it.mode.writes() && it.mode != Mode::InOut && it.it.constant != Some(0))
}

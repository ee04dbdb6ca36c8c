//! W006: memory written under one address and used under another.

use crate::analysis::Site;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Object, Type};
use crate::model::sets::Sets;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let objects = &cx.program.objects;
    // A group: all objects that conflicts join, directly or through others.
    let mut groups = Sets::new(objects.len());
    let mut members: Vec<usize> = Vec::new();
    for &(a, b) in cx.overlaps() {
        let (a, b) = (a as usize, b as usize);
        if in_conflict(cx, &objects[a], &objects[b]) {
            groups.join(a, b);
            members.extend([a, b]);
        }
    }
    members.sort_unstable();
    members.dedup();
    members.sort_by_key(|it| groups.find(*it));
    for group in members.chunk_by(|a, b| groups.find(*a) == groups.find(*b)) {
        report(cx, group, sink);
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
    let clashes = |a: usize, b: usize| {
        let share = objects[a].object.footprint.overlaps(&objects[b].object.footprint);
        a != b && share && in_conflict(cx, &objects[a.min(b)], &objects[a.max(b)])
    };
    // The write that changes what another address holds; where one address alone is written, that write.
    let second = uses.iter().filter(is_write).find(|it| clashes(it.0, first.0)).unwrap_or(first);
    let Some(other) = uses.iter().find(|it| clashes(it.0, second.0)) else { return };
    let (name, other) = (&objects[second.0].object.text, &objects[other.0].object.text);
    let others = uses.iter().filter(|it| it.1.site() != second.1.site());
    sink.report(second.1.site(), format!("`{name}` shares memory with `{other}`"))
        .label(format!("changes part of `{other}`"))
        .related_all(
            others.map(|(object, it)| {
                (it.site(), format!("`{}` is {} here", objects[*object].object.text, it.mode.verb()))
            }),
        );
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

/// Whether a part is written by its own address while the program gives the whole a value that it computes with. A whole
/// that is only copied in and out is an image of its parts.
fn part_disturbs(cx: &ProgramCx<'_>, whole: &ObjectUses<'_>, part: &ObjectUses<'_>) -> bool {
    // Tables are made to be used as a whole and by element. Word stores over output bits are W001's and W002's, edge
    // memory is E009's.
    let outputs = whole.object.class == Class::Output && part.object.ty == Type::Bool;
    let edge_memory = || part.uses.iter().any(|it| it.mode == Mode::EdgeMemory);
    let gives = |it: &GlobalUse<'_>| it.mode == Mode::Store && it.it.constant() != Some(0);
    let candidate = whole.number && !whole.object.ty.is_table() && !outputs;
    candidate && running(cx, whole).any(gives) && changes(cx, part) && !edge_memory()
}

/// Uses outside of start-up blocks, without writes that change nothing.
fn running<'p, 'a>(cx: &'p ProgramCx<'_>, uses: &'p ObjectUses<'a>) -> impl Iterator<Item = &'p GlobalUse<'a>> {
    let own_value = |it: &GlobalUse<'_>| it.it.own && it.mode != Mode::Set;
    uses.uses.iter().filter(move |it| !cx.program.is_startup(it.unit) && !own_value(it))
}

/// Whether something gives the object a value other than 0.
fn changes(cx: &ProgramCx<'_>, uses: &ObjectUses<'_>) -> bool {
    running(cx, uses).any(|it| it.mode.writes() && it.mode != Mode::InOut && it.it.constant() != Some(0))
}

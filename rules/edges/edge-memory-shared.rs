//! E009: the memory bit of an edge that something else changes.

use std::collections::BTreeSet;

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        if uses.has_mode(|it| it == Mode::EdgeMemory) && uses.object.is_fixed() {
            let mut all = uses.uses.clone();
            for &other in cx.neighbours(at) {
                let other = &cx.program.objects[other as usize];
                if other.object.footprint.contains(&uses.object.footprint) && other.object.ty != Type::Bool {
                    all.extend(other.with_mode(|it| it == Mode::Store));
                }
            }
            judge(cx, uses.object, all, sink);
        }
    }
    // Memory of a block's own: nobody else has a name for it.
    for (unit, facts) in cx.program.judged_units() {
        let edges = facts.uses.iter().filter(|it| it.mode == Mode::EdgeMemory);
        for object in edges.map(|it| it.object).collect::<BTreeSet<_>>() {
            let Some(fact) = facts.objects.get(object as usize) else { continue };
            let is_own = matches!(fact.object.class, Class::LocalName | Class::LocalData | Class::InstanceData);
            if is_own && fact.object.is_fixed() {
                let own = facts.uses.iter().filter(|it| it.object == object);
                judge(cx, &fact.object, own.map(|it| GlobalUse { unit, mode: it.mode, it }).collect(), sink);
            }
        }
    }
}

/// Reports the second of two places that both take part in one scan: an edge, or a write of anything but a constant,
/// which arms the edge anew on purpose.
fn judge(cx: &ProgramCx<'_>, object: &Object, mut uses: Vec<GlobalUse<'_>>, sink: &mut Sink<'_, Site>) {
    let is_edge = |it: &GlobalUse<'_>| it.mode == Mode::EdgeMemory;
    let gives = |it: &GlobalUse<'_>| (it.mode.assigns() || it.mode == Mode::Store) && it.it.constant().is_none();
    uses.retain(|it| is_edge(it) || gives(it));
    if !uses.iter().any(is_edge) {
        return;
    }
    drives::in_order(cx.program, &mut uses);
    let Some((second, others)) = drives::conflict(cx.program, &uses, |a, b| is_edge(a) || is_edge(b)) else { return };
    // The edge is what goes wrong: where one of several does, the second.
    let edges: Vec<&GlobalUse<'_>> = uses.iter().filter(|it| is_edge(it)).collect();
    let place = if is_edge(&second) { second } else { **edges.last().unwrap_or(&&second) };
    let message = match edges.len() {
        1 => format!("the edge memory `{}` is also written elsewhere", object.text),
        _ => format!("`{}` is the memory of more than one edge", object.text),
    };
    let others = others.iter().chain([&second]).filter(|it| it.site() != place.site());
    sink.report(place.site(), message).related_all(others.map(|it| (it.site(), format!("{} here", it.mode.verb()))));
}

//! W009: an output that its only assignment gives no value in some scans.

use crate::analysis::Site;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{Entity, Part};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;
use crate::syntax::Language;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut found: Vec<(u32, u32, &ObjectUses<'_>, GlobalUse<'_>)> = Vec::new();
    for (at, uses) in (0..).zip(&cx.program.objects) {
        let is_output = uses.object.class == Class::Output && uses.object.ty == Type::Bool && uses.object.is_fixed();
        // A table or word that covers the output, or an index, may give it its value.
        let otherwise = || cx.neighbours(at).iter().any(|&it| cx.program.objects[it as usize].is_written());
        if is_output
            && let Some((condition, write)) = lone_assignment(cx, uses)
            && !otherwise()
            && !cx.program.unseen(uses).is_written_by_index()
        {
            found.push((write.unit, condition, uses, write));
        }
    }
    // Outputs that one condition passes by have one cause.
    found.sort_by_key(|it| (cx.program.order[it.0 as usize], it.1, it.3.it.anchor));
    for group in found.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (.., uses, write) = &group[0];
        let others = group[1..].iter().map(|(.., uses, it)| (it.site(), format!("`{}`, too", uses.object.text)));
        sink.report(write.site(), format!("`{}` is assigned under a condition alone", uses.object.text))
            .label("keeps its last value when this is passed by")
            .related_all(others);
    }
}

/// The first place that writes an object, with its condition: when one unit alone assigns it, not every run of the unit
/// does, and something else than a constant is assigned. Constants under conditions store a bit as set and reset do.
fn lone_assignment<'a>(cx: &ProgramCx<'_>, uses: &ObjectUses<'a>) -> Option<(u32, GlobalUse<'a>)> {
    let mut writes = uses.with_mode(Mode::writes);
    let first = writes.next()?;
    let is_plain = |it: &GlobalUse<'_>| it.unit == first.unit && matches!(it.mode, Mode::Assign | Mode::AssignNot);
    // In an action of a step, the last value is kept on purpose, or G rules speak.
    let in_chart = matches!(cx.program.entity(first.unit), Entity::Pl7 { part: Part::Chart(_), .. });
    // A value that depends on the output's own is to be kept.
    let computes = uses.with_mode(Mode::writes).any(|it| it.it.constant().is_none() && !it.it.holds);
    // In ladder, what a jump leads past shows.
    let language = cx.program.units[first.unit as usize].language;
    let is_text = matches!(language, Language::Awl(_) | Language::Step5(_) | Language::Pl7Il | Language::Pl7St);
    let is_lone = is_plain(first) && writes.all(is_plain) && computes && is_text && !in_chart;
    Some((cx.program.missed(first).filter(|_| is_lone)?, *first))
}

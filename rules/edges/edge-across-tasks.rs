//! E003: the edge of a bit, tested in another task than the one that makes its value.

use crate::analysis::program::{Context, GlobalUse, ObjectUses};
use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        if !uses.has_mode(Mode::is_edge) || uses.object.ty != Type::Bool || !uses.object.is_fixed() {
            continue;
        }
        match uses.object.class {
            Class::Input => exchanged(cx, uses, sink),
            Class::Memory | Class::Output => written(cx, at, uses, sink),
            _ => {}
        }
    }
}

/// A bit whose every write lies in another task.
fn written<'a>(cx: &ProgramCx<'a>, at: u32, uses: &ObjectUses<'a>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(Mode::writes).copied().collect();
    writes.extend(drives::covering(program, uses, cx.neighbours(at)));
    // Of set and reset E001 speaks, of outputs that an event exchanges E004.
    let stored = writes.iter().any(|it| matches!(it.mode, Mode::Set | Mode::Reset));
    let by_event = |it: &GlobalUse<'_>| program.tasks(it.unit).any(|it| matches!(it, Context::Event(_)));
    if writes.is_empty() || stored || (uses.object.class == Class::Output && uses.uses.iter().any(by_event)) {
        return;
    }
    drives::in_order(program, &mut writes);
    let apart = |edge: &&GlobalUse<'_>| writes.iter().all(|it| program.in_other_tasks(it.unit, edge.unit));
    let Some(edge) = uses.with_mode(Mode::is_edge).find(apart) else { return };
    let (name, here) = (&uses.object.text, program.task_names(edge.unit));
    let there = program.task_names(writes[0].unit);
    sink.report(edge.site(), format!("the edge of `{name}` is tested in {here}, and {there} writes the bit"))
        .related_all(writes.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))));
}

/// An input that another task exchanges.
fn exchanged(cx: &ProgramCx<'_>, uses: &ObjectUses<'_>, sink: &mut Sink<'_, Site>) {
    let Some(task) = cx.settings.task_of(uses.object) else { return };
    // An event exchanges what it uses by itself.
    let apart = |edge: &&GlobalUse<'_>| {
        let mut tasks = cx.program.tasks(edge.unit).peekable();
        tasks.peek().is_some() && tasks.all(|it| it != task && matches!(it, Context::Cyclic | Context::Fast))
    };
    let Some(edge) = uses.with_mode(Mode::is_edge).find(apart) else { return };
    let (name, here) = (&uses.object.text, cx.program.task_names(edge.unit));
    let there = task.name(cx.program.family);
    sink.report(edge.site(), format!("the edge of `{name}` is tested in {here}, and {there} exchanges the input"))
        .note("which task exchanges an input is what `[[task]]` of the configuration says");
}

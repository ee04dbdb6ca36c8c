//! G024: actions of one evolution, of which the later undoes the earlier.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::chart::{Action, Chart, Left, Transition};
use crate::analysis::facts::FactObject;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::ActionKind;
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for chart in cx.program.charts() {
        let leaving = chart.leaving();
        let mut seen: FxHashSet<&_> = FxHashSet::default();
        for (at, step) in (0..).zip(&chart.steps) {
            // A step that is drawn twice has its actions once.
            if step.it.name.as_ref().is_none_or(|it| !seen.insert(it)) {
                continue;
            }
            within_step(cx, chart, at, sink);
            from_step(cx, chart, at, &leaving[at as usize], sink);
        }
    }
}

/// The action at activation, and the continuous one of the same scan.
fn within_step<'a>(cx: &ProgramCx<'a>, chart: &Chart<'a>, step: u32, sink: &mut Sink<'_, Site>) {
    let only = |kind| cx.program.actions().only(chart, step, kind);
    let (Some(first), Some(second)) = (only(ActionKind::Activation), only(ActionKind::Continuous)) else { return };
    for (object, before) in bits(cx, first) {
        let Some(after) = second.left(&cx.program.units, object).filter(|it| it.is_sure) else { continue };
        let opposed = before.value.is_some() && after.value == before.value.map(|it| !it);
        if opposed && !is_read_between(cx, object, &[first, second]) {
            let (text, name) = (&object.object.text, &chart.steps[step as usize].it.text);
            let (was, is) = (verb(before.value), verb(after.value));
            let message = format!(
                "`{text}` is {was} at the activation of step `{name}`, and {is} by its continuous action in the same scan"
            );
            report(sink, (second, after), (first, before), message);
        }
    }
}

/// The action at deactivation, and those of the steps that come next. What is reset and set again stays on, as is meant.
fn from_step<'a>(
    cx: &ProgramCx<'a>,
    chart: &Chart<'a>,
    step: u32,
    leaving: &[&Transition<'a>],
    sink: &mut Sink<'_, Site>,
) {
    let actions = cx.program.actions();
    let Some(first) = actions.only(chart, step, ActionKind::Deactivation) else { return };
    if leaving.is_empty() || leaving.iter().any(|it| !it.is_whole) {
        return;
    }
    for (object, before) in bits(cx, first).filter(|it| it.1.value == Some(true)) {
        let undone = |target: u32| {
            let only = |kind| actions.only(chart, target, kind);
            let later = [only(ActionKind::Continuous), only(ActionKind::Activation)].into_iter().flatten();
            let last = later.filter_map(|it| Some((it, it.left(&cx.program.units, object)?))).next()?;
            (last.1.is_sure && last.1.value == Some(false)).then_some((target, last))
        };
        let undone: Option<Vec<_>> =
            leaving.iter().map(|it| it.targets.iter().find_map(|&target| undone(target))).collect();
        let Some(undone) = undone else { continue };
        let Some(&(target, (second, after))) = undone.first() else { continue };
        let mut concerned = vec![first];
        concerned.extend(undone.iter().flat_map(|it| actions.of(chart, it.0)));
        if is_read_between(cx, object, &concerned) {
            continue;
        }
        let name = |step: u32| &chart.steps[step as usize].it.text;
        let (text, from, to) = (&object.object.text, name(step), name(target));
        let message =
            format!("`{text}` is set at the deactivation of step `{from}`, and reset by step `{to}` in the same scan");
        report(sink, (second, after), (first, before), message);
    }
}

fn report(sink: &mut Sink<'_, Site>, after: (Action<'_>, &Left), before: (Action<'_>, &Left), message: String) {
    let site = |it: (Action<'_>, &Left)| Site { unit: it.0.unit, anchor: it.1.anchor };
    sink.report(site(after), message)
        .related(site(before), format!("{} here", verb(before.1.value)))
        .note("actions run in the order deactivation, activation, continuous (PL7:4565-4569)");
}

fn verb(value: Option<bool>) -> &'static str {
    if value == Some(true) { "set" } else { "reset" }
}

/// Bits of the program that an action leaves.
fn bits<'a>(cx: &ProgramCx<'a>, action: Action<'a>) -> impl Iterator<Item = (&'a FactObject, &'a Left)> {
    let objects = &cx.program.units[action.unit as usize].objects;
    let is_bit = |it: &FactObject| {
        matches!(it.object.class, Class::Memory | Class::Output | Class::Symbol) && it.object.is_fixed()
    };
    /// Of an action that writes more bits than this, the first.
    const MOST: usize = 256;
    action
        .it
        .left
        .iter()
        .take(MOST)
        .filter_map(|it| Some((objects.get(it.object as usize)?, it)))
        .filter(move |it| is_bit(it.0))
}

/// Whether something may see the bit before it is undone: the actions themselves, or what they can call.
fn is_read_between(cx: &ProgramCx<'_>, object: &FactObject, actions: &[Action<'_>]) -> bool {
    let program = cx.program;
    let Some(at) = program.object_of(object) else { return true };
    let with = cx.neighbours(at).iter().filter_map(|&it| program.objects.get(it as usize));
    std::iter::once(&program.objects[at as usize]).chain(with).any(|uses| {
        uses.with_mode(Mode::reads)
            .any(|it| !program.is_entry(it.unit) || actions.iter().any(|action| action.holds(it.site())))
    })
}

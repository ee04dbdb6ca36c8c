//! G029: a step that is left on a sensor alone, and whose time nothing checks.

use std::cell::LazyCell;

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::chart::{Chart, FactReceptivity, Transition};
use crate::analysis::facts::FactObject;
use crate::analysis::flow::Flow;
use crate::analysis::program::ObjectUses;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::StepKind;
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if cx.program.charts().is_empty() {
        return;
    }
    let times = || cx.program.objects.iter().filter(|it| it.object.class == Class::StepTime && it.is_read());
    // Which step an index means is known when the program runs.
    if times().any(|it| !it.object.is_fixed() || it.object.ty.is_table()) {
        return;
    }
    let flow = LazyCell::new(|| Flow::new(cx.program));
    for chart in cx.program.charts().iter().filter(|it| !it.has_gaps) {
        let checked: FxHashSet<u32> = times().filter_map(|it| chart.step_at(&it.object.footprint)).collect();
        let leaving = chart.leaving();
        for (at, step) in (0..).zip(&chart.steps) {
            let waits = matches!(step.it.kind, StepKind::Simple);
            let is_first = step.it.name.as_ref().is_some_and(|it| chart.step_named(it) == Some(at));
            if !waits || !is_first || checked.contains(&at) || !acts(cx, chart, at) {
                continue;
            }
            let leaving = &leaving[at as usize];
            let sensors: Option<Vec<Vec<&str>>> = leaving.iter().map(|it| sensors(cx, it)).collect();
            let mut sensors: Vec<&str> = sensors.unwrap_or_default().concat();
            sensors.sort_unstable();
            sensors.dedup();
            let waits = match &sensors[..] {
                [] => continue,
                _ if is_timed(cx, chart, at, &flow) => continue,
                [only] => format!("`{only}` alone"),
                several => format!("the inputs `{}` alone", several.join("`, `")),
            };
            let name = &step.it.text;
            sink.report(step.site(), format!("step `{name}` waits for {waits}, and nothing checks its time"))
                .related_all(leaving.iter().map(|it| (it.site(), "it is left here".to_owned())))
                .note("this assumes a sensor, and not a button that somebody presses");
        }
    }
}

/// The inputs that a receptivity asks for, when it depends on inputs and steps alone.
fn sensors<'a>(cx: &ProgramCx<'a>, it: &Transition<'a>) -> Option<Vec<&'a str>> {
    let FactReceptivity::Guard(guard) = &it.it.receptivity else { return None };
    let all: &'a [FactObject] = &cx.program.units.get(it.unit as usize)?.objects;
    let objects: Option<Vec<&FactObject>> = guard.objects().map(|it| all.get(it.0 as usize)).collect();
    let objects = objects.filter(|_| guard.is_understood())?;
    let is_plain = |it: &&FactObject| matches!(it.object.class, Class::Input | Class::Step);
    let inputs = objects.iter().filter(|it| it.object.class == Class::Input);
    let inputs: Vec<&str> = inputs.map(|it| it.object.text.as_str()).collect();
    (!inputs.is_empty() && objects.iter().all(is_plain)).then_some(inputs)
}

/// Whether a step drives something: by an action, or by its bit outside of the charts.
fn acts<'a>(cx: &ProgramCx<'a>, chart: &Chart<'a>, step: u32) -> bool {
    let has_action = cx.program.actions().of(chart, step).iter().any(|it| !it.it.anchors.is_empty());
    let is_bit =
        |it: &&ObjectUses<'_>| it.object.class == Class::Step && chart.step_at(&it.object.footprint) == Some(step);
    has_action || cx.program.objects.iter().filter(is_bit).any(ObjectUses::is_read)
}

/// Whether a timer runs with the step: its actions drive a block or call something, or what depends on its bit or on what
/// they write drives one.
fn is_timed<'a>(cx: &ProgramCx<'a>, chart: &Chart<'a>, step: u32, flow: &Flow) -> bool {
    let actions = cx.program.actions().of(chart, step);
    let by_action = actions.iter().any(|action| {
        let unit = cx.program.units[action.unit as usize];
        let within = |anchor: u32| action.it.anchors.contains(&anchor);
        let mut uses = unit.uses.iter();
        uses.any(|it| within(it.anchor) && matches!(it.mode, Mode::Drive(_)))
            || unit.calls.iter().any(|it| within(it.anchor))
    });
    let is_of_step = |it: &ObjectUses<'_>| {
        it.object.class == Class::Step && chart.step_at(&it.object.footprint) == Some(step)
            || it.with_mode(Mode::writes).any(|it| actions.iter().any(|action| action.holds(it.site())))
    };
    let of_step = (0..).zip(&cx.program.objects).filter(|it| is_of_step(it.1)).map(|it| it.0);
    by_action || flow.reaches_block(of_step.collect())
}

//! G026: a step that the preliminary processing resets, and whose action at deactivation does something.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::chart::{Action, Chart};
use crate::analysis::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::ActionKind;
use crate::model::entity::{Entity, Part};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if program.charts().is_empty() {
        return;
    }
    let is_preliminary =
        |it: &&GlobalUse<'_>| matches!(program.entity(it.unit), Entity::Pl7 { part: Part::Preliminary, .. });
    for uses in program.objects.iter().filter(|it| it.object.class == Class::Step && it.object.is_fixed()) {
        let resets = |it: &&GlobalUse<'_>| it.mode == Mode::Reset || it.mode.assigns() && it.it.constant() == Some(0);
        let mut places = uses.with_mode(Mode::writes).filter(is_preliminary).filter(resets);
        let Some(reset) = places.next() else { continue };
        for chart in program.charts() {
            let Some(step) = chart.step_at(&uses.object.footprint) else { continue };
            let Some(action) = program.actions().only(chart, step, ActionKind::Deactivation) else { continue };
            let preset = preset(program, chart, reset);
            let Some((object, place)) = relied_on(program, action, &preset) else { continue };
            let (step, name) = (&chart.steps[step as usize].it.text, &object.object.text);
            let message = format!(
                "`{}` is reset here without the action at the deactivation of step `{step}`, which alone writes `{name}`",
                program.text_of(reset)
            );
            sink.report(reset.site(), message)
                .related(place.site(), format!("`{name}` is {} here", place.mode.verb()))
                .related_all(places.by_ref().map(|it| (it.site(), "reset here, too".to_owned())))
                .note("the actions at the deactivation of a step are not run when it is reset (PL7:4980)");
        }
    }
}

/// The actions of steps that the same processing sets.
fn preset<'a>(program: &ProgramIndex<'a>, chart: &Chart<'a>, reset: &GlobalUse<'_>) -> Vec<Action<'a>> {
    let steps = program.objects.iter().filter(|it| it.object.class == Class::Step && it.object.is_fixed());
    let is_set = |it: &GlobalUse<'_>| it.unit == reset.unit && it.mode != Mode::Reset && it.it.constant() != Some(0);
    let set = steps.filter(|it| it.with_mode(Mode::writes).any(is_set));
    set.filter_map(|it| chart.step_at(&it.object.footprint))
        .flat_map(|it| program.actions().of(chart, it))
        .copied()
        .collect()
}

/// What an action writes and no code outside of charts does, nor an action that runs in its place.
fn relied_on<'p, 'a>(
    program: &'p ProgramIndex<'a>,
    action: Action<'_>,
    instead: &[Action<'_>],
) -> Option<(&'p ObjectUses<'a>, &'p GlobalUse<'a>)> {
    let mut of: FxHashSet<u32> = FxHashSet::default();
    of.extend(action.it.left.iter().map(|it| it.object));
    let is_of_chart = |unit: u32| matches!(program.entity(unit), Entity::Pl7 { part: Part::Chart(_), .. });
    let written = |it: &&'p ObjectUses<'a>| {
        let is_value = matches!(it.object.class, Class::Memory | Class::Output | Class::Symbol) && it.object.is_fixed();
        let mut writes = it.with_mode(Mode::writes);
        is_value
            && !program.unseen(it).is_written()
            && writes.all(|it| is_of_chart(it.unit) && !instead.iter().any(|action| action.holds(it.site())))
    };
    let mine = |it: &&'p GlobalUse<'a>| of.contains(&it.it.object) && action.holds(it.site());
    program.objects.iter().filter_map(|it| Some((it, it.with_mode(Mode::writes).find(mine)?))).find(|it| written(&it.0))
}

//! P011: an output that the master task writes and the fast task sends.

use crate::analysis::program::{Context, GlobalUse, ProgramIndex};
use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Task;
use crate::model::object::{Area, Class, Object};
use crate::model::unit::Mode;
use crate::target::pl72::FastTaskChannels;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let mut units = (0..).zip(&program.units);
    let is_fast = |facts: &crate::analysis::facts::UnitFacts| facts.entity.task() == Some(Task::Fast);
    let Some((fast, _)) = units.find(|it| is_fast(it.1) && !it.1.uses.is_empty()) else { return };
    for uses in program.objects_that(|it| it == Class::Output, Object::is_fixed) {
        let Some((source, configured)) = owner(cx, uses.object) else { continue };
        let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(Mode::writes).copied().collect();
        // Of what both tasks write, W005 speaks.
        let in_task = |it: &GlobalUse<'_>, task: Context| program.tasks(it.unit).any(|it| it == task);
        if writes.iter().any(|it| in_task(it, Context::Fast)) {
            continue;
        }
        writes.retain(|it| in_task(it, Context::Cyclic));
        drives::in_order(program, &mut writes);
        let Some((first, others)) = writes.split_first() else { continue };
        let message = format!("`{}` is written in MAST, and the fast task sends it too", uses.object.text);
        sink.report(first.site(), message)
            .related_all(others.iter().map(|it| (it.site(), "also written here".to_owned())))
            .related(ProgramIndex::heading(fast), "the fast task")
            .related_all(configured.map(|it| (it, "the channels of the fast task".to_owned())))
            .note(source);
    }
}

/// Who says that the fast task sends an output, and where in the configuration.
fn owner(cx: &ProgramCx<'_>, object: &Object) -> Option<(String, Option<Site>)> {
    let listed = cx.settings.tasks().iter().filter(|it| it.context() == Some(Context::Fast)).flat_map(|it| &it.io);
    if let Some(channels) = listed.clone().find(|it| it.get_ref().0.footprint.overlaps(&object.footprint)) {
        let text = &channels.get_ref().0.text;
        let note = format!("`{text}` is among the channels that the configuration gives the fast task");
        return Some((note, Some(cx.settings.site(channels))));
    }
    let series = cx.target.pl72()?.controller?.series;
    match series.fast_task_channels() {
        FastTaskChannels::Modules { output, source, .. } => {
            let is_own = object.footprint.area == Area::OutputChannels(output.to_string().into());
            let note = || format!("the fast task owns the outputs of module {output}, according to {source}");
            is_own.then(|| (note(), None))
        }
        FastTaskChannels::Bytes { .. } | FastTaskChannels::Configured { .. } => None,
    }
}

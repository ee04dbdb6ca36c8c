//! P010: words of an intelligent module in the fast task.

use crate::analysis::program::{Context, GlobalUse};
use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Area;
use crate::target::pl72::Feature;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // Of a controller that has no such modules, O006 speaks.
    if cx.target.pl72().is_none_or(|it| !it.has(Feature::Couplers)) {
        return;
    }
    for uses in program.objects_that(|_| true, |it| matches!(it.footprint.area, Area::ModuleWords(_))) {
        let is_fast = |it: &&GlobalUse<'_>| program.tasks(it.unit).any(|it| it == Context::Fast);
        let mut places: Vec<GlobalUse<'_>> = uses.uses.iter().filter(is_fast).copied().collect();
        drives::in_order(program, &mut places);
        let Some((first, others)) = places.split_first() else { continue };
        let message =
            format!("`{}` is a word of an intelligent module, and the fast task manages none", uses.object.text);
        sink.report(first.site(), message)
            .related_all(others.iter().map(|it| (it.site(), "also here".to_owned())))
            .note("according to PL72:1892");
    }
}

//! P012: events are masked, and never unmasked.

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if !program.complete {
        return;
    }
    let is_called = |it: &&GlobalCall<'_>, name: &str| {
        let runs = it.it.reachable && program.reached[it.unit as usize];
        runs && matches!(&it.it.callee, Callee::Function(function) if function == name)
    };
    if program.calls.iter().any(|it| is_called(&it, "UNMASKEVT")) {
        return;
    }
    let mut masks: Vec<&GlobalCall<'_>> = program.calls.iter().filter(|it| is_called(it, "MASKEVT")).collect();
    masks.sort_by_key(|it| (program.order[it.unit as usize], it.index));
    let Some((first, others)) = masks.split_first() else { return };
    sink.report(first.site(), "events are masked here, and nothing that runs unmasks them")
        .related_all(others.iter().map(|it| (it.site(), "also here".to_owned())));
}

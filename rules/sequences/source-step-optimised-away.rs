//! Q011: a source transition that does not run while no step is active.

use crate::analysis::Site;
use crate::analysis::sequences::tables::FaultKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.sequences().faults.iter().filter(|it| it.kind == FaultKind::PassedBy) {
        sink.report(it.site, it.message.clone())
            .related_all(it.related.iter().cloned())
            .note("a branch that begins with a transition needs it while nothing is active; add a step before it, or leave the test out");
    }
}

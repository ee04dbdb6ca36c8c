//! Q008: what the steps of a table drive is computed before the steps are.

use crate::analysis::Site;
use crate::analysis::sequences::tables::FaultKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.sequences().faults.iter().filter(|it| it.kind == FaultKind::Misplaced) {
        sink.report(it.site, it.message.clone())
            .label("too early in the scan")
            .related_all(it.related.iter().cloned())
            .note("the order is: preliminary processing, graphs, forces, counters, timers, outputs");
    }
}

//! Q006: the activities of the scan before, on which the steps of a table are computed, are not those.

use crate::analysis::Site;
use crate::analysis::sequences::tables::FaultKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.sequences().faults.iter().filter(|it| it.kind == FaultKind::Stale) {
        sink.report(it.site, it.message.clone())
            .related_all(it.related.iter().cloned())
            .note("copy it once, before all steps: they are computed from what was active when the scan began");
    }
}

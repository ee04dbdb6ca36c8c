//! Q010: a force to 0 that wins over one to 1.

use crate::analysis::Site;
use crate::analysis::sequences::tables::FaultKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.sequences().faults.iter().filter(|it| it.kind == FaultKind::ForcedOff) {
        sink.report(it.site, it.message.clone())
            .related_all(it.related.iter().cloned())
            .note("a step that one graph forces to 1 and another one to 0 stays active");
    }
}

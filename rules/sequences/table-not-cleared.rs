//! Q007: a table that keeps bits of scans before.

use crate::analysis::Site;
use crate::analysis::sequences::tables::FaultKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.sequences().faults.iter().filter(|it| it.kind == FaultKind::NotCleared) {
        sink.report(it.site, it.message.clone())
            .related_all(it.related.iter().cloned())
            .note("a bit that one scan set is still there in the next: clear the table where the work on it begins");
    }
}

//! C006: a timer, counter or other function block beyond what the controller or its configuration has.

use crate::analysis::{Site, counts};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in counts::beyond_blocks(cx.numbers(), cx.target) {
        let Some((first, others)) = it.sites(cx.program) else { continue };
        sink.report(first, it.message(cx.target))
            .related_all(others.map(|it| (it, "also used here".to_owned())))
            .note(it.note());
    }
}

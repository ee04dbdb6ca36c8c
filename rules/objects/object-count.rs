//! O003: an object number beyond what the controller or its configuration has.

use crate::analysis::{Site, counts, drives, modules};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in counts::beyond(cx.numbers(), cx.target) {
        let Some((first, others)) = it.sites(cx.program) else { continue };
        sink.report(first, it.message(cx.target))
            .related_all(others.map(|it| (it, "also used here".to_owned())))
            .note(it.note());
    }
    let Some(model) = cx.target.pl72() else { return };
    for it in modules::misplaced(cx.program, &model) {
        let mut places = it.uses.uses.clone();
        drives::in_order(cx.program, &mut places);
        let Some((first, others)) = places.split_first() else { continue };
        sink.report(first.site(), format!("`{}` does not exist: {}", it.uses.object.text, it.reason))
            .related_all(others.iter().map(|it| (it.site(), "also used here".to_owned())))
            .note(format!("according to {}", it.source));
    }
}

//! W008: a write that others override before anything reads it.

use crate::analysis::{Site, liveness};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in liveness::of_program(cx.program, |at| cx.neighbours(at)) {
        let site = |anchor| Site { unit: it.unit, anchor };
        let [first, others @ ..] = it.writes.as_slice() else { continue };
        let [ways @ .., last] = &*first.by else { continue };
        sink.report(site(*last), format!("`{}` is overwritten before anything reads it", it.text))
            .label("overwritten here")
            .related(site(first.write), "what is written here is lost")
            .related_all(ways.iter().map(|way| (site(*way), "and here, on another way".to_owned())))
            .related_all(others.iter().map(|it| (site(it.write), "what is written here is lost, too".to_owned())));
    }
}

//! Q002: a loop of two steps coded by set and reset, which one scan can run through.

use crate::analysis::Site;
use crate::analysis::sequences::judge::DeviationKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for sequence in &cx.sequences().list {
        for found in sequence.deviations.iter().filter(|it| it.kind == DeviationKind::Undone) {
            let Some(reset) = cx.sequences().reset_of(sequence, found) else { continue };
            let (step, other) = (sequence.name(found.step), sequence.names(&found.situation));
            let message = format!("the loop of {other} and `{step}` ends the scan where it began {}", found.when());
            sink.report(reset, message)
                .label(format!("goes back in the scan that went on to `{step}`"))
                .related_all(cx.sequences().set_of(sequence, found).map(|it| (it, format!("switches `{step}` on"))))
                .notes(found.besides())
                .note(sequence.note(found.step))
                .note("let the two conditions exclude each other, or add a step, or keep the activities in two tables");
        }
    }
}

//! Q003: a step that is activated and deactivated in one scan, and goes off.

use crate::analysis::Site;
use crate::analysis::sequences::judge::DeviationKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for sequence in &cx.sequences().list {
        let mut seen: Vec<usize> = Vec::new();
        for found in sequence.deviations.iter().filter(|it| it.kind == DeviationKind::Lost) {
            let Some(reset) = cx.sequences().reset_of(sequence, found) else { continue };
            if seen.contains(&found.step) {
                continue;
            }
            seen.push(found.step);
            let step = sequence.name(found.step);
            let message = format!("step `{step}` goes off though it is activated in the same scan {}", found.when());
            sink.report(reset, message)
                .label("undoes the activation")
                .related_all(cx.sequences().set_of(sequence, found).map(|it| (it, format!("activates `{step}`"))))
                .note(format!("the scan begins with {} active", sequence.names(&found.situation)))
                .note("a step that is deactivated and activated at once stays active (rule 5)")
                .notes(found.besides())
                .note(sequence.note(found.step));
        }
    }
}

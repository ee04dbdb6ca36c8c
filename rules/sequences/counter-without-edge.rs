//! Q009: a word that is counted on in each scan while a step is on.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(trace) = &cx.sequences().trace else { return };
    for sequence in &cx.sequences().list {
        for &(event, step) in &sequence.counts {
            let Some(event) = trace.events.get(event) else { continue };
            let (word, step_name) = (&trace.object(event.object).text, sequence.name(step));
            sink.report(event.site, format!("`{word}` counts in each scan while step `{step_name}` is on"))
                .label("counted on without an edge of the step")
                .related_all(sequence.steps.get(step).map(|it| (it.site(), format!("`{step_name}` goes on here"))))
                .note("count on the rising edge of the step: `FP`, or the step now and not in the scan before")
                .note(sequence.note(step));
        }
    }
}

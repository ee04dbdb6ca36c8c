//! B011: steps that outlast a power failure, and that no start-up block puts in order.

use crate::analysis::Site;
use crate::analysis::program::Context;
use crate::analysis::sequences::SequenceStep;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(bytes) = cx.target.retentive_bytes() else { return };
    for sequence in cx.sequences().list.iter().filter(|it| !it.has_gaps) {
        let is_kept = |it: &SequenceStep<'_>| {
            let place = &it.object.footprint;
            it.object.class == Class::Memory && place.area == Area::Words && bytes.contains(place.start / 8)
        };
        let left: Vec<usize> = (0..)
            .zip(&sequence.steps)
            .filter(|(_, it)| is_kept(it) && !is_put_at_start_up(cx, it))
            .map(|it| it.0)
            .collect();
        let Some((&first, others)) = left.split_first() else { continue };
        let it = &sequence.steps[first];
        let message = match others {
            [] => format!("the retentive step {} is not initialised at start-up", sequence.names(&left)),
            _ => format!("the retentive steps {} are not initialised at start-up", sequence.names(&left)),
        };
        sink.report(it.site(), message)
            .label("keeps its value when the power fails")
            .related_all(others.iter().map(|&it| &sequence.steps[it]).map(|it| (it.site(), "so does this".to_owned())))
            .note(format!("MB{} to MB{} are retentive ({})", bytes.first, bytes.last, bytes.source))
            .note("this assumes that the sequence is not meant to go on where the power failed")
            .note(sequence.note(first));
    }
}

/// Whether a start-up block writes the step, or memory that holds it.
fn is_put_at_start_up(cx: &ProgramCx<'_>, step: &SequenceStep<'_>) -> bool {
    let around = cx.neighbours(step.id.0).iter().copied().chain([step.id.0]);
    let mut objects = around.filter_map(|it| cx.program.objects.get(it as usize));
    objects.any(|it| {
        it.object.footprint.contains(&step.object.footprint)
            && it
                .with_mode(|it| it.writes())
                .any(|it| cx.program.contexts[it.unit as usize].contains(&Context::Startup))
    })
}

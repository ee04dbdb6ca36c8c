//! Q012: what the rules about charts say of a sequence that is coded with bits.

use rustc_hash::FxHashSet;

use super::{deadlock, divergence_mismatch, non_exclusive_divergence, unreachable_step, unsafe_activation};
use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (sequence, study) in cx.sequences().list.iter().zip(cx.sequence_studies()) {
        sink.noting(sequence.note(0), |sink| {
            // Branches of which the code takes the first alone are another rule's affair.
            let together = |a: usize, b: usize| sequence.together.contains(&(a, b));
            non_exclusive_divergence::study(study, together, sink);
            divergence_mismatch::study(study, sink);
            unreachable_step::study(study, |_| FxHashSet::default(), sink);
            deadlock::study(study, sink);
            unsafe_activation::study(study, sink);
        });
    }
}

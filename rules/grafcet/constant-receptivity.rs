//! G009: a receptivity that is always true, or never.

use crate::analysis::Site;
use crate::analysis::reach::Guarded;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for study in cx.studies() {
        let net = &study.net;
        for part in &study.parts {
            for &it in &part.component.crossings {
                // A time that is never reached is the affair of the rule about the times of steps.
                let is_asked = match net.crossings[it].guard {
                    Guarded::By(guard) => !net.space().asks_beyond_step_times(guard),
                    Guarded::Never | Guarded::Unknown => false,
                };
                if !is_asked || !net.is_ever_valid(&part.all, it) {
                    continue;
                }
                let can_be = |value| net.can_be(&part.component, &part.all, &[(it, value)]);
                let message = if can_be(true).is_never() {
                    "the receptivity is never true, so the transition is never crossed"
                } else if net.has_objects(it) && can_be(false).is_never() {
                    // A constant is written on purpose.
                    "the receptivity is always true"
                } else {
                    continue;
                };
                sink.report(net.transition(it).site(), message);
            }
        }
    }
}

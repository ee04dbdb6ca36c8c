//! G009: a receptivity that is always true, or never.

use crate::analysis::Site;
use crate::analysis::reach::{Guarded, Part, Study};
use crate::lint::{ProgramCx, Sink};

const NEVER: &str = "the receptivity is never true, so the transition is never crossed";

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for study in cx.studies() {
        for part in &study.parts {
            judge(study, part, sink);
        }
    }
}

fn judge(study: &Study<'_, '_>, part: &Part, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    // A time that is never reached is the affair of the rule about the times of steps.
    let is_asked = |it: usize| match net.crossings[it].guard {
        Guarded::By(guard) => !net.space().asks_beyond_step_times(guard),
        Guarded::Never | Guarded::Unknown => false,
    };
    let site = |it: usize| net.transition(it).site();
    for &it in part.component.crossings.iter().filter(|it| is_asked(**it)) {
        // A constant is written on purpose.
        let is_judged = net.is_ever_valid(&part.all, it) && net.has_objects(it);
        if is_judged && study.is_never(part, &[(it, false)], |it| study.is_dead_beside(part, it)) {
            sink.report(site(it), "the receptivity is always true");
        }
    }
    let stuck = study.stuck(part);
    for &it in stuck.causes.iter().filter(|it| is_asked(**it)) {
        sink.report(site(it), NEVER);
    }
    for circle in &stuck.circles {
        let Some((&first, others)) = circle.split_first() else { continue };
        let mut finding = sink.report(site(first), NEVER);
        for node in net.asked_of(&part.component, first).filter(|it| stuck.behind.contains(it)) {
            let name = net.name(node);
            finding =
                finding.related(net.step(node).site(), format!("step `{name}`, which it waits for, is never active"));
        }
        let _ = finding
            .related_all(others.iter().map(|&it| (site(it), "never true either: one waits for the other".to_owned())));
    }
}

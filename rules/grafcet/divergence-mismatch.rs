//! G015: branches that are opened in one way and closed in the other.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::reach::{MAX_CAUSES, Node, Part, Study};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        study(it, sink);
    }
}

pub(super) fn study(study: &Study<'_, '_>, sink: &mut Sink<'_, Site>) {
    for part in study.parts.iter().filter(|_| !study.net.has_gaps) {
        parallel_as_alternatives(study, part, sink);
        alternatives_as_parallel(study, part, sink);
    }
}

fn parallel_as_alternatives(study: &Study<'_, '_>, part: &Part, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    let mut steps: Vec<_> = part.own.lost.iter().map(|it| (it.2, it.0)).collect();
    steps.sort_unstable();
    steps.dedup_by_key(|it| it.0);
    let mut openings = FxHashSet::default();
    for (step, situation) in steps.into_iter().take(MAX_CAUSES) {
        let Some((opening, [a, b])) = net.opened_in_parallel(&part.component, step) else { continue };
        if !openings.insert(opening) {
            continue;
        }
        sink.report(
            net.step(step).site(),
            format!("parallel branches come together at step `{}` as alternatives", net.name(step)),
        )
        .related(net.transition(opening).site(), "opened here, all at once")
        .related(net.transition(a).site(), "one branch ends here")
        .related(net.transition(b).site(), "the other one here")
        .note(format!(
            "the step is activated once by each branch: {}",
            net.trace(&part.component, &part.own, situation)
        ));
    }
}

fn alternatives_as_parallel(study: &Study<'_, '_>, part: &Part, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    let mut seen = FxHashSet::default();
    for &dead in part.own.dead.iter().take(MAX_CAUSES) {
        let situation = &part.own.situations[dead as usize];
        let active: FxHashSet<Node> = net.active(&part.component, situation).collect();
        for &crossing in &part.component.crossings {
            if !net.crossings[crossing].from.iter().any(|it| active.contains(it)) {
                continue;
            }
            let (missing, held) = net.waits(&part.component, situation, crossing);
            if missing.is_empty() || held.is_empty() || seen.contains(&crossing) {
                continue;
            }
            let Some(step) = net.opened_as_alternatives(&part.component, crossing) else { continue };
            seen.insert(crossing);
            sink.report(
                net.transition(crossing).site(),
                format!("alternative branches of step `{}` are joined as parallel ones", net.name(step)),
            )
            .label("waits for all of them")
            .related(net.step(step).site(), "opened here, one at a time")
            .note(format!("nothing leads on from here: {}", net.trace(&part.component, &part.own, dead)));
        }
    }
}

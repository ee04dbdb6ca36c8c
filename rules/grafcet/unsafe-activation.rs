//! G018: a step that is activated while it is active.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::reach::{MAX_CAUSES, Node, Study};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        study(it, sink);
    }
}

pub(super) fn study(study: &Study<'_, '_>, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    if net.has_gaps {
        return;
    }
    for part in &study.parts {
        let mut seen: FxHashSet<Node> = FxHashSet::default();
        // Parallel branches that come together as alternatives are one rule's affair, and so is what follows from it.
        let lost = || part.own.lost.iter().take(MAX_CAUSES);
        if lost().any(|it| net.opened_in_parallel(&part.component, it.2).is_some()) {
            continue;
        }
        for &(situation, crossing, step) in lost() {
            if !seen.insert(step) {
                continue;
            }
            let message = format!("step `{}` can be activated while it is active", net.name(step));
            sink.report(net.step(step).site(), message)
                .related(net.transition(crossing).site(), "by this transition")
                .note(format!("reached by {}", net.trace(&part.component, &part.own, situation)))
                .note("the step stays active as if once: one of the two sequences that led to it is lost");
        }
    }
}

//! G017: a situation that no transition leaves.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::reach::{Guarded, MAX_CAUSES, Node, Part, Study};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        study(it, sink);
    }
}

pub(super) fn study(study: &Study<'_, '_>, sink: &mut Sink<'_, Site>) {
    if !study.net.has_gaps {
        study.parts.iter().for_each(|it| judge(study, it, sink));
    }
}

fn judge(study: &Study<'_, '_>, part: &Part, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    let (component, reached) = (&part.component, &part.own);
    let mut seen: FxHashSet<Option<usize>> = FxHashSet::default();
    for &dead in reached.dead.iter().take(MAX_CAUSES) {
        let situation = &reached.situations[dead as usize];
        let active: Vec<Node> = net.active(component, situation).collect();
        let out: Vec<usize> = active.iter().flat_map(|it| net.leaving(*it).iter().copied()).collect();
        // A transition that is valid and never crossed is the affair of the rules about its receptivity.
        let is_valid = |it: &usize| net.waits(component, situation, *it).0.is_empty();
        if out.iter().any(is_valid) {
            continue;
        }
        let waiting = out.iter().copied().find(|it| net.crossings[*it].guard != Guarded::Never);
        if !seen.insert(waiting) {
            continue;
        }
        let trace = net.trace(component, reached, dead);
        match waiting {
            Some(crossing) if net.opened_as_alternatives(component, crossing).is_none() => {
                let (missing, held) = net.waits(component, situation, crossing);
                let Some(&step) = held.first() else { continue };
                let list = |nodes: &[Node]| {
                    nodes.iter().map(|it| format!("`{}`", net.name(*it))).collect::<Vec<_>>().join(", ")
                };
                let message = format!("step {} waits for ever for step {}", list(&held), list(&missing));
                sink.report(net.step(step).site(), message)
                    .related(net.transition(crossing).site(), "the transition that waits for both")
                    .note(format!("reached by {trace}"));
            }
            Some(_) => {}
            // A chart that goes round is not meant to end.
            None if out.is_empty() && net.has_loop(component) && !net.is_commanded() => {
                let Some(&step) = active.first() else { continue };
                sink.report(net.step(step).site(), format!("no transition leaves step `{}`", net.name(step)))
                    .note(format!("reached by {trace}"));
            }
            None => {}
        }
    }
}

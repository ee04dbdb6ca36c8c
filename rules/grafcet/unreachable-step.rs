//! G016: steps that are never active.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::reach::{Node, Part, Study};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        study(it, sink);
    }
}

pub(super) fn study(study: &Study<'_, '_>, sink: &mut Sink<'_, Site>) {
    if study.net.has_gaps || !study.net.knows_presets() {
        return;
    }
    for part in &study.parts {
        // Without a start, all of it is another rule's affair.
        if !part.all.is_partial && !part.all.situations.is_empty() {
            judge(study, part, sink);
        }
    }
}

fn judge(study: &Study<'_, '_>, part: &Part, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    let reached: FxHashSet<Node> = part.all.situations.iter().flat_map(|it| net.active(&part.component, it)).collect();
    let never: Vec<Node> = part.component.nodes.iter().copied().filter(|it| !reached.contains(it)).collect();
    // What comes behind a step that is never active has the same cause.
    let is_first = |&node: &Node| {
        net.entering(node).iter().any(|&it| net.crossings[it].from.iter().any(|it| reached.contains(it)))
    };
    let first: Vec<Node> = never.iter().copied().filter(is_first).collect();
    let Some(&primary) = first.first().or(never.first()) else { return };
    let message = format!("step `{}` is never active", net.name(primary));
    let others = never.iter().filter(|it| **it != primary);
    let mut finding = sink
        .report(net.step(primary).site(), message)
        .related_all(others.map(|&it| (net.step(it).site(), format!("nor is step `{}`", net.name(it)))));
    for &it in net.entering(primary) {
        finding = finding.related(net.transition(it).site(), "never crossed");
    }
}

//! G016: steps that are never active.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::reach::{Node, Part, Study};
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::Graph;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        // Behind a receptivity that is never true: the affair of the rules about receptivities.
        study(it, |part| it.stuck(part).behind.clone(), sink);
    }
}

/// `explained`: steps of which another rule says why they are never active.
pub(super) fn study(study: &Study<'_, '_>, explained: impl Fn(&Part) -> FxHashSet<Node>, sink: &mut Sink<'_, Site>) {
    if !study.knows_all() {
        return;
    }
    for part in &study.parts {
        // Without a start, all of it is another rule's affair, unless it is a step that the others leave alone.
        let has_start = !part.all.situations.is_empty();
        if !part.all.is_partial && (has_start || is_left_over(study, part)) {
            judge(study, part, &explained(part), sink);
        }
    }
}

/// Whether nothing connects a step with a chart that transitions make. A text that shows steps alone, without transitions, is
/// no chart.
fn is_left_over(study: &Study<'_, '_>, part: &Part) -> bool {
    let net = &study.net;
    let graph = |at: usize| net.charts[at].graph;
    let in_main = |&it: &Node| graph(net.nodes[it as usize].0) == Graph::Main;
    let is_connected = net.crossings.iter().any(|it| graph(it.chart) == Graph::Main);
    part.component.crossings.is_empty() && is_connected && part.component.nodes.iter().all(in_main)
}

fn judge(study: &Study<'_, '_>, part: &Part, explained: &FxHashSet<Node>, sink: &mut Sink<'_, Site>) {
    let net = &study.net;
    let all = &part.never_active;
    let left: Vec<Node> = all.iter().copied().filter(|it| !explained.contains(it)).collect();
    let all: FxHashSet<Node> = all.iter().copied().collect();
    // What comes behind a step that is never active has the same cause.
    let is_first =
        |&node: &Node| net.entering(node).iter().any(|&it| net.crossings[it].from.iter().any(|it| !all.contains(it)));
    let Some(&primary) = left.iter().find(|it| is_first(it)).or(left.first()) else { return };
    let message = format!("step `{}` is never active", net.name(primary));
    let others = left.iter().filter(|it| **it != primary);
    let mut finding = sink
        .report(net.step(primary).site(), message)
        .related_all(others.map(|&it| (net.step(it).site(), format!("nor is step `{}`", net.name(it)))));
    for &it in net.entering(primary) {
        finding = finding.related(net.transition(it).site(), "never crossed");
    }
}

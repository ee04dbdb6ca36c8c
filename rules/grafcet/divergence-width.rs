//! G002: a divergence or convergence with too many branches.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::chart::LinkKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let (Some(chart), Some(limit)) = (&cx.model.chart, cx.target.chart_branches()) else { return };
    for junction in chart.junctions() {
        let count = junction.branches.len();
        if count <= limit.value as usize {
            continue;
        }
        let what = match junction.kind {
            LinkKind::OrDivergence => "OR divergence",
            LinkKind::OrConvergence => "OR convergence",
            LinkKind::AndDivergence => "AND divergence",
            LinkKind::AndConvergence => "AND convergence",
        };
        let beyond = junction.branches.iter().filter(|it| **it != junction.at).nth(limit.value as usize).copied();
        sink.report(junction.at, format!("this {what} has {count} branches, and {} are allowed", limit.value))
            .related_all(beyond.map(|it| (it, "the first branch beyond".to_owned())))
            .note(format!("the number is given in {}", limit.source));
    }
}

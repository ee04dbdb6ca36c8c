//! G008: a transition without receptivity.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::chart::{Node, Receptivity, Transition};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(chart) = &cx.model.chart else { return };
    let list = |nodes: &[Node]| -> Vec<String> {
        nodes.iter().filter_map(|it| chart.name_of(it)).map(|it| format!("`{it}`")).collect()
    };
    let name = |it: &Transition| {
        let (from, to) = (list(&it.sources), list(&it.targets));
        if from.is_empty() || to.is_empty() {
            return "this transition".to_owned();
        }
        format!("the transition from step {} to step {}", from.join(" and "), to.join(" and "))
    };
    for it in chart.transitions.iter().filter(|it| it.receptivity == Receptivity::Missing) {
        sink.report(it.range, format!("{} has no receptivity, so it is never crossed", name(it)));
    }
}

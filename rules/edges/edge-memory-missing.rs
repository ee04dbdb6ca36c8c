//! E010: the memory bit of a hand-made edge, refreshed before the edge is tested, or passed by.

use rowan::TextRange;

use crate::analysis::edges::{Lost, lost};
use crate::lint::{Sink, UnitCx};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let place = |statement: u32| cx.model.statements.get(statement as usize).map(|it| it.range).unwrap_or_default();
    for edge in lost(cx.model) {
        let name = &cx.model.object(edge.memory).text;
        let (message, label) = match edge.why {
            Lost::Late => (
                format!("`{name}` is refreshed before its edge is tested, so that the edge never shows"),
                "takes the new value here",
            ),
            Lost::PassedBy => (
                format!("this edge is tested in runs that pass by the refresh of its memory `{name}`"),
                "refreshed here",
            ),
        };
        sink.report(place(edge.test), message).related(place(edge.refresh), label);
    }
}

//! T001: an exit that leaves no loop.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::SyntaxKind;

const LOOPS: [SyntaxKind; 3] = [SyntaxKind::WhileStmt, SyntaxKind::RepeatStmt, SyntaxKind::ForStmt];

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    // The loops that stand in no other loop, in the order of the text.
    let mut loops: Vec<TextRange> = LOOPS.into_iter().flat_map(|it| cx.nodes(it)).map(|it| it.text_range()).collect();
    loops.sort_by_key(|it| (it.start(), std::cmp::Reverse(it.end())));
    loops.dedup_by(|inner, outer| outer.contains_range(*inner));
    for exit in cx.nodes(SyntaxKind::ExitStmt) {
        let place = exit.text_range();
        let before = loops.partition_point(|it| it.start() <= place.start());
        if !loops[..before].last().is_some_and(|it| it.contains_range(place)) {
            sink.report(place, "`EXIT` stands outside of a loop");
        }
    }
}

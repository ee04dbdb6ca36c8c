//! T001: an exit that leaves no loop.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::SyntaxKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for exit in cx.nodes(SyntaxKind::ExitStmt) {
        let is_loop = |kind| matches!(kind, SyntaxKind::WhileStmt | SyntaxKind::RepeatStmt | SyntaxKind::ForStmt);
        if !exit.ancestors().any(|it| is_loop(it.kind())) {
            sink.report(exit.text_range(), "`EXIT` stands outside of a loop");
        }
    }
}

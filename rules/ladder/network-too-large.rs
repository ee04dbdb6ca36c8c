//! L001: a rung that does not fit the grid.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Grid;
use crate::syntax::pl7::ast::Rung;
use crate::syntax::{AstNode as _, SyntaxKind};
use crate::target::pl7::LADDER_COLUMNS;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for rung in cx.nodes(SyntaxKind::Rung).filter_map(Rung::cast) {
        let grid = Grid::new(rung);
        for row in &grid.rows {
            let Some(cell) = row.excess else { continue };
            let has_assumed = row.is_assumed;
            let found = sink.report(
                cell.syntax().text_range(),
                format!("this line has {} columns, and a rung has {}", row.columns, LADDER_COLUMNS.value),
            );
            if has_assumed {
                found.note("a function block other than a timer is taken for three columns");
            }
        }
        let Some(limit) = cx.target.ladder_lines() else { continue };
        let lines = grid.lines_used();
        if let Some(first) = grid.rows.get(limit.value as usize).filter(|_| lines > limit.value) {
            let message = format!("this rung has {lines} lines, and the controller's have {}", limit.value);
            sink.report(first.range, message).note(match cx.target.controller() {
                Some(_) => "Micro controllers have 7 lines, Premium controllers 16",
                None => "the controller is not known: 16 lines is what the larger ones have",
            });
        }
    }
}

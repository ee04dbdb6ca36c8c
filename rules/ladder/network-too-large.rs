//! L001: a rung that does not fit the grid.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::Family;
use crate::model::ladder::{Grid, Layout, Row};
use crate::syntax::pl7::ast::Rung;
use crate::syntax::{AstNode as _, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let layout = Layout::of(cx.model.language);
    for rung in cx.nodes(SyntaxKind::Rung).filter_map(Rung::cast) {
        let rows = Grid::rows_of(rung, layout);
        // Where a cell was not read, nobody knows how many there are.
        for row in &rows {
            let Some(cell) = row.excess.filter(|_| !rung.syntax().has_error()) else { continue };
            let has_assumed = row.is_assumed;
            let found = sink.report(
                cell.syntax().text_range(),
                format!("this line has {} columns, and a rung has {}", row.columns, layout.columns()),
            );
            if has_assumed {
                found.note(match layout {
                    Layout::Pl7 => "a function block other than a timer is taken for three columns",
                    Layout::Pl72 => "a monostable is taken for two columns, as all other function blocks",
                });
            }
        }
        let Some(limit) = cx.target.ladder_lines() else { continue };
        let lines = Row::used(&rows);
        if let Some(first) = rows.get(limit.value as usize).filter(|_| lines > limit.value) {
            let message = format!("this rung has {lines} lines, and the controller's have {}", limit.value);
            let found = sink.report(first.range, message);
            if cx.target.family() == Family::Pl7 {
                found.note(match cx.target.controller() {
                    Some(_) => "Micro controllers have 7 lines, Premium controllers 16",
                    None => "the controller is not known: 16 lines is what the larger ones have",
                });
            }
        }
    }
}

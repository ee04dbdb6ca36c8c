//! J014: an instruction that stops the application.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::Exprs;
use crate::model::unit::StatementKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in &cx.model.statements {
        if statement.kind == StatementKind::Halt && statement.path != Exprs::FALSE {
            sink.report(statement.range, "`HALT` stops the whole application");
        }
    }
}

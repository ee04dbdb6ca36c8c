//! O008: the step of a drum that something else than a transfer of a value sets.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::Expr;
use crate::model::object::pl72;
use crate::model::unit::StatementKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in &cx.model.statements {
        let StatementKind::Store { access, value } = statement.kind else { continue };
        let Some(access) = cx.model.accesses.get(access as usize) else { continue };
        let object = cx.model.object(access.object);
        if !pl72::is_drum_step(object) {
            continue;
        }
        let how = match cx.model.exprs.get(value) {
            Expr::Read { .. } => "a transfer from an object",
            Expr::Binary(..) | Expr::Call(..) | Expr::Not(_) => "the result of an operation",
            _ => continue,
        };
        let message = format!("`{}` is set by {how}, and only the transfer of a value can set it", object.text);
        sink.report(cx.model.place(access.anchor), message).note("according to PL72:899");
    }
}

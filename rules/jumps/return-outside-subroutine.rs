//! J012: a return where there is no caller to go back to.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::Entity;
use crate::model::unit::{Leave, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    // The code of a DFB has a caller, and `RETURN` is not among what it may not hold (PL7:5480-5487).
    if cx.model.entity.subroutine().is_some() || matches!(cx.model.entity, Entity::Dfb { .. }) {
        return;
    }
    for statement in &cx.model.statements {
        if matches!(statement.kind, StatementKind::Return { how: Leave::Subroutine, .. }) {
            let text = cx.text_of(statement.range);
            let message = format!("`{}` returns from a subroutine, and {} is none", text.trim(), cx.model.entity);
            sink.report(statement.range, message);
        }
    }
}

//! J004: a jump to an earlier place.

use rowan::TextRange;

use crate::lint::{Severity, Sink, UnitCx};
use crate::model::UnitModel;
use crate::model::expr::Exprs;
use crate::model::unit::{Loop, LoopKind, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    for jump in &model.jumps {
        let back = |it: &&Loop| it.kind == LoopKind::Jump && it.keyword == jump.range;
        let Some(it) = model.loops.iter().find(back) else { continue };
        let Some(target) = jump.target.and_then(|it| model.labels.get(it as usize)) else { continue };
        if model.statements.get(jump.statement as usize).is_some_and(|it| it.path == Exprs::FALSE) {
            continue;
        }
        let report = if it.exits || can_leave(model, it) {
            sink.report(jump.range, format!("jump back to `{}`", jump.text))
        } else {
            sink.report(jump.range, format!("jump back to `{}`, and nothing leaves the loop", jump.text))
                .severity(Severity::Error)
        };
        report.related(target.range, "the loop starts here");
    }
}

/// Whether some statement between the label and the jump back goes elsewhere.
fn can_leave(model: &UnitModel, it: &Loop) -> bool {
    let body = it.body.start as usize..it.body.end as usize;
    let statements = model.statements.get(body.clone()).unwrap_or_default();
    statements.iter().any(|statement| match statement.kind {
        StatementKind::Return { .. } | StatementKind::Halt => true,
        StatementKind::Jump(jump) => {
            let label = model.jumps.get(jump as usize).and_then(|it| model.labels.get(it.target? as usize));
            label.is_none_or(|it| !body.contains(&(it.statement as usize)))
        }
        _ => false,
    })
}

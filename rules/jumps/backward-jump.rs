//! J004: a jump to an earlier place.

use std::collections::BTreeMap;

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Severity, Sink, UnitCx};
use crate::model::UnitModel;
use crate::model::expr::Exprs;
use crate::model::unit::{Jump, Loop, LoopKind, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    let mut jumps: FxHashMap<TextRange, &Jump> = model.jumps.iter().map(|it| (it.range, it)).collect();
    // Jumps back by their label, in the order of the labels.
    let mut loops: BTreeMap<u32, Vec<(&Jump, &Loop)>> = BTreeMap::new();
    for it in model.loops.iter().filter(|it| it.kind == LoopKind::Jump) {
        let Some(jump) = jumps.remove(&it.keyword) else { continue };
        let reached = model.statements.get(jump.statement as usize).is_some_and(|it| it.path != Exprs::FALSE);
        if let Some(target) = jump.target.filter(|_| reached) {
            loops.entry(target).or_default().push((jump, it));
        }
    }
    for (target, back) in loops {
        let Some(label) = model.labels.get(target as usize) else { continue };
        // The widest loop holds the others: where nothing leaves it, nothing leaves them.
        let Some(&(last, widest)) = back.last() else { continue };
        let endless = !widest.exits && !can_leave(model, widest);
        let (place, others) = if endless { (last, &back[..back.len() - 1]) } else { (back[0].0, &back[1..]) };
        let report = if endless {
            sink.report(place.range, format!("jump back to `{}`, and nothing leaves the loop", place.text))
                .severity(Severity::Error)
        } else {
            sink.report(place.range, format!("jump back to `{}`", place.text))
        };
        report
            .related(label.range, "the loop starts here")
            .related_all(others.iter().map(|it| (it.0.range, "also from here".to_owned())));
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

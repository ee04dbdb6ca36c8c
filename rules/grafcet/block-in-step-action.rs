//! G025: a function block in the action of a step, with an input that never rises there.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::model::chart::StepName;
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::lower;
use crate::model::object::Area;
use crate::model::unit::{Pin, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    let Some(chart) = &model.chart else { return };
    let drives = model.statements.iter().filter_map(|it| match it.kind {
        StatementKind::Drive { access, pin, when, .. } => {
            Some((model.accesses.get(access as usize)?, pin, when, it.range))
        }
        _ => None,
    });
    let mut places: FxHashMap<(ObjectId, Pin), u32> = FxHashMap::default();
    for (access, pin, ..) in drives.clone() {
        *places.entry((access.object, pin)).or_default() += 1;
    }
    for (access, pin, when, range) in drives {
        let Some(action) = chart.action_at(access.anchor) else { continue };
        let object = model.object(access.object);
        let Area::Block(symbol, _) = object.footprint.area else { continue };
        // What drives the input elsewhere may take it back to 0.
        let is_only = places.get(&(access.object, pin)) == Some(&1);
        if !is_only || !lower::acts_on_edge(symbol, pin) || !is_always_1(&model.exprs, when, action.path) {
            continue;
        }
        let step = action.steps.first().and_then(|&it| chart.steps.get(it as usize)?.name.as_ref());
        let name = step.map_or_else(String::new, |it: &StepName| format!(" {it}"));
        let (input, text) = (pin.describe(), &object.text);
        let message = format!("the {input} input of `{text}` is 1 whenever step{name} runs it, so that it never rises");
        sink.report(model.anchors.get(access.anchor as usize).copied().unwrap_or(range), message)
            .note("the input acts when it rises; while the step is not active nothing sets it back to 0");
    }
}

/// Whether a condition holds whenever the action runs: no contact, or the bit of the step itself.
fn is_always_1(exprs: &Exprs, when: ExprId, path: ExprId) -> bool {
    when == Exprs::TRUE || when == path || exprs.has_conjunct_prefix(path, when)
}

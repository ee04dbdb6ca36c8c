//! E010: the memory bit of a hand-made edge, refreshed before the edge is tested, or passed by.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::Class;
use crate::model::unit::{Statement, StatementKind};

/// `U x`, `= m`
struct Refresh {
    /// Index of the statement.
    at: usize,
    /// Version of the memory that it makes.
    version: u32,
    bit: ObjectId,
    /// Version of the bit that it takes.
    taken: u32,
}

/// A bit that a condition reads.
struct Term {
    object: ObjectId,
    version: u32,
    negated: bool,
}

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    let mut refreshes = refreshes(model);
    if refreshes.is_empty() {
        return;
    }
    for (at, test) in model.statements.iter().enumerate() {
        let Some(condition) = condition(model, test) else { continue };
        let terms = terms(&model.exprs, condition);
        for memory in &terms {
            let Some(refresh) = refreshes.get(&memory.object) else { continue };
            let is_bit = |it: &&Term| it.object == refresh.bit && it.negated != memory.negated;
            let Some(bit) = terms.iter().find(is_bit) else { continue };
            let Some(statement) = model.statements.get(refresh.at) else { continue };
            let name = &model.object(memory.object).text;
            let is_late = refresh.at < at && memory.version == refresh.version && bit.version == refresh.taken;
            let is_passed_by = at < refresh.at
                && test.path != statement.path
                && model.exprs.has_conjunct_prefix(statement.path, test.path);
            let (message, label) = if is_late {
                let message = format!("`{name}` is refreshed before its edge is tested, so that the edge never shows");
                (message, "takes the new value here")
            } else if is_passed_by {
                let message = format!("this edge is tested in runs that pass by the refresh of its memory `{name}`");
                (message, "refreshed here")
            } else {
                continue;
            };
            sink.report(test.range, message).related(statement.range, label);
            refreshes.remove(&memory.object);
        }
    }
}

/// Memory bits with one write alone, which takes the value of another bit.
fn refreshes(model: &UnitModel) -> FxHashMap<ObjectId, Refresh> {
    let mut writes = vec![0_u32; model.objects.len()];
    for it in model.accesses.iter().filter(|it| it.mode.writes()) {
        writes[it.object.0 as usize] += 1;
    }
    let mut refreshes = FxHashMap::default();
    for (at, statement) in model.statements.iter().enumerate().filter(|it| it.1.path != Exprs::FALSE) {
        let StatementKind::Assign { access, value } = statement.kind else { continue };
        let Some(access) = model.accesses.get(access as usize) else { continue };
        let is_memory = matches!(model.object(access.object).class, Class::Memory | Class::Data | Class::LocalName);
        let is_only = writes.get(access.object.0 as usize) == Some(&1);
        if let Expr::Read { object: bit, version: taken } = *model.exprs.get(value)
            && is_memory
            && is_only
            && bit != access.object
        {
            refreshes.insert(access.object, Refresh { at, version: access.version, bit, taken });
        }
    }
    refreshes
}

fn condition(model: &UnitModel, statement: &Statement) -> Option<ExprId> {
    match statement.kind {
        StatementKind::Assign { value, .. } => Some(value),
        StatementKind::Set { when, .. } | StatementKind::Reset { when, .. } | StatementKind::Drive { when, .. } => {
            Some(when)
        }
        StatementKind::Jump(jump) => Some(model.jumps.get(jump as usize)?.when),
        StatementKind::Call(call) => Some(model.calls.get(call as usize)?.when),
        StatementKind::Return { when, .. } => Some(when),
        _ => None,
    }
}

/// The bits that a condition, or its contrary, wants together: a jump is taken when there is no edge, too.
fn terms(exprs: &Exprs, condition: ExprId) -> Vec<Term> {
    const MOST: usize = 64;
    let start = match exprs.get(condition) {
        Expr::Not(inner) => *inner,
        _ => condition,
    };
    let (mut stack, mut terms) = (vec![start], Vec::new());
    while let Some(id) = stack.pop().filter(|_| terms.len() < MOST) {
        let (inner, negated) = match *exprs.get(id) {
            Expr::And(a, b) => {
                stack.extend([a, b]);
                continue;
            }
            Expr::Not(inner) => (inner, true),
            _ => (id, false),
        };
        if let Expr::Read { object, version } = *exprs.get(inner) {
            terms.push(Term { object, version, negated });
        }
    }
    terms
}

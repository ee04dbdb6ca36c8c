//! T019: an assignment that changes nothing.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator};
use crate::model::unit::StatementKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in &cx.model.statements {
        // In a list or a rung a bit takes a result that was computed before: other writes may lie between.
        let (access, value) = match statement.kind {
            StatementKind::Store { access, value } => (access, value),
            StatementKind::Assign { access, value } => (access, value),
            _ => continue,
        };
        let Some(access) = cx.model.accesses.get(access as usize) else { continue };
        if matches!(statement.kind, StatementKind::Assign { .. }) && !cx.model.is_structured_text(access) {
            continue;
        }
        let target = access.object;
        let object = cx.model.object(target);
        if object.is_bit() && !object.extracted {
            continue;
        }
        if is_read(&cx.model.exprs, value, target) {
            sink.report(statement.range, format!("`{}` is assigned to itself", object.text));
        } else if keeps(&cx.model.exprs, value, target) {
            sink.report(statement.range, format!("this operation leaves `{}` as it is", object.text));
        }
    }
}

/// Whether a value is what the object has. It is read in the statement that writes it, so that nothing lies between.
fn is_read(exprs: &Exprs, value: ExprId, target: ObjectId) -> bool {
    matches!(*exprs.get(value), Expr::Read { object, .. } if object == target)
}

fn keeps(exprs: &Exprs, value: ExprId, target: ObjectId) -> bool {
    let Expr::Binary(operator, a, b) = *exprs.get(value) else { return false };
    let is = |id: ExprId, wanted: f64| match *exprs.get(id) {
        Expr::Int(value) => value as f64 == wanted,
        Expr::Float(bits) => f64::from_bits(bits) == wanted,
        _ => false,
    };
    let (left, right) = (is_read(exprs, a, target), is_read(exprs, b, target));
    match operator {
        Operator::Add | Operator::Xor => left && is(b, 0.0) || right && is(a, 0.0),
        Operator::Or => left && is(b, 0.0) || right && is(a, 0.0) || left && right,
        Operator::Mul => left && is(b, 1.0) || right && is(a, 1.0),
        Operator::And => left && right,
        Operator::Sub => left && is(b, 0.0),
        Operator::Div => left && is(b, 1.0),
        Operator::Rem => false,
    }
}

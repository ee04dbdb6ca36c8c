//! T012: floating-point numbers compared for equality.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::pl7_kinds::Kind;
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::{BinExpr, BinOp, Expr, LiteralValue};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for expr in cx.nodes(SyntaxKind::BinExpr).filter_map(BinExpr::cast) {
        let Some((BinOp::Eq | BinOp::Ne, operator)) = expr.operation() else { continue };
        let (Some(a), Some(b)) = expr.operands() else { continue };
        let kinds = [a, b].map(|it| cx.kinds().of(it));
        // A whole number beside a floating-point number is T011's affair.
        if !kinds.contains(&Kind::Float) || kinds.iter().any(|it| it.is_integer()) || is_zero(&a) || is_zero(&b) {
            continue;
        }
        let text = operator.text();
        sink.report(expr.syntax().text_range(), format!("`{text}` compares floating-point numbers for equality"));
    }
}

fn is_zero(expr: &Expr) -> bool {
    match expr {
        Expr::Literal(it) => matches!(it.value(), Some(LiteralValue::Real(value)) if value == 0.0),
        Expr::Paren(it) => it.expr().is_some_and(|it| is_zero(&it)),
        _ => false,
    }
}

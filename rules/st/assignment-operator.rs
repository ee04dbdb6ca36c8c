//! T018: `=` where `:=` is meant, and the reverse.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx};
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, BinOp, ForStmt};
use crate::syntax::{SyntaxKind, SyntaxToken};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let assignments = cx.nodes(SyntaxKind::AssignStmt).filter_map(AssignStmt::cast);
    let loops = cx.nodes(SyntaxKind::ForStmt).filter_map(ForStmt::cast);
    let is_mistaken = |it: &SyntaxToken<'_>| it.kind() == SyntaxKind::Eq;
    let assignments = assignments.filter_map(|it| Some((it.operator().filter(is_mistaken)?, it.target())));
    let loops = loops.filter_map(|it| Some((it.operator().filter(is_mistaken)?, it.index())));
    for (operator, target) in assignments.chain(loops) {
        let target = target.map_or("", |it| cx.text_of(it.syntax().text_range()));
        exchange(sink, operator, ":=", format!("`=` compares, and `{target}` is to be assigned"));
    }
    for (parent, expr) in cx.nodes_in(SyntaxKind::BinExpr) {
        let Some(expr) = BinExpr::cast(expr) else { continue };
        // `Motor(START := %M0)` names a parameter: no condition, whatever else is wrong with it.
        if expr.op() == Some(BinOp::Assign)
            && !matches!(parent.kind(), SyntaxKind::CallStmt | SyntaxKind::CallExpr)
            && let Some(operator) = expr.operator()
        {
            let target = expr.lhs().map_or("", |it| cx.text_of(it.syntax().text_range()));
            exchange(sink, operator, "=", format!("`:=` assigns, and `{target}` is to be compared"));
        }
    }
}

fn exchange(sink: &mut Sink<'_, TextRange>, operator: SyntaxToken<'_>, by: &str, message: String) {
    let place = operator.text_range();
    sink.report(place, message).replace(format!("Write `{by}`"), Applicability::Safe, place, by);
}

//! T011: floating-point numbers and whole numbers meet without a conversion.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Applicability, Reported, Severity, Sink, UnitCx};
use crate::model::pl7_kinds::{Kind, Kinds};
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, CallExpr, CallStmt, Expr};
use crate::syntax::pl7::functions::Function;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if !cx.model.mixes_floats {
        return;
    }
    for expr in cx.nodes(SyntaxKind::BinExpr).filter_map(BinExpr::cast) {
        pair(cx, sink, expr.lhs(), expr.rhs(), expr.syntax().text_range());
    }
    for statement in cx.nodes(SyntaxKind::AssignStmt).filter_map(AssignStmt::cast) {
        let place = statement.value().map_or(statement.syntax().text_range(), |it| it.syntax().text_range());
        pair(cx, sink, statement.target(), statement.value(), place);
    }
    for call in cx.nodes(SyntaxKind::CallExpr).filter_map(CallExpr::cast) {
        arguments(cx, sink, call.function(), call.arguments());
    }
    for call in cx.nodes(SyntaxKind::CallStmt).filter_map(CallStmt::cast) {
        if call.has_parentheses() {
            arguments(cx, sink, call.function(), call.arguments());
        }
    }
}

/// Two operands that meet.
fn pair<'a>(
    cx: &UnitCx<'a>,
    sink: &mut Sink<'_, TextRange>,
    a: Option<Expr<'a>>,
    b: Option<Expr<'a>>,
    place: TextRange,
) {
    let (Some(a), Some(b)) = (a, b) else { return };
    let kinds = [a, b].map(|it| cx.kinds().of(it));
    if !kinds[0].mixes_with(kinds[1]) {
        return;
    }
    for it in [&a, &b] {
        if let Some(digits) = whole_constant(it) {
            let message = format!("the whole number `{}` meets a floating-point number", cx.text_of(digits));
            as_float(cx, sink.report(digits, message), digits);
            return;
        }
    }
    let part = |expr: &Expr, kind: Kind| (expr.syntax().text_range(), format!("this is {}", kind.describe()));
    sink.report(place, "a floating-point number and a whole number meet without a conversion")
        .related_all([part(&a, kinds[0]), part(&b, kinds[1])]);
}

fn arguments<'a>(
    cx: &UnitCx<'a>,
    sink: &mut Sink<'_, TextRange>,
    function: Option<&'static Function>,
    given: Vec<Option<Expr<'a>>>,
) {
    let Some(function) = function else { return };
    for (position, argument) in given.into_iter().enumerate() {
        let Some(argument) = argument else { continue };
        let (wanted, kind) = (Kinds::wanted(function, position), cx.kinds().of(argument));
        if !wanted.mixes_with(kind) {
            continue;
        }
        let place = argument.syntax().text_range();
        let text = cx.text_of(place);
        let message = format!("`{}` takes {}, and `{text}` is {}", function.name, wanted.describe(), kind.describe());
        let finding = sink.report(place, message);
        if let Some(digits) = whole_constant(&argument) {
            as_float(cx, finding, digits);
        }
    }
}

/// Of a constant, nobody doubts which number was meant.
fn as_float(cx: &UnitCx<'_>, finding: Reported<'_, TextRange>, digits: TextRange) {
    let text = format!("{}.0", cx.text_of(digits));
    finding.severity(Severity::Warning).replace(format!("Write `{text}`"), Applicability::Safe, digits, text);
}

/// The digits of a whole constant in base 10, behind its sign and parentheses.
fn whole_constant(expr: &Expr) -> Option<TextRange> {
    match expr {
        Expr::Literal(it) => {
            let token = it.token()?;
            let is_whole = token.kind() == SyntaxKind::Number && token.text().bytes().all(|it| it.is_ascii_digit());
            is_whole.then(|| token.text_range())
        }
        Expr::Unary(it) => whole_constant(&it.operand()?),
        Expr::Paren(it) => whole_constant(&it.expr()?),
        _ => None,
    }
}

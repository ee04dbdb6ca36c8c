//! T009: operators whose order is easily misread.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Applicability, Edit, Reported, Sink, UnitCx};
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::{BinExpr, BinOp, Expr, UnaryOp};

/// Bytes of an expression that a note repeats.
const LONGEST_SHOWN: usize = 200;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for (parent, expr) in cx.nodes_in(SyntaxKind::BinExpr) {
        let Some((expr, op)) = BinExpr::cast(expr).and_then(|it| Some((it, it.op()?))) else { continue };
        if !op.is_logical() {
            negated_operand(cx, sink, expr, op);
            continue;
        }
        let parent = BinExpr::cast(parent).and_then(|it| it.op());
        if parent.is_none_or(|it| !it.is_logical()) {
            logical_chain(cx, sink, expr);
        }
    }
}

/// One finding for all that should stand in parentheses under one outermost logical operator.
fn logical_chain<'a>(cx: &UnitCx<'a>, sink: &mut Sink<'_, TextRange>, whole: BinExpr<'a>) {
    let mut places: Vec<TextRange> = Vec::new();
    let mut words: Vec<String> = Vec::new();
    let mut stack = vec![whole];
    while let Some(expr) = stack.pop() {
        let (Some(op), Some(operator)) = (expr.op(), expr.operator()) else { continue };
        if !op.is_logical() {
            continue;
        }
        for inner in operands(expr) {
            if is_doubtful(cx, expr, op, inner) {
                places.push(inner.syntax().text_range());
                for word in inner.operator().iter().chain([&operator]).map(|it| it.text().to_ascii_uppercase()) {
                    if !words.contains(&word) {
                        words.push(word);
                    }
                }
            }
            stack.push(inner);
        }
    }
    if places.is_empty() {
        return;
    }
    places.sort_by_key(|it| (it.start(), it.end()));
    let mut edits: Vec<Edit<TextRange>> = places.iter().copied().flat_map(parentheses).collect();
    edits.sort_by_key(|it| it.place.start());
    let words: Vec<String> = words.iter().map(|it| format!("`{it}`")).collect();
    let place = whole.syntax().text_range();
    let found = sink
        .report(place, format!("{} are mixed without parentheses", words.join(" and ")))
        .related_all(places.into_iter().map(|it| (it, "this is done first".to_owned())));
    grouping(cx, place, &edits, found).fix("Write the parentheses that apply", Applicability::Safe, edits);
}

/// `NOT a = b`, `NOT a + b`: the `NOT` belongs to `a` alone.
fn negated_operand(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, expr: BinExpr<'_>, op: BinOp) {
    let Some(Expr::Unary(negation)) = expr.lhs() else { return };
    if negation.op() != Some(UnaryOp::Not) || op == BinOp::Assign {
        return;
    }
    let Some(operator) = expr.operator() else { return };
    let place = negation.syntax().text_range();
    let edits: Vec<Edit<TextRange>> = parentheses(place).into();
    let whole = expr.syntax().text_range();
    let found =
        sink.report(whole, format!("`NOT` is done before `{}`", operator.text())).related(place, "this is done first");
    grouping(cx, whole, &edits, found).fix("Write the parentheses that apply", Applicability::Safe, edits);
}

fn operands(expr: BinExpr<'_>) -> Vec<BinExpr<'_>> {
    [expr.lhs(), expr.rhs()]
        .into_iter()
        .filter_map(|it| if let Some(Expr::Bin(it)) = it { Some(it) } else { None })
        .collect()
}

/// Whether an operand of a logical operator should stand in parentheses: it has another logical operator, or is a
/// comparison while the other operand is a number.
fn is_doubtful<'a>(cx: &UnitCx<'a>, whole: BinExpr<'a>, op: BinOp, operand: BinExpr<'_>) -> bool {
    let Some(inner) = operand.op() else { return false };
    if inner.is_logical() {
        return inner != op;
    }
    let others = [whole.lhs(), whole.rhs()];
    inner.is_comparison() && others.into_iter().flatten().any(|it| cx.kinds().of(it).is_integer())
}

fn parentheses(place: TextRange) -> [Edit<TextRange>; 2] {
    [
        Edit { place: TextRange::empty(place.start()), replacement: "(".to_owned() },
        Edit { place: TextRange::empty(place.end()), replacement: ")".to_owned() },
    ]
}

/// Says how an expression is read: its text with the edits done, in one line, unless that is too long to help.
fn grouping<'a>(
    cx: &UnitCx<'_>,
    place: TextRange,
    edits: &[Edit<TextRange>],
    found: Reported<'a, TextRange>,
) -> Reported<'a, TextRange> {
    if usize::from(place.len()) > LONGEST_SHOWN {
        return found;
    }
    let mut text = String::new();
    let mut at = place.start();
    for edit in edits {
        text += cx.text_of(TextRange::new(at, edit.place.start().max(at)));
        text += &edit.replacement;
        at = edit.place.end().max(at);
    }
    text += cx.text_of(TextRange::new(at, place.end().max(at)));
    found.note(format!("it is read as `{}`", text.split_whitespace().collect::<Vec<_>>().join(" ")))
}

//! T017: a condition that stands twice in one `IF`, or makes no difference.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::{Expr, IfStmt, Stmt};
use crate::syntax::{SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in cx.nodes(SyntaxKind::IfStmt).filter_map(IfStmt::cast) {
        if !repeats(cx, sink, statement) {
            makes_no_difference(cx, sink, statement);
        }
    }
}

/// Reports conditions that an earlier arm has; whether the last arm's is one.
fn repeats(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, statement: IfStmt<'_>) -> bool {
    if statement.arms().nth(1).is_none() {
        return false;
    }
    let mut seen: FxHashMap<Vec<String>, TextRange> = FxHashMap::default();
    let mut is_repeated = false;
    for condition in statement.arms().filter_map(|it| it.condition()).filter_map(bare) {
        let place = condition.syntax().text_range();
        let first = *seen.entry(tokens(condition.syntax()).collect()).or_insert(place);
        is_repeated = first != place;
        if is_repeated {
            sink.report(place, format!("the condition `{}` stands in an earlier arm", one_line(cx, place)))
                .label("never true here")
                .related(first, "first here");
        }
    }
    is_repeated
}

fn makes_no_difference(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, statement: IfStmt<'_>) {
    let Some(last) = statement.arms().last() else { return };
    let Some((body, other)) = last.body().zip(statement.else_arm().and_then(|it| it.body())) else { return };
    let Some(place) = last.condition().map(|it| it.syntax().text_range()) else { return };
    let is_empty = body.statements().all(|it| matches!(it, Stmt::Empty(_)));
    if !is_empty && tokens(body.syntax()).eq(tokens(other.syntax())) {
        sink.report(place, format!("the condition `{}` makes no difference", one_line(cx, place)))
            .related(body.syntax().text_range(), "what is done when it is true")
            .related(other.syntax().text_range(), "is done by `ELSE` too");
    }
}

/// The expression without the parentheses around the whole.
fn bare(mut expr: Expr<'_>) -> Option<Expr<'_>> {
    while let Expr::Paren(it) = expr {
        expr = it.expr()?;
    }
    Some(expr)
}

/// The tokens of a piece of program as PL7 reads them: no blanks, no comments, names in one case.
fn tokens(node: SyntaxNode<'_>) -> impl Iterator<Item = String> {
    let tokens = node.descendant_tokens();
    tokens.filter(|it| !it.kind().is_trivia()).map(|it| match it.kind() {
        SyntaxKind::CharString => it.text().to_owned(),
        _ => it.text().to_uppercase(),
    })
}

fn one_line(cx: &UnitCx<'_>, place: TextRange) -> String {
    cx.text_of(place).split_whitespace().collect::<Vec<_>>().join(" ")
}

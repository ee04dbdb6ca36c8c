//! T017: a condition that stands twice in one `IF`, or makes no difference.

use rowan::TextRange;
use rowan::ast::AstNode as _;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::{Expr, IfStmt};
use crate::syntax::{SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in cx.nodes(SyntaxKind::IfStmt).iter().cloned().filter_map(IfStmt::cast) {
        if statement.arms().nth(1).is_some() {
            let mut seen: FxHashMap<Vec<String>, TextRange> = FxHashMap::default();
            for condition in statement.arms().filter_map(|it| it.condition()).filter_map(bare) {
                let place = condition.syntax().text_range();
                if let Some(&first) = seen.get(&words(condition.syntax())) {
                    sink.report(place, format!("the condition `{}` stands in an earlier arm", one_line(cx, place)))
                        .label("never true here")
                        .related(first, "first here");
                } else {
                    seen.insert(words(condition.syntax()), place);
                }
            }
        }
        let Some(last) = statement.arms().last() else { continue };
        let Some((body, other)) = last.body().zip(statement.else_arm().and_then(|it| it.body())) else { continue };
        if body.statements().next().is_some()
            && is_like(body.syntax(), other.syntax())
            && let Some(condition) = last.condition()
        {
            let place = condition.syntax().text_range();
            sink.report(place, format!("the condition `{}` makes no difference", one_line(cx, place)))
                .related(body.syntax().text_range(), "what is done when it is true")
                .related(other.syntax().text_range(), "is done by `ELSE` too");
        }
    }
}

/// The expression without the parentheses around the whole.
fn bare(mut expr: Expr) -> Option<Expr> {
    while let Expr::Paren(it) = &expr {
        expr = it.expr()?;
    }
    Some(expr)
}

/// The tokens of a piece of program as PL7 reads them: no blanks, no comments, names in one case.
fn tokens(node: &SyntaxNode) -> impl Iterator<Item = String> {
    let tokens = node.descendants_with_tokens().filter_map(rowan::NodeOrToken::into_token);
    tokens.filter(|it| !it.kind().is_trivia()).map(|it| match it.kind() {
        SyntaxKind::CharString => it.text().to_owned(),
        _ => it.text().to_uppercase(),
    })
}

fn words(node: &SyntaxNode) -> Vec<String> {
    tokens(node).collect()
}

fn is_like(a: &SyntaxNode, b: &SyntaxNode) -> bool {
    tokens(a).eq(tokens(b))
}

fn one_line(cx: &UnitCx<'_>, place: TextRange) -> String {
    cx.text_of(place).split_whitespace().collect::<Vec<_>>().join(" ")
}

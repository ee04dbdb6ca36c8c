//! T017: a condition that stands twice in one `IF`, or makes no difference.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use rustc_hash::FxHashSet;

use crate::analysis::decided;
use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::{IfStmt, Stmt};
use crate::syntax::{SyntaxKind, SyntaxNode, SyntaxToken};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let place = |at: u32| cx.model.statements.get(at as usize).map(|it| it.range);
    let mut repeated = FxHashSet::default();
    for (later, first) in decided::repeated(cx.model) {
        let Some((later, first)) = place(later).zip(place(first)) else { continue };
        repeated.insert(later);
        sink.report(later, format!("an earlier arm has the condition `{}` already", one_line(cx, later)))
            .label("never true here")
            .related(first, "first here");
    }
    for statement in cx.nodes(SyntaxKind::IfStmt).filter_map(IfStmt::cast) {
        let mut conditions = statement.arms().filter_map(|it| it.condition());
        if !conditions.any(|it| repeated.contains(&it.syntax().text_range())) {
            makes_no_difference(cx, sink, statement);
        }
    }
}

fn makes_no_difference(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, statement: IfStmt<'_>) {
    let Some(last) = statement.arms().last() else { return };
    let Some((body, other)) = last.body().zip(statement.else_arm().and_then(|it| it.body())) else { return };
    let Some(place) = last.condition().map(|it| it.syntax().text_range()) else { return };
    let is_empty = body.statements().all(|it| matches!(it, Stmt::Empty(_)));
    if !is_empty && are_alike(body.syntax(), other.syntax()) {
        sink.report(place, format!("the condition `{}` makes no difference", one_line(cx, place)))
            .related(body.syntax().text_range(), "what is done when it is true")
            .related(other.syntax().text_range(), "is done by `ELSE` too");
    }
}

/// Whether PL7 reads two pieces of program as the same: blanks, comments and the case of names mean nothing.
fn are_alike(a: SyntaxNode<'_>, b: SyntaxNode<'_>) -> bool {
    fn upper(text: &str) -> impl Iterator<Item = char> {
        text.chars().flat_map(char::to_uppercase)
    }
    let is_same = |a: SyntaxToken<'_>, b: SyntaxToken<'_>| {
        a.text() == b.text() || a.kind() != SyntaxKind::CharString && upper(a.text()).eq(upper(b.text()))
    };
    let [mut a, mut b] = [a, b].map(|it| it.descendant_tokens().filter(|it| !it.kind().is_trivia()));
    loop {
        match (a.next(), b.next()) {
            (Some(a), Some(b)) if is_same(a, b) => {}
            (a, b) => return a.is_none() && b.is_none(),
        }
    }
}

fn one_line(cx: &UnitCx<'_>, place: TextRange) -> String {
    cx.text_of(place).split_whitespace().collect::<Vec<_>>().join(" ")
}

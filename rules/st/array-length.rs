//! T015: tables that do not fit one another, and tables where there can be none.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::Type;
use crate::model::pl7_tables::{self, Misfit};
use crate::model::unit::Mode;
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, CallExpr};
use crate::syntax::{AstNode, SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let is_awl = cx.model.language.is_statement_list();
    if is_awl || !cx.model.objects.iter().any(|it| it.ty.is_table()) {
        return;
    }
    for access in cx.model.accesses.iter().filter(|it| !matches!(it.mode, Mode::Drive(_))) {
        let object = cx.model.object(access.object);
        if let Some(flaw) = pl7_tables::misplaced(object) {
            sink.report(cx.model.place(access.anchor), format!("`{}` {flaw}", object.text));
        }
    }
    let kinds = cx.kinds();
    meet(cx, sink, SyntaxKind::AssignStmt, |it: AssignStmt<'_>| pl7_tables::of_assignment(kinds, it));
    meet(cx, sink, SyntaxKind::BinExpr, |it: BinExpr<'_>| pl7_tables::of_operation(kinds, it));
    meet(cx, sink, SyntaxKind::CallExpr, |it: CallExpr<'_>| pl7_tables::of_call(kinds, it));
}

fn meet<'a, N: AstNode<'a>>(
    cx: &UnitCx<'a>,
    sink: &mut Sink<'_, TextRange>,
    kind: SyntaxKind,
    operands: impl Fn(N) -> Option<(Type, Type)>,
) {
    let may_have_table = |it: &SyntaxNode<'_>| names_length(cx.text_of(it.text_range()));
    for node in cx.nodes(kind).filter(may_have_table).filter_map(N::cast) {
        let place = node.syntax().text_range();
        let Some((a, b)) = operands(node) else { continue };
        match pl7_tables::misfit(a, b) {
            // Of floats and whole numbers T011 speaks.
            Some(Misfit::Elements(..)) if a.is_float() != b.is_float() && cx.model.mixes_floats => {}
            Some(Misfit::Elements((n, what), (m, other))) => {
                sink.report(place, format!("a table of {n} {what} meets one of {m} {other}"));
            }
            Some(Misfit::Lengths(what, n, m)) => {
                sink.report(place, format!("a table of {n} {what} meets one of {m}"))
                    .note("the manual has operations of two tables, and none that says what becomes of the rest");
            }
            Some(Misfit::Bits(n, width)) => {
                sink.report(place, format!("a table of {n} bits meets an object of {width}"));
            }
            None => {}
        }
    }
}

/// Whether a colon stands in a text that is none of `:=`: the length of a table is behind one.
fn names_length(text: &str) -> bool {
    let text = text.as_bytes();
    memchr::memchr_iter(b':', text).any(|at| text.get(at + 1) != Some(&b'='))
}

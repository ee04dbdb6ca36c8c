//! T002: the index of a `FOR` is no word, or no word that may be written.

use rowan::TextRange;
use rowan::ast::AstNode as _;

use crate::lint::{Sink, UnitCx};
use crate::model::object::Rights;
use crate::model::pl7_kinds::Kind;
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::{Expr, ForStmt};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in cx.nodes(SyntaxKind::ForStmt).iter().cloned().filter_map(ForStmt::cast) {
        let Some(index) = statement.index() else { continue };
        let place = index.syntax().text_range();
        let text = cx.text_of(place);
        let what = match (&index, cx.kinds().of(&index)) {
            (Expr::Name(_), _) => continue,
            (Expr::Object(_), Kind::Word | Kind::Double | Kind::Unknown) => {
                // The model has resolved the object.
                let read_only = |it: &&crate::model::unit::Loop| it.index_range == Some(place);
                let object = cx.model.loops.iter().find(read_only).and_then(|it| it.index);
                let Some(Rights::ReadOnly(source)) = object.map(|it| cx.model.object(it).rights) else { continue };
                sink.report(place, format!("the index `{text}` of `FOR` cannot be written by the program"))
                    .note(format!("{source} gives it as not writable"));
                continue;
            }
            (Expr::Object(_), kind) => kind.describe(),
            (Expr::Literal(_), _) => "a constant",
            _ => "an expression",
        };
        sink.report(place, format!("the index of `FOR` is a word, and `{text}` is {what}"));
    }
}

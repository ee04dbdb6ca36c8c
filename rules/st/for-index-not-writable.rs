//! T002: the index of a `FOR` is no word, or no word that may be written.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::ObjectId;
use crate::model::object::Rights;
use crate::model::pl7_kinds::Kind;
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::{Expr, ForStmt};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let indices = cx.model.loops.iter().filter_map(|it| it.index_range.zip(it.index));
    let indices: FxHashMap<TextRange, ObjectId> = indices.collect();
    for statement in cx.nodes(SyntaxKind::ForStmt).filter_map(ForStmt::cast) {
        let Some(index) = statement.index() else { continue };
        let place = index.syntax().text_range();
        let text = cx.text_of(place);
        let what = match (&index, cx.kinds().of(index)) {
            (Expr::Name(_), _) => continue,
            (Expr::Object(_), Kind::Word | Kind::Double | Kind::Unknown) => {
                // The model has resolved the object.
                let rights = indices.get(&place).map(|it| cx.model.object(*it).rights);
                let Some(Rights::ReadOnly(source)) = rights else { continue };
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

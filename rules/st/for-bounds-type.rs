//! T003: a bound of a `FOR` that is no number of the type word.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::pl7_kinds::Kind;
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::ForStmt;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in cx.nodes(SyntaxKind::ForStmt).filter_map(ForStmt::cast) {
        for (name, bound) in [("start", statement.start()), ("end", statement.end())] {
            let Some(bound) = bound else { continue };
            let kind = cx.kinds().of(bound);
            if matches!(kind, Kind::Word | Kind::Double | Kind::Integer | Kind::Unknown) {
                continue;
            }
            let place = bound.syntax().text_range();
            let text = cx.text_of(place);
            sink.report(place, format!("the {name} value of `FOR` is a word, and `{text}` is {}", kind.describe()));
        }
    }
}

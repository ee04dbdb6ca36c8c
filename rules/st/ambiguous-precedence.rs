//! T009: operators whose order is easily misread.

use rowan::{TextRange, TextSize};

use crate::lint::{Applicability, Edit, Sink, UnitCx};
use crate::model::pl7_precedence::{Doubt, logical_chain, negated_operand};
use crate::syntax::pl7::ast::BinExpr;
use crate::syntax::{AstNode as _, SyntaxKind};

/// Bytes of an expression that a note repeats.
const LONGEST_SHOWN: usize = 200;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let is_logical = |it: BinExpr<'_>| it.op().is_some_and(|it| it.is_logical());
    for (parent, expr) in cx.nodes_in(SyntaxKind::BinExpr) {
        let Some(expr) = BinExpr::cast(expr) else { continue };
        if !is_logical(expr) {
            if let Some(doubt) = negated_operand(expr) {
                let message = format!("`NOT` is done before `{}`", doubt.operators.concat());
                report(cx, sink, &doubt, message);
            }
        } else if !BinExpr::cast(parent).is_some_and(is_logical)
            && let Some(doubt) = logical_chain(cx.kinds(), expr)
        {
            let words: Vec<String> = doubt.operators.iter().map(|it| format!("`{it}`")).collect();
            report(cx, sink, &doubt, format!("{} are mixed without parentheses", words.join(" and ")));
        }
    }
}

fn report(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, doubt: &Doubt, message: String) {
    let at = |place: TextSize, text: &str| Edit { place: TextRange::empty(place), replacement: text.to_owned() };
    let mut edits: Vec<_> = doubt.first.iter().flat_map(|it| [at(it.start(), "("), at(it.end(), ")")]).collect();
    edits.sort_by_key(|it| it.place.start());
    let mut finding = sink
        .report(doubt.whole, message)
        .related_all(doubt.first.iter().map(|it| (*it, "this is done first".to_owned())));
    // A note that is too long helps nobody.
    if usize::from(doubt.whole.len()) <= LONGEST_SHOWN {
        finding = finding.note(format!("it is read as `{}`", doubt.regrouped(|it| cx.text_of(it))));
    }
    finding.fix("Write the parentheses that apply", Applicability::Safe, edits);
}

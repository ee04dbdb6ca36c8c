//! V003: a value that an operation or function block of PL7-2 does not take.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::analysis::operands::{self, Place};
use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::{AssignStmt, Expr};
use crate::syntax::{AstNode as _, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(model) = cx.target.pl72() else { return };
    let misfits = operands::misfits(cx.model, &model);
    if misfits.is_empty() {
        return;
    }
    let written = cx.nodes(SyntaxKind::AssignStmt).filter_map(AssignStmt::cast);
    let written: FxHashMap<TextRange, AssignStmt<'_>> = written.map(|it| (it.syntax().text_range(), it)).collect();
    for it in misfits {
        let place = match it.at {
            Place::Target(anchor) => cx.model.place(anchor),
            Place::Operand(at) => {
                let places = written.get(&it.statement.range).map(operands).unwrap_or_default();
                places.get(at).copied().unwrap_or(it.statement.range)
            }
        };
        let (text, value, takes) = (cx.text_of(place), it.value.value, &it.takes);
        let message = match (it.value.stored, it.at) {
            (Some(_), Place::Operand(_)) => format!("`{text}` is {value} here, and {takes}"),
            // A number as it is, or in the word of a shift.
            (None, Place::Operand(_)) if !text.ends_with(&value.to_string()) => {
                format!("{takes}, and not `{text}` ({value})")
            }
            _ => format!("{takes}, and not {value}"),
        };
        let stored = it.value.stored.map(|it| (cx.model.place(it), "the value is set here".to_owned()));
        sink.report(place, message).related_all(stored).note(format!("the range is given in {}", it.source));
    }
}

/// Places of the operands, from left to right; of a shift with its count first.
fn operands(it: &AssignStmt<'_>) -> Vec<TextRange> {
    let place = |it: Expr<'_>| it.syntax().text_range();
    match it.value() {
        Some(Expr::Bin(it)) => [it.lhs(), it.rhs()].into_iter().flatten().map(place).collect(),
        Some(Expr::Call(it)) => {
            // `SLC16 W1` has its count in the word of the operation.
            let glued = it.name().filter(|it| it.text().ends_with(|it: char| it.is_ascii_digit()));
            glued.map(|it| it.text_range()).into_iter().chain(it.operands().map(place)).collect()
        }
        _ => Vec::new(),
    }
}

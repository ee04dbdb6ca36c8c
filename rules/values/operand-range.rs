//! V003: a value that an operation of PL7-2 does not take.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::analysis::known::{Known, Value};
use crate::lint::{Sink, UnitCx};
use crate::model::expr::{Expr, ExprId, Operator};
use crate::model::unit::{Statement, StatementKind};
use crate::syntax::pl7::ast::{self, AssignStmt};
use crate::syntax::{AstNode as _, SyntaxKind};
use crate::target::pl72::{Operation, SHIFT};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(model) = cx.target.pl72() else { return };
    let known = Known::new(cx.model);
    let written: FxHashMap<TextRange, AssignStmt<'_>> = cx
        .nodes(SyntaxKind::AssignStmt)
        .filter_map(AssignStmt::cast)
        .map(|it| (it.syntax().text_range(), it))
        .collect();
    for statement in &cx.model.statements {
        let StatementKind::Store { value, .. } = statement.kind else { continue };
        let Some(written) = written.get(&statement.range) else { continue };
        let mut operands = operands(written).into_iter();
        let mut next = || operands.next().unwrap_or(statement.range);
        match cx.model.exprs.get(value) {
            &Expr::Binary(operator, lhs, rhs) => {
                let Some(operation) = code(operator).and_then(Operation::of_code) else { continue };
                let Some(range) = model.operand_range(operation) else { continue };
                for operand in [lhs, rhs] {
                    let place = next();
                    let fits = |it: i64| (i64::from(range.first)..=i64::from(range.last)).contains(&it);
                    if let Some(value) = known.value(operand, statement.path).filter(|it| !fits(it.value)) {
                        let takes = format!("`{}` takes {} to {}", operation.code, range.first, range.last);
                        report(cx, sink, place, value, &takes, range.source);
                    }
                }
            }
            Expr::Call(function, arguments) => {
                call(cx, &known, statement, function, arguments, next, sink);
            }
            _ => {}
        }
    }
}

fn call(
    cx: &UnitCx<'_>,
    known: &Known<'_>,
    statement: &Statement,
    code: &str,
    arguments: &[ExprId],
    mut next: impl FnMut() -> TextRange,
    sink: &mut Sink<'_, TextRange>,
) {
    let Some(operation) = Operation::of_code(code) else { return };
    let value = |it: Option<&ExprId>| known.value(*it?, statement.path);
    match operation.code {
        "SLC" | "SRC" => {
            let Some(bits) = value(arguments.first()).filter(|_| arguments.len() > 1) else { return };
            let last = i64::from(SHIFT.last);
            if !(0..=last).contains(&bits.value) {
                let takes = format!("`{}` shifts by 0 to {last} bits", operation.code);
                report(cx, sink, next(), bits, &takes, SHIFT.source);
            }
        }
        "BIN" => {
            let is_wrong = |it: &Value| u16::try_from(it.value & 0xFFFF).is_ok_and(|it| !is_bcd(it));
            if let Some(word) = value(arguments.last()).filter(is_wrong) {
                report(cx, sink, next(), word, "`BIN` takes four decimal digits, one in each four bits", "PL72:1056");
            }
        }
        _ => {
            let Some(range) = cx.target.pl72().and_then(|it| it.operand_range(operation)) else { return };
            let fits = |it: i64| (i64::from(range.first)..=i64::from(range.last)).contains(&it);
            if let Some(operand) = value(arguments.last()).filter(|it| !fits(it.value)) {
                let takes = format!("`{}` takes {} to {}", operation.code, range.first, range.last);
                report(cx, sink, next(), operand, &takes, range.source);
            }
        }
    }
}

fn report(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, place: TextRange, value: Value, takes: &str, source: &str) {
    let text = cx.text_of(place);
    let message = match value.stored {
        Some(_) => format!("`{text}` is {} here, and {takes}", value.value),
        // A number as it is, or in the word of a shift.
        None if text.ends_with(&value.value.to_string()) => format!("{takes}, and not {}", value.value),
        None => format!("{takes}, and not `{text}` ({})", value.value),
    };
    let stored = value.stored.map(|it| (cx.model.place(it), format!("`{text}` is set here")));
    sink.report(place, message).related_all(stored).note(format!("the range is given in {source}"));
}

/// Places of the operands, from left to right; of a shift with its count first.
fn operands(it: &AssignStmt<'_>) -> Vec<TextRange> {
    let place = |it: ast::Expr<'_>| it.syntax().text_range();
    match it.value() {
        Some(ast::Expr::Bin(it)) => [it.lhs(), it.rhs()].into_iter().flatten().map(place).collect(),
        Some(ast::Expr::Call(it)) => {
            // `SLC16 W1` has its count in the word of the operation.
            let glued = it.name().filter(|it| it.text().ends_with(|it: char| it.is_ascii_digit()));
            glued.map(|it| it.text_range()).into_iter().chain(it.operands().map(place)).collect()
        }
        _ => Vec::new(),
    }
}

fn code(operator: Operator) -> Option<&'static str> {
    Some(match operator {
        Operator::Add => "+",
        Operator::Sub => "-",
        Operator::Mul => "*",
        Operator::Div => "/",
        Operator::Rem => "REM",
        _ => return None,
    })
}

fn is_bcd(word: u16) -> bool {
    (0..4).all(|digit| (word >> (4 * digit)) & 0xF <= 9)
}

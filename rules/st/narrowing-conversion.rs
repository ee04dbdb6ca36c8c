//! T010: a word takes a double word, of which it keeps the low half.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::analysis::ranges::Ranges;
use crate::lint::{Severity, Sink, UnitCx};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Operator};
use crate::model::object::Type;
use crate::model::pl7_kinds::Kind;
use crate::model::unit::StatementKind;
use crate::syntax::pl7::ast::AssignStmt;
use crate::syntax::{AstNode as _, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    let stores: FxHashMap<TextRange, (u32, ExprId)> = (0..)
        .zip(&model.statements)
        .filter_map(|(at, it)| match it.kind {
            StatementKind::Store { value, .. } if !is_of_words(model, value) => Some((it.range, (at, value))),
            _ => None,
        })
        .collect();
    let assignments = cx.nodes(SyntaxKind::AssignStmt).filter(|it| stores.contains_key(&it.text_range()));
    let mut candidates = assignments.filter_map(AssignStmt::cast).filter_map(|it| {
        let (Some(target), Some(value)) = it.sides() else { return None };
        let is_word = cx.kinds().type_of(target) == Some(Type::Word);
        let kind = is_word.then(|| cx.kinds().of(value)).filter(|it| matches!(it, Kind::Double | Kind::Integer))?;
        Some((kind, [it.syntax(), target.syntax(), value.syntax()].map(|it| it.text_range())))
    });
    let Some(first) = candidates.next() else { return };
    let ranges = Ranges::new(model);
    for (kind, [statement, target, value]) in std::iter::once(first).chain(candidates) {
        let Some(&(at, expr)) = stores.get(&statement) else { continue };
        let Some(path) = model.statements.get(at as usize).map(|it| it.path) else { continue };
        let Some(span) = ranges.of(expr, at, path).map(|it| it.span) else { continue };
        // The result of some functions is a word or a double word, nothing tells which.
        if kind == Kind::Integer && !span.is_one() {
            continue;
        }
        // `AND` and `SHR` give patterns: all that counts is that no bit is lost. So it is with constants.
        let of_bits = match model.exprs.get(expr) {
            Expr::Binary(Operator::And, ..) | Expr::Int(_) => true,
            Expr::Call(name, _) => name == "SHR",
            _ => false,
        };
        let (least, most) = (i16::MIN.into(), if of_bits { u16::MAX.into() } else { i16::MAX.into() });
        let (is_below, is_above) = (span.first < least, span.last > most);
        let lets_pass = is_below && span.tells_first || is_above && span.tells_last;
        // Who tests one side knows the other: most double words are counters and sums, which have no sign.
        let is_tested = !lets_pass && (span.tells_first || span.tells_last);
        if !is_below && !is_above || is_tested {
            continue;
        }
        let (target, text) = (cx.text_of(target), cx.text_of(value));
        let report = sink.report(value, format!("`{target}` takes the low word of `{text}`, which may need 32 bits"));
        if span.is_one() {
            report.label(format!("this is {}", span.first));
        } else if span.tells_first && span.tells_last {
            report.label(format!("this is {} to {}", span.first, span.last));
        } else if !lets_pass {
            report.label("nothing here tells how large it is").severity(Severity::Advice);
        }
    }
}

/// Whether a value is a word, or computed from words and constants, which gives one.
fn is_of_words(model: &UnitModel, value: ExprId) -> bool {
    let is_constant = |it: ExprId| matches!(model.exprs.get(it), Expr::Int(_));
    match *model.exprs.get(value) {
        Expr::Read { object, .. } => model.object(object).ty == Type::Word,
        Expr::Negate(a) => is_of_words(model, a),
        Expr::Binary(_, a, b) if is_constant(a) => is_of_words(model, b),
        Expr::Binary(_, a, b) => is_of_words(model, a) && (is_constant(b) || is_of_words(model, b)),
        _ => false,
    }
}

//! Comparisons of step times with constants, and the durations that comments name.

use rowan::TextRange;

use super::expr::Comparison;
use super::literal::{self, Value};
use super::object::{self, Class, Object, Type};
use super::unit::UnitModel;
use crate::syntax::AstNode as _;
use crate::syntax::pl7::ast::{BinExpr, BinOp, Expr, ObjectRef, UnaryOp};

/// `%X3.T > 50`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimeCheck {
    /// Place of the time.
    pub time: TextRange,
    /// With the time on the left.
    pub op: Comparison,
    pub constant: i64,
    pub range: TextRange,
    pub constant_range: TextRange,
}

/// The comparison of a step time with a whole number; `None` for anything else.
pub fn check(model: &UnitModel, it: BinExpr<'_>) -> Option<TimeCheck> {
    let op = comparison(it.op()?)?;
    let (lhs, rhs) = (bare(it.lhs()?)?, bare(it.rhs()?)?);
    let (time, value, op) = match (constant(lhs), constant(rhs)) {
        (None, Some(value)) => (lhs, (value, rhs), op),
        (Some(value), None) => (rhs, (value, lhs), op.mirrored()),
        _ => return None,
    };
    let Expr::Object(object) = time else { return None };
    names_step_time(model, object).then(|| TimeCheck {
        time: object.syntax().text_range(),
        op,
        constant: value.0,
        range: it.syntax().text_range(),
        constant_range: value.1.syntax().text_range(),
    })
}

/// Whether an object is the time of a step.
pub fn is_step_time(object: &Object) -> bool {
    object.class == Class::StepTime && object.ty == Type::Word
}

fn names_step_time(model: &UnitModel, it: ObjectRef<'_>) -> bool {
    let address = it.address();
    match it.index() {
        Some(_) => object::pl7::parse_indexed(&address, it.suffix().as_deref()).is_ok_and(|it| is_step_time(&it)),
        None => model.address(&address).is_some_and(|it| is_step_time(model.object(it))),
    }
}

/// Without the parentheses around it.
fn bare(mut it: Expr<'_>) -> Option<Expr<'_>> {
    while let Expr::Paren(inner) = it {
        it = inner.expr()?;
    }
    Some(it)
}

fn constant(it: Expr<'_>) -> Option<i64> {
    match it {
        Expr::Literal(it) => match literal::parse_pl7(it.token()?.text()).ok()? {
            Value::Int { value, .. } => Some(value),
            _ => None,
        },
        Expr::Unary(it) if it.op() == Some(UnaryOp::Minus) => match bare(it.operand()?)? {
            it @ Expr::Literal(_) => constant(it)?.checked_neg(),
            _ => None,
        },
        _ => None,
    }
}

fn comparison(op: BinOp) -> Option<Comparison> {
    Some(match op {
        BinOp::Eq => Comparison::Eq,
        BinOp::Ne => Comparison::Ne,
        BinOp::Lt => Comparison::Lt,
        BinOp::Le => Comparison::Le,
        BinOp::Gt => Comparison::Gt,
        BinOp::Ge => Comparison::Ge,
        _ => return None,
    })
}

/// Units of time as comments write them, in milliseconds.
const UNITS: &[(&str, u64)] = &[
    ("ms", 1),
    ("s", 1000),
    ("sec", 1000),
    ("secs", 1000),
    ("seconde", 1000),
    ("secondes", 1000),
    ("second", 1000),
    ("seconds", 1000),
    ("mn", 60_000),
    ("min", 60_000),
    ("minute", 60_000),
    ("minutes", 60_000),
];

/// Durations that a text names, in milliseconds: `10 s`, `1,5 sec`, `2 min`.
pub fn durations(text: &str) -> Vec<u64> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(|it: char| it.is_ascii_digit()) {
        let before = rest[..start].chars().next_back();
        rest = &rest[start..];
        let end = rest.find(|it: char| !it.is_ascii_digit() && it != '.' && it != ',').unwrap_or(rest.len());
        let (number, behind) = rest.split_at(end);
        let word = behind.strip_prefix(' ').unwrap_or(behind);
        let end = word.find(|it: char| !it.is_alphanumeric() && it != '_').unwrap_or(word.len());
        let (unit, behind) = word.split_at(end);
        // `%M10 s`, `X5.10 s`: a number that belongs to a name.
        let is_free = before.is_none_or(|it| !it.is_alphanumeric() && !matches!(it, '_' | '.' | '%' | '-'));
        let unit = UNITS.iter().find(|it| it.0.eq_ignore_ascii_case(unit)).map(|it| it.1);
        if let Some(duration) = unit.filter(|_| is_free).and_then(|unit| milliseconds(number, unit)) {
            found.push(duration);
        }
        rest = if unit.is_some() { behind } else { word };
    }
    found
}

/// `1,5` of a unit.
fn milliseconds(number: &str, unit: u64) -> Option<u64> {
    let number = number.trim_end_matches(['.', ',']);
    let (whole, part) = number.split_once(['.', ',']).unwrap_or((number, ""));
    if part.len() > 3 || !part.bytes().all(|it| it.is_ascii_digit()) {
        return None;
    }
    let whole: u64 = whole.parse().ok()?;
    let part_value: u64 = if part.is_empty() { 0 } else { part.parse().ok()? };
    let scale = [1, 10, 100, 1000].get(part.len())?;
    whole.checked_mul(unit)?.checked_add(part_value.checked_mul(unit)? / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_in_comments() {
        for (text, expected) in [
            ("(* attendre 10 s *)", &[10_000][..]),
            ("Tempo 5s, puis 1,5 sec", &[5000, 1500]),
            ("2 min.", &[120_000]),
            ("500ms", &[500]),
            ("0.25 seconde", &[250]),
            ("%M10 s", &[]),
            ("poste 2 sud", &[]),
            ("3 services, 12", &[]),
            ("1.2.3 s", &[]),
            ("99999999999999999999 s", &[]),
            ("7\u{a0}s é 4 s", &[4000]),
            ("", &[]),
        ] {
            assert_eq!(durations(text), expected, "{text}");
        }
    }
}

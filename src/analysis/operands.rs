//! Values of PL7-2 operations against what they take (PL72:1022-1056).

use super::known::{Known, Value};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Operator};
use crate::model::object::pl72;
use crate::model::unit::{Statement, StatementKind};
use crate::target::pl72::{BCD_MAX, Model, Operation, SHIFT};

/// A value that an operation, or the word of a function block, does not take.
#[derive(Debug)]
pub struct Misfit<'m> {
    pub statement: &'m Statement,
    pub at: Place,
    pub value: Value,
    /// One sentence: what would be taken.
    pub takes: String,
    pub source: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// From the left, from 0; the count of a shift is the first.
    Operand(usize),
    /// What the value goes to, by its anchor.
    Target(u32),
}

/// Those of a unit whose value is known, in the order of its statements.
pub fn misfits<'m>(model: &'m UnitModel, target: &Model) -> Vec<Misfit<'m>> {
    let known = Known::new(model);
    let mut search = Search { known: &known, target, found: Vec::new() };
    for statement in &model.statements {
        let StatementKind::Store { access, value } = statement.kind else { continue };
        if let Some(access) = model.accesses.get(access as usize) {
            let object = model.object(access.object);
            if let Some(range) = pl72::word_range(object) {
                let range = Range { first: range.first.into(), last: range.last.into(), source: range.source };
                search.within(statement, Place::Target(access.anchor), value, &object.text, range);
            }
        }
        match model.exprs.get(value) {
            &Expr::Binary(operator, lhs, rhs) => {
                let Some(operation) = code(operator).and_then(Operation::of_code) else { continue };
                search.operand(statement, 0, lhs, operation);
                search.operand(statement, 1, rhs, operation);
            }
            Expr::Call(code, operands) => {
                if let Some(operation) = Operation::of_code(code) {
                    search.conversion(statement, operation, operands);
                }
            }
            _ => {}
        }
    }
    search.found
}

struct Range {
    first: i64,
    last: i64,
    source: &'static str,
}

struct Search<'s, 'm> {
    known: &'s Known<'m>,
    target: &'s Model,
    found: Vec<Misfit<'m>>,
}

impl<'m> Search<'_, 'm> {
    fn within(&mut self, statement: &'m Statement, at: Place, operand: ExprId, what: &str, range: Range) {
        let Range { first, last, source } = range;
        let value = self.known.value(operand, statement.path).filter(|it| !(first..=last).contains(&it.value));
        if let Some(value) = value {
            self.found.push(Misfit {
                statement,
                at,
                value,
                takes: format!("`{what}` takes {first} to {last}"),
                source,
            });
        }
    }

    fn operand(&mut self, statement: &'m Statement, at: usize, operand: ExprId, operation: &Operation) {
        if let Some(range) = self.target.operand_range(operation) {
            let range = Range { first: range.first.into(), last: range.last.into(), source: range.source };
            self.within(statement, Place::Operand(at), operand, operation.code, range);
        }
    }

    fn conversion(&mut self, statement: &'m Statement, operation: &Operation, operands: &[ExprId]) {
        match (operation.code, operands) {
            ("SLC" | "SRC", &[count, _]) => {
                let range = Range { first: SHIFT.first.into(), last: SHIFT.last.into(), source: SHIFT.source };
                self.within(statement, Place::Operand(0), count, operation.code, range);
            }
            ("BIN", &[word]) => {
                let is_wrong = |it: &Value| u16::try_from(it.value & 0xFFFF).is_ok_and(|it| !is_bcd(it));
                if let Some(value) = self.known.value(word, statement.path).filter(is_wrong) {
                    let takes = "`BIN` takes four decimal digits, one in each four bits".to_owned();
                    let (at, source) = (Place::Operand(0), BCD_MAX.source);
                    self.found.push(Misfit { statement, at, value, takes, source });
                }
            }
            (_, &[word]) => self.operand(statement, 0, word, operation),
            _ => {}
        }
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

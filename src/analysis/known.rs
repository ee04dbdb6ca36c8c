//! Constants that objects surely hold where a unit reads them.

use rustc_hash::FxHashMap;

use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, ObjectId};
use crate::model::unit::StatementKind;

/// Constants that the unit stores, by what they are stored in and the version that the store makes.
pub struct Known<'m> {
    model: &'m UnitModel,
    stores: FxHashMap<(ObjectId, u32), Stored>,
}

struct Stored {
    value: i64,
    path: ExprId,
    anchor: u32,
}

/// A value, and the place of the store that gives it when it is not written where it is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Value {
    pub value: i64,
    pub stored: Option<u32>,
}

impl<'m> Known<'m> {
    pub fn new(model: &'m UnitModel) -> Self {
        let stores = model.statements.iter().filter_map(|it| {
            let StatementKind::Store { access, value } = it.kind else { return None };
            let &Expr::Int(value) = model.exprs.get(value) else { return None };
            let access = model.accesses.get(access as usize)?;
            let stored = Stored { value, path: it.path, anchor: access.anchor };
            model.object(access.object).is_fixed().then_some(((access.object, access.version), stored))
        });
        Self { model, stores: stores.collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.stores.is_empty()
    }

    /// The value of an expression that is looked at under a path: a constant, or the read of what holds one. The store counts
    /// when control is sure to have come by.
    pub fn value(&self, expr: ExprId, path: ExprId) -> Option<Value> {
        match *self.model.exprs.get(expr) {
            Expr::Int(value) => Some(Value { value, stored: None }),
            Expr::Read { object, version } => self.read(object, version, path),
            _ => None,
        }
    }

    /// The same of one read of an object.
    pub fn read(&self, object: ObjectId, version: u32, path: ExprId) -> Option<Value> {
        let stored = self.stores.get(&(object, version))?;
        let is_sure = self.model.exprs.has_conjunct_prefix(path, stored.path);
        is_sure.then_some(Value { value: stored.value, stored: Some(stored.anchor) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower;
    use crate::syntax::{self, Language};

    /// What the last operation is known to convert: `BCD W1 -> W2`.
    fn converted(rungs: &[&str]) -> Option<i64> {
        let text: String = (1..).zip(rungs).map(|(at, rung)| format!("RUNG L{at}:\n{rung}\nEND_RUNG\n")).collect();
        let parse = syntax::parse(Language::Pl72Ld, &text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let model = lower::lower(parse.syntax(), &text, entity, Language::Pl72Ld);
        let known = Known::new(&model);
        let last = model.statements.iter().rev().find_map(|it| match it.kind {
            StatementKind::Store { value, .. } => Some((value, it.path)),
            _ => None,
        });
        let (value, path) = last.expect("an operation");
        let Expr::Call(_, operands) = model.exprs.get(value) else { panic!("{:?}", model.exprs.get(value)) };
        let found = operands.last().and_then(|it| known.value(*it, path))?;
        assert!(found.stored.is_some());
        Some(found.value)
    }

    const SET: &str = "H_LINK(7),OPERATE 12000 -> W1 END_BLOCK;";
    const MAYBE: &str = "OPEN_CONTACT(B0),H_LINK(6),OPERATE 12000 -> W1 END_BLOCK;";
    const CONVERT: &str = "H_LINK(7),OPERATE BCD W1 -> W2 END_BLOCK;";

    #[test]
    fn a_store_that_control_came_by() {
        assert_eq!(converted(&[SET, CONVERT]), Some(12_000));
        assert_eq!(converted(&[MAYBE, CONVERT]), None);
        assert_eq!(converted(&[MAYBE, "OPEN_CONTACT(B0),H_LINK(6),OPERATE BCD W1 -> W2 END_BLOCK;"]), Some(12_000));
        assert_eq!(converted(&["OPEN_CONTACT(B0),H_LINK(8),JUMP_COIL(L3);", SET, CONVERT]), None);
        assert_eq!(converted(&[CONVERT]), None);
    }

    #[test]
    fn nothing_wrote_in_between() {
        for other in [
            "H_LINK(7),OPERATE W5 -> W1 END_BLOCK;",
            "OPEN_CONTACT(B3),H_LINK(6),OPERATE 5 -> W1 END_BLOCK;",
            "H_LINK(7),OPERATE 5 -> W0(W5) END_BLOCK;",
            "H_LINK(7),OPERATE W20[10] -> W0[10] END_BLOCK;",
            "H_LINK(7),OPERATE BTA W30 -> W0 END_BLOCK;",
            "OPEN_CONTACT(B3),H_LINK(8),COIL(W1,D);",
        ] {
            assert_eq!(converted(&[SET, other, CONVERT]), None, "{other}");
        }
        assert_eq!(converted(&[SET, "H_LINK(7),OPERATE 5 -> W3 END_BLOCK;", CONVERT]), Some(12_000));
    }
}

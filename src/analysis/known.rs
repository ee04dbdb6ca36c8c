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

//! Edge tests against the writes of their bits. A PL7 bit keeps its former state, which moves when the bit is written
//! (PL7:1434-1439); an edge made by hand is tested against a memory bit, which the program refreshes.

use rustc_hash::FxHashMap;

use super::drives;
use super::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Type};
use crate::model::unit::{Mode, StatementKind};

/// The places that write an internal bit with an edge, when they are those of one unit, none of them sets or resets, and
/// no two take effect in one scan; else another rule speaks of the bit, or nothing is known.
fn lone_writes<'u, 'a>(
    program: &ProgramIndex<'a>,
    bit: &'u ObjectUses<'a>,
    neighbours: &[u32],
) -> Option<Vec<GlobalUse<'a>>> {
    let is_internal = bit.object.class == Class::Memory && bit.object.ty == Type::Bool && bit.object.is_fixed();
    let neighbour_is_written = || neighbours.iter().any(|&it| program.objects[it as usize].is_written());
    if !is_internal
        || !bit.has_mode(Mode::is_edge)
        || bit.has_mode(|it| it.writes() && !it.assigns())
        || neighbour_is_written()
    {
        return None;
    }
    let mut writes: Vec<GlobalUse<'a>> = bit.with_mode(Mode::assigns).copied().collect();
    drives::in_order(program, &mut writes);
    let first = writes.first()?;
    let is_lone = writes.iter().all(|it| it.unit == first.unit) && program.reached[first.unit as usize];
    let is_lone = is_lone && drives::conflict(program, &writes, |_, _| true).is_none();
    (is_lone && !program.unseen(bit).is_written_by_index()).then_some(writes)
}

/// An edge test that sees the same edge again, since the write of the bit can be passed by while the test is not; with
/// the first place that writes the bit.
pub fn permanent<'a>(
    program: &ProgramIndex<'a>,
    bit: &ObjectUses<'a>,
    neighbours: &[u32],
) -> Option<(GlobalUse<'a>, GlobalUse<'a>)> {
    let writes = lone_writes(program, bit, neighbours)?;
    let write = *writes.first()?;
    let rests = program.missed(&write).is_some() || program.is_passed_by(write.unit);
    let sees_again = |edge: &&GlobalUse<'a>| {
        if edge.unit == write.unit {
            return edge.it.stale;
        }
        let always = program.sure[edge.unit as usize] && edge.it.path == Exprs::TRUE.0;
        rests && always && program.same_scan(edge.unit, write.unit)
    };
    Some((*bit.with_mode(Mode::is_edge).find(sees_again)?, write))
}

/// Edge tests of an internal bit that can be passed by while the bit is written.
pub fn skipped<'a>(program: &ProgramIndex<'a>, bit: &ObjectUses<'a>, neighbours: &[u32]) -> Vec<GlobalUse<'a>> {
    let Some(writes) = lone_writes(program, bit, neighbours) else { return Vec::new() };
    if permanent(program, bit, neighbours).is_some() {
        return Vec::new();
    }
    let goes_on = |edge: &&GlobalUse<'a>| {
        let beside = writes.iter().any(|it| it.unit == edge.unit || program.run_together(it.unit, edge.unit));
        let together = writes.iter().any(|it| it.unit == edge.unit && it.it.path == edge.it.path);
        !together && (edge.it.skipped_by().is_some() || (!beside && program.is_passed_by(edge.unit)))
    };
    bit.with_mode(Mode::is_edge).filter(goes_on).copied().collect()
}

/// An edge made by hand, `U x`, `UN m`, whose test does not find in the memory what the bit was in the scan before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LostEdge {
    /// Indices of the statements that test the edge, and that refresh the memory.
    pub test: u32,
    pub refresh: u32,
    pub memory: ObjectId,
    pub why: Lost,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    /// The memory has the new value already.
    Late,
    /// In some runs the edge is tested, and the memory is not refreshed.
    PassedBy,
}

/// The edges made by hand that are lost: one of each memory.
pub fn lost(model: &UnitModel) -> Vec<LostEdge> {
    let mut refreshes = refreshes(model);
    let mut found = Vec::new();
    for (at, test) in (0..).zip(&model.statements) {
        if refreshes.is_empty() {
            break;
        }
        let condition = match test.kind {
            StatementKind::Assign { value, .. } => Some(value),
            _ => model.condition(test),
        };
        let Some(condition) = condition else { continue };
        let terms = terms(&model.exprs, condition);
        for memory in &terms {
            let Some(refresh) = refreshes.get(&memory.object) else { continue };
            let is_bit = |it: &&Term| it.object == refresh.bit && it.negated != memory.negated;
            let Some(bit) = terms.iter().find(is_bit) else { continue };
            let Some(statement) = model.statements.get(refresh.at as usize) else { continue };
            let is_late = refresh.at < at && memory.version == refresh.version && bit.version == refresh.taken;
            let is_passed_by = at < refresh.at
                && test.path != statement.path
                && model.exprs.has_conjunct_prefix(statement.path, test.path);
            if is_late || is_passed_by {
                let why = if is_late { Lost::Late } else { Lost::PassedBy };
                found.push(LostEdge { test: at, refresh: refresh.at, memory: memory.object, why });
                refreshes.remove(&memory.object);
            }
        }
    }
    found
}

/// `U x`, `= m`
struct Refresh {
    /// Index of the statement.
    at: u32,
    /// Version of the memory that it makes.
    version: u32,
    bit: ObjectId,
    /// Version of the bit that it takes.
    taken: u32,
}

/// Memory bits with one write alone, which takes the value of another bit.
fn refreshes(model: &UnitModel) -> FxHashMap<ObjectId, Refresh> {
    let mut writes = vec![0_u32; model.objects.len()];
    for it in model.accesses.iter().filter(|it| it.mode.writes()) {
        writes[it.object.0 as usize] += 1;
    }
    let mut refreshes = FxHashMap::default();
    for (at, statement) in (0..).zip(&model.statements).filter(|it| it.1.path != Exprs::FALSE) {
        let StatementKind::Assign { access, value } = statement.kind else { continue };
        let Some(access) = model.accesses.get(access as usize) else { continue };
        let is_memory = matches!(model.object(access.object).class, Class::Memory | Class::Data | Class::LocalName);
        let is_only = writes.get(access.object.0 as usize) == Some(&1);
        if let Expr::Read { object: bit, version: taken } = *model.exprs.get(value)
            && is_memory
            && is_only
            && bit != access.object
        {
            refreshes.insert(access.object, Refresh { at, version: access.version, bit, taken });
        }
    }
    refreshes
}

/// A bit that a condition reads.
struct Term {
    object: ObjectId,
    version: u32,
    negated: bool,
}

/// The bits that a condition, or its contrary, wants together: a jump is taken when there is no edge, too.
fn terms(exprs: &Exprs, condition: ExprId) -> Vec<Term> {
    const MOST: usize = 64;
    let start = match exprs.get(condition) {
        Expr::Not(inner) => *inner,
        _ => condition,
    };
    let (mut stack, mut terms) = (vec![start], Vec::new());
    while let Some(id) = stack.pop().filter(|_| terms.len() < MOST) {
        let (inner, negated) = match *exprs.get(id) {
            Expr::And(a, b) => {
                stack.extend([a, b]);
                continue;
            }
            Expr::Not(inner) => (inner, true),
            _ => (id, false),
        };
        if let Expr::Read { object, version } = *exprs.get(inner) {
            terms.push(Term { object, version, negated });
        }
    }
    terms
}

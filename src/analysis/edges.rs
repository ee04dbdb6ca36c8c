//! Edge tests against the writes of their bits. A PL7 bit keeps its former state, which moves when the bit is written
//! (PL7:1434-1439).

use super::drives;
use super::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::model::expr::Exprs;
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

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
        || program.is_written_by_index(&bit.object.footprint.area)
    {
        return None;
    }
    let mut writes: Vec<GlobalUse<'a>> = bit.with_mode(Mode::assigns).copied().collect();
    drives::in_order(program, &mut writes);
    let first = writes.first()?;
    let is_lone = writes.iter().all(|it| it.unit == first.unit) && program.reached[first.unit as usize];
    (is_lone && drives::conflict(program, &writes, |_, _| true).is_none()).then_some(writes)
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
        !together && (edge.it.skipped_by.is_some() || (!beside && program.is_passed_by(edge.unit)))
    };
    bit.with_mode(Mode::is_edge).filter(goes_on).copied().collect()
}

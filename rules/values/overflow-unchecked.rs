//! V004: arithmetic of which no code asks whether it overflowed.

use crate::analysis::Site;
use crate::analysis::program::ObjectUses;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::model::object::{Area, Class, Object};

/// `%S18` says that an operation overflowed, or divided by zero; so do `SY18` and, without signs, `SY17` (PL72:1031-1034).
const OVERFLOW: u32 = 18;
const OVERFLOW_UNSIGNED: u32 = 17;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let (first_bit, note) = match program.family {
        Family::Pl7 => (OVERFLOW, "`%S18` says so, and stays until the program resets it"),
        Family::Pl72 => {
            (OVERFLOW_UNSIGNED, "`SY18` says so, of numbers without a sign `SY17`; the program resets them")
        }
        Family::Step5 | Family::Step7 => return,
    };
    if !program.complete {
        return;
    }
    let tells = |it: &Object| {
        let covers = it.indexed || (it.footprint.start <= OVERFLOW && first_bit < it.footprint.end());
        it.footprint.area == Area::SystemBits && covers
    };
    let is_asked = program.objects_that(|it| it == Class::System, tells).iter().any(ObjectUses::is_read);
    let mut computing: Vec<Site> =
        (0..).zip(&program.units).filter_map(|(unit, facts)| Some(Site { unit, anchor: facts.computes? })).collect();
    computing.sort_by_key(|it| (program.order[it.unit as usize], it.anchor));
    let Some((&first, others)) = computing.split_first().filter(|_| !is_asked) else { return };
    let more = others.iter().map(|it| (*it, format!("{} computes, too", program.entity(it.unit))));
    sink.report(first, "the program computes, and never asks whether a result overflowed").related_all(more).note(note);
}

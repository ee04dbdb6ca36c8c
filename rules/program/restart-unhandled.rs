//! P008: a program that drives outputs and never asks how it was started.

use crate::analysis::Site;
use crate::analysis::program::{ObjectUses, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::model::object::{Area, Class};
use crate::syntax::Language;

/// `%S0` cold start, `%S1` warm start, `%S13` first cycle; `%SW10` cold start of each task.
const START_BITS: [u32; 3] = [0, 1, 13];
const START_WORD: u32 = 10;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // Whether the cross-reference of a project lists system bits is not known.
    let is_project = program.units.iter().any(|it| it.language == Language::Pl7Xref);
    if program.family != Family::Pl7 || is_project || !program.complete || program.objects.iter().any(asks) {
        return;
    }
    let outputs = program.objects.iter().filter(|it| it.object.class == Class::Output);
    let mut writes: Vec<Site> =
        outputs.filter_map(|it| it.with_mode(crate::model::unit::Mode::writes).next()).map(|it| it.site()).collect();
    writes.sort_by_key(|it| (program.order[it.unit as usize], it.anchor));
    let main = (0..).take(program.units.len()).min_by_key(|&it| program.order[it as usize]);
    if let (Some(main), Some(&output)) = (main, writes.first()) {
        sink.report(ProgramIndex::heading(main), "the program drives outputs, and never asks how it was started")
            .related(output, "an output is driven here")
            .note("`%S0` tells a cold start, `%S1` a warm one, `%SW10:X0` the first cycle after a cold start");
    }
}

fn asks(it: &ObjectUses<'_>) -> bool {
    let place = &it.object.footprint;
    let covers = |from: u32, to: u32| it.object.indexed || (place.start < to && from < place.end());
    let is_start = match place.area {
        Area::SystemBits => START_BITS.iter().any(|&bit| covers(bit, bit + 1)),
        Area::SystemWords => covers(START_WORD * 16, START_WORD * 16 + 16),
        _ => false,
    };
    is_start && it.is_read()
}

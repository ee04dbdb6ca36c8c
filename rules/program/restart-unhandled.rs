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
/// `SY00` cold start, `SY01` warm start; `SY09`, which the program sets, resets the outputs (PL72:1886-1888).
const START_BITS_PL7_2: [u32; 3] = [0, 1, 9];

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // Whether the cross-reference of a project lists system bits is not known.
    let is_project = program.units.iter().any(|it| it.language == Language::Pl7Xref);
    let (asks, note): (fn(&ObjectUses<'_>) -> bool, _) = match program.family {
        Family::Pl7 => {
            (asks, "`%S0` tells a cold start, `%S1` a warm one, `%SW10:X0` the first cycle after a cold start")
        }
        Family::Pl72 => (asks_pl7_2, "`SY00` tells a cold start, `SY01` a warm one; `SY09` resets the outputs"),
        Family::Step5 | Family::Step7 => return,
    };
    if is_project || !program.complete || program.objects_that(|it| it == Class::System, |_| true).iter().any(asks) {
        return;
    }
    let outputs = program.objects_that(|it| it == Class::Output, |_| true);
    let mut writes: Vec<Site> = outputs
        .iter()
        .filter_map(|it| it.with_mode(crate::model::unit::Mode::writes).next())
        .map(|it| it.site())
        .collect();
    writes.sort_by_key(|it| (program.order[it.unit as usize], it.anchor));
    let main = (0..).take(program.units.len()).min_by_key(|&it| program.order[it as usize]);
    if let (Some(main), Some(&output)) = (main, writes.first()) {
        sink.report(ProgramIndex::heading(main), "the program drives outputs, and never asks how it was started")
            .related(output, "an output is driven here")
            .note(note);
    }
}

fn asks_pl7_2(it: &ObjectUses<'_>) -> bool {
    let place = &it.object.footprint;
    let bit = START_BITS_PL7_2.iter().find(|bit| place.start <= **bit && **bit < place.end());
    place.area == Area::SystemBits && bit.is_some_and(|&bit| it.is_read() || bit == 9)
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

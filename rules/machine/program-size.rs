//! M003: a program that is larger than the memory for it.

use crate::analysis::program::ProgramIndex;
use crate::analysis::{Site, cost, size};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    match cx.program.family {
        Family::Pl72 => bytes(cx, sink),
        Family::Pl7 => instructions(cx, sink),
        Family::Step5 | Family::Step7 => {}
    }
}

/// PL7-2: the bytes of all elements.
fn bytes(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let (Some(bytes), Some(memory)) = (cost::program_bytes(cx.program), cx.settings.program_memory()) else { return };
    if bytes > u64::from(*memory.get_ref()) {
        let Some(place) = first_code(cx) else { return };
        sink.report(place, format!("the program takes {bytes} bytes, and the memory for it has {memory}"))
            .related(cx.settings.site(memory), "what the memory has")
            .note("estimated from PL72:1915-1974: elements, networks and their comments; the chart itself and constants are not counted");
    }
}

/// PL7: instructions against those that a processor holds at most.
fn instructions(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(processor) = cx.target.processor() else { return };
    let Some(share) = size::share(cx.program, processor.memory) else { return };
    if share.thousandths > 1000 {
        let Some(place) = first_code(cx) else { return };
        let [ladder, list, text] = share.instructions;
        sink.report(
            place,
            format!(
                "the program is {}.{} times what the memory of a {} holds",
                share.thousandths / 1000,
                share.thousandths % 1000 / 100,
                processor.name
            ),
        )
        .note(format!("{ladder} elements of ladder, {list} instructions of list, {text} statements of text were counted"))
        .note("estimated from the tables of PL7:1528-1728 for a program of Boolean instructions alone, which takes the least, \
             and the largest cartridge");
    }
}

fn first_code(cx: &ProgramCx<'_>) -> Option<Site> {
    let units = (0..).zip(&cx.program.units).filter(|it| it.1.instructions > 0);
    units.min_by_key(|it| cx.program.order[it.0 as usize]).map(|it| ProgramIndex::heading(it.0))
}

//! C004: a timer that only conditional calls scan, and that other code reads.

use crate::analysis::Site;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class};
use crate::model::unit::{Mode, Pin};
use crate::syntax::Language;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // The items of one block stand together: objects are in the order of their addresses.
    let same = |a: &ObjectUses<'_>, b: &ObjectUses<'_>| match &a.object.footprint.area {
        Area::Block(..) => a.object.footprint.area == b.object.footprint.area,
        _ => false,
    };
    for items in program.objects.chunk_by(same) {
        let is_timer = matches!(items[0].object.footprint.area, Area::Timers | Area::Block("TM" | "T", _));
        if !is_timer || !items.iter().all(|it| it.object.is_fixed()) {
            continue;
        }
        let uses = || items.iter().flat_map(|it| it.uses.iter());
        let mut starts = uses().filter(|it| matches!(it.mode, Mode::Drive(Pin::Start | Pin::Whole)));
        let Some(start) = starts.next() else { continue };
        // An order of structured text is for one moment: nothing has to scan the timer.
        let is_order = |it: &GlobalUse<'_>| program.units[it.unit as usize].language == Language::Pl7St;
        if ![start].into_iter().chain(starts).all(|it| program.is_passed_by(it.unit) && !is_order(it)) {
            continue;
        }
        let Some(read) = uses().find(|it| it.mode.reads() && program.sure[it.unit as usize]) else { continue };
        let block = items.iter().find(|it| matches!(it.object.class, Class::Block | Class::Timer));
        let name = block.map_or("", |it| &it.object.text);
        let message = format!("`{name}` is scanned by code that does not run in every scan, and read here");
        let mut finding = sink.report(read.site(), message).related(start.site(), "scanned here");
        if let Some((site, why)) = program.passed_by(start.unit) {
            finding = finding.related(site, why);
        }
        finding.note("while it is not scanned, a running timer runs on, and a stopped one does not start");
    }
}

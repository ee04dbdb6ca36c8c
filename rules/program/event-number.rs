//! P003: an event of a number that the controller does not have.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{Family, Task};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(range) = cx.target.events() else { return };
    let mut report = |number: u16, place: Site| {
        let head = match cx.target.controller() {
            Some(name) => format!("`EVT{number}` does not exist on a {name}"),
            None => format!("`EVT{number}` exists on no controller"),
        };
        sink.report(place, format!("{head}: events are EVT{} to EVT{}", range.first, range.last))
            .note(format!("the numbers are given in {}", range.source));
    };
    for unit in (0..).take(cx.program.units.len()) {
        let Some(Task::Event(number)) = cx.program.entity(unit).task() else { continue };
        if range.contains(u32::from(number)) {
            continue;
        }
        report(number, ProgramIndex::heading(unit));
    }
    let configured = cx.settings.events().iter().filter(|_| cx.program.family == Family::Pl7);
    for event in configured.filter(|it| !range.contains(u32::from(*it.number.get_ref()))) {
        report(*event.number.get_ref(), cx.settings.site(&event.number));
    }
}

//! P003: an event of a number that the controller does not have.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Task;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(range) = cx.target.events() else { return };
    for unit in (0..).take(cx.program.units.len()) {
        let Some(Task::Event(number)) = cx.program.entity(unit).task() else { continue };
        if range.contains(u32::from(number)) {
            continue;
        }
        let head = match cx.target.controller() {
            Some(name) => format!("`EVT{number}` does not exist on a {name}"),
            None => format!("`EVT{number}` exists on no controller"),
        };
        sink.report(ProgramIndex::heading(unit), format!("{head}: events are EVT{} to EVT{}", range.first, range.last))
            .note(format!("the numbers are given in {}", range.source));
    }
}

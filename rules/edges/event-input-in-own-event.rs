//! E005: the input that raises an event, read in that event.

use crate::analysis::Site;
use crate::analysis::program::{Context, GlobalUse};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;
use crate::target::pl7::Series;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // The modules that do not refresh the input are those of a Premium.
    let is_micro = cx.target.processor().is_some_and(|it| it.series == Series::Micro);
    if is_micro || cx.settings.events().is_empty() {
        return;
    }
    for uses in &cx.program.objects {
        let place = &uses.object.footprint;
        let is_bits = matches!(uses.object.ty, Type::Bool | Type::BitTable(_));
        if uses.object.class != Class::Input || !is_bits || !uses.object.is_fixed() {
            continue;
        }
        let raises = |number: u16| cx.settings.trigger_of(number).is_some_and(|it| it.footprint.overlaps(place));
        let event = |it: &GlobalUse<'_>| {
            cx.program.tasks(it.unit).find(|it| matches!(it, Context::Event(number) if raises(*number)))
        };
        let mut reads = uses.with_mode(Mode::reads).filter_map(|it| Some((it, event(it)?)));
        let Some((first, event)) = reads.next() else { continue };
        let (name, event) = (&uses.object.text, event.name(cx.program.family));
        sink.report(first.site(), format!("`{name}` raises {event}, and is not refreshed when it is read there"))
            .related_all(reads.map(|it| (it.0.site(), "also read here".to_owned())))
            .note("this is so on the modules TSX DEY 16FK, DMY 28FK and DMY 28RFK (PL7:2479)");
    }
}

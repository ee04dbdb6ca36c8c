//! C005: a timer, counter or other block that is read and never driven, or driven and never read.

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::entity::Family;
use crate::model::object::{Area, Class, Object, pl7, pl72};
use crate::model::unit::{Mode, Pin};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // The items of one block stand together: objects are in the order of their addresses.
    let same = |a: &ObjectUses<'_>, b: &ObjectUses<'_>| match &a.object.footprint.area {
        Area::Block(..) => a.object.footprint.area == b.object.footprint.area,
        _ => false,
    };
    for items in program.objects.chunk_by(same) {
        let Some(kind) = kind(items[0].object) else { continue };
        let unseen = program.unseen(&items[0]);
        let mut uses: Vec<GlobalUse<'_>> = items.iter().flat_map(|it| it.uses.iter().copied()).collect();
        drives::in_order(program, &mut uses);
        // What a call or a store does to it is not known.
        let is_open = |it: &GlobalUse<'_>| {
            it.it.parameter().is_some() || matches!(it.mode, Mode::InOut | Mode::Output | Mode::Drive(Pin::Whole))
        };
        let is_open = uses.iter().any(is_open);
        let area = &items[0].object.footprint.area;
        let holds = matches!(area, Area::Block("R" | "DR" | "D", _));
        let drive = uses.iter().find(|it| is_drive(it.mode, holds));
        let read = items
            .iter()
            .filter(|it| is_result(it.object, program.family))
            .find_map(|it| it.with_mode(Mode::reads).next());
        let name = items[0].object.text.split(['.', ',']).next().unwrap_or_default();
        match (drive, read) {
            _ if is_open => {}
            // What is not there can only be missed in a whole program.
            (None, Some(read)) if unseen.is_complete() && !unseen.is_written() => {
                let resets = uses.iter().filter(|it| matches!(it.mode, Mode::Drive(_)));
                sink.report(read.site(), format!("`{name}` is read, and nothing {kind}"))
                    .related_all(resets.map(|it| (it.site(), "only this is done with it".to_owned())));
            }
            // The outputs of a drum are set when the application is configured, and a text block sends.
            (Some(drive), None)
                if !matches!(area, Area::Block("DR" | "D" | "TXT", _)) && unseen.is_complete() && !unseen.is_read() =>
            {
                sink.report(drive.site(), format!("`{name}` is driven, and nothing reads it"))
                    .severity(Severity::Advice)
                    .note("this assumes that no operator panel or other station reads it");
            }
            _ => {}
        }
    }
}

/// What makes a block run, in the words of a message.
fn kind(object: &Object) -> Option<&'static str> {
    Some(match &object.footprint.area {
        Area::Timers | Area::Block("TM" | "T" | "MN" | "M" | "TXT", _) => "starts it",
        Area::Counters | Area::Block("C", _) => "makes it count",
        Area::Block("R", _) => "stores a value in it",
        Area::Block("DR" | "D", _) => "makes it advance",
        _ => return None,
    })
}

/// `holds`: the block is given values besides, as registers and drums are; of other blocks those are presets.
fn is_drive(mode: Mode, holds: bool) -> bool {
    match mode {
        Mode::Store => holds,
        Mode::Drive(pin) => !matches!(pin, Pin::Reset | Pin::Enable),
        _ => false,
    }
}

/// Whether what is read of an object comes out of the block, and was not put into it.
fn is_result(object: &Object, family: Family) -> bool {
    let is_preset = match family {
        Family::Pl72 => pl72::is_preset(object),
        _ => pl7::is_preset(object),
    };
    matches!(object.class, Class::Timer | Class::Counter | Class::BlockBit | Class::BlockWord) && !is_preset
}

//! C003: one pin of a timer, counter or monostable driven in more than one place.

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::{Mode, Pin};

const PINS: [Pin; 7] = [Pin::Start, Pin::Preset, Pin::Up, Pin::Down, Pin::Store, Pin::Retrieve, Pin::Advance];

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let is_drive = |it: Mode| matches!(it, Mode::Drive(_));
    for uses in cx.program.objects.iter().filter(|it| it.has_mode(is_drive) && it.object.is_fixed()) {
        for pin in PINS {
            let mut places: Vec<GlobalUse<'_>> =
                uses.with_mode(|it| it == Mode::Drive(pin)).filter(|it| counts(cx, it, pin)).copied().collect();
            drives::in_order(cx.program, &mut places);
            let Some((second, others)) = drives::conflict(cx.program, &places, |_, _| true) else { continue };
            let message =
                format!("the {} input of `{}` is driven in more than one place", pin.describe(), uses.object.text);
            sink.report(second.site(), message)
                .related_all(others.iter().map(|it| (it.site(), "also driven here".to_owned())));
        }
    }
}

/// A statement of structured text that counts or stores is an event of its own: several of them add up.
fn counts(cx: &ProgramCx<'_>, it: &GlobalUse<'_>, pin: Pin) -> bool {
    let event = cx.program.units[it.unit as usize].is_structured_text(it.it.anchor);
    !event || matches!(pin, Pin::Start | Pin::Preset)
}

//! C003: one pin of a timer, counter or monostable driven in more than one place.

use crate::analysis::Site;
use crate::analysis::facts;
use crate::analysis::program::{Context, GlobalUse};
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Pin;
use crate::syntax::Language;

const PINS: [Pin; 7] = [Pin::Start, Pin::Preset, Pin::Up, Pin::Down, Pin::Store, Pin::Retrieve, Pin::Advance];

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.program.objects.iter().filter(|it| it.object.is_fixed()) {
        for pin in PINS {
            let mut drives: Vec<GlobalUse<'_>> =
                uses.uses.iter().filter(|it| facts::pin(it.it) == Some(pin) && counts(cx, it, pin)).copied().collect();
            drives.sort_by_key(|it| (cx.program.order[it.unit as usize], it.it.anchor));
            let second = (1..drives.len()).find(|&at| drives[..at].iter().any(|it| clash(cx, it, &drives[at])));
            let Some(second) = second else { continue };
            let others = drives.iter().enumerate().filter(|it| it.0 != second);
            sink.report(
                drives[second].site(),
                format!("the {} input of `{}` is driven in more than one place", pin.describe(), uses.object.text),
            )
            .related_all(others.map(|(_, it)| (it.site(), "also driven here".to_owned())));
        }
    }
}

/// Start-up blocks run before the first scan. A statement of structured text that counts or stores is an event of its
/// own: several of them add up.
fn counts(cx: &ProgramCx<'_>, it: &GlobalUse<'_>, pin: Pin) -> bool {
    let event = cx.program.units[it.unit as usize].language == Language::Pl7St;
    let adds_up = event && !matches!(pin, Pin::Start | Pin::Preset);
    cx.program.contexts[it.unit as usize] != [Context::Startup] && !adds_up
}

fn clash(cx: &ProgramCx<'_>, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    if a.unit == b.unit { a.it.group != b.it.group } else { cx.program.same_scan(a.unit, b.unit) }
}

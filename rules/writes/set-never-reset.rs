//! W003: a bit that is set and never reset, or reset and never set.

use crate::analysis::Site;
use crate::analysis::processing::InAction;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.known_bits() {
        let class = uses.object.class;
        if uses.uses.iter().any(|it| gives_otherwise(it.mode)) {
            continue;
        }
        let sets: Vec<&GlobalUse<'_>> = uses.with_mode(|it| it == Mode::Set).collect();
        let resets: Vec<&GlobalUse<'_>> = uses.with_mode(|it| it == Mode::Reset).collect();
        let Some((missing, places)) = one_sided(&sets, &resets) else { continue };
        // A table that is not cleared is Q007's affair.
        if missing == Mode::Reset && cx.program.unseen(uses).is_in_uncleared_table() {
            continue;
        }
        // What a step stores is G011's affair.
        if missing == Mode::Reset && sets.iter().any(|it| InAction::of(cx.program, it).is_some()) {
            continue;
        }
        let constant_one = missing == Mode::Reset
            && sets.iter().any(|it| {
                it.it.own || cx.program.is_startup(it.unit) || !it.it.conditional && !cx.program.is_in_event(it.unit)
            });
        if constant_one || cx.program.unseen(uses).may_give(missing) {
            continue;
        }
        let Some((first, others)) = places.split_first() else { continue };
        let done = first.mode.verb();
        let report = sink
            .report(first.site(), format!("`{}` is {done} and never {}", uses.object.text, missing.verb()))
            .related_all(others.iter().map(|it| (it.site(), format!("also {done} here"))))
            .note("this assumes that no operator panel or other station writes the bit");
        if missing == Mode::Set && class != Class::Output {
            // An operator panel sets it and the program takes it back: a common handshake.
            report.severity(Severity::Advice);
        }
    }
}

/// What is missing, and the places of what is there.
fn one_sided<'p, 'a>(
    sets: &'p [&'p GlobalUse<'a>],
    resets: &'p [&'p GlobalUse<'a>],
) -> Option<(Mode, &'p [&'p GlobalUse<'a>])> {
    match (sets.is_empty(), resets.is_empty()) {
        (false, true) => Some((Mode::Reset, sets)),
        (true, false) => Some((Mode::Set, resets)),
        _ => None,
    }
}

/// Whether a place gives the bit a value by other means: an assignment, a call, as the input of a block.
fn gives_otherwise(mode: Mode) -> bool {
    matches!(mode, Mode::Drive(_)) || mode.writes() && !matches!(mode, Mode::Set | Mode::Reset)
}

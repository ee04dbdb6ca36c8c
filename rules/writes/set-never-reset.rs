//! W003: a bit that is set and never reset, or reset and never set.

use crate::analysis::Site;
use crate::analysis::drives::Hidden;
use crate::analysis::processing::InAction;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // What is not there can only be missed in a whole program of which every place is known.
    if !cx.program.complete {
        return;
    }
    let hidden = Hidden::new(cx.program);
    for (at, uses) in (0..).zip(&cx.program.objects) {
        let class = uses.object.class;
        let is_bit = uses.object.ty == Type::Bool || class == Class::Symbol;
        let is_block = uses.uses.iter().any(|it| matches!(it.mode, Mode::Drive(_)));
        if !is_bit || is_block || !matches!(class, Class::Output | Class::Memory | Class::Symbol) {
            continue;
        }
        let sets: Vec<&GlobalUse<'_>> = uses.with_mode(|it| it == Mode::Set).collect();
        let resets: Vec<&GlobalUse<'_>> = uses.with_mode(|it| it == Mode::Reset).collect();
        let Some((missing, places)) = one_sided(&sets, &resets) else { continue };
        // What a step stores is G011's affair.
        if missing == Mode::Reset && sets.iter().any(|it| InAction::of(cx.program, it).is_some()) {
            continue;
        }
        // A memory bit that nothing reads is O007's affair.
        let unread = class == Class::Memory && !is_read(cx, at, uses);
        let constant_one = missing == Mode::Reset
            && sets.iter().any(|it| {
                it.it.own || cx.program.is_startup(it.unit) || !it.it.conditional && !cx.program.is_in_event(it.unit)
            });
        let is_placed = cx.program.writes_indirectly(&uses.object.footprint.area);
        if unread || constant_one || is_placed || is_written_otherwise(cx, at, uses) || hidden.may_hold(class, missing)
        {
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

fn is_read(cx: &ProgramCx<'_>, at: u32, uses: &ObjectUses<'_>) -> bool {
    uses.is_read() || cx.neighbours(at).iter().any(|&it| cx.program.objects[it as usize].is_read())
}

/// Whether the bit takes a value by other means: an assignment, a call, a word or table that covers it.
fn is_written_otherwise(cx: &ProgramCx<'_>, at: u32, uses: &ObjectUses<'_>) -> bool {
    let by_itself = uses.uses.iter().any(|it| it.mode.writes() && !matches!(it.mode, Mode::Set | Mode::Reset));
    by_itself || cx.neighbours(at).iter().any(|&it| cx.program.objects[it as usize].is_written())
}

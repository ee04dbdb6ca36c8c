//! W002: a bit driven both by assignment and by set or reset.

use crate::analysis::Site;
use crate::analysis::program::GlobalUse;
use crate::analysis::{apart, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        let is_stored = |it: Mode| matches!(it, Mode::Set | Mode::Reset);
        if !uses.has_mode(is_stored) || !uses.has_mode(Mode::assigns) && cx.neighbours(at).is_empty() {
            continue;
        }
        let is_bit = uses.object.ty == Type::Bool || uses.object.class == Class::Symbol;
        let is_block = uses.has_mode(|it| matches!(it, Mode::Drive(_)));
        let driven = matches!(uses.object.class, Class::Output | Class::Memory | Class::Data | Class::Symbol);
        // The open data block may be another one at each place.
        let known = uses.object.is_fixed() && uses.object.footprint.area != Area::OpenData;
        if !is_bit || is_block || !driven || !known {
            continue;
        }
        let stored = |it: &GlobalUse<'_>| is_stored(it.mode);
        let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(is_stored).copied().collect();
        // A constant, and a circuit that holds itself, store the bit as set and reset do.
        writes.extend(uses.with_mode(Mode::assigns).filter(|it| it.it.constant().is_none() && !it.it.holds));
        writes.extend(drives::covering(cx.program, uses, cx.neighbours(at)));
        drives::in_order(cx.program, &mut writes);
        // A scratch value that each unit assigns before it sets or resets it.
        let starts_by_set = |at: usize| (at == 0 || writes[at - 1].unit != writes[at].unit) && stored(&writes[at]);
        if uses.is_scratch() && !(0..writes.len()).any(starts_by_set) {
            continue;
        }
        // A reset below the assignment in the same unit takes part of the assigned condition back.
        let corrects = |a: &GlobalUse<'_>, b: &GlobalUse<'_>| a.unit == b.unit && b.mode == Mode::Reset;
        let opposed = |a: &GlobalUse<'_>, b: &GlobalUse<'_>| {
            stored(a) != stored(b) && !corrects(a, b) && !apart::never_together(cx.program, || cx.studies(), a, b)
        };
        let Some((second, others)) = drives::conflict(cx.program, &writes, opposed) else { continue };
        let label = match second.mode {
            Mode::Set | Mode::Reset => format!("{} here, where the assignment does not reach", second.mode.verb()),
            _ => "assigned here, whatever was set or reset before".to_owned(),
        };
        sink.report(second.site(), format!("`{}` is both assigned and set or reset", uses.object.text))
            .label(label)
            .related_all(others.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))));
    }
}

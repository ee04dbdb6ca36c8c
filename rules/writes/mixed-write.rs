//! W002: a bit driven both by assignment and by set or reset.

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        let is_bit = uses.object.ty == Type::Bool || uses.object.class == Class::Symbol;
        let is_block = uses.uses.iter().any(|it| matches!(it.mode, Mode::Drive(_)));
        let driven = matches!(uses.object.class, Class::Output | Class::Memory | Class::Data | Class::Symbol);
        if !is_bit || is_block || !driven || !uses.object.is_fixed() {
            continue;
        }
        let stored = |it: &GlobalUse<'_>| matches!(it.mode, Mode::Set | Mode::Reset);
        let mut writes: Vec<GlobalUse<'_>> = uses.uses.iter().filter(|it| stored(it)).copied().collect();
        if writes.is_empty() {
            continue;
        }
        // A constant that is assigned under a condition stores it, as set and reset do.
        writes.extend(uses.with_mode(Mode::assigns).filter(|it| it.it.constant.is_none()));
        writes.extend(drives::covering(cx.program, uses, cx.neighbours(at)));
        drives::in_order(cx.program, &mut writes);
        // A scratch value that each unit assigns before it sets or resets it.
        let starts_by_set = |at: usize| (at == 0 || writes[at - 1].unit != writes[at].unit) && stored(&writes[at]);
        if uses.is_scratch() && !(0..writes.len()).any(starts_by_set) {
            continue;
        }
        let Some((second, others)) = drives::conflict(cx.program, &writes, |a, b| stored(a) != stored(b)) else {
            continue;
        };
        let label = match second.mode {
            Mode::Set | Mode::Reset => format!("{} here, where the assignment does not reach", second.mode.verb()),
            _ => "assigned here, whatever was set or reset before".to_owned(),
        };
        sink.report(second.site(), format!("`{}` is both assigned and set or reset", uses.object.text))
            .label(label)
            .related_all(others.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))));
    }
}

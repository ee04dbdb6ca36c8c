//! W001: a bit driven by assignment in more than one place.

use crate::analysis::Site;
use crate::analysis::program::{Context, GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in cx.program.objects.iter().enumerate() {
        let is_bit = match uses.object.class {
            Class::Output | Class::Memory => uses.object.ty == Type::Bool,
            // Only bits are assigned conditions.
            Class::Symbol => true,
            _ => false,
        };
        if !is_bit {
            continue;
        }
        // Mixed driving is W002's affair, and a scratch value is nobody else's.
        let set_or_reset = uses.uses.iter().any(|it| matches!(it.mode, Mode::Set | Mode::Reset));
        if set_or_reset || !uses.object.is_fixed() || uses.is_scratch() {
            continue;
        }
        let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(Mode::assigns).copied().collect();
        // A bit that only takes the outputs of calls which nobody wants is a waste basket.
        let is_sink = uses.object.class != Class::Output
            && !uses.is_read()
            && writes.iter().all(|it| it.mode == Mode::Output);
        if writes.is_empty() || is_sink {
            continue;
        }
        writes.extend(covering(cx, at, uses));
        writes.sort_by_key(|it| (cx.program.order[it.unit as usize], it.it.anchor));
        if let Some((second, others)) = conflict(cx, &writes) {
            sink.report(second.site(), format!("`{}` is assigned in more than one place", uses.object.text))
                .label("assigned here too, which overrides the other")
                .related_all(others.iter().map(|it| (it.site(), format!("also {} here", it.mode.verb()))));
        }
    }
}

/// Stores of words and tables that cover an output bit, or of bit tables that cover a memory bit.
fn covering<'a>(cx: &ProgramCx<'a>, at: usize, bit: &ObjectUses<'a>) -> Vec<GlobalUse<'a>> {
    let mut found = Vec::new();
    for &(whole, part) in cx.overlaps() {
        let whole = &cx.program.objects[whole as usize];
        let wide = whole.object.class == Class::Output || matches!(whole.object.ty, Type::BitTable(_));
        if part as usize == at && wide && whole.object.footprint.contains(&bit.object.footprint) {
            found.extend(whole.with_mode(|it| it == Mode::Store).filter(|it| it.it.constant.is_none()).copied());
        }
    }
    found
}

/// The second place of the first two that can take effect in one scan, and all others.
fn conflict<'a>(cx: &ProgramCx<'_>, writes: &[GlobalUse<'a>]) -> Option<(GlobalUse<'a>, Vec<GlobalUse<'a>>)> {
    let startup_only = |unit: u32| cx.program.contexts[unit as usize] == [Context::Startup];
    let writes: Vec<GlobalUse<'a>> = writes.iter().filter(|it| !startup_only(it.unit)).copied().collect();
    let clash = |a: &GlobalUse<'_>, b: &GlobalUse<'_>| {
        if a.unit == b.unit { a.it.group != b.it.group } else { cx.program.same_scan(a.unit, b.unit) }
    };
    let at = (1..writes.len()).find(|&at| writes[..at].iter().any(|it| clash(it, &writes[at])))?;
    let others = writes.iter().enumerate().filter(|it| it.0 != at).map(|it| *it.1).collect();
    Some((writes[at], others))
}

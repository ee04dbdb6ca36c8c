//! W001: a bit driven by assignment in more than one place.

use std::cell::LazyCell;

use crate::analysis::Site;
use crate::analysis::program::GlobalUse;
use crate::analysis::{apart, coactive, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        let is_bit = match uses.object.class {
            Class::Output | Class::Memory => uses.object.ty == Type::Bool,
            // Only bits are assigned conditions.
            Class::Symbol => uses.has_mode(|it| matches!(it, Mode::Assign | Mode::AssignNot)),
            _ => false,
        };
        if !is_bit {
            continue;
        }
        // Mixed driving is W002's affair, a bit with an edge E002's, and a scratch value is nobody else's.
        let others = uses.has_mode(|it| matches!(it, Mode::Set | Mode::Reset) || it.is_edge());
        if others || !uses.object.is_fixed() || uses.is_scratch() {
            continue;
        }
        let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(Mode::assigns).copied().collect();
        // A bit that only takes the outputs of calls which nobody wants is a waste basket.
        let is_sink =
            uses.object.class != Class::Output && !uses.is_read() && writes.iter().all(|it| it.mode == Mode::Output);
        // What was not understood may read the bit between two writes. Actions of a chart are apart from one another.
        let may_read = |it: &GlobalUse<'_>| {
            let unit = cx.program.units[it.unit as usize];
            unit.has_gaps && !unit.language.is_chart()
        };
        let is_hidden = uses.object.class != Class::Output && writes.iter().any(may_read);
        if writes.is_empty() || is_sink || is_hidden {
            continue;
        }
        writes.extend(drives::covering(cx.program, uses, cx.neighbours(at)));
        drives::in_order(cx.program, &mut writes);
        // Only the last value of an output gets to the process.
        let is_kept = uses.object.class != Class::Output;
        let reading = LazyCell::new(|| drives::ReadingCalls::new(cx.program, uses));
        let opposed = |a: &GlobalUse<'_>, b: &GlobalUse<'_>| {
            let has_effect = is_kept && reading.between(a, b)
                || [a, b].iter().all(|it| drives::is_of_cleared_table(cx.program, it, cx.neighbours(at)));
            drives::override_each_other(a, b)
                && !drives::of_one_instance(cx.program, a, b)
                && !has_effect
                && !apart::never_together(cx.program, || cx.studies(), a, b)
        };
        if let Some((second, others)) = drives::conflict(cx.program, &writes, opposed) {
            sink.report(second.site(), format!("`{}` is assigned in more than one place", uses.object.text))
                .label("assigned here too, which overrides the other")
                .related_all(others.iter().map(|it| (it.site(), format!("also {} here", it.mode.verb()))));
        } else if let Some(it) = coactive::assigned(cx.program, || cx.studies(), uses) {
            let (first, second) = (it.first, it.second);
            let message =
                format!("`{}` is assigned in the actions of steps that are active together", uses.object.text);
            sink.report(second.0.site(), message)
                .label(format!("in {}, which runs after the other", second.1.describe()))
                .related(first.0.site(), format!("also {} here, in {}", first.0.mode.verb(), first.1.describe()))
                .note(format!("the chart comes to both by {}", it.trace));
        }
    }
}

//! J011: a cycle of calls.

use crate::analysis::Site;
use crate::analysis::calls;
use crate::lint::{ProgramCx, Severity, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for cycle in calls::cycles(cx.program) {
        let cycle: Vec<_> = cycle.iter().filter_map(|&it| cx.program.calls.get(it as usize)).collect();
        let Some((last, before)) = cycle.split_last() else { continue };
        let message = match before {
            [] => format!("`{}` calls itself", cx.program.entity(last.unit)),
            _ => format!("the call of `{}` closes a cycle of {} calls", last.it.text, cycle.len()),
        };
        let steps =
            before.iter().map(|it| (it.site(), format!("{} calls `{}`", cx.program.entity(it.unit), it.it.text)));
        let report = sink.report(last.site(), message).related_all(steps);
        if cycle.iter().any(|it| it.it.conditional) {
            let note = "a condition may end the cycle; nothing limits it to the levels that the controller has";
            report.severity(Severity::Warning).note(note);
        }
    }
}

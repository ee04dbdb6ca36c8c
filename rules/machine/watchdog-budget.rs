//! M001: a scan that may take longer than the watchdog allows.

use crate::analysis::cost::{self, TaskCost, milliseconds};
use crate::analysis::{Site, program::ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Task;

/// Parts of the program that a finding shows.
const MAX_SHOWN: usize = 8;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(controller) = cx.target.pl72().and_then(|it| it.controller) else { return };
    let Some(limit) = cx.target.watchdog_ms() else { return };
    let Some(scan) = cost::task(cx.program, Task::Mast, controller.series) else { return };
    let total = scan.code_ns.saturating_add(scan.system_ns);
    if total <= u64::from(limit.value) * 1_000_000 {
        return;
    }
    let Some(first) = scan.units.first() else { return };
    let message = format!(
        "a scan may take {} on a {}, and the watchdog stops the program after {} ms",
        milliseconds(total),
        controller.name,
        limit.value
    );
    let share = |&(unit, time): &(u32, u64)| {
        format!("{} of it: {}", milliseconds(time), cost::name_of(cx.program.entity(unit)))
    };
    // The largest parts, in the order of execution.
    let mut others: Vec<&(u32, u64)> = scan.units.iter().skip(1).collect();
    others.sort_by_key(|it| std::cmp::Reverse(it.1));
    others.truncate(MAX_SHOWN);
    others.sort_by_key(|it| cx.program.order[it.0 as usize]);
    sink.report(ProgramIndex::heading(first.0), message)
        .label(share(first))
        .related_all(others.into_iter().map(|it| (ProgramIndex::heading(it.0), share(it))))
        .note(format!(
            "estimated from PL72:1898-1972: {} of code with all its blocks active and all its operations fed, {} of the \
             system",
            milliseconds(scan.code_ns),
            milliseconds(scan.system_ns)
        ))
        .note(left_out(&scan, cost::has_fast_task(cx.program)));
}

/// What an estimate lacks.
pub(super) fn left_out(scan: &TaskCost, has_fast_task: bool) -> String {
    let mut missing = vec!["modules that the program does not use".to_owned()];
    if scan.has_chart {
        missing.push("the evolution of the chart".to_owned());
    }
    if scan.turns_back {
        missing.push("repetitions by jumps that lead back".to_owned());
    }
    if has_fast_task {
        missing.push("interruptions by the fast task".to_owned());
    }
    if scan.unlisted > 0 {
        missing.push(format!("elements without a figure ({})", scan.unlisted));
    }
    format!("not counted: {}", missing.join(", "))
}

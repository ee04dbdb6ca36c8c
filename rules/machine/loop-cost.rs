//! M004: a loop that takes longer than the watchdog allows.

use crate::analysis::Site;
use crate::analysis::turns::LoopCosts;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::target::{pl7, step7};

/// Nanoseconds that an operation is taken to need, unless the option `operation-ns` says otherwise.
const OPERATION_NS: u64 = 1000;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let option = cx.settings.options("loop-cost").and_then(|it| it.get("operation-ns"));
    let option = option.and_then(|it| u64::try_from(it.as_integer()?).ok());
    let each = option.unwrap_or(OPERATION_NS).max(1);
    if !matches!(cx.program.family, Family::Pl7 | Family::Step7) {
        return;
    }
    let nanoseconds = |unit: u32| u64::from(watchdog(cx, unit).0) * 1_000_000;
    for it in LoopCosts::new(cx.program).above(|unit| nanoseconds(unit) / each) {
        // No watchdog runs while the CPU starts.
        if cx.program.is_startup(it.unit) {
            continue;
        }
        let (limit, source) = watchdog(cx, it.unit);
        let site = |anchor: u32| Site { unit: it.unit, anchor };
        let time = it.operations.saturating_mul(each) / 1_000_000;
        let message = format!(
            "this loop runs up to {} times, {} operations in all: about {time} ms, and the watchdog stops the controller \
             after {limit} ms",
            it.turns, it.operations
        );
        let inner = it.inner.iter().map(|&(anchor, turns)| (site(anchor), format!("up to {turns} times in each turn")));
        sink.report(site(it.it.anchor), message)
            .related_all(inner)
            .note(format!("assumed: an operation takes {each} ns; the option `operation-ns` says otherwise"))
            .note(format!("the watchdog: {source}"));
    }
}

/// Milliseconds of the watchdog over a unit, and who says so.
fn watchdog(cx: &ProgramCx<'_>, unit: u32) -> (u32, &'static str) {
    let default = match cx.program.family {
        Family::Pl7 => pl7::WATCHDOG_DEFAULT_MS,
        _ => cx.target.watchdog_ms().unwrap_or(step7::WATCHDOG_MS),
    };
    let runs = |context| cx.program.tasks(unit).any(|it| it == context);
    let configured = cx.settings.tasks().iter().filter(|it| it.context().is_some_and(runs));
    let shortest = configured.filter_map(|it| Some(it.watchdog.as_ref()?.get_ref().0)).min();
    shortest.map_or((default.value, default.source), |it| (it, "as the configuration says"))
}

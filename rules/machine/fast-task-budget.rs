//! M002: a fast task that is longer than its period allows.

use crate::analysis::Site;
use crate::analysis::cost;
use crate::analysis::program::{ObjectUses, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Task;
use crate::model::object::{Area, Object};
use crate::model::unit::Mode;
use crate::target::pl72::{FAST_TASKS, Feature, Series};

/// The bit that chooses the period (PL72:326-327).
const PERIOD_BIT: u32 = 3;

/// The controller that PL72:553 speaks of.
const COUPLED: &str = "TSX 47-20";

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(model) = cx.target.pl72() else { return };
    let Some(controller) = model.controller.filter(|it| it.series != Series::Tsx17) else { return };
    // A version without the task is the business of O006.
    if !model.has(Feature::PeriodicFastTask) {
        return;
    }
    let program = cx.program;
    let Some(cost) = cost::task(program, Task::Fast, controller.series) else { return };
    let setting = program.objects.iter().find_map(sets_period);
    let Some(row) = FAST_TASKS.iter().find(|it| it.sy03 == setting.is_some()) else { return };
    if let Some(setting) = setting.filter(|_| row.excludes_couplers && controller.name == COUPLED) {
        coupled(cx, setting, sink);
    }
    let is_long = cost.code_ns > u64::from(row.duration_us.value) * 1_000;
    let is_many = cost.networks > row.networks.value;
    let Some(&(first, _)) = cost.units.first().filter(|_| is_long || is_many) else { return };
    let networks = format!("{} networks, and {} are the most", cost.networks, row.networks.value);
    let (took, most) = (cost.code_ns.div_ceil(1_000), row.duration_us.value);
    let time = format!("{took} microseconds, and {most} are the most");
    let every = format!("in a task that runs every {} ms", row.period_ms.value);
    let message = match (is_many, is_long) {
        (true, true) => format!("the fast task has {networks}, and may take {time}, {every}"),
        (true, false) => format!("the fast task has {networks} {every}"),
        (false, _) => format!("the fast task may take {time} {every}"),
    };
    let mut finding = sink
        .report(ProgramIndex::heading(first), message)
        .related_all(setting.map(|it| (it, "this bit chooses a period of 5 ms".to_owned())))
        .note(format!("the limits are given in {}", row.networks.source));
    if is_long {
        finding = finding.note(
            "the time is estimated from PL72:1915-1972, with all blocks active and all operations fed; the exchange of inputs \
             and outputs is not counted",
        );
    }
    if setting.is_none() {
        finding.note("nothing sets `SY03`, so that the period is 10 ms");
    }
}

/// A period of 5 ms beside words of an intelligent module or of the network (PL72:553).
fn coupled(cx: &ProgramCx<'_>, setting: Site, sink: &mut Sink<'_, Site>) {
    let is_coupled = |it: &Object| matches!(it.footprint.area, Area::ModuleWords(_) | Area::Network(..));
    let words = cx.program.objects.iter().filter(|it| is_coupled(it.object));
    let Some((object, first)) = words.filter_map(|it| Some((it.object, it.uses.first()?))).next() else { return };
    let message =
        format!("the fast task cannot run every 5 ms beside a coupler, and `{}` is a word of one", object.text);
    sink.report(setting, message).related(first.site(), "the module is used here").note("according to PL72:553");
}

/// A write that may set SY03.
fn sets_period(uses: &ObjectUses<'_>) -> Option<Site> {
    let place = &uses.object.footprint;
    if place.area != Area::SystemBits || place.start != PERIOD_BIT {
        return None;
    }
    let sets = |mode: Mode| mode.writes() && mode != Mode::Reset;
    uses.with_mode(sets).find(|it| it.it.constant() != Some(0)).map(|it| it.site())
}

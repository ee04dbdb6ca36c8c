//! P006: a period or a watchdog that a task cannot have.

use crate::analysis::Site;
use crate::analysis::program::{Context, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::model::object::{Area, Class, Type};
use crate::model::unit::Mode;
use crate::target::Range;
use crate::target::pl7::{FAST_PERIOD_MS, MASTER_PERIOD_MS, Series, WATCHDOG_MAX_MS};

/// The system words that hold the periods of MAST and FAST (PL7:2298, PL7:2031).
const PERIODS: [(u32, &str, Range); 2] = [(0, "MAST", MASTER_PERIOD_MS), (1, "FAST", FAST_PERIOD_MS)];

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if cx.program.family == Family::Pl7 {
        configured(cx, sink);
        written(cx, sink);
    }
}

fn configured(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let is_micro = cx.target.processor().is_some_and(|it| it.series == Series::Micro);
    for task in cx.settings.tasks() {
        let Some((context, (_, name, range))) =
            task.context().zip(PERIODS.iter().find(|it| it.1.eq_ignore_ascii_case(&task.name)))
        else {
            continue;
        };
        let unit = first_unit(cx.program, context).map(|it| (it, "the task".to_owned()));
        let period = task.period.as_ref().map(|it| (it.get_ref().0, cx.settings.site(it)));
        if let Some((period, place)) = period.filter(|it| !range.contains(it.0)) {
            let (first, last, source) = (range.first, range.last, range.source);
            sink.report(place, format!("the period of {name} is {period} ms, and may be {first} to {last} ms"))
                .related_all(unit.clone())
                .note(format!("the range is given in {source}"));
        }
        let Some(configured) = &task.watchdog else { continue };
        let (watchdog, place) = (configured.get_ref().0, cx.settings.site(configured));
        let most = WATCHDOG_MAX_MS;
        if watchdog > most.value {
            let message = format!("the watchdog of {name} is {watchdog} ms, and may be {} ms at most", most.value);
            sink.report(place, message).related_all(unit).note(format!("the limit is given in {}", most.source));
        } else if let Some((period, at)) = period.filter(|it| !is_micro && watchdog <= it.0) {
            let message =
                format!("the watchdog of {name} is {watchdog} ms, which is not above its period of {period} ms");
            sink.report(place, message)
                .related(at, "the period")
                .related_all(unit)
                .note("on a Premium the watchdog has to be longer than the period (PL7:2288)");
        }
    }
}

/// Heading of the first unit that a task runs.
fn first_unit(program: &ProgramIndex<'_>, context: Context) -> Option<Site> {
    let units = (0..).take(program.units.len());
    let mut runs = units.filter(|&it| program.tasks(it).any(|it| it == context));
    let first = runs.by_ref().next()?;
    Some(ProgramIndex::heading(
        runs.fold(first, |a, b| if program.order[b as usize] < program.order[a as usize] { b } else { a }),
    ))
}

/// A constant that the program gives as a period. What 0 does, the manual does not say.
fn written(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in &cx.program.objects_that(|it| it == Class::System, |it| it.footprint.area == Area::SystemWords) {
        let word = uses.object.footprint.start / 16;
        let Some((_, name, range)) = PERIODS.iter().find(|it| it.0 == word) else { continue };
        if uses.object.ty != Type::Word || uses.object.indexed {
            continue;
        }
        for it in uses.with_mode(|it| it == Mode::Store) {
            let wrong = it.it.constant().filter(|&it| it != 0 && !u32::try_from(it).is_ok_and(|it| range.contains(it)));
            let Some(value) = wrong else { continue };
            let (text, first, last) = (&uses.object.text, range.first, range.last);
            let message = format!("`{text}` takes {value}, and the period of {name} is {first} to {last} ms");
            sink.report(it.site(), message).note(format!("the range is given in {}", range.source));
        }
    }
}

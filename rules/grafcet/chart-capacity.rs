//! G019: more of a chart than the controller holds.

use crate::analysis::Site;
use crate::analysis::capacity::{AtOnce, Drawn};
use crate::analysis::reach::Study;
use crate::lint::{ProgramCx, Severity, Sink};
use crate::target::{ChartCapacity, Limit};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(capacity) = cx.target.chart_capacity() else { return };
    drawn(&Drawn::new(cx.program.charts()), &capacity, sink);
    configured(cx, &capacity, sink);
    at_once(cx, &capacity, sink);
}

/// What the drawing has.
fn drawn(drawn: &Drawn, capacity: &ChartCapacity, sink: &mut Sink<'_, Site>) {
    let (origins, destinations) = capacity.connectors.unzip();
    let limits = [
        ("steps", Some(capacity.steps), &drawn.steps),
        ("initial steps", capacity.initial_steps, &drawn.initial_steps),
        ("transitions", Some(capacity.transitions), &drawn.transitions),
        ("AND convergences", capacity.and_convergences, &drawn.and_convergences),
        ("origin connectors", origins, &drawn.origins),
        ("destination connectors", destinations, &drawn.destinations),
    ];
    for (what, limit, all) in limits {
        if let Some(limit) = limit {
            report(sink, what, limit, all);
        }
    }
}

/// What the configuration gives the charts, against what the controller has.
fn configured(cx: &ProgramCx<'_>, capacity: &ChartCapacity, sink: &mut Sink<'_, Site>) {
    if cx.program.charts().is_empty() {
        return;
    }
    let configured = cx.settings.chart();
    let values = [
        (configured.active_steps, capacity.active_steps, "active steps"),
        (configured.valid_transitions, capacity.valid_transitions, "valid transitions"),
    ];
    for (value, most, what) in values {
        let Some(value) = value.filter(|it| *it.get_ref() > most.value) else { continue };
        let of = cx.target.controller().map_or("a controller".to_owned(), |it| format!("a {it}"));
        sink.report(cx.settings.site(&value), format!("{of} keeps {} {what} at most, not {value}", most.value))
            .note(format!("the number is given in {}", most.source));
    }
}

fn report(sink: &mut Sink<'_, Site>, what: &str, limit: Limit, all: &[Site]) {
    let (Some(beyond), Some(first)) = (all.get(limit.value as usize), all.first()) else { return };
    let count = all.len();
    sink.report(*beyond, format!("the charts have {count} {what}, and {} are allowed", limit.value))
        .label("the first one beyond")
        .related(*first, "the first one of all")
        .note(format!("the number is given in {}", limit.source));
}

/// What the charts can have active and valid at one time.
fn at_once(cx: &ProgramCx<'_>, capacity: &ChartCapacity, sink: &mut Sink<'_, Site>) {
    let configured = cx.settings.chart();
    let (active, valid) = capacity.default.map_or((None, None), |it| (Some(it.0), Some(it.1)));
    let limits = [
        ("active steps", configured.active_steps, active, capacity.active_steps, "active-steps"),
        ("valid transitions", configured.valid_transitions, valid, capacity.valid_transitions, "valid-transitions"),
    ];
    let counts: [fn(&[Study<'_, '_>]) -> AtOnce; 2] = [AtOnce::active_steps, AtOnce::valid_transitions];
    for ((what, configured, default, most, key), of) in limits.into_iter().zip(counts) {
        let limit = configured
            .as_ref()
            .map(|it| *it.get_ref())
            .or(default.map(|it| it.value))
            .map_or(most.value, |it| it.min(most.value));
        // Fewer that there are at all are never too many.
        let drawn = cx.studies().iter().map(|it| it.net.nodes.len().max(it.net.crossings.len())).sum::<usize>();
        if drawn <= limit as usize {
            continue;
        }
        let count = of(cx.studies());
        let Some((place, others)) = count.steps.split_first().filter(|_| count.sum > limit) else { continue };
        let message = format!("{} {what} are reached at one time, and {limit} are kept", count.sum);
        let also = others.iter().map(|it| (*it, "active at the same time".to_owned()));
        let mut finding = sink.report(*place, message).related_all(also).note(count.trace);
        if count.parts > 1 {
            finding = finding.note("this counts what charts that nothing connects reach, each by itself");
        }
        if count.sum > most.value {
            finding.note(format!("no more can be configured, according to {}", most.source));
        } else if let Some(configured) = &configured {
            finding.related(cx.settings.site(configured), format!("`{key}` says so"));
        } else {
            // The application may configure more, up to what the controller has.
            finding.severity(Severity::Warning).note(format!(
                "{} according to {}, unless configured: if it is, say `{key}` in `[chart]`",
                limit, most.source
            ));
        }
    }
}

//! G019: more of a chart than the controller holds.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::chart::{Chart, Connector};
use crate::analysis::reach::{Node, Part, Study};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::chart::{ConnectorKind, StepKind};
use crate::target::{ChartCapacity, Limit};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(capacity) = cx.target.chart_capacity() else { return };
    drawn(cx.program.charts(), &capacity, sink);
    configured(cx, &capacity, sink);
    at_once(cx, &capacity, sink);
}

/// What the drawing has.
fn drawn(charts: &[Chart<'_>], capacity: &ChartCapacity, sink: &mut Sink<'_, Site>) {
    let steps = charts.iter().flat_map(|chart| {
        (0..).zip(&chart.steps).filter(|(at, it)| {
            let is_counted = !matches!(it.it.kind, StepKind::In | StepKind::Out | StepKind::Macro);
            is_counted && it.it.name.as_ref().is_none_or(|name| chart.step_named(name) == Some(*at))
        })
    });
    let steps: Vec<_> = steps.map(|it| it.1).collect();
    report(sink, "steps", capacity.steps, steps.iter().map(|it| it.site()).collect());
    if let Some(limit) = capacity.initial_steps {
        let initial = steps.iter().filter(|it| it.it.kind == StepKind::Initial);
        report(sink, "initial steps", limit, initial.map(|it| it.site()).collect());
    }
    let transitions = || charts.iter().flat_map(|it| &it.transitions);
    report(sink, "transitions", capacity.transitions, transitions().map(|it| it.site()).collect());
    if let Some(limit) = capacity.and_convergences {
        let convergences = transitions().filter(|it| it.it.sources.len() > 1);
        report(sink, "AND convergences", limit, convergences.map(|it| it.site()).collect());
    }
    if let Some((origins, destinations)) = capacity.connectors {
        let of = |kind| {
            let all = charts.iter().flat_map(|it| &it.connectors).filter(move |it| it.it.kind == kind);
            all.map(Connector::site).collect()
        };
        report(sink, "origin connectors", origins, of(ConnectorKind::Origin));
        report(sink, "destination connectors", destinations, of(ConnectorKind::Destination));
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

fn report(sink: &mut Sink<'_, Site>, what: &str, limit: Limit, all: Vec<Site>) {
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
    let counts: [fn(&Study<'_, '_>, &Part, u32) -> u32; 2] = [active_steps, valid_transitions];
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
        let count = Count::new(cx, of);
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

/// The most of something that the charts of a program have at one time.
struct Count {
    sum: u32,
    /// Steps that are active then, in the chart that has most.
    steps: Vec<Site>,
    trace: String,
    /// Charts that have some.
    parts: u32,
}

impl Count {
    fn new(cx: &ProgramCx<'_>, of: fn(&Study<'_, '_>, &Part, u32) -> u32) -> Self {
        let mut count = Self { sum: 0, steps: Vec::new(), trace: String::new(), parts: 0 };
        let mut largest = 0;
        for study in cx.studies() {
            for part in &study.parts {
                let situations = (0..).take(part.all.situations.len());
                // Of situations with as many, the first has the shortest way.
                let most = situations.map(|it| (of(study, part, it), std::cmp::Reverse(it))).max();
                let Some((number, std::cmp::Reverse(situation))) = most.filter(|it| it.0 > 0) else { continue };
                count.sum = count.sum.saturating_add(number);
                count.parts += 1;
                if number > largest {
                    largest = number;
                    let active = study.net.active(&part.component, &part.all.situations[situation as usize]);
                    count.steps = active.map(|it| study.net.step(it).site()).collect();
                    let trace = study.net.trace(&part.component, &part.all, situation);
                    count.trace = format!("{number} of them are reached by {trace}");
                }
            }
        }
        count
    }
}

/// Macro-steps stand for their expansions.
fn active_steps(study: &Study<'_, '_>, part: &Part, situation: u32) -> u32 {
    let active = study.net.active(&part.component, &part.all.situations[situation as usize]);
    let steps = active.filter(|it| study.net.step(*it).it.kind != StepKind::Macro);
    u32::try_from(steps.count()).unwrap_or(u32::MAX)
}

fn valid_transitions(study: &Study<'_, '_>, part: &Part, situation: u32) -> u32 {
    let active: FxHashSet<Node> = study.net.active(&part.component, &part.all.situations[situation as usize]).collect();
    let crossings = part.component.crossings.iter().filter_map(|&it| study.net.crossings.get(it));
    let valid = crossings.filter(|it| it.from.iter().all(|it| active.contains(it)));
    u32::try_from(valid.count()).unwrap_or(u32::MAX)
}

//! G014: macro-steps where there are none, and expansions that are not what they must be.

use crate::analysis::Site;
use crate::analysis::chart::Chart;
use crate::analysis::nesting::{by_section, macros};
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::{Graph, StepName};
use crate::target::Counted;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let charts = cx.program.charts();
    if is_unavailable(cx, charts, sink) {
        return;
    }
    for nesting in by_section(charts) {
        for (number, place, before) in nesting.repeated {
            sink.report(place, format!("macro-step `M{number}` is used a second time"))
                .related(before, "first used here");
        }
        for cycle in nesting.cycles {
            let Some((&(number, place), others)) = cycle.split_first() else { continue };
            sink.report(place, format!("the expansion of macro-step `M{number}` contains the macro-step itself"))
                .related_all(others.iter().map(|(it, place)| (*place, format!("by way of macro-step `M{it}`"))));
        }
    }
    for chart in charts {
        ends(chart, sink);
    }
    for (unit, facts) in (0..).zip(&cx.program.units) {
        let Some(chart) = facts.chart.as_ref() else { continue };
        let Graph::Macro(number) = chart.graph else { continue };
        let is_out = |it: &u32| chart.steps.get(*it as usize).is_some_and(|it| it.name == Some(StepName::Out));
        for action in chart.actions.iter().filter(|it| it.steps.iter().any(is_out) && !it.anchors.is_empty()) {
            let message = format!("step `OUT` of macro-step `M{number}` has an action, and it can have none");
            sink.report(Site { unit, anchor: action.anchors.start }, message);
        }
    }
}

/// Reports the macro-steps of a controller that has none.
fn is_unavailable(cx: &ProgramCx<'_>, charts: &[Chart<'_>], sink: &mut Sink<'_, Site>) -> bool {
    let Some(count) = cx.target.count(Counted::MacroSteps).filter(|it| it.value == 0) else { return false };
    let in_charts = charts.iter().flat_map(macros).map(|it| it.1.site());
    let expansions = charts.iter().filter(|it| it.graph != Graph::Main).filter_map(heading);
    let places: Vec<Site> = in_charts.chain(expansions).collect();
    if let Some((first, others)) = places.split_first() {
        let message = match cx.target.controller() {
            Some(name) => format!("a {name} has no macro-steps"),
            None => "the application has no macro-steps".to_owned(),
        };
        sink.report(*first, message)
            .related_all(others.iter().map(|it| (*it, "also here".to_owned())))
            .note(format!("the number of macro-steps is given in {}", count.source));
    }
    true
}

fn heading(chart: &Chart<'_>) -> Option<Site> {
    chart.steps.first().map(|it| ProgramIndex::heading(it.unit))
}

/// The first and last step of an expansion. Where a connector leads to a page that is not there, so may they.
fn ends(chart: &Chart<'_>, sink: &mut Sink<'_, Site>) {
    let Graph::Macro(number) = chart.graph else { return };
    if chart.has_gaps || chart.unpaired().next().is_some() {
        return;
    }
    let lacks = |it: &StepName| chart.step_named(it).is_none();
    let missing = match (lacks(&StepName::In), lacks(&StepName::Out)) {
        (false, false) => return,
        (true, false) => "no step `IN`",
        (false, true) => "no step `OUT`",
        (true, true) => "neither step `IN` nor step `OUT`",
    };
    let Some(place) = heading(chart) else { return };
    sink.report(place, format!("the expansion of macro-step `M{number}` has {missing}"))
        .note("this assumes that all pages of the expansion are there");
}

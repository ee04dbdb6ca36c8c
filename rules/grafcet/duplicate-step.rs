//! G003: a step number that is used twice, or that the controller does not have.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::chart::{Chart, Step};
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::{Graph, StepName};
use crate::target::Counted;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for chart in cx.program.charts() {
        let mut first: FxHashMap<&StepName, &Step<'_>> = FxHashMap::default();
        for step in &chart.steps {
            let Some(name) = &step.it.name else { continue };
            match first.get(name) {
                // A macro-step that is used twice is G014's affair.
                Some(_) if matches!(name, StepName::Macro(_)) => {}
                Some(before) => {
                    sink.report(step.site(), format!("step `{}` is defined a second time", step.it.text))
                        .related(before.site(), "first defined here");
                }
                None => {
                    first.insert(name, step);
                    out_of_range(cx, chart, step, name, sink);
                }
            }
        }
    }
}

fn out_of_range(cx: &ProgramCx<'_>, chart: &Chart<'_>, step: &Step<'_>, name: &StepName, sink: &mut Sink<'_, Site>) {
    let (number, last, source) = match (chart.graph, name) {
        (_, StepName::Macro(number)) => {
            let Some(count) = cx.target.count(Counted::MacroSteps) else { return };
            (*number, count.value, count.source)
        }
        (Graph::Main, StepName::Number(number)) => {
            let Some(count) = cx.target.count(Counted::Steps) else { return };
            (*number, count.value, count.source)
        }
        (Graph::Macro(_), StepName::Number(number)) => {
            let Some(limits) = cx.target.chart() else { return };
            (*number, limits.macro_step_steps.value, limits.macro_step_steps.source)
        }
        (_, StepName::In | StepName::Out | StepName::Symbol(_)) => return,
    };
    // Where there are none at all, the chart is for another controller: G014's affair.
    let Some(last) = last.checked_sub(1).filter(|&it| number > it) else { return };
    sink.report(step.site(), format!("step `{}` is out of range: steps are numbered 0 to {last}", step.it.text))
        .note(format!("the number of steps is given in {source}"));
}

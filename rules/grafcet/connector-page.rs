//! G006: a connector of a divergence or convergence that is not on the page where it must be.

use crate::analysis::Site;
use crate::analysis::chart::Chart;
use crate::analysis::connectors::{Flaw, misplaced};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // What was not understood may be what is missing.
    for chart in cx.program.charts().iter().filter(|it| !it.has_gaps) {
        for it in misplaced(cx.program, chart) {
            let (Some(connector), Some(from)) = (chart.connectors.get(it.connector), step(chart, it.step)) else {
                continue;
            };
            let step_here = |it: &(Site, String)| (it.0, format!("step {}", it.1));
            let transition = |at: usize, what: &str| {
                chart.transitions.get(at).map(|it| (it.site(), format!("the transition {what} stands here")))
            };
            let (name, mut related) = (&from.1, vec![step_here(&from)]);
            let message = match it.flaw {
                Flaw::Branch { other } => {
                    related.extend(transition(other, "of another branch"));
                    format!("a branch of the divergence behind step {name} starts on another page than the others")
                }
                Flaw::Before => {
                    format!("a transition has an origin connector before it, in place of step {name}")
                }
                Flaw::Convergence => {
                    format!("step {name} takes part in this AND convergence from another page")
                }
                Flaw::Divergence => {
                    format!("step {name} before this AND divergence stands on another page")
                }
                Flaw::Origin { target } => {
                    let Some(to) = step(chart, target) else { continue };
                    related.push(step_here(&to));
                    format!("the connector from step {name} is not on the page of step {}, where it goes on", to.1)
                }
                Flaw::Destination { transition: at } => {
                    related.extend(transition(at, "behind that step"));
                    let text = &connector.it.text;
                    format!("the connector to step `{text}` is not on the page of the transition behind step {name}")
                }
                Flaw::Missing { target } => {
                    let Some(to) = step(chart, target) else { continue };
                    related.push(step_here(&to));
                    format!("step {name} comes to this connector, and step {} has no origin connector from it", to.1)
                }
            };
            sink.report(connector.site(), message)
                .related_all(related)
                .note("this assumes that all pages of the chart are there");
        }
    }
}

/// A step with its name.
fn step(chart: &Chart<'_>, at: u32) -> Option<(Site, String)> {
    let it = chart.steps.get(at as usize)?;
    Some((it.site(), format!("`{}`", it.it.text)))
}

//! G005: a connector without the other one of its pair.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::ConnectorKind;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for chart in cx.program.charts() {
        // What was not understood may be the other one.
        if chart.has_gaps {
            continue;
        }
        for connector in chart.unpaired() {
            let Some(name) = connector.name() else { continue };
            let text = &connector.it.text;
            let message = match (connector.it.kind, chart.step_named(name)) {
                (ConnectorKind::Destination, None) => {
                    format!("the connector goes to step `{text}`, which the chart does not have")
                }
                (ConnectorKind::Origin, None) => {
                    format!("the connector comes from step `{text}`, which the chart does not have")
                }
                (ConnectorKind::Destination, Some(_)) => {
                    format!("the connector to step `{text}` has no origin connector at that step")
                }
                (ConnectorKind::Origin, Some(_)) => {
                    format!("the connector from step `{text}` has no destination connector behind that step")
                }
            };
            let step = chart.step_named(name).and_then(|it| chart.steps.get(it as usize));
            sink.report(connector.site(), message)
                .related_all(step.map(|it| (it.site(), format!("step `{text}`"))))
                .note("this assumes that all pages of the chart are there");
        }
    }
}

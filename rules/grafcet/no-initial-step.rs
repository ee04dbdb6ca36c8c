//! G007: a chart that nothing starts.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::Graph;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for study in cx.studies().iter().filter(|it| !it.net.has_gaps && it.net.knows_presets()) {
        let net = &study.net;
        for part in study.parts.iter().filter(|it| !it.component.crossings.is_empty() && it.all.situations.is_empty()) {
            let is_main = |&node: &u32| net.charts[net.nodes[node as usize].0].graph == Graph::Main;
            let Some(&first) = part.component.nodes.iter().find(|it| is_main(it)) else { continue };
            let others = part.component.nodes.iter().filter(|it| **it != first);
            sink.report(net.step(first).site(), "no step of this chart is initial, and the program sets none")
                .related_all(others.map(|&it| (net.step(it).site(), "belongs to it".to_owned())));
        }
    }
}

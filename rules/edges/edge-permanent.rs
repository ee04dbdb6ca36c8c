//! E007: the edge of a bit that is not written in every scan, so that the edge stays.

use crate::analysis::{Site, edges};
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        if !uses.has_mode(Mode::is_edge) {
            continue;
        }
        let Some((edge, write)) = edges::permanent(cx.program, uses, cx.neighbours(at)) else { continue };
        let name = &uses.object.text;
        let mut finding = sink
            .report(edge.site(), format!("the edge of `{name}` stays while the bit is not written"))
            .related(write.site(), "not written in every scan");
        if let Some((site, why)) = cx.program.passed_by(write.unit).filter(|_| cx.program.is_passed_by(write.unit)) {
            finding = finding.related(site, why);
        }
        finding.note("an edge is there until its bit is written again (PL7:1468)");
    }
}

//! E008: edge tests that a jump or a conditional call can skip.

use crate::analysis::program::GlobalUse;
use crate::analysis::{Site, edges};
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let mut found: Vec<(&str, GlobalUse<'_>)> = Vec::new();
    for (at, uses) in (0..).zip(&program.objects) {
        let name = uses.object.text.as_str();
        for it in uses.with_mode(|it| it == Mode::EdgeMemory) {
            if it.it.skipped_by().is_some() || program.is_passed_by(it.unit) {
                found.push((name, *it));
            }
        }
        if uses.has_mode(Mode::is_edge) {
            found.extend(edges::skipped(program, uses, cx.neighbours(at)).into_iter().map(|it| (name, it)));
        }
    }
    // What one jump or one call skips has one cause.
    let cause = |it: &GlobalUse<'_>| (program.order[it.unit as usize], it.it.skipped_by());
    found.sort_by_key(|(_, it)| (cause(it), it.it.anchor));
    for group in found.chunk_by(|a, b| cause(&a.1) == cause(&b.1)) {
        let (name, first) = group[0];
        let what = match first.mode {
            Mode::EdgeMemory => format!("the edge that `{name}` remembers"),
            _ => format!("the edge of `{name}`"),
        };
        let others = group[1..].iter().map(|(name, it)| (it.site(), format!("that of `{name}`, too")));
        let mut finding = sink.report(first.site(), format!("{what} is not tested in every scan"));
        if let Some(jump) = first.it.skipped_by() {
            finding = finding.related(Site { unit: first.unit, anchor: jump }, "this jump can skip it");
        } else if let Some((site, why)) = program.passed_by(first.unit) {
            finding = finding.related(site, why);
        }
        finding.related_all(others);
    }
}

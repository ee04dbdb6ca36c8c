//! G012: a step bit that is written outside the preliminary processing.

use crate::analysis::Site;
use crate::analysis::processing::Preliminary;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let preliminary = Preliminary::new(cx.program);
    // What is given to a call need not be written, and tables and indexes are G027's affair.
    let is_write = |it: Mode| it.writes() && it != Mode::InOut;
    for uses in &cx.program.objects {
        let is_step = matches!(uses.object.class, Class::Step | Class::MacroStep);
        if !is_step || !uses.object.is_fixed() || uses.object.ty.is_table() {
            continue;
        }
        for it in uses.with_mode(is_write) {
            let Some(outside) = preliminary.outside(it.unit) else { continue };
            let (text, verb) = (cx.program.text_of(it), it.mode.verb());
            sink.report(it.site(), format!("`{text}` is {verb} outside the preliminary processing of the chart"))
                .related_all(
                    outside.call.map(|call| {
                        (call, format!("`{}` calls the subroutine here", cx.program.entity(outside.entry)))
                    }),
                );
        }
    }
}

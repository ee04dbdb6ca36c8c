//! G027: step bits written through an index or as a table.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // A call that is given an object need not write it.
    let is_write = |mode: Mode| mode.writes() && mode != Mode::InOut;
    for uses in &cx.program.objects {
        let object = uses.object;
        if !matches!(object.class, Class::Step | Class::MacroStep) {
            continue;
        }
        let (what, source) = if object.indexed {
            ("through an index", "PL7:1106-1107")
        } else if object.ty.is_table() {
            ("as a table", "PL7:1015")
        } else {
            continue;
        };
        for it in uses.with_mode(is_write).filter(|it| it.it.parameter().is_none()) {
            let text = cx.program.text_of(it);
            sink.report(it.site(), format!("`{text}` writes step bits {what}, which may only be read so"))
                .note(format!("not writable according to {source}"));
        }
    }
}

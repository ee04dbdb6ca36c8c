//! E006: the edge of a bit that keeps no history.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in &cx.program.objects {
        let Some(what) = without_history(uses.object) else { continue };
        for it in uses.with_mode(Mode::is_edge) {
            let text = cx.program.text_of(it);
            sink.report(it.site(), format!("`{text}` has no edge: {what} keeps no former state"));
        }
    }
}

/// What the object is, when the controller does not keep its former state.
fn without_history(object: &Object) -> Option<&'static str> {
    if object.extracted {
        return Some("a bit of a word");
    }
    Some(match object.class {
        Class::System => "a system bit",
        Class::Step | Class::MacroStep => "a step bit",
        Class::BlockBit => "an output of a function block",
        Class::Fault => "a fault bit",
        _ => return None,
    })
}

//! E006: the edge of a bit that keeps no history.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Class, Object};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for access in cx.model.accesses.iter().filter(|it| it.mode.is_edge()) {
        let object = cx.model.object(access.object);
        if let Some(what) = without_history(cx, object) {
            let place = cx.model.place(access.anchor);
            sink.report(place, format!("`{}` has no edge: {what} keeps no former state", object.text));
        }
    }
}

/// What the object is, when the controller does not keep its former state.
fn without_history(cx: &UnitCx<'_>, object: &Object) -> Option<&'static str> {
    if object.extracted {
        return Some("a bit of a word");
    }
    Some(match object.class {
        Class::System => "a system bit",
        Class::Step | Class::MacroStep => "a step bit",
        Class::BlockBit => "an output of a function block",
        Class::Fault => "a fault bit",
        Class::LocalName if is_plain_bool(cx, object) => "a variable of type BOOL",
        _ => return None,
    })
}

/// Whether a variable of the unit is declared as BOOL, and not as EBOOL.
fn is_plain_bool(cx: &UnitCx<'_>, object: &Object) -> bool {
    let declared = cx.model.declarations.iter().find(|it| it.name.eq_ignore_ascii_case(&object.text));
    declared.is_some_and(|it| it.ty.eq_ignore_ascii_case("BOOL"))
}

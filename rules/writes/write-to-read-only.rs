//! W004: a write to an object that a program cannot write.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Class, Object, Rights};
use crate::model::unit::{Access, Mode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for access in &cx.model.accesses {
        let object = cx.model.object(access.object);
        let Some((what, source)) = forbidden(object, access) else { continue };
        let place = cx.model.place(access.anchor);
        sink.report(place, format!("`{}` is {what}, which a program cannot write", object.text))
            .note(format!("not writable according to {source}"));
    }
}

/// What the object is and who says that it is not writable; `None` when the access writes nothing or may write.
fn forbidden(object: &Object, access: &Access) -> Option<(&'static str, &'static str)> {
    // A call that is given an object need not write it, and a pin of a block is made to be driven.
    if !access.mode.writes() || access.mode == Mode::InOut {
        return None;
    }
    match (object.rights, object.class) {
        // Who may write a step is said by the rules about charts.
        (_, Class::Step | Class::MacroStep) => None,
        (Rights::ReadOnly(source), class) => Some((describe(class), source)),
        (_, Class::PeripheralInput) => Some(("a peripheral input", "the vendor's general documentation")),
        (_, Class::Timer | Class::Counter) => Some((
            "a timer or counter",
            "S7:475-628: only its own instructions drive it",
        )),
        _ => None,
    }
}

fn describe(class: Class) -> &'static str {
    match class {
        Class::Input => "an input",
        Class::Constant => "a constant",
        Class::System => "a value that the system manages",
        Class::StepTime => "a step time",
        Class::Fault => "a fault bit",
        Class::BlockBit => "an output of a function block",
        Class::BlockWord => "a current value of a function block",
        _ => "an object",
    }
}

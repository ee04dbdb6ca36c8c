//! W004: a write to an object that a program cannot write.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object, Rights};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // A call that is given an object need not write it, and a pin of a block is made to be driven.
    let is_write = |mode: Mode| mode.writes() && mode != Mode::InOut;
    for uses in &cx.program.objects {
        let Some((what, source)) = forbidden(uses.object) else { continue };
        for it in uses.with_mode(is_write).filter(|it| it.it.parameter().is_none()) {
            sink.report(it.site(), format!("`{}` is {what}, which a program cannot write", cx.program.text_of(it)))
                .note(format!("not writable according to {source}"));
        }
    }
}

/// What the object is and who says that it is not writable.
fn forbidden(object: &Object) -> Option<(&'static str, &'static str)> {
    match (object.rights, object.class) {
        // Who may write a step is said by the rules about charts.
        (_, Class::Step | Class::MacroStep) => None,
        (Rights::ReadOnly(source), class) => Some((describe(class), source)),
        (_, Class::PeripheralInput) => Some(("a peripheral input", "the vendor's general documentation")),
        (_, Class::Timer | Class::Counter) => {
            Some(("a timer or counter", "S7:475-628: only its own instructions drive it"))
        }
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

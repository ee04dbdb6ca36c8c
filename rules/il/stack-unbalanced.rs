//! I008: a pushed value that nothing takes off the stack.

use rowan::TextRange;

use crate::lint::{Severity, Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        match oddity.kind {
            OddityKind::StackLeft(count) => {
                let message = if count == 1 {
                    "the value pushed here is left on the stack at the end of the sentence".to_owned()
                } else {
                    format!("{count} pushed values are left on the stack at the end of the sentence")
                };
                sink.report(oddity.range, message).label("no `MPP` takes it off");
            }
            OddityKind::StackMismatch => {
                sink.report(oddity.range, format!("`{}` leaves a pushed value on the stack", oddity.text))
                    .severity(Severity::Warning)
                    .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())))
                    .note("the manual does not say what becomes of the stack when a jump is taken");
            }
            _ => {}
        }
    }
}

//! V001: a constant that is malformed or out of its range.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        // Durations of STEP 7 timers have a rule of their own.
        if let OddityKind::Literal(error) = &oddity.kind
            && !error.is_s5time
        {
            sink.report(oddity.range, error.message.clone());
        }
    }
}

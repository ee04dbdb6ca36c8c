//! V001: a constant that is malformed or out of its range.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        // Durations of STEP 7 timers and floating-point numbers of PL7 have rules of their own.
        if let OddityKind::Literal(error) = &oddity.kind
            && !error.is_s5time
            && (!error.is_real_range || cx.model.language.is_statement_list())
        {
            sink.report(oddity.range, error.message.clone());
        }
    }
}

//! T020: a floating-point number that its format cannot hold.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if cx.model.language.is_statement_list() {
        return;
    }
    for oddity in &cx.model.oddities {
        if let OddityKind::Literal(error) = &oddity.kind
            && error.is_real_range
        {
            sink.report(oddity.range, error.message.clone());
        }
    }
}

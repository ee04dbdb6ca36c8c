//! R006: an operation on data of another width or kind of number.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        if let OddityKind::OperandWidth(flaw) = &oddity.kind {
            sink.report(oddity.range, format!("`{}` {flaw}", oddity.text));
        }
    }
}

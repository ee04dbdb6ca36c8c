//! I014: an operand of a type that its instruction does not take.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        if let OddityKind::OperandType(message) = &oddity.kind {
            sink.report(oddity.range, message.clone());
        }
    }
}

//! O002: an address with a number that no controller has.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::AddressErrorKind;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        if let OddityKind::Address(error) = &oddity.kind
            && error.kind == AddressErrorKind::OutOfRange
        {
            sink.report(oddity.range, format!("`{}` is out of range: {}", oddity.text, error.message));
        }
    }
}

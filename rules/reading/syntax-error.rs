//! X001: text that the grammar does not have.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for error in cx.parse.errors() {
        sink.report(error.range, error.message.clone());
    }
}

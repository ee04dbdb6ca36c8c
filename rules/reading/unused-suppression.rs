//! X003: a suppression that suppresses nothing.

use rowan::TextRange;

use crate::lint::{FileCx, Sink};

pub(crate) fn check(cx: &FileCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for leftover in cx.leftovers {
        sink.report(leftover.range, leftover.message.clone());
    }
}

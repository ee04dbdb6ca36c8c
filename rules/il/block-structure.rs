//! I013: the structured form of a function block.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        if let OddityKind::BlockStructure(message) = &oddity.kind {
            let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
            sink.report(oddity.range, message.clone()).related_all(related);
        }
    }
}

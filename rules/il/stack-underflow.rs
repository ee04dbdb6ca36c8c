//! I007: the stack is read while nothing is on it.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::StackUnderflow) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, format!("`{}` reads a stack on which this sentence has pushed nothing", oddity.text))
            .related_all(related);
    }
}

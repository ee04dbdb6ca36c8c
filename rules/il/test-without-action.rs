//! I011: tests whose result no action uses.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::TestWithoutAction) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, "no action uses the result of these tests").related_all(related);
    }
}

//! L004: a test that a wire goes round.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::Ladder(Flaw::Bypassed)) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, "this test has no effect: a wire goes round it").related_all(related);
    }
}

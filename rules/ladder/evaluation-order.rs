//! L011: the value of the scan before.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::Ladder(Flaw::ReadBeforeDriven)) {
        let message = format!("`{}` is read here before the same rung drives it", oddity.text);
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, message).related_all(related);
    }
}

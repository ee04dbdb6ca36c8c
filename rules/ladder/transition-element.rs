//! L007: what acts in a transition.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::Ladder(Flaw::ElementInTransition)) {
        sink.report(oddity.range, "a transition holds contacts, comparison blocks and the hash coil only");
    }
}

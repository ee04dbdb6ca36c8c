//! L006: the hash coil and transitions belong together.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let message = match oddity.kind {
            OddityKind::Ladder(Flaw::HashOutsideTransition) => "a hash coil belongs to the rung of a transition",
            OddityKind::Ladder(Flaw::CoilInTransition) => "of coils, a transition holds the hash coil only",
            _ => continue,
        };
        sink.report(oddity.range, message);
    }
}

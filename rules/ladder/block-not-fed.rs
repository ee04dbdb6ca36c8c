//! L005: a block without a wire on its left.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::Ladder(Flaw::BlockNotFed)) {
        sink.report(oddity.range, "this block is not wired to the left rail");
    }
}

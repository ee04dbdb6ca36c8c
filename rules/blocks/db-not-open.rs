//! B004: data block access while the block has opened none.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::DataBlockNotOpen) {
        sink.report(oddity.range, format!("`{}` is accessed before this block has opened a data block", oddity.text))
            .note("it lies in whatever data block is open where the block is called");
    }
}

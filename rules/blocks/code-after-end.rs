//! B006: code after the end of a block.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::DeadCause;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for stretch in cx.model.unreachable.iter().filter(|it| it.cause == DeadCause::End) {
        let end = cx.text_of(stretch.cut_by);
        sink.report(stretch.first, format!("this code stands after `{end}`, and no jump leads to it"))
            .related(stretch.cut_by, "the block ends here");
    }
}

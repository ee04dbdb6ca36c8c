//! I006: more values pushed than the stack holds.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(limit) = cx.target.stack_depth() else { return };
    for oddity in &cx.model.oddities {
        if oddity.kind == OddityKind::StackDepth(limit.value + 1) {
            sink.report(
                oddity.range,
                format!("`{}` pushes more than the {} values that the stack holds", oddity.text, limit.value),
            )
            .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())));
        }
    }
}

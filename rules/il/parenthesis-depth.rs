//! I005: parentheses nested too deeply.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let limit = cx.target.parenthesis_depth();
    for oddity in &cx.model.oddities {
        if oddity.kind == OddityKind::ParenthesisDepth(limit.value + 1) {
            sink.report(oddity.range, format!("parentheses are nested more than {} deep", limit.value))
                .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())))
                .note(format!("the limit is that of {}", limit.source));
        }
    }
}

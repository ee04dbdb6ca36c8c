//! R005: a two-operand instruction with fewer than two loaded values.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let OddityKind::MissingOperand(loaded) = oddity.kind else { continue };
        let loaded = if loaded == 0 { "none" } else { "only one" };
        sink.report(
            oddity.range,
            format!("`{}` works on both accumulators, and the block has loaded {loaded}", oddity.text),
        )
        .note("the other operand is what the caller left in the accumulator");
    }
}

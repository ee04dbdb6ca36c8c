//! R001: an instruction acts on an RLO that nothing in the block computed.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::BlockKind;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let (whose, note) = match oddity.kind {
            OddityKind::RloFromCaller if cx.model.entity.block_kind() == Some(BlockKind::Ob) => (
                "an RLO that nothing computed",
                "the system calls an organization block, so that no caller's RLO is there",
            ),
            OddityKind::RloFromCaller => ("the caller's RLO", "nothing in this block has computed an RLO before it"),
            OddityKind::RloAfterCall => {
                ("the RLO that the called block left", "nothing has computed an RLO since the call")
            }
            _ => continue,
        };
        sink.report(oddity.range, format!("`{}` acts on {whose}", oddity.text)).note(note);
    }
}

//! L003: a line that is open at one of its ends.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let message = match oddity.kind {
            OddityKind::Ladder(Flaw::NotFed) => "nothing stands on the left of this: it never has power",
            OddityKind::Ladder(Flaw::FacesNoPin) => "no pin of a DFB is beside this cell",
            OddityKind::Ladder(Flaw::LeadsNowhere) => "nothing stands on the right of this: it leads nowhere",
            OddityKind::Ladder(Flaw::OpenLink) => "the vertical link of this cell ends at nothing",
            _ => continue,
        };
        sink.report(oddity.range, message);
    }
}

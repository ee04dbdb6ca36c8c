//! L002: tests and actions in each other's zone.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let message = match oddity.kind {
            OddityKind::Ladder(Flaw::TestInActionZone(_)) => {
                "this test stands in column 11, where actions stand".into()
            }
            OddityKind::Ladder(Flaw::ActionInTestZone(end)) => {
                format!("this action ends in column {end}, and actions stand in column 11")
            }
            _ => continue,
        };
        sink.report(oddity.range, message);
    }
}

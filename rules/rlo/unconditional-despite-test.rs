//! R003: an instruction that looks conditioned by the test before it, and is not.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::UnconditionalAfterTest) {
        sink.report(oddity.range, format!("`{}` runs whatever the test before it gives", oddity.text))
            .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())))
            .note("nothing else uses the result of that test either");
    }
}

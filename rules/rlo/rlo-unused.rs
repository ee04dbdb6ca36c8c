//! R002: an RLO computed and lost.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::RloUnused) {
        let test = cx.text_of(oddity.range);
        let first = test.split([';', '\n']).next().unwrap_or_default();
        let first: Vec<&str> = first.split_whitespace().collect();
        sink.report(
            oddity.range,
            format!("nothing uses the result of the test that starts with `{}`", first.join(" ")),
        )
        .label("this result is lost")
        .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())));
    }
}

//! R004: a value loaded and lost.

use rowan::{TextRange, TextSize};

use crate::lint::{Applicability, Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::DeadLoad) {
        let finding = sink
            .report(oddity.range, format!("`{}` is loaded, and nothing uses the value", oddity.text))
            .related_all(oddity.related.iter().map(|&(place, part)| (place, part.to_owned())));
        // Two lost loads in a row: the second was meant to store the first.
        let before = oddity.related.iter().find(|it| it.0.end() <= oddity.range.start());
        let is_place = cx.model.objects.iter().any(|it| it.text == oddity.text);
        if before.is_some() && is_place && cx.text_of(oddity.range).starts_with(['L', 'l']) {
            let mnemonic = TextRange::at(oddity.range.start(), TextSize::new(1));
            finding.replace(
                format!("Write `T` to store the value in `{}`", oddity.text),
                Applicability::Unsafe,
                mnemonic,
                "T",
            );
        }
    }
}

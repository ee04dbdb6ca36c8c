//! I010: a sentence that starts without a result.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::SentenceStart) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, message(&oddity.text)).related_all(related);
    }
}

fn message(text: &str) -> String {
    let what = if text == "[" { "an operation in brackets".to_owned() } else { format!("`{text}`") };
    format!("{what} uses the result of an instruction before it, and the sentence has none")
}

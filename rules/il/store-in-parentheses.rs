//! I003: an action inside parentheses.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::StoreInParentheses) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, message(&oddity.text)).related_all(related);
    }
}

fn message(text: &str) -> String {
    if text == "[" {
        "an operation in brackets stands inside parentheses".to_owned()
    } else {
        format!("`{text}` stands inside parentheses")
    }
}

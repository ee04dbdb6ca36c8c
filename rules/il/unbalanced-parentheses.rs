//! I004: parentheses that do not match.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let message = match oddity.kind {
            OddityKind::UnclosedParenthesis => "the parenthesis opened here is not closed",
            OddityKind::UnopenedParenthesis => "`)` closes a parenthesis that nothing opened",
            _ => continue,
        };
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, message).related_all(related);
    }
}

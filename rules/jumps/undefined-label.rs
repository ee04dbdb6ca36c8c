//! J002: a jump to a label that its entity does not define.

use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx, nearest};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut undefined = cx.model.jumps.iter().filter(|it| it.target.is_none()).peekable();
    // A listing with parts left out may have left out the label.
    if undefined.peek().is_none() || cx.leaves_out() {
        return;
    }
    for jump in undefined {
        let message = format!("jump to `{}`, which {} does not define", jump.text, cx.model.entity);
        let report = sink.report(jump.range, message);
        // A name can be mistyped; of a number, no other one is nearer than the rest.
        let names = cx.model.labels.iter().map(|it| it.text.as_str()).filter(|it| it.starts_with(char::is_alphabetic));
        if let Some(near) = nearest(&jump.text, names) {
            report.replace(format!("Jump to `{near}`"), Applicability::Unsafe, jump.range, near);
        }
    }
}

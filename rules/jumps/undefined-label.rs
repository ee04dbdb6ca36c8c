//! J002: a jump to a label that its entity does not define.

use rowan::TextRange;
use rustc_hash::FxHashSet;

use crate::lint::{Applicability, Sink, UnitCx, nearest};

/// Jumps and labels of a unit that are compared for a likely slip of the keyboard.
const MOST_COMPARED: usize = 200;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut undefined = cx.model.jumps.iter().filter(|it| it.target.is_none()).peekable();
    // A listing with parts left out may have left out the label.
    if undefined.peek().is_none() || cx.leaves_out() {
        return;
    }
    // A name can be mistyped; of a number, no other one is nearer than the rest.
    let mut seen = FxHashSet::default();
    let names: Vec<&str> = cx.model.labels.iter().map(|it| it.text.as_str()).filter(|it| is_word(it)).collect();
    let names: Vec<&str> = names.into_iter().filter(|it| seen.insert(*it)).take(MOST_COMPARED).collect();
    for (at, jump) in undefined.enumerate() {
        let message = format!("jump to `{}`, which {} does not define", jump.text, cx.model.entity);
        let report = sink.report(jump.range, message);
        let near = if at < MOST_COMPARED { nearest(&jump.text, names.iter().copied()) } else { None };
        if let Some(near) = near {
            report.replace(format!("Jump to `{near}`"), Applicability::Unsafe, jump.range, near);
        }
    }
}

fn is_word(label: &str) -> bool {
    label.starts_with(char::is_alphabetic)
}

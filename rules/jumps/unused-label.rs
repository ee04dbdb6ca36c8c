//! J005: a label that no jump goes to.

use rowan::TextRange;
use rustc_hash::FxHashSet;

use crate::lint::{Sink, UnitCx};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut used: FxHashSet<(u32, &str)> = cx.model.jumps.iter().map(|it| (it.part, it.label.as_str())).collect();
    // A second label of one name is J001's affair.
    let mut unused = cx.model.labels.iter().filter(|it| used.insert((it.part, &it.name))).peekable();
    // Where parts are left out, the jump may be among them.
    if unused.peek().is_none() || cx.leaves_out() {
        return;
    }
    for label in unused {
        sink.report(label.range, format!("no jump goes to label `{}`", label.text));
    }
}

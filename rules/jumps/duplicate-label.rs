//! J001: a label defined twice.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut first: FxHashMap<(u32, &str), TextRange> = FxHashMap::default();
    for label in &cx.model.labels {
        let key = (label.part, label.name.as_str());
        match first.get(&key) {
            None => {
                first.insert(key, label.range);
            }
            Some(&before) => {
                sink.report(label.range, format!("label `{}` is defined a second time", label.text))
                    .related(before, "first defined here");
            }
        }
    }
}

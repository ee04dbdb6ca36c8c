//! J003: a label that the language does not have, or more jumps to labels than it has.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if let Some(limit) = cx.target.jumps()
        && let (Some(beyond), Some(first)) = (cx.model.jumps.get(limit.value as usize), cx.model.jumps.first())
    {
        let count = cx.model.jumps.len();
        sink.report(cx.model.place(beyond.anchor), format!("there are {count} jumps, and {} are allowed", limit.value))
            .label("the first one beyond")
            .related(cx.model.place(first.anchor), "the first one of all")
            .note(format!("the number is given in {}", limit.source));
    }
    for label in &cx.model.labels {
        let text = &label.text;
        if let Some(range) = cx.target.label_numbers() {
            // A number too long for its type is out of any range.
            let number = label.name.parse::<u32>().unwrap_or(u32::MAX);
            if !range.contains(number) {
                let sign = if cx.model.language.is_pl7_2() { "" } else { "%" };
                let message =
                    format!("label `{text}` is out of range: {sign}L{} to {sign}L{}", range.first, range.last);
                sink.report(label.range, message).note(format!("the range is given in {}", range.source));
            }
        }
        if let Some(length) = cx.target.label_length().filter(|_| !cx.model.of_tia_portal) {
            if text.chars().count() > length.value as usize {
                let message = format!("label `{text}` has more than {} characters", length.value);
                sink.report(label.range, message).note(format!("the length is given in {}", length.source));
            } else if !text.starts_with(|it: char| it.is_alphabetic() || it == '_') {
                sink.report(label.range, format!("label `{text}` starts with neither a letter nor `_`"));
            }
        }
    }
}

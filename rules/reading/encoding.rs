//! X002: text whose characters were lost or read in the wrong encoding.

use rowan::{TextRange, TextSize};

use crate::lint::{FileCx, Sink};

pub(crate) fn check(cx: &FileCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let (mut lost, mut mixed) = (Found::default(), Found::default());
    // What is looked for begins with one of these bytes.
    for at in memchr::memchr3_iter(0xC2, 0xC3, 0xEF, cx.text.as_bytes()) {
        let mut characters = cx.text.get(at..).unwrap_or_default().chars();
        let Some(first) = characters.next() else { continue };
        if is_lost(first) {
            lost.add(at, first);
        } else if characters.next().is_some_and(|second| is_doubled(first, second)) {
            mixed.add(at, first);
        }
    }
    if let Some(range) = lost.first {
        sink.report(range, format!("{} without a meaning in the file's encoding", lost.count("character")));
    }
    if let Some(range) = mixed.first {
        sink.report(range, format!("{} stored as UTF-8 and read in another encoding", mixed.count("character")))
            .note("the file mixes encodings, or was converted twice");
    }
}

#[derive(Default)]
struct Found {
    first: Option<TextRange>,
    number: usize,
}

impl Found {
    fn add(&mut self, at: usize, character: char) {
        self.number += 1;
        let start = TextSize::new(u32::try_from(at).unwrap_or(u32::MAX));
        self.first.get_or_insert_with(|| TextRange::at(start, TextSize::of(character)));
    }

    fn count(&self, what: &str) -> String {
        format!("the text holds {} {what}{}", self.number, if self.number == 1 { "" } else { "s" })
    }
}

/// The mark of a byte without meaning, and controls that no program holds. U+0085 ends a line in some encodings.
fn is_lost(it: char) -> bool {
    it == '\u{fffd}' || matches!(it, '\u{80}'..='\u{9f}') && it != '\u{85}'
}

/// What accented letters (`Ã©`), no-break spaces and guillemets (`Â«`) look like when their UTF-8 is read as
/// Windows-1252, by their first two characters.
fn is_doubled(first: char, second: char) -> bool {
    match first {
        'Â' => matches!(second, '\u{a0}'..='¿'),
        'Ã' => matches!(second, '\u{a0}'..='¿') || "€‚ƒ„…†‡ˆ‰Š‹ŒŽ‘’“”•–—˜™š›œžŸ".contains(second),
        _ => false,
    }
}

//! O005: a word of PL7-2 that is reached directly, and is only by the transfer of tables.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::analysis::known::Known;
use crate::lint::{Sink, UnitCx};
use crate::model::object::{Area, Object};
use crate::model::unit::Access;
use crate::target::pl72::{DIRECT_WORDS, INDEXED_WORDS, Kind, PAGE_WORDS};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(model) = cx.target.pl72() else { return };
    let known = Known::new(cx.model);
    // The word that was last read at a place: what stands in the parentheses is read before what stands in front of them.
    let mut read: FxHashMap<TextRange, &Access> = FxHashMap::default();
    for access in &cx.model.accesses {
        let object = cx.model.object(access.object);
        let kind = match object.footprint.area {
            Area::Words => Kind::Word,
            Area::Constants => Kind::Constant,
            _ => continue,
        };
        // Of a controller that has no more words than these, O003 speaks.
        if model.count(kind).value <= PAGE_WORDS.value {
            continue;
        }
        let place = cx.model.place(access.anchor);
        let (first, end) = (object.footprint.start / 16, object.footprint.end().div_ceil(16));
        let text = &object.text;
        let is_far = end > DIRECT_WORDS.last + 1;
        if object.is_fixed() && access.mode.reads() {
            read.insert(place, access);
        }
        if object.indexed {
            indexed(cx, &known, read.get(&place).copied(), object, place, sink);
        } else if cx.text_of(place).contains('[') {
            // A transfer of a table: the source is anywhere, what it fills in this page ends with it.
            if access.mode.writes() && first < PAGE_WORDS.value && is_far {
                let message = format!(
                    "`{text}` leaves the page that is reached directly: words {first} to {}, and it ends with {}",
                    end - 1,
                    DIRECT_WORDS.last
                );
                sink.report(place, message).note("the pages of 128 words are those of PL72:1092-1103");
            }
        } else if is_far && end - first > 1 {
            let (from, to) = (first, end - 1);
            let message = format!(
                "this conversion takes the words {from} to {to}, and those above {} are reached by the transfer of tables alone",
                DIRECT_WORDS.last
            );
            sink.report(place, message).note(format!("according to {}", DIRECT_WORDS.source));
        } else if is_far {
            let message = format!(
                "`{text}` is not reached directly: words above {} are read and written by the transfer of tables alone",
                DIRECT_WORDS.last
            );
            sink.report(place, message).note(format!("according to {}", DIRECT_WORDS.source));
        }
    }
}

/// `W5(W10)`: the word is one that can be indexed, and the index, where it is known, stays in the page.
fn indexed(
    cx: &UnitCx<'_>,
    known: &Known<'_>,
    index: Option<&Access>,
    object: &Object,
    place: TextRange,
    sink: &mut Sink<'_, TextRange>,
) {
    let (text, base) = (&object.text, object.footprint.start / 16);
    if !INDEXED_WORDS.contains(base) {
        let message = format!("`{text}` cannot be indexed: words up to {} can", INDEXED_WORDS.last);
        sink.report(place, message).note(format!("according to {}", INDEXED_WORDS.source));
        return;
    }
    let value = index.and_then(|it| Some((it, known.read(it.object, it.version, it.path)?)));
    let Some((index, value)) = value else { return };
    let last = i64::from(INDEXED_WORDS.last - base);
    if !(0..=last).contains(&value.value) {
        let name = &cx.model.object(index.object).text;
        let message = format!("the index `{name}` is {} here, and that of `{text}` is 0 to {last}", value.value);
        let stored = value.stored.map(|it| (cx.model.place(it), format!("`{name}` is set here")));
        sink.report(place, message).related_all(stored).note("according to PL72:995");
    }
}

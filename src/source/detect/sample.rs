//! The part of a text by which it is recognised.

use std::sync::Arc;

use super::super::edit::difference;
use super::super::scan::{Comments, Lines};
use super::tally::{Kind, Tally};

/// How much of a text is looked at.
const SAMPLE: usize = 128 * 1024;

/// Lines that are counted together.
const LINES: usize = 64;

/// What the sample of a text looks like. `kind`: as far as its name tells.
pub(super) fn tally(text: &str, kind: Kind) -> Tally {
    let text = cut(text);
    let mut tally = Tally::of_start(text, kind);
    Lines::new(text, Comments::Step7).for_each(|it| tally.add_line(it.code));
    tally
}

fn cut(text: &str) -> &str {
    let mut end = text.len().min(SAMPLE);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.get(..end).unwrap_or_default()
}

/// The sample of a text that is edited: an edit makes count the lines around it alone.
///
/// **Invariant:** [`Self::take`] says of a text what [`tally`] says of it, whatever it was given before.
#[derive(Debug, Default)]
pub struct Sample {
    text: Arc<str>,
    kind: Kind,
    /// They tile the sample, in order.
    pieces: Vec<Piece>,
}

/// Some lines of a text.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: usize,
    end: usize,
    /// [`Tally::in_code_block`] before the first of them.
    in_code_block: bool,
    tally: Tally,
}

impl Piece {
    /// Without lines, behind others.
    fn behind(before: Option<&Self>, kind: Kind) -> Self {
        let (at, in_code_block) = before.map_or((0, false), |it| (it.end, it.tally.in_code_block));
        Self { start: at, end: at, in_code_block, tally: Tally::behind(in_code_block, kind) }
    }
}

impl Sample {
    pub(super) fn take(&mut self, text: &Arc<str>, kind: Kind) -> Tally {
        if std::mem::replace(&mut self.kind, kind) != kind {
            *self = Self { kind, ..Self::default() };
        }
        let old = std::mem::replace(&mut self.text, text.clone());
        let (sample, last) = (cut(text), cut(&old).len());
        let (start, end) = difference(&old, text);
        let known = std::mem::take(&mut self.pieces);
        // A line that ends where the text or its sample does may go on now: its piece is counted anew.
        let (before, behind) = known.split_at(known.partition_point(|it| it.end < start.min(last).min(sample.len())));
        self.pieces.extend(before);
        let moved = |it: &Piece| {
            let at = |offset: usize| (offset + text.len()).checked_sub(old.len());
            Some(Piece { start: at(it.start)?, end: at(it.end)?, ..*it })
        };
        let behind = behind.iter().filter(|it| it.start >= end && it.end < last).filter_map(moved);
        let mut behind = behind.filter(|it| it.end < sample.len()).peekable();
        let mut lines = Lines::new(sample, Comments::Step7);
        loop {
            let mut piece = Piece::behind(self.pieces.last(), kind);
            while behind.next_if(|it| it.start < piece.start).is_some() {}
            // Lines that begin where others did, and as the text before leaves off there, are counted already.
            while let Some(it) = behind.next_if(|it| (it.start, it.in_code_block) == (piece.start, piece.in_code_block))
            {
                piece = Piece::behind(Some(&it), kind);
                self.pieces.push(it);
            }
            let next = behind.peek().map_or(usize::MAX, |it| it.start);
            lines.skip_to(piece.start);
            for line in lines.by_ref().take(LINES) {
                piece.tally.add_line(line.code);
                piece.end = line.end;
                if line.end >= next {
                    break;
                }
            }
            if piece.end == piece.start {
                break;
            }
            self.pieces.push(piece);
        }
        let mut tally = Tally::of_start(sample, kind);
        self.pieces.iter().for_each(|it| tally.join(&it.tally));
        tally
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Lines of every kind, with comments and strings that reach over the breaks between them.
    fn line() -> impl Strategy<Value = String> {
        let lines = [
            "      U     E 1.0",
            "      =     A 4.0;",
            "FUNCTION_BLOCK FB 1",
            "DATA_BLOCK DB 2",
            "END_DATA_BLOCK",
            "a := 1;",
            "IF %M0 THEN",
            "(* a comment",
            "*)",
            "// b *)",
            "LD %M1",
            "\u{e9}t\u{e9}",
            "",
            "\"",
            "'",
            "TITLE = (* x",
        ];
        let breaks = ["\n", "\r\n", "\r", ""];
        (prop::sample::select(lines.to_vec()), prop::sample::select(breaks.to_vec()))
            .prop_map(|(a, b)| format!("{a}{b}"))
    }

    fn text() -> impl Strategy<Value = String> {
        prop::collection::vec(line(), 0..300).prop_map(|it| it.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn from_edit_to_edit(
            first in text(),
            edits in prop::collection::vec((any::<prop::sample::Index>(), 0..40usize, prop::collection::vec(line(), 0..4)), 1..8),
            pad in prop::sample::select(vec![0, SAMPLE - 2000, SAMPLE]),
            kind in prop::sample::select(vec![Kind::Other, Kind::Table]),
        ) {
            let mut text = " ".repeat(pad) + &first;
            let mut sample = Sample::default();
            for (at, length, lines) in edits {
                let take = |sample: &mut Sample, text: &str| sample.take(&text.into(), kind);
                prop_assert_eq!(take(&mut sample, &text), tally(&text, kind));
                let boundary = |it: usize| (0..=it.min(text.len())).rfind(|it| text.is_char_boundary(*it)).unwrap_or(0);
                let start = boundary(at.index(text.len() + 1));
                let end = boundary(start + length);
                text.replace_range(start..end, &lines.concat());
                prop_assert_eq!(take(&mut sample, &text), tally(&text, kind));
            }
        }
    }

    #[test]
    fn an_edit_counts_the_lines_around_it() {
        let text = "      U     E 1.0;\n".repeat(1000);
        let mut sample = Sample::default();
        sample.take(&text.as_str().into(), Kind::Other);
        let before: Vec<(usize, usize)> = sample.pieces.iter().map(|it| (it.start, it.end)).collect();
        let edited = format!("{}!{}", &text[..9000], &text[9000..]);
        sample.take(&edited.as_str().into(), Kind::Other);
        let after: Vec<(usize, usize)> = sample.pieces.iter().map(|it| (it.start, it.end)).collect();
        let is_kept = |it: &&(usize, usize)| before.contains(it) || before.contains(&(it.0 - 1, it.1 - 1));
        assert!(before.len() > 10 && after.len() <= before.len() + 1);
        assert!(after.iter().filter(is_kept).count() + 3 > after.len(), "{before:?} {after:?}");
    }
}

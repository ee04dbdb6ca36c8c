//! Texts as the client shows them.

use std::sync::Arc;

use lsp_types::{TextDocumentContentChangeEvent as Change, Uri};

use rustc_hash::FxHashMap;

use super::convert::Encoding;
use crate::source::line_index::LineIndex;

/// Open documents by path.
pub(super) type Documents = FxHashMap<String, Document>;

/// A document that is open in the client. Its text, not the file's, is what counts.
#[derive(Debug, Clone)]
pub(super) struct Document {
    /// As the client writes it.
    pub(super) uri: Uri,
    pub(super) version: i32,
    pub(super) text: Arc<str>,
}

impl Document {
    /// Applies changes one after the other: each speaks of the text that those before it made.
    pub(super) fn change(&mut self, changes: Vec<Change>, encoding: Encoding) {
        let mut text: Option<String> = None;
        for change in changes {
            match change {
                Change::TextDocumentContentChangeWholeDocument(it) => text = Some(it.text),
                Change::TextDocumentContentChangePartial(it) => {
                    let mut before = text.take().unwrap_or_else(|| self.text.to_string());
                    let lines = LineIndex::new(&before);
                    let range = encoding.text_range(&lines, &before, it.range);
                    before.replace_range(std::ops::Range::<usize>::from(range), &it.text);
                    text = Some(before);
                }
            }
        }
        if let Some(text) = text {
            self.text = text.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use lsp_types::{Position, Range, TextDocumentContentChangePartial};

    use super::*;

    fn partial(from: (u32, u32), to: (u32, u32), text: &str) -> Change {
        let range = Range::new(Position::new(from.0, from.1), Position::new(to.0, to.1));
        #[expect(deprecated, reason = "the field is there and has no default")]
        Change::from(TextDocumentContentChangePartial { range, range_length: None, text: text.to_owned() })
    }

    #[test]
    fn changes_follow_one_another() {
        let uri = Uri::parse("file:///a.awl").unwrap();
        let mut it = Document { uri, version: 1, text: "one\ntwo\n".into() };
        it.change(vec![partial((0, 3), (1, 0), ", "), partial((0, 0), (0, 3), "ONE")], Encoding::Utf16);
        assert_eq!(&*it.text, "ONE, two\n");
        it.change(vec![partial((9, 9), (9, 9), "end")], Encoding::Utf16);
        assert_eq!(&*it.text, "ONE, two\nend");
        it.change(vec![partial((0, 4), (0, 1), "!")], Encoding::Utf16);
        assert_eq!(&*it.text, "ONE,! two\nend", "a range the wrong way round is empty");
        it.change(Vec::new(), Encoding::Utf16);
        assert_eq!(&*it.text, "ONE,! two\nend");
    }
}

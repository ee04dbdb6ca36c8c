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
    lines: LineIndex,
}

impl Document {
    pub(super) fn new(uri: Uri, version: i32, text: String) -> Self {
        Self { uri, version, lines: LineIndex::new(&text), text: text.into() }
    }

    /// Applies changes one after the other: each speaks of the text that those before it made.
    pub(super) fn change(&mut self, changes: Vec<Change>, encoding: Encoding) {
        let mut text: Option<String> = None;
        for change in changes {
            match change {
                Change::TextDocumentContentChangeWholeDocument(it) => {
                    self.lines = LineIndex::new(&it.text);
                    text = Some(it.text);
                }
                Change::TextDocumentContentChangePartial(it) => {
                    let text = text.get_or_insert_with(|| self.text.to_string());
                    let range = std::ops::Range::<usize>::from(encoding.text_range(&self.lines, text, it.range));
                    text.replace_range(range.clone(), &it.text);
                    self.lines.edit(range, it.text.len(), text);
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
        let mut it = Document::new(uri, 1, "one\ntwo\n".to_owned());
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

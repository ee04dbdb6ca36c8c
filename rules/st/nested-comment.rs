//! T005: a comment inside a comment, or a comment that is not closed.

use rowan::{TextRange, TextSize};

use crate::lint::{Sink, UnitCx};
use crate::syntax::{Language, SyntaxKind};

/// Length of `(*` and of `*)`.
const MARK: usize = 2;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    // What stands around the program in an exchange file is not published: its parentheses may mean anything.
    if cx.model.language == Language::Exchange || !is_suspicious(cx.text) {
        return;
    }
    let mark = TextSize::of("(*");
    for token in cx.parse.syntax().descendant_tokens() {
        let is_closed = token.kind() == SyntaxKind::Comment;
        if !is_closed && token.kind() != SyntaxKind::UnclosedComment {
            continue;
        }
        let open = TextRange::at(token.text_range().start(), mark);
        let text = token.text();
        let end = if is_closed { text.len().saturating_sub(MARK) } else { text.len() };
        let inner = text.get(MARK..end).and_then(|it| it.find("(*")).and_then(|it| u32::try_from(it + MARK).ok());
        let inner = inner.map(|it| TextRange::at(open.start() + TextSize::new(it), mark));
        match inner {
            Some(inner) if is_closed => {
                sink.report(inner, "a comment opens inside a comment")
                    .related(open, "this comment is still open there")
                    .note("the first `*)` ends the outer comment");
            }
            None if is_closed => {}
            _ => {
                let related = inner.map(|it| (it, "another comment opens here".to_owned()));
                sink.report(open, "the comment opened here is not closed").related_all(related);
            }
        }
    }
}

/// Whether some `(*` is followed by another before any `*)`, or by none: what nearly no text has.
fn is_suspicious(text: &str) -> bool {
    let text = text.as_bytes();
    let mut inner = None;
    for at in memchr::memchr_iter(b'*', text) {
        let opens = at > 0 && text[at - 1] == b'(';
        match inner {
            // `(*)` opens and does not close.
            Some(start) if text.get(at + 1) == Some(&b')') && at >= start => inner = None,
            Some(_) if opens => return true,
            None if opens => inner = Some(at + 1),
            Some(_) | None => {}
        }
    }
    inner.is_some()
}

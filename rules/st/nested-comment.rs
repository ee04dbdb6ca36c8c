//! T005: a comment inside a comment, or a comment that is not closed.

use rowan::{TextRange, TextSize};

use crate::lint::{Sink, UnitCx};
use crate::syntax::{AstNode as _, Language, SyntaxKind, exchange};

/// Length of `(*` and of `*)`.
const MARK: usize = 2;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if !is_suspicious(cx.text) {
        return;
    }
    // What the vendor keeps for its own tool is not published: its parentheses may mean anything.
    let blocks = exchange::Block::all(cx.parse.syntax()).filter(|_| cx.model.language == Language::Exchange);
    let blocks: Vec<_> = blocks.map(|it| (it.syntax().text_range().start(), it.is_called("VENDOR"))).collect();
    let block_at = |at: TextSize| blocks.get(blocks.partition_point(|it| it.0 <= at).checked_sub(1)?);
    let is_private = |at: TextSize| block_at(at).is_some_and(|it| it.1);
    let mark = TextSize::of("(*");
    for token in cx.parse.syntax().descendant_tokens() {
        let is_closed = token.kind() == SyntaxKind::Comment;
        let is_comment = is_closed || token.kind() == SyntaxKind::UnclosedComment;
        if !is_comment || is_private(token.text_range().start()) {
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

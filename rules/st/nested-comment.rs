//! T005: a comment inside a comment, or a comment that is not closed.

use rowan::{TextRange, TextSize};

use crate::lint::{Sink, UnitCx};
use crate::syntax::{Language, SyntaxKind};

/// Length of `(*` and of `*)`.
const MARK: usize = 2;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if !matches!(cx.model.language, Language::Pl7Il | Language::Pl7St) || !is_suspicious(cx.text) {
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
    let mut rest = text;
    while let Some(open) = rest.find("(*") {
        let inner = &rest[open + MARK..];
        let Some(close) = inner.find("*)") else { return true };
        if inner[..close].contains("(*") {
            return true;
        }
        rest = &inner[close + MARK..];
    }
    false
}

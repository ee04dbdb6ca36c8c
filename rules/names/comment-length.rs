//! N002: a comment that is longer than the vendor's tool takes.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::symbols::{Remark, RemarkKind};
use crate::syntax::{Language, SyntaxElement, SyntaxKind};
use crate::target::Limit;
use crate::target::pl7::{
    CHART_COMMENT_LENGTH, DFB_ITEM_COMMENT_LENGTH, IL_COMMENT_LENGTH, RUNG_COMMENT_LENGTH, SECTION_COMMENT_LENGTH,
    ST_COMMENT_LENGTH, SYMBOL_COMMENT_LENGTH,
};
use crate::target::pl72::{COMMENT_LENGTH, STEP_COMMENT_LENGTH};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for remark in &cx.model.remarks {
        let (limit, what) = match remark.kind {
            RemarkKind::Symbol => (SYMBOL_COMMENT_LENGTH, "symbol"),
            RemarkKind::Module => (SECTION_COMMENT_LENGTH, "section or subroutine"),
            RemarkKind::Item => (DFB_ITEM_COMMENT_LENGTH, "parameter or variable of a DFB"),
            RemarkKind::Network => (COMMENT_LENGTH, "network"),
        };
        if remark.characters > limit.value {
            let message =
                format!("the comment of a {what} has {} characters, {} are allowed", remark.characters, limit.value);
            sink.report(remark.range, message).note(format!("the limit is that of {}", limit.source));
        }
    }
    let (limit, what) = match cx.model.language {
        Language::Pl7Gr7 => return chart(cx, CHART_COMMENT_LENGTH, sink),
        Language::Pl72Gr7 => return chart(cx, STEP_COMMENT_LENGTH, sink),
        Language::Pl7Ld => (RUNG_COMMENT_LENGTH, "ladder"),
        Language::Pl7Il => (IL_COMMENT_LENGTH, "a list of instructions"),
        Language::Pl7St => (ST_COMMENT_LENGTH, "structured text"),
        _ => return,
    };
    // Most units hold no long comment: their tokens need no look.
    let text = cx.text.as_bytes();
    let ends = memchr::memmem::find_iter(text, "*)").chain([text.len()]);
    let starts = memchr::memmem::Finder::new("(*");
    let mut from = 0;
    let is_long = |end: usize| {
        let piece = text.get(std::mem::replace(&mut from, end)..end).unwrap_or_default();
        piece.len() > limit.value as usize
            && starts.find(piece).is_some_and(|at| piece.len() - at > limit.value as usize)
    };
    if !ends.into_iter().any(is_long) {
        return;
    }
    let is_item = |range: TextRange| cx.model.remarks.iter().any(|it| it.range == range);
    for token in cx.parse.syntax().descendant_tokens().filter(|it| it.kind() == SyntaxKind::Comment) {
        let characters = Remark::inner(token.text()).chars().count();
        if characters > limit.value as usize && !is_item(token.text_range()) {
            let message = format!("a comment in {what} has {characters} characters, {} are allowed", limit.value);
            sink.report(token.text_range(), message).note(format!("the limit is that of {}", limit.source));
        }
    }
}

/// Comments of the elements of a page: what stands in their heads, and comments on the page itself.
fn chart(cx: &UnitCx<'_>, limit: Limit, sink: &mut Sink<'_, TextRange>) {
    for kind in [SyntaxKind::ChartStep, SyntaxKind::Transition, SyntaxKind::ChartComment] {
        for node in cx.nodes(kind) {
            let head = node.children_with_tokens().take_while(|it| it.kind() != SyntaxKind::Colon);
            let texts = head.filter_map(SyntaxElement::into_token);
            for token in texts.filter(|it| matches!(it.kind(), SyntaxKind::Comment | SyntaxKind::CharString)) {
                let characters = Remark::inner(token.text()).chars().count();
                if characters > limit.value as usize {
                    let message =
                        format!("a comment in a chart has {characters} characters, {} are allowed", limit.value);
                    sink.report(token.text_range(), message).note(format!("the limit is that of {}", limit.source));
                }
            }
        }
    }
}

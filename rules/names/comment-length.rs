//! N002: a comment that is longer than the vendor's tool takes.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::symbols::RemarkKind;
use crate::target::pl7::{SECTION_COMMENT_LENGTH, SYMBOL_COMMENT_LENGTH};
use crate::target::pl72::COMMENT_LENGTH;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for remark in &cx.model.remarks {
        let (limit, what) = match remark.kind {
            RemarkKind::Symbol => (SYMBOL_COMMENT_LENGTH, "symbol"),
            RemarkKind::Module => (SECTION_COMMENT_LENGTH, "section or subroutine"),
            RemarkKind::Network => (COMMENT_LENGTH, "network"),
        };
        if remark.characters > limit.value {
            let message =
                format!("the comment of a {what} has {} characters, {} are allowed", remark.characters, limit.value);
            sink.report(remark.range, message).note(format!("the limit is that of {}", limit.source));
        }
    }
}

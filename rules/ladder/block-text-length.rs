//! L009: the text of a comparison or operation block.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::Cell;
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, SyntaxKind};
use crate::target::pl7::BLOCK_TEXT;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for cell in cx.nodes(SyntaxKind::Cell).filter_map(Cell::cast) {
        // Most cells are shorter than any text that is too long.
        if u32::from(cell.range().len()) <= BLOCK_TEXT.value {
            continue;
        }
        if !matches!(cell.element(), Some(Element::Compare | Element::Operate)) {
            continue;
        }
        let Some(text) = cell.block_text() else { continue };
        let length = cx.text_of(text).trim().chars().count();
        if length > BLOCK_TEXT.value as usize {
            let message =
                format!("this block holds {length} characters, and no block holds more than {}", BLOCK_TEXT.value);
            sink.report(cell.word().map_or(text, |it| it.text_range()), message);
        }
    }
}

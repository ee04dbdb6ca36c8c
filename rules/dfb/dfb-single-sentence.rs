//! F010: code of a DFB with more than one sentence.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::Entity;
use crate::syntax::{Language, SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if !matches!(cx.model.entity, Entity::Dfb { .. }) || cx.model.language != Language::Pl7St {
        return;
    }
    let start = |it: SyntaxNode<'_>| {
        let mut tokens = it.descendant_tokens();
        tokens.find(|it| !it.kind().is_trivia()).map_or_else(|| it.text_range(), |it| it.text_range())
    };
    let mut sentences = cx.nodes(SyntaxKind::Sentence).map(start).skip(1);
    if let Some(second) = sentences.next() {
        sink.report(second, "the code of a DFB is one sentence, and this begins another")
            .related_all(sentences.map(|it| (it, "and another".to_owned())));
    }
}

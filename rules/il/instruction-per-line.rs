//! I012: more than one instruction on a line.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use crate::lint::{Applicability, Edit, Sink, UnitCx};
use crate::syntax::SyntaxKind;
use crate::syntax::pl7::ast::Sentence;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    // The exchange form puts several on a line, and charts are written in it.
    if cx.model.language.is_chart() {
        return;
    }
    for sentence in cx.nodes(SyntaxKind::Sentence) {
        let Some(sentence) = Sentence::cast(sentence) else { continue };
        if sentence.marker().is_some_and(|it| it.kind() == SyntaxKind::SentenceStart) {
            continue;
        }
        let places: Vec<TextRange> = sentence.instructions().map(|it| it.syntax().text_range()).collect();
        let gap = |pair: &[TextRange]| TextRange::new(pair[0].end(), pair[1].start().max(pair[0].end()));
        // Runs of instructions with no line break between them.
        for line in places.chunk_by(|a, b| !cx.text_of(gap(&[*a, *b])).contains(['\n', '\r'])) {
            let (Some(second), Some(last)) = (line.get(1), line.last()) else { continue };
            let edits = line
                .windows(2)
                .map(|pair| Edit { place: gap(pair), replacement: format!("\n     {}", cx.text_of(gap(pair)).trim()) })
                .collect();
            let count = line.len();
            sink.report(second.cover(*last), format!("{count} instructions stand on one line")).fix(
                "Give each instruction a line",
                Applicability::Safe,
                edits,
            );
        }
    }
}

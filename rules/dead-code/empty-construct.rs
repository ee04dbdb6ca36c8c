//! D002: a branch, loop, network, section or block that holds nothing.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::{BlockKind, BlockName, Entity, Part};
use crate::model::unit::HollowKind;
use crate::syntax::SyntaxKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    if let Some(what) = holds_code(&cx.model.entity).filter(|_| is_empty(cx)) {
        sink.report(cx.model.heading(), format!("this {what} is empty"));
        return;
    }
    // A block without any code, if it is not reported as such, is empty on purpose.
    for hollow in cx.model.hollows.iter().filter(|_| cx.model.instructions > 0) {
        let message = match hollow.kind {
            HollowKind::Branch => "this branch does nothing",
            HollowKind::Loop => "this loop does nothing",
            HollowKind::Network => "this network is empty",
        };
        sink.report(hollow.range, message);
    }
}

/// What a unit is called, when it is there for its code. The OBs of errors are there to be there: without one the CPU stops.
fn holds_code(entity: &Entity) -> Option<&'static str> {
    match entity {
        Entity::Pl7 { part: Part::Subroutine(_), .. } => Some("subroutine"),
        Entity::Pl7 { part: Part::Main | Part::Preliminary | Part::Posterior, .. } => Some("section"),
        Entity::Pl7 { part: Part::Event, .. } => Some("event"),
        Entity::Block { kind: BlockKind::Fc | BlockKind::Fb, .. }
        | Entity::Block { name: BlockName::Number(BlockKind::Ob, 1), .. } => Some("block"),
        _ => None,
    }
}

/// Neither an instruction nor a sentence, which may be empty, nor a remark, nor something that was not understood.
fn is_empty(cx: &UnitCx<'_>) -> bool {
    let mut tokens = cx.parse.syntax().descendant_tokens();
    cx.model.instructions == 0
        && !cx.model.has_gaps
        && cx.parse.errors().is_empty()
        && cx.nodes(SyntaxKind::Sentence).next().is_none()
        && !tokens.any(|it| matches!(it.kind(), SyntaxKind::Comment | SyntaxKind::Elision | SyntaxKind::Unknown))
}

//! J006: a network of PL7-2 without a label.

use std::collections::BTreeSet;

use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx};
use crate::model::entity::{Entity, Part};
use crate::syntax::pl7::ast::Rung;
use crate::syntax::{AstNode as _, Language, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    // Actions and receptivities are labelled by the tool, with the numbers of their steps (PL72:1419-1422, PL72:1476-1478).
    let is_piece = matches!(cx.model.entity, Entity::Pl7 { part: Part::Chart(_), .. });
    if cx.model.language != Language::Pl72Ld || is_piece {
        return;
    }
    let Some(range) = cx.target.label_numbers() else { return };
    let taken: BTreeSet<u32> = cx.model.labels.iter().filter_map(|it| it.name.parse().ok()).collect();
    let mut free = (range.first..=range.last).filter(|it| !taken.contains(it));
    for rung in cx.nodes(SyntaxKind::Rung).filter_map(Rung::cast) {
        let Some(keyword) = rung.keyword().filter(|_| rung.label().is_none()) else { continue };
        let place = keyword.text_range();
        let found = sink.report(place, "this network has no label, and each network of PL7-2 has one");
        if let Some(number) = free.next() {
            let behind = TextRange::empty(place.end());
            found.replace(format!("Write `L{number}:`"), Applicability::Safe, behind, format!(" L{number}:"));
        }
    }
}

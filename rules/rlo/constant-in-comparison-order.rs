//! R007: a comparison whose comment states it the other way round.

use rowan::TextRange;

use crate::analysis::stated::stated;
use crate::lint::finding::{Applicability, Edit};
use crate::lint::{Sink, UnitCx};
use crate::model::expr::Comparison;
use crate::syntax::awl::ast::{Instr, Network};
use crate::syntax::awl::instruction::{Op, Relation};
use crate::syntax::{AstNode as _, Language, SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Language::Awl(mnemonics) = cx.model.language else { return };
    let comments = cx.comments();
    if comments.is_empty() {
        return;
    }
    // Most networks compare nothing.
    let may_compare =
        |it: &SyntaxNode<'_>| memchr::memchr2(b'<', b'>', cx.text_of(it.text_range()).as_bytes()).is_some();
    for network in cx.nodes(SyntaxKind::Network).filter(may_compare).filter_map(Network::cast) {
        let instrs: Vec<Instr<'_>> = network.instrs().collect();
        for (at, window) in instrs.windows(3).enumerate() {
            let &[first, second, comparison] = window else { continue };
            let is_load = |it: Instr<'_>| it.op(mnemonics) == Some(Op::Load);
            let Some(Op::Compare(relation, _)) = comparison.op(mnemonics) else { continue };
            let Some(tested) = order(relation).filter(|_| is_load(first) && is_load(second)) else { continue };
            let (Some(left), Some(right)) = (first.operand(), second.operand()) else { continue };
            if second.label().is_some() || comparison.label().is_some() {
                continue;
            }
            let (a, b) = (cx.text_of(left.range()), cx.text_of(right.range()));
            // A jump or `NOT` behind it may be there for the case that the comment does not speak of.
            let is_turned = instrs.get(at + 3).and_then(|it| it.op(mnemonics)).is_some_and(|it| {
                matches!(it, Op::Jump(_) | Op::NegateRlo | Op::BlockEndConditional | Op::CallConditional)
            });
            let beside: &[Instr<'_>] = if is_turned { &[comparison] } else { &[first, second, comparison] };
            let stating: Vec<(TextRange, Comparison)> =
                near(cx.text, comments, first.range().cover(comparison.range()))
                    .iter()
                    .filter(|it| beside.iter().any(|instr| is_beside(cx.text, instr.range(), **it)))
                    .filter_map(|it| Some((*it, stated(cx.text_of(*it), a, b)?)))
                    .collect();
            let [(comment, said), others @ ..] = stating.as_slice() else { continue };
            if *said != tested.mirrored() || others.iter().any(|it| it.1 != *said) {
                continue;
            }
            let exchange = vec![
                Edit { place: left.range(), replacement: b.to_owned() },
                Edit { place: right.range(), replacement: a.to_owned() },
            ];
            let (tested, said) = (tested.as_str(), said.as_str());
            sink.report(
                comparison.range(),
                format!("the comment says `{a} {said} {b}`, and the code tests `{a} {tested} {b}`"),
            )
            .label("compares what was loaded first with what was loaded last")
            .related(*comment, "the comment")
            .fix("Exchange the operands", Applicability::Unsafe, exchange);
        }
    }
}

/// The relation of an instruction that puts its operands in order.
fn order(relation: Relation) -> Option<Comparison> {
    Some(match relation {
        Relation::Gt => Comparison::Gt,
        Relation::Lt => Comparison::Lt,
        Relation::Ge => Comparison::Ge,
        Relation::Le => Comparison::Le,
        Relation::Eq | Relation::Ne => return None,
    })
}

/// The comments on the lines of a place, and on the line above it.
fn near<'c>(text: &str, comments: &'c [TextRange], place: TextRange) -> &'c [TextRange] {
    let above = text.get(..usize::from(place.start())).unwrap_or_default().rmatch_indices('\n').nth(1);
    let start = above.map_or(0, |it| it.0);
    let behind = text.get(usize::from(place.end())..).unwrap_or_default();
    let end = usize::from(place.end()) + behind.find('\n').unwrap_or(behind.len());
    let from = comments.partition_point(|it| usize::from(it.end()) <= start);
    let to = comments.partition_point(|it| usize::from(it.start()) < end);
    comments.get(from..to).unwrap_or_default()
}

/// Whether a comment stands behind an instruction on its line, or fills the line above it.
fn is_beside(text: &str, instr: TextRange, comment: TextRange) -> bool {
    let between = |from, to| text.get(usize::from(from)..usize::from(to)).unwrap_or_default();
    if comment.start() >= instr.end() {
        return !between(instr.end(), comment.start()).contains('\n');
    }
    let line = text.get(..usize::from(comment.start())).unwrap_or_default();
    let is_alone = line.rsplit('\n').next().unwrap_or_default().trim().is_empty();
    let gap = if comment.end() <= instr.start() { between(comment.end(), instr.start()) } else { return false };
    is_alone && gap.trim().is_empty() && gap.matches('\n').count() <= 1
}

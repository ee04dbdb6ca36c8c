//! L004: a test that a wire goes round, and tests that are without effect together.

use rowan::TextRange;

use crate::analysis::conditions::Space;
use crate::lint::{Sink, UnitCx};
use crate::model::expr::Exprs;
use crate::model::ladder::Flaw;
use crate::model::unit::{OddityKind, StatementKind};
use crate::syntax::SyntaxKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in cx.model.oddities.iter().filter(|it| it.kind == OddityKind::Ladder(Flaw::Bypassed)) {
        let related = oddity.related.iter().map(|&(place, part)| (place, part.to_owned()));
        sink.report(oddity.range, "this test has no effect: a wire goes round it").related_all(related);
    }
    let rungs: Vec<TextRange> = cx.nodes(SyntaxKind::Rung).map(|it| it.text_range()).collect();
    let space = Space::of(cx.model);
    let mut before = None;
    for it in &cx.model.statements {
        let (StatementKind::Assign { value: power, .. }
        | StatementKind::Set { when: power, .. }
        | StatementKind::Reset { when: power, .. }) = it.kind
        else {
            continue;
        };
        // Several coils of one line have one cause; a constant is wired on purpose.
        let this = Some((it.network, power));
        if matches!(power, Exprs::TRUE | Exprs::FALSE) || std::mem::replace(&mut before, this) == this {
            continue;
        }
        if space.implies(Exprs::TRUE, power) && rungs.iter().any(|rung| rung.contains_range(it.range)) {
            sink.report(it.range, "the tests before this coil let power through whatever they find");
        }
    }
}

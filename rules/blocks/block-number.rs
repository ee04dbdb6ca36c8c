//! B009: a block number that the controller does not have.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::BlockName;
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut seen: FxHashSet<&BlockName> = FxHashSet::default();
    let defined = (0_u32..).zip(&cx.program.units).filter_map(|(unit, it)| {
        let name = it.entity.name()?;
        Some((name, ProgramIndex::heading(unit)))
    });
    let called = cx.program.calls.iter().filter_map(|it| match &it.it.callee {
        Callee::Block(name) => Some((name, it.site())),
        _ => None,
    });
    for (name, site) in defined.chain(called) {
        let BlockName::Number(kind, number) = name else { continue };
        let Some(range) = cx.target.block_numbers(*kind) else { continue };
        if range.contains(*number) || !seen.insert(name) {
            continue;
        }
        let of = cx.target.controller().map_or("every controller of the family".to_owned(), |it| format!("the {it}"));
        let kind = kind.as_str();
        sink.report(site, format!("`{name}` is out of range: {of} has {kind}{} to {kind}{}", range.first, range.last))
            .note(format!("the range is given in {}", range.source));
    }
}

//! B010: a function block on a controller without function blocks.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::unit::Callee;
use crate::target::step5::FunctionBlocks;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(cpu) = cx.target.step5() else { return };
    let FunctionBlocks::None(source) = cpu.function_blocks else { return };
    let is_fb = |it: &BlockName| matches!(it, BlockName::Number(BlockKind::Fb | BlockKind::Fx, _));
    let defined = (0_u32..).zip(&cx.program.units).filter_map(|(unit, it)| {
        let name = it.entity.name().filter(|it| is_fb(it))?;
        Some((ProgramIndex::heading(unit), name.to_string()))
    });
    let called = cx.program.calls.iter().filter(|it| it.target.is_none()).filter_map(|it| match &it.it.callee {
        Callee::Block(name) if is_fb(name) => Some((it.site(), name.to_string())),
        _ => None,
    });
    let mut found = defined.chain(called);
    let Some((first, name)) = found.next() else { return };
    sink.report(first, format!("`{name}` is a function block, which the {} does not have", cpu.name))
        .related_all(found.map(|(site, name)| (site, format!("`{name}` is one too"))))
        .note(format!("this is said in {source}"));
}

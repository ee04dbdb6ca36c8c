//! J013: a subroutine or block that nothing calls.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::layout::DataType;
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    // A call computed at run time, or one of which the callee was not found, may call anything.
    if !program.complete {
        return;
    }
    let called: FxHashSet<u32> =
        program.calls.iter().filter(|it| it.target != Some(it.unit)).filter_map(|it| it.target).collect();
    let typed = used_as_type(program);
    for (unit, facts) in (0_u32..).zip(&program.units) {
        let entity = &facts.entity;
        let callable = entity.subroutine().is_some() || entity.block_kind().is_some_and(BlockKind::is_callable);
        let as_type = entity.name().is_some_and(|it| typed.contains(it));
        if callable && !as_type && !called.contains(&unit) {
            sink.report(ProgramIndex::heading(unit), format!("nothing calls {entity}"));
        }
    }
}

/// Function blocks that have an instance: a data block that something calls, a variable of another block.
fn used_as_type<'a>(program: &ProgramIndex<'a>) -> FxHashSet<&'a BlockName> {
    let mut used = FxHashSet::default();
    for facts in &program.units {
        // Of a data block, the block whose data it is; whether something calls it is another matter.
        let of = facts.declared.as_deref().filter(|it| !matches!(it, DataType::Named(_)));
        if let Some(of) = of {
            of.each_named(&mut |it| {
                used.insert(it);
            });
        }
    }
    for call in &program.calls {
        // `CALL DB 5` or `CALL "Motor_1"` calls the block whose data that is.
        if let Callee::Block(name @ (BlockName::Symbol(_) | BlockName::Number(BlockKind::Db, _))) = &call.it.callee
            && let Some(of) = program.unit_named(name).and_then(|it| program.units[it as usize].instance_of.as_ref())
        {
            used.insert(of);
        }
    }
    used
}

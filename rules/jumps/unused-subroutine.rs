//! J013: a subroutine or block that nothing calls.

use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
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
        let as_type = entity.name().is_some_and(|it| typed.contains(&type_key(&it.to_string())));
        if callable && !as_type && !called.contains(&unit) {
            sink.report(ProgramIndex::heading(unit), format!("nothing calls {entity}"));
        }
    }
}

/// Function blocks that have an instance: a data block that something calls, a variable of another block.
fn used_as_type(program: &ProgramIndex<'_>) -> FxHashSet<SmolStr> {
    let mut used = FxHashSet::default();
    for facts in &program.units {
        used.extend(facts.declared.iter().map(|it| type_key(&it.ty)));
    }
    for call in &program.calls {
        // `CALL DB 5` or `CALL "Motor_1"` calls the block whose data that is.
        if let Callee::Block(name @ (BlockName::Symbol(_) | BlockName::Number(BlockKind::Db, _))) = &call.it.callee
            && let Some(of) = program.unit_named(name).and_then(|it| program.units[it as usize].instance_of.as_ref())
        {
            used.insert(type_key(&of.to_string()));
        }
    }
    used
}

/// A type as written, without quotes and blanks, in lower case.
fn type_key(ty: &str) -> SmolStr {
    ty.chars().filter(|it| !it.is_whitespace() && *it != '"').flat_map(char::to_lowercase).collect()
}

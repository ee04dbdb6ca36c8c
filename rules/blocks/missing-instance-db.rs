//! B002: a function block called without its instance data block, or with another's.

use crate::analysis::Site;
use crate::analysis::program::{GlobalCall, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for call in &cx.program.calls {
        let Callee::Block(name) = &call.it.callee else { continue };
        if !call.it.full || !is_function_block(cx.program, call, name) {
            continue;
        }
        let callee = &call.it.text;
        let Some(instance) = &call.it.instance else {
            sink.report(call.site(), format!("`{callee}` is called without an instance data block"));
            continue;
        };
        let Some(unit) = cx.program.unit_named(instance) else { continue };
        let heading = ProgramIndex::heading(unit);
        match &cx.program.units[unit as usize].instance_of {
            None if cx.program.entity(unit).block_kind() == Some(BlockKind::Db) => {
                sink.report(call.instance_site(), format!("`{instance}` is no instance of `{callee}`"))
                    .related(heading, "declared as a data block of its own".to_owned());
            }
            Some(of) if differ(cx.program, call, name, of) => {
                sink.report(call.instance_site(), format!("`{instance}` is an instance of `{of}`, not of `{callee}`"))
                    .related(heading, format!("declared as an instance of `{of}`"));
            }
            _ => {}
        }
    }
}

fn is_function_block(program: &ProgramIndex<'_>, call: &GlobalCall<'_>, name: &BlockName) -> bool {
    match name {
        BlockName::Number(kind, _) => matches!(kind, BlockKind::Fb | BlockKind::Sfb),
        BlockName::Symbol(_) => call.target.is_some_and(|it| program.entity(it).block_kind() == Some(BlockKind::Fb)),
    }
}

/// Whether the names are of two blocks for sure: a symbol and a number may name the same one.
fn differ(program: &ProgramIndex<'_>, call: &GlobalCall<'_>, callee: &BlockName, of: &BlockName) -> bool {
    match (callee, of) {
        (BlockName::Number(..), BlockName::Number(..)) => callee != of,
        _ => call.target.zip(program.unit_named(of)).is_some_and(|(a, b)| a != b),
    }
}

//! B001: an organization block called by the program.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for call in &cx.program.calls {
        let Callee::Block(name) = &call.it.callee else { continue };
        let by_number = matches!(name, BlockName::Number(BlockKind::Ob, _));
        let by_target = call.target.is_some_and(|it| cx.program.entity(it).block_kind() == Some(BlockKind::Ob));
        if by_number || by_target {
            sink.report(
                call.site(),
                format!("`{}` is an organization block, which only the system calls", call.it.text),
            );
        }
    }
}

//! B001: an organization block called by the program.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName, Family};
use crate::model::unit::Callee;
use crate::target::step5;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for call in &cx.program.calls {
        let Callee::Block(name) = &call.it.callee else { continue };
        let by_number = matches!(name, BlockName::Number(BlockKind::Ob, _));
        let by_target = call.target.is_some_and(|it| cx.program.entity(it).block_kind() == Some(BlockKind::Ob));
        let is_function = cx.program.family == Family::Step5 && step5::is_function(name);
        if (by_number || by_target) && !is_function {
            sink.report(
                call.site(),
                format!("`{}` is an organization block, which only the system calls", call.it.text),
            );
        }
    }
}

//! D001: code that no path reaches.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::unit::DeadCause;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let blocks = cx.model.language.is_statement_list();
    for stretch in &cx.model.unreachable {
        let part = match stretch.cause {
            // Code after the end of a block is another rule's affair.
            DeadCause::End if blocks => continue,
            DeadCause::End => "the program ends here",
            DeadCause::Jump => "control always leaves here",
            DeadCause::Return => "control goes back to the caller here",
            DeadCause::Halt => "the program stops here",
            DeadCause::FalseCondition => "this is never true",
        };
        sink.report(stretch.first, "no path reaches this code").related(stretch.cut_by, part);
    }
}

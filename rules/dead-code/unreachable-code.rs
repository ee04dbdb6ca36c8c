//! D001: code that no path reaches.

use rowan::TextRange;

use crate::analysis::decided;
use crate::lint::{Sink, UnitCx};
use crate::model::unit::DeadCause;
use crate::syntax::Language;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let blocks = cx.model.language.is_statement_list();
    // In these languages, a condition that cuts code off is a finding of its own.
    let has_texts = !blocks && !matches!(cx.model.language, Language::Pl7Ld | Language::Pl72Ld);
    let is_cut = has_texts && !cx.model.unreachable.is_empty();
    let judged = if is_cut { decided::judged(cx.model) } else { Vec::new() };
    for stretch in &cx.model.unreachable {
        if judged.contains(&stretch.cut_by) {
            continue;
        }
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
    if has_texts {
        return;
    }
    for (first, _) in decided::unreached(cx.model) {
        let Some(statement) = cx.model.statements.get(first as usize) else { continue };
        sink.report(statement.range, "no path reaches this code")
            .note("the conditions that lead here exclude one another");
    }
}

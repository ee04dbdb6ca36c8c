//! T013: a condition that is always true, or never.

use rowan::TextRange;

use crate::analysis::decided::{self, Because};
use crate::lint::{Sink, UnitCx};
use crate::model::unit::StatementKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for it in decided::decided(cx.model) {
        let text = cx.text_of(it.range).split_whitespace().collect::<Vec<_>>().join(" ");
        let kind = cx.model.statements.get(it.statement as usize).map(|it| &it.kind);
        let condition = match kind {
            Some(StatementKind::Branch { .. }) => format!("the condition `{text}`"),
            _ => format!("the condition of `{text}`"),
        };
        let value = if it.value { "always true" } else { "never true" };
        let here = if it.because == Because::Itself { "" } else { " here" };
        let finding = sink.report(it.range, format!("{condition} is {value}{here}"));
        match it.because {
            Because::Itself => {}
            Because::Stored(place) => {
                finding.related(place, "the value that it asks for is set here");
            }
            Because::Path => {
                let tells = if it.value { "imply it" } else { "exclude it" };
                finding.note(format!("the conditions under which control comes here {tells}"));
            }
        }
    }
}

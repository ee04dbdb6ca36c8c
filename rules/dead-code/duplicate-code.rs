//! D003: statements that stand several times in a program.

use crate::analysis::{Site, repeats};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;

/// So many statements fewer there must be with one block in place of the copies.
const SAVED: usize = 6;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let option = cx.settings.options("duplicate-code").and_then(|it| it.get("saved-statements"));
    let saved = option.and_then(toml::Value::as_integer).and_then(|it| usize::try_from(it).ok()).unwrap_or(SAVED);
    let instead = match cx.program.family {
        Family::Pl7 => "a DFB, or a subroutine where the operands are the same, would hold it once",
        Family::Pl72 => "a subroutine that is given its operands in words would hold it once",
        Family::Step5 | Family::Step7 => "a function block with parameters would hold it once",
    };
    for it in repeats::repeats(cx.program, saved.max(1)) {
        let [first, second, others @ ..] = it.places.as_slice() else { continue };
        let operands = if it.identical { "the same operands" } else { "other operands" };
        let message = format!(
            "the same {} statements stand in {} places of the program, with {operands}",
            it.length,
            it.places.len()
        );
        sink.report(*second, message)
            .label("the second of them begins here")
            .related(*first, "the first begins here")
            .related_all(others.iter().map(|it| (*it, "one more begins here".to_owned())))
            .note(instead);
    }
}

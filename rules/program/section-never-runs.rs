//! P002: a section whose condition nothing but the section itself can make 1.

use crate::analysis::Site;
use crate::analysis::program::{GlobalUse, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if !program.complete {
        return;
    }
    for section in program.conditional_sections() {
        let condition = section.condition;
        // The system drives the other bits.
        let is_driven = matches!(condition.class, Class::Memory | Class::Output) && condition.is_fixed();
        let unseen = program.unseen_of(condition);
        if !is_driven || unseen.has_unresolved(Mode::writes) || unseen.is_written() {
            continue;
        }
        let Some(&first) = section.units.first() else { continue };
        let own = program.run_by(&section.units);
        let writes = program.objects_that(|_| true, |it| it.footprint.overlaps(&condition.footprint));
        // A reset does not start the section.
        let raises = |it: &&GlobalUse<'_>| it.mode.writes() && it.mode != Mode::Reset && it.it.constant() != Some(0);
        let mut raising = writes.iter().flat_map(|it| &it.uses).filter(raises).peekable();
        if raising.peek().is_none() {
            continue;
        }
        let raising: Vec<&GlobalUse<'_>> = raising.collect();
        if raising.iter().all(|it| own.contains(&it.unit)) {
            let message = format!("this section never runs: it alone can make its condition `{}` 1", condition.text);
            sink.report(ProgramIndex::heading(first), message)
                .related_all(
                    cx.settings.condition_site(program.entity(first)).map(|it| (it, "its condition".to_owned())),
                )
                .related_all(raising.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))))
                .note("at a cold start the conditions of sections are 0 (PL7:1988)");
        }
    }
}

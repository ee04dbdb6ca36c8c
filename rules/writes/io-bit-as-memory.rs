//! W007: an output that no configured module has, written as if it were memory.

use crate::analysis::Site;
use crate::analysis::channels;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Class;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if !cx.settings.has_modules() {
        return;
    }
    for uses in cx.program.objects.iter().filter(|it| it.object.class == Class::Output) {
        let Some((position, last)) = channels::discrete(uses.object) else { continue };
        let configured = cx.settings.output_channels(position);
        if configured.is_some_and(|it| last < it.0) {
            continue;
        }
        let mut writes = uses.with_mode(Mode::writes);
        let Some(write) = writes.next() else { continue };
        let others = writes.chain(uses.with_mode(|it| it.reads() && !it.writes()));
        let note = match configured.map(|it| it.0) {
            Some(0) => format!("the configuration gives the module at position {position} no outputs"),
            Some(count) => format!("the configuration gives the module at position {position} {count} outputs"),
            None => format!("the configuration has no module at position {position}"),
        };
        sink.report(
            write.site(),
            format!("`{}` is no output of any module, and cannot serve as memory", uses.object.text),
        )
        .related_all(configured.map(|it| (it.1, "the module".to_owned())))
        .related_all(others.map(|it| (it.site(), format!("also {} here", it.mode.verb()))))
        .note(note);
    }
}

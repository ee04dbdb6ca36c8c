//! E002: the edge of a bit that several places write.

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Type;
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (at, uses) in (0..).zip(&cx.program.objects) {
        // Set and reset are E001's affair.
        let stored = uses.has_mode(|it| matches!(it, Mode::Set | Mode::Reset));
        let Some(edge) = uses.with_mode(Mode::is_edge).next().filter(|_| !stored) else { continue };
        if uses.object.ty != Type::Bool || !uses.object.is_fixed() {
            continue;
        }
        let mut writes: Vec<GlobalUse<'_>> = uses.with_mode(Mode::assigns).copied().collect();
        writes.extend(drives::covering(cx.program, uses, cx.neighbours(at)));
        drives::in_order(cx.program, &mut writes);
        let Some((second, others)) = drives::conflict(cx.program, &writes, |_, _| true) else { continue };
        let name = &uses.object.text;
        sink.report(edge.site(), format!("the edge of `{name}` is tested, which more than one place writes"))
            .related(second.site(), format!("{} a second time here", second.mode.verb()))
            .related_all(others.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))));
    }
}

//! G021: an output driven in the action of a step.

use crate::analysis::Site;
use crate::analysis::processing::{InAction, may_raise, raised_by_several};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.program.objects.iter().filter(|it| it.object.class == Class::Output) {
        // One that several steps drive is G022's affair.
        if uses.object.ty == Type::Bool && raised_by_several(cx.program, uses).is_some() {
            continue;
        }
        let places = uses.with_mode(Mode::writes).filter_map(|it| Some((it, InAction::of(cx.program, it)?)));
        let places: Vec<_> = places.collect();
        let at = places.iter().position(|it| may_raise(it.0)).unwrap_or_default();
        let Some((first, action)) = places.get(at) else { continue };
        let others = places.iter().enumerate().filter(|it| it.0 != at);
        let others = others
            .map(|(_, (it, action))| (it.site(), format!("also {} here, in {}", it.mode.verb(), action.describe())));
        sink.report(
            first.site(),
            format!("`{}` is driven directly in an action of {}", uses.object.text, action.describe()),
        )
        .related_all(others);
    }
}

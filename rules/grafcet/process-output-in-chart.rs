//! G021: an output driven in the action of a step.

use crate::analysis::Site;
use crate::analysis::processing::{action_of, raised_by_several};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.program.objects.iter().filter(|it| it.object.class == Class::Output) {
        // One that several steps drive is G022's affair.
        if uses.object.ty == Type::Bool && raised_by_several(cx.program, uses).is_some() {
            continue;
        }
        let mut places = uses
            .with_mode(Mode::writes)
            .filter_map(|it| Some((it, action_of(cx.program, it)?)))
            .collect::<Vec<_>>()
            .into_iter();
        let Some((first, action)) = places.next() else { continue };
        let message = format!("`{}` is driven directly in an action of {}", uses.object.text, action.describe());
        sink.report(first.site(), message).related_all(
            places.map(|(it, action)| (it.site(), format!("also {} here, in {}", it.mode.verb(), action.describe()))),
        );
    }
}

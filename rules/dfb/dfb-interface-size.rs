//! F001: a DFB type with more parameters or variables than PL7 takes.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::Role;
use crate::target::pl7;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = &cx.model.interface else { return };
    for (roles, what, limit) in [
        (&[Role::Input, Role::InOut][..], "inputs and in/outs", pl7::DFB_INPUTS_AND_IN_OUTS),
        (&[Role::Output, Role::InOut][..], "outputs and in/outs", pl7::DFB_OUTPUTS_AND_IN_OUTS),
        (&[Role::Public][..], "public variables", pl7::DFB_PUBLIC_VARIABLES),
        (&[Role::Private][..], "private variables", pl7::DFB_PRIVATE_VARIABLES),
    ] {
        let items = || interface.items.iter().filter(|it| roles.contains(&it.role));
        let Some(first) = items().nth(limit.value as usize) else { continue };
        let message = format!("the DFB has {} {what}, {} are allowed", items().count(), limit.value);
        sink.report(cx.model.place(interface.anchor), message)
            .related(cx.model.place(first.anchor), format!("the first one beyond {}", limit.value))
            .note(format!("the limit is given in {}", limit.source));
    }
}

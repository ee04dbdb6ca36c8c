//! F002: a DFB type without a Boolean input.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::{ItemType, Role};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = cx.model.interface.as_ref().filter(|it| !it.items.is_empty()) else { return };
    let mut inputs = interface.items.iter().filter(|it| matches!(it.role, Role::Input | Role::InOut));
    if !inputs.any(|it| it.ty.is_bit() || it.ty == ItemType::Unknown) {
        sink.report(cx.model.place(interface.anchor), "the DFB has no Boolean input");
    }
}

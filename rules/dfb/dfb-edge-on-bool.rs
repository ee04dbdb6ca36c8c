//! F009: an edge of a DFB item of type BOOL.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::ItemType;
use crate::model::object::Class;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = &cx.model.interface else { return };
    for access in cx.model.accesses.iter().filter(|it| it.mode.is_edge()) {
        let object = cx.model.object(access.object);
        if object.class != Class::LocalName {
            continue;
        }
        if let Some(item) = interface.item(&object.text).filter(|it| it.ty == ItemType::Bool) {
            let message = format!("`{}` has no edge: an item of type BOOL keeps no former state", object.text);
            sink.report(cx.model.place(access.anchor), message)
                .related(cx.model.place(item.ty_anchor), "declared here, `EBOOL` would have edges");
        }
    }
}

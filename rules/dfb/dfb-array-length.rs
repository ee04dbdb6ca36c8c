//! F004: a table of a DFB whose length is not given.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::Role;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for item in cx.model.interface.iter().flat_map(|it| &it.items) {
        let needs = matches!(item.role, Role::Output | Role::Public | Role::Private);
        if needs && item.ty.is_array() && item.ty.length().is_none() {
            let message = format!("the {} `{}` is a table without a length", item.role.describe(), item.name);
            sink.report(cx.model.place(item.ty_anchor), message);
        }
    }
}

//! F005: an initial value of a parameter that cannot have one.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::Role;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for item in cx.model.interface.iter().flat_map(|it| &it.items) {
        let what = match item.role {
            Role::InOut => "an in/out parameter",
            Role::Input if item.ty.is_array() => "an input that is a table",
            _ => continue,
        };
        if let Some((_, anchor)) = &item.initial {
            let message = format!("`{}` is {what}, which has no initial value", item.name);
            sink.report(cx.model.place(*anchor), message);
        }
    }
}

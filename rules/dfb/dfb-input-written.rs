//! F008: an input that the code of its DFB writes.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::dfb::Role;
use crate::model::object::Area;
use crate::model::symbols::key;
use crate::model::unit::{Access, Mode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = &cx.model.interface else { return };
    // What a call may change, or not, is not known.
    let writes: Vec<&Access> =
        cx.model.accesses.iter().filter(|it| it.mode.writes() && it.mode != Mode::InOut).collect();
    for item in interface.items.iter().filter(|it| it.role == Role::Input) {
        let name = key(&item.name);
        let of_item = |it: &&&Access| match &cx.model.object(it.object).footprint.area {
            Area::LocalName(area) => *area == name,
            _ => false,
        };
        let mut writes = writes.iter().filter(of_item);
        let Some(first) = writes.next() else { continue };
        sink.report(
            cx.model.place(first.anchor),
            format!("`{}` is an input of the DFB, which its code cannot write", item.name),
        )
        .label(format!("{} here", first.mode.verb()))
        .related(cx.model.place(item.anchor), "declared here")
        .related_all(writes.map(|it| (cx.model.place(it.anchor), format!("also {} here", it.mode.verb()))));
    }
}

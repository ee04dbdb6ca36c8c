//! F013: a call of a DFB without a parameter that it must have, or with too many.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::{Item, Role};
use crate::model::unit::Slot;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (call, _, unit, interface) in cx.program.instance_calls() {
        if !call.it.full || interface.items.is_empty() {
            continue;
        }
        let (site, text, actuals) = (call.site(), &call.it.text, &call.it.actuals);
        let at = |it: &Item| Site { unit, anchor: it.anchor };
        if let Some(last) = actuals.iter().rfind(|it| interface.position(it.slot).is_none()) {
            let (place, message) = match last.slot {
                Slot::Position(last) => {
                    let count = interface.parameters().count();
                    (site, format!("`{text}` takes {count} parameters, and is given {}", last + 1))
                }
                Slot::Left(_) | Slot::Right(_) => {
                    (Site { unit: call.unit, anchor: last.anchor }, format!("`{text}` has no pin in this row"))
                }
            };
            sink.report(place, message).related(Site { unit, anchor: interface.anchor }, "the type of the DFB");
            continue;
        }
        let given: Vec<u32> = actuals.iter().filter_map(|it| interface.position(it.slot)).collect();
        let is_needed = |it: &Item| it.role == Role::InOut || it.role == Role::Input && it.ty.is_array();
        let open = (0..).zip(interface.parameters()).filter(|it| is_needed(it.1) && !given.contains(&it.0));
        let open: Vec<&Item> = open.map(|it| it.1).collect();
        if let [first, ..] = &open[..] {
            let what = if first.role == Role::InOut { "in/out" } else { "table" };
            sink.report(site, format!("`{text}` is called without its {what} `{}`", first.name))
                .related_all(open.iter().map(|it| (at(it), "this must be given".to_owned())));
        }
    }
}

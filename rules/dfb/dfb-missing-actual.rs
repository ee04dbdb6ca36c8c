//! F013: a call of a DFB without a parameter that it must have, or with too many.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::{Item, Role};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for call in cx.program.calls.iter().filter(|it| it.it.full) {
        let Callee::Instance(name) = &call.it.callee else { continue };
        let Some((unit, interface)) = cx.program.dfb_of(name).filter(|it| !it.1.items.is_empty()) else { continue };
        let site = call.site();
        let at = |it: &Item| Site { unit, anchor: it.anchor };
        let count = interface.parameters().count();
        if let Some(last) = call.it.given.last().filter(|it| **it as usize >= count) {
            let message = format!("`{}` takes {count} parameters, and is given {}", call.it.text, last + 1);
            sink.report(site, message).related(Site { unit, anchor: interface.anchor }, "the type of the DFB");
            continue;
        }
        let is_needed = |it: &Item| it.role == Role::InOut || it.role == Role::Input && it.ty.is_array();
        let open = (0..).zip(interface.parameters()).filter(|it| is_needed(it.1) && !call.it.given.contains(&it.0));
        let open: Vec<&Item> = open.map(|it| it.1).collect();
        if let [first, ..] = &open[..] {
            let what = if first.role == Role::InOut { "in/out" } else { "table" };
            sink.report(site, format!("`{}` is called without its {what} `{}`", call.it.text, first.name))
                .related_all(open.iter().map(|it| (at(it), "this must be given".to_owned())));
        }
    }
}

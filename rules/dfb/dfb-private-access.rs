//! F015: an item of a DFB that is not visible from outside.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::Role;
use crate::model::entity::Entity;
use crate::model::object::Class;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.program.objects.iter().filter(|it| it.object.class == Class::Symbol) {
        let Some((instance, item)) = uses.object.text.split_once('.') else { continue };
        let Some((unit, interface)) = cx.program.dfb_of(instance) else { continue };
        let item = item.split(['.', ':', '[']).next().unwrap_or_default();
        let Some(item) = interface.item(item).filter(|it| !matches!(it.role, Role::Output | Role::Public)) else {
            continue;
        };
        // In the code of a DFB, no instance is visible at all.
        let mut uses_outside = uses.uses.iter().filter(|it| !matches!(cx.program.entity(it.unit), Entity::Dfb { .. }));
        if let Some(first) = uses_outside.next() {
            let what = match item.role {
                Role::Input => "an input",
                Role::InOut => "an in/out parameter",
                _ => "a private variable",
            };
            let message = format!("`{}` is {what} of the DFB, which is not visible outside of it", uses.object.text);
            sink.report(first.site(), message)
                .related(Site { unit, anchor: item.anchor }, "declared here")
                .related_all(uses_outside.map(|it| (it.site(), format!("also {} here", it.mode.verb()))));
        }
    }
}

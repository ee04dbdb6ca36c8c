//! N004: a symbol whose object the program never uses.

use crate::analysis::Site;
use crate::analysis::used::Used;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Footprint};
use crate::model::symbols::key;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if !program.complete || !program.units.iter().any(|it| it.symbols.iter().any(|it| it.object.is_some())) {
        return;
    }
    let used = Used::new(program);
    for (unit, facts) in (0..).zip(&program.units) {
        for symbol in &facts.symbols {
            // Code that goes by a symbol with two objects is resolved to neither.
            let by_name = Footprint::new(Area::Symbol(key(&symbol.name)), 0, 1);
            let Some(object) = symbol.object.as_ref() else { continue };
            if used.has_block(&object.footprint.area) {
                continue;
            }
            let raises = cx.settings.events().iter().filter_map(|it| it.trigger.as_ref());
            let is_trigger = raises.into_iter().any(|it| it.get_ref().0.footprint.overlaps(&object.footprint));
            if is_trigger || used.covers(&object.footprint) || used.covers(&by_name) {
                continue;
            }
            let message = format!("the program does not use `{}`, the symbol of `{}`", symbol.name, object.text);
            sink.report(Site { unit, anchor: symbol.anchor }, message)
                .note("this assumes that no operator panel, other station or tool uses it");
        }
    }
}

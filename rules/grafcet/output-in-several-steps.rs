//! G022: an output driven in the actions of several steps.

use crate::analysis::Site;
use crate::analysis::coactive;
use crate::analysis::processing::{is_stored, raised_by_several};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::object::{Class, Type};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in &cx.program.objects {
        if uses.object.class != Class::Output || uses.object.ty != Type::Bool {
            continue;
        }
        let Some(several) = raised_by_several(cx.program, uses) else { continue };
        // Of steps that are active together, that is a mistake by itself.
        if coactive::assigned(cx.program, || cx.studies(), uses).is_some() {
            continue;
        }
        let Some((second, action)) = several.places.get(several.second) else { continue };
        let others = several.places.iter().enumerate().filter(|it| it.0 != several.second);
        let others = others
            .map(|(_, (it, action))| (it.site(), format!("also {} here, in {}", it.mode.verb(), action.describe())));
        let message = format!("`{}` is driven in the actions of several steps", uses.object.text);
        let report = sink.report(second.site(), message).label(format!("in {}", action.describe())).related_all(others);
        // What is set and reset keeps its value on purpose: it is only that nobody sees when it is 1.
        if several.places.iter().all(|it| is_stored(&it.0)) {
            report.severity(Severity::Advice);
        }
    }
}

//! F014: an actual of an in/out or output of a DFB that no program can write.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Rights;
use crate::model::unit::Given;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (call, _, unit, interface) in cx.program.instance_calls() {
        for actual in &call.it.actuals {
            let Some(item) = interface.parameter(actual.slot).filter(|it| it.role.is_written()) else { continue };
            let (what, source) = match actual.given {
                Given::Constant(_) => ("a constant".to_owned(), None),
                Given::Expression(_) => ("an expression".to_owned(), None),
                Given::Object(_) => {
                    let Some(object) = cx.program.given_object(call.unit, actual) else { continue };
                    let Rights::ReadOnly(source) = object.rights else { continue };
                    (format!("`{}`, which a program cannot write", object.text), Some(source))
                }
                Given::Wire | Given::Unknown => continue,
            };
            let message = format!("the {} `{}` of `{}` is given {what}", item.role.describe(), item.name, call.it.text);
            let finding = sink
                .report(Site { unit: call.unit, anchor: actual.anchor }, message)
                .related(Site { unit, anchor: item.anchor }, "the parameter");
            if let Some(source) = source {
                finding.note(format!("not writable according to {source}"));
            }
        }
    }
}

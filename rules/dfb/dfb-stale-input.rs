//! F019: an input of a DFB that one call leaves open and another gives.

use std::collections::BTreeMap;

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::Role;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut calls: BTreeMap<&str, Vec<&GlobalCall<'_>>> = BTreeMap::new();
    for (call, name, ..) in cx.program.instance_calls().filter(|it| it.0.it.reachable && it.0.it.full) {
        calls.entry(name).or_default().push(call);
    }
    for (name, calls) in calls {
        let Some((unit, interface)) = cx.program.dfb_of(name) else { continue };
        // A table must be given: F013 says so.
        let inputs = (0..).zip(interface.parameters()).filter(|it| it.1.role == Role::Input && !it.1.ty.is_array());
        for (position, item) in inputs {
            let (given, open): (Vec<&GlobalCall<'_>>, Vec<&GlobalCall<'_>>) = calls
                .iter()
                .copied()
                .partition(|call| call.it.actuals.iter().any(|it| interface.position(it.slot) == Some(position)));
            let (Some(first), [call, others @ ..]) = (given.first(), &open[..]) else { continue };
            let message =
                format!("`{}` is called without its input `{}`, which keeps its last value", call.it.text, item.name);
            sink.report(call.site(), message)
                .related(first.site(), "given here")
                .related_all(others.iter().map(|it| (it.site(), "also left open here".to_owned())))
                .related(Site { unit, anchor: item.anchor }, "the input");
        }
    }
}

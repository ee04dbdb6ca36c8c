//! B003: several calls of one scan work on one instance data block.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::BlockName;
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // Calls of different blocks with one instance are another rule's affair.
    let mut by_instance: FxHashMap<(&BlockName, &Callee), Vec<&GlobalCall<'_>>> = FxHashMap::default();
    for call in &cx.program.calls {
        if let Some(instance) = call.it.instance.as_ref().filter(|_| call.it.full && call.it.reachable) {
            by_instance.entry((instance, &call.it.callee)).or_default().push(call);
        }
    }
    let mut groups: Vec<_> = by_instance.into_iter().filter(|it| it.1.len() > 1).collect();
    groups.sort_by(|a, b| a.0.cmp(&b.0));
    for ((instance, _), mut calls) in groups {
        calls.sort_by_key(|it| (cx.program.order[it.unit as usize], it.it.anchor));
        let second = (1..calls.len())
            .find(|&at| calls[..at].iter().any(|before| cx.program.calls_in_same_scan(before, calls[at])));
        let Some(second) = second else { continue };
        let others = calls.iter().enumerate().filter(|it| it.0 != second);
        sink.report(
            calls[second].instance_site(),
            format!("`{instance}` is the instance of more than one call of `{}` in a scan", calls[second].it.text),
        )
        .related_all(others.map(|(_, it)| (it.instance_site(), "also used here".to_owned())));
    }
}

//! F017: an instance of a DFB that is called in more than one place of a scan.

use std::collections::BTreeMap;

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut calls: BTreeMap<&str, Vec<&GlobalCall<'_>>> = BTreeMap::new();
    for call in cx.program.calls.iter().filter(|it| it.it.reachable) {
        if let Callee::Instance(name) = &call.it.callee
            && cx.program.dfb_of(name).is_some()
        {
            calls.entry(name).or_default().push(call);
        }
    }
    for (_, mut calls) in calls {
        calls.sort_by_key(|it| (cx.program.order[it.unit as usize], it.index));
        let Some((first, others)) = calls.split_first() else { continue };
        let mut again = others.iter().filter(|it| cx.program.calls_in_same_scan(first, it));
        if let Some(second) = again.next() {
            sink.report(second.site(), format!("`{}` is called in more than one place of a scan", second.it.text))
                .label("called again here, with the values that the call before left")
                .related(first.site(), "called here")
                .related_all(again.map(|it| (it.site(), "also called here".to_owned())));
        }
    }
}

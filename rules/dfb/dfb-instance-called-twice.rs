//! F017: an instance of a DFB that is called in more than one place of a scan.

use std::collections::BTreeMap;

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};

/// Of more calls of one instance, only so many are compared.
const MAX_COMPARED: usize = 64;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut calls: BTreeMap<&str, Vec<&GlobalCall<'_>>> = BTreeMap::new();
    for (call, name, ..) in cx.program.instance_calls().filter(|it| it.0.it.reachable) {
        calls.entry(name).or_default().push(call);
    }
    for (_, mut calls) in calls {
        calls.sort_by_key(|it| (cx.program.order[it.unit as usize], it.index));
        calls.truncate(MAX_COMPARED);
        let meets = |at: usize, other: usize| at != other && cx.program.calls_in_same_scan(calls[at], calls[other]);
        // The first call that some call before it can share a scan with.
        let Some(second) = (1..calls.len()).find(|&at| (0..at).any(|before| meets(before, at))) else { continue };
        let call = calls[second];
        let (before, after): (Vec<usize>, Vec<usize>) =
            (0..calls.len()).filter(|&it| meets(second, it)).partition(|it| *it < second);
        sink.report(call.site(), format!("`{}` is called in more than one place of a scan", call.it.text))
            .label("called again here, with the values that the call before left")
            .related_all(before.iter().map(|&it| (calls[it].site(), "called here".to_owned())))
            .related_all(after.iter().map(|&it| (calls[it].site(), "also called here".to_owned())));
    }
}

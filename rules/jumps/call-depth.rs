//! J010: calls nested deeper than the controller allows.

use crate::analysis::calls;
use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(limit) = cx.target.call_depth() else { return };
    for chain in calls::too_deep(cx.program, limit.value) {
        let chain: Vec<_> = chain.iter().filter_map(|&it| cx.program.calls.get(it as usize)).collect();
        let Some((last, before)) = chain.split_last() else { continue };
        let message = format!("the call of `{}` nests {} deep: {} at most", last.it.text, chain.len(), limit.value);
        let steps = (1..).zip(before);
        sink.report(last.site(), message)
            .related_all(steps.map(|(depth, it)| (it.site(), format!("level {depth}: `{}`", it.it.text))))
            .note(format!("the depth is given in {}", limit.source));
    }
}

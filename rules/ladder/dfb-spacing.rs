//! L008: two DFBs in series with too little room between them.

use crate::analysis::Site;
use crate::analysis::program::GlobalCall;
use crate::lint::{ProgramCx, Sink};
use crate::target::pl7::DFB_GAP;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    // A symbol may name a standard block.
    let is_dfb = |it: &GlobalCall<'_>| !cx.program.names_address(&it.it.text);
    for (at, call) in cx.program.calls.iter().enumerate() {
        // The calls of a unit stand together, in their order.
        let Some(distance) = call.it.too_close.and_then(|it| call.index.checked_sub(it)) else { continue };
        let before = at.checked_sub(distance as usize).and_then(|it| cx.program.calls.get(it));
        let Some(before) = before.filter(|it| is_dfb(it) && is_dfb(call)) else { continue };
        let message =
            format!("`{}` stands less than {} columns behind `{}`", call.it.text, DFB_GAP.value, before.it.text);
        sink.report(call.site(), message).related(before.site(), "wired to this one");
    }
}

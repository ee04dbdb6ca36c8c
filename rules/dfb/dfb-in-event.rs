//! F011: a DFB that is called in an event task.

use crate::analysis::Site;
use crate::analysis::program::Context;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (call, ..) in cx.program.instance_calls() {
        let event = cx.program.tasks(call.unit).find(|it| matches!(it, Context::Event(_)));
        if let Some(Context::Event(number)) = event {
            let message = format!("`{}` is a DFB, which the event task EVT{number} cannot call", call.it.text);
            sink.report(call.site(), message);
        }
    }
}

//! C002: a duration that a timer of STEP 7 cuts off.

use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx};
use crate::model::literal::{S5TIME_MAX_MS, Value, s5time_encoding, s5time_text};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for constant in &cx.model.constants {
        let Value::S5Time { milliseconds } = constant.value else { continue };
        let encoding = s5time_encoding(milliseconds);
        if encoding.represented_ms == milliseconds || milliseconds > S5TIME_MAX_MS {
            continue;
        }
        let real = s5time_text(encoding.represented_ms);
        sink.report(constant.range, format!("`{}` is really `{real}`", constant.text))
            .note(format!("a timer counts {} times {} ms here", encoding.count, encoding.base_ms))
            .replace(format!("Write `{real}`"), Applicability::Safe, constant.range, real);
    }
}

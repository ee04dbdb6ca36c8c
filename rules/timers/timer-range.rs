//! C001: a duration that no timer of STEP 7 can hold.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::Expr;
use crate::model::literal;
use crate::model::unit::{OddityKind, Pin, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        if let OddityKind::Literal(error) = &oddity.kind
            && error.is_s5time
        {
            sink.report(oddity.range, error.message.clone());
        }
    }
    for statement in &cx.model.statements {
        let StatementKind::Drive { access, pin: Pin::Start, value: Some(value), .. } = statement.kind else { continue };
        let Expr::Int(number) = *cx.model.exprs.get(value) else { continue };
        // The timer reads the low word of the accumulator.
        let word = u16::try_from(number & 0xFFFF).unwrap_or_default();
        if literal::s5time_from_word(word).is_none()
            && let Some(access) = cx.model.accesses.get(access as usize)
        {
            let timer = &cx.model.object(access.object).text;
            sink.report(
                cx.model.place(access.anchor),
                format!("`{timer}` starts with `W#16#{word:04X}`, whose last three digits are not all decimal"),
            );
        }
    }
}

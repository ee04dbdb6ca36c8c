//! V002: a preset that the timer or counter cannot hold.

use rowan::TextRange;

use crate::analysis::counts;
use crate::lint::{Sink, UnitCx};
use crate::model::entity::Family;
use crate::model::expr::Expr;
use crate::model::literal;
use crate::model::object::{Class, Object, pl7, pl72};
use crate::model::unit::{Pin, StatementKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for statement in &cx.model.statements {
        let (access, value) = match statement.kind {
            StatementKind::Store { access, value } => (access, value),
            StatementKind::Drive { access, pin: Pin::Preset, value: Some(value), .. } => (access, value),
            _ => continue,
        };
        let Expr::Int(value) = *cx.model.exprs.get(value) else { continue };
        let Some(access) = cx.model.accesses.get(access as usize) else { continue };
        let object = cx.model.object(access.object);
        let wrong = match statement.kind {
            StatementKind::Store { .. } => stored(cx, object, value),
            _ => loaded(cx, object, value),
        };
        if let Some(message) = wrong {
            sink.report(cx.model.place(access.anchor), message);
        }
    }
}

/// `%TM0.P := 10000`.
fn stored(cx: &UnitCx<'_>, object: &Object, value: i64) -> Option<String> {
    let (family, is_preset) = match cx.model.language.is_pl7_2() {
        true => (Family::Pl72, pl72::is_preset(object)),
        false => (Family::Pl7, pl7::is_preset(object)),
    };
    if !is_preset {
        return None;
    }
    let (what, _) = counts::number(family, object)?;
    let range = cx.target.preset(what)?;
    let fits = u32::try_from(value).is_ok_and(|it| range.contains(it));
    let message = || format!("`{}` takes {value}, and a preset is {} to {}", object.text, range.first, range.last);
    (!fits).then(message)
}

/// `L 1000`, `S Z 1`: the counter reads three decimal digits of the low word. What `C#` says is judged as a constant.
fn loaded(cx: &UnitCx<'_>, object: &Object, value: i64) -> Option<String> {
    if object.class != Class::Counter {
        return None;
    }
    let (what, _) = counts::number(cx.target.family(), object)?;
    let range = cx.target.preset(what)?;
    // A count that fits is taken as one: the model does not tell `C#250` from `250`.
    let counts = u32::try_from(value).is_ok_and(|it| range.contains(it));
    let word = u16::try_from(value & 0xFFFF).unwrap_or_default();
    let message = || {
        let (text, first, last) = (&object.text, range.first, range.last);
        format!(
            "`{text}` is preset with {value} (`W#16#{word:04X}`), and takes three decimal digits, {first} to {last}"
        )
    };
    (!counts && literal::s5time_from_word(word).is_none()).then(message)
}

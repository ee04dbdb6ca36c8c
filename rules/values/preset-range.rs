//! V002: a preset that the timer or counter cannot hold.

use crate::analysis::Site;
use crate::analysis::counts;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::model::literal;
use crate::model::object::{Class, Object, pl7, pl72};
use crate::model::unit::{Mode, Pin};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for object in &cx.program.objects {
        for it in object.with_mode(|it| matches!(it, Mode::Store | Mode::Drive(Pin::Preset))) {
            let Some(value) = it.it.constant() else { continue };
            let units = cx.program.units.get(it.unit as usize);
            let Some(written) = units.and_then(|unit| unit.objects.get(it.it.object as usize)) else { continue };
            let wrong = match it.mode {
                Mode::Store => stored(cx, &written.object, value),
                _ => loaded(cx, &written.object, value),
            };
            if let Some(message) = wrong {
                sink.report(it.site(), message);
            }
        }
    }
}

/// `%TM0.P := 10000`.
fn stored(cx: &ProgramCx<'_>, object: &Object, value: i64) -> Option<String> {
    let family = cx.program.family;
    let is_preset = match family {
        Family::Pl7 => pl7::is_preset(object),
        Family::Pl72 => pl72::is_preset(object),
        Family::Step5 | Family::Step7 => false,
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
fn loaded(cx: &ProgramCx<'_>, object: &Object, value: i64) -> Option<String> {
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

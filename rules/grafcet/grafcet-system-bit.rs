//! G013: a system bit that commands charts, written where or how it must not be.

use crate::analysis::Site;
use crate::analysis::processing::{Preliminary, is_reset};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::object::{Area, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(chart) = cx.target.chart_bits() else { return };
    let preliminary = Preliminary::new(cx.program);
    for uses in &cx.program.objects {
        let place = &uses.object.footprint;
        let is_bit = place.area == Area::SystemBits && uses.object.ty == Type::Bool && uses.object.is_fixed();
        if !is_bit || !chart.bits.contains(place.start) {
            continue;
        }
        let cleared = chart.cleared.iter().find(|it| it.bit == place.start);
        for it in uses.with_mode(|it| it.writes() && it != Mode::InOut) {
            let (text, verb) = (cx.program.text_of(it), it.mode.verb());
            if let Some(cleared) = cleared.filter(|_| is_reset(it)) {
                let note = format!("the system resets it, according to {}", cleared.source);
                if cleared.is_forbidden {
                    sink.report(it.site(), format!("`{text}` is reset by the program, which must not do so"))
                        .note(note);
                } else {
                    sink.report(it.site(), format!("`{text}` is reset by the program, which need not do so"))
                        .severity(Severity::Warning)
                        .note(note);
                }
            } else if let Some(outside) = preliminary.outside(it.unit) {
                let part = cx.program.entity(outside.entry);
                sink.report(it.site(), format!("`{text}` is {verb} outside the preliminary processing of the chart"))
                    .related_all(outside.call.map(|call| (call, format!("`{part}` calls the subroutine here"))));
            } else if let Some(source) = chart.only_set.filter(|_| !matches!(it.mode, Mode::Set | Mode::Write)) {
                sink.report(it.site(), format!("`{text}` is {verb}, and only set coils may write it"))
                    .note(format!("the rule is given in {source}"));
            }
        }
    }
}

//! F016: a DFB where there are none, or in a language that has none.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::Language;
use crate::target::pl7::Series;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = &cx.model.interface else { return };
    let place = cx.model.place(interface.anchor);
    if let Some(it) = cx.target.processor().filter(|it| it.series == Series::Micro) {
        sink.report(place, format!("the {} has no DFBs", it.name)).note("only Premium controllers run them (PL7:5304)");
    } else if cx.model.language == Language::Pl7Il {
        sink.report(place, "the code of a DFB is structured text or ladder, not a list of instructions");
    }
}

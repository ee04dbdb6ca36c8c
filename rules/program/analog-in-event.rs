//! P005: an analog input of a Micro, outside the master task.

use crate::analysis::Site;
use crate::analysis::program::{Context, GlobalUse};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Object, Type};
use crate::model::unit::Mode;
use crate::target::pl7::Series;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if !cx.target.processor().is_some_and(|it| it.series == Series::Micro) {
        return;
    }
    for uses in cx.program.objects.iter().filter(|it| is_analog(it.object)) {
        let task = |it: &GlobalUse<'_>| cx.program.tasks(it.unit).find(|it| *it != Context::Cyclic);
        let mut reads = uses.with_mode(Mode::reads).filter_map(|it| Some((it, task(it)?)));
        let Some((first, task)) = reads.next() else { continue };
        let (name, task) = (&uses.object.text, task.name(cx.program.family));
        sink.report(first.site(), format!("`{name}` is read in {task}, and analog inputs of a Micro belong to MAST"))
            .related_all(reads.map(|it| (it.0.site(), "also here".to_owned())))
            .note("this assumes that the module is one of analog inputs");
    }
}

/// `%IW3.0`: the value of a channel. Words with a rank, double words and bits of words are those of counters and states.
fn is_analog(object: &Object) -> bool {
    let is_word = object.class == Class::Input && object.ty == Type::Word && !object.extracted && !object.indexed;
    is_word && matches!(object.footprint.area, Area::ModuleWords(_)) && object.text.matches('.').count() == 1
}

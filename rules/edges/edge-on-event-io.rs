//! E004: the edge of an input or output that an event exchanges, in the master or fast task.

use crate::analysis::Site;
use crate::analysis::channels::Group;
use crate::analysis::program::{Context, GlobalUse};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object, Type};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if !program.has_events() {
        return;
    }
    let event = |it: &GlobalUse<'_>| program.tasks(it.unit).find(|it| matches!(it, Context::Event(_)));
    let channels = program.objects_that(|it| matches!(it, Class::Input | Class::Output), |_| true);
    let mut exchanged: Vec<(Group<'_>, &Object, GlobalUse<'_>)> = Vec::new();
    for uses in &channels {
        // An output is exchanged when the event writes it, an input when it reads it.
        let is_output = uses.object.class == Class::Output;
        let first = uses.uses.iter().find(|it| event(it).is_some() && (!is_output || it.mode.writes()));
        exchanged.extend(first.into_iter().flat_map(|it| Group::all_of(uses.object).map(|g| (g, uses.object, *it))));
    }
    for uses in channels.iter().filter(|it| it.has_mode(Mode::is_edge) && it.object.ty == Type::Bool) {
        let in_task =
            |it: &&GlobalUse<'_>| program.tasks(it.unit).any(|it| matches!(it, Context::Cyclic | Context::Fast));
        let Some(edge) = uses.with_mode(Mode::is_edge).find(in_task) else { continue };
        let (name, group) = (&uses.object.text, Group::all_of(uses.object).next());
        let same = |it: &&(Group<'_>, &Object, GlobalUse<'_>)| Some(it.0) == group;
        // The bit itself rather than its neighbour.
        let by_event = exchanged.iter().filter(same).max_by_key(|it| it.1.footprint.overlaps(&uses.object.footprint));
        if let Some((group, other, it)) = by_event {
            let task = event(it).map(|it| it.name(program.family)).unwrap_or_default();
            let (first, last) = group.channels();
            let message = format!("the edge of `{name}` is tested, which {task} exchanges, too");
            let finding =
                sink.report(edge.site(), message).related(it.site(), format!("`{}` is used here", other.text));
            if !other.footprint.overlaps(&uses.object.footprint) {
                finding.note(format!("channels {first} to {last} of the module are exchanged together (PL7:2502)"));
            }
        } else if let Some(number) = raised_by(cx, uses.object) {
            sink.report(edge.site(), format!("the edge of `{name}` is tested, which EVT{number} exchanges, too"))
                .related_all(cx.settings.trigger_site(number).map(|it| (it, format!("`{name}` raises EVT{number}"))));
        }
    }
}

/// The event of the program that the channel of an input raises, which has it read (PL7:2468).
fn raised_by(cx: &ProgramCx<'_>, input: &Object) -> Option<u16> {
    if cx.settings.events().is_empty() {
        return None;
    }
    let events = (0..).take(cx.program.units.len()).flat_map(|it| cx.program.tasks(it)).filter_map(|it| match it {
        Context::Event(number) => Some(number),
        _ => None,
    });
    let mut raised =
        events.filter(|&it| cx.settings.trigger_of(it).is_some_and(|it| it.footprint.overlaps(&input.footprint)));
    raised.next()
}

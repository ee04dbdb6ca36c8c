//! T007: an index that leads out of the area of its object.

use crate::analysis::Site;
use crate::analysis::counts::Ends;
use crate::analysis::ranges::demands::{self, Room, Unmet};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::target::{CountedBy, Target};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if cx.program.family != Family::Pl7 {
        return;
    }
    let ends = Ends::new(cx.target);
    let room = |it: &Unmet<'_>| Room::new(it.object()?, &ends);
    let mut found =
        demands::unmet(cx.program, |facts, it| Room::new(demands::indexed(facts, it)?, &ends).map(|it| it.accepted()));
    // What one loop, store or guard does to several accesses is one finding.
    let cause = |it: &Unmet<'_>| (it.site.unit, it.it.object, it.it.span.by, it.number);
    found.sort_by_key(|it| (cause(it), it.site.anchor));
    for group in found.chunk_by(|a, b| a.it.object.is_some() && cause(a) == cause(b)) {
        let Some((first, others)) = group.split_first() else { continue };
        let (Some(object), Some(room)) = (first.object(), room(first)) else { continue };
        let with = match first.name() {
            Some(name) => format!("when `{name}` is {}", first.number),
            None => format!("with {}", first.number),
        };
        let verb = if first.always { "leads" } else { "can lead" };
        let message = format!(
            "the index {verb} out of the area: {with}, `{}` is number {}",
            object.text,
            room.reached(first.number)
        );
        let report = sink
            .report(first.site, message)
            .related_all(first.because.iter().cloned())
            .related_all(others.iter().map(|it| (it.site, "so it does here".to_owned())))
            .note(last(&room, cx.target))
            .note("the controller sets `%S20` and takes the object without its index (PL7:1134-1143)");
        if first.assumes_writes {
            report.note("assumed: no terminal, operator panel or message writes the index");
        }
    }
}

/// Which numbers there are, and who says so.
fn last(room: &Room, target: &Target) -> String {
    let number = room.count.value.saturating_sub(1);
    let what = match room.what.and_then(|it| target.numbered(it)) {
        Some(it) => format!("{} are `{}0` to `{}{number}`", it.plural, it.prefix, it.prefix),
        None => format!("the channels of a module are numbers 0 to {number}"),
    };
    match room.count.by {
        CountedBy::Configuration => format!("{what}, as the configuration says"),
        CountedBy::Controller(name) => format!("{what} on a {name} ({})", room.count.source),
        CountedBy::Family => format!("{what} at most ({})", room.count.source),
    }
}

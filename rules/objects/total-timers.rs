//! O004: more timers of both kinds together than the controller has.

use crate::analysis::{Site, counts};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::Class;
use crate::target::{Counted, CountedBy};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(most) = cx.target.all_timers() else { return };
    let is_block = |it: Class| matches!(it, Class::Block | Class::BlockBit | Class::BlockWord);
    // A number that is too high by itself has a rule of its own.
    let taken = |what| counts::taken(cx.program.family, cx.program.places(is_block), cx.target, what);
    let (Some(new), Some(old)) = (taken(Counted::Timers), taken(Counted::OldTimers)) else { return };
    let total = new.saturating_add(old);
    if total <= most.value {
        return;
    }
    let timers = cx.program.those(is_block, |_| true);
    let numbers = counts::numbers(&timers);
    let highest = |what| counts::highest(&numbers, cx.target, what);
    let (Some(timer), Some(old)) = (highest(Counted::Timers), highest(Counted::OldTimers)) else { return };
    let (Some(at), Some(other)) = (old.uses.first(), timer.uses.first()) else { return };
    let has = match most.by {
        CountedBy::Controller(name) => format!("a {name} has {} together", most.value),
        CountedBy::Configuration | CountedBy::Family => format!("no controller has more than {} together", most.value),
    };
    let (text, other_text) = (counts::name(old.object), counts::name(timer.object));
    sink.report(at.site(), format!("`{other_text}` and `{text}` take {total} timers, and {has}"))
        .related(other.site(), format!("`{other_text}` takes {new} of them"))
        .note(format!(
            "blocks are counted from 0 up to the highest number used; the limit is given in {}",
            most.source
        ));
}

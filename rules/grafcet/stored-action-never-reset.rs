//! G011: a bit that the action of a step leaves at 1, and that nothing resets.

use crate::analysis::Site;
use crate::analysis::processing::{InAction, is_stored, may_raise};
use crate::analysis::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.known_bits() {
        let Some(raised) = Raised::new(cx.program, uses) else { continue };
        if cx.program.unseen(uses).may_give(Mode::Reset) {
            continue;
        }
        let (place, action) = &raised.first;
        let (text, steps) = (&uses.object.text, action.describe());
        let message = if is_stored(place) {
            format!("`{text}` is set in an action of {steps}, and nothing resets it")
        } else {
            format!("`{text}` keeps the last value that an action of {steps} gives it, and nothing resets it")
        };
        sink.report(place.site(), message)
            .related_all(raised.others.iter().map(|it| (it.site(), format!("also {} here", it.mode.verb()))))
            .note("this assumes that no operator panel or other station writes the bit");
    }
}

/// The places that make a bit 1, where nothing makes it 0.
struct Raised<'a> {
    /// The first in an action.
    first: (GlobalUse<'a>, InAction<'a>),
    others: Vec<GlobalUse<'a>>,
}

impl<'a> Raised<'a> {
    fn new(program: &ProgramIndex<'a>, uses: &ObjectUses<'a>) -> Option<Self> {
        let mut first: Option<(GlobalUse<'a>, InAction<'a>)> = None;
        let mut others = Vec::new();
        let (mut is_computed, mut is_of_one_step) = (false, true);
        for it in uses.with_mode(|it| it.writes() || matches!(it, Mode::Drive(_))) {
            let action = InAction::of(program, it);
            let stays = match it.mode {
                Mode::Set => !it.it.own && (action.is_some() || it.it.conditional || program.is_in_event(it.unit)),
                Mode::Assign | Mode::AssignNot if it.it.constant().is_some() => may_raise(it),
                // Its last value stays when the step is left.
                Mode::Assign | Mode::AssignNot => {
                    is_computed = true;
                    it.it.of_bits && action.is_some_and(|it| it.is_continuous_of_one_step())
                }
                _ => false,
            };
            if !stays {
                return None;
            }
            is_of_one_step &= action.is_some_and(|it| first.as_ref().is_none_or(|first| first.1.has_steps_of(&it)));
            match action {
                Some(action) if first.is_none() => first = Some((*it, action)),
                _ => others.push(*it),
            }
        }
        // What one step computes may be what ends that which another began.
        (is_of_one_step || !is_computed).then_some(Self { first: first?, others })
    }
}

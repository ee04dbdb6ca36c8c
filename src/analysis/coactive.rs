//! Bits that actions of steps which are active together assign.

use super::drives;
use super::processing::InAction;
use super::program::{GlobalUse, ObjectUses, ProgramIndex};
use super::reach::Study;
use crate::model::unit::Mode;

/// Two assignments in the actions of steps that are active together, of which the later one overrides the other.
pub struct Coactive<'a> {
    pub first: (GlobalUse<'a>, InAction<'a>),
    pub second: (GlobalUse<'a>, InAction<'a>),
    /// How the chart comes to a situation with both steps: `0 -> 1 -> 3,4`.
    pub trace: String,
}

/// The first of them, for a bit that nothing but assignments drives. A situation counts when the chart surely reaches it, by
/// some values of what its receptivities ask; what no such situation shows is not known, and is none.
pub fn assigned<'a, 's, 'p: 's>(
    program: &ProgramIndex<'a>,
    studies: impl Fn() -> &'s [Study<'p, 'p>],
    uses: &ObjectUses<'a>,
) -> Option<Coactive<'a>> {
    /// Of more places, only so many are compared.
    const MOST: usize = 64;
    if uses.has_mode(|it| matches!(it, Mode::Set | Mode::Reset) || it.is_edge()) || !uses.object.is_fixed() {
        return None;
    }
    let mut writes: Vec<GlobalUse<'a>> = uses.with_mode(Mode::assigns).copied().collect();
    drives::in_order(program, &mut writes);
    // What is done when a step goes off is undone while another one goes on: the other one's own action says so.
    let places: Vec<(GlobalUse<'a>, InAction<'a>)> = writes
        .into_iter()
        .filter_map(|it| Some((it, InAction::of(program, &it)?)))
        .filter(|it| !it.1.is_at_end())
        .take(MOST)
        .collect();
    for (at, second) in places.iter().enumerate() {
        for first in &places[..at] {
            // An action at activation runs once: only one that goes on overrides, or is overridden, for certain.
            let goes_on = first.1.is_continuous() || second.1.is_continuous();
            if !goes_on || first.1.has_steps_of(&second.1) || !drives::override_each_other(&first.0, &second.0) {
                continue;
            }
            if let Some(trace) = studies().iter().find_map(|it| together(program, it, first, second)) {
                return Some(Coactive { first: *first, second: *second, trace });
            }
        }
    }
    None
}

fn together(
    program: &ProgramIndex<'_>,
    study: &Study<'_, '_>,
    first: &(GlobalUse<'_>, InAction<'_>),
    second: &(GlobalUse<'_>, InAction<'_>),
) -> Option<String> {
    let nodes = |it: &(GlobalUse<'_>, InAction<'_>)| it.1.nodes(program, it.0.unit, &study.net);
    let (a, b) = (nodes(first), nodes(second));
    study.parts.iter().find_map(|part| {
        let (situation, _) = part.active_together(&a, &b)?;
        Some(study.net.trace(&part.component, &part.own, situation))
    })
}

//! G001: alternative branches of a chart that can be taken together.

use crate::analysis::Site;
use crate::analysis::conditions::{self, Answer, Witness};
use crate::analysis::priority;
use crate::analysis::reach::{Part, Study};

use crate::lint::{Applicability, Edit, ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for it in cx.studies() {
        study(it, |_, _| true, sink);
    }
}

/// `compare`: which pairs of transitions are looked at, the earlier first.
pub(super) fn study(study: &Study<'_, '_>, compare: impl Fn(usize, usize) -> bool, sink: &mut Sink<'_, Site>) {
    for part in &study.parts {
        for &later in &part.component.crossings {
            divergence(study, part, later, &compare, sink);
        }
    }
}

/// Compares a transition with those before it that leave the same step.
fn divergence(
    study: &Study<'_, '_>,
    part: &Part,
    later: usize,
    compare: &impl Fn(usize, usize) -> bool,
    sink: &mut Sink<'_, Site>,
) {
    /// Of more branches than this, those before the first ones are not compared.
    const MOST: usize = 32;
    let net = &study.net;
    let from = &net.crossings[later].from;
    let mut beside: Vec<usize> =
        from.iter().flat_map(|it| net.leaving(*it).iter().copied().take_while(|it| *it < later).take(MOST)).collect();
    beside.sort_unstable();
    beside.dedup();
    let found: Vec<(usize, Witness)> = beside
        .into_iter()
        .filter(|it| compare(*it, later))
        .filter_map(|it| match study.can_be(part, &[(it, true), (later, true)]) {
            Answer::Possible(witness) => Some((it, witness)),
            Answer::Never | Answer::NotDecided => None,
        })
        .collect();
    let Some((first, witness)) = found.first() else { return };
    let Some(&step) = net.crossings[*first].from.iter().find(|it| from.contains(it)) else { return };
    // Branches behind two steps of one number: that is the mistake, and the affair of the rules about numbers.
    if net.is_drawn_twice(step) {
        return;
    }
    let space = net.space();
    let values: Vec<String> = witness.given.iter().map(|it| space.describe(it)).collect();
    let when = conditions::when(&values);
    let mut finding = sink
        .report(
            net.transition(later).site(),
            format!("two branches behind step `{}` are taken together {when}", net.name(step)),
        )
        .label("this branch")
        .related_all(found.iter().map(|(it, _)| (net.transition(*it).site(), "and this one".to_owned())))
        .related(net.step(step).site(), "the step that they leave")
        .notes(conditions::besides(&values));
    if witness.assumed {
        finding = finding.note("values that are compared with one another, or computed, were taken as free");
    }
    let others: Vec<usize> = found.iter().map(|it| it.0).collect();
    if let Some(edits) = priority::give_way(net, later, &others) {
        let edits = edits.into_iter().map(|(place, replacement)| Edit { place, replacement }).collect();
        finding = finding.fix("Give the branches before it priority", Applicability::Unsafe, edits);
    }
    finding.note("branches of a divergence exclude each other when each asks that those before it are not taken");
}

//! Q004: a branch that takes the step away from the branches after it.

use crate::analysis::Site;
use crate::analysis::sequences::judge::DeviationKind;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for sequence in &cx.sequences().list {
        let mut seen: Vec<usize> = Vec::new();
        for found in sequence.deviations.iter().filter(|it| it.kind == DeviationKind::Shadowed) {
            let event = sequence.transitions[found.first].found.reset_of(found.step);
            let Some(reset) = event.and_then(|it| cx.sequences().event(it)) else { continue };
            if seen.contains(&found.step) {
                continue;
            }
            seen.push(found.step);
            let (first, second) = (&sequence.transitions[found.first], &sequence.transitions[found.second]);
            let (taken, left) = (sequence.names(&first.found.targets), sequence.names(&second.found.targets));
            let step = sequence.name(found.step);
            let message = format!("the branch from `{step}` to {left} is not taken {}", found.when());
            sink.report(reset.site, message)
                .label(format!("resets `{step}` before that branch is tested"))
                .related(second.site(), format!("the branch to {left}, which the rules cross too (rule 4)"))
                .note(format!("the branch to {taken} comes first in the scan; if it is to have priority, say so in the condition of the other one"))
                .notes(found.besides())
                .note(sequence.note(found.step));
        }
    }
}

//! Q001: a step of a sequence coded by set and reset that goes on and off within one scan.

use crate::analysis::Site;
use crate::analysis::sequences::judge::{Deviation, DeviationKind};
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for sequence in &cx.sequences().list {
        let skipped = |it: &&Deviation| it.kind == DeviationKind::Skipped;
        let found: Vec<&Deviation> = sequence.deviations.iter().filter(skipped).collect();
        let Some(first) = found.first() else { continue };
        let step = sequence.name(first.step);
        let place = |it: &Deviation| cx.sequences().reset_of(sequence, it);
        let mut seen = vec![first.step];
        let others = found.iter().filter(|it| {
            let is_new = !seen.contains(&it.step);
            seen.push(it.step);
            is_new
        });
        let others: Vec<(Site, String)> = others
            .filter_map(|it| Some((place(it)?, format!("so is `{}`, {}", sequence.name(it.step), it.when()))))
            .collect();
        let Some(reset) = place(first) else { continue };
        let mut finding = sink
            .report(reset, format!("step `{step}` is passed within one scan {}", first.when()))
            .label(format!("switches `{step}` off in the scan that switched it on"))
            .related_all(cx.sequences().set_of(sequence, first).map(|it| (it, format!("switches `{step}` on"))))
            .related_all(others)
            .note(format!("the scan begins with {} active", sequence.names(&first.situation)))
            .notes(first.besides())
            .note(sequence.note(first.step));
        if first.assumed {
            finding = finding.note("values that are compared with one another, or computed, were taken as free");
        }
        let is_closing = found.len() == 1 && sequence.transitions.len() > 2;
        finding.note(if is_closing {
            "where the loop closes, no order of the transitions helps: let these two conditions exclude each other"
        } else {
            "written from the last transition to the first, each step stays on for a scan at least"
        });
    }
}

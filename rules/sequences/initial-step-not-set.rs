//! Q005: a sequence that nothing starts.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for sequence in cx.sequences().list.iter().filter(|it| it.starts.is_empty() && !it.has_gaps) {
        let Some(first) = sequence.steps.first() else { continue };
        let all: Vec<usize> = (0..sequence.steps.len()).collect();
        sink.report(first.site(), format!("nothing sets a first step of the sequence {}", sequence.names(&all)))
            .label("set only when another step is on")
            .related_all(sequence.steps.iter().skip(1).map(|it| (it.site(), format!("so is `{}`", it.fact.text))))
            .note("set the initial step in a start-up block, or under a start condition")
            .note("this assumes that no operator panel or other station sets one, and that no retained value is meant")
            .note(sequence.note(0));
    }
}

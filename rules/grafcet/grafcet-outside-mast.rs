//! G020: a chart, or the processing around one, in another task than MAST.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{Entity, Part, Task};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut sections: Vec<(Task, Option<&str>, Vec<u32>)> = Vec::new();
    for (unit, facts) in (0..).zip(&cx.program.units) {
        let Entity::Pl7 { task, section, part } = &facts.entity else { continue };
        let is_chart = matches!(part, Part::Preliminary | Part::Chart(_) | Part::Posterior);
        // Which task a number stands for is not known.
        if !is_chart || !matches!(task, Task::Fast | Task::Event(_)) {
            continue;
        }
        let section = section.as_deref();
        match sections.iter_mut().find(|it| (it.0, it.1) == (*task, section)) {
            Some(it) => it.2.push(unit),
            None => sections.push((*task, section, vec![unit])),
        }
    }
    for (task, section, units) in sections {
        let Some((first, others)) = units.split_first() else { continue };
        let what = section.map_or_else(|| "a Grafcet section".to_owned(), |it| format!("the Grafcet section `{it}`"));
        sink.report(ProgramIndex::heading(*first), format!("{what} is in {task}, and only MAST has charts"))
            .related_all(others.iter().map(|&it| (ProgramIndex::heading(it), "also part of it".to_owned())));
    }
}

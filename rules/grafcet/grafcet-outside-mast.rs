//! G020: a chart, or the processing around one, in another task than MAST.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{Entity, Part, Task};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut sections: Vec<(Task, Option<&str>, Vec<u32>)> = Vec::new();
    let mut known: FxHashMap<(Task, Option<&str>), usize> = FxHashMap::default();
    for (unit, facts) in (0..).zip(&cx.program.units) {
        let Entity::Pl7 { task, section, part } = &facts.entity else { continue };
        let is_chart = matches!(part, Part::Preliminary | Part::Chart(_) | Part::Posterior);
        // Which task a number stands for is not known.
        if !is_chart || !matches!(task, Task::Fast | Task::Event(_)) {
            continue;
        }
        let section = section.as_deref();
        let at = *known.entry((*task, section)).or_insert(sections.len());
        if at == sections.len() {
            sections.push((*task, section, Vec::new()));
        }
        sections[at].2.push(unit);
    }
    for (task, section, units) in sections {
        let Some((first, others)) = units.split_first() else { continue };
        let what = section.map_or_else(|| "a Grafcet section".to_owned(), |it| format!("the Grafcet section `{it}`"));
        sink.report(ProgramIndex::heading(*first), format!("{what} is in {task}, and only MAST has charts"))
            .related_all(others.iter().map(|&it| (ProgramIndex::heading(it), "also part of it".to_owned())));
    }
}

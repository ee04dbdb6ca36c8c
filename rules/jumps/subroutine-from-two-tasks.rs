//! J009: a subroutine called from a task that it does not belong to.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::program::{GlobalCall, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{Entity, Part};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let mut defined: FxHashMap<u32, u32> = FxHashMap::default();
    for number in program.units.iter().filter_map(|it| it.entity.subroutine()) {
        *defined.entry(number).or_default() += 1;
    }
    for (unit, facts) in (0_u32..).zip(&program.units) {
        let Entity::Pl7 { task: own, part: Part::Subroutine(number), .. } = facts.entity else { continue };
        // Of two subroutines of one number, which one a call means is not known.
        if defined.get(&number) != Some(&1) {
            continue;
        }
        // A caller that is a subroutine stands for its own task: what calls that one from elsewhere is another finding.
        let calls = program.callers[unit as usize].iter().filter_map(|&it| program.calls.get(it as usize));
        let calls: Vec<(&GlobalCall<'_>, _)> =
            calls.filter_map(|it| Some((it, program.entity(it.unit).task()?))).collect();
        let Some((first, task)) = calls.iter().find(|it| it.1 != own) else { continue };
        let others = calls.iter().filter(|it| it.0.site() != first.site());
        sink.report(first.site(), format!("`{}` belongs to {own} and is called in {task}", first.it.text))
            .related_all(others.map(|(it, task)| (it.site(), format!("called in {task} here"))))
            .related(ProgramIndex::heading(unit), format!("SR{number} of {own}"));
    }
}

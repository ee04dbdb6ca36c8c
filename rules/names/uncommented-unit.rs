//! N005: a section, subroutine, block or step without a comment.

use crate::analysis::Site;
use crate::analysis::chart::FactStep;
use crate::analysis::facts::UnitFacts;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::chart::StepName;
use crate::model::entity::{BlockKind, Entity, Part};
use crate::syntax::Language;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let mut before: Option<&UnitFacts> = None;
    for (unit, &facts) in (0..).zip(&cx.program.units) {
        // The comment of a section may stand in the head that an exchange file gives it.
        let is_headed = before.replace(facts).is_some_and(|it| it.entity == Entity::Container && it.commented);
        // A cross-reference shows no comments.
        if facts.language == Language::Pl7Xref {
            continue;
        }
        if let Some(chart) = facts.chart.as_ref().filter(|it| it.defines && !it.has_gaps) {
            // First and last steps of expansions have no number.
            let name = |it: &FactStep| match &it.name {
                Some(StepName::In) => "the first step".to_owned(),
                Some(StepName::Out) => "the last step".to_owned(),
                _ => format!("step `{}`", it.text),
            };
            let mut steps = chart.steps.iter().filter(|it| !it.commented);
            if let Some(first) = steps.next() {
                let site = |it: &FactStep| Site { unit, anchor: it.anchor };
                let others = steps.map(|it| (site(it), format!("nor has {}", name(it))));
                sink.report(site(first), format!("{} has no comment", name(first))).related_all(others);
            }
        } else if let Some(what) = kind(&facts.entity)
            && !facts.commented
            && !is_headed
            && !facts.has_gaps
            && !facts.is_fragment
            && facts.instructions > 0
        {
            sink.report(ProgramIndex::heading(unit), format!("this {what} has no comment"));
        }
    }
}

/// What a unit is that should say what it does.
fn kind(entity: &Entity) -> Option<&'static str> {
    Some(match entity {
        Entity::Pl7 { part: Part::Subroutine(_), .. } => "subroutine",
        Entity::Pl7 { part: Part::Main | Part::Preliminary | Part::Posterior, .. } => "section",
        Entity::Pl7 { part: Part::Event, .. } => "event",
        Entity::Dfb { .. } => "DFB",
        Entity::Block { kind, .. } if *kind == BlockKind::Ob || kind.is_callable() => "block",
        _ => return None,
    })
}

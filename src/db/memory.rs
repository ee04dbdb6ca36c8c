//! What was found out about the objects of programs, so that an edit makes judge only those that it touches.
//!
//! **Invariant:** with or without it, findings are the same. Whatever is written to the database but the text of a file
//! makes it forget all.

use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::{FxHashMap, FxHashSet};

use super::Ran;
use crate::analysis::Site;
use crate::analysis::facts::UnitFacts;
use crate::analysis::islands::Islands;
use crate::analysis::program::{ProgramIndex, Skeleton, Summary};
use crate::lint::Finding;
use crate::model::entity::Family;
use crate::target::Target;

type Key = (String, Family);

#[derive(Debug, Default)]
pub struct Memory {
    states: Mutex<FxHashMap<Key, Vec<State>>>,
}

/// Of each program, so many states are kept: one with a mistake that is being typed, one without, and some besides.
const MOST_STATES: usize = 4;

/// Findings about the objects of a program as it was once.
#[derive(Debug)]
struct State {
    target: Target,
    facts: Vec<Arc<UnitFacts>>,
    summary: Summary,
    ran: Ran<Site>,
    kept: Option<Kept>,
}

/// What makes the next step from a state a small one.
#[derive(Debug)]
struct Kept {
    islands: Islands,
    /// Of each finding, the objects at its place.
    subjects: Vec<Vec<u32>>,
}

/// From what is known to the findings about a program as it is now.
pub(super) struct Step {
    key: Key,
    target: Target,
    facts: Vec<Arc<UnitFacts>>,
    from: Option<From>,
}

struct From {
    state: State,
    kept: Kept,
    /// Units that are not what they were.
    changed: Vec<u32>,
    /// Objects to judge anew.
    moved: FxHashSet<u32>,
}

impl Memory {
    pub(super) fn forget(&self) {
        self.states.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Starts from the state that is most like the program now.
    pub(super) fn step(&self, key: Key, target: Target, facts: &[Arc<UnitFacts>], skeleton: &Skeleton<'_>) -> Step {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner).remove(&key).unwrap_or_default();
        // A drum or a text block of PL7-2 reaches memory that no use of it names (PL72:895), and programs are small.
        let is_kept = key.1 != Family::Pl72;
        let of_target = (0..).zip(&states).filter(|it| is_kept && it.1.target == target);
        let mut near: Vec<(Vec<u32>, usize)> =
            of_target.filter_map(|(at, it)| Some((it.changed(facts)?, at))).collect();
        near.sort_by_key(|it| it.0.len());
        let from = near.into_iter().find_map(|(changed, at)| {
            let (kept, moved) = states.get_mut(at)?.follow(facts, &changed, skeleton)?;
            Some(From { state: states.remove(at), kept, changed, moved })
        });
        if !states.is_empty() {
            self.states.lock().unwrap_or_else(PoisonError::into_inner).insert(key.clone(), states);
        }
        Step { key, target, facts: facts.to_vec(), from }
    }

    /// Ends a step with what was found in its part, or in the whole program. Returns all findings.
    pub(super) fn keep(&self, step: Step, ran: Ran<Site>, summary: impl FnOnce() -> Summary) -> Ran<Site> {
        let Step { key, target, facts, from } = step;
        let state = match from {
            Some(from) => from.join(facts, ran),
            None => State { target, facts, summary: summary(), ran, kept: None },
        };
        let ran = state.ran.clone();
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        let of_program = states.entry(key).or_default();
        of_program.truncate(MOST_STATES - 1);
        of_program.insert(0, state);
        ran
    }
}

impl Step {
    /// The islands to judge anew; `None` when that is the whole program.
    pub(super) fn part<'a>(&self, skeleton: &Rc<Skeleton<'a>>) -> Option<ProgramIndex<'a>> {
        let from = self.from.as_ref()?;
        Some(from.kept.islands.part(skeleton, &from.moved, &from.changed, from.state.summary.clone()))
    }
}

impl State {
    /// Units that are not what they were; `None` when one has another outline.
    fn changed(&self, facts: &[Arc<UnitFacts>]) -> Option<Vec<u32>> {
        if self.facts.len() != facts.len() {
            return None;
        }
        let mut changed = Vec::new();
        for (unit, (old, new)) in (0..).zip(self.facts.iter().zip(facts)) {
            if Arc::ptr_eq(old, new) || old == new {
                continue;
            }
            if !new.has_outline_of(old) {
                return None;
            }
            changed.push(unit);
        }
        Some(changed)
    }

    /// Goes to a program in which some units have changed: what is kept of it, and what moves. `None`, and nothing has
    /// happened, when all must be judged anew.
    fn follow(
        &mut self,
        facts: &[Arc<UnitFacts>],
        changed: &[u32],
        skeleton: &Skeleton<'_>,
    ) -> Option<(Kept, FxHashSet<u32>)> {
        let mut kept = self.kept.take().unwrap_or_else(|| {
            let old = Skeleton::new(skeleton.family, self.facts.iter().map(AsRef::as_ref).collect());
            let islands = Islands::new(&old, &self.facts);
            let subjects = self.ran.findings.iter().map(|it| islands.at(it.place)).collect();
            Kept { islands, subjects }
        });
        let of = |facts: &[Arc<UnitFacts>]| -> Vec<(u32, Arc<UnitFacts>)> {
            changed.iter().filter_map(|&it| Some((it, facts.get(it as usize)?.clone()))).collect()
        };
        let new = of(facts);
        let mut moved = kept.islands.update(skeleton, &new);
        if kept.islands.summary(skeleton) != self.summary {
            kept.islands.update(skeleton, &of(&self.facts));
            self.kept = Some(kept);
            return None;
        }
        for unit in behind_moved_calls(skeleton, &self.facts, &new) {
            moved.extend(kept.islands.used_in(unit));
        }
        kept.islands.close(&mut moved);
        Some((kept, moved))
    }
}

impl From {
    /// The state of the program now, of which `ran` was found in the part that moved.
    fn join(self, facts: Vec<Arc<UnitFacts>>, ran: Ran<Site>) -> State {
        let Self { state, kept: Kept { islands, subjects }, changed, moved } = self;
        let has_moved = |(finding, subjects): &(Finding<Site>, Vec<u32>)| match subjects[..] {
            [] => changed.contains(&finding.place.unit),
            _ => subjects.iter().any(|it| moved.contains(it)),
        };
        let unmoved = state.ran.findings.into_iter().zip(subjects).filter(|it| !has_moved(it));
        let (mut findings, mut subjects): (Vec<Finding<Site>>, Vec<Vec<u32>>) = unmoved.unzip();
        subjects.extend(ran.findings.iter().map(|it| islands.at(it.place)));
        findings.extend(ran.findings);
        let mut failed = state.ran.failed;
        failed.extend(ran.failed);
        failed.sort_unstable();
        failed.dedup();
        let ran = Ran { findings, failed };
        State { target: state.target, facts, summary: state.summary, ran, kept: Some(Kept { islands, subjects }) }
    }
}

/// Units to which calls lead that stand at other places than before: findings there may name those.
fn behind_moved_calls(
    skeleton: &Skeleton<'_>,
    old: &[Arc<UnitFacts>],
    changed: &[(u32, Arc<UnitFacts>)],
) -> FxHashSet<u32> {
    let has_moved =
        |(unit, new): &&(u32, Arc<UnitFacts>)| old.get(*unit as usize).is_some_and(|old| !new.calls_from_where(old));
    let mut open: Vec<u32> = changed.iter().filter(has_moved).map(|it| it.0).collect();
    if open.is_empty() {
        return FxHashSet::default();
    }
    let mut callees: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for call in &skeleton.calls {
        callees.entry(call.unit).or_default().extend(call.target);
    }
    let mut found = FxHashSet::default();
    while let Some(unit) = open.pop() {
        for &callee in callees.get(&unit).into_iter().flatten() {
            if found.insert(callee) {
                open.push(callee);
            }
        }
    }
    found
}

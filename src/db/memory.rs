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
use crate::analysis::outline::{Moved, Outline};
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
    outline: Outline,
    summary: Summary,
    ran: Ran<Arc<Finding<Site>>>,
    kept: Option<Kept>,
}

/// What makes the next step from a state a small one.
#[derive(Debug)]
struct Kept {
    islands: Arc<Islands>,
    /// Of each finding, the objects at its place.
    subjects: Vec<Vec<u32>>,
}

impl Kept {
    /// What is known already of a program that was judged as a whole.
    fn of(program: &ProgramIndex<'_>, ran: &Ran<Arc<Finding<Site>>>) -> Option<Self> {
        let islands = program.known()?.clone();
        let subjects = ran.findings.iter().map(|it| islands.at(it.place)).collect();
        Some(Self { islands, subjects })
    }
}

/// From what is known to the findings about a program as it is now.
pub(super) struct Step {
    key: Key,
    target: Target,
    facts: Vec<Arc<UnitFacts>>,
    outline: Outline,
    from: Option<From>,
}

struct From {
    state: State,
    kept: Kept,
    /// Units whose own objects are to be judged anew.
    units: Vec<u32>,
    /// Objects to judge anew.
    moved: FxHashSet<u32>,
}

impl Memory {
    pub(super) fn forget(&self) {
        self.states.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Starts from the state that is most like the program now.
    pub(super) fn step(&self, key: Key, target: Target, facts: &[Arc<UnitFacts>], program: &ProgramIndex<'_>) -> Step {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner).remove(&key).unwrap_or_default();
        // A drum or a text block of PL7-2 reaches memory that no use of it names (PL72:895), and programs are small.
        let is_kept = key.1 != Family::Pl72;
        let of_target = (0..).zip(&states).filter(|it| is_kept && it.1.target == target);
        let outline = Outline::new(program);
        let moved = |it: &State| it.outline.moved(&it.facts, &outline, facts);
        let mut near: Vec<(Moved, usize)> = of_target.filter_map(|(at, it)| Some((moved(it)?, at))).collect();
        near.sort_by_key(|it| it.0.units.len());
        let from = near.into_iter().find_map(|(by, at)| {
            let (kept, moved) = states.get_mut(at)?.follow(facts, &by, program)?;
            Some(From { state: states.remove(at), kept, units: by.units, moved })
        });
        if !states.is_empty() {
            self.states.lock().unwrap_or_else(PoisonError::into_inner).insert(key.clone(), states);
        }
        Step { key, target, facts: facts.to_vec(), outline, from }
    }

    /// Ends a step with what was found in its part, or in the whole program. Returns all findings.
    pub(super) fn keep(
        &self,
        step: Step,
        ran: Ran<Arc<Finding<Site>>>,
        program: &ProgramIndex<'_>,
    ) -> Ran<Arc<Finding<Site>>> {
        let Step { key, target, facts, outline, from } = step;
        let state = match from {
            Some(from) => from.join(facts, outline, ran),
            None => State { kept: Kept::of(program, &ran), target, facts, outline, summary: program.summary(), ran },
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
        Some(from.kept.islands.part(skeleton, &from.moved, &from.units, from.state.summary.clone()))
    }
}

impl State {
    /// Goes to a program in which some units have moved: what is kept of it, and the objects to judge anew. `None`, and
    /// nothing has happened, when those are all.
    fn follow(
        &mut self,
        facts: &[Arc<UnitFacts>],
        by: &Moved,
        program: &ProgramIndex<'_>,
    ) -> Option<(Kept, FxHashSet<u32>)> {
        // Another state has shown what can be said of all objects now.
        if program.known().is_some() && program.summary() != self.summary {
            return None;
        }
        let old = || Skeleton::new(program.family, self.facts.iter().map(AsRef::as_ref).collect());
        let mut kept = self.kept.take().unwrap_or_else(|| {
            let islands = Islands::new(&old(), &self.facts);
            let subjects = self.ran.findings.iter().map(|it| islands.at(it.place)).collect();
            Kept { islands: Arc::new(islands), subjects }
        });
        let islands = Arc::make_mut(&mut kept.islands);
        let mut moved = islands.update(program, facts, &by.changed, &by.units);
        islands.close(&mut moved);
        program.know(kept.islands.clone());
        if program.summary() != self.summary {
            Arc::make_mut(&mut kept.islands).update(&old(), &self.facts, &by.changed, &by.units);
            self.kept = Some(kept);
            return None;
        }
        Some((kept, moved))
    }
}

impl From {
    /// The state of the program now, of which `ran` was found in the part that moved.
    fn join(self, facts: Vec<Arc<UnitFacts>>, outline: Outline, ran: Ran<Arc<Finding<Site>>>) -> State {
        let Self { state, kept: Kept { islands, subjects }, units, moved } = self;
        let has_moved = |(finding, subjects): &(Arc<Finding<Site>>, Vec<u32>)| match subjects[..] {
            [] => units.binary_search(&finding.place.unit).is_ok(),
            _ => subjects.iter().any(|it| moved.contains(it)),
        };
        let unmoved = state.ran.findings.into_iter().zip(subjects).filter(|it| !has_moved(it));
        let (mut findings, mut subjects): (Vec<Arc<Finding<Site>>>, Vec<Vec<u32>>) = unmoved.unzip();
        subjects.extend(ran.findings.iter().map(|it| islands.at(it.place)));
        findings.extend(ran.findings);
        let mut failed = state.ran.failed;
        failed.extend(ran.failed);
        failed.sort_unstable();
        failed.dedup();
        let ran = Ran { findings, failed };
        State {
            target: state.target,
            facts,
            outline,
            summary: state.summary,
            ran,
            kept: Some(Kept { islands, subjects }),
        }
    }
}

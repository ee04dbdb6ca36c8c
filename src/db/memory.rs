//! What was found out about the objects of programs, so that an edit makes judge only those that it touches.
//!
//! **Invariant:** with or without it, findings are the same. Whatever is written to the database but the text of a file
//! makes it forget all.

use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::{FxHashMap, FxHashSet};

use super::Ran;
use super::names::{Facts, Resolved};
use crate::analysis::Site;
use crate::analysis::facts::UnitFacts;
use crate::analysis::islands::Islands;
use crate::analysis::outline::{Moved, Numbers, Outline};
use crate::analysis::program::{ProgramIndex, Skeleton};
use crate::analysis::symbols::SymbolTable;
use crate::analysis::unseen::{AskedFor, Questions, Summary};
use crate::lint::Finding;
use crate::model::entity::Family;
use crate::target::Target;

type Key = (String, Family);

#[derive(Debug, Default)]
pub struct Memory {
    states: Mutex<FxHashMap<Key, Vec<State>>>,
    resolved: Mutex<FxHashMap<Key, Arc<Resolved>>>,
}

/// Of each program, so many states are kept: one with the mistake that is being typed, one without, and some besides, for
/// edits that make or undo a unit.
const MOST_STATES: usize = 4;

/// Whether programs of a family are judged in parts. A drum or a text block of PL7-2 reaches memory that no use of it names
/// (PL72:895), and programs are small.
fn keeps(family: Family) -> bool {
    family != Family::Pl72
}

/// Findings about the objects of a program as it was once.
#[derive(Debug, Clone)]
struct State {
    target: Target,
    facts: Facts,
    outline: Outline,
    summary: Summary,
    ran: Ran<Arc<Finding<Site>>>,
    /// What was asked of the summary for no single object.
    asked_of_all: Questions,
    kept: Kept,
}

/// What makes the next step from a state a small one.
#[derive(Debug, Clone)]
enum Kept {
    /// All there is to make the rest of: for which objects what was asked of the summary. They go by the name of a unit.
    Asked(AskedFor),
    Known(Known),
}

#[derive(Debug, Clone)]
struct Known {
    islands: Arc<Islands>,
    /// Of each finding, the objects at its place.
    subjects: Vec<Vec<u32>>,
    /// What was asked of the summary for which objects.
    asked: FxHashMap<u32, Questions>,
}

impl Kept {
    fn known(self, family: Family, facts: &[Arc<UnitFacts>], ran: &Ran<Arc<Finding<Site>>>) -> Known {
        match self {
            Self::Known(known) => known,
            Self::Asked(asked) => {
                let skeleton = Skeleton::new(family, facts.iter().map(AsRef::as_ref).collect());
                Known::new(Arc::new(Islands::new(&skeleton, facts)), ran, asked)
            }
        }
    }
}

impl Known {
    /// Of what was found out about a program as a whole.
    fn new(islands: Arc<Islands>, ran: &Ran<Arc<Finding<Site>>>, asked: AskedFor) -> Self {
        let subjects = ran.findings.iter().map(|it| islands.at(it.place)).collect();
        let asked = asked.into_iter().filter_map(|(of, it)| Some((islands.object(of)?, it))).collect();
        Self { islands, subjects, asked }
    }
}

/// From what is known to the findings about a program as it is now.
pub(super) struct Step {
    key: Key,
    target: Target,
    facts: Facts,
    outline: Outline,
    from: Option<From>,
}

struct From {
    ran: Ran<Arc<Finding<Site>>>,
    asked_of_all: Questions,
    known: Known,
    /// Units whose own objects are to be judged anew.
    units: Vec<u32>,
    /// Objects to judge anew; `None` when those are all.
    moved: Option<FxHashSet<u32>>,
}

impl Memory {
    pub(super) fn forget(&self) {
        self.states.lock().unwrap_or_else(PoisonError::into_inner).clear();
        self.resolved.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Resolves names in what the units of a program tell.
    pub(super) fn resolve(&self, key: Key, told: Facts, symbols: Arc<SymbolTable>) -> Arc<Resolved> {
        let known = || self.resolved.lock().unwrap_or_else(PoisonError::into_inner);
        let old = known().get(&key).cloned();
        let new = Arc::new(Resolved::new(told, symbols, key.1 == Family::Step7, old.as_deref()));
        known().insert(key, new.clone());
        new
    }

    /// Gets ready for the next edit, as far as that can be done before it comes.
    pub(super) fn get_ready(&self) {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        for ((_, family), states) in states.iter_mut().filter(|it| keeps(it.0.1)) {
            states.iter_mut().for_each(|it| it.get_ready(*family));
        }
    }

    /// Starts from the state that is most like the program now.
    pub(super) fn step(&self, key: Key, target: Target, facts: &Facts, program: &ProgramIndex<'_>) -> Step {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner).remove(&key).unwrap_or_default();
        let of_target = (0..).zip(&states).filter(|it| keeps(key.1) && it.1.target == target);
        let outline = Outline::new(program);
        let moved = |it: &State| it.outline.moved(&it.facts, &outline, facts);
        let is_as_complete = |it: &State| it.summary.is_complete() == program.complete;
        let near = of_target.filter_map(|(at, it)| Some((!is_as_complete(it), moved(it)?, at)));
        let near = near.min_by_key(|it| (it.0, it.1.units.len()));
        let from = near.map(|(is_kept, by, at)| {
            // Mistakes come and go: of what goes on from the other kind of state, that stays as it is.
            let state = if is_kept {
                states[at].get_ready(key.1);
                states[at].clone()
            } else {
                states.remove(at)
            };
            state.follow(facts, by, program)
        });
        if !states.is_empty() {
            self.states.lock().unwrap_or_else(PoisonError::into_inner).insert(key.clone(), states);
        }
        Step { key, target, facts: facts.clone(), outline, from }
    }

    /// Ends a step with what was found in its part, or in the whole program: `judged`. Returns all findings.
    pub(super) fn keep(
        &self,
        step: Step,
        ran: Ran<Arc<Finding<Site>>>,
        judged: &ProgramIndex<'_>,
    ) -> Ran<Arc<Finding<Site>>> {
        let Step { key, target, facts, outline, from } = step;
        let (asked, asked_of_all) = judged.asked();
        let (ran, asked_of_all, kept) = match from {
            Some(from) => from.join(ran, asked, asked_of_all),
            None => (ran, asked_of_all, Kept::Asked(asked)),
        };
        let state = State { target, facts, outline, summary: judged.summary(), ran, asked_of_all, kept };
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
    pub(super) fn part<'a>(&self, whole: &ProgramIndex<'a>) -> Option<ProgramIndex<'a>> {
        let from = self.from.as_ref()?;
        let moved = from.moved.as_ref()?;
        Some(from.known.islands.part(whole.skeleton(), moved, &from.units, whole.summary()))
    }
}

impl State {
    fn get_ready(&mut self, family: Family) {
        let kept = std::mem::replace(&mut self.kept, Kept::Asked(AskedFor::default()));
        self.kept = Kept::Known(kept.known(family, &self.facts, &self.ran));
    }

    /// Goes to a program in which some units have moved.
    fn follow(self, facts: &[Arc<UnitFacts>], by: Moved, program: &ProgramIndex<'_>) -> From {
        let Self { mut ran, asked_of_all, .. } = self;
        let mut known = self.kept.known(program.family, &self.facts, &ran);
        let islands = Arc::make_mut(&mut known.islands);
        let mut moved = islands.update(program, facts, &by);
        if !by.numbers.are_same() {
            ran.findings = renumber(ran.findings, &mut known.subjects, by.numbers);
        }
        program.know(known.islands.clone());
        let summary = program.summary();
        let changed = self.summary.difference(&summary);
        if asked_of_all.meet(changed) {
            return From { ran, asked_of_all, known, units: by.units, moved: None };
        }
        let islands = &known.islands;
        if !changed.is_empty() {
            let tells_otherwise = |asked: Questions, it: u32| {
                islands.get(it).is_some_and(|it| self.summary.tells_otherwise(&summary, changed, asked, it))
            };
            moved.extend(known.asked.iter().filter(|(it, asked)| tells_otherwise(**asked, **it)).map(|it| it.0));
        }
        islands.close(&mut moved);
        From { ran, asked_of_all, known, units: by.units, moved: Some(moved) }
    }
}

/// Findings about a program in which units have other numbers. Those that name a unit which is not there any more go: they
/// are about objects that it used, or about what its calls led to.
fn renumber(
    findings: Vec<Arc<Finding<Site>>>,
    subjects: &mut Vec<Vec<u32>>,
    numbers: Numbers,
) -> Vec<Arc<Finding<Site>>> {
    let now = |it: Site| {
        if it.is_configured() { Some(it) } else { Some(Site { unit: numbers.now(it.unit)?, ..it }) }
    };
    let renumbered = |it: Arc<Finding<Site>>| {
        if it.names(|it| now(*it).is_none()) {
            None
        } else if it.names(|it| now(*it) != Some(*it)) {
            Arc::unwrap_or_clone(it).map(now).map(Arc::new)
        } else {
            Some(it)
        }
    };
    let all = findings.into_iter().zip(std::mem::take(subjects));
    let (findings, kept) = all.filter_map(|(it, of)| Some((renumbered(it)?, of))).unzip();
    *subjects = kept;
    findings
}

impl From {
    /// All findings about the program now, with what was asked for them; `ran` and `asked` are of the part that moved.
    fn join(
        self,
        ran: Ran<Arc<Finding<Site>>>,
        asked: AskedFor,
        asked_of_all: Questions,
    ) -> (Ran<Arc<Finding<Site>>>, Questions, Kept) {
        let Known { islands, subjects, asked: mut known } = self.known;
        let Some(moved) = self.moved else {
            let known = Known::new(islands, &ran, asked);
            return (ran, asked_of_all, Kept::Known(known));
        };
        let has_moved = |(finding, subjects): &(Arc<Finding<Site>>, Vec<u32>)| match subjects[..] {
            [] => self.units.binary_search(&finding.place.unit).is_ok(),
            _ => subjects.iter().any(|it| moved.contains(it)),
        };
        let unmoved = self.ran.findings.into_iter().zip(subjects).filter(|it| !has_moved(it));
        let (mut findings, mut subjects): (Vec<Arc<Finding<Site>>>, Vec<Vec<u32>>) = unmoved.unzip();
        subjects.extend(ran.findings.iter().map(|it| islands.at(it.place)));
        findings.extend(ran.findings);
        let mut failed = self.ran.failed;
        failed.extend(ran.failed);
        failed.sort_unstable();
        failed.dedup();
        for it in &moved {
            known.remove(it);
        }
        known.extend(asked.into_iter().filter_map(|(of, it)| Some((islands.object(of)?, it))));
        let asked_of_all = self.asked_of_all.join(asked_of_all);
        (Ran { findings, failed }, asked_of_all, Kept::Known(Known { islands, subjects, asked: known }))
    }
}

#[cfg(test)]
mod tests {
    use salsa::Setter as _;

    use super::*;
    use crate::db::{Db as _, Input, RootDatabase, index, program_facts, programs, run_program_rules};
    use crate::lint::settings::Settings;
    use crate::lint::{Check, ProgramCx};
    use crate::source::detect::Dialect;

    /// The memory bits that each text makes judge anew, after the one before it; `None` for all objects.
    fn judged(texts: &[&str]) -> Vec<Option<Vec<String>>> {
        let mut db = RootDatabase::new(Settings::default(), None);
        let file = db.set_files([Input::from_text("p/a.awl", texts[0], Dialect::Step7)])[0];
        let memory = Memory::default();
        let mut judged = Vec::new();
        for text in texts {
            let content: Arc<str> = (*text).into();
            file.set_content(&mut db).to(content.into());
            let program = programs(&db)[0];
            let facts = program_facts(&db, program);
            let whole = index(&db, program, &facts);
            let settings = db.project().settings(&db);
            let target = settings.target_or(Family::Step7, None);
            let step = memory.step((String::new(), Family::Step7), target, &facts, &whole);
            judged.push(step.from.as_ref().and_then(|from| {
                let of = from.moved.as_ref()?.iter().filter_map(|it| from.known.islands.get(*it));
                let mut names: Vec<String> = of.map(|it| it.text.replace(' ', "")).collect();
                names.retain(|it| it.starts_with('M'));
                names.sort();
                Some(names)
            }));
            let part = step.part(&whole);
            let judged = part.as_ref().unwrap_or(&whole);
            let ran =
                run_program_rules(&ProgramCx::new(judged, settings, &target), |it| matches!(it, Check::Object(_)));
            memory.keep(step, ran, judged);
        }
        judged
    }

    fn program(edited: &str) -> String {
        format!(
            "ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FC 1\nCALL FC 2\nCALL FC 3\nEND_ORGANIZATION_BLOCK\n\
             FUNCTION FC 1 : VOID\nBEGIN\nU E 0.0\nS M 1.0\nU M 1.0\n= A 0.0\n\
             U E 0.1\nS M 2.0\nU E 0.2\nR M 2.0\nU M 2.0\n= A 0.1\n\
             U M 3.0\n= A 0.2\nU E 0.3\n= M 4.0\nU M 4.0\n= A 0.3\nEND_FUNCTION\n\
             FUNCTION FC 2 : VOID\nBEGIN\nU M 6.0\n= A 0.4\n{edited}END_FUNCTION\n\
             FUNCTION FC 3 : VOID\nBEGIN\nU E 1.0\n= M 5.0\nEND_FUNCTION\n"
        )
    }

    #[test]
    fn what_is_written_by_a_pointer_bears_on_those_that_asked() {
        let (plain, pointer) = (program("L EW 4\nT AW 4\n"), program("L EW 4\nT MW [MD 100]\n"));
        let moved = judged(&[&plain, &pointer, &pointer, &plain, &pointer]);
        let names = |it: &[&str]| Some(it.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>());
        // Those of the block that was edited, and those that would be missing a write or reset. What is never read would
        // not ask for writes.
        let there = names(&["M1.0", "M3.0", "M6.0", "MD100"]);
        assert_eq!(moved[0], None, "nothing is known yet");
        assert_eq!(moved[1], there);
        assert_eq!(moved[2], names(&[]));
        assert_eq!(moved[3], there);
        assert_eq!(moved[4], there);
    }

    #[test]
    fn a_unit_that_comes_or_goes_leaves_the_others() {
        let without = program("L EW 4\nT AW 4\n");
        let with = format!("FUNCTION FC 4 : VOID\nBEGIN\nU M 7.0\n= A 5.0\nU M 5.0\n= A 5.1\nEND_FUNCTION\n{without}");
        let moved = judged(&[&without, &with, &without, &with]);
        let names = |it: &[&str]| Some(it.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>());
        let there = names(&["M5.0", "M7.0"]);
        assert_eq!(moved, [None, there.clone(), there.clone(), there]);
    }

    #[test]
    fn what_is_used_by_a_symbol_bears_on_those_that_asked() {
        let (plain, symbol) = (program("L EW 4\nT AW 4\n"), program("U \"ready\"\nR \"done\"\n"));
        let moved = judged(&[&plain, &symbol, &plain]);
        let names = |it: &[&str]| Some(it.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>());
        let there = names(&["M1.0", "M3.0", "M5.0", "M6.0"]);
        assert_eq!(moved, [None, there.clone(), there]);
    }
}

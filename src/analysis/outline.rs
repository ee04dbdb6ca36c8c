//! How the units of a program run one another, compared from edit to edit.

use std::collections::VecDeque;
use std::sync::Arc;

use super::facts::{Difference, UnitFacts};
use super::program::{Context, Skeleton};

/// What of a [`Skeleton`] findings about objects hang on, without places.
#[derive(Debug, Clone)]
pub struct Outline {
    units: Vec<Unit>,
    /// The units in the order of execution.
    sequence: Vec<u32>,
}

#[derive(Debug, Clone)]
struct Unit {
    contexts: Box<[Context]>,
    reached: bool,
    sure: bool,
    /// Where its calls lead.
    targets: Box<[Option<u32>]>,
}

/// What an edit touches.
#[derive(Debug)]
pub struct Moved {
    /// Units whose facts are others.
    pub changed: Vec<u32>,
    /// Units of whose objects something else may hold, those with other facts among them. Sorted.
    pub units: Vec<u32>,
}

impl Outline {
    pub fn new(skeleton: &Skeleton<'_>) -> Self {
        let mut units: Vec<Unit> = (skeleton.contexts.iter().zip(&skeleton.reached).zip(&skeleton.sure))
            .map(|((contexts, &reached), &sure)| Unit {
                contexts: contexts.as_slice().into(),
                reached,
                sure,
                targets: Box::default(),
            })
            .collect();
        for calls in skeleton.calls.chunk_by(|a, b| a.unit == b.unit) {
            if let Some(unit) = calls.first().and_then(|it| units.get_mut(it.unit as usize)) {
                unit.targets = calls.iter().map(|it| it.target).collect();
            }
        }
        let mut sequence: Vec<u32> = (0..).take(units.len()).collect();
        sequence.sort_by_key(|&it| skeleton.order.get(it as usize));
        Self { units, sequence }
    }

    /// From this outline, with the facts that it is of, to another one: what moves; `None` when it may be anything.
    pub fn moved(&self, old: &[Arc<UnitFacts>], new: &Self, facts: &[Arc<UnitFacts>]) -> Option<Moved> {
        if self.units.len() != new.units.len() || old.len() != facts.len() {
            return None;
        }
        let mut changed = Vec::new();
        let mut has_moved = vec![false; facts.len()];
        // Where calls lead of which something is new: findings in the code behind them may name it.
        let mut behind: VecDeque<u32> = VecDeque::new();
        for (unit, (a, b)) in (0..).zip(old.iter().zip(facts)) {
            let at = unit as usize;
            let (was, is) = (self.units.get(at)?, new.units.get(at)?);
            let runs = |it: &Unit| (it.reached, it.sure);
            has_moved[at] |= runs(was) != runs(is) || was.contexts != is.contexts;
            let difference = if Arc::ptr_eq(a, b) || a == b { Difference::None } else { b.difference(a) };
            match difference {
                Difference::None => {}
                Difference::Unknown => return None,
                Difference::Uses | Difference::Calls => {
                    changed.push(unit);
                    has_moved[at] = true;
                }
            }
            let all = difference == Difference::Calls;
            if difference == Difference::None && was.targets == is.targets {
                continue;
            }
            has_moved[at] = true;
            let pairs = was.targets.iter().zip(&is.targets).zip(a.calls.iter().zip(&b.calls));
            for ((from, to), (x, y)) in pairs {
                if all || from != to || x.anchor != y.anchor {
                    behind.extend(from.iter().chain(to));
                }
            }
            if was.targets.len() != is.targets.len() {
                behind.extend(was.targets.iter().chain(&is.targets).flatten());
            }
        }
        // What a unit is called and declares is read where it is called.
        for (at, (was, is)) in self.units.iter().zip(&new.units).enumerate() {
            let is_other = |it: &u32| {
                let facts = old.get(*it as usize).zip(facts.get(*it as usize));
                facts.is_some_and(|(a, b)| !Arc::ptr_eq(a, b) && a.declared != b.declared)
            };
            has_moved[at] |= was.targets.iter().chain(&is.targets).flatten().any(is_other);
        }
        let mut seen = vec![false; facts.len()];
        while let Some(unit) = behind.pop_front() {
            let at = unit as usize;
            if std::mem::replace(seen.get_mut(at)?, true) {
                continue;
            }
            has_moved[at] = true;
            for it in [self, new] {
                behind.extend(it.units.get(at)?.targets.iter().flatten());
            }
        }
        let still = |it: &&u32| !has_moved.get(**it as usize).copied().unwrap_or(true);
        if !self.sequence.iter().filter(still).eq(new.sequence.iter().filter(still)) {
            return None;
        }
        let units = (0..).zip(&has_moved).filter(|it| *it.1).map(|it| it.0).collect();
        Some(Moved { changed, units })
    }
}

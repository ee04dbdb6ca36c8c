//! How the units of a program run one another, compared from edit to edit.

use std::collections::VecDeque;
use std::ops::Range;
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

/// What an edit touches. Units go by their numbers after it.
#[derive(Debug)]
pub struct Moved {
    pub numbers: Numbers,
    /// Units whose facts are others, and those that were not there.
    pub changed: Vec<u32>,
    /// Units of whose objects something else may hold, the changed ones among them. Sorted.
    pub units: Vec<u32>,
}

/// Which unit of a program is which after an edit, which may break or mend the headings of units.
#[derive(Debug, Clone, Copy)]
pub struct Numbers {
    /// The units before this one have the numbers that they had.
    at: u32,
    /// So many are not there any more, then so many are new. One of both is 0.
    gone: u32,
    come: u32,
}

fn is_same(a: &Arc<UnitFacts>, b: &Arc<UnitFacts>) -> bool {
    Arc::ptr_eq(a, b) || a == b
}

impl Numbers {
    /// Of a unit that is not there any more.
    const GONE: u32 = u32::MAX;

    fn new(old: &[Arc<UnitFacts>], new: &[Arc<UnitFacts>]) -> Self {
        fn same<'f>(pairs: impl Iterator<Item = (&'f Arc<UnitFacts>, &'f Arc<UnitFacts>)>) -> usize {
            pairs.take_while(|(a, b)| is_same(a, b)).count()
        }
        let start = same(old.iter().zip(new));
        let end = same(old.iter().skip(start).rev().zip(new.iter().skip(start).rev()));
        let (gone, come) = (old.len() - start - end, new.len() - start - end);
        let kept = gone.min(come);
        let number = |it: usize| u32::try_from(it).unwrap_or(u32::MAX);
        Self { at: number(start + kept), gone: number(gone - kept), come: number(come - kept) }
    }

    pub fn are_same(self) -> bool {
        self.gone == self.come
    }

    /// Units that are not there any more, by the numbers that they had.
    pub fn gone(self) -> Range<u32> {
        self.at..self.at + self.gone
    }

    /// Units that were not there, by their numbers now.
    pub fn come(self) -> Range<u32> {
        self.at..self.at + self.come
    }

    /// The number now of a unit that had this one; `None` when it is not there any more.
    pub fn now(self, old: u32) -> Option<u32> {
        match old.checked_sub(self.at) {
            None => Some(old),
            Some(beyond) => beyond.checked_sub(self.gone)?.checked_add(self.at + self.come),
        }
    }

    fn before(self, now: u32) -> Option<u32> {
        Self { gone: self.come, come: self.gone, ..self }.now(now)
    }

    fn target(self, old: Option<u32>) -> Option<u32> {
        old.map(|it| self.now(it).unwrap_or(Self::GONE))
    }
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
        let numbers = Numbers::new(old, facts);
        let gone = numbers.gone().filter_map(|it| old.get(it as usize));
        let come = numbers.come().filter_map(|it| facts.get(it as usize));
        if !gone.chain(come).all(|it| it.is_code_alone()) {
            return None;
        }
        let before = |it: u32| Some(numbers.before(it)? as usize);
        let targets = |unit: Option<usize>| {
            let it = unit.and_then(|it| self.units.get(it));
            it.into_iter().flat_map(|it| it.targets.iter().map(|it| numbers.target(*it)))
        };
        let (mut changed, mut redeclared) = (Vec::new(), false);
        let mut has_moved = vec![false; facts.len()];
        // Where calls lead of which something is new: findings in the code behind them may name it.
        let mut behind: VecDeque<u32> = numbers.gone().flat_map(|it| targets(Some(it as usize))).flatten().collect();
        for (unit, (is, b)) in (0..).zip(new.units.iter().zip(facts)) {
            let at = unit as usize;
            let Some((was, a)) = before(unit).and_then(|it| Some((self.units.get(it)?, old.get(it)?))) else {
                changed.push(unit);
                has_moved[at] = true;
                behind.extend(is.targets.iter().flatten());
                continue;
            };
            let runs = |it: &Unit| (it.reached, it.sure);
            has_moved[at] |= runs(was) != runs(is) || was.contexts != is.contexts;
            let difference = if is_same(a, b) { Difference::None } else { b.difference(a) };
            match difference {
                Difference::None => {}
                Difference::Unknown => return None,
                Difference::Uses | Difference::Calls => {
                    changed.push(unit);
                    has_moved[at] = true;
                }
            }
            let all = difference == Difference::Calls;
            let led = || targets(before(unit));
            let leads_on =
                if numbers.are_same() { was.targets == is.targets } else { led().eq(is.targets.iter().copied()) };
            if difference == Difference::None && leads_on {
                continue;
            }
            redeclared |= a.declared != b.declared;
            has_moved[at] = true;
            for ((from, &to), (x, y)) in led().zip(&is.targets).zip(a.calls.iter().zip(&b.calls)) {
                if all || from != to || x.anchor != y.anchor {
                    behind.extend(from.into_iter().chain(to));
                }
            }
            if was.targets.len() != is.targets.len() {
                behind.extend(led().chain(is.targets.iter().copied()).flatten());
            }
        }
        // What a unit is called and declares is read where it is called.
        let is_other = |it: u32| {
            let facts = before(it).and_then(|was| Some((old.get(was)?, facts.get(it as usize)?)));
            facts.is_some_and(|(a, b)| !Arc::ptr_eq(a, b) && a.declared != b.declared)
        };
        for (unit, is) in (0..).zip(&new.units).filter(|_| redeclared) {
            let called = targets(before(unit)).chain(is.targets.iter().copied()).flatten();
            has_moved[unit as usize] |= called.into_iter().any(is_other);
        }
        let mut seen = vec![false; facts.len()];
        while let Some(unit) = behind.pop_front() {
            // What is not there any more has been followed.
            let Some(seen) = seen.get_mut(unit as usize) else { continue };
            if std::mem::replace(seen, true) {
                continue;
            }
            has_moved[unit as usize] = true;
            let is = new.units.get(unit as usize)?;
            behind.extend(targets(before(unit)).chain(is.targets.iter().copied()).flatten());
        }
        let still = |it: &u32| !has_moved.get(*it as usize).copied().unwrap_or(true);
        let was = self.sequence.iter().filter_map(|&it| numbers.now(it));
        if !was.filter(still).eq(new.sequence.iter().copied().filter(still)) {
            return None;
        }
        let units = (0..).zip(&has_moved).filter(|it| *it.1).map(|it| it.0).collect();
        Some(Moved { numbers, changed, units })
    }
}

//! A scan compared with the rules of evolution (GRF:128-152).
//!
//! The rules cross all transitions at once, by what holds when the scan begins; code crosses one after the other, and what
//! one changes the next one sees. Where the two differ, some situation that the chart reaches and some values of the inputs
//! say so: the solver finds them.

use rustc_hash::{FxHashMap, FxHashSet};

use super::code::How;
use super::set_reset::FoundTransition;
use super::trace::Trace;
use super::{Sequence, SequenceTransition};
use crate::analysis::conditions::{self, Answer, Given};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator, Replaced};
use crate::model::object::{Class, Type};

/// What a scan does otherwise than the rules say.
#[derive(Debug, Clone)]
pub struct Deviation {
    pub kind: DeviationKind,
    /// Step that it is about.
    pub step: usize,
    /// The two transitions, as indices, in the order of the scan.
    pub first: usize,
    pub second: usize,
    /// Steps that are active when the scan begins.
    pub situation: Vec<usize>,
    /// Values of everything else that make it happen.
    pub values: Vec<String>,
    /// Something was taken as free that may not be.
    pub assumed: bool,
}

impl Deviation {
    /// The values as a message says them: ``when `E0.1` = 1``.
    pub fn when(&self) -> String {
        conditions::when(&self.values)
    }

    /// Those that are too many for the message.
    pub fn besides(&self) -> Option<String> {
        conditions::besides(&self.values)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum DeviationKind {
    /// The step goes on and off within the scan.
    Skipped,
    /// The same, and the scan ends where it began.
    Undone,
    /// The step was on, is activated and deactivated, and goes off (rule 5).
    Lost,
    /// The first branch takes the step away from the second one (rule 4).
    Shadowed,
}

/// Of more situations, or pairs of transitions at one step, the rest is not looked at.
const MOST_SITUATIONS: usize = 64;
const MOST_PAIRS: usize = 256;

/// So many questions about one sequence are asked of the solver.
const MOST_QUESTIONS: usize = 4000;

pub struct Judge<'s, 't, 'a> {
    trace: &'t mut Trace<'a>,
    sequence: &'s Sequence<'a>,
    /// By transition: the situations in which it is valid.
    valid: Vec<Vec<Vec<usize>>>,
    steps: FxHashMap<ObjectId, usize>,
    questions: usize,
}

impl<'s, 't, 'a> Judge<'s, 't, 'a> {
    pub fn new(trace: &'t mut Trace<'a>, sequence: &'s Sequence<'a>) -> Self {
        let valid = situations(trace, sequence);
        let steps = sequence.steps.iter().map(|it| it.id).zip(0..).collect();
        Self { trace, sequence, valid, steps, questions: MOST_QUESTIONS }
    }

    pub fn deviations(&mut self) -> Vec<Deviation> {
        let mut found = Vec::new();
        let transitions: &'s [SequenceTransition] = &self.sequence.transitions;
        for step in 0..self.sequence.steps.len() {
            let has = |list: &[usize]| list.contains(&step);
            let of = |wanted: &dyn Fn(&FoundTransition) -> bool| -> Vec<usize> {
                (0..transitions.len()).filter(|&it| wanted(&transitions[it].found)).collect()
            };
            let into = of(&|it| has(&it.targets) && !has(&it.sources));
            let out = of(&|it| has(&it.sources) && it.reset_of(step).is_some());
            let pairs = into.iter().flat_map(|a| out.iter().map(move |b| (*a, *b)));
            for (a, b) in pairs.filter(|it| it.0 != it.1).take(MOST_PAIRS) {
                // Where both steps are on in turn anyway, that one forgets the other is what happens.
                let both = self.both_valid(a, b);
                let one = self.lost(step, a, b, both).or_else(|| self.skipped(step, a, b));
                found.extend(one.or_else(|| {
                    let all = [&self.transition(a).sources[..], &self.transition(b).sources].concat();
                    if self.sequence.is_fed { self.lost(step, a, b, vec![all]) } else { None }
                }));
            }
            let leaving = of(&|it| has(&it.sources));
            let pairs = leaving.iter().flat_map(|a| leaving.iter().map(move |b| (*a, *b)));
            for (a, b) in pairs.filter(|it| it.0 != it.1).take(MOST_PAIRS) {
                found.extend(self.shadowed(step, a, b));
            }
        }
        found
    }

    /// See [`Sequence::together`].
    pub fn together(&mut self) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        let transitions: &'s [SequenceTransition] = &self.sequence.transitions;
        for step in 0..self.sequence.steps.len() {
            let leaving: Vec<usize> =
                (0..transitions.len()).filter(|&it| transitions[it].found.sources.contains(&step)).collect();
            let pairs = leaving.iter().enumerate().flat_map(|(at, b)| leaving[..at].iter().map(move |a| (*a, *b)));
            for (a, b) in pairs.take(MOST_PAIRS) {
                let conditions = [self.transition(a).condition, self.transition(b).condition];
                let wanted = conditions.map(|it| (self.trace.expand(it), true));
                if self.possible(self.both_valid(a, b), &wanted).is_some() {
                    found.push((a, b));
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Words that are counted on in each scan while a step is on: by event, with the step.
    pub fn counts(&mut self) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for at in 0..self.trace.events.len() {
            let event = &self.trace.events[at];
            let Some(value) = event.value.filter(|_| event.how == How::Store) else { continue };
            let Expr::Binary(Operator::Add | Operator::Sub, a, b) = *self.trace.exprs.get(value) else { continue };
            let (object, when) = (event.object, event.when);
            let is_own =
                |it: ExprId| matches!(*self.trace.exprs.get(it), Expr::Read { object: of, .. } if of == object);
            let is_constant = |it: ExprId| matches!(self.trace.exprs.get(it), Expr::Int(_));
            if !(is_own(a) && is_constant(b) || is_constant(a) && is_own(b)) {
                continue;
            }
            let is_timer = |it: ObjectId| matches!(self.trace.object(it).class, Class::Timer | Class::Counter);
            let step = self.trace.conjuncts(when).into_iter().find_map(|it| match *self.trace.exprs.get(it) {
                Expr::Read { object, .. } => self.steps.get(&object).copied(),
                _ => None,
            });
            // A bit that nothing shown here writes, but the process or somebody else, may be a pulse.
            let is_pulse = |it: ObjectId| {
                let object = self.trace.object(it);
                let is_bit = object.ty == Type::Bool || object.class == Class::Symbol;
                let is_process = matches!(object.class, Class::Input | Class::PeripheralInput);
                is_timer(it) || is_bit && !is_process && !self.trace.is_written(it)
            };
            let Some(step) = step.filter(|_| !self.trace.mentions(when, is_pulse)) else { continue };
            let wanted = [(self.trace.expand(when), true), (self.trace.next(when), true)];
            let mut situations: Vec<Vec<usize>> =
                self.valid.iter().flatten().filter(|it| it.contains(&step)).cloned().collect();
            situations.sort_unstable();
            situations.dedup();
            if self.possible(situations, &wanted).is_some() {
                found.push((at, step));
            }
        }
        found
    }

    fn transition(&self, at: usize) -> &'s FoundTransition {
        &self.sequence.transitions[at].found
    }

    /// Whether an event comes before another one in the same scan.
    fn is_before(&self, a: usize, b: usize) -> bool {
        let root = |it: usize| self.trace.events.get(it).map(|it| it.root);
        a < b && root(a) == root(b)
    }

    /// The step is off, the first transition sets it, the second one resets it.
    fn skipped(&mut self, step: usize, first: usize, second: usize) -> Option<Deviation> {
        let (a, b) = (self.transition(first), self.transition(second));
        let (on, off) = (a.set_of(step)?, b.reset_of(step)?);
        if !self.is_before(on, off) || self.needs_coincidence(a, b, step) {
            return None;
        }
        let end = self.end(step);
        let wanted = [(self.trace.expand(a.condition), true), (self.trace.expand(b.condition), true), (end, false)];
        let situations: Vec<Vec<usize>> = self.valid[first].iter().filter(|it| !it.contains(&step)).cloned().collect();
        let (situation, answer) = self.possible(situations, &wanted)?;
        let is_undone = b.targets == a.sources && a.targets == b.sources && a.targets.len() == 1;
        let kind = if is_undone { DeviationKind::Undone } else { DeviationKind::Skipped };
        Some(self.deviation(kind, step, first, second, situation, answer))
    }

    /// The step is on, both transitions are crossed, and it goes off.
    fn lost(&mut self, step: usize, first: usize, second: usize, situations: Vec<Vec<usize>>) -> Option<Deviation> {
        let (a, b) = (self.transition(first), self.transition(second));
        let (on, off) = (a.set_of(step)?, b.reset_of(step)?);
        if !self.is_before(on, off) || self.is_apart(a, b) {
            return None;
        }
        let end = self.end(step);
        let wanted = [
            (self.trace.flatten(a.condition), true),
            (self.trace.flatten(b.condition), true),
            (self.trace.expand(a.condition), true),
            (self.trace.expand(b.condition), true),
            (end, false),
        ];
        let situations = situations.into_iter().filter(|it| it.contains(&step)).collect();
        let (situation, answer) = self.possible(situations, &wanted)?;
        Some(self.deviation(DeviationKind::Lost, step, first, second, situation, answer))
    }

    /// Both transitions leave the step; the first resets it before the second one asks for it.
    fn shadowed(&mut self, step: usize, first: usize, second: usize) -> Option<Deviation> {
        let (a, b) = (self.transition(first), self.transition(second));
        let off = a.reset_of(step)?;
        if b.targets.is_empty() || a.targets == b.targets || !self.is_before(off, b.event()) || self.is_apart(a, b) {
            return None;
        }
        let wanted = [
            (self.trace.flatten(a.condition), true),
            (self.trace.flatten(b.condition), true),
            (self.trace.expand(a.condition), true),
            (self.trace.expand(b.condition), false),
            (self.trace.expand(b.receptivity), true),
        ];
        let situations = self.both_valid(first, second);
        let (situation, answer) = self.possible(situations, &wanted)?;
        Some(self.deviation(DeviationKind::Shadowed, step, first, second, situation, answer))
    }

    fn end(&mut self, step: usize) -> ExprId {
        self.trace.end(self.sequence.steps[step].id)
    }

    fn both_valid(&self, first: usize, second: usize) -> Vec<Vec<usize>> {
        let sources = &self.transition(second).sources;
        let both = |it: &&Vec<usize>| sources.iter().all(|step| it.contains(step));
        self.valid[first].iter().filter(both).cloned().collect()
    }

    /// Whether the second transition waits for an edge that only by chance comes in the scan in which the first one is
    /// crossed, or for a timer that starts with the step.
    fn needs_coincidence(&mut self, first: &FoundTransition, second: &FoundTransition, step: usize) -> bool {
        let bit = self.sequence.steps[step].id;
        let receptivity = self.trace.expand(second.receptivity);
        if self.trace.waits_since(second.condition, bit) {
            return true;
        }
        let condition = self.trace.expand(first.condition);
        let known = self.trace.edges(condition);
        let own: Vec<ExprId> = self.trace.edges(receptivity).into_iter().collect();
        own.into_iter().any(|it| {
            let of = self.trace.expand(it);
            !known.contains(&it) && !self.trace.mentions(of, |object| self.steps.contains_key(&object))
        })
    }

    /// Whether both transitions wait for edges, of different signals.
    fn is_apart(&mut self, first: &FoundTransition, second: &FoundTransition) -> bool {
        let (a, b) = (self.trace.expand(first.condition), self.trace.expand(second.condition));
        let (a, b): (FxHashSet<ExprId>, FxHashSet<ExprId>) = (self.trace.edges(a), self.trace.edges(b));
        !a.is_empty() && !b.is_empty() && a.is_disjoint(&b)
    }

    /// A situation in which all conditions can be as wanted.
    fn possible(&mut self, situations: Vec<Vec<usize>>, wanted: &[(ExprId, bool)]) -> Option<(Vec<usize>, Answer)> {
        let mut seen: FxHashSet<Vec<ExprId>> = FxHashSet::default();
        for situation in situations.into_iter().take(MOST_SITUATIONS) {
            let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
            let steps = &self.steps;
            let fixed: Vec<ExprId> = wanted
                .iter()
                .map(|it| {
                    self.trace.exprs.rewrite(it.0, &mut known, |exprs, id| match *exprs.get(id) {
                        Expr::Read { object, version: 0 } => Replaced::By(match steps.get(&object) {
                            Some(step) => Exprs::bool(situation.contains(step)),
                            None => id,
                        }),
                        _ => Replaced::By(id),
                    })
                })
                .collect();
            if !seen.insert(fixed.clone()) {
                continue;
            }
            self.questions = self.questions.checked_sub(1)?;
            let wanted: Vec<(ExprId, bool)> = fixed.into_iter().zip(wanted.iter().map(|it| it.1)).collect();
            let answer = self.trace.solve(&wanted);
            if matches!(answer, Answer::Possible(_)) {
                return Some((situation, answer));
            }
        }
        None
    }

    fn deviation(
        &self,
        kind: DeviationKind,
        step: usize,
        first: usize,
        second: usize,
        situation: Vec<usize>,
        answer: Answer,
    ) -> Deviation {
        let (mut values, mut assumed) = (Vec::new(), false);
        if let Answer::Possible(witness) = answer {
            let is_known = |it: &&Given| !matches!(it, Given::Unknown(..));
            // Two versions of one object may have one value.
            for it in witness.given.iter().filter(is_known).map(|it| self.trace.space().describe(it)) {
                if !values.contains(&it) {
                    values.push(it);
                }
            }
            assumed = witness.assumed;
        }
        Deviation { kind, step, first, second, situation, values, assumed }
    }
}

/// By transition: the situations in which it is valid. That branches of one step can be taken together is a finding of its
/// own, and what follows from it is none. Where nothing says how the sequence starts, its own steps alone.
fn situations(trace: &Trace<'_>, sequence: &Sequence<'_>) -> Vec<Vec<Vec<usize>>> {
    let chart = sequence.chart();
    let mut net = sequence.net(trace.family, &chart);
    let mut valid: Vec<Vec<Vec<usize>>> = vec![Vec::new(); sequence.transitions.len()];
    for component in net.components() {
        let reached = net.reach_apart(&component);
        for &crossing in &component.crossings {
            let Some(list) = valid.get_mut(net.crossings[crossing].transition) else { continue };
            let all = net.valid_in(&component, &reached, crossing).take(MOST_SITUATIONS);
            list.extend(all.map(|it| it.map(|it| it as usize).collect::<Vec<usize>>()));
        }
    }
    if sequence.starts.is_empty() {
        for (list, transition) in valid.iter_mut().zip(&sequence.transitions) {
            list.push(transition.found.sources.clone());
        }
    }
    valid
}

//! Moments that an answer has shown to be possible: most questions about one unit hold in one of a few of them, and need no
//! solver then.
//!
//! **Invariant:** what a case says is true of some values of all objects, whatever is asked. Where the memory of a bit and of
//! a word is one, or that of two words, a case tells of the one that its question was about, and leaves the other open.

use std::cmp::Ordering;

use rustc_hash::{FxHashMap, FxHashSet};

use super::problem::{Atom, Problem, Said};
use super::{Given, Question, Space, Witness};
use crate::model::expr::{Comparison, Expr, ExprId, ObjectId};
use crate::model::object::{Object, Type};

#[derive(Debug, Default)]
pub(super) struct Cases {
    /// Of each expression that there was at the first case, the cases in which it is false, and those in which it is true; a
    /// case is one bit. In the others it is open.
    columns: Vec<[u64; 2]>,
    /// Which expressions are bits and terms that share memory with another one at the same moment.
    shared: Vec<bool>,
    /// Number of cases so far. Of more than 64, the first ones are forgotten.
    count: u32,
}

impl Cases {
    /// Whether some case answers the question.
    pub(super) fn answer(&self, question: &Question<'_>) -> bool {
        if self.columns.is_empty() {
            return false;
        }
        let column = |id: ExprId, value: bool| self.columns.get(id.0 as usize).map_or(0, |it| it[usize::from(value)]);
        let wanted = question.wanted.iter().fold(u64::MAX, |cases, &(id, value)| cases & column(id, value));
        let all = question.never.iter().fold(wanted, |cases, &[a, b]| cases & (column(a, false) | column(b, false)));
        all != 0
    }

    /// Adds the case in which a question was found to be possible: the values of its atoms, and what explains them.
    pub(super) fn add(&mut self, problem: &Problem<'_, '_>, values: &[Option<bool>], witness: &Witness) {
        if !problem.is_tight() {
            return;
        }
        if self.columns.is_empty() {
            let count = problem.space.exprs.len();
            *self = Self { columns: vec![[0; 2]; count], shared: shared(problem.space), count: 0 };
        }
        // Of a large unit, a case is more to work out than a question.
        if self.columns.len() > problem.gates.len() * 16 + 2048 {
            return;
        }
        let case = 1_u64 << (self.count % u64::BITS);
        self.count += 1;
        let moment = Moment::new(problem, values, witness);
        for at in 0..self.columns.len() {
            let id = ExprId(u32::try_from(at).unwrap_or(u32::MAX));
            let value = moment.value(id, self.shared[at], |it| {
                let [no, yes] = self.columns[it.0 as usize];
                if no & case != 0 { Some(false) } else { (yes & case != 0).then_some(true) }
            });
            for (column, of) in self.columns[at].iter_mut().zip([false, true]) {
                *column = if value == Some(of) { *column | case } else { *column & !case };
            }
        }
    }
}

/// Values of the objects that a question was about.
struct Moment<'p> {
    space: &'p Space<'p>,
    atoms: FxHashMap<ExprId, bool>,
    /// What the edges that happen say of their bits.
    bits: FxHashMap<(ObjectId, u32), bool>,
    numbers: FxHashMap<ExprId, f64>,
    orders: FxHashMap<(ExprId, ExprId), Comparison>,
}

impl<'p> Moment<'p> {
    fn new(problem: &'p Problem<'_, '_>, values: &[Option<bool>], witness: &Witness) -> Self {
        let mut it = Self {
            space: problem.space,
            atoms: FxHashMap::default(),
            bits: FxHashMap::default(),
            numbers: FxHashMap::default(),
            orders: FxHashMap::default(),
        };
        for (&(node, atom), value) in problem.atoms.iter().zip(values) {
            it.atoms.extend(value.map(|value| (problem.ids[node], value)));
            if let (Atom::Edge(object, version, rising), Some(true)) = (atom, value) {
                it.bits.insert((object, version), rising);
            }
        }
        for given in &witness.given {
            match *given {
                // Any of them does.
                Given::Whole(term, first, last) => {
                    it.numbers.insert(term, 0.clamp(first, last) as f64);
                }
                Given::Number(term, value) => {
                    it.numbers.insert(term, value);
                }
                Given::Relation(op, a, b) => {
                    it.orders.insert((a, b), op);
                }
                Given::Bit(..) | Given::Edge { .. } | Given::Unknown(..) => {}
            }
        }
        it
    }

    /// The value of an expression; what the question was not about is 0 where it may be. `of`: the values of those before.
    fn value(&self, id: ExprId, is_shared: bool, of: impl Fn(ExprId) -> Option<bool>) -> Option<bool> {
        if let Some(&value) = self.atoms.get(&id) {
            return Some(value);
        }
        match *self.space.exprs.get(id) {
            Expr::Bool(value) => Some(value),
            Expr::Not(a) => of(a).map(|it| !it),
            Expr::And(a, b) => match (of(a), of(b)) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (a, b) => a.and(b),
            },
            Expr::Or(a, b) => match (of(a), of(b)) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (a, b) => a.and(b),
            },
            Expr::Xor(a, b) => of(a).zip(of(b)).map(|(a, b)| a != b),
            Expr::Read { object, version } => {
                self.bits.get(&(object, version)).copied().or_else(|| (!is_shared).then_some(false))
            }
            Expr::Compare(op, a, b) => match self.space.said(op, a, b) {
                Said::Constant(value) => Some(value),
                Said::Bound(term, bound) => self.number(term, is_shared).map(|it| bound.holds(it)),
                Said::Relation(op, a, b) => {
                    let order = match self.orders.get(&(a, b)) {
                        Some(Comparison::Lt) => Ordering::Less,
                        Some(Comparison::Gt) => Ordering::Greater,
                        _ => Ordering::Equal,
                    };
                    Some(op.holds(order))
                }
                Said::Unknown => Some(false),
            },
            _ => Some(false),
        }
    }

    fn number(&self, term: ExprId, is_shared: bool) -> Option<f64> {
        let any = || {
            let (lowest, highest) = self.space.domain(term).unwrap_or((0, 0));
            (!is_shared).then(|| 0.clamp(lowest, highest) as f64)
        };
        self.numbers.get(&term).copied().or_else(any)
    }
}

/// Which expressions are about memory that another one is about as well, at the same moment: bits of words that are compared,
/// and comparisons of words that share memory with those, or with one another.
fn shared(space: &Space<'_>) -> Vec<bool> {
    let ids = || (0..space.exprs.len()).map(|it| ExprId(u32::try_from(it).unwrap_or(u32::MAX)));
    let fixed = |id: ExprId| space.read_of(id).filter(|it| it.0.is_fixed());
    let term_of = |id: ExprId| match *space.exprs.get(id) {
        Expr::Compare(op, a, b) => match space.said(op, a, b) {
            Said::Bound(term, _) => Some(term),
            _ => None,
        },
        _ => None,
    };
    let mut terms: Vec<ExprId> = ids().filter_map(term_of).collect();
    terms.sort_unstable();
    terms.dedup();
    // Of each version, the terms and the bits.
    let mut memory: FxHashMap<u32, [Vec<(ExprId, &Object)>; 2]> = FxHashMap::default();
    for &term in &terms {
        if let Some((object, version)) = fixed(term) {
            memory.entry(version).or_default()[0].push((term, object));
        }
    }
    if terms.is_empty() {
        return vec![false; space.exprs.len()];
    }
    let is_bit = |id: &ExprId| fixed(*id).is_some_and(|it| it.0.ty == Type::Bool);
    for bit in ids().filter(is_bit) {
        if let Some((object, version)) = fixed(bit) {
            memory.entry(version).or_default()[1].push((bit, object));
        }
    }
    let is_shared = |id: ExprId, with: &[usize]| {
        let Some((object, version)) = fixed(id) else { return false };
        let all = memory.get(&version).into_iter().flat_map(|it| with.iter().flat_map(|&part| &it[part]));
        all.into_iter().any(|(other, it)| *other != id && it.footprint.overlaps(&object.footprint))
    };
    let shared_terms: FxHashSet<ExprId> = terms.into_iter().filter(|it| is_shared(*it, &[0, 1])).collect();
    let of = |id: ExprId| match term_of(id) {
        Some(term) => shared_terms.contains(&term),
        None => is_bit(&id) && is_shared(id, &[0]),
    };
    ids().map(of).collect()
}

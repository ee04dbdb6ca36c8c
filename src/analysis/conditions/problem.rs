//! What conditions ask of their atoms, and the laws between those: the part of a question that does not depend on how it is
//! answered.

use std::cmp::Ordering;

use super::{Answer, Given, Question, Space, Witness};
use crate::model::expr::{Comparison, Expr, ExprId, ObjectId};
use crate::model::object::{Object, Type};

/// Conditions of more nodes than this are not decided.
const MAX_NODES: usize = 4096;
const MAX_ATOMS: usize = 512;

/// Whole numbers of a width that is not known: what 32 bits hold, with a sign or without.
pub(super) const WIDEST: (i64, i64) = (i32::MIN as i64, u32::MAX as i64);

/// What a comparison says.
pub(super) enum Said {
    Constant(bool),
    /// Of a term.
    Bound(ExprId, Bound),
    /// Of two terms, in the order of their ids.
    Relation(Comparison, ExprId, ExprId),
    Unknown,
}

/// What atoms are about: laws tie those with one subject to one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Subject {
    /// A bit of a version.
    Bit(ObjectId, u32),
    Term(ExprId),
    Relation(ExprId, ExprId),
}

/// A comparison of a term with a constant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    op: Comparison,
    constant: Constant,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Constant {
    Int(i64),
    Float(f64),
}

impl Constant {
    pub(super) fn as_f64(self) -> f64 {
        match self {
            // Whole numbers of PLC programs have at most 32 bits, which an f64 holds exactly.
            Self::Int(value) => value as f64,
            Self::Float(value) => value,
        }
    }
}

/// What an atom says.
#[derive(Debug, Clone, Copy)]
pub(super) enum Atom {
    /// A bit of a version.
    Bit(ObjectId, u32),
    /// Whether it rises.
    Edge(ObjectId, u32, bool),
    /// Of a term: index into the terms.
    Bound(usize, Bound),
    Relation(Comparison, ExprId, ExprId),
    Unknown,
}

/// A node of the conditions; operands are indices of nodes before it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Gate {
    Constant(bool),
    Not(usize),
    And(usize, usize),
    Or(usize, usize),
    Xor(usize, usize),
    /// Index into the atoms.
    Atom(usize),
}

/// A numeric term that is compared with constants.
pub(super) struct Term {
    id: ExprId,
    is_float: bool,
    lowest: i64,
    highest: i64,
    /// Atoms that are bits of the term: which atom, which bit.
    bits: Vec<(usize, u32)>,
    /// Number of bits of the term when bits of it can be told.
    width: Option<u32>,
    /// The term is an object, which shares memory with no other term.
    is_exact: bool,
}

/// Atoms whose values depend on one another beyond what pairs of them say.
pub(super) struct Tie {
    pub(super) atoms: Vec<usize>,
    /// The values that they can have together, in the order of the atoms, the first the lowest bit.
    pub(super) cases: Vec<u32>,
}

/// The conditions of a question.
pub(super) struct Problem<'s, 'a> {
    pub(super) space: &'s Space<'a>,
    /// Sorted: operands before what they are operands of.
    pub(super) ids: Vec<ExprId>,
    pub(super) gates: Vec<Gate>,
    /// The node of each, and what it says.
    pub(super) atoms: Vec<(usize, Atom)>,
    terms: Vec<Term>,
    /// Memory of a term is that of another atom, and no law says what that means.
    is_loose: bool,
}

/// Atoms with the values that they do not have together.
pub(super) type Conflict = Vec<(usize, bool)>;

impl<'s, 'a> Problem<'s, 'a> {
    /// `None` when the conditions are too large.
    pub(super) fn new(space: &'s Space<'a>, question: &Question<'_>) -> Option<Self> {
        let ids = nodes(space, question)?;
        let (gates, atoms) = (Vec::with_capacity(ids.len()), Vec::with_capacity(ids.len()));
        let mut problem = Self { space, gates, ids, atoms, terms: Vec::new(), is_loose: false };
        for at in 0..problem.ids.len() {
            let node = |id: ExprId| problem.node(id);
            let gate = match *space.exprs.get(problem.ids[at]) {
                Expr::Bool(value) => Gate::Constant(value),
                Expr::Not(a) => Gate::Not(node(a)),
                Expr::And(a, b) => Gate::And(node(a), node(b)),
                Expr::Or(a, b) => Gate::Or(node(a), node(b)),
                Expr::Xor(a, b) => Gate::Xor(node(a), node(b)),
                Expr::Read { object, version } => problem.atom(at, Atom::Bit(object, version)),
                Expr::Edge { object, version, rising } => problem.atom(at, Atom::Edge(object, version, rising)),
                Expr::Compare(op, a, b) => match problem.comparison(op, a, b) {
                    Ok(value) => Gate::Constant(value),
                    Err(atom) => problem.atom(at, atom),
                },
                _ => problem.atom(at, Atom::Unknown),
            };
            problem.gates.push(gate);
        }
        problem.find_bits();
        (problem.atoms.len() <= MAX_ATOMS).then_some(problem)
    }

    /// The node of an expression of the conditions.
    pub(super) fn node(&self, id: ExprId) -> usize {
        self.ids.binary_search(&id).unwrap_or(0)
    }

    fn atom(&mut self, node: usize, atom: Atom) -> Gate {
        self.atoms.push((node, atom));
        Gate::Atom(self.atoms.len() - 1)
    }

    /// What a comparison says; its value where it has only one.
    fn comparison(&mut self, op: Comparison, a: ExprId, b: ExprId) -> Result<bool, Atom> {
        Err(match self.space.said(op, a, b) {
            Said::Constant(value) => return Ok(value),
            Said::Bound(term, bound) => Atom::Bound(self.term(term, bound.constant), bound),
            Said::Relation(op, a, b) => Atom::Relation(op, a, b),
            Said::Unknown => Atom::Unknown,
        })
    }

    /// Whether it says of each term that it compares whether it is a whole number without asking what it is compared with:
    /// only then what one question teaches holds for others.
    pub(super) fn is_typed(&self) -> bool {
        let is_float = |it: &Term| self.space.read_of(it.id).is_some_and(|it| it.0.ty == Type::Float);
        self.terms.iter().all(|it| !it.is_float || is_float(it))
    }

    /// Whether what explains the values of its atoms leaves no law of their memory out.
    pub(super) fn is_tight(&self) -> bool {
        !self.is_loose
    }

    pub(super) fn subject(&self, atom: &Atom) -> Option<Subject> {
        match *atom {
            Atom::Bit(object, version) | Atom::Edge(object, version, _) => Some(Subject::Bit(object, version)),
            Atom::Bound(term, _) => self.terms.get(term).map(|it| Subject::Term(it.id)),
            Atom::Relation(_, a, b) => Some(Subject::Relation(a, b)),
            Atom::Unknown => None,
        }
    }

    fn term(&mut self, id: ExprId, constant: Constant) -> usize {
        let is_float = matches!(constant, Constant::Float(_));
        if let Some(at) = self.terms.iter().position(|it| it.id == id) {
            self.terms[at].is_float |= is_float;
            return at;
        }
        let object = self.space.read_of(id).map(|it| it.0);
        let domain = self.space.domain(id);
        let (lowest, highest) = domain.unwrap_or(WIDEST);
        let is_float = is_float || object.is_some_and(|it| it.ty == Type::Float);
        let width = object.filter(|_| domain.is_some()).and_then(|it| it.ty.bits());
        // A symbol whose type is not known is a number of some width.
        let is_exact = object.is_some_and(|it| it.is_fixed() && !it.ty.is_table());
        self.terms.push(Term { id, is_float, lowest, highest, bits: Vec::new(), width, is_exact });
        self.terms.len() - 1
    }

    /// Finds which atoms are bits of which terms, and which terms share memory. A bit is one of a word when nothing wrote
    /// one of them without the other since both had their values: when their versions are equal.
    fn find_bits(&mut self) {
        if self.terms.is_empty() {
            return;
        }
        let object_of = |id: ExprId| self.space.read_of(id).filter(|it| it.0.is_fixed());
        let objects: Vec<Option<(&Object, u32)>> = self.terms.iter().map(|it| object_of(it.id)).collect();
        for at in 0..self.terms.len() {
            let Some((object, version)) = objects[at] else { continue };
            let overlaps = |(other, it): (usize, &Option<(&Object, u32)>)| {
                other != at && it.is_some_and(|it| it.1 == version && it.0.footprint.overlaps(&object.footprint))
            };
            let is_shared = objects.iter().enumerate().any(overlaps);
            let mut bits = Vec::new();
            let mut overlapping = 0;
            for (index, (_, atom)) in self.atoms.iter().enumerate() {
                if let Atom::Bit(bit, of) | Atom::Edge(bit, of, _) = atom
                    && *of == version
                    && let Some(bit) = self.space.objects.get(*bit)
                    && bit.footprint.overlaps(&object.footprint)
                {
                    overlapping += 1;
                    let place = self.space.bit_of(bit, object).filter(|_| matches!(atom, Atom::Bit(..)));
                    bits.extend(place.map(|it| (index, it)));
                }
            }
            let term = &mut self.terms[at];
            term.is_exact &= !is_shared;
            if term.width.is_some() && !term.is_float && !is_shared {
                self.is_loose |= bits.len() < overlapping;
                term.bits = bits;
            } else {
                self.is_loose |= is_shared || overlapping > 0;
                term.is_exact &= bits.is_empty();
            }
        }
    }

    /// What holds of edges: a rising bit is 1, a falling one 0, a bit does not do both. Each is two values that no two atoms
    /// have together.
    pub(super) fn edge_laws(&self) -> Vec<[(usize, bool); 2]> {
        let mut laws = Vec::new();
        for (a, (_, first)) in self.atoms.iter().enumerate() {
            if !matches!(first, Atom::Edge(..)) {
                continue;
            }
            for (b, (_, second)) in self.atoms.iter().enumerate() {
                if a < b || matches!(second, Atom::Bit(..)) {
                    laws.extend(self.excluded(first, second).map(|(x, y)| [(a, x), (b, y)]));
                }
            }
        }
        laws
    }

    /// Values that two atoms do not have together: what edges are of their bits, and what two comparisons of one term, or of
    /// two terms with one another, exclude. The latter follows from [`Self::ties`], and is what a solver wants to know
    /// before it starts.
    pub(super) fn excluded(&self, first: &Atom, second: &Atom) -> impl Iterator<Item = (bool, bool)> + use<> {
        const VALUES: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];
        let agree = |(p, q): (bool, bool)| match (*first, *second) {
            (Atom::Edge(x, version, _), Atom::Edge(y, of, _)) if (x, version) == (y, of) => !(p && q),
            (Atom::Edge(x, version, rising), Atom::Bit(y, of)) if (x, version) == (y, of) => !p || q == rising,
            (Atom::Bit(x, version), Atom::Edge(y, of, rising)) if (x, version) == (y, of) => !q || p == rising,
            (Atom::Bound(x, one), Atom::Bound(y, other)) if x == y => {
                self.terms[x].value(&[one.with(p), other.with(q)], &[]).is_some()
            }
            (Atom::Relation(one, x, y), Atom::Relation(other, u, v)) if (x, y) == (u, v) => {
                order(&[with(one, p), with(other, q)]).is_some()
            }
            _ => true,
        };
        let excluded = VALUES.map(|it| !agree(it));
        VALUES.into_iter().zip(excluded).filter_map(|(values, is_excluded)| is_excluded.then_some(values))
    }

    /// The values that comparisons of one term, with its bits, have together; those of two terms with one another. `None`
    /// when that is too much to tell. At most 32 atoms are tied together.
    pub(super) fn ties(&self) -> Option<Vec<Tie>> {
        /// Of more bits of one term, the cases are not told.
        const MOST_BITS: usize = 6;
        let mut ties = Vec::new();
        for (at, term) in self.terms.iter().enumerate() {
            let bounds: Vec<(usize, Bound)> = (0..)
                .zip(&self.atoms)
                .filter_map(|(index, (_, atom))| match *atom {
                    Atom::Bound(of, bound) if of == at => Some((index, bound)),
                    _ => None,
                })
                .collect();
            if term.bits.len() > MOST_BITS || bounds.len() + term.bits.len() > 32 {
                return None;
            }
            ties.push(term.tie(&bounds));
        }
        let mut related: Vec<(ExprId, ExprId)> = Vec::new();
        for (at, (_, atom)) in self.atoms.iter().enumerate() {
            let Atom::Relation(_, a, b) = *atom else { continue };
            if related.contains(&(a, b)) {
                continue;
            }
            related.push((a, b));
            let mut tie = Tie { atoms: Vec::new(), cases: vec![0; 3] };
            for (index, (_, atom)) in self.atoms.iter().enumerate().skip(at) {
                let Atom::Relation(op, x, y) = *atom else { continue };
                if (x, y) != (a, b) {
                    continue;
                }
                for (case, (order, _)) in tie.cases.iter_mut().zip(ORDERS) {
                    *case |= u32::from(op.holds(order)) << tie.atoms.len();
                }
                tie.atoms.push(index);
            }
            ties.extend(Some(tie).filter(|it| it.atoms.len() > 1));
        }
        Some(ties)
    }

    /// The answer to a question that leaves no choice: atoms, or their opposites, that all have to hold. `None` of any other.
    pub(super) fn forced(&self, question: &Question<'_>) -> Option<Answer> {
        if !question.never.is_empty() {
            return None;
        }
        let mut values = vec![None; self.atoms.len()];
        let mut open: Vec<(usize, bool)> = question.wanted.iter().map(|&(id, value)| (self.node(id), value)).collect();
        while let Some((node, value)) = open.pop() {
            match (self.gates[node], value) {
                (Gate::Constant(it), _) if it != value => return Some(Answer::Never),
                (Gate::Constant(_), _) => {}
                (Gate::Not(a), _) => open.push((a, !value)),
                (Gate::And(a, b), true) | (Gate::Or(a, b), false) => open.extend([(a, value), (b, value)]),
                (Gate::And(..) | Gate::Or(..) | Gate::Xor(..), _) => return None,
                (Gate::Atom(at), _) if values[at].replace(value).is_some_and(|before| before != value) => {
                    return Some(Answer::Never);
                }
                (Gate::Atom(_), _) => {}
            }
        }
        let breaks = |[(a, x), (b, y)]: [(usize, bool); 2]| values[a] == Some(x) && values[b] == Some(y);
        if self.edge_laws().into_iter().any(breaks) {
            return Some(Answer::Never);
        }
        Some(self.explain(&values).map_or(Answer::Never, Answer::Possible))
    }

    /// Values of all nodes as far as those of the atoms tell.
    fn evaluate(&self, values: &[Option<bool>], known: &mut Vec<Option<bool>>) {
        known.clear();
        for gate in &self.gates {
            let value = match *gate {
                Gate::Constant(value) => Some(value),
                Gate::Not(a) => known[a].map(|it: bool| !it),
                Gate::And(a, b) => match (known[a], known[b]) {
                    (Some(false), _) | (_, Some(false)) => Some(false),
                    (Some(true), Some(true)) => Some(true),
                    _ => None,
                },
                Gate::Or(a, b) => match (known[a], known[b]) {
                    (Some(true), _) | (_, Some(true)) => Some(true),
                    (Some(false), Some(false)) => Some(false),
                    _ => None,
                },
                Gate::Xor(a, b) => known[a].zip(known[b]).map(|(a, b)| a != b),
                Gate::Atom(at) => values[at],
            };
            known.push(value);
        }
    }

    /// Values of atoms that answer a question, told as values of objects: without those on which the answer does not
    /// depend. What no values of objects agree with is a conflict.
    pub(super) fn witness(&self, values: &mut [Option<bool>], question: &Question<'_>) -> Result<Witness, Conflict> {
        self.forget_needless(values, question);
        self.explain(values)
    }

    /// Leaves out the atoms on which the wanted values do not depend, given the others.
    fn forget_needless(&self, values: &mut [Option<bool>], question: &Question<'_>) {
        let mut known: Vec<Option<bool>> = Vec::with_capacity(self.gates.len());
        for at in 0..values.len() {
            let before = values[at].take();
            self.evaluate(values, &mut known);
            let is = |id: ExprId, value: bool| known[self.node(id)] == Some(value);
            let holds = question.wanted.iter().all(|&(id, value)| is(id, value))
                && question.never.iter().all(|&[a, b]| is(a, false) || is(b, false));
            if !holds {
                values[at] = before;
            }
        }
    }

    /// Values of the terms that agree with those of the atoms, or atoms that no values agree with.
    pub(super) fn explain(&self, values: &[Option<bool>]) -> Result<Witness, Conflict> {
        let mut given = Vec::new();
        let mut assumed = false;
        let mut explained = vec![false; self.terms.len()];
        let mut related: Vec<(ExprId, ExprId)> = Vec::new();
        for (at, (node, atom)) in self.atoms.iter().enumerate() {
            let Some(value) = values[at] else { continue };
            match *atom {
                Atom::Bit(object, _) => {
                    // Of a word that is compared as well, the word's value says it.
                    let is_part = |it: &Term| it.bits.iter().any(|bit| bit.0 == at) && self.is_asked(it, values);
                    if !self.terms.iter().any(is_part) {
                        given.push(Given::Bit(object, value));
                    }
                }
                Atom::Edge(object, _, rising) => given.push(Given::Edge { object, rising, value }),
                Atom::Bound(term, _) => {
                    if !std::mem::replace(&mut explained[term], true) {
                        let (bounds, bits, asked) = self.asked(term, values);
                        let it = &self.terms[term];
                        assumed |= !it.is_exact;
                        given.push(it.value(&bounds, &bits).ok_or(asked)?);
                    }
                }
                Atom::Relation(_, a, b) => {
                    if !related.contains(&(a, b)) {
                        related.push((a, b));
                        let (ops, asked) = self.relations((a, b), values);
                        assumed = true;
                        let op = order(&ops).ok_or(asked)?;
                        given.push(Given::Relation(op, a, b));
                    }
                }
                Atom::Unknown => {
                    assumed = true;
                    given.push(Given::Unknown(self.ids[*node], value));
                }
            }
        }
        Ok(Witness { given, assumed })
    }

    fn is_asked(&self, term: &Term, values: &[Option<bool>]) -> bool {
        self.atoms.iter().zip(values).any(|((_, atom), value)| {
            value.is_some() && matches!(*atom, Atom::Bound(of, _) if self.terms[of].id == term.id)
        })
    }

    /// What is asked of a term, and the atoms that ask it.
    fn asked(&self, term: usize, values: &[Option<bool>]) -> (Vec<Bound>, Vec<(u32, bool)>, Conflict) {
        let (mut bounds, mut bits, mut asked) = (Vec::new(), Vec::new(), Vec::new());
        for (at, (_, atom)) in self.atoms.iter().enumerate() {
            let Some(value) = values[at] else { continue };
            if let Atom::Bound(of, bound) = *atom
                && of == term
            {
                bounds.push(bound.with(value));
                asked.push((at, value));
            }
            for &(_, bit) in self.terms[term].bits.iter().filter(|it| it.0 == at) {
                bits.push((bit, value));
                asked.push((at, value));
            }
        }
        (bounds, bits, asked)
    }

    fn relations(&self, of: (ExprId, ExprId), values: &[Option<bool>]) -> (Vec<Comparison>, Conflict) {
        let (mut ops, mut asked) = (Vec::new(), Vec::new());
        for (at, (_, atom)) in self.atoms.iter().enumerate() {
            if let (Atom::Relation(op, a, b), Some(value)) = (*atom, values[at])
                && (a, b) == of
            {
                ops.push(with(op, value));
                asked.push((at, value));
            }
        }
        (ops, asked)
    }
}

/// What the conditions of a question are made of, sorted; `None` when that is too much.
fn nodes(space: &Space<'_>, question: &Question<'_>) -> Option<Vec<ExprId>> {
    /// Fewer than these are looked through, more are hashed.
    const FEW: usize = 48;
    let mut nodes: Vec<ExprId> = Vec::with_capacity(FEW);
    let mut many = rustc_hash::FxHashSet::default();
    let mut stack: Vec<ExprId> = Vec::with_capacity(FEW);
    stack.extend(question.wanted.iter().map(|it| it.0));
    stack.extend(question.never.iter().flatten());
    while let Some(id) = stack.pop() {
        let is_new = if nodes.len() < FEW {
            !nodes.contains(&id)
        } else {
            if many.is_empty() {
                many.extend(nodes.iter().copied());
            }
            many.insert(id)
        };
        if !is_new {
            continue;
        }
        nodes.push(id);
        if nodes.len() > MAX_NODES {
            return None;
        }
        match *space.exprs.get(id) {
            Expr::Not(a) => stack.push(a),
            Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => stack.extend([a, b]),
            _ => {}
        }
    }
    nodes.sort_unstable();
    Some(nodes)
}

/// How two terms can stand to one another, the likeliest first.
const ORDERS: [(Ordering, Comparison); 3] =
    [(Ordering::Equal, Comparison::Eq), (Ordering::Less, Comparison::Lt), (Ordering::Greater, Comparison::Gt)];

fn with(op: Comparison, value: bool) -> Comparison {
    if value { op } else { op.negated() }
}

/// A relation in which two terms can stand, given what holds of them.
fn order(ops: &[Comparison]) -> Option<Comparison> {
    ORDERS.into_iter().find(|(order, _)| ops.iter().all(|it| it.holds(*order))).map(|it| it.1)
}

impl Bound {
    pub(super) fn new(op: Comparison, constant: Constant) -> Self {
        Self { op, constant }
    }

    fn with(self, value: bool) -> Self {
        Self { op: with(self.op, value), ..self }
    }

    pub(super) fn holds(self, value: f64) -> bool {
        value.partial_cmp(&self.constant.as_f64()).is_some_and(|order| self.op.holds(order))
    }
}

impl Term {
    /// The values of the term's comparisons and bits.
    fn tie(&self, bounds: &[(usize, Bound)]) -> Tie {
        let atoms = bounds.iter().map(|it| it.0).chain(self.bits.iter().map(|it| it.0)).collect();
        let of_bounds =
            |value: f64| bounds.iter().enumerate().fold(0, |case, (at, it)| case | u32::from(it.1.holds(value)) << at);
        let mut cases: Vec<u32> = Vec::new();
        if self.is_float {
            let samples = samples(bounds.iter().map(|it| it.1.constant.as_f64()).collect());
            cases.extend(samples.into_iter().map(of_bounds));
        } else {
            for (first, last) in self.ranges(bounds) {
                let case = of_bounds(first as f64);
                if self.bits.is_empty() {
                    cases.push(case);
                    continue;
                }
                for values in 0..1_u32 << self.bits.len() {
                    let bits: Vec<(u32, bool)> =
                        self.bits.iter().enumerate().map(|(at, it)| (it.1, values >> at & 1 == 1)).collect();
                    if self.with_bits(first, &bits).is_some_and(|it| it <= last) {
                        cases.push(case | values << bounds.len());
                    }
                }
            }
        }
        cases.sort_unstable();
        cases.dedup();
        Tie { atoms, cases }
    }

    /// Ranges of the term's whole numbers in which no comparison changes.
    fn ranges(&self, bounds: &[(usize, Bound)]) -> Vec<(i64, i64)> {
        let constants = bounds.iter().filter_map(|it| match it.1.constant {
            Constant::Int(value) => Some(value),
            Constant::Float(_) => None,
        });
        let mut starts: Vec<i64> = constants.flat_map(|it| [it, it.saturating_add(1)]).collect();
        starts.push(self.lowest);
        starts.retain(|it| (self.lowest..=self.highest).contains(it));
        starts.sort_unstable();
        starts.dedup();
        let ends = starts.iter().skip(1).map(|it| it - 1).chain([self.highest]);
        starts.iter().copied().zip(ends).collect()
    }

    /// The smallest number from one on that has some bits.
    fn with_bits(&self, from: i64, bits: &[(u32, bool)]) -> Option<i64> {
        next_with_bits(from, self.width?, self.lowest < 0, bits)
    }

    /// A value that agrees with all bounds and bits.
    fn value(&self, bounds: &[Bound], bits: &[(u32, bool)]) -> Option<Given> {
        if self.is_float {
            let holds = |value: &f64| bounds.iter().all(|it| it.holds(*value));
            let samples = samples(bounds.iter().map(|it| it.constant.as_f64()).collect());
            return samples.into_iter().find(holds).map(|it| Given::Number(self.id, it));
        }
        let (mut first, mut last) = (self.lowest, self.highest);
        let mut excluded: Vec<i64> = Vec::new();
        for bound in bounds {
            let Constant::Int(constant) = bound.constant else { continue };
            match bound.op {
                Comparison::Lt => last = last.min(constant.saturating_sub(1)),
                Comparison::Le => last = last.min(constant),
                Comparison::Gt => first = first.max(constant.saturating_add(1)),
                Comparison::Ge => first = first.max(constant),
                Comparison::Eq => (first, last) = (first.max(constant), last.min(constant)),
                Comparison::Ne => excluded.push(constant),
            }
        }
        excluded.sort_unstable();
        if bits.is_empty() {
            for &it in &excluded {
                if it == first {
                    first += 1;
                }
            }
            // Up to the next value that is excluded.
            last = excluded.iter().find(|it| **it > first).map_or(last, |it| last.min(it - 1));
            return (first <= last).then_some(Given::Whole(self.id, first, last));
        }
        let smallest = |mut from: i64| loop {
            let value = self.with_bits(from, bits).filter(|it| *it <= last)?;
            if excluded.binary_search(&value).is_err() {
                return Some(Given::Whole(self.id, value, value));
            }
            from = value + 1;
        };
        // One that a reader would choose.
        smallest(first.max(0)).or_else(|| smallest(first.max(-4))).or_else(|| smallest(first))
    }
}

/// A number below, at, between and above some constants.
fn samples(mut constants: Vec<f64>) -> Vec<f64> {
    constants.sort_by(f64::total_cmp);
    constants.dedup();
    let mut all = Vec::with_capacity(constants.len() * 2 + 1);
    all.extend(constants.first().map(|it| it - 1.0));
    for pair in constants.windows(2) {
        all.extend([pair[0], f64::midpoint(pair[0], pair[1])]);
    }
    all.extend(constants.last().into_iter().flat_map(|it| [*it, it + 1.0]));
    all
}

/// The smallest number from `from` on whose bits are as given.
fn next_with_bits(from: i64, width: u32, is_signed: bool, bits: &[(u32, bool)]) -> Option<i64> {
    // With the sign bit turned over, signed numbers are in the order of unsigned ones.
    let (all, sign) = ((1_u64 << width) - 1, if is_signed { 1_u64 << (width - 1) } else { 0 });
    let (mut mask, mut fixed) = (0_u64, 0_u64);
    for &(bit, value) in bits.iter().filter(|it| it.0 < width) {
        let it = 1_u64 << bit;
        if mask & it != 0 && (fixed & it != 0) != value {
            return None;
        }
        mask |= it;
        fixed |= if value { it } else { 0 };
    }
    let lowest = if is_signed { -(1_i64 << (width - 1)) } else { 0 };
    let from = u64::try_from(from.max(lowest) - lowest).ok().filter(|it| *it <= all)?;
    let fixed = fixed ^ (sign & mask);
    let number = |it: u64| i64::try_from(it).ok().map(|it| it + lowest);
    if from & mask == fixed {
        return number(from);
    }
    // Equal to `from` above some bit, 1 where it has 0 there, and as small as can be below.
    (0..width).find_map(|bit| {
        let it = 1_u64 << bit;
        let above = all & !(it | (it - 1));
        let can_rise = from & it == 0 && (mask & it == 0 || fixed & it != 0);
        let agrees = (from & mask) & above == fixed & above;
        (can_rise && agrees).then_some((from & above) | it | (fixed & (it - 1))).and_then(number)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::next_with_bits;

    proptest! {
        #[test]
        fn the_next_number_with_bits(from in -140_i64..130, bits in prop::collection::vec((0..8_u32, any::<bool>()), 0..4)) {
            let has = |it: i64| bits.iter().all(|&(bit, value)| (it >> bit & 1 == 1) == value);
            let expected = (from.max(-128)..=127).find(|it| has(*it));
            prop_assert_eq!(next_with_bits(from, 8, true, &bits), expected);
            let expected = (from.max(0)..=255).find(|it| has(*it));
            prop_assert_eq!(next_with_bits(from, 8, false, &bits), expected);
        }
    }
}

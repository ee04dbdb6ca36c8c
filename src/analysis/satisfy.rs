//! Whether conditions over a program's objects can hold at one moment, and with which values.
//!
//! Atoms are bits, edges and comparisons. A SAT solver finds values of the atoms; what it finds is checked against what the
//! atoms mean: the comparisons of one term with constants, and the bits that are extracted from it, agree with some value
//! of the term. What does not is a clause more, and the solver goes on. The answer is exact but where a [`Witness`] says
//! that it assumed something: two terms that are compared with one another, computed values, and words that overlap are
//! taken as free of one another.

use batsat::{BasicSolver, Lit, SolverInterface as _, Var, lbool};

use crate::model::entity::Family;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Object, Type};
use crate::target::pl7::STEP_TIMES;

/// Conditions of more nodes than this are not decided.
const MAX_NODES: usize = 4096;
const MAX_ATOMS: usize = 512;

/// Whole numbers of a width that is not known.
const WIDEST: (i64, i64) = (i32::MIN as i64, i32::MAX as i64);

/// So many candidates of the solver are refuted before the question is given up.
const MAX_ROUNDS: usize = 1000;

/// Expressions, and the objects that they are about.
pub struct Space<'a> {
    pub exprs: &'a Exprs,
    /// By [`ObjectId`].
    pub objects: &'a [&'a Object],
    pub family: Family,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    Never,
    Possible(Witness),
    NotDecided,
}

impl Answer {
    pub fn is_never(&self) -> bool {
        matches!(self, Self::Never)
    }
}

/// Values that make conditions hold, whatever all other objects are.
#[derive(Debug, Clone, PartialEq)]
pub struct Witness {
    pub given: Vec<Given>,
    /// Whether something was taken as free that may not be.
    pub assumed: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    Bit(ObjectId, bool),
    /// Whether the bit rises (or falls) at this moment.
    Edge {
        object: ObjectId,
        rising: bool,
        value: bool,
    },
    /// A term, and whole numbers that it may be; from the first to the last.
    Whole(ExprId, i64, i64),
    Number(ExprId, f64),
    /// A relation of two terms.
    Relation(Comparison, ExprId, ExprId),
    /// A bit or a comparison that is not understood, or computed.
    Unknown(ExprId, bool),
}

/// A comparison of a term with a constant that holds.
#[derive(Debug, Clone, Copy)]
struct Bound {
    op: Comparison,
    constant: Constant,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Constant {
    Int(i64),
    Float(f64),
}

impl Constant {
    fn as_f64(self) -> f64 {
        match self {
            // Whole numbers of PLC programs have at most 32 bits, which an f64 holds exactly.
            Self::Int(value) => value as f64,
            Self::Float(value) => value,
        }
    }
}

/// What an atom says.
#[derive(Debug, Clone, Copy)]
enum Atom {
    Bit(ObjectId),
    Edge(ObjectId, bool),
    /// Of a term: index into the terms.
    Bound(usize, Bound),
    Relation(Comparison, ExprId, ExprId),
    Unknown,
}

/// A numeric term that is compared with constants.
struct Term {
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

/// A question to the solver.
struct Problem<'s, 'a> {
    space: &'s Space<'a>,
    /// Sorted: operands before what they are operands of.
    nodes: Vec<ExprId>,
    /// Index into `nodes` and what it says.
    atoms: Vec<(usize, Atom)>,
    terms: Vec<Term>,
}

impl<'a> Space<'a> {
    /// Whether all conditions can have the values wanted of them at one moment.
    pub fn solve(&self, wanted: &[(ExprId, bool)]) -> Answer {
        match Problem::new(self, wanted) {
            Some(problem) => problem.solve(wanted),
            None => Answer::NotDecided,
        }
    }

    /// Whether a condition asks a step time for what it never is, or always is.
    pub fn asks_beyond_step_times(&self, condition: ExprId) -> bool {
        let mut found = false;
        self.exprs.each_comparison(condition, |op, a, b| {
            let (time, constant, op) = match (self.constant(a), self.constant(b)) {
                (None, Some(Constant::Int(constant))) => (a, constant, op),
                (Some(Constant::Int(constant)), None) => (b, constant, op.mirrored()),
                _ => return,
            };
            let is_time = |it: &Object| it.class == Class::StepTime;
            let Expr::Read { object, .. } = *self.exprs.get(time) else { return };
            if self.object(object).is_some_and(is_time)
                && let Some((first, last)) = self.domain(time)
            {
                found |= op.decided(first, last, constant).is_some();
            }
        });
        found
    }

    fn object(&self, id: ObjectId) -> Option<&'a Object> {
        self.objects.get(id.0 as usize).copied()
    }

    fn constant(&self, id: ExprId) -> Option<Constant> {
        match *self.exprs.get(id) {
            Expr::Int(value) => Some(Constant::Int(value)),
            Expr::Float(bits) => Some(Constant::Float(f64::from_bits(bits))).filter(|it| it.as_f64().is_finite()),
            _ => None,
        }
    }

    /// A term as a message names it.
    fn name(&self, id: ExprId) -> String {
        match *self.exprs.get(id) {
            Expr::Read { object, .. } => self.object_name(object),
            Expr::Int(value) => value.to_string(),
            Expr::Float(bits) => f64::from_bits(bits).to_string(),
            _ => "a computed value".to_owned(),
        }
    }

    fn object_name(&self, id: ObjectId) -> String {
        self.object(id).map_or_else(|| "?".to_owned(), |it| format!("`{}`", it.text))
    }

    /// A part of a witness as a message says it: `` `%MW10` in 15..20 ``.
    pub fn describe(&self, given: &Given) -> String {
        let bit = |value: bool| u8::from(value);
        match *given {
            Given::Bit(object, value) => format!("{} = {}", self.object_name(object), bit(value)),
            Given::Edge { object, rising, value } => {
                let (name, edge) = (self.object_name(object), if rising { "rising" } else { "falling" });
                if value { format!("{name} {edge}") } else { format!("{name} not {edge}") }
            }
            Given::Whole(term, first, last) => {
                let name = self.name(term);
                let (lowest, highest) = self.domain(term).unwrap_or(WIDEST);
                match (first == last, first <= lowest, last >= highest) {
                    (true, ..) => format!("{name} = {first}"),
                    (_, true, true) => format!("any {name}"),
                    (_, true, false) => format!("{name} <= {last}"),
                    (_, false, true) => format!("{name} >= {first}"),
                    (_, false, false) => format!("{name} in {first}..{last}"),
                }
            }
            Given::Number(term, value) => format!("{} = {value}", self.name(term)),
            Given::Relation(op, a, b) => format!("{} {} {}", self.name(a), op.as_str(), self.name(b)),
            Given::Unknown(id, value) => match *self.exprs.get(id) {
                Expr::Compare(op, a, b) => {
                    let op = if value { op } else { op.negated() };
                    format!("{} {} {}", self.name(a), op.as_str(), self.name(b))
                }
                _ => format!("a condition that is not understood = {}", bit(value)),
            },
        }
    }

    /// The values that a whole number can have.
    fn domain(&self, term: ExprId) -> Option<(i64, i64)> {
        let Expr::Read { object, .. } = *self.exprs.get(term) else { return None };
        let object = self.object(object)?;
        Some(match (object.class, object.ty) {
            (Class::StepTime, Type::Word) => (STEP_TIMES.first.into(), STEP_TIMES.last.into()),
            (_, Type::Byte) => (0, 255),
            (_, Type::Word) => (i16::MIN.into(), i16::MAX.into()),
            (_, Type::Double) => (i32::MIN.into(), i32::MAX.into()),
            _ => return None,
        })
    }

    /// The place of a bit in the value of a word that holds it.
    fn bit_of(&self, bit: &Object, word: &Object) -> Option<u32> {
        let width = word.ty.bits().filter(|it| matches!(it, 8 | 16 | 32))?;
        let is_held = bit.is_fixed() && word.is_fixed() && word.footprint.contains(&bit.footprint);
        let at = bit.footprint.start.checked_sub(word.footprint.start).filter(|_| is_held)?;
        // Siemens words have their most significant byte first.
        Some(if self.family.has_blocks() { (width / 8 - 1 - at / 8) * 8 + at % 8 } else { at })
    }
}

impl<'s, 'a> Problem<'s, 'a> {
    /// `None` when the conditions are too large.
    fn new(space: &'s Space<'a>, wanted: &[(ExprId, bool)]) -> Option<Self> {
        let exprs = space.exprs;
        let mut seen = rustc_hash::FxHashSet::default();
        let mut stack: Vec<ExprId> = wanted.iter().map(|it| it.0).collect();
        while let Some(id) = stack.pop() {
            if !seen.insert(id) {
                continue;
            }
            if seen.len() > MAX_NODES {
                return None;
            }
            match *exprs.get(id) {
                Expr::Not(a) => stack.push(a),
                Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => stack.extend([a, b]),
                _ => {}
            }
        }
        let mut nodes: Vec<ExprId> = seen.into_iter().collect();
        nodes.sort_unstable();
        let mut problem = Self { space, nodes, atoms: Vec::new(), terms: Vec::new() };
        for at in 0..problem.nodes.len() {
            let id = problem.nodes[at];
            let atom = match *exprs.get(id) {
                Expr::Bool(_) | Expr::Not(_) | Expr::And(..) | Expr::Or(..) | Expr::Xor(..) => continue,
                Expr::Read { object, .. } => Atom::Bit(object),
                Expr::Edge { object, rising, .. } => Atom::Edge(object, rising),
                Expr::Compare(op, a, b) => problem.comparison(op, a, b),
                _ => Atom::Unknown,
            };
            problem.atoms.push((at, atom));
        }
        problem.find_bits();
        (problem.atoms.len() <= MAX_ATOMS).then_some(problem)
    }

    fn comparison(&mut self, op: Comparison, a: ExprId, b: ExprId) -> Atom {
        match (self.space.constant(a), self.space.constant(b)) {
            (None, Some(constant)) => Atom::Bound(self.term(a, constant), Bound { op, constant }),
            (Some(constant), None) => Atom::Bound(self.term(b, constant), Bound { op: op.mirrored(), constant }),
            (None, None) if a <= b => Atom::Relation(op, a, b),
            (None, None) => Atom::Relation(op.mirrored(), b, a),
            (Some(_), Some(_)) => Atom::Unknown,
        }
    }

    fn term(&mut self, id: ExprId, constant: Constant) -> usize {
        let is_float = matches!(constant, Constant::Float(_));
        if let Some(at) = self.terms.iter().position(|it| it.id == id) {
            self.terms[at].is_float |= is_float;
            return at;
        }
        let object = match *self.space.exprs.get(id) {
            Expr::Read { object, .. } => self.space.object(object),
            _ => None,
        };
        let domain = self.space.domain(id);
        let (lowest, highest) = domain.unwrap_or(WIDEST);
        let is_float = is_float || object.is_some_and(|it| it.ty == Type::Float);
        let width = object.filter(|_| domain.is_some()).and_then(|it| it.ty.bits());
        // A symbol whose type is not known is a number of some width.
        let is_exact = object.is_some_and(|it| it.is_fixed() && !it.ty.is_table());
        self.terms.push(Term { id, is_float, lowest, highest, bits: Vec::new(), width, is_exact });
        self.terms.len() - 1
    }

    /// Finds which atoms are bits of which terms, and which terms share memory.
    fn find_bits(&mut self) {
        let object_of = |id: ExprId| match *self.space.exprs.get(id) {
            Expr::Read { object, .. } => self.space.object(object).filter(|it| it.is_fixed()),
            _ => None,
        };
        let objects: Vec<Option<&Object>> = self.terms.iter().map(|it| object_of(it.id)).collect();
        for at in 0..self.terms.len() {
            let Some(object) = objects[at] else { continue };
            let overlaps = |(other, it): (usize, &Option<&Object>)| {
                other != at && it.is_some_and(|it| it.footprint.overlaps(&object.footprint))
            };
            let is_shared = objects.iter().enumerate().any(overlaps);
            let mut bits = Vec::new();
            for (index, (_, atom)) in self.atoms.iter().enumerate() {
                if let Atom::Bit(bit) | Atom::Edge(bit, _) = atom
                    && let Some(bit) = self.space.object(*bit)
                    && bit.footprint.overlaps(&object.footprint)
                {
                    let place = self.space.bit_of(bit, object).filter(|_| matches!(atom, Atom::Bit(_)));
                    bits.extend(place.map(|it| (index, it)));
                }
            }
            let term = &mut self.terms[at];
            term.is_exact &= !is_shared;
            if term.width.is_some() && !term.is_float && !is_shared {
                term.bits = bits;
            } else {
                term.is_exact &= bits.is_empty();
            }
        }
    }

    fn solve(&self, wanted: &[(ExprId, bool)]) -> Answer {
        let mut solver = BasicSolver::default();
        let vars: Vec<Var> = self.nodes.iter().map(|_| solver.new_var_default()).collect();
        let place = |id: ExprId| self.nodes.binary_search(&id).unwrap_or(0);
        let lit = |id: ExprId, value: bool| Lit::new(vars[place(id)], value);
        let atom_lit = |atom: usize, value: bool| Lit::new(vars[self.atoms[atom].0], value);
        let mut clause = Vec::new();
        let mut add = |solver: &mut BasicSolver, lits: &[Lit]| {
            clause.clear();
            clause.extend_from_slice(lits);
            solver.add_clause_reuse(&mut clause);
        };
        // What each node is, by Tseitin.
        for &id in &self.nodes {
            let (yes, no) = (lit(id, true), lit(id, false));
            match *self.space.exprs.get(id) {
                Expr::Bool(value) => add(&mut solver, &[lit(id, value)]),
                Expr::Not(a) => {
                    add(&mut solver, &[yes, lit(a, true)]);
                    add(&mut solver, &[no, lit(a, false)]);
                }
                Expr::And(a, b) => {
                    add(&mut solver, &[no, lit(a, true)]);
                    add(&mut solver, &[no, lit(b, true)]);
                    add(&mut solver, &[yes, lit(a, false), lit(b, false)]);
                }
                Expr::Or(a, b) => {
                    add(&mut solver, &[yes, lit(a, false)]);
                    add(&mut solver, &[yes, lit(b, false)]);
                    add(&mut solver, &[no, lit(a, true), lit(b, true)]);
                }
                Expr::Xor(a, b) => {
                    add(&mut solver, &[no, lit(a, true), lit(b, true)]);
                    add(&mut solver, &[no, lit(a, false), lit(b, false)]);
                    add(&mut solver, &[yes, lit(a, true), lit(b, false)]);
                    add(&mut solver, &[yes, lit(a, false), lit(b, true)]);
                }
                _ => {}
            }
        }
        for lits in self.laws() {
            let lits: Vec<Lit> = lits.into_iter().map(|(atom, value)| atom_lit(atom, value)).collect();
            add(&mut solver, &lits);
        }
        let assumptions: Vec<Lit> = wanted.iter().map(|&(id, value)| lit(id, value)).collect();
        for _ in 0..MAX_ROUNDS {
            match solver.solve_limited(&assumptions) {
                it if it == lbool::FALSE => return Answer::Never,
                it if it == lbool::TRUE => {}
                _ => return Answer::NotDecided,
            }
            let values = (0..self.atoms.len()).map(|it| Some(solver.value_lit(atom_lit(it, true)) == lbool::TRUE));
            let mut values: Vec<Option<bool>> = values.collect();
            self.forget_needless(&mut values, wanted);
            match self.explain(&values) {
                Ok(witness) => return Answer::Possible(witness),
                Err(conflict) => {
                    let lits: Vec<Lit> = conflict.into_iter().map(|(atom, value)| atom_lit(atom, !value)).collect();
                    add(&mut solver, &lits);
                }
            }
        }
        Answer::NotDecided
    }

    /// Clauses that hold of any two atoms: a rising bit is 1, a falling one 0, a bit does not do both; what two comparisons
    /// of one term, or of two terms with one another, say.
    fn laws(&self) -> Vec<[(usize, bool); 2]> {
        let mut laws = Vec::new();
        for (a, (_, first)) in self.atoms.iter().enumerate() {
            for (b, (_, second)) in self.atoms.iter().enumerate().skip(a + 1) {
                match (*first, *second) {
                    (Atom::Edge(x, _), Atom::Edge(y, _)) if x == y => laws.push([(a, false), (b, false)]),
                    (Atom::Edge(x, rising), Atom::Bit(y)) if x == y => laws.push([(a, false), (b, rising)]),
                    (Atom::Bit(x), Atom::Edge(y, rising)) if x == y => laws.push([(b, false), (a, rising)]),
                    (Atom::Bound(x, one), Atom::Bound(y, other)) if x == y => {
                        for (p, q) in [(false, false), (false, true), (true, false), (true, true)] {
                            let bounds = [(one, p), (other, q)].map(|(it, value)| it.with(value));
                            if self.terms[x].value(&bounds, &[]).is_none() {
                                laws.push([(a, !p), (b, !q)]);
                            }
                        }
                    }
                    (Atom::Relation(one, x, y), Atom::Relation(other, u, v)) if (x, y) == (u, v) => {
                        for (p, q) in [(false, false), (false, true), (true, false), (true, true)] {
                            if order(&[with(one, p), with(other, q)]).is_none() {
                                laws.push([(a, !p), (b, !q)]);
                            }
                        }
                    }
                    _ => {}
                }
            }
        }
        laws
    }

    /// Leaves out the atoms on which the wanted values do not depend, given the others.
    fn forget_needless(&self, values: &mut [Option<bool>], wanted: &[(ExprId, bool)]) {
        let mut known: Vec<Option<bool>> = vec![None; self.nodes.len()];
        for at in 0..values.len() {
            let before = values[at].take();
            self.evaluate(values, &mut known);
            let holds =
                |&(id, value): &(ExprId, bool)| self.nodes.binary_search(&id).is_ok_and(|it| known[it] == Some(value));
            if !wanted.iter().all(holds) {
                values[at] = before;
            }
        }
    }

    /// Values of all nodes as far as those of the atoms tell.
    fn evaluate(&self, values: &[Option<bool>], known: &mut [Option<bool>]) {
        let mut atoms = self.atoms.iter().zip(values).peekable();
        for (at, &id) in self.nodes.iter().enumerate() {
            let of = |id: ExprId| self.nodes.binary_search(&id).ok().and_then(|it| known[it]);
            known[at] = match *self.space.exprs.get(id) {
                Expr::Bool(value) => Some(value),
                Expr::Not(a) => of(a).map(|it| !it),
                Expr::And(a, b) => match (of(a), of(b)) {
                    (Some(false), _) | (_, Some(false)) => Some(false),
                    (Some(true), Some(true)) => Some(true),
                    _ => None,
                },
                Expr::Or(a, b) => match (of(a), of(b)) {
                    (Some(true), _) | (_, Some(true)) => Some(true),
                    (Some(false), Some(false)) => Some(false),
                    _ => None,
                },
                Expr::Xor(a, b) => of(a).zip(of(b)).map(|(a, b)| a != b),
                _ => atoms.next_if(|it| it.0.0 == at).and_then(|it| *it.1),
            };
        }
    }

    /// Values of the terms that agree with those of the atoms, or atoms that no values agree with.
    fn explain(&self, values: &[Option<bool>]) -> Result<Witness, Vec<(usize, bool)>> {
        let mut given = Vec::new();
        let mut assumed = false;
        let mut explained = vec![false; self.terms.len()];
        let mut related: Vec<(ExprId, ExprId)> = Vec::new();
        for (at, (node, atom)) in self.atoms.iter().enumerate() {
            let Some(value) = values[at] else { continue };
            match *atom {
                Atom::Bit(object) => {
                    // Of a word that is compared as well, the word's value says it.
                    let is_part = |it: &Term| it.bits.iter().any(|bit| bit.0 == at) && self.is_asked(it, values);
                    if !self.terms.iter().any(is_part) {
                        given.push(Given::Bit(object, value));
                    }
                }
                Atom::Edge(object, rising) => given.push(Given::Edge { object, rising, value }),
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
                    given.push(Given::Unknown(self.nodes[*node], value));
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
    #[allow(clippy::type_complexity)]
    fn asked(&self, term: usize, values: &[Option<bool>]) -> (Vec<Bound>, Vec<(u32, bool)>, Vec<(usize, bool)>) {
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

    fn relations(&self, of: (ExprId, ExprId), values: &[Option<bool>]) -> (Vec<Comparison>, Vec<(usize, bool)>) {
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

fn with(op: Comparison, value: bool) -> Comparison {
    if value { op } else { op.negated() }
}

/// A relation in which two terms can stand, given what holds of them.
fn order(ops: &[Comparison]) -> Option<Comparison> {
    use std::cmp::Ordering;
    let orders =
        [(Ordering::Equal, Comparison::Eq), (Ordering::Less, Comparison::Lt), (Ordering::Greater, Comparison::Gt)];
    orders.into_iter().find(|(order, _)| ops.iter().all(|it| it.holds(*order))).map(|it| it.1)
}

impl Bound {
    fn with(self, value: bool) -> Self {
        Self { op: with(self.op, value), ..self }
    }
}

impl Term {
    /// A value that agrees with all bounds and bits.
    fn value(&self, bounds: &[Bound], bits: &[(u32, bool)]) -> Option<Given> {
        if self.is_float {
            return self.number(bounds);
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
        let width = self.width?;
        let smallest = |mut from: i64| loop {
            let value = next_with_bits(from, width, self.lowest < 0, bits).filter(|it| *it <= last)?;
            if excluded.binary_search(&value).is_err() {
                return Some(Given::Whole(self.id, value, value));
            }
            from = value + 1;
        };
        // One that a reader would choose.
        smallest(first.max(0)).or_else(|| smallest(first.max(-4))).or_else(|| smallest(first))
    }

    fn number(&self, bounds: &[Bound]) -> Option<Given> {
        let mut samples: Vec<f64> = bounds.iter().map(|it| it.constant.as_f64()).collect();
        samples.sort_by(f64::total_cmp);
        samples.dedup();
        let mut all = Vec::with_capacity(samples.len() * 2 + 1);
        all.extend(samples.first().map(|it| it - 1.0));
        for pair in samples.windows(2) {
            all.extend([pair[0], f64::midpoint(pair[0], pair[1])]);
        }
        all.extend(samples.last().into_iter().flat_map(|it| [*it, it + 1.0]));
        let holds = |value: f64| {
            let agrees = |it: &Bound| value.partial_cmp(&it.constant.as_f64()).is_some_and(|order| it.op.holds(order));
            bounds.iter().all(agrees)
        };
        all.into_iter().find(|it| holds(*it)).map(|it| Given::Number(self.id, it))
    }
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

    use super::*;
    use crate::model::object::pl7;

    const BITS: [&str; 4] = ["%M0", "%M1", "%I1.0", "%I1.1"];
    const WORDS: [&str; 2] = ["%MW0", "%MW9"];
    const PARTS: [&str; 2] = ["%MW0:X0", "%MW0:X1"];

    fn objects() -> Vec<Object> {
        BITS.iter().chain(&WORDS).chain(&PARTS).map(|it| pl7::parse(it).unwrap()).collect()
    }

    #[derive(Debug, Clone)]
    enum Formula {
        Bit(usize),
        Part(usize),
        Edge(usize, bool),
        Compare(usize, Comparison, i64),
        Not(Box<Self>),
        Both(Box<Self>, Box<Self>, u8),
    }

    /// A state of the machine: bits now and before, words.
    struct State {
        now: u8,
        before: u8,
        words: [i64; 2],
    }

    impl Formula {
        fn build(&self, exprs: &mut Exprs) -> ExprId {
            let id = |it: usize| ObjectId(u32::try_from(it).unwrap());
            match self {
                Self::Bit(n) => exprs.read(id(*n), 0),
                Self::Part(n) => exprs.read(id(6 + n), 0),
                Self::Edge(n, rising) => exprs.edge(id(*n), 0, *rising),
                Self::Compare(n, op, value) => {
                    let (a, b) = (exprs.read(id(4 + n), 0), exprs.int(*value));
                    if value % 2 == 0 { exprs.compare(*op, a, b) } else { exprs.compare(op.mirrored(), b, a) }
                }
                Self::Not(it) => {
                    let it = it.build(exprs);
                    exprs.not(it)
                }
                Self::Both(a, b, op) => {
                    let (a, b) = (a.build(exprs), b.build(exprs));
                    match op {
                        0 => exprs.and(a, b),
                        1 => exprs.or(a, b),
                        _ => exprs.xor(a, b),
                    }
                }
            }
        }

        fn holds(&self, state: &State) -> bool {
            let bit = |bits: u8, n: usize| bits >> n & 1 == 1;
            match self {
                Self::Bit(n) => bit(state.now, *n),
                Self::Part(n) => state.words[0] >> n & 1 == 1,
                Self::Edge(n, rising) => bit(state.now, *n) == *rising && bit(state.before, *n) != *rising,
                Self::Compare(n, op, value) => op.holds(state.words[*n].cmp(value)),
                Self::Not(it) => !it.holds(state),
                Self::Both(a, b, op) => match op {
                    0 => a.holds(state) && b.holds(state),
                    1 => a.holds(state) || b.holds(state),
                    _ => a.holds(state) != b.holds(state),
                },
            }
        }
    }

    impl State {
        fn all() -> impl Iterator<Item = Self> {
            let words = (-4..=7).flat_map(|a| (-1..=4).map(move |b| [a, b]));
            words.flat_map(|words| (0..16).flat_map(move |now| (0..16).map(move |before| Self { now, before, words })))
        }

        fn agrees(&self, given: &Given) -> bool {
            let bit = |bits: u8, n: u32| bits >> n & 1 == 1;
            match *given {
                Given::Bit(ObjectId(n @ 0..4), value) => bit(self.now, n) == value,
                Given::Bit(ObjectId(n), value) => (self.words[0] >> (n - 6) & 1 == 1) == value,
                Given::Edge { object: ObjectId(n), rising, value } => {
                    (bit(self.now, n) == rising && bit(self.before, n) != rising) == value
                }
                _ => true,
            }
        }
    }

    fn formula() -> impl Strategy<Value = Formula> {
        use Comparison::*;
        let op = prop_oneof![Just(Eq), Just(Ne), Just(Lt), Just(Le), Just(Gt), Just(Ge)];
        let leaf = prop_oneof![
            (0..4_usize).prop_map(Formula::Bit),
            (0..2_usize).prop_map(Formula::Part),
            (0..2_usize, any::<bool>()).prop_map(|(n, rising)| Formula::Edge(n, rising)),
            (0..2_usize, op, 0..4_i64).prop_map(|(n, op, value)| Formula::Compare(n, op, value)),
        ];
        leaf.prop_recursive(4, 12, 2, |inner| {
            prop_oneof![
                inner.clone().prop_map(|it| Formula::Not(Box::new(it))),
                (inner.clone(), inner, 0..3_u8).prop_map(|(a, b, op)| Formula::Both(Box::new(a), Box::new(b), op)),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// Decided as by trying all states; and every state that agrees with the witness makes the conditions hold.
        #[test]
        fn agrees_with_brute_force(a in formula(), b in formula()) {
            let objects = objects();
            let objects: Vec<&Object> = objects.iter().collect();
            let mut exprs = Exprs::default();
            let wanted = [(a.build(&mut exprs), true), (b.build(&mut exprs), true)];
            let space = Space { exprs: &exprs, objects: &objects, family: Family::Pl7 };
            let possible = State::all().any(|it| a.holds(&it) && b.holds(&it));
            match space.solve(&wanted) {
                Answer::Never => prop_assert!(!possible),
                Answer::NotDecided => prop_assert!(false, "small conditions are decided"),
                Answer::Possible(witness) => {
                    prop_assert!(possible && !witness.assumed);
                    let in_range = |state: &State| witness.given.iter().all(|it| match *it {
                        Given::Whole(term, first, last) => {
                            let Expr::Read { object: ObjectId(n), .. } = *exprs.get(term) else { return false };
                            (first..=last).contains(&state.words[n as usize - 4])
                        }
                        ref other => state.agrees(other),
                    });
                    let agreeing: Vec<State> = State::all().filter(in_range).collect();
                    prop_assert!(!agreeing.is_empty(), "{witness:?}");
                    prop_assert!(agreeing.iter().all(|it| a.holds(it) && b.holds(it)), "{witness:?}");
                }
            }
        }

        #[test]
        fn the_next_number_with_bits(from in -140_i64..130, bits in prop::collection::vec((0..8_u32, any::<bool>()), 0..4)) {
            let has = |it: i64| bits.iter().all(|&(bit, value)| (it >> bit & 1 == 1) == value);
            let expected = (from.max(-128)..=127).find(|it| has(*it));
            prop_assert_eq!(next_with_bits(from, 8, true, &bits), expected);
            let expected = (from.max(0)..=255).find(|it| has(*it));
            prop_assert_eq!(next_with_bits(from, 8, false, &bits), expected);
        }
    }

    fn answer(first: &str, second: &str) -> (Answer, Vec<String>) {
        use crate::model::chart::Receptivity;
        use crate::model::entity::{Entity, Part, Task};
        use crate::model::lower;
        use crate::syntax::{self, Language};
        let text = format!(
            "PAGE 0\nTRANSITION (ST) AT (C 0,L 2) : {first} END_TRANSITION\nTRANSITION (ST) AT (C 1,L 2) : {second} END_TRANSITION\nEND_PAGE\n"
        );
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Chart("".into()) };
        let parse = syntax::parse(Language::Pl7Gr7, &text);
        assert_eq!(parse.errors(), [], "{text}");
        let model = lower::lower(parse.syntax(), &text, entity, Language::Pl7Gr7);
        let mut exprs = Exprs::default();
        let transitions = &model.chart.as_ref().unwrap().transitions;
        let wanted: Vec<(ExprId, bool)> = transitions
            .iter()
            .map(|it| {
                let Receptivity::Value(value) = it.receptivity else { panic!("{first} {second}") };
                (exprs.import(&model.exprs.cut(value, 100).unwrap(), |it| it), true)
            })
            .collect();
        let objects: Vec<&Object> = model.objects.iter().collect();
        let space = Space { exprs: &exprs, objects: &objects, family: Family::Pl7 };
        let answer = space.solve(&wanted);
        let given = match &answer {
            Answer::Possible(witness) => witness.given.iter().map(|it| space.describe(it)).collect(),
            _ => Vec::new(),
        };
        (answer, given)
    }

    #[test]
    fn receptivities() {
        let never = |a: &str, b: &str| assert!(answer(a, b).0.is_never(), "{a} / {b}");
        never("%I1.0 AND NOT %M3", "%M3");
        never("RE %I1.0", "FE %I1.0");
        never("RE %I1.0", "NOT %I1.0");
        never("%MW5 > 10", "%MW5 <= 10");
        never("%MW0:X3", "%MW0 = 0");
        never("%X3.T >= 10000", "%I1.0");
        never("%MF2 > 1.5", "%MF2 <= 1.5");
        never("%MW1 > %MW2", "%MW2 > %MW1");
        let possible = |a: &str, b: &str, assumed: bool, expected: &[&str]| {
            let (answer, given) = answer(a, b);
            let Answer::Possible(witness) = answer else { panic!("{a} / {b}") };
            assert_eq!(
                (witness.assumed, given),
                (assumed, expected.iter().map(|it| (*it).to_owned()).collect()),
                "{a} / {b}"
            );
        };
        possible("%I1.0", "%I1.1", false, &["`%I1.0` = 1", "`%I1.1` = 1"]);
        possible("%I1.0 OR %I1.1", "%I1.1 AND NOT %I1.0", false, &["`%I1.0` = 0", "`%I1.1` = 1"]);
        possible("%MW5 >= 15", "%MW5 <= 20", false, &["`%MW5` in 15..20"]);
        possible("%MW5 > 15", "%M1", false, &["`%MW5` >= 16", "`%M1` = 1"]);
        possible("%X3.T > 50", "%M1", false, &["`%X3.T` >= 51", "`%M1` = 1"]);
        possible("%MW0:X3", "%MW0 > 3", false, &["`%MW0` = 8"]);
        possible("%MW1 > %MW2", "%MW1 <> %MW2", true, &["`%MW1` > `%MW2`"]);
        possible("%MW1 + 1 > 5", "%M1", true, &["a computed value >= 6", "`%M1` = 1"]);
        possible("%MD0 > 5", "%MW0 < 0", true, &["`%MD0` >= 6", "`%MW0` <= -1"]);
    }
}

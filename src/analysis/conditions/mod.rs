//! Whether conditions can hold at one moment, and with which values: of one unit, or of a whole program.
//!
//! Atoms are bits, edges and comparisons; equal atoms (same object, same version) have equal values. The laws between atoms
//! are respected: a rising edge is of a bit that is 1, a falling one of a bit that is 0; the comparisons of one term with
//! constants, and the bits that are extracted from it, agree with some value of the term; two terms stand in one relation.
//!
//! A question that leaves no choice is answered by the laws alone, one of few atoms by a truth table in machine words
//! ([`table`]), one of many by a SAT solver ([`solver`]); what they ask, and the laws, is one [`problem`]. What is too large
//! is said to be not decided. The answer is exact but where a [`Witness`] says that it assumed something: two terms that are
//! compared with one another, computed values, and words that overlap are taken as free of one another.

mod cases;
mod lessons;
mod problem;
mod solver;
mod table;

use std::cmp::Ordering;

pub use lessons::Lessons;
use problem::{Bound, Constant, Problem, Said, WIDEST};
use solver::Told;
use table::Table;

use crate::model::UnitModel;
use crate::model::entity::Family;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Object, Type};
use crate::target::pl7::STEP_TIMES;

/// Expressions, and the objects that they are about.
#[derive(Debug, Clone, Copy)]
pub struct Space<'a> {
    pub exprs: &'a Exprs,
    pub objects: Objects<'a>,
    pub family: Family,
    /// Terms of which the value is known.
    known: &'a [(ExprId, i64)],
    lessons: Option<&'a Lessons>,
}

/// Objects by [`ObjectId`]: those of a unit, or of several.
#[derive(Debug, Clone, Copy)]
pub enum Objects<'a> {
    Unit(&'a [Object]),
    Units(&'a [&'a Object]),
}

impl<'a> Objects<'a> {
    pub fn get(self, id: ObjectId) -> Option<&'a Object> {
        match self {
            Self::Unit(objects) => objects.get(id.0 as usize),
            Self::Units(objects) => objects.get(id.0 as usize).copied(),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    Never,
    Possible,
    NotDecided,
}

/// A [`Verdict`] with what makes the conditions hold, where that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer<W = Witness> {
    Never,
    Possible(W),
    NotDecided,
}

impl From<Verdict> for Answer<()> {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Never => Self::Never,
            Verdict::Possible => Self::Possible(()),
            Verdict::NotDecided => Self::NotDecided,
        }
    }
}

impl<W> Answer<W> {
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

/// What makes something happen, as a message says it: ``when `E0.1` = 1``. Of many values the first, and the number of the
/// others, which [`besides`] tells.
pub fn when(values: &[String]) -> String {
    let (told, others) = values.split_at(values.len().min(MOST_TOLD));
    match (told, others.len()) {
        ([], _) => "always".to_owned(),
        (_, 0) => format!("when {}", told.join(", ")),
        (_, more) => format!("when {} and {more} more hold", told.join(", ")),
    }
}

/// The values that [`when`] leaves out.
pub fn besides(values: &[String]) -> Option<String> {
    let others = values.get(MOST_TOLD..).filter(|it| !it.is_empty())?;
    Some(format!("what has to hold besides: {}", others.join(", ")))
}

/// Of more values, the first are told in a message.
const MOST_TOLD: usize = 6;

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

/// Values wanted of conditions, and pairs of conditions that do not hold both.
#[derive(Debug, Clone, Copy)]
struct Question<'q> {
    wanted: &'q [(ExprId, bool)],
    never: &'q [[ExprId; 2]],
}

impl<'a> Space<'a> {
    pub fn new(exprs: &'a Exprs, objects: Objects<'a>, family: Family) -> Self {
        Self { exprs, objects, family, known: &[], lessons: None }
    }

    /// The conditions of one unit.
    pub fn of(model: &'a UnitModel) -> Self {
        // An exchange file has no conditions between its programs.
        let family = Family::of(model.language).unwrap_or(Family::Pl7);
        Self::new(&model.exprs, Objects::Unit(&model.objects), family)
    }

    /// The same space, in which what one question teaches serves the next. Lessons are of one space, to which expressions
    /// may be added.
    pub fn learning(self, lessons: &'a Lessons) -> Self {
        Self { lessons: Some(lessons), ..self }
    }

    /// The same space, where the values of some terms are known.
    pub fn knowing<'k>(self, known: &'k [(ExprId, i64)]) -> Space<'k>
    where
        'a: 'k,
    {
        Space { known, lessons: None, ..self }
    }

    /// Whether all conditions can have the values wanted of them at one moment, and what does it.
    pub fn solve(&self, wanted: &[(ExprId, bool)]) -> Answer {
        let question = Question { wanted, never: &[] };
        if self.lessons.is_some() && self.decide(&question) == Verdict::Never {
            return Answer::Never;
        }
        let Some(problem) = Problem::new(self, &question) else { return Answer::NotDecided };
        if let Some(answer) = problem.forced(&question) {
            return answer;
        }
        match Table::new(&problem) {
            Some(table) => table.answer(&question),
            // Which values are told does not depend on what was asked before.
            None => problem.solve(&question, false, &mut Told::default()).0,
        }
    }

    /// Whether all conditions can have the values wanted of them at one moment.
    pub fn possible(&self, wanted: &[(ExprId, bool)]) -> Verdict {
        let given: Vec<ExprId> = wanted.iter().filter(|it| it.1).map(|it| it.0).collect();
        let others: Vec<[ExprId; 2]> = wanted.iter().filter(|it| !it.1).map(|it| [it.0, Exprs::TRUE]).collect();
        let verdict = self.by_parts(&given, &others);
        verdict.unwrap_or_else(|| self.decide(&Question { wanted, never: &[] }))
    }

    /// Whether all of the conditions can hold at once.
    pub fn together(&self, conditions: &[ExprId]) -> Verdict {
        if conditions.iter().all(|&it| it == Exprs::TRUE) {
            return Verdict::Possible;
        }
        let mut conjuncts = Vec::with_capacity(ROOM);
        for &condition in conditions {
            spread(self.exprs, condition, &mut conjuncts);
        }
        if let Some(verdict) = self.by_form(&mut conjuncts) {
            return verdict;
        }
        let wanted: Vec<(ExprId, bool)> = conjuncts.iter().map(|&it| (it, true)).collect();
        self.decide(&Question { wanted: &wanted, never: &[] })
    }

    /// Whether the given conditions can hold at once, while of none of the others all parts do.
    pub fn without(&self, given: &[ExprId], others: &[[ExprId; 2]]) -> Verdict {
        if given.contains(&Exprs::FALSE) || others.contains(&[Exprs::TRUE; 2]) {
            return Verdict::Never;
        }
        if let Some(verdict) = self.by_parts(given, others) {
            return verdict;
        }
        let wanted: Vec<(ExprId, bool)> = given.iter().map(|&it| (it, true)).collect();
        self.decide(&Question { wanted: &wanted, never: others })
    }

    /// Whether two conditions surely never hold at once.
    pub fn exclusive(&self, a: ExprId, b: ExprId) -> bool {
        self.together(&[a, b]) == Verdict::Never
    }

    /// Whether the first condition surely never holds without the second.
    pub fn implies(&self, a: ExprId, b: ExprId) -> bool {
        if a == b || a == Exprs::FALSE || b == Exprs::TRUE {
            return true;
        }
        let verdict = self.by_parts(&[a], &[[b, Exprs::TRUE]]);
        let decide = || self.decide(&Question { wanted: &[(a, true), (b, false)], never: &[] });
        verdict.unwrap_or_else(decide) == Verdict::Never
    }

    /// What the form of conditions tells of whether they can hold at once while of each pair one does not: they cannot when
    /// they hold all parts of a pair, and they can when some part of each pair is free of them and of the others.
    fn by_parts(&self, given: &[ExprId], pairs: &[[ExprId; 2]]) -> Option<Verdict> {
        /// So many pairs, and parts of each, are looked at.
        const FEW: usize = 4;
        if pairs.len() > FEW {
            return None;
        }
        let (mut all, mut parts) = (Vec::with_capacity(ROOM), Vec::with_capacity(ROOM));
        let mut with_part = Vec::new();
        given.iter().for_each(|it| spread(self.exprs, *it, &mut all));
        if pairs.is_empty() {
            return self.by_form(&mut all);
        }
        // Of a pair that is one condition, its opposite holds.
        for &[a, b] in pairs.iter().filter(|it| it.contains(&Exprs::TRUE)) {
            parts.clear();
            spread(self.exprs, if a == Exprs::TRUE { b } else { a }, &mut parts);
            if let [part] = *parts
                && !matches!(self.exprs.get(part), Expr::Or(..))
                && let Some(opposite) = self.exprs.find_complement(part)
            {
                spread(self.exprs, opposite, &mut all);
            }
        }
        let held = all.len();
        let (mut is_free, mut asks) = (true, false);
        for pair in pairs {
            parts.clear();
            pair.iter().for_each(|it| spread(self.exprs, *it, &mut parts));
            parts.retain(|it| *it != Exprs::TRUE && !all[..held].contains(it));
            if parts.is_empty() {
                return Some(Verdict::Never);
            }
            // They do not hold both anyway.
            if parts.iter().any(|it| self.is_opposed(*it, |it| all[..held].contains(&it))) {
                continue;
            }
            asks = true;
            // What is free of conditions is false while they hold. A disjunction is false where all that it is made of is.
            let start = all.len();
            is_free = is_free
                && parts.iter().take(FEW).any(|&part| {
                    all.truncate(start);
                    spread_disjuncts(self.exprs, part, &mut all);
                    let (before, own) = all.split_at(start);
                    let is_open = own.iter().all(|it| *it != Exprs::TRUE && !before[..held].contains(it));
                    with_part.clone_from(&all);
                    is_open && self.by_form(&mut with_part) == Some(Verdict::Possible)
                });
        }
        if !asks {
            return self.by_form(&mut all);
        }
        is_free.then_some(Verdict::Possible)
    }

    /// Whether two conditions surely hold at the same moments.
    pub fn equivalent(&self, a: ExprId, b: ExprId) -> bool {
        self.implies(a, b) && self.implies(b, a)
    }

    /// Whether a condition is always true, always false, or neither, wherever another one holds.
    pub fn constant(&self, given: ExprId, condition: ExprId) -> Option<bool> {
        if given == Exprs::TRUE {
            // Where nothing ties the atoms of a conjunction, each can be true, and false.
            let mut conjuncts = Vec::with_capacity(ROOM);
            spread(self.exprs, condition, &mut conjuncts);
            if self.by_form(&mut conjuncts) == Some(Verdict::Possible) && !conjuncts.is_empty() {
                return None;
            }
        }
        if self.exclusive(given, condition) { Some(false) } else { self.implies(given, condition).then_some(true) }
    }

    fn decide(&self, question: &Question<'_>) -> Verdict {
        let Some(lessons) = self.lessons else { return self.decide_anew(question) };
        lessons.answer(question).unwrap_or_else(|asked| {
            let verdict = self.decide_anew(question);
            lessons.keep(asked, verdict);
            verdict
        })
    }

    fn decide_anew(&self, question: &Question<'_>) -> Verdict {
        let Some(problem) = Problem::new(self, question) else { return Verdict::NotDecided };
        let answer = match problem.forced(question) {
            Some(answer) => answer,
            None => match Table::new(&problem) {
                Some(table) => return table.decide(question),
                None => match self.lessons.filter(|_| problem.is_typed()) {
                    Some(lessons) => lessons.solve(&problem, question),
                    None => problem.solve(question, true, &mut Told::default()).0,
                },
            },
        };
        match answer {
            Answer::Never => Verdict::Never,
            Answer::Possible(_) => Verdict::Possible,
            Answer::NotDecided => Verdict::NotDecided,
        }
    }

    /// What the form of conjuncts tells, which is most of what is asked. Sorts them, and drops what is TRUE.
    fn by_form(&self, conjuncts: &mut Vec<ExprId>) -> Option<Verdict> {
        if conjuncts.contains(&Exprs::FALSE) {
            return Some(Verdict::Never);
        }
        conjuncts.sort_unstable();
        conjuncts.dedup();
        let has = |it: ExprId| conjuncts.binary_search(&it).is_ok();
        if conjuncts.iter().any(|it| self.is_opposed(*it, has)) {
            return Some(Verdict::Never);
        }
        conjuncts.retain(|&it| it != Exprs::TRUE);
        (conjuncts.is_empty() || self.are_free(conjuncts)).then_some(Verdict::Possible)
    }

    /// Whether a condition is the opposite of one that holds: also `NOT (a AND b)` beside `a` and `b`, as the ELSE of an IF
    /// gives it.
    fn is_opposed(&self, it: ExprId, has: impl Fn(ExprId) -> bool) -> bool {
        if self.exprs.find_complement(it).is_some_and(&has) {
            return true;
        }
        let Expr::Not(inner) = *self.exprs.get(it) else { return false };
        let Expr::And(a, b) = *self.exprs.get(inner) else { return false };
        let mut parts = Vec::with_capacity(ROOM);
        spread(self.exprs, a, &mut parts);
        spread(self.exprs, b, &mut parts);
        parts.into_iter().all(has)
    }

    /// Whether conjuncts, none of which is another's complement, are bits, edges of other bits, the absences of such, and
    /// comparisons of different terms with constants that the terms can have: no law ties any of them to another.
    fn are_free(&self, conjuncts: &[ExprId]) -> bool {
        let (mut bits, mut edges, mut terms) = (Vec::with_capacity(ROOM), Vec::new(), Vec::new());
        for &it in conjuncts {
            let atom = if let Expr::Not(inner) = *self.exprs.get(it) { inner } else { it };
            match *self.exprs.get(atom) {
                Expr::Read { object, .. } => bits.push(object),
                Expr::Edge { object, .. } => edges.push(object),
                Expr::Compare(op, a, b) => {
                    let (op, term, constant) = match (self.constant_of(a), self.constant_of(b)) {
                        (None, Some(constant)) => (op, a, constant),
                        (Some(constant), None) => (op.mirrored(), b, constant),
                        _ => return false,
                    };
                    if let (Constant::Int(value), Some((lowest, highest))) = (constant, self.domain(term))
                        && op.decided(lowest, highest, value).is_some()
                    {
                        return false;
                    }
                    terms.push(term);
                }
                _ => return false,
            }
        }
        for edge in edges {
            if bits.contains(&edge) {
                return false;
            }
            bits.push(edge);
        }
        terms.sort_unstable();
        let is_part = |term: &ExprId| {
            self.read_of(*term).is_some_and(|(word, _)| {
                bits.iter().any(|it| self.objects.get(*it).is_some_and(|it| it.footprint.overlaps(&word.footprint)))
            })
        };
        terms.windows(2).all(|it| it[0] != it[1]) && !terms.iter().any(is_part)
    }

    /// Whether a condition asks a step time for what it never is, or always is.
    pub fn asks_beyond_step_times(&self, condition: ExprId) -> bool {
        let mut found = false;
        self.exprs.each_comparison(condition, |op, a, b| {
            let (time, constant, op) = match (self.constant_of(a), self.constant_of(b)) {
                (None, Some(Constant::Int(constant))) => (a, constant, op),
                (Some(Constant::Int(constant)), None) => (b, constant, op.mirrored()),
                _ => return,
            };
            if self.read_of(time).is_some_and(|it| it.0.class == Class::StepTime)
                && let Some((first, last)) = self.domain(time)
            {
                found |= op.decided(first, last, constant).is_some();
            }
        });
        found
    }

    /// The object that a term reads, and the version.
    fn read_of(&self, term: ExprId) -> Option<(&'a Object, u32)> {
        match *self.exprs.get(term) {
            Expr::Read { object, version } => self.objects.get(object).map(|it| (it, version)),
            _ => None,
        }
    }

    fn constant_of(&self, id: ExprId) -> Option<Constant> {
        match *self.exprs.get(id) {
            Expr::Int(value) => Some(Constant::Int(value)),
            Expr::Float(bits) => Some(f64::from_bits(bits)).filter(|it| it.is_finite()).map(Constant::Float),
            _ => None,
        }
    }

    /// The constant as the term has it that it is compared with: `16#FFFF` is -1 in a word. `None` where it depends on the
    /// width of the comparison, which is not known, what it is.
    fn in_width(&self, op: Comparison, term: ExprId, constant: Constant) -> Option<Constant> {
        let (Constant::Int(value), Some((lowest, highest))) = (constant, self.range_of(term)) else {
            return Some(constant);
        };
        let all = highest - lowest + 1;
        if lowest >= 0 || value <= highest || value >= all {
            return Some(constant);
        }
        matches!(op, Comparison::Eq | Comparison::Ne).then_some(Constant::Int(value - all))
    }

    /// What a comparison says.
    fn said(&self, op: Comparison, a: ExprId, b: ExprId) -> Said {
        let bound = |op: Comparison, term: ExprId, constant: Constant| match self.in_width(op, term, constant) {
            Some(constant) => Said::Bound(term, Bound::new(op, constant)),
            None => Said::Unknown,
        };
        match (self.constant_of(a), self.constant_of(b)) {
            (None, Some(constant)) => bound(op, a, constant),
            (Some(constant), None) => bound(op.mirrored(), b, constant),
            (Some(a), Some(b)) => {
                let order = a.as_f64().partial_cmp(&b.as_f64());
                order.map_or(Said::Unknown, |order| Said::Constant(op.holds(order)))
            }
            // What may be a floating-point number may be none, and differ from itself.
            (None, None) if a == b && self.read_of(a).is_some_and(|it| matches!(it.0.ty, Type::Byte | Type::Word)) => {
                Said::Constant(op.holds(Ordering::Equal))
            }
            (None, None) if a <= b => Said::Relation(op, a, b),
            (None, None) => Said::Relation(op.mirrored(), b, a),
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
        self.objects.get(id).map_or_else(|| "?".to_owned(), |it| format!("`{}`", it.text))
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

    /// The values that a whole number can have here.
    fn domain(&self, term: ExprId) -> Option<(i64, i64)> {
        let known = self.known.iter().find(|it| it.0 == term);
        known.map(|it| (it.1, it.1)).or_else(|| self.range_of(term))
    }

    /// The values that a whole number can have by its type.
    fn range_of(&self, term: ExprId) -> Option<(i64, i64)> {
        let (object, _) = self.read_of(term)?;
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

/// Most conditions have no more conjuncts.
const ROOM: usize = 8;

/// The conjuncts of a condition, at most 256 of them looked into.
fn spread(exprs: &Exprs, condition: ExprId, out: &mut Vec<ExprId>) {
    spread_parts(condition, out, |it| if let Expr::And(a, b) = *exprs.get(it) { Some((a, b)) } else { None });
}

/// The same of what it is a disjunction of.
fn spread_disjuncts(exprs: &Exprs, condition: ExprId, out: &mut Vec<ExprId>) {
    spread_parts(condition, out, |it| if let Expr::Or(a, b) = *exprs.get(it) { Some((a, b)) } else { None });
}

fn spread_parts(of: ExprId, out: &mut Vec<ExprId>, parts: impl Fn(ExprId) -> Option<(ExprId, ExprId)>) {
    let mut at = out.len();
    let mut budget = 256;
    out.push(of);
    while let Some(&id) = out.get(at) {
        match parts(id) {
            Some((a, b)) if budget > 0 => {
                budget -= 1;
                out[at] = a;
                out.push(b);
            }
            _ => at += 1,
        }
    }
}

#[cfg(test)]
mod tests;

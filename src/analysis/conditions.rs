//! Whether conditions can hold together.
//!
//! Atoms are bits, edges, comparisons and opaque values; equal atoms (same object, same version) have equal values.
//! The laws between atoms are respected: a rising edge implies the bit, a falling edge its absence, and the comparisons
//! of one term with constants agree with some value of the term. Small conditions are decided by a truth table in
//! machine words, those beyond [`MAX_ATOMS`] by the solver of [`super::satisfy`], which also knows a program's objects.

use super::satisfy::{Answer, Space};
use crate::model::entity::Family;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs};

/// Truth tables have at most 2^12 rows, 64 machine words.
pub const MAX_ATOMS: usize = 12;

/// Expressions with more nodes than this are not looked into.
const MAX_NODES: usize = 2048;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    Never,
    Possible,
    NotDecided,
}

/// Whether all of the conditions can hold at once.
pub fn together(exprs: &Exprs, conditions: &[ExprId]) -> Verdict {
    if conditions.iter().all(|&it| it == Exprs::TRUE) {
        return Verdict::Possible;
    }
    let mut conjuncts = Vec::new();
    for &condition in conditions {
        spread(exprs, condition, &mut conjuncts);
    }
    if conjuncts.contains(&Exprs::FALSE) {
        return Verdict::Never;
    }
    conjuncts.sort_unstable();
    conjuncts.dedup();
    let has = |it: ExprId| conjuncts.binary_search(&it).is_ok();
    // Also `NOT (a AND b)` beside `a` and `b`, as the ELSE of an IF gives it.
    let opposed = |&it: &ExprId| {
        exprs.find_complement(it).is_some_and(has)
            || matches!(*exprs.get(it), Expr::Not(inner) if matches!(*exprs.get(inner), Expr::And(a, b) if {
                let mut parts = Vec::new();
                spread(exprs, a, &mut parts);
                spread(exprs, b, &mut parts);
                parts.into_iter().all(has)
            }))
    };
    if conjuncts.iter().any(opposed) {
        return Verdict::Never;
    }
    conjuncts.retain(|&it| it != Exprs::TRUE);
    if conjuncts.is_empty() {
        return Verdict::Possible;
    }
    if are_free(exprs, &conjuncts) {
        return Verdict::Possible;
    }
    let Some(table) = Table::new(exprs, &conjuncts) else { return by_solver(exprs, &conjuncts) };
    let mut rows = table.lawful();
    for &it in &conjuncts {
        and(&mut rows, table.value(it));
    }
    verdict(&rows)
}

/// The same of conditions too large for a table. What the objects are plays no part here, as it plays none in a table.
fn by_solver(exprs: &Exprs, conjuncts: &[ExprId]) -> Verdict {
    let space = Space { exprs, objects: &[], family: Family::Step7 };
    let wanted: Vec<(ExprId, bool)> = conjuncts.iter().map(|&it| (it, true)).collect();
    match space.solve(&wanted) {
        Answer::Never => Verdict::Never,
        Answer::Possible(_) => Verdict::Possible,
        Answer::NotDecided => Verdict::NotDecided,
    }
}

/// Whether conjuncts, none of which is another's complement, are bits, their absences, and comparisons of different
/// terms with constants: no law ties any of them to another.
fn are_free(exprs: &Exprs, conjuncts: &[ExprId]) -> bool {
    let mut terms = Vec::new();
    for &it in conjuncts {
        let atom = if let Expr::Not(inner) = *exprs.get(it) { inner } else { it };
        match *exprs.get(atom) {
            Expr::Read { .. } => {}
            Expr::Compare(_, a, b) => match (number(exprs, a), number(exprs, b)) {
                (None, Some(_)) => terms.push(a),
                (Some(_), None) => terms.push(b),
                _ => return false,
            },
            _ => return false,
        }
    }
    terms.sort_unstable();
    terms.windows(2).all(|it| it[0] != it[1])
}

/// Whether the given conditions can hold at once, while of none of the others all parts do.
pub fn without(exprs: &Exprs, given: &[ExprId], others: &[[ExprId; 2]]) -> Verdict {
    if given.contains(&Exprs::FALSE) || others.contains(&[Exprs::TRUE; 2]) {
        return Verdict::Never;
    }
    let all: Vec<ExprId> = given.iter().chain(others.iter().flatten()).copied().collect();
    let Some(table) = Table::new(exprs, &all) else { return Verdict::NotDecided };
    let mut rows = table.lawful();
    for &it in given {
        and(&mut rows, table.value(it));
    }
    for &[a, b] in others {
        for ((row, a), b) in rows.iter_mut().zip(table.value(a)).zip(table.value(b)) {
            *row &= !(a & b);
        }
    }
    verdict(&rows)
}

/// Whether two conditions surely never hold at once.
pub fn exclusive(exprs: &Exprs, a: ExprId, b: ExprId) -> bool {
    together(exprs, &[a, b]) == Verdict::Never
}

/// Whether a condition is always true, always false, or neither.
pub fn constant(exprs: &mut Exprs, condition: ExprId) -> Option<bool> {
    if together(exprs, &[condition]) == Verdict::Never {
        return Some(false);
    }
    let negated = exprs.not(condition);
    (together(exprs, &[negated]) == Verdict::Never).then_some(true)
}

/// The conjuncts of a condition, at most 256 of them looked into.
fn spread(exprs: &Exprs, condition: ExprId, out: &mut Vec<ExprId>) {
    let mut at = out.len();
    let mut budget = 256;
    out.push(condition);
    while let Some(&id) = out.get(at) {
        match exprs.get(id) {
            &Expr::And(a, b) if budget > 0 => {
                budget -= 1;
                out[at] = a;
                out.push(b);
            }
            _ => at += 1,
        }
    }
}

/// An atom that compares a term: its number, the comparison, the constant if it is one, and whether that is whole.
type Compared = (usize, Comparison, Option<f64>, bool);

/// What atoms compare: a term with constants, or two terms with one another, the first the smaller.
type Term = (ExprId, Option<ExprId>);

fn and(rows: &mut [u64], other: &[u64]) {
    rows.iter_mut().zip(other).for_each(|(row, other)| *row &= other);
}

fn verdict(rows: &[u64]) -> Verdict {
    if rows.iter().any(|&it| it != 0) { Verdict::Possible } else { Verdict::Never }
}

/// A truth table: for each node of the conditions the rows in which it is true, one bit a row.
struct Table<'e> {
    exprs: &'e Exprs,
    /// Sorted. Ids grow from operands to what they are operands of, so that this is an order to evaluate in.
    nodes: Vec<ExprId>,
    atoms: Vec<ExprId>,
    /// Machine words of a column.
    words: usize,
    /// All rows there are: the column of TRUE.
    full: Vec<u64>,
    /// The columns of the nodes, one behind the other.
    columns: Vec<u64>,
}

impl<'e> Table<'e> {
    /// `None` when the conditions are too large to decide.
    fn new(exprs: &'e Exprs, conditions: &[ExprId]) -> Option<Self> {
        let (nodes, atoms) = nodes_and_atoms(exprs, conditions)?;
        let rows = 1_usize << atoms.len();
        let words = rows.div_ceil(64);
        let mut full = vec![u64::MAX; words];
        if rows < 64 {
            full[0] = (1 << rows) - 1;
        }
        let columns = vec![0; words * nodes.len()];
        let mut table = Self { exprs, nodes, atoms, words, full, columns };
        for at in 0..table.nodes.len() {
            table.fill(at);
        }
        Some(table)
    }

    fn fill(&mut self, at: usize) {
        let column = |nodes: &[ExprId], id: ExprId| nodes.binary_search(&id).map_or(0, |it| it * self.words);
        let (before, rest) = self.columns.split_at_mut(at * self.words);
        let id = self.nodes[at];
        for (word, row) in rest.iter_mut().take(self.words).enumerate() {
            let operand = |id: ExprId| before.get(column(&self.nodes, id) + word).copied().unwrap_or_default();
            *row = self.full[word]
                & match *self.exprs.get(id) {
                    Expr::Bool(value) => {
                        if value {
                            u64::MAX
                        } else {
                            0
                        }
                    }
                    Expr::Not(a) => !operand(a),
                    Expr::And(a, b) => operand(a) & operand(b),
                    Expr::Or(a, b) => operand(a) | operand(b),
                    Expr::Xor(a, b) => operand(a) ^ operand(b),
                    _ => self.atoms.iter().position(|it| *it == id).map_or(0, |n| atom(n, word)),
                };
        }
    }

    /// Rows in which a node is true.
    fn value(&self, id: ExprId) -> &[u64] {
        match self.nodes.binary_search(&id) {
            Ok(at) => &self.columns[at * self.words..(at + 1) * self.words],
            Err(_) => &self.full,
        }
    }

    /// Rows that the laws between atoms allow.
    fn lawful(&self) -> Vec<u64> {
        let mut rows = self.full.clone();
        let mut forbid = |literals: [(usize, bool); 2]| {
            for (word, row) in rows.iter_mut().enumerate() {
                let holds = |(n, value): (usize, bool)| if value { atom(n, word) } else { !atom(n, word) };
                *row &= !(holds(literals[0]) & holds(literals[1]));
            }
        };
        let number_of = |id: ExprId| self.atoms.iter().position(|it| *it == id);
        let mut terms: Vec<(Term, Compared)> = Vec::new();
        for (n, &id) in self.atoms.iter().enumerate() {
            match *self.exprs.get(id) {
                Expr::Edge { object, version, rising } => {
                    if let Some(bit) = self.exprs.find_read(object, version).and_then(number_of) {
                        forbid([(n, true), (bit, !rising)]);
                    }
                    let other = Expr::Edge { object, version, rising: !rising };
                    if let Some(other) = self.atoms.iter().position(|&it| *self.exprs.get(it) == other) {
                        forbid([(n, true), (other, true)]);
                    }
                }
                Expr::Compare(op, a, b) => terms.extend(compared(self.exprs, n, op, a, b)),
                _ => {}
            }
        }
        terms.sort_by_key(|it| it.0);
        for atoms in terms.chunk_by(|a, b| a.0 == b.0).filter(|it| it.len() > 1) {
            self.obey_order(&mut rows, atoms);
        }
        rows
    }

    /// Keeps the rows in which some value of the term explains what its comparisons give.
    fn obey_order(&self, rows: &mut [u64], atoms: &[(Term, Compared)]) {
        let samples: Vec<f64> = if atoms.iter().any(|it| it.0.1.is_some()) {
            vec![-1.0, 0.0, 1.0]
        } else {
            let mut constants: Vec<f64> = atoms.iter().filter_map(|it| it.1.2).collect();
            constants.sort_by(f64::total_cmp);
            constants.dedup();
            samples_around(&constants, atoms.iter().all(|it| it.1.3))
        };
        for (word, row) in rows.iter_mut().enumerate() {
            let explained = |&sample: &f64| {
                atoms.iter().fold(u64::MAX, |row, &(_, (n, op, constant, _))| {
                    let holds = sample.partial_cmp(&constant.unwrap_or(0.0)).is_some_and(|it| op.holds(it));
                    row & if holds { atom(n, word) } else { !atom(n, word) }
                })
            };
            *row &= samples.iter().map(explained).fold(0, |law, row| law | row);
        }
    }
}

/// What conditions are made of, sorted, and the atoms among it; `None` when that is too much.
fn nodes_and_atoms(exprs: &Exprs, conditions: &[ExprId]) -> Option<(Vec<ExprId>, Vec<ExprId>)> {
    /// Fewer than these are looked through, more are hashed.
    const FEW: usize = 48;
    let (mut nodes, mut atoms) = (Vec::new(), Vec::new());
    let mut many = rustc_hash::FxHashSet::default();
    let mut stack = conditions.to_vec();
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
        match *exprs.get(id) {
            Expr::Bool(_) => {}
            Expr::Not(a) => stack.push(a),
            Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => stack.extend([a, b]),
            _ => {
                atoms.push(id);
                // An edge says something of its bit.
                if let Expr::Edge { object, version, .. } = *exprs.get(id) {
                    stack.extend(exprs.find_read(object, version));
                }
                if atoms.len() > MAX_ATOMS {
                    return None;
                }
            }
        }
    }
    nodes.sort_unstable();
    Some((nodes, atoms))
}

/// Rows in which the n-th atom is true: a word of its column.
fn atom(n: usize, word: usize) -> u64 {
    const PATTERN: [u64; 6] = [
        0xAAAA_AAAA_AAAA_AAAA,
        0xCCCC_CCCC_CCCC_CCCC,
        0xF0F0_F0F0_F0F0_F0F0,
        0xFF00_FF00_FF00_FF00,
        0xFFFF_0000_FFFF_0000,
        0xFFFF_FFFF_0000_0000,
    ];
    match PATTERN.get(n) {
        Some(pattern) => *pattern,
        None if word >> (n - 6) & 1 == 1 => u64::MAX,
        None => 0,
    }
}

/// What an atom says of a term; `None` when it compares two constants.
fn compared(exprs: &Exprs, n: usize, op: Comparison, a: ExprId, b: ExprId) -> Option<(Term, Compared)> {
    let whole = |it: ExprId| matches!(exprs.get(it), Expr::Int(_));
    match (number(exprs, a), number(exprs, b)) {
        (None, Some(value)) => Some(((a, None), (n, op, Some(value), whole(b)))),
        (Some(value), None) => Some(((b, None), (n, op.mirrored(), Some(value), whole(a)))),
        (None, None) if a <= b => Some(((a, Some(b)), (n, op, None, true))),
        (None, None) => Some(((b, Some(a)), (n, op.mirrored(), None, true))),
        (Some(_), Some(_)) => None,
    }
}

fn number(exprs: &Exprs, id: ExprId) -> Option<f64> {
    match *exprs.get(id) {
        // Whole numbers of PLC programs have at most 32 bits, which an f64 holds exactly.
        Expr::Int(value) => Some(value as f64),
        Expr::Float(bits) => Some(f64::from_bits(bits)).filter(|it| it.is_finite()),
        _ => None,
    }
}

/// A value below, at, between and above the sorted constants. A whole term has no value between neighbours.
fn samples_around(constants: &[f64], whole: bool) -> Vec<f64> {
    let mut samples = Vec::with_capacity(constants.len() * 2 + 1);
    if let (Some(first), Some(last)) = (constants.first(), constants.last()) {
        samples.push(first - 1.0);
        samples.push(last + 1.0);
    }
    for (at, &constant) in constants.iter().enumerate() {
        samples.push(constant);
        if let Some(&next) = constants.get(at + 1)
            && !(whole && next - constant <= 1.0)
        {
            samples.push(f64::midpoint(constant, next));
        }
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expr::ObjectId;

    fn bit(exprs: &mut Exprs, n: u32) -> ExprId {
        exprs.read(ObjectId(n), 0)
    }

    #[test]
    fn arms_of_one_if_exclude_each_other() {
        let mut exprs = Exprs::default();
        let (a, b) = (bit(&mut exprs, 0), bit(&mut exprs, 1));
        let both = exprs.and(a, b);
        let neither = exprs.not(both);
        assert!(exclusive(&exprs, both, neither));
        assert!(!exclusive(&exprs, a, neither));
        // a AND NOT b, against b OR NOT a: complementary by value, not by form.
        let not_a = exprs.not(a);
        let not_b = exprs.not(b);
        let left = exprs.and(a, not_b);
        let right = exprs.or(b, not_a);
        assert!(exclusive(&exprs, left, right));
    }

    #[test]
    fn conditions_leave_nothing_out_when_they_cover_all() {
        let mut exprs = Exprs::default();
        let (a, b) = (bit(&mut exprs, 0), bit(&mut exprs, 1));
        let not_a = exprs.not(a);
        let (both, other) = (exprs.and(a, b), exprs.and(not_a, b));
        let all = Exprs::TRUE;
        assert_eq!(without(&exprs, &[all], &[[a, all], [not_a, all]]), Verdict::Never);
        assert_eq!(without(&exprs, &[all], &[[both, all], [other, all]]), Verdict::Possible);
        assert_eq!(without(&exprs, &[b], &[[both, all], [other, all]]), Verdict::Never);
        assert_eq!(without(&exprs, &[b], &[[a, b], [not_a, a]]), Verdict::Possible);
    }

    #[test]
    fn another_version_is_another_value() {
        let mut exprs = Exprs::default();
        let before = exprs.read(ObjectId(0), 0);
        let after = exprs.read(ObjectId(0), 1);
        let not_after = exprs.not(after);
        assert!(!exclusive(&exprs, before, not_after));
    }

    #[test]
    fn comparisons_of_one_term_share_its_value() {
        let mut exprs = Exprs::default();
        let term = bit(&mut exprs, 0);
        let (five, six, nine) = (exprs.int(5), exprs.int(6), exprs.int(9));
        let below = exprs.compare(Comparison::Lt, term, five);
        let above = exprs.compare(Comparison::Gt, term, nine);
        let equal = exprs.compare(Comparison::Eq, term, six);
        let between = exprs.compare(Comparison::Gt, six, term);
        assert!(exclusive(&exprs, below, above));
        assert!(exclusive(&exprs, below, equal));
        assert!(!exclusive(&exprs, below, between));
        // Nothing whole lies strictly between 5 and 6.
        let over_five = exprs.compare(Comparison::Gt, term, five);
        assert!(exclusive(&exprs, over_five, between));
    }

    #[test]
    fn edges_exclude_each_other_and_imply_the_level() {
        let mut exprs = Exprs::default();
        let rising = exprs.edge(ObjectId(0), 0, true);
        let falling = exprs.edge(ObjectId(0), 0, false);
        let level = bit(&mut exprs, 0);
        let low = exprs.not(level);
        assert!(exclusive(&exprs, rising, falling));
        assert!(exclusive(&exprs, rising, low));
        assert!(exclusive(&exprs, falling, level));
        assert!(!exclusive(&exprs, rising, level));
    }

    #[test]
    fn large_conditions_are_decided_by_the_solver() {
        let mut exprs = Exprs::default();
        let some = |exprs: &mut Exprs, count: u32| {
            (1..count).fold(bit(exprs, 0), |any, n| {
                let next = bit(exprs, n);
                exprs.or(any, next)
            })
        };
        let any = some(&mut exprs, 40);
        let other = exprs.xor(any, Exprs::TRUE);
        assert_eq!(together(&exprs, &[any]), Verdict::Possible);
        assert_eq!(together(&exprs, &[any, other]), Verdict::Never, "by form");
        let mut all = vec![any];
        for n in 0..40 {
            let absent = bit(&mut exprs, n);
            all.push(exprs.not(absent));
        }
        assert_eq!(together(&exprs, &all), Verdict::Never, "by what they say");
        let too_many = some(&mut exprs, 5000);
        assert_eq!(together(&exprs, &[too_many]), Verdict::NotDecided);
    }

    #[test]
    fn constants_are_recognised() {
        let mut exprs = Exprs::default();
        let a = bit(&mut exprs, 0);
        let b = bit(&mut exprs, 1);
        let not_a = exprs.not(a);
        let inner = exprs.or(b, not_a);
        let always = exprs.or(a, inner);
        assert_eq!(constant(&mut exprs, always), Some(true));
        assert_eq!(constant(&mut exprs, inner), None);
    }
}

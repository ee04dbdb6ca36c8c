//! Whether conditions can hold together.
//!
//! Atoms are bits, edges, comparisons and opaque values; equal atoms (same object, same version) have equal values.
//! The laws between atoms are respected: a rising edge implies the bit, a falling edge its absence, and the comparisons
//! of one term with constants agree with some value of the term. Small conditions are decided by a truth table in
//! machine words; beyond [`MAX_ATOMS`] the answer is "not decided".

use rustc_hash::FxHashMap;

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
    match Table::new(exprs, &conjuncts) {
        Some(table) => table.decide(exprs, &conjuncts),
        None => Verdict::NotDecided,
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
    let mut known = FxHashMap::default();
    let mut rows = table.lawful(exprs);
    for &it in given {
        let value = table.evaluate(exprs, it, &mut known);
        rows.iter_mut().zip(value).for_each(|(row, value)| *row &= value);
    }
    for &[a, b] in others {
        let (a, b) = (table.evaluate(exprs, a, &mut known), table.evaluate(exprs, b, &mut known));
        rows.iter_mut().zip(a).zip(b).for_each(|((row, a), b)| *row &= !(a & b));
    }
    if rows.iter().any(|&it| it != 0) { Verdict::Possible } else { Verdict::Never }
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

/// A truth table: one bit a row, `rows` of them.
type Bits = Vec<u64>;

struct Table {
    atoms: FxHashMap<ExprId, usize>,
    order: Vec<ExprId>,
    words: usize,
    rows: usize,
}

impl Table {
    /// `None` when the conditions are too large to decide.
    fn new(exprs: &Exprs, conditions: &[ExprId]) -> Option<Self> {
        let mut atoms = FxHashMap::default();
        let mut order = Vec::new();
        let mut seen = rustc_hash::FxHashSet::default();
        let mut stack = conditions.to_vec();
        while let Some(id) = stack.pop() {
            if !seen.insert(id) {
                continue;
            }
            if seen.len() > MAX_NODES {
                return None;
            }
            match *exprs.get(id) {
                Expr::Bool(_) => {}
                Expr::Not(a) => stack.push(a),
                Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => stack.extend([a, b]),
                _ => {
                    atoms.insert(id, order.len());
                    order.push(id);
                    // An edge says something of its bit.
                    if let Expr::Edge { object, version, .. } = *exprs.get(id)
                        && let Some(bit) = exprs.find_read(object, version)
                    {
                        stack.push(bit);
                    }
                    if order.len() > MAX_ATOMS {
                        return None;
                    }
                }
            }
        }
        let rows = 1_usize << order.len();
        Some(Self { atoms, order, words: rows.div_ceil(64), rows })
    }

    fn constant(&self, value: bool) -> Bits {
        let mut bits = vec![if value { u64::MAX } else { 0 }; self.words];
        if value && self.rows < 64 {
            bits[0] = (1 << self.rows) - 1;
        }
        bits
    }

    /// Rows in which the n-th atom is true.
    fn atom(&self, n: usize) -> Bits {
        const PATTERN: [u64; 6] = [
            0xAAAA_AAAA_AAAA_AAAA,
            0xCCCC_CCCC_CCCC_CCCC,
            0xF0F0_F0F0_F0F0_F0F0,
            0xFF00_FF00_FF00_FF00,
            0xFFFF_0000_FFFF_0000,
            0xFFFF_FFFF_0000_0000,
        ];
        let full = self.constant(true);
        (0..self.words)
            .map(|word| match PATTERN.get(n) {
                Some(pattern) => pattern & full[word],
                None if word >> (n - 6) & 1 == 1 => u64::MAX,
                None => 0,
            })
            .collect()
    }

    fn decide(&self, exprs: &Exprs, conditions: &[ExprId]) -> Verdict {
        let mut rows = self.lawful(exprs);
        let mut known: FxHashMap<ExprId, Bits> = FxHashMap::default();
        for &condition in conditions {
            let value = self.evaluate(exprs, condition, &mut known);
            for (row, word) in rows.iter_mut().zip(&value) {
                *row &= word;
            }
        }
        if rows.iter().any(|&it| it != 0) { Verdict::Possible } else { Verdict::Never }
    }

    /// Bottom-up over the expression, without recursion.
    fn evaluate(&self, exprs: &Exprs, root: ExprId, known: &mut FxHashMap<ExprId, Bits>) -> Bits {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if known.contains_key(&id) {
                continue;
            }
            let value = if let Some(&n) = self.atoms.get(&id) {
                Some(self.atom(n))
            } else {
                match *exprs.get(id) {
                    Expr::Bool(value) => Some(self.constant(value)),
                    Expr::Not(a) => {
                        stack.extend((!ready).then_some((id, true)));
                        stack.extend((!ready).then_some((a, false)));
                        known.get(&a).filter(|_| ready).map(|a| {
                            let full = self.constant(true);
                            a.iter().zip(full).map(|(x, full)| !x & full).collect()
                        })
                    }
                    Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => {
                        if !ready {
                            stack.extend([(id, true), (a, false), (b, false)]);
                        }
                        known.get(&a).zip(known.get(&b)).filter(|_| ready).map(|(a, b)| {
                            let pairs = a.iter().zip(b);
                            match exprs.get(id) {
                                Expr::And(..) => pairs.map(|(x, y)| x & y).collect(),
                                Expr::Or(..) => pairs.map(|(x, y)| x | y).collect(),
                                _ => pairs.map(|(x, y)| x ^ y).collect(),
                            }
                        })
                    }
                    _ => Some(self.constant(true)),
                }
            };
            if let Some(value) = value {
                known.insert(id, value);
            }
        }
        known.get(&root).cloned().unwrap_or_else(|| self.constant(true))
    }

    /// Rows that the laws between atoms allow.
    fn lawful(&self, exprs: &Exprs) -> Bits {
        let mut rows = self.constant(true);
        if !self.order.iter().any(|it| matches!(exprs.get(*it), Expr::Edge { .. } | Expr::Compare(..))) {
            return rows;
        }
        let full = self.constant(true);
        let mut forbid = |literals: &[(usize, bool)]| {
            let mut bad = full.clone();
            for &(n, value) in literals {
                for (word, atom) in bad.iter_mut().zip(self.atom(n)) {
                    *word &= if value { atom } else { !atom };
                }
            }
            for (row, bad) in rows.iter_mut().zip(bad) {
                *row &= !bad;
            }
        };
        for (n, &id) in self.order.iter().enumerate() {
            if let Expr::Edge { object, version, rising } = *exprs.get(id) {
                if let Some(&bit) = exprs.find_read(object, version).as_ref().and_then(|it| self.atoms.get(it)) {
                    forbid(&[(n, true), (bit, !rising)]);
                }
                let other = Expr::Edge { object, version, rising: !rising };
                if let Some(other) = self.order.iter().position(|&it| *exprs.get(it) == other) {
                    forbid(&[(n, true), (other, true)]);
                }
            }
        }
        for law in self.orders(exprs) {
            for (row, law) in rows.iter_mut().zip(law) {
                *row &= law;
            }
        }
        rows
    }

    /// For each term compared with constants or with one other term: the rows that some value of it explains.
    fn orders(&self, exprs: &Exprs) -> Vec<Bits> {
        let mut terms: FxHashMap<(ExprId, Option<ExprId>), Vec<Compared>> = FxHashMap::default();
        for (n, &id) in self.order.iter().enumerate() {
            let Expr::Compare(op, a, b) = *exprs.get(id) else { continue };
            match (number(exprs, a), number(exprs, b)) {
                (None, Some(value)) => {
                    let whole = matches!(exprs.get(b), Expr::Int(_));
                    terms.entry((a, None)).or_default().push((n, op, Some(value), whole));
                }
                (Some(value), None) => {
                    let whole = matches!(exprs.get(a), Expr::Int(_));
                    terms.entry((b, None)).or_default().push((n, op.mirrored(), Some(value), whole));
                }
                (None, None) if a <= b => terms.entry((a, Some(b))).or_default().push((n, op, None, true)),
                (None, None) => terms.entry((b, Some(a))).or_default().push((n, op.mirrored(), None, true)),
                (Some(_), Some(_)) => {}
            }
        }
        let mut laws = Vec::new();
        for ((_, other), atoms) in &terms {
            let samples: Vec<f64> = if other.is_some() {
                vec![-1.0, 0.0, 1.0]
            } else {
                let mut constants: Vec<f64> = atoms.iter().filter_map(|it| it.2).collect();
                constants.sort_by(f64::total_cmp);
                constants.dedup();
                samples_around(&constants, atoms.iter().all(|it| it.3))
            };
            let mut law = self.constant(false);
            for sample in samples {
                let mut row = self.constant(true);
                for &(n, op, constant, _) in atoms {
                    let holds = sample.partial_cmp(&constant.unwrap_or(0.0)).is_some_and(|it| op.holds(it));
                    for (word, atom) in row.iter_mut().zip(self.atom(n)) {
                        *word &= if holds { atom } else { !atom };
                    }
                }
                for (word, row) in law.iter_mut().zip(row) {
                    *word |= row;
                }
            }
            laws.push(law);
        }
        laws
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
    fn large_conditions_are_not_decided() {
        let mut exprs = Exprs::default();
        let mut any = bit(&mut exprs, 0);
        for n in 1..40 {
            let next = bit(&mut exprs, n);
            any = exprs.or(any, next);
        }
        let other = exprs.xor(any, Exprs::TRUE);
        assert_eq!(together(&exprs, &[any]), Verdict::NotDecided);
        assert_eq!(together(&exprs, &[any, other]), Verdict::Never, "by form");
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

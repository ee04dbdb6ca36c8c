//! Expressions, shared: equal expressions of a unit have equal ids.
//!
//! A read carries the *version* of what it reads. Two reads of one object with equal versions give the same value,
//! because nothing wrote the object between them.

use std::hash::BuildHasher as _;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// Index of an object in the unit's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Index of an expression in the unit's arena.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(pub u32);

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Comparison {
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
}

impl Comparison {
    /// The comparison that holds exactly when this one does not.
    pub fn negated(self) -> Self {
        match self {
            Self::Eq => Self::Ne,
            Self::Ne => Self::Eq,
            Self::Lt => Self::Ge,
            Self::Ge => Self::Lt,
            Self::Gt => Self::Le,
            Self::Le => Self::Gt,
        }
    }

    /// The comparison with its operands exchanged.
    pub fn mirrored(self) -> Self {
        match self {
            Self::Lt => Self::Gt,
            Self::Gt => Self::Lt,
            Self::Le => Self::Ge,
            Self::Ge => Self::Le,
            other => other,
        }
    }

    pub fn as_str(self) -> &'static str {
        match self {
            Self::Eq => "=",
            Self::Ne => "<>",
            Self::Lt => "<",
            Self::Le => "<=",
            Self::Gt => ">",
            Self::Ge => ">=",
        }
    }

    /// Whether a comparison of a number with a constant holds for every number of a range, or for none; `None` where that
    /// depends on the number.
    pub fn decided(self, first: i64, last: i64, constant: i64) -> Option<bool> {
        match self {
            Self::Eq if constant < first || constant > last => Some(false),
            Self::Eq if first == last => Some(true),
            Self::Eq => None,
            Self::Lt if last < constant => Some(true),
            Self::Lt if first >= constant => Some(false),
            Self::Lt => None,
            Self::Le if last <= constant => Some(true),
            Self::Le if first > constant => Some(false),
            Self::Le => None,
            Self::Ne | Self::Gt | Self::Ge => self.negated().decided(first, last, constant).map(|it| !it),
        }
    }

    pub fn holds(self, order: std::cmp::Ordering) -> bool {
        match self {
            Self::Eq => order.is_eq(),
            Self::Ne => order.is_ne(),
            Self::Lt => order.is_lt(),
            Self::Le => order.is_le(),
            Self::Gt => order.is_gt(),
            Self::Ge => order.is_ge(),
        }
    }
}

/// Operators on numbers and patterns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operator {
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    And,
    Or,
    Xor,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Expr {
    Bool(bool),
    Int(i64),
    /// Bits of an `f64`.
    Float(u64),
    Text(SmolStr),
    /// The value of an object; as a condition, whether the bit is 1.
    Read {
        object: ObjectId,
        version: u32,
    },
    /// Rising or falling edge of a bit.
    Edge {
        object: ObjectId,
        version: u32,
        rising: bool,
    },
    Not(ExprId),
    And(ExprId, ExprId),
    Or(ExprId, ExprId),
    Xor(ExprId, ExprId),
    Compare(Comparison, ExprId, ExprId),
    Negate(ExprId),
    Binary(Operator, ExprId, ExprId),
    Call(SmolStr, Box<[ExprId]>),
    /// A value about which nothing is known; equal only to itself.
    Opaque(u32),
}

impl Expr {
    fn operands(&self, mut each: impl FnMut(ExprId)) {
        match self {
            Self::Not(a) | Self::Negate(a) => each(*a),
            Self::And(a, b) | Self::Or(a, b) | Self::Xor(a, b) | Self::Compare(_, a, b) | Self::Binary(_, a, b) => {
                each(*a);
                each(*b);
            }
            Self::Call(_, list) => list.iter().for_each(|it| each(*it)),
            _ => {}
        }
    }

    /// The same of other operands.
    fn with_operands(&self, mut of: impl FnMut(ExprId) -> ExprId) -> Self {
        match self {
            Self::Not(a) => Self::Not(of(*a)),
            Self::And(a, b) => Self::And(of(*a), of(*b)),
            Self::Or(a, b) => Self::Or(of(*a), of(*b)),
            Self::Xor(a, b) => Self::Xor(of(*a), of(*b)),
            Self::Compare(op, a, b) => Self::Compare(*op, of(*a), of(*b)),
            Self::Negate(a) => Self::Negate(of(*a)),
            Self::Binary(op, a, b) => Self::Binary(*op, of(*a), of(*b)),
            Self::Call(name, list) => Self::Call(name.clone(), list.iter().map(|it| of(*it)).collect()),
            other => other.clone(),
        }
    }
}

/// Expressions that were met, each once.
#[derive(Debug)]
struct Met {
    all: Vec<ExprId>,
    /// Those of `all`, once they are many.
    many: FxHashSet<ExprId>,
}

impl Met {
    /// Fewer than these are looked through, more are hashed.
    const FEW: usize = 48;

    fn new() -> Self {
        Self { all: Vec::with_capacity(16), many: FxHashSet::default() }
    }

    /// Whether the expression was not met before.
    fn add(&mut self, id: ExprId) -> bool {
        let is_new = if self.all.len() < Self::FEW {
            !self.all.contains(&id)
        } else {
            if self.many.is_empty() {
                self.many.extend(self.all.iter().copied());
            }
            self.many.insert(id)
        };
        if is_new {
            self.all.push(id);
        }
        is_new
    }

    fn count(&self) -> usize {
        self.all.len()
    }

    fn sorted(mut self) -> Vec<ExprId> {
        self.all.sort_unstable();
        self.all
    }
}

/// The expressions of one unit.
#[derive(Debug, Clone)]
pub struct Exprs {
    nodes: Vec<Expr>,
    ids: HashTable<ExprId>,
    opaque: u32,
}

/// A condition cut out of a unit, free of versions: what is asked of objects as they are at one moment. Its objects are
/// those of the unit that it comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guard {
    /// Operands before what they are operands of; the last is the condition.
    nodes: Box<[Expr]>,
}

impl Guard {
    /// Every object that it reads or tests for an edge.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> {
        self.nodes.iter().filter_map(|it| match it {
            Expr::Read { object, .. } | Expr::Edge { object, .. } => Some(*object),
            _ => None,
        })
    }

    /// Whether nothing of it is a value about which nothing is known.
    pub fn is_understood(&self) -> bool {
        !self.nodes.iter().any(|it| matches!(it, Expr::Opaque(_)))
    }
}

/// Expressions cut out of a unit with their versions: what several places of it compute. Its objects are those of the
/// unit.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Pool {
    /// Operands before what they are operands of.
    nodes: Box<[Packed]>,
}

/// An expression in the room that most of them need: pools are kept for every unit.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Packed {
    Read(ObjectId, u32),
    Not(ExprId),
    And(ExprId, ExprId),
    Or(ExprId, ExprId),
    Other(Box<Expr>),
}

impl Packed {
    fn new(expr: Expr) -> Self {
        match expr {
            Expr::Read { object, version } => Self::Read(object, version),
            Expr::Not(a) => Self::Not(a),
            Expr::And(a, b) => Self::And(a, b),
            Expr::Or(a, b) => Self::Or(a, b),
            other => Self::Other(Box::new(other)),
        }
    }

    fn unpack(&self) -> Expr {
        match *self {
            Self::Read(object, version) => Expr::Read { object, version },
            Self::Not(a) => Expr::Not(a),
            Self::And(a, b) => Expr::And(a, b),
            Self::Or(a, b) => Expr::Or(a, b),
            Self::Other(ref other) => (**other).clone(),
        }
    }
}

impl Pool {
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
}

/// Where the expressions of a unit stand in a [`Pool`] that was cut out of it.
#[derive(Debug)]
pub struct Places(Vec<u32>);

impl Places {
    /// Of an expression that is part of the pool.
    pub fn of(&self, id: ExprId) -> u32 {
        self.0.get(id.0 as usize).copied().unwrap_or(0)
    }
}

/// What stands in the place of a read.
pub enum Replaced {
    /// This, as it is.
    By(ExprId),
    /// This, when the reads in it are replaced.
    As(ExprId),
}

impl Default for Exprs {
    fn default() -> Self {
        Self::with_capacity(0)
    }
}

fn hash(expr: &Expr) -> u64 {
    FxBuildHasher.hash_one(expr)
}

impl Exprs {
    pub const FALSE: ExprId = ExprId(0);
    pub const TRUE: ExprId = ExprId(1);

    pub fn get(&self, id: ExprId) -> &Expr {
        &self.nodes[id.0 as usize]
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Room for so many expressions.
    pub fn with_capacity(capacity: usize) -> Self {
        let capacity = capacity.max(2);
        let (nodes, ids) = (Vec::with_capacity(capacity), HashTable::with_capacity(capacity));
        let mut exprs = Self { nodes, ids, opaque: 0 };
        exprs.intern(Expr::Bool(false));
        exprs.intern(Expr::Bool(true));
        exprs
    }

    fn intern(&mut self, expr: Expr) -> ExprId {
        let nodes = &self.nodes;
        let id = ExprId(u32::try_from(nodes.len()).unwrap_or(u32::MAX));
        let entry = self.ids.entry(hash(&expr), |it| nodes[it.0 as usize] == expr, |it| hash(&nodes[it.0 as usize]));
        match entry {
            Entry::Occupied(found) => *found.get(),
            Entry::Vacant(entry) => {
                entry.insert(id);
                self.nodes.push(expr);
                id
            }
        }
    }

    fn find(&self, expr: &Expr) -> Option<ExprId> {
        self.ids.find(hash(expr), |it| self.nodes[it.0 as usize] == *expr).copied()
    }

    /// The condition with all it is made of, unless that is more than `most` expressions.
    pub fn cut(&self, condition: ExprId, most: usize) -> Option<Guard> {
        let mut met = Met::new();
        let mut next = Some(condition);
        let mut stack = Vec::new();
        while let Some(id) = next {
            if met.add(id) {
                self.get(id).operands(|it| stack.push(it));
            }
            if met.count() > most {
                return None;
            }
            next = stack.pop();
        }
        // Ids grow from operands to what they are operands of.
        let ids = met.sorted();
        let place = |id: ExprId| ExprId(ids.binary_search(&id).ok().and_then(|it| u32::try_from(it).ok()).unwrap_or(0));
        let node = |id: &ExprId| match self.get(*id) {
            Expr::Read { object, .. } => Expr::Read { object: *object, version: 0 },
            Expr::Edge { object, rising, .. } => Expr::Edge { object: *object, version: 0, rising: *rising },
            other => other.with_operands(place),
        };
        Some(Guard { nodes: ids.iter().map(node).collect() })
    }

    /// Whether a condition is made of at most so many expressions, those that it has several times counted as often.
    pub fn is_within(&self, condition: ExprId, most: usize) -> bool {
        let mut next = Some(condition);
        let mut stack = Vec::new();
        let mut count = 0;
        while let Some(id) = next {
            count += 1;
            if count > most {
                return false;
            }
            self.get(id).operands(|it| stack.push(it));
            next = stack.pop();
        }
        true
    }

    /// What an expression is made of, one level down.
    pub fn each_operand(&self, id: ExprId, each: impl FnMut(ExprId)) {
        self.get(id).operands(each);
    }

    /// Every expression that a condition is made of, itself too, each once.
    pub fn each_part(&self, condition: ExprId, mut each: impl FnMut(ExprId)) {
        let mut met = Met::new();
        let mut next = Some(condition);
        let mut stack = Vec::new();
        while let Some(id) = next {
            if met.add(id) {
                self.get(id).operands(|it| stack.push(it));
                each(id);
            }
            next = stack.pop();
        }
    }

    /// Whether a condition, or something that it is made of, is what `is` says.
    pub fn has_part(&self, condition: ExprId, is: impl Fn(&Expr) -> bool) -> bool {
        let mut found = false;
        self.each_part(condition, |id| found |= is(self.get(id)));
        found
    }

    /// Every object that a condition reads or tests for an edge.
    pub fn each_object(&self, condition: ExprId, mut each: impl FnMut(ObjectId)) {
        self.each_part(condition, |id| match self.get(id) {
            Expr::Read { object, .. } | Expr::Edge { object, .. } => each(*object),
            _ => {}
        });
    }

    /// Every plain read that a condition is made of.
    pub fn each_read(&self, condition: ExprId, mut each: impl FnMut(ExprId)) {
        self.each_part(condition, |id| {
            if matches!(self.get(id), Expr::Read { .. }) {
                each(id);
            }
        });
    }

    /// Every comparison that a condition is made of.
    pub fn each_comparison(&self, condition: ExprId, mut each: impl FnMut(Comparison, ExprId, ExprId)) {
        self.each_part(condition, |id| {
            if let Expr::Compare(op, a, b) = *self.get(id) {
                each(op, a, b);
            }
        });
    }

    /// A condition of another unit, over objects as `object` names them here.
    pub fn import(&mut self, guard: &Guard, mut object: impl FnMut(ObjectId) -> ObjectId) -> ExprId {
        let mut ids: Vec<ExprId> = Vec::with_capacity(guard.nodes.len());
        for node in &guard.nodes {
            let at = |it: ExprId| ids.get(it.0 as usize).copied().unwrap_or(Self::FALSE);
            let id = match node {
                Expr::Read { object: it, version } => self.read(object(*it), *version),
                Expr::Edge { object: it, version, rising } => self.edge(object(*it), *version, *rising),
                Expr::Opaque(_) => self.opaque(),
                other => self.build(&other.with_operands(at)),
            };
            ids.push(id);
        }
        ids.last().copied().unwrap_or(Self::FALSE)
    }

    /// An expression by its form, simplified; its operands are those of this list.
    fn build(&mut self, expr: &Expr) -> ExprId {
        match *expr {
            Expr::Not(a) => self.not(a),
            Expr::And(a, b) => self.and(a, b),
            Expr::Or(a, b) => self.or(a, b),
            Expr::Xor(a, b) => self.xor(a, b),
            Expr::Negate(a) => self.negate(a),
            _ => self.intern(expr.clone()),
        }
    }

    /// Some conditions with all that they are made of, versions too, and where each expression went.
    pub fn cut_all(&self, conditions: impl IntoIterator<Item = ExprId>) -> (Pool, Places) {
        let mut is_part = vec![false; self.nodes.len()];
        let mark = |is_part: &mut Vec<bool>, id: ExprId| {
            if let Some(it) = is_part.get_mut(id.0 as usize) {
                *it = true;
            }
        };
        conditions.into_iter().for_each(|it| mark(&mut is_part, it));
        // Ids grow from operands to what they are operands of.
        for (at, node) in self.nodes.iter().enumerate().rev() {
            if is_part[at] {
                node.operands(|it| mark(&mut is_part, it));
            }
        }
        let mut places = Places(vec![0; self.nodes.len()]);
        let mut nodes = Vec::with_capacity(is_part.iter().filter(|it| **it).count());
        for (at, node) in self.nodes.iter().enumerate().filter(|it| is_part[it.0]) {
            places.0[at] = u32::try_from(nodes.len()).unwrap_or(u32::MAX);
            nodes.push(Packed::new(node.with_operands(|it| ExprId(places.of(it)))));
        }
        (Pool { nodes: nodes.into() }, places)
    }

    /// A condition in which reads, edge tests and values about which nothing is known are replaced. `known` holds what is
    /// replaced already, and takes what is found. A replacement that has not been made itself is `Err`: it is made first.
    pub fn rewrite(
        &mut self,
        condition: ExprId,
        known: &mut FxHashMap<ExprId, ExprId>,
        mut leaf: impl FnMut(&mut Self, ExprId) -> Replaced,
    ) -> ExprId {
        let mut stack = vec![condition];
        while let Some(&id) = stack.last() {
            if known.contains_key(&id) {
                stack.pop();
                continue;
            }
            let is_leaf = matches!(self.get(id), Expr::Read { .. } | Expr::Edge { .. } | Expr::Opaque(_));
            if is_leaf {
                match leaf(self, id) {
                    Replaced::By(it) => {
                        known.insert(id, it);
                    }
                    Replaced::As(it) => match known.get(&it) {
                        Some(&made) => {
                            known.insert(id, made);
                        }
                        None => stack.push(it),
                    },
                }
                continue;
            }
            let before = stack.len();
            let expr = self.get(id).clone();
            expr.operands(|it| {
                if !known.contains_key(&it) {
                    stack.push(it);
                }
            });
            if stack.len() == before {
                let made = self.build(&expr.with_operands(|it| known.get(&it).copied().unwrap_or(it)));
                known.insert(id, made);
            }
        }
        known.get(&condition).copied().unwrap_or(condition)
    }

    /// One of the expressions of a pool, with what stands in the place of its reads, edge tests and unknown values. `known`
    /// has as many places as the pool.
    pub fn import_from(
        &mut self,
        pool: &Pool,
        at: u32,
        known: &mut [Option<ExprId>],
        mut leaf: impl FnMut(&mut Self, &Expr) -> ExprId,
    ) -> ExprId {
        let mut stack = vec![at];
        while let Some(&at) = stack.last() {
            let (Some(packed), Some(None)) = (pool.nodes.get(at as usize), known.get(at as usize)) else {
                stack.pop();
                continue;
            };
            let expr = packed.unpack();
            let before = stack.len();
            expr.operands(|it| {
                if let Some(None) = known.get(it.0 as usize) {
                    stack.push(it.0);
                }
            });
            if stack.len() > before {
                continue;
            }
            let made = match expr {
                Expr::Read { .. } | Expr::Edge { .. } | Expr::Opaque(_) => leaf(self, &expr),
                _ => {
                    let operand = |it: ExprId| known.get(it.0 as usize).copied().flatten().unwrap_or(Self::FALSE);
                    self.build(&expr.with_operands(operand))
                }
            };
            known[at as usize] = Some(made);
        }
        known.get(at as usize).copied().flatten().unwrap_or(Self::FALSE)
    }

    pub fn bool(value: bool) -> ExprId {
        if value { Self::TRUE } else { Self::FALSE }
    }

    /// A value that is equal to nothing but itself.
    pub fn opaque(&mut self) -> ExprId {
        self.opaque += 1;
        self.intern(Expr::Opaque(self.opaque))
    }

    pub fn is_opaque(&self, id: ExprId) -> bool {
        matches!(self.get(id), Expr::Opaque(_))
    }

    pub fn int(&mut self, value: i64) -> ExprId {
        self.intern(Expr::Int(value))
    }

    pub fn float(&mut self, value: f64) -> ExprId {
        self.intern(Expr::Float(value.to_bits()))
    }

    pub fn text(&mut self, value: &str) -> ExprId {
        self.intern(Expr::Text(value.into()))
    }

    pub fn read(&mut self, object: ObjectId, version: u32) -> ExprId {
        self.intern(Expr::Read { object, version })
    }

    pub fn edge(&mut self, object: ObjectId, version: u32, rising: bool) -> ExprId {
        self.intern(Expr::Edge { object, version, rising })
    }

    /// The plain read of an object's value, where the unit has one.
    pub fn find_read(&self, object: ObjectId, version: u32) -> Option<ExprId> {
        self.find(&Expr::Read { object, version })
    }

    pub fn not(&mut self, a: ExprId) -> ExprId {
        match *self.get(a) {
            Expr::Bool(value) => Self::bool(!value),
            Expr::Not(inner) => inner,
            Expr::Compare(op, x, y) => self.intern(Expr::Compare(op.negated(), x, y)),
            _ => self.intern(Expr::Not(a)),
        }
    }

    /// Whether one is the negation of the other, as far as their form tells.
    pub fn are_complements(&self, a: ExprId, b: ExprId) -> bool {
        match (self.get(a), self.get(b)) {
            (Expr::Bool(x), Expr::Bool(y)) => x != y,
            (Expr::Not(x), _) if *x == b => true,
            (_, Expr::Not(y)) if *y == a => true,
            (Expr::Compare(op, x, y), Expr::Compare(other, u, v)) => op.negated() == *other && x == u && y == v,
            _ => false,
        }
    }

    /// The negation of an expression by its form, where the unit has it.
    pub fn find_complement(&self, a: ExprId) -> Option<ExprId> {
        match *self.get(a) {
            Expr::Bool(value) => Some(Self::bool(!value)),
            Expr::Not(inner) => Some(inner),
            Expr::Compare(op, x, y) => self.find(&Expr::Compare(op.negated(), x, y)),
            _ => self.find(&Expr::Not(a)),
        }
    }

    pub fn and(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == Self::FALSE || b == Self::FALSE || self.are_complements(a, b) {
            return Self::FALSE;
        }
        if a == Self::TRUE || a == b {
            return b;
        }
        if b == Self::TRUE {
            return a;
        }
        self.intern(Expr::And(a, b))
    }

    pub fn or(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == Self::TRUE || b == Self::TRUE || self.are_complements(a, b) {
            return Self::TRUE;
        }
        if a == Self::FALSE || a == b {
            return b;
        }
        if b == Self::FALSE {
            return a;
        }
        // (p AND c) OR (p AND NOT c) is p: what a jump over code leaves where its paths meet.
        if let (&Expr::And(p, c), &Expr::And(q, d)) = (self.get(a), self.get(b))
            && p == q
            && self.are_complements(c, d)
        {
            return p;
        }
        self.intern(Expr::Or(a, b))
    }

    pub fn xor(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == b {
            return Self::FALSE;
        }
        match (a, b) {
            (Self::FALSE, other) | (other, Self::FALSE) => other,
            (Self::TRUE, other) | (other, Self::TRUE) => self.not(other),
            _ => self.intern(Expr::Xor(a, b)),
        }
    }

    pub fn compare(&mut self, op: Comparison, a: ExprId, b: ExprId) -> ExprId {
        self.intern(Expr::Compare(op, a, b))
    }

    pub fn negate(&mut self, a: ExprId) -> ExprId {
        match *self.get(a) {
            Expr::Int(value) => match value.checked_neg() {
                Some(value) => self.int(value),
                None => self.intern(Expr::Negate(a)),
            },
            Expr::Float(bits) => self.float(-f64::from_bits(bits)),
            _ => self.intern(Expr::Negate(a)),
        }
    }

    pub fn binary(&mut self, op: Operator, a: ExprId, b: ExprId) -> ExprId {
        self.intern(Expr::Binary(op, a, b))
    }

    pub fn call(&mut self, function: &str, arguments: Vec<ExprId>) -> ExprId {
        self.intern(Expr::Call(function.into(), arguments.into_boxed_slice()))
    }

    /// Whether `whole` is `part AND ...`, looking at most 64 conjunctions down its left side.
    pub fn has_conjunct_prefix(&self, whole: ExprId, part: ExprId) -> bool {
        let mut at = whole;
        for _ in 0..64 {
            if at == part || part == Self::TRUE {
                return true;
            }
            match self.get(at) {
                Expr::And(left, _) => at = *left,
                _ => return false,
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_meet_again_cancel() {
        let mut exprs = Exprs::default();
        let (p, c) = (exprs.opaque(), exprs.opaque());
        let not_c = exprs.not(c);
        let taken = exprs.and(p, c);
        let fallen = exprs.and(p, not_c);
        assert_eq!(exprs.or(fallen, taken), p);
        assert_eq!(exprs.and(c, not_c), Exprs::FALSE);
        assert_eq!(exprs.or(c, not_c), Exprs::TRUE);
        assert!(exprs.has_conjunct_prefix(taken, p));
        assert!(!exprs.has_conjunct_prefix(p, taken));
    }

    #[test]
    fn negated_comparison_is_the_opposite_comparison() {
        let mut exprs = Exprs::default();
        let (a, five) = (exprs.opaque(), exprs.int(5));
        let below = exprs.compare(Comparison::Lt, a, five);
        let not_below = exprs.not(below);
        assert_eq!(exprs.get(not_below), &Expr::Compare(Comparison::Ge, a, five));
        assert!(exprs.are_complements(below, not_below));
    }
}

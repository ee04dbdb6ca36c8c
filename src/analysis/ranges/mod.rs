//! The values that numbers can have where a unit uses them.
//!
//! **Sound**: no run of the unit has a value there that lies outside of its range. What is known comes from constants and
//! widths, from the conditions under which control is at a place, from stores before it, and from loops that count. What
//! other code may have changed has any value of its width. Taken for granted, as everywhere: that no other task, event or
//! operator panel changes an object while the unit runs, and that symbols name objects of their own.
//!
//! Reads with equal versions give equal values, so that what a condition says of a read holds for every other one. An answer
//! looks at a bounded number of expressions; beyond it, it is the width's.

pub mod demands;
pub mod span;

use std::cell::{Cell, OnceCell};

use rustc_hash::{FxHashMap, FxHashSet};

use super::conditions::Space;
use crate::model::UnitModel;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs, ObjectId};
use crate::model::unit::{Access, Callee, Counting, DemandKind, Loop, Mode, StatementKind};
use span::{Number, Span, Width};

/// Expressions that one answer looks at.
const MOST_WORK: u32 = 256;
/// How deep in one another.
const DEEPEST: u32 = 24;
/// Conjuncts of the conditions at a place that are looked at.
const MOST_GUARDS: usize = 64;
/// Ways of a disjunction that are told apart.
const MOST_WAYS: usize = 8;

struct Store {
    value: ExprId,
    path: ExprId,
    /// The version that the object had before.
    replaced: u32,
    anchor: u32,
}

pub struct Ranges<'m> {
    model: &'m UnitModel,
    by_blocks: bool,
    /// By object, and the version that they make.
    stores: OnceCell<FxHashMap<(ObjectId, u32), Store>>,
    /// Loops into which a jump leads.
    entered: FxHashSet<u32>,
    /// Of each loop, whether it leaves its index alone.
    steady: Vec<OnceCell<bool>>,
}

/// What holds at a place: conditions with their values.
type Given = [(ExprId, bool)];

/// One question.
struct Query {
    statement: u32,
    work: Cell<u32>,
    /// Loops are taken to leave their indexes alone: what is asked is whether they do.
    assumes_steady: bool,
}

impl<'m> Ranges<'m> {
    /// Costs next to nothing until something is asked.
    pub fn new(model: &'m UnitModel) -> Self {
        let steady = model.loops.iter().map(|_| OnceCell::new()).collect();
        let by_blocks = Space::of(model).family.has_blocks();
        Self { model, by_blocks, stores: OnceCell::new(), entered: entered(model), steady }
    }

    pub(super) fn model(&self) -> &'m UnitModel {
        self.model
    }

    fn store(&self, object: ObjectId, version: u32) -> Option<&Store> {
        self.stores.get_or_init(|| stores(self.model)).get(&(object, version))
    }

    /// The values that an expression can have at a statement that control comes to by a path. `None` when it is no whole
    /// number, or control never comes there.
    pub fn of(&self, value: ExprId, statement: u32, path: ExprId) -> Option<Number> {
        let query = Query { statement, work: Cell::new(MOST_WORK), assumes_steady: false };
        self.eval(&query, value, &[(path, true)], 0)
    }

    /// Whether an object that is read under a path may hold what other code left in it.
    pub fn may_be_left(&self, object: ObjectId, mut version: u32, path: ExprId) -> bool {
        // A version replaces one before it.
        while let Some(store) = self.store(object, version) {
            if self.model.exprs.has_conjunct_prefix(path, store.path) || store.replaced >= version {
                return false;
            }
            version = store.replaced;
        }
        true
    }

    fn eval(&self, query: &Query, id: ExprId, given: &Given, depth: u32) -> Option<Number> {
        let exprs = &self.model.exprs;
        if let Expr::Int(value) = *exprs.get(id) {
            return Some(Number::constant(value));
        }
        let work = query.work.get();
        if work == 0 || depth >= DEEPEST {
            return Some(Number::UNKNOWN);
        }
        query.work.set(work - 1);
        let operand = |it: ExprId| self.eval(query, it, given, depth + 1);
        let number = match *exprs.get(id) {
            Expr::Read { object, version } => return self.read(query, object, version, given, depth),
            Expr::Negate(a) => operand(a)?.negated(),
            Expr::Binary(operator, a, b) => operand(a)?.binary(operator, operand(b)?, self.by_blocks),
            Expr::Call(ref name, ref list) if !self.by_blocks => match (name.as_str(), &**list) {
                ("NOT", &[a]) => operand(a)?.complemented(),
                ("ABS", &[a]) => operand(a)?.absolute(),
                ("SHR", &[a, count]) => operand(a)?.shifted_right(operand(count)?),
                ("SHL", &[a, _]) => Number::all(operand(a)?.width),
                _ => Number::UNKNOWN,
            },
            Expr::Call(..) | Expr::Opaque(_) => Number::UNKNOWN,
            _ => return None,
        };
        self.guarded(query, id, number, given, depth)
    }

    fn read(&self, query: &Query, object: ObjectId, version: u32, given: &Given, depth: u32) -> Option<Number> {
        let place = Number::of(self.model.object(object))?;
        let mut number = place;
        if let Some(store) = self.store(object, version) {
            number = self.stored(query, object, store, given, depth)?;
        } else if let Some(counted) = self.counted(query, object, version, given, depth) {
            number.span = counted.stored_in(place).span;
        }
        match self.model.exprs.find_read(object, version) {
            Some(id) => self.guarded(query, id, number, given, depth),
            None => Some(number),
        }
    }

    /// What a store leaves in an object, which control may have passed by.
    fn stored(&self, query: &Query, object: ObjectId, store: &Store, given: &Given, depth: u32) -> Option<Number> {
        let place = Number::of(self.model.object(object))?;
        if query.work.get() == 0 || depth >= DEEPEST {
            return Some(place);
        }
        let with = |it: bool| [given, &[(store.path, it)]].concat();
        let is_plain = given.iter().any(|it| it.1 && self.model.exprs.has_conjunct_prefix(it.0, store.path));
        let is_sure = is_plain || self.is_never(query, &with(false));
        let after = |given: &Given| -> Number {
            let value = self.eval(query, store.value, given, depth + 1).map_or(place, |it| it.stored_in(place));
            Number { span: Span { by: Some(store.anchor), ..value.span }, ..value }
        };
        if is_sure {
            return Some(after(given));
        }
        let taken = (!self.is_never(query, &with(true))).then(|| after(&with(true)));
        let passed = self.read(query, object, store.replaced, &with(false), depth + 1);
        Some(match (taken, passed) {
            (Some(a), Some(b)) => Number { span: a.span.join(b.span), ..place },
            (Some(it), None) | (None, Some(it)) => it,
            (None, None) => return None,
        })
    }

    /// Whether conditions surely never hold at once.
    fn is_never(&self, query: &Query, given: &Given) -> bool {
        /// Of longer conditions, one is not looked for.
        const LONGEST: usize = 32;
        /// What it costs, in expressions.
        const COST: u32 = 16;
        let work = query.work.get();
        query.work.set(work.saturating_sub(COST));
        let is_short = |it: &(ExprId, bool)| self.model.exprs.is_within(it.0, LONGEST);
        let short: Vec<(ExprId, bool)> = given.iter().filter(|it| is_short(it)).copied().collect();
        work > COST && short.last() == given.last() && Space::of(self.model).solve(&short).is_never()
    }

    /// The values of the index of a loop around the place: from its first to its last.
    fn counted(&self, query: &Query, object: ObjectId, version: u32, given: &Given, depth: u32) -> Option<Number> {
        let mut at = self.model.statements.get(query.statement as usize)?.in_loop;
        while let Some(id) = at {
            let it = self.model.loops.get(id as usize)?;
            if it.index == Some(object)
                && let Some(Counting::Up { first, last }) = it.counting
                // What was read before the loop gave the index its first value is another value.
                && self.start_version(it).is_some_and(|start| version > start)
            {
                if !query.assumes_steady && !self.is_steady(id) {
                    return None;
                }
                let first = self.eval(query, first, given, depth + 1)?;
                let last = self.eval(query, last, given, depth + 1)?;
                let span = Span {
                    first: first.span.first,
                    last: last.span.last.max(first.span.first),
                    tells_first: first.span.tells_first,
                    tells_last: last.span.tells_last,
                    not_zero: false,
                    by: Some(it.anchor),
                };
                return Some(Number { span, width: Width::Word });
            }
            at = it.parent;
        }
        None
    }

    /// The version of the index that a loop starts with.
    fn start_version(&self, it: &Loop) -> Option<u32> {
        let start = self.model.statements.get(it.body.start.checked_sub(1)? as usize)?;
        let StatementKind::Store { access, .. } = start.kind else { return None };
        let access = self.model.accesses.get(access as usize)?;
        (Some(access.object) == it.index).then_some(access.version)
    }

    /// Whether the body of a loop changes neither its index nor what its end is computed from, and jumps lead into no loop
    /// around it. That the indexes of the loops keep their ranges is assumed on the way: the first statement to break that
    /// would be found.
    pub(super) fn is_steady(&self, id: u32) -> bool {
        let Some(cell) = self.steady.get(id as usize) else { return false };
        *cell.get_or_init(|| {
            let mut chain = std::iter::successors(Some(id), |at| self.model.loops.get(*at as usize)?.parent);
            !self.model.has_gaps
                && !self.model.writes_indirectly
                && chain.all(|at| !self.entered.contains(&at) && self.keeps(at))
        })
    }

    fn keeps(&self, id: u32) -> bool {
        let Some(it) = self.model.loops.get(id as usize) else { return false };
        let mut kept: Vec<ObjectId> = it.index.into_iter().collect();
        if let Some(Counting::Up { last, .. }) = it.counting {
            self.model.exprs.each_object(last, |it| kept.push(it));
        }
        if it.index.is_none() || calls_code(self.model, it) {
            return it.index.is_none();
        }
        kept.iter().all(|it| self.model.object(*it).is_fixed())
            && accesses(self.model, it).iter().filter(|it| it.mode.writes() || matches!(it.mode, Mode::Drive(_))).all(
                |write| {
                    let reach = self.reach(write);
                    kept.iter().all(|it| {
                        let kept = &self.model.object(*it).footprint;
                        self.model.object(write.object).footprint.area != kept.area
                            || reach.is_some_and(|(start, end)| {
                                end <= i64::from(kept.start) || i64::from(kept.end()) <= start
                            })
                    })
                },
            )
    }

    /// The bits that a write can change: those of an indexed object lie as far as its index goes.
    fn reach(&self, write: &Access) -> Option<(i64, i64)> {
        let object = self.model.object(write.object);
        let (start, end) = (i64::from(object.footprint.start), i64::from(object.footprint.end()));
        if object.is_fixed() {
            return Some((start, end));
        }
        let demands = &self.model.demands;
        let from = demands.partition_point(|it| it.statement < write.statement);
        let own = demands.get(from..)?.iter().take_while(|it| it.statement == write.statement);
        let index = own.into_iter().find(|it| it.what == DemandKind::Index(write.object))?;
        let query = Query { statement: write.statement, work: Cell::new(MOST_WORK), assumes_steady: true };
        let span = self.eval(&query, index.value, &[(index.path, true)], 0)?.span;
        // Where the sum leaves the area, the object without its index is meant (PL7:1143).
        let bits = demands::step_bits(object)?;
        Some((start + span.first.min(0) * bits, end + span.last.max(0) * bits))
    }

    /// What the conditions at a place leave of a number; `None` when they leave nothing.
    fn guarded(&self, query: &Query, id: ExprId, number: Number, given: &Given, depth: u32) -> Option<Number> {
        let span = self.narrow(query, id, number, given, depth, 2)?;
        Some(Number { span, ..number })
    }

    /// `ways`: disjunctions in one another that are looked into.
    fn narrow(&self, query: &Query, id: ExprId, number: Number, given: &Given, depth: u32, ways: u32) -> Option<Span> {
        if given.iter().all(|it| *it == (Exprs::TRUE, true)) {
            return Some(number.span);
        }
        let exprs = &self.model.exprs;
        let mut open: Vec<(ExprId, bool)> = given.to_vec();
        let (mut known, mut unequal, mut choices) = (Vec::new(), Vec::new(), Vec::new());
        let mut span = number.span;
        let mut budget = MOST_GUARDS;
        while let Some((condition, holds)) = open.pop() {
            if budget == 0 {
                break;
            }
            budget -= 1;
            known.push((condition, holds));
            match (exprs.get(condition), holds) {
                (&Expr::Not(a), _) => open.push((a, !holds)),
                (&Expr::And(a, b), true) | (&Expr::Or(a, b), false) => open.extend([(a, holds), (b, holds)]),
                (Expr::And(..), false) | (Expr::Or(..), true) => choices.push((condition, holds)),
                (&Expr::Compare(op, a, b), _) => {
                    let op = if holds { op } else { op.negated() };
                    let (op, other) = match (a == id, b == id) {
                        (true, false) => (op, b),
                        (false, true) => (op.mirrored(), a),
                        _ => continue,
                    };
                    let Some(other) = self.compared(query, op, number, other, depth) else { continue };
                    // Last, when the ends are known: a number that is not its first value is at least the next.
                    if op == Comparison::Ne { unequal.push(other) } else { span = span.narrowed(op, other)? }
                }
                _ => {}
            }
        }
        for other in unequal {
            span = span.narrowed(Comparison::Ne, other)?;
        }
        for (condition, holds) in choices.into_iter().filter(|_| ways > 0) {
            let mut parts = Vec::new();
            self.alternatives(condition, holds, &mut parts);
            parts.retain(|it| !known.contains(&(it.0, !it.1)));
            if parts.len() > MOST_WAYS || !parts.iter().all(|it| self.concerns(it.0, id)) {
                continue;
            }
            let narrowed = Number { span, ..number };
            let spans = parts.iter().filter_map(|it| self.narrow(query, id, narrowed, &[*it], depth, ways - 1));
            span = spans.reduce(Span::join)?;
        }
        Some(span)
    }

    /// The parts of a condition of which one surely has the value.
    fn alternatives(&self, condition: ExprId, holds: bool, parts: &mut Vec<(ExprId, bool)>) {
        let mut open = vec![condition];
        while let Some(id) = open.pop() {
            match (self.model.exprs.get(id), holds) {
                (&Expr::And(a, b), false) | (&Expr::Or(a, b), true) if parts.len() <= MOST_WAYS => open.extend([a, b]),
                _ => parts.push((id, holds)),
            }
        }
    }

    /// Whether a comparison of a number stands in a condition.
    fn concerns(&self, condition: ExprId, id: ExprId) -> bool {
        /// What is longer leaves the number as it is.
        const LONGEST: usize = 32;
        let mut found = false;
        if self.model.exprs.is_within(condition, LONGEST) {
            self.model.exprs.each_comparison(condition, |_, a, b| found |= a == id || b == id);
        }
        found
    }

    /// What a number is compared with, by itself: no condition is asked for it.
    fn compared(&self, query: &Query, op: Comparison, number: Number, other: ExprId, depth: u32) -> Option<Span> {
        let other = self.eval(query, other, &[(Exprs::TRUE, true)], depth + 1)?.span;
        let is_pattern = other.is_one() && other.first > i16::MAX.into() && other.first <= u16::MAX.into();
        match number.width {
            // `16#FFFF` is -1 in a word; of an order, it depends on the width of the comparison what it is.
            Width::Word if is_pattern && number.span.first < 0 => {
                let is_equality = matches!(op, Comparison::Eq | Comparison::Ne);
                is_equality.then(|| Span::exactly(other.first - (1 << 16)))
            }
            // A word whose width is not known may be compared as another number than it is.
            Width::Unknown if other.first < 0 || other.last > i16::MAX.into() => None,
            _ => Some(other),
        }
    }
}

fn stores(model: &UnitModel) -> FxHashMap<(ObjectId, u32), Store> {
    let mut stores = FxHashMap::default();
    stores.reserve(model.replaced.len());
    for it in &model.statements {
        let StatementKind::Store { access: at, value } = it.kind else { continue };
        let replaced = model.replaced.binary_search_by_key(&at, |it| it.0).ok().map(|it| model.replaced[it].1);
        let (Some(access), Some(replaced)) = (model.accesses.get(at as usize), replaced) else { continue };
        if model.object(access.object).is_fixed() {
            let store = Store { value, path: it.path, replaced, anchor: access.anchor };
            stores.insert((access.object, access.version), store);
        }
    }
    stores
}

/// Loops into which some jump leads from outside.
fn entered(model: &UnitModel) -> FxHashSet<u32> {
    let mut found = FxHashSet::default();
    if model.loops.is_empty() {
        return found;
    }
    for jump in &model.jumps {
        let Some(label) = jump.target.and_then(|it| model.labels.get(it as usize)) else { continue };
        let mut at = model.statements.get(label.statement as usize).and_then(|it| it.in_loop);
        while let Some(it) = at.and_then(|id| model.loops.get(id as usize)) {
            if !it.body.contains(&jump.statement) {
                found.extend(at);
            }
            at = it.parent;
        }
    }
    found
}

/// What the statements of a loop read and write. Accesses stand in the order of their statements.
pub(super) fn accesses<'m>(model: &'m UnitModel, it: &Loop) -> &'m [Access] {
    let all = &model.accesses;
    let start = all.partition_point(|access| access.statement < it.body.start);
    let end = all.partition_point(|access| access.statement < it.body.end);
    all.get(start..end).unwrap_or_default()
}

/// Whether a loop calls code that may write anything. What a function of the system writes, its call says.
pub(super) fn calls_code(model: &UnitModel, it: &Loop) -> bool {
    let body = model.statements.get(it.body.start as usize..it.body.end as usize).unwrap_or_default();
    body.iter().any(|statement| match statement.kind {
        StatementKind::Call(call) => {
            model.calls.get(call as usize).is_none_or(|it| !matches!(it.callee, Callee::Function(_)))
        }
        _ => false,
    })
}

#[cfg(test)]
mod tests;

//! How often loops run, and what that costs.

use rustc_hash::{FxHashMap, FxHashSet};

use super::program::ProgramIndex;
use super::ranges::span::Span;
use super::ranges::{Ranges, accesses, calls_code};
use crate::model::UnitModel;
use crate::model::expr::{Comparison, Expr, ExprId, Exprs, ObjectId, Operator};
use crate::model::object::{Class, Type};
use crate::model::unit::{Access, Counting, Loop, LoopKind, Mode, Statement, StatementKind};

/// A loop of a unit. It holds no position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactLoop {
    pub anchor: u32,
    /// How often it runs at most, where the code tells.
    pub turns: Option<u64>,
    /// What one turn reads, writes and does, without the loops in it.
    pub operations: u64,
    /// Indices of the unit's calls in it, not in the loops in it.
    pub calls: Vec<u32>,
    /// The loop that it stands in, before it in the list.
    pub parent: Option<u32>,
}

/// The loops of a unit, each behind those that it stands in.
pub fn loops(ranges: &Ranges<'_>) -> Vec<FactLoop> {
    let model = ranges.model();
    if model.loops.is_empty() {
        return Vec::new();
    }
    let counter = Counter { model, ranges };
    let mut order: Vec<(u32, &Loop)> = (0..).zip(&model.loops).collect();
    order.sort_by_key(|(id, it)| (it.body.start, std::cmp::Reverse(it.body.end), *id));
    let mut found: Vec<FactLoop> = Vec::with_capacity(order.len());
    let mut open: Vec<(u32, &Loop)> = Vec::new();
    let mut owners: FxHashMap<u32, usize> = FxHashMap::default();
    for (id, it) in order {
        while open.last().is_some_and(|(_, outer)| outer.body.end < it.body.end || outer.body.end <= it.body.start) {
            open.pop();
        }
        let parent = open.last().map(|it| it.0);
        let operations = operations(model, it);
        if let Some(outer) = parent.and_then(|it| found.get_mut(it as usize)) {
            outer.operations = outer.operations.saturating_sub(operations);
        }
        let first = model.calls.partition_point(|call| call.statement < it.body.start);
        let end = model.calls.partition_point(|call| call.statement < it.body.end);
        owners.extend((first..end).filter_map(|at| Some((u32::try_from(at).ok()?, found.len()))));
        open.push((u32::try_from(found.len()).unwrap_or(u32::MAX), it));
        let turns = counter.turns(id, it);
        found.push(FactLoop { anchor: it.anchor, turns, operations, calls: Vec::new(), parent });
    }
    let mut owners: Vec<(u32, usize)> = owners.into_iter().collect();
    owners.sort_unstable();
    for (call, owner) in owners {
        found[owner].calls.push(call);
    }
    found
}

/// What is read, written and done: in instruction lists about as many instructions.
fn operations(model: &UnitModel, it: &Loop) -> u64 {
    (accesses(model, it).len() + it.body.len()) as u64
}

struct Counter<'r, 'm> {
    model: &'m UnitModel,
    ranges: &'r Ranges<'m>,
}

impl Counter<'_, '_> {
    fn turns(&self, id: u32, it: &Loop) -> Option<u64> {
        match it.counting {
            Some(Counting::Up { first, last }) => self.up(id, it, first, last),
            Some(Counting::Down { entry, turn, left }) => self.down(id, it, entry, turn, left),
            None => self.by_condition(id, it),
        }
    }

    fn up(&self, id: u32, it: &Loop, first: ExprId, last: ExprId) -> Option<u64> {
        let start = it.body.start.checked_sub(1)?;
        let path = self.model.statements.get(start as usize)?.path;
        if !self.ranges.is_steady(id) {
            return None;
        }
        let (first, last) = (self.ranges.of(first, start, path)?.span, self.ranges.of(last, start, path)?.span);
        let turns = last.last.checked_sub(first.first)?.checked_add(1)?;
        (first.tells_first && last.tells_last).then(|| u64::try_from(turns).unwrap_or(0))
    }

    /// `LOOP` counts down 16 bits without sign, and goes on until they are 0.
    fn down(&self, id: u32, it: &Loop, entry: ExprId, turn: ExprId, left: ExprId) -> Option<u64> {
        const ALL: u64 = 1 << 16;
        let start = self.model.statements.get(it.body.start as usize)?;
        let span = self.ranges.of(entry, it.body.start, start.path)?.span;
        let is_shared = self.others(id, it).any(|other| other.body.start == it.body.start);
        if is_shared || !span.tells_last || !span.is_within(0, u16::MAX.into()) {
            return None;
        }
        if left != turn && !self.is_kept(it, turn, left, span) {
            return None;
        }
        if span == (Span { by: span.by, ..Span::exactly(0) }) { Some(ALL) } else { u64::try_from(span.last).ok() }
    }

    fn others(&self, id: u32, it: &Loop) -> impl Iterator<Item = &Loop> {
        let keyword = it.keyword;
        (0..).zip(&self.model.loops).filter(move |(other, it)| *other != id && it.keyword != keyword).map(|it| it.1)
    }

    /// Whether an object that takes the count on each turn gives it back at the end.
    fn is_kept(&self, it: &Loop, turn: ExprId, left: ExprId, span: Span) -> bool {
        let Expr::Read { object, .. } = *self.model.exprs.get(left) else { return false };
        let most = match self.model.object(object).ty {
            Type::Byte => u8::MAX.into(),
            Type::Word | Type::Double => u16::MAX.into(),
            _ => return false,
        };
        let Some((write, value)) = self.only_store(it, object) else { return false };
        let end = self.model.statements.get(it.body.end.saturating_sub(1) as usize);
        value == turn && span.last <= most && end.is_some_and(|it| self.comes_by(it.path, write.path))
    }

    fn comes_by(&self, path: ExprId, part: ExprId) -> bool {
        self.model.exprs.has_conjunct_prefix(path, part)
    }

    /// The only statement of a loop that changes an object, with the value that it stores.
    fn only_store(&self, it: &Loop, object: ObjectId) -> Option<(&Access, ExprId)> {
        let model = self.model;
        let own = model.object(object);
        let is_local = matches!(own.class, Class::LocalData | Class::LocalName);
        if !own.is_fixed() || model.writes_indirectly || model.has_gaps || !is_local && calls_code(model, it) {
            return None;
        }
        let writes = |it: &&Access| {
            let other = model.object(it.object);
            let may_meet = if other.is_fixed() {
                other.footprint.overlaps(&own.footprint)
            } else {
                other.footprint.area == own.footprint.area
            };
            may_meet && (it.mode.writes() || matches!(it.mode, Mode::Drive(_)))
        };
        let mut writes = accesses(model, it).iter().filter(writes);
        let only = writes.next().filter(|it| it.object == object && it.mode == Mode::Store)?;
        if writes.next().is_some() {
            return None;
        }
        match model.statements.get(only.statement as usize)?.kind {
            StatementKind::Store { value, .. } => Some((only, value)),
            _ => None,
        }
    }

    /// A loop that goes on while a counter stands on one side of a constant.
    fn by_condition(&self, id: u32, it: &Loop) -> Option<u64> {
        let mut open = vec![(it.condition?, it.kind != LoopKind::Repeat)];
        match it.kind {
            LoopKind::While | LoopKind::Repeat => {}
            // A jump is taken where control comes to it, and its own condition holds.
            LoopKind::Jump => open.push((self.model.statements.get(it.body.end.checked_sub(1)? as usize)?.path, true)),
            LoopKind::For => return None,
        }
        // Where several conditions have to hold, each alone bounds the loop.
        let mut least: Option<u64> = None;
        let mut budget = 32;
        while let Some((at, holds)) = open.pop() {
            budget -= 1;
            if budget == 0 {
                break;
            }
            match *self.model.exprs.get(at) {
                Expr::Not(a) => open.push((a, !holds)),
                Expr::And(a, b) if holds => open.extend([(a, true), (b, true)]),
                Expr::Or(a, b) if !holds => open.extend([(a, false), (b, false)]),
                Expr::Compare(op, a, b) => {
                    let op = if holds { op } else { op.negated() };
                    let turns = self.bounded(id, it, op, a, b).or_else(|| self.bounded(id, it, op.mirrored(), b, a));
                    least = match (least, turns) {
                        (Some(a), Some(b)) => Some(a.min(b)),
                        (a, b) => a.or(b),
                    };
                }
                _ => {}
            }
        }
        least
    }

    /// The turns of a loop that goes on while a counter compares so with a limit.
    fn bounded(&self, id: u32, it: &Loop, op: Comparison, counter: ExprId, limit: ExprId) -> Option<u64> {
        let exprs = &self.model.exprs;
        let Expr::Read { object, version } = *exprs.get(counter) else { return None };
        let is_asked = |it: &Access| it.object == object && it.version == version && it.mode.reads();
        if !accesses(self.model, it).iter().any(is_asked) {
            return None;
        }
        let (write, value) = self.only_store(it, object)?;
        let is_own = |it: ExprId| matches!(*exprs.get(it), Expr::Read { object: read, .. } if read == object);
        let step = match *exprs.get(value) {
            Expr::Binary(Operator::Add, a, b) => match (exprs.get(a), exprs.get(b)) {
                (_, &Expr::Int(step)) if is_own(a) => step,
                (&Expr::Int(step), _) if is_own(b) => step,
                _ => return None,
            },
            Expr::Binary(Operator::Sub, a, b) if is_own(a) => match *exprs.get(b) {
                Expr::Int(step) => step.checked_neg()?,
                _ => return None,
            },
            _ => return None,
        };
        let is_shared = it.kind == LoopKind::Jump && self.others(id, it).any(|other| other.body.start == it.body.start);
        if is_shared || !self.is_counted_each_turn(it, write) {
            return None;
        }
        let limit = self.ranges.of(limit, it.body.start, Exprs::TRUE)?.span;
        let first = self.first(it, object)?;
        let tells = |it: Span| it.tells_first && it.tells_last;
        if !tells(limit) || !tells(first) {
            return None;
        }
        // How far the counter goes, and whether it goes on where it meets the limit.
        let (way, also) = match op {
            Comparison::Lt | Comparison::Le if step > 0 => (limit.last - first.first, op == Comparison::Le),
            Comparison::Gt | Comparison::Ge if step < 0 => (first.last - limit.first, op == Comparison::Ge),
            Comparison::Ne if limit.is_one() && first.is_one() => {
                let way = limit.first - first.first;
                let meets = way.signum() == step.signum() && way.checked_rem(step) == Some(0);
                (meets.then(|| way.abs())?, false)
            }
            _ => return None,
        };
        let size = step.checked_abs()?;
        let turns = if also { way.div_euclid(size) + 1 } else { (way - 1).div_euclid(size) + 1 };
        let turns = u64::try_from(turns).unwrap_or(0);
        // A condition at the end is asked when a turn has been run; one that is asked before the counter moves lets it run
        // once more.
        Some(match it.kind {
            LoopKind::While => turns,
            _ => turns.max(1) + u64::from(turns > 0 && version < write.version),
        })
    }

    /// Whether a statement of a loop is run on each turn after which the loop may go on.
    fn is_counted_each_turn(&self, it: &Loop, write: &Access) -> bool {
        let statements = &self.model.statements;
        let asked = match it.kind {
            LoopKind::While => statements.get(it.body.start as usize),
            _ => statements.get(it.body.end.saturating_sub(1) as usize),
        };
        let Some(asked) = asked else { return false };
        match (it.kind, it.condition) {
            (LoopKind::While, Some(condition)) => match *self.model.exprs.get(write.path) {
                _ if write.path == condition => asked.path == Exprs::TRUE,
                Expr::And(before, own) => before == asked.path && own == condition,
                _ => false,
            },
            _ => self.comes_by(asked.path, write.path),
        }
    }

    /// What an object holds where a loop is entered: what the statements right before it store.
    fn first(&self, it: &Loop, object: ObjectId) -> Option<Span> {
        /// So many statements are looked at.
        const FAR: u32 = 64;
        let model = self.model;
        let own = model.object(object);
        let start = model.statements.get(it.body.start as usize)?;
        // Labels between are where control may come from elsewhere; that of the loop itself is none of them. They stand in the
        // order of their statements.
        let labels = |at: u32| {
            let before = |end: u32| model.labels.partition_point(|label| label.statement < end);
            before(at + 1) - before(at)
        };
        if labels(it.body.start) > usize::from(it.kind == LoopKind::Jump) {
            return None;
        }
        for at in (it.body.start.saturating_sub(FAR)..it.body.start).rev() {
            let statement: &Statement = model.statements.get(at as usize)?;
            let is_outside = statement.in_loop != it.parent;
            let is_call = matches!(statement.kind, StatementKind::Call(_));
            if is_outside || is_call && calls_code(model, &Loop { body: at..at + 1, ..it.clone() }) {
                return None;
            }
            let from = model.accesses.partition_point(|it| it.statement < at);
            let accesses = model.accesses.get(from..)?.iter().take_while(|it| it.statement == at);
            for access in accesses.filter(|it| it.mode.writes() || matches!(it.mode, Mode::Drive(_))) {
                let other = model.object(access.object);
                let is_same = access.object == object && access.mode == Mode::Store;
                if is_same && let StatementKind::Store { value, .. } = statement.kind {
                    // An opaque condition stands for a label that jumps lead back to: this one's loop is behind it.
                    let is_sure = self.comes_by(start.path, statement.path);
                    return self.ranges.of(value, at, statement.path).map(|it| it.span).filter(|_| is_sure);
                }
                let is_apart = other.footprint.area != own.footprint.area
                    || other.is_fixed() && !other.footprint.overlaps(&own.footprint);
                if !is_apart {
                    return None;
                }
            }
            if labels(at) > 0 {
                return None;
            }
        }
        None
    }
}

/// A loop that takes long.
#[derive(Debug)]
pub struct Costly<'a> {
    pub unit: u32,
    pub it: &'a FactLoop,
    pub turns: u64,
    /// Operations of all turns.
    pub operations: u64,
    /// Loops in it, with how often each runs in one turn of the loop around it.
    pub inner: Vec<(u32, u64)>,
}

/// What the loops of a program cost, with the blocks that they call.
pub struct LoopCosts<'p, 'a> {
    program: &'p ProgramIndex<'a>,
    units: FxHashMap<u32, u64>,
}

impl<'p, 'a> LoopCosts<'p, 'a> {
    pub fn new(program: &'p ProgramIndex<'a>) -> Self {
        Self { program, units: FxHashMap::default() }
    }

    /// The loops that take more operations than a unit may, without those around them.
    pub fn above(&mut self, most: impl Fn(u32) -> u64) -> Vec<Costly<'a>> {
        let program = self.program;
        let mut found = Vec::new();
        for (unit, &facts) in (0..).zip(&program.units) {
            if facts.loops.iter().all(|it| it.turns.is_none()) {
                continue;
            }
            let (totals, most) = (self.totals(unit, 0), most(unit));
            if totals.iter().all(|it| *it <= most) {
                continue;
            }
            for (at, (it, &operations)) in (0..).zip(facts.loops.iter().zip(&totals)) {
                let Some(turns) = it.turns else { continue };
                // What stands in a loop comes right behind it.
                let behind = facts.loops.iter().zip(&totals).skip(at as usize + 1);
                let within = behind.take_while(|it| it.0.parent.is_some_and(|parent| parent >= at));
                let inner: Vec<_> = within.filter(|it| it.0.parent == Some(at)).collect();
                let of_inner = inner.iter().any(|it| *it.1 > most);
                let of_called = it.calls.iter().any(|call| {
                    let called = program.target_of(unit, *call);
                    called.is_some_and(|it| self.units.get(&it).is_some_and(|it| *it > most))
                });
                if operations > most && !of_inner && !of_called {
                    let inner = inner.into_iter().filter_map(|(it, _)| Some((it.anchor, it.turns?))).collect();
                    found.push(Costly { unit, it, turns, operations, inner });
                }
            }
        }
        found
    }

    /// Operations of each loop of a unit, with all its turns. A loop of which nothing is known is run once.
    fn totals(&mut self, unit: u32, depth: u32) -> Vec<u64> {
        let Some(&facts) = self.program.units.get(unit as usize) else { return Vec::new() };
        let mut totals: Vec<u64> = vec![0; facts.loops.len()];
        for (at, it) in facts.loops.iter().enumerate().rev() {
            let called = it.calls.iter().map(|call| self.called(unit, *call, depth));
            let turn = called.fold(it.operations.saturating_add(totals[at]), u64::saturating_add);
            totals[at] = turn.saturating_mul(it.turns.unwrap_or(1));
            if let Some(outer) = it.parent.and_then(|outer| totals.get(outer as usize)).copied() {
                let sum = outer.saturating_add(totals[at]);
                if let Some(slot) = it.parent.and_then(|outer| totals.get_mut(outer as usize)) {
                    *slot = sum;
                }
            }
        }
        totals
    }

    /// Operations of the unit that a call leads to.
    fn called(&mut self, unit: u32, call: u32, depth: u32) -> u64 {
        /// Calls in one another that are followed.
        const DEEPEST: u32 = 16;
        let Some(target) = self.program.target_of(unit, call) else { return 0 };
        if let Some(&known) = self.units.get(&target) {
            return known;
        }
        let Some(&facts) = self.program.units.get(target as usize) else { return 0 };
        // What calls itself is not followed again.
        self.units.insert(target, 0);
        let mut sum = facts.uses.len() as u64;
        if depth < DEEPEST {
            let totals = self.totals(target, depth + 1);
            for (it, total) in facts.loops.iter().zip(totals).filter(|it| it.0.parent.is_none()) {
                sum = sum.saturating_sub(it.operations).saturating_add(total);
            }
            let in_loops: FxHashSet<u32> = facts.loops.iter().flat_map(|it| it.calls.iter().copied()).collect();
            for call in (0..u32::try_from(facts.calls.len()).unwrap_or(0)).filter(|it| !in_loops.contains(it)) {
                sum = sum.saturating_add(self.called(target, call, depth + 1));
            }
        }
        self.units.insert(target, sum);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower;
    use crate::syntax::{self, Language, Mnemonics};

    fn model(text: &str, language: Language) -> UnitModel {
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = match language {
            Language::Pl7St => Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main },
            _ => Entity::Listing,
        };
        lower::lower(parse.syntax(), text, entity, language)
    }

    fn st(text: &str) -> Vec<Option<u64>> {
        loops(&Ranges::new(&model(text, Language::Pl7St))).iter().map(|it| it.turns).collect()
    }

    fn awl(text: &str) -> Vec<Option<u64>> {
        loops(&Ranges::new(&model(text, Language::Awl(Mnemonics::German)))).iter().map(|it| it.turns).collect()
    }

    #[test]
    fn loops_that_count_by_themselves() {
        assert_eq!(st("! FOR %MW0 := 0 TO 9 DO INC %MW1; END_FOR;"), [Some(10)]);
        assert_eq!(st("! FOR %MW0 := 5 TO 4 DO INC %MW1; END_FOR;"), [Some(0)]);
        assert_eq!(st("! FOR %MW0 := 0 TO %MW5 DO INC %MW1; END_FOR;"), [None]);
        assert_eq!(st("! FOR %MW0 := 0 TO 9 DO INC %MW0; END_FOR;"), [None]);
        assert_eq!(st("! IF %MW5 < 8 THEN FOR %MW0 := 1 TO %MW5 DO INC %MW1; END_FOR; END_IF;"), [Some(7)]);
        assert_eq!(
            st("! FOR %MW0 := 1 TO 3 DO FOR %MW1 := 1 TO %MW0 DO INC %MW2; END_FOR; END_FOR;"),
            [Some(3), Some(3)]
        );
    }

    #[test]
    fn loops_with_a_counter() {
        let counts = |first: &str, text: &str| st(&format!("! {first} {text}"));
        let up = "WHILE %MW0 < 10 DO INC %MW0; END_WHILE;";
        assert_eq!(counts("%MW0 := 0;", up), [Some(10)]);
        assert_eq!(counts("%MW0 := 0; %MW1 := 3;", up), [Some(10)]);
        assert_eq!(counts("%MW0 := 10;", up), [Some(0)]);
        for first in ["", "%MW0 := 0; SR1;", "%MW0 := %MW1;", "IF %M0 THEN %MW0 := 0; END_IF;", "%MW0 := 0; %MD0 := 1;"]
        {
            assert_eq!(counts(first, up), [None], "{first}");
        }
        assert_eq!(st("! %MW0 := 0; %L10: WHILE %MW0 < 10 DO INC %MW0; END_WHILE;"), [None]);
        let body = |it: &str| counts("%MW0 := 0;", &format!("WHILE %MW0 <= 10 DO {it} END_WHILE;"));
        assert_eq!(body("%MW0 := 3 + %MW0;"), [Some(4)]);
        assert_eq!(body("%MW0 := %MW0 - 1;"), [None]);
        assert_eq!(body("IF %M0 THEN INC %MW0; END_IF;"), [None]);
        assert_eq!(body("INC %MW0; %MW0 := 5;"), [None]);
        assert_eq!(body("INC %MW0; SR1;"), [None]);
        assert_eq!(body("INC %MW0; %MW0[%MW4] := 0;"), [None]);
        assert_eq!(counts("%MW0 := 9;", "REPEAT DEC %MW0; UNTIL %MW0 <= 0 OR %M0 END_REPEAT;"), [Some(9)]);
        assert_eq!(counts("%MW0 := 0;", "REPEAT INC %MW0; UNTIL %MW0 = 7 END_REPEAT;"), [Some(7)]);
        assert_eq!(counts("%MW0 := 0;", "REPEAT INC %MW0; UNTIL %MW0 = -7 END_REPEAT;"), [None]);
        assert_eq!(counts("%MW0 := 0;", "REPEAT %MW0 := %MW0 + 0; UNTIL %MW0 = 7 END_REPEAT;"), [None]);
        assert_eq!(counts("%MW0 := 0;", "WHILE %MW0 < 7 DO %MW0 := %MW0 + 9; END_WHILE;"), [Some(1)]);
        assert_eq!(st("! %MW0 := 0; ! %L10: INC %MW0; ! IF %MW0 < 5 THEN JUMP %L10; END_IF;"), [Some(5)]);
        assert_eq!(
            st("! IF %M0 THEN JUMP %L10; END_IF; ! %MW0 := 0; ! %L10: INC %MW0; ! IF %MW0 < 5 THEN JUMP %L10; END_IF;"),
            [None]
        );
    }

    #[test]
    fn loops_of_statement_lists() {
        let body =
            |first: &str, place: &str| awl(&format!("{first}\nM1: T {place}\nU E 0.0\n= A 4.0\nL {place}\nLOOP M1\n"));
        assert_eq!(body("L 10", "MW 10"), [Some(10)]);
        assert_eq!(body("L 10", "MB 10"), [Some(10)]);
        assert_eq!(body("L 0", "MW 10"), [Some(65_536)]);
        assert_eq!(body("L 300", "MB 10"), [None]);
        assert_eq!(body("L -1", "MW 10"), [None]);
        assert_eq!(body("L MW 20", "MW 10"), [None]);
        assert_eq!(awl("L 10\nSPA M2\nM1: L MW 4\nM2: T MW 10\nL MW 10\nLOOP M1\n"), [None]);
        // Another count, a call that may write it, and one that may not.
        assert_eq!(awl("L 10\nM1: T MW 10\nL MW 12\nT MW 10\nL MW 10\nLOOP M1\n"), [None]);
        assert_eq!(awl("L 10\nM1: T MW 10\nL MW 12\nLOOP M1\n"), [None]);
        assert_eq!(awl("L 10\nM1: T MW 10\nUC FC 1\nL MW 10\nLOOP M1\n"), [None]);
        assert_eq!(awl("L 10\nM1: T LW 10\nUC FC 1\nL LW 10\nLOOP M1\n"), [Some(10)]);
        let nested = "L 10\nM1: T MW 10\nL 20\nM2: T MW 12\nL MW 12\nLOOP M2\nL MW 10\nLOOP M1\n";
        assert_eq!(awl(nested), [Some(10), Some(20)]);
        let counted = "L 0\nT MW 10\nM1: L MW 10\nL 1\n+I\nT MW 10\nL MW 10\nL 100\n<I\nSPB M1\n";
        assert_eq!(awl(counted), [Some(100)]);
    }

    #[test]
    fn what_a_turn_does() {
        let text =
            "! FOR %MW0 := 0 TO 9 DO %MW1 := %MW2; FOR %MW3 := 0 TO 9 DO %MW4 := %MW5; SR1; END_FOR; SR2; END_FOR;";
        let found = loops(&Ranges::new(&model(text, Language::Pl7St)));
        let [outer, inner] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!((outer.parent, inner.parent), (None, Some(0)));
        assert_eq!((outer.calls.as_slice(), inner.calls.as_slice()), (&[1][..], &[0][..]));
        // The index, a store with its two operands, and the call; around it, also the first value of the inner index.
        assert_eq!((inner.operations, outer.operations), (5, 7));
    }
}

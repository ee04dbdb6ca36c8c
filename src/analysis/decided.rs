//! Conditions of a unit that are always true, or never, where the program asks them.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use super::conditions::{Lessons, Space, Verdict};
use super::known::Known;
use crate::model::UnitModel;
use crate::model::expr::{ExprId, Exprs};
use crate::model::unit::{Fork, Statement, StatementKind};

/// A condition that has one value alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decided {
    /// Index of its statement.
    pub statement: u32,
    pub range: TextRange,
    pub value: bool,
    pub because: Because,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Because {
    /// Of what it says.
    Itself,
    /// Of a constant that was stored at this place before.
    Stored(TextRange),
    /// Of the conditions under which control comes to it.
    Path,
}

/// The conditions that are judged by themselves: what they cut off has its cause there.
pub fn judged(model: &UnitModel) -> Vec<TextRange> {
    let place = |at: u32| model.statements.get(at as usize).map(|it| it.range);
    let repeated = repeated(model).into_iter().filter_map(|it| place(it.0));
    decided(model).iter().map(|it| it.range).chain(repeated).collect()
}

/// What a statement asks, if it is a condition on which the run of the unit, or of an action, depends.
fn asked(model: &UnitModel, statement: &Statement) -> Option<ExprId> {
    match statement.kind {
        // A block acts on 0 as well.
        StatementKind::Branch { of: Fork::Receptivity, .. } | StatementKind::Drive { .. } => None,
        _ => model.condition(statement),
    }
}

/// Whether something is acted on, which is done unconditionally on purpose.
fn acts(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::Call(_) | StatementKind::Set { .. } | StatementKind::Reset { .. })
}

/// The conditions of branches, jumps, returns, calls, sets and resets. A constant that is written as such is none; of a chain
/// of arms, one that asks what an arm before it asks is left to [`repeated`].
pub fn decided(model: &UnitModel) -> Vec<Decided> {
    let known = Known::new(model);
    let lessons = Lessons::default();
    let space = Space::of(model).learning(&lessons);
    let mut paths = Paths::default();
    // What a condition tests, its statement reads, also where its form alone made it a constant.
    let mut reads = model.accesses.iter().filter(|it| it.mode.reads()).map(|it| it.statement).peekable();
    let mut found = Vec::new();
    for (at, statement) in (0..).zip(&model.statements) {
        // Accesses stand in the order of their statements.
        while reads.next_if(|it| *it < at).is_some() {}
        let tests = reads.peek() == Some(&at);
        let Some(condition) = asked(model, statement) else { continue };
        let is_branch = matches!(statement.kind, StatementKind::Branch { .. });
        let is_written = match condition {
            Exprs::TRUE => !is_branch || !tests,
            Exprs::FALSE => !tests,
            _ => false,
        };
        if is_written || paths.is_closed(&space, statement.path) {
            continue;
        }
        let decided = |because, value: bool| {
            let it = Decided { statement: at, range: statement.range, value, because };
            (!value || !acts(statement)).then_some(it)
        };
        if let Some(value) = space.constant(Exprs::TRUE, condition) {
            found.extend(decided(Because::Itself, value));
            continue;
        }
        let stored = stored(model, &known, condition, statement.path);
        let values: Vec<(ExprId, i64)> = stored.iter().map(|it| (it.0, it.1)).collect();
        let with_stored = space.knowing(&values);
        if let Some(&(.., anchor)) = stored.first()
            && let Some(value) = with_stored.constant(Exprs::TRUE, condition)
        {
            found.extend(decided(Because::Stored(model.place(anchor)), value));
        } else if statement.path != Exprs::TRUE
            && paths.is_short(&space, statement.path)
            && let Some(value) = space.constant(statement.path, condition)
            && repeated_arm(model, &space, at).is_none()
        {
            found.extend(decided(Because::Path, value));
        }
    }
    found
}

/// Reads of a condition that are known to give a constant: the value, and the place that stores it.
fn stored(model: &UnitModel, known: &Known<'_>, condition: ExprId, path: ExprId) -> Vec<(ExprId, i64, u32)> {
    let mut found = Vec::new();
    if known.is_empty() {
        return found;
    }
    model.exprs.each_read(condition, |read| {
        if let Some(it) = known.value(read, path)
            && let Some(anchor) = it.stored
        {
            found.push((read, it.value, anchor));
        }
    });
    found
}

/// Arms of one `IF` that ask what an arm before them asks: the statements of the later and of the earlier one.
pub fn repeated(model: &UnitModel) -> Vec<(u32, u32)> {
    let lessons = Lessons::default();
    let space = Space::of(model).learning(&lessons);
    let arms = (0..).zip(&model.statements).filter(|it| before(it.1).is_some());
    arms.filter_map(|(at, _)| Some((at, repeated_arm(model, &space, at)?))).collect()
}

fn before(statement: &Statement) -> Option<u32> {
    match statement.kind {
        StatementKind::Branch { of: Fork::Arm { after }, .. } => after,
        _ => None,
    }
}

/// The first arm of an `IF` that asks the same as a later one.
fn repeated_arm(model: &UnitModel, space: &Space<'_>, arm: u32) -> Option<u32> {
    /// An arm is compared with so many before it.
    const MOST: usize = 64;
    let of = |at: u32| model.statements.get(at as usize);
    let condition = asked(model, of(arm)?)?;
    if matches!(condition, Exprs::TRUE | Exprs::FALSE) {
        return None;
    }
    let chain = std::iter::successors(before(of(arm)?), |at| before(of(*at)?)).take(MOST);
    let is_same = |at: &u32| {
        of(*at).and_then(|it| asked(model, it)).is_some_and(|it| it == condition || space.equivalent(it, condition))
    };
    chain.filter(is_same).last()
}

/// The statements that no values of objects let control come to, though their paths are not FALSE by form: the first and
/// the last of each stretch.
pub fn unreached(model: &UnitModel) -> Vec<(u32, u32)> {
    let lessons = Lessons::default();
    let space = Space::of(model).learning(&lessons);
    let mut paths = Paths::default();
    let mut found: Vec<(u32, u32)> = Vec::new();
    for (at, statement) in (0..).zip(&model.statements) {
        if statement.path == Exprs::FALSE || !paths.is_closed(&space, statement.path) {
            continue;
        }
        match found.last_mut().filter(|it| it.1 + 1 == at) {
            Some(stretch) => stretch.1 = at,
            None => found.push((at, at)),
        }
    }
    found
}

/// Which paths nothing takes. Most statements share theirs.
#[derive(Default)]
struct Paths {
    closed: FxHashMap<ExprId, bool>,
    short: FxHashMap<ExprId, bool>,
}

impl Paths {
    fn is_closed(&mut self, space: &Space<'_>, path: ExprId) -> bool {
        if path == Exprs::TRUE || path == Exprs::FALSE {
            return path == Exprs::FALSE;
        }
        if !self.is_short(space, path) {
            return false;
        }
        *self.closed.entry(path).or_insert_with(|| space.together(&[path]) == Verdict::Never)
    }

    /// Whether a path is looked into: each jump that control may pass makes that of the next one longer.
    fn is_short(&mut self, space: &Space<'_>, path: ExprId) -> bool {
        const LONGEST: usize = 128;
        *self.short.entry(path).or_insert_with(|| space.exprs.is_within(path, LONGEST))
    }
}

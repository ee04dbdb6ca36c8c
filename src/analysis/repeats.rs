//! Code that stands several times in a program, with the same operands or with others.
//!
//! A unit tells the form of each statement apart from what it works on ([`Forms`]): two stretches are copies when their
//! forms are equal one by one, and the operands of one take the place of those of the other one to one. Objects, constants,
//! labels and the conditions under which control comes to a statement count as operands alike.
//!
//! Stretches of [`SHORTEST`] statements are looked up by a hash of their forms and of how far back each operand stood before;
//! what is found grows as far as its copies go along. Operands can be renamed one to one exactly where those distances,
//! within the stretches, are equal (B. Baker, Parameterized Duplication in Strings, 1997).

use std::hash::{BuildHasher as _, Hash, Hasher as _};

use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet, FxHasher};

use super::Site;
use super::program::ProgramIndex;
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::object::{Class, Type};
use crate::model::unit::{Access, StatementKind};

/// The statements of a unit, without places and names.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Forms {
    items: Vec<Item>,
    operands: Vec<Operand>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Item {
    /// Of all but the operands; `None` for a statement too large to compare.
    form: Option<u64>,
    /// End of its operands, which begin where those of the item before end.
    end: u32,
    anchor: Option<u32>,
    /// It writes no more than a bit of local data by its address, as the ladder editor does for the operands of a call.
    is_aside: bool,
}

/// What may be another thing in a copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Operand {
    hash: u64,
    role: Role,
    /// How many operands of the unit back the last one is that is the same; more than there are where none is.
    back: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Role {
    Object,
    /// A constant.
    Value,
    /// What each place has for itself: a label, the condition under which control is there, a value that is not known.
    Own,
}

/// A statement of more expressions is not compared.
const LARGEST: usize = 256;

impl Forms {
    pub fn new(model: &UnitModel) -> Self {
        let mut forms = Self::default();
        let (mut last, mut seen) = (FxHashMap::default(), Vec::new());
        let mut labels = model.labels.iter().peekable();
        let mut accesses = model.accesses.iter().peekable();
        for (at, statement) in (0..).zip(&model.statements) {
            let mut own: Vec<&Access> = Vec::new();
            while let Some(it) = accesses.next_if(|it| it.statement <= at) {
                own.push(it);
            }
            seen.clear();
            let hasher = FxHasher::default();
            let mut form = Form { model, forms: &mut forms, last: &mut last, hasher, seen: &mut seen };
            while let Some(it) = labels.next_if(|it| it.statement <= at) {
                form.operand(&it.name, Role::Own);
                "label".hash(&mut form.hasher);
            }
            let anchor = form.statement(&statement.kind, &own);
            form.path(statement.path);
            let hash = (form.seen.len() <= LARGEST).then(|| form.hasher.finish());
            let end = u32::try_from(forms.operands.len()).unwrap_or(u32::MAX);
            let anchor = anchor.or_else(|| own.first().map(|it| it.anchor));
            let is_aside = match statement.kind {
                StatementKind::Assign { access, .. } => model.accesses.get(access as usize).is_some_and(|it| {
                    let object = model.object(it.object);
                    object.class == Class::LocalData && object.ty == Type::Bool
                }),
                _ => false,
            };
            forms.items.push(Item { form: hash, end, anchor, is_aside });
        }
        forms
    }
}

struct Form<'a> {
    model: &'a UnitModel,
    forms: &'a mut Forms,
    /// How many operands stand before the last one that is the same.
    last: &'a mut FxHashMap<u64, u32>,
    hasher: FxHasher,
    /// Expressions written so far, few as they are.
    seen: &'a mut Vec<ExprId>,
}

impl Form<'_> {
    fn operand(&mut self, it: impl Hash, role: Role) {
        let hash = FxBuildHasher.hash_one((role, it));
        let count = u32::try_from(self.forms.operands.len()).unwrap_or(u32::MAX);
        let back = self.last.insert(hash, count).map_or(u32::MAX, |it| count - it);
        self.forms.operands.push(Operand { hash, role, back });
    }

    fn object(&mut self, id: ObjectId) {
        let object = self.model.object(id);
        // Which of several data blocks is open is not told by the address.
        ("object", object.ty, object.indexed, object.extracted).hash(&mut self.hasher);
        let is_block = object.ty == Type::Block;
        is_block.then_some(object.class).hash(&mut self.hasher);
        self.operand((&object.footprint, object.ty), Role::Object);
    }

    fn statement(&mut self, kind: &StatementKind, own: &[&Access]) -> Option<u32> {
        std::mem::discriminant(kind).hash(&mut self.hasher);
        let model = self.model;
        match *kind {
            StatementKind::Assign { access, value: it }
            | StatementKind::Store { access, value: it }
            | StatementKind::Set { access, when: it }
            | StatementKind::Reset { access, when: it } => {
                self.expr(it);
                self.access(access)
            }
            StatementKind::Drive { access, pin, when, value } => {
                pin.hash(&mut self.hasher);
                self.expr(when);
                if let Some(it) = value {
                    self.expr(it);
                }
                self.access(access)
            }
            StatementKind::Call(at) => {
                let call = model.calls.get(at as usize)?;
                call.callee.hash(&mut self.hasher);
                self.expr(call.when);
                for it in own {
                    it.mode.hash(&mut self.hasher);
                    self.object(it.object);
                }
                Some(call.anchor)
            }
            StatementKind::Jump(at) => {
                let jump = model.jumps.get(at as usize)?;
                self.expr(jump.when);
                self.operand(&jump.label, Role::Own);
                Some(jump.anchor)
            }
            StatementKind::Return { when, how } => {
                how.hash(&mut self.hasher);
                self.expr(when);
                None
            }
            StatementKind::Branch { condition, .. } => {
                self.expr(condition);
                None
            }
            StatementKind::Halt | StatementKind::Exit | StatementKind::Open | StatementKind::Other => None,
        }
    }

    fn access(&mut self, at: u32) -> Option<u32> {
        let access = self.model.accesses.get(at as usize)?;
        access.mode.hash(&mut self.hasher);
        self.object(access.object);
        Some(access.anchor)
    }

    fn path(&mut self, path: ExprId) {
        let is_certain = path == Exprs::TRUE;
        is_certain.hash(&mut self.hasher);
        if !is_certain {
            self.operand(path, Role::Own);
        }
    }

    /// Operands before what they are operands of, each once.
    fn expr(&mut self, id: ExprId) {
        enum Visit {
            Enter(ExprId),
            Leave(ExprId),
        }
        let mut open = vec![Visit::Enter(id)];
        while let Some(it) = open.pop() {
            match it {
                Visit::Enter(id) => match self.seen.iter().position(|it| *it == id) {
                    Some(number) => ("again", number).hash(&mut self.hasher),
                    None if self.seen.len() > LARGEST => return,
                    None => {
                        open.push(Visit::Leave(id));
                        let from = open.len();
                        self.model.exprs.each_operand(id, |it| open.push(Visit::Enter(it)));
                        open[from..].reverse();
                    }
                },
                Visit::Leave(id) => {
                    if !self.seen.contains(&id) {
                        self.seen.push(id);
                        self.node(id);
                    }
                }
            }
        }
    }

    fn node(&mut self, id: ExprId) {
        let node = self.model.exprs.get(id);
        std::mem::discriminant(node).hash(&mut self.hasher);
        match node {
            Expr::Bool(it) => it.hash(&mut self.hasher),
            Expr::Int(it) => self.operand(it, Role::Value),
            Expr::Float(it) => self.operand(it, Role::Value),
            Expr::Text(it) => self.operand(it, Role::Value),
            Expr::Opaque(it) => self.operand(it, Role::Own),
            Expr::Read { object, .. } => self.object(*object),
            Expr::Edge { object, rising, .. } => {
                rising.hash(&mut self.hasher);
                self.object(*object);
            }
            Expr::Compare(op, ..) => op.hash(&mut self.hasher),
            Expr::Binary(op, ..) => op.hash(&mut self.hasher),
            Expr::Call(name, list) => (name, list.len()).hash(&mut self.hasher),
            Expr::Not(_) | Expr::And(..) | Expr::Or(..) | Expr::Xor(..) | Expr::Negate(_) => {}
        }
    }
}

/// A stretch of statements with its copies.
#[derive(Debug, PartialEq, Eq)]
pub struct Repeat {
    /// Number of statements.
    pub length: usize,
    /// The first place of each copy, in the order of the units and of their code.
    pub places: Vec<Site>,
    /// Whether all work on the same operands.
    pub identical: bool,
}

/// The shortest stretch that is looked for.
pub const SHORTEST: usize = 3;

/// So many copies of one stretch are told, out of so many places, and a stretch has at most so many statements.
const MOST_COPIES: usize = 64;
const MOST_LOOKED_AT: usize = 8 * MOST_COPIES;
const LONGEST: usize = 2000;

/// What stands several times in a program, if its copies are `saved` statements more than one stretch of it.
pub fn repeats(program: &ProgramIndex<'_>, saved: usize) -> Vec<Repeat> {
    let all = All::new((0..).zip(&program.units).filter_map(|(unit, it)| Some((unit, it.forms.as_deref()?))));
    let mut copies: FxHashMap<u64, Vec<usize>> = FxHashMap::default();
    let mut keys = Vec::with_capacity(all.items.len());
    for at in 0..all.items.len() {
        let key = all.key(at);
        keys.push(key);
        if let Some(key) = key {
            copies.entry(key).or_default().push(at);
        }
    }
    let mut covered = vec![false; all.items.len()];
    let mut found = Vec::new();
    for (at, key) in keys.into_iter().enumerate() {
        let Some(list) = key.and_then(|it| copies.get(&it)).filter(|it| it.len() > 1) else { continue };
        if covered[at] {
            continue;
        }
        let from = list.partition_point(|&it| it <= at);
        let mut others: Vec<usize> = Vec::new();
        for &it in list[from..].iter().take(MOST_LOOKED_AT) {
            let before = others.last().copied().unwrap_or(at);
            if it >= before + SHORTEST && !covered[it..it + SHORTEST].contains(&true) {
                others.push(it);
            }
            if others.len() >= MOST_COPIES {
                break;
            }
        }
        let Some((length, mut places)) = all.grow(at, &others, &covered, saved) else { continue };
        places.insert(0, at);
        for &it in &places {
            covered[it..it + length].fill(true);
        }
        let identical = places.iter().all(|&it| all.works_on(at, length).eq(all.works_on(it, length)));
        let places = places.into_iter().filter_map(|it| all.site(it, length)).collect();
        found.push(Repeat { length, places, identical });
    }
    found.retain(|it| it.places.len() > 1);
    found
}

/// The statements of all units, one after the other.
struct All<'a> {
    /// Unit and statement.
    items: Vec<(u32, &'a Item)>,
    /// Where the operands of each end; they begin where those of the one before end.
    ends: Vec<usize>,
    operands: Vec<Operand>,
}

impl<'a> All<'a> {
    fn new(units: impl Iterator<Item = (u32, &'a Forms)>) -> Self {
        let mut all = Self { items: Vec::new(), ends: Vec::new(), operands: Vec::new() };
        for (unit, forms) in units {
            let before = all.operands.len();
            all.items.extend(forms.items.iter().map(|it| (unit, it)));
            all.ends.extend(forms.items.iter().map(|it| before + it.end as usize));
            all.operands.extend(&forms.operands);
        }
        all
    }

    fn form(&self, at: usize) -> Option<u64> {
        self.items.get(at)?.1.form
    }

    fn unit(&self, at: usize) -> Option<u32> {
        self.items.get(at).map(|it| it.0)
    }

    fn is_aside(&self, at: usize) -> bool {
        self.items.get(at).is_some_and(|it| it.1.is_aside)
    }

    fn operands(&self, at: usize, length: usize) -> &[Operand] {
        let end = self.ends.get(at + length - 1).copied().unwrap_or_default();
        self.operands.get(self.first_operand(at)..end).unwrap_or_default()
    }

    fn first_operand(&self, at: usize) -> usize {
        at.checked_sub(1).and_then(|it| self.ends.get(it)).copied().unwrap_or_default()
    }

    /// Of the operands of a statement of the stretch that begins at `start`, how far back each stood before in it; 0 where it
    /// did not.
    #[inline]
    fn distances(&self, start: usize, at: usize, length: usize) -> impl ExactSizeIterator<Item = u32> {
        // As many as the unit has, which is below 4 GiB.
        let mut from = (self.first_operand(at) - self.first_operand(start)) as u32;
        self.operands(at, length).iter().map(move |it| {
            let distance = if it.back > from { 0 } else { it.back };
            from += 1;
            distance
        })
    }

    /// The operands that copies can share.
    fn works_on(&self, at: usize, length: usize) -> impl Iterator<Item = u64> {
        self.operands(at, length).iter().filter(|it| it.role != Role::Own).map(|it| it.hash)
    }

    fn site(&self, at: usize, length: usize) -> Option<Site> {
        let statements = self.items.get(at..at + length)?;
        statements.iter().find_map(|&(unit, it)| Some(Site { unit, anchor: it.anchor? }))
    }

    /// Equal for stretches of the shortest length that are copies.
    fn key(&self, at: usize) -> Option<u64> {
        let mut hasher = FxHasher::default();
        for it in at..at + SHORTEST {
            (self.form(it)?, self.unit(it)? == self.unit(at)?).hash(&mut hasher);
        }
        if self.unit(at) != self.unit(at + SHORTEST - 1) {
            return None;
        }
        self.distances(at, at, SHORTEST).for_each(|it| it.hash(&mut hasher));
        Some(hasher.finish())
    }

    /// The length and the copies of the stretch at a place that save most.
    fn grow(&self, at: usize, others: &[usize], covered: &[bool], saved: usize) -> Option<(usize, Vec<usize>)> {
        let mut alive = others.to_vec();
        let mut linked = Linked::default();
        let mut best: Option<(usize, usize, Vec<usize>)> = None;
        let mut distances: Vec<u32> = Vec::new();
        for length in 1..=LONGEST {
            let last = at + length - 1;
            if self.unit(last) != self.unit(at) || covered.get(last).is_none_or(|it| *it) {
                break;
            }
            let Some(form) = self.form(last) else { break };
            distances.clear();
            distances.extend(self.distances(at, last, 1));
            let mut end = at + length;
            alive.retain(|&other| {
                let there = other + length - 1;
                let goes_on = end <= other
                    && self.unit(there) == self.unit(other)
                    && covered.get(there).is_some_and(|it| !it)
                    && self.form(there) == Some(form)
                    && is_same(&distances, self.distances(other, there, 1));
                if goes_on {
                    end = other + length;
                }
                goes_on
            });
            let Some(first) = alive.first() else { break };
            let copies = self.operands(first + length - 1, 1).iter();
            let copied = self.operands(last, 1).iter().zip(copies);
            if !linked.extend(copied, self.is_aside(last)) {
                break;
            }
            let saves = alive.len() * linked.acting;
            if linked.acting >= SHORTEST && saves >= saved && best.as_ref().is_none_or(|it| it.0 <= saves) {
                best = Some((saves, length, alive.clone()));
            }
        }
        best.map(|(_, length, copies)| (length, copies))
    }
}

fn is_same(list: &[u32], other: impl ExactSizeIterator<Item = u32>) -> bool {
    list.len() == other.len() && list.iter().zip(other).all(|(a, b)| *a == b)
}

/// Whether the statements belong together: each works on something that one before it works on. What is the same in all
/// copies, as the bit of an operating mode is, binds nothing, unless everything is.
#[derive(Default)]
struct Linked {
    renamed: FxHashSet<u64>,
    same: FxHashSet<u64>,
    other_values: bool,
    /// Statements that work on objects and are counted.
    acting: usize,
}

impl Linked {
    /// By a statement with its operands, each before what stands for it in a copy.
    fn extend<'a>(&mut self, copied: impl Iterator<Item = (&'a Operand, &'a Operand)> + Clone, is_aside: bool) -> bool {
        let objects = || copied.clone().filter(|it| it.0.role == Role::Object).map(|(it, copy)| (it.hash, copy.hash));
        self.other_values |= copied.clone().any(|(it, copy)| it.role == Role::Value && it.hash != copy.hash);
        if objects().next().is_none() {
            // A jump or a branch alone has nothing to bind it.
            return true;
        }
        let all_same = self.renamed.is_empty() && !self.other_values;
        let is_first = self.renamed.is_empty() && self.same.is_empty();
        let is_linked =
            is_first || objects().any(|(it, _)| self.renamed.contains(&it) || all_same && self.same.contains(&it));
        for (it, copy) in objects() {
            let kept = if it == copy { &mut self.same } else { &mut self.renamed };
            kept.insert(it);
        }
        self.acting += usize::from(!is_aside);
        is_linked
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::analysis::facts::UnitFacts;
    use crate::model::entity::{Entity, Family};
    use crate::model::lower;
    use crate::syntax::{self, Language, Mnemonics};

    /// Of each repeat in listings: statements, places, and whether the operands are the same.
    fn found(listings: &[&str]) -> Vec<(usize, usize, bool)> {
        let language = Language::Awl(Mnemonics::German);
        let facts: Vec<UnitFacts> = listings
            .iter()
            .map(|text| {
                let parse = syntax::parse(language, text);
                assert_eq!(parse.errors(), [], "{text}");
                let model = lower::lower(parse.syntax(), text, Entity::Listing, language);
                UnitFacts { forms: Some(Box::new(Forms::new(&model))), ..UnitFacts::new(&model) }
            })
            .collect();
        let program = ProgramIndex::new(Family::Step7, facts.iter().collect());
        repeats(&program, 3).into_iter().map(|it| (it.length, it.places.len(), it.identical)).collect()
    }

    #[test]
    fn operands_that_are_the_same() {
        let code = |label: &str, word: u32| {
            format!(
                "U E 0.0\nSPBN {label}\nL MW 20\nL 1\n+I\nT MW 20\nL MW 20\nT MW {word}\nL MW {word}\nT MW 40\n\
                 {label}: NOP 0\n"
            )
        };
        let other = "U E 4.0\n= A 4.0\n";
        assert_eq!(found(&[&code("a1", 30), &(other.to_owned() + &code("b1", 30))]), [(3, 2, true)]);
        assert_eq!(found(&[&code("a1", 30), &(other.to_owned() + &code("b1", 32))]), [(3, 2, false)]);
    }

    #[test]
    fn operands_of_calls_do_not_count() {
        let calls = |memory: &str| {
            let call = format!("CALL FC 9 (IN := {memory}.0, STOP := {memory}.1)\n");
            format!("{call}U E 0.0\n= {memory}.0\nUN E 0.1\n= {memory}.1\n{call}")
        };
        assert_eq!(found(&[&calls("L 0"), &calls("L 2")]), []);
        assert_eq!(found(&[&calls("M 0"), &calls("M 2")]), [(4, 2, false)]);
    }

    proptest! {
        /// Operands can be renamed one to one exactly where their distances are equal.
        #[test]
        fn distances_say_what_can_be_renamed(names in prop::collection::vec(0..4_u64, 2..24), a in 0..24_usize, b in 0..24_usize) {
            let mut last: FxHashMap<u64, u32> = FxHashMap::default();
            let operands: Vec<Operand> = (1..)
                .zip(&names)
                .map(|(count, &hash)| {
                    let back = last.insert(hash, count).map_or(u32::MAX, |it| count - it);
                    Operand { hash, role: Role::Object, back }
                })
                .collect();
            let item = |end| Item { form: None, end, anchor: None, is_aside: false };
            let forms = Forms { items: (1..).take(names.len()).map(item).collect(), operands };
            let all = All::new([(0, &forms)].into_iter());
            let (a, b) = (a % names.len(), b % names.len());
            let length = names.len() - a.max(b);
            let (mut there, mut here) = (FxHashMap::default(), FxHashMap::default());
            let can_be_renamed = names[a..a + length].iter().zip(&names[b..b + length]).all(|(x, y)| {
                *there.entry(x).or_insert(y) == y && *here.entry(y).or_insert(x) == x
            });
            prop_assert_eq!(all.distances(a, a, length).eq(all.distances(b, b, length)), can_be_renamed);
        }
    }
}

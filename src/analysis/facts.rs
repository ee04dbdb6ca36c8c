//! What a unit tells the rest of its program: who uses which object how, who calls whom.
//!
//! **Invariant:** no position in it. Places are anchors, which number the places of a unit in order.

use std::hash::BuildHasher as _;

use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::apart::{self, Asking};
use super::chart::ChartFacts;
use super::conditions::{Lessons, Space, Verdict};
use super::cost::UnitCost;
use super::gaps;
use super::liveness::{self, Lost};
use super::ranges::Ranges;
use super::ranges::demands::{self, Demanded};
use super::repeats::Forms;
use super::sequences::code::CodeFacts;
use super::turns::{self, FactLoop};
use crate::model::UnitModel;
use crate::model::chart::CodeLanguage;
use crate::model::dfb::Interface;
use crate::model::entity::{BlockKind, BlockName, Entity, Part};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator};
use crate::model::layout::DataType;
use crate::model::object::{Area, Class, Object, Type};
use crate::model::unit::{Access, Actual, Argument, Call, Callee, Formal, Index, IndexKind, Mode, Pin, StatementKind};
use crate::syntax::Language;

/// One use of one object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Use {
    /// Index into [`UnitFacts::objects`].
    pub object: u32,
    pub mode: Mode,
    pub anchor: u32,
    /// For reads: the value may stem from another unit or scan.
    pub exposed: bool,
    /// For writes that take effect whenever they are reached: writes of one object with equal groups never happen in
    /// one scan, or the later is meant to override the earlier.
    pub group: u32,
    /// Whether control may pass the place by.
    pub conditional: bool,
    /// Number of the condition under which control reaches the place: equal numbers in a unit are equal conditions.
    pub path: u32,
    /// For an edge test: a run of the unit may make it without the unit's own write of the object.
    pub stale: bool,
    /// For a set: it waits for nothing but the bit's own 0, so that the bit is 1 for ever. For other writes: the object
    /// takes its own value, so that nothing changes.
    pub own: bool,
    /// For an assignment: its value depends on the object's own, as that of a circuit that holds itself does.
    pub holds: bool,
    /// For an assignment: its value is made of inputs, outputs and memory bits alone, so that no time ends it.
    pub of_bits: bool,
    /// Network or sentence.
    pub network: u32,
    /// Uses are what most of the memory of a program goes to, and few have any of it.
    detail: Option<Box<Detail>>,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Detail {
    skipped_by: Option<u32>,
    constant: Option<i64>,
    parameter: Option<(u32, Formal)>,
}

impl Detail {
    fn boxed(self) -> Option<Box<Self>> {
        (self != Self::default()).then(|| Box::new(self))
    }
}

impl Use {
    /// For an edge test or an input of a block: place of the jump that can skip it.
    pub fn skipped_by(&self) -> Option<u32> {
        self.detail.as_ref()?.skipped_by
    }

    /// For writes, and for a block that takes its preset: the constant that is written, when it is one.
    pub fn constant(&self) -> Option<i64> {
        self.detail.as_ref()?.constant
    }

    /// For an actual parameter: the call, an index into the unit's calls, and the formal parameter.
    pub fn parameter(&self) -> Option<&(u32, Formal)> {
        self.detail.as_ref()?.parameter.as_ref()
    }
}

/// An object of the unit with how its value is used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactObject {
    pub object: Object,
    /// The value is computed with: arithmetic or an order comparison reads it, or an arithmetic result is stored in it.
    pub number: bool,
    /// The unit writes it, or drives it, and some runs pass that by: number of the condition at the first such place.
    pub missed: Option<u32>,
    /// Of what makes it one object with those of other units, see [`Self::is_same`]. 0 for an object of the unit alone.
    pub hash: u64,
}

impl FactObject {
    pub(super) fn new(object: &Object, number: bool, missed: Option<u32>) -> Self {
        let key = (&object.footprint, object.ty, object.indexed);
        let hash = if is_shared(object) { FxBuildHasher.hash_one(key) } else { 0 };
        Self { object: object.clone(), number, missed, hash }
    }

    /// Whether two units name one object, whatever its spelling.
    pub fn is_same(&self, other: &Self) -> bool {
        let key = |it: &Self| (it.object.ty, it.object.indexed);
        self.hash == other.hash && key(self) == key(other) && self.object.footprint == other.object.footprint
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactCall {
    pub callee: Callee,
    /// As written.
    pub text: SmolStr,
    pub anchor: u32,
    pub conditional: bool,
    pub reachable: bool,
    pub instance: Option<BlockName>,
    /// Place of the instance.
    pub instance_anchor: Option<u32>,
    pub full: bool,
    /// What a block of STEP 7 is given; objects are indices into [`UnitFacts::objects`].
    pub arguments: Vec<Argument>,
    /// What an instance of a DFB is given; objects are indices into [`UnitFacts::objects`].
    pub actuals: Vec<Actual>,
    /// See [`Call::too_close`].
    pub too_close: Option<u32>,
}

/// A symbol that the unit declares for the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactSymbol {
    /// As written.
    pub name: SmolStr,
    /// `None` for an instance of a DFB.
    pub object: Option<Object>,
    /// As written, blanks removed: of an instance the DFB type.
    pub ty: SmolStr,
    /// Place of the name.
    pub anchor: u32,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnitFacts {
    pub entity: Entity,
    pub language: Language,
    pub objects: Vec<FactObject>,
    /// In execution order.
    pub uses: Vec<Use>,
    pub calls: Vec<FactCall>,
    /// What stands in the brackets of indexed objects, internal words left out; an object is one of `objects`.
    pub indexes: Vec<Index>,
    /// Pairs of calls, by index, the smaller first, that never run in the same scan. Sorted.
    pub exclusive_calls: Vec<(u32, u32)>,
    /// Pairs of uses, by anchor, the smaller first, that never take effect in the same scan: of a set, reset or edge
    /// memory with another write of its object. Sorted. [`Use::group`] says it of the other writes.
    pub exclusive_uses: Vec<(u32, u32)>,
    /// Conditions that ask for steps of charts, by the places that they lead to.
    pub asking: Option<Box<Asking>>,
    /// For a data block: the block that it is an instance of.
    pub instance_of: Option<BlockName>,
    /// Whether it opens another data block in place of its instance.
    pub opens_instance: bool,
    /// What a block of STEP 7 declares.
    pub declared: Option<Box<DataType>>,
    pub symbols: Vec<FactSymbol>,
    pub instructions: u32,
    /// Anchor of the first operation of PL7 that can overflow.
    pub computes: Option<u32>,
    /// Some place computed at run time is read (or written): any object may be.
    pub reads_indirectly: bool,
    pub writes_indirectly: bool,
    /// The unit, or some of it, was not understood: what seems to be missing may stand there.
    pub has_gaps: bool,
    /// The unit is part of something that is not there.
    pub is_fragment: bool,
    /// What the unit holds of a chart.
    pub chart: Option<Box<ChartFacts>>,
    /// The parameters and variables of a DFB type.
    pub interface: Option<Box<Interface>>,
    /// The bit under which the section runs that the unit belongs to, an index into `objects`. The section is passed by
    /// while it is 0.
    pub condition: Option<u32>,
    /// Whether a comment stands in the unit. Of the text around programs, whether one is said to be that of a program.
    pub commented: bool,
    /// Of a unit of PL7-2.
    pub cost: Option<Box<UnitCost>>,
    /// Indexes and divisors, with the ranges of their values.
    pub demands: Vec<Demanded>,
    pub loops: Vec<FactLoop>,
    /// Of Siemens blocks: what sequences are recovered from.
    pub code: Option<Box<CodeFacts>>,
    /// Writes whose value nothing in the unit reads.
    pub lost: Vec<Lost>,
    /// What its statements look like, for those who search for repetitions.
    pub forms: Option<Box<Forms>>,
}

/// In what facts of a unit are others than before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Difference {
    None,
    /// In what its code does to which objects, and where things stand.
    Uses,
    /// Besides, in what it is called, declares for its callers, or calls.
    Calls,
    Unknown,
}

/// More calls than this in a unit are not compared with one another.
const MAX_COMPARED: usize = 48;

/// The writes of one object in a unit are compared this many times; what is left counts as different places.
const MAX_COMPARISONS: u32 = 1000;

impl UnitFacts {
    /// The function block of an instance that the unit declares: `#motor`.
    pub fn type_of_instance(&self, name: &str) -> Option<&BlockName> {
        let name = name.trim_matches(['#', '"', ' ']).to_lowercase();
        let declared = self.declared.as_deref()?.fields().iter().find(|it| it.name == name)?;
        match &declared.ty {
            DataType::Named(block) => Some(block),
            _ => None,
        }
    }

    /// Whether a place is one of structured text.
    pub fn is_structured_text(&self, anchor: u32) -> bool {
        match self.chart.as_ref().filter(|_| self.language.is_chart()) {
            Some(chart) => chart.action_at(anchor).is_some_and(|it| it.language == Some(CodeLanguage::St)),
            None => self.language == Language::Pl7St,
        }
    }

    pub fn new(model: &UnitModel) -> Self {
        let numbers = numbers(model);
        let mut given = Given { values: vec![None; model.accesses.len()], whens: vec![None; model.accesses.len()] };
        let mut conditional_calls: FxHashSet<u32> = FxHashSet::default();
        let mut presets: FxHashMap<u32, ExprId> = FxHashMap::default();
        for (at, statement) in model.statements.iter().enumerate() {
            let at = u32::try_from(at).unwrap_or(u32::MAX);
            match statement.kind {
                StatementKind::Assign { access, value } | StatementKind::Store { access, value } => {
                    set(&mut given.values, access, value);
                }
                StatementKind::Drive { access, pin: Pin::Preset, when, value: Some(value) } => {
                    presets.insert(access, value);
                    set(&mut given.whens, access, when);
                }
                StatementKind::Set { access, when }
                | StatementKind::Reset { access, when }
                | StatementKind::Drive { access, when, .. } => {
                    set(&mut given.whens, access, when);
                }
                StatementKind::Call(call)
                    if model.calls.get(call as usize).is_some_and(|it| it.when != Exprs::TRUE) =>
                {
                    conditional_calls.insert(at);
                }
                _ => {}
            }
        }
        let lessons = Lessons::default();
        let space = Space::of(model).learning(&lessons);
        let groups = groups(model, space, &given);
        let writes = gaps::writes(model);
        let (skips, exits) = (gaps::skips(model), gaps::exits(model));
        let ranges = Ranges::new(model);
        let uses = model
            .accesses
            .iter()
            .enumerate()
            .map(|(at, access)| {
                let (value, when) = (given.values[at], given.whens[at]);
                let statement = model.statement(access);
                let by_call = conditional_calls.contains(&access.statement);
                let called = match statement.map(|it| &it.kind) {
                    Some(StatementKind::Call(call)) => Some(*call),
                    _ => None,
                };
                let preset = || presets.get(&u32::try_from(at).ok()?).copied();
                let constant = value.or_else(preset).and_then(|it| match *model.exprs.get(it) {
                    Expr::Int(value) => Some(value),
                    Expr::Bool(value) => Some(i64::from(value)),
                    _ => None,
                });
                let own = when.is_some_and(|it| is_own_absence(model, it, access.object))
                    || value.is_some_and(|it| is_own_value(model, it, access.object));
                let skipped_by = gaps::skip(&skips, access)
                    .filter(|_| access.mode.is_edge() || matches!(access.mode, Mode::EdgeMemory | Mode::Drive(_)))
                    .and_then(|it| Some(model.jumps.get(it as usize)?.anchor));
                let parameter = access.parameter.clone().zip(called).map(|(formal, call)| (call, formal));
                Use {
                    object: access.object.0,
                    mode: access.mode,
                    anchor: access.anchor,
                    exposed: access.exposed,
                    group: groups[at],
                    conditional: statement.is_some_and(|it| it.path != Exprs::TRUE)
                        || by_call
                        || when.is_some_and(|it| it != Exprs::TRUE),
                    path: access.path.0,
                    stale: access.mode.is_edge()
                        && writes.get(&access.object.0).is_some_and(|it| it.leave_out(space, access.path, &[])),
                    own,
                    holds: value.is_some_and(|it| depends_on(&model.exprs, it, access.object)),
                    of_bits: value.is_some_and(|it| is_of_bits(model, it)),
                    network: statement.map_or(0, |it| it.network),
                    detail: Detail { skipped_by, constant, parameter }.boxed(),
                }
            })
            .collect();
        let missed = |at: u32| {
            let it = writes.get(&at).filter(|it| it.leave_out(space, Exprs::TRUE, &exits))?;
            Some(it.first().0)
        };
        let objects = (0..).zip(&model.objects).zip(numbers);
        Self {
            entity: model.entity.clone(),
            language: model.language,
            objects: objects.map(|((at, object), number)| FactObject::new(object, number, missed(at))).collect(),
            uses,
            calls: calls(model),
            indexes: model.indexes.iter().filter(|it| !is_internal_word(model, it.what)).cloned().collect(),
            exclusive_calls: exclusive_calls(model, space),
            exclusive_uses: exclusive_uses(model, space, &given),
            asking: Asking::new(model),
            instance_of: model.instance_of.clone(),
            opens_instance: model.opens_instance,
            declared: model.declared.clone().map(Box::new),
            symbols: model
                .symbols
                .iter()
                .map(|it| FactSymbol {
                    name: it.name.clone(),
                    object: it.object.clone(),
                    ty: it.ty.clone(),
                    anchor: it.anchor,
                })
                .collect(),
            instructions: model.instructions,
            computes: model.computes,
            reads_indirectly: model.reads_indirectly,
            writes_indirectly: model.writes_indirectly,
            has_gaps: model.has_gaps,
            is_fragment: false,
            chart: model.chart.as_ref().map(|it| Box::new(ChartFacts::new(it, model))),
            interface: model.interface.clone(),
            condition: None,
            commented: false,
            cost: UnitCost::new(model),
            demands: demands::of_unit(&ranges),
            loops: turns::loops(&ranges),
            code: CodeFacts::new(model),
            lost: liveness::lost(model),
            forms: None,
        }
    }

    /// In what these facts are others than those which the unit had before.
    pub fn difference(&self, old: &Self) -> Difference {
        let is_same_call = |(a, b): (&FactCall, &FactCall)| {
            let key = |it: &FactCall| (it.conditional, it.reachable, it.full, it.instance_anchor.is_some());
            (&a.callee, &a.instance, key(a)) == (&b.callee, &b.instance, key(b))
        };
        let is_same_symbol =
            |(a, b): (&FactSymbol, &FactSymbol)| (&a.name, &a.object, &a.ty) == (&b.name, &b.object, &b.ty);
        let condition = |it: &Self| Some(it.objects.get(it.condition? as usize)?.object.clone());
        let is_same = self.language == old.language
            && self.instance_of == old.instance_of
            && self.opens_instance == old.opens_instance
            && self.symbols.len() == old.symbols.len()
            && self.symbols.iter().zip(&old.symbols).all(is_same_symbol)
            && self.chart == old.chart
            && self.interface == old.interface
            && apart::commands(self) == apart::commands(old)
            && condition(self) == condition(old);
        let is_named_same = self.entity == old.entity && self.declared == old.declared;
        let is_code = is_same && self.is_code() && old.is_code() || self.is_code_alone() && old.is_code_alone();
        if !(is_same && is_named_same || is_code) {
            return Difference::Unknown;
        }
        let calls_same = self.calls.len() == old.calls.len()
            && self.calls.iter().zip(&old.calls).all(is_same_call)
            && self.exclusive_calls == old.exclusive_calls;
        if is_same && is_named_same && calls_same { Difference::Uses } else { Difference::Calls }
    }

    /// Whether nothing but calls places the unit, if it is any code: data is laid out by what other blocks declare, and other code is placed by
    /// what it is.
    fn is_code(&self) -> bool {
        match &self.entity {
            Entity::Block { kind, .. } => {
                matches!(kind, BlockKind::Fc | BlockKind::Ob | BlockKind::Pb | BlockKind::Sb)
            }
            Entity::Pl7 { part, .. } => matches!(part, Part::Subroutine(_)),
            Entity::Container => true,
            _ => false,
        }
    }

    /// Whether a program without the unit is another one by its uses and calls alone.
    pub(super) fn is_code_alone(&self) -> bool {
        self.is_code()
            && self.instance_of.is_none()
            && !self.opens_instance
            && self.symbols.is_empty()
            && self.chart.is_none()
            && self.interface.is_none()
            && apart::commands(self).is_empty()
            && self.condition.is_none()
    }

    /// Says under which condition the section runs. The bit is read before the unit runs.
    pub fn run_under(&mut self, condition: &Object) {
        let object = u32::try_from(self.objects.len()).unwrap_or(u32::MAX);
        self.objects.push(FactObject::new(condition, false, None));
        self.condition = Some(object);
        let read = Use {
            object,
            mode: Mode::Read,
            anchor: 0,
            exposed: true,
            group: u32::MAX,
            conditional: false,
            path: Exprs::TRUE.0,
            stale: false,
            own: false,
            holds: false,
            of_bits: false,
            network: 0,
            detail: None,
        };
        self.uses.insert(0, read);
    }
}

fn is_internal_word(model: &UnitModel, index: IndexKind) -> bool {
    let IndexKind::Object(it) = index else { return false };
    let object = model.object(it);
    object.footprint.area == Area::Words && object.ty == Type::Word && object.class == Class::Memory && !object.indexed
}

fn is_own_value(model: &UnitModel, value: ExprId, object: ObjectId) -> bool {
    matches!(model.exprs.get(value), Expr::Read { object: read, .. } if *read == object)
}

/// Whether a condition or value reads the object, looking at its first terms.
fn depends_on(exprs: &Exprs, value: ExprId, object: ObjectId) -> bool {
    const MAX_TERMS: usize = 128;
    let mut rest = Vec::new();
    let mut next = Some(value);
    for _ in 0..MAX_TERMS {
        let Some(id) = next.take().or_else(|| rest.pop()) else { return false };
        match *exprs.get(id) {
            Expr::Read { object: read, .. } if read == object => return true,
            Expr::Not(a) | Expr::Negate(a) => next = Some(a),
            Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) | Expr::Binary(_, a, b) => {
                rest.push(a);
                next = Some(b);
            }
            _ => {}
        }
    }
    false
}

/// Whether a value is made of inputs, outputs and memory bits alone, and of few of them.
fn is_of_bits(model: &UnitModel, value: ExprId) -> bool {
    const MAX_TERMS: usize = 128;
    let mut rest = Vec::new();
    let mut next = Some(value);
    let mut reads = false;
    for _ in 0..MAX_TERMS {
        let Some(id) = next.take().or_else(|| rest.pop()) else { return reads };
        match *model.exprs.get(id) {
            Expr::Read { object, .. } => {
                let object = model.object(object);
                let is_bit = match object.class {
                    Class::Input | Class::Output | Class::Memory => object.ty == Type::Bool,
                    // An item of a block may be a timer's output.
                    Class::Symbol => !object.text.contains('.'),
                    _ => false,
                };
                if !is_bit {
                    return false;
                }
                reads = true;
            }
            Expr::Not(a) => next = Some(a),
            Expr::And(a, b) | Expr::Or(a, b) | Expr::Xor(a, b) => {
                rest.push(a);
                next = Some(b);
            }
            _ => return false,
        }
    }
    false
}

/// Whether a condition says no more than that the object is 0.
fn is_own_absence(model: &UnitModel, when: ExprId, object: ObjectId) -> bool {
    let Expr::Not(inner) = model.exprs.get(when) else { return false };
    matches!(model.exprs.get(*inner), Expr::Read { object: read, .. } if *read == object)
}

/// Which objects are computed with.
fn numbers(model: &UnitModel) -> Vec<bool> {
    let mut numbers = vec![false; model.objects.len()];
    let mut mark = |id: ExprId| {
        if let Expr::Read { object, .. } = *model.exprs.get(id) {
            numbers[object.0 as usize] = true;
        }
    };
    for id in 0..model.exprs.len() {
        match *model.exprs.get(ExprId(u32::try_from(id).unwrap_or(u32::MAX))) {
            Expr::Binary(Operator::Add | Operator::Sub | Operator::Mul | Operator::Div | Operator::Rem, a, b) => {
                mark(a);
                mark(b);
            }
            Expr::Compare(op, a, b) if !matches!(op.as_str(), "=" | "<>") => {
                mark(a);
                mark(b);
            }
            Expr::Negate(a) => mark(a),
            _ => {}
        }
    }
    for statement in &model.statements {
        if let StatementKind::Store { access, value } = statement.kind
            && let Expr::Binary(Operator::Add | Operator::Sub | Operator::Mul | Operator::Div | Operator::Rem, ..) =
                model.exprs.get(value)
            && let Some(access) = model.accesses.get(access as usize)
        {
            numbers[access.object.0 as usize] = true;
        }
    }
    numbers
}

/// What the statements give to each access: the value of an assignment, the condition of a set, reset or drive.
struct Given {
    values: Vec<Option<ExprId>>,
    whens: Vec<Option<ExprId>>,
}

fn set(list: &mut [Option<ExprId>], access: u32, it: ExprId) {
    if let Some(slot) = list.get_mut(access as usize) {
        *slot = Some(it);
    }
}

/// Accesses of some sort, those of one object together and in order; objects with one alone are left out.
fn by_object(model: &UnitModel, wanted: impl Fn(&Access) -> bool) -> Vec<(u32, &Access)> {
    #[derive(Clone, Copy, PartialEq)]
    enum Count {
        None,
        One,
        More,
    }
    // Most objects are alone.
    let mut counts = vec![Count::None; model.objects.len()];
    for it in model.accesses.iter().filter(|it| wanted(it)) {
        let count = &mut counts[it.object.0 as usize];
        *count = if *count == Count::None { Count::One } else { Count::More };
    }
    let is_one_of_more = |it: &(u32, &Access)| counts[it.1.object.0 as usize] == Count::More && wanted(it.1);
    let mut list: Vec<(u32, &Access)> = (0..).zip(&model.accesses).filter(is_one_of_more).collect();
    list.sort_by_key(|it| it.1.object);
    list
}

/// Group of each access: equal for writes of one object of which at most one takes effect in a scan.
fn groups(model: &UnitModel, space: Space<'_>, given: &Given) -> Vec<u32> {
    // What a call does to an actual parameter shows in the program alone.
    let drives = |it: &Access| it.mode.assigns() || matches!(it.mode, Mode::Store | Mode::InOut | Mode::Drive(_));
    let writes = by_object(model, drives);
    let mut groups: Vec<u32> = (0..u32::try_from(model.accesses.len()).unwrap_or(u32::MAX)).collect();
    for list in writes.chunk_by(|a, b| a.1.object == b.1.object) {
        let mut open: Vec<Vec<(u32, &Access)>> = Vec::new();
        let mut budget = MAX_COMPARISONS;
        for &(at, access) in list {
            let mut fits = |group: &Vec<(u32, &Access)>| {
                group.len() < MAX_COMPARED
                    && group.iter().all(|&(other, before)| {
                        budget = budget.saturating_sub(1);
                        budget > 0 && same_drive(model, space, given, (other, before), (at, access))
                    })
            };
            match open.iter_mut().take(MAX_COMPARED).find(|it| fits(it)) {
                Some(group) => group.push((at, access)),
                None => open.push(vec![(at, access)]),
            }
        }
        for group in open {
            for (at, _) in &group[1..] {
                groups[*at as usize] = group[0].0;
            }
        }
    }
    groups
}

fn exclusive_uses(model: &UnitModel, space: Space<'_>, given: &Given) -> Vec<(u32, u32)> {
    let stores = |it: Mode| matches!(it, Mode::Set | Mode::Reset | Mode::EdgeMemory);
    let writes = by_object(model, |it| stores(it.mode) || it.mode.assigns() || it.mode == Mode::InOut);
    let mut pairs = Vec::new();
    for list in writes.chunk_by(|a, b| a.1.object == b.1.object) {
        for (at, second) in list.iter().take(MAX_COMPARED).enumerate() {
            for first in &list[..at] {
                let either = stores(first.1.mode) || stores(second.1.mode);
                if either && same_drive(model, space, given, *first, *second) {
                    pairs.push((first.1.anchor.min(second.1.anchor), first.1.anchor.max(second.1.anchor)));
                }
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Whether two writes of one object count as one: never both in a scan, or a constant default that a later,
/// conditional write of the same unit overrides.
fn same_drive(
    model: &UnitModel,
    space: Space<'_>,
    given: &Given,
    first: (u32, &Access),
    second: (u32, &Access),
) -> bool {
    let (Some(a), Some(b)) = (model.statement(first.1), model.statement(second.1)) else { return false };
    if a.path == Exprs::FALSE || b.path == Exprs::FALSE {
        return true;
    }
    if first.1.statement == second.1.statement {
        return true;
    }
    let value = given.values.get(first.0 as usize).copied().flatten();
    let default = value.is_some_and(|it| matches!(model.exprs.get(it), Expr::Bool(_) | Expr::Int(_)));
    if default && a.path != b.path && model.exprs.has_conjunct_prefix(b.path, a.path) {
        return true;
    }
    let (a, b) = (effective(model, first.1, a.path), effective(model, second.1, b.path));
    space.together(&[a.0, a.1, b.0, b.1]) == Verdict::Never
}

/// Path to a write, and the condition at the instruction itself. A pin of a timer or counter takes 0 as well as 1: the
/// instruction acts whatever its condition.
pub(super) fn effective(model: &UnitModel, write: &Access, path: ExprId) -> (ExprId, ExprId) {
    let when = match model.statement(write).map(|it| &it.kind) {
        Some(StatementKind::Set { when, .. } | StatementKind::Reset { when, .. }) => *when,
        Some(StatementKind::Call(call)) => model.calls.get(*call as usize).map_or(Exprs::TRUE, |it| it.when),
        _ => Exprs::TRUE,
    };
    (path, when)
}

fn calls(model: &UnitModel) -> Vec<FactCall> {
    let path = |statement: u32| model.statements.get(statement as usize).map_or(Exprs::TRUE, |it| it.path);
    model
        .calls
        .iter()
        .map(|call| FactCall {
            callee: call.callee.clone(),
            text: call.text.clone(),
            anchor: call.anchor,
            conditional: call.when != Exprs::TRUE || path(call.statement) != Exprs::TRUE,
            reachable: path(call.statement) != Exprs::FALSE && call.when != Exprs::FALSE,
            instance: call.instance.clone(),
            instance_anchor: call
                .instance_range
                .zip(call.anchor.checked_add(1))
                .filter(|(range, anchor)| model.anchors.get(*anchor as usize) == Some(range))
                .map(|it| it.1),
            full: call.full,
            arguments: call.arguments.clone(),
            actuals: call.actuals.clone(),
            too_close: call.too_close,
        })
        .collect()
}

fn exclusive_calls(model: &UnitModel, space: Space<'_>) -> Vec<(u32, u32)> {
    let conditional: Vec<(u32, ExprId, &Call)> = model
        .calls
        .iter()
        .enumerate()
        .filter(|(_, call)| matches!(call.callee, Callee::Subroutine(_) | Callee::Block(_) | Callee::Instance(_)))
        .filter_map(|(at, call)| {
            let path = model.statements.get(call.statement as usize)?.path;
            (path != Exprs::TRUE || call.when != Exprs::TRUE).then_some((u32::try_from(at).ok()?, path, call))
        })
        .collect();
    let mut by_instance: FxHashMap<&BlockName, Vec<usize>> = FxHashMap::default();
    let mut pairs = Vec::new();
    for (at, &(b, path_b, call_b)) in conditional.iter().enumerate() {
        let same = call_b.instance.as_ref().map(|it| by_instance.entry(it).or_default());
        let others: Vec<usize> = match &same {
            _ if at < MAX_COMPARED => (0..at).collect(),
            Some(list) => list.to_vec(),
            None => Vec::new(),
        };
        for other in others {
            let (a, path_a, call_a) = conditional[other];
            let all = [path_a, call_a.when, path_b, call_b.when];
            if space.together(&all) == Verdict::Never {
                pairs.push((a, b));
            }
        }
        if let Some(same) = same.filter(|it| it.len() < MAX_COMPARED) {
            same.push(at);
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Whether an object is shared by the program: not the block's own name, not a place unknown before the program runs.
pub fn is_shared(object: &Object) -> bool {
    !matches!(
        object.class,
        Class::LocalName | Class::LocalData | Class::Indirect | Class::Status | Class::InstanceData | Class::CodeBlock
    )
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;
    use crate::model::lower;
    use crate::model::unit::Pin;
    use crate::syntax::{self, Mnemonics};

    fn facts(text: &str) -> UnitFacts {
        let language = Language::Awl(Mnemonics::German);
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        UnitFacts::new(&lower::lower(parse.syntax(), text, Entity::Listing, language))
    }

    fn starts(text: &str) -> Vec<u32> {
        facts(text).uses.iter().filter(|it| it.mode == Mode::Drive(Pin::Start)).map(|it| it.group).collect()
    }

    #[test]
    fn a_pin_is_driven_by_0_too() {
        let groups = starts("U E0.0\nL S5T#5S\nSE T1\nUN E0.0\nL S5T#2S\nSE T1\n");
        assert_ne!(groups[0], groups[1], "both are executed in each scan");
        let groups = starts("U E0.0\nSPB A\nU E0.1\nL S5T#5S\nSE T1\nSPA B\nA: U E0.1\nL S5T#2S\nSE T1\nB: NOP 0\n");
        assert_eq!(groups[0], groups[1], "only one of them is reached");
    }

    #[test]
    fn calls_of_one_instance_are_compared_however_many_there_are() {
        let mut text = String::new();
        for at in 0..100 {
            writeln!(text, "U E0.0\nSPB A{at}\nCALL FC {at}\nA{at}: NOP 0").unwrap();
        }
        text += "U E1.0\nSPB B\nCALL FB 1, DB 1\nSPA C\nB: CALL FB 1, DB 1\nC: NOP 0\nCALL FB 1, DB 1\n";
        let facts = facts(&text);
        assert!(facts.exclusive_calls.contains(&(100, 101)));
        assert!(!facts.exclusive_calls.contains(&(101, 102)));
    }

    #[test]
    fn an_instance_has_its_place() {
        let facts = facts("CALL FC 2\nCALL FB 1, DB 3\n");
        assert_eq!(facts.calls[0].instance_anchor, None);
        assert_eq!(facts.calls[1].instance_anchor, Some(facts.calls[1].anchor + 1));
    }
}

//! A program as a whole: the access table over all units, the call graph, and what scans what.

use std::cell::{Cell, OnceCell};
use std::ops::Deref;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::Arc;

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;
use smol_str::SmolStr;

use super::Site;
use super::chart::{self, Actions, Chart};
use super::facts::{self, FactCall, FactObject, UnitFacts, Use};
use super::fields;
use super::islands::Islands;
use super::sequences::Sequences;
use super::unseen::{Access, AskedFor, Questions, Summary, Unseen};
use crate::model::chart::StepKind;
use crate::model::dfb::{Interface, Role};
use crate::model::entity::{BlockKind, BlockName, Entity, Family, Part, Task};
use crate::model::layout::{DataType, Layouts, Place};
use crate::model::object::{Area, Class, Footprint, Object};
use crate::model::symbols::key;
use crate::model::unit::{Actual, Callee, Formal, Given, Mode, Pin, Section};
use crate::syntax::Language;
use crate::target::step5;

/// What runs code: code of one context never interrupts itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Context {
    /// MAST, or OB 1 and what it calls. Also code whose caller is not known.
    Cyclic,
    Fast,
    Event(u16),
    /// A task of a PL7 project of which only the number is known.
    Task(u16),
    /// OB 100 to 102: once, before the first scan.
    Startup,
    /// Any other OB, by number.
    Interrupt(u32),
}

impl Context {
    /// Whether code of one context never interrupts code of the other. Events but EVT0 have one priority (PL7:2113-2117);
    /// so have the OBs of one kind, by the vendor's general documentation.
    fn is_level_with(self, other: Self) -> bool {
        let kind = |ob: u32| match ob {
            10..=17 => 10,
            80..=89 => 80,
            other => other,
        };
        match (self, other) {
            (Self::Event(a), Self::Event(b)) => a == b || (a != 0 && b != 0),
            (Self::Interrupt(a), Self::Interrupt(b)) => kind(a) == kind(b),
            (a, b) => a == b,
        }
    }

    /// The task or block that it stands for.
    pub fn name(self, family: Family) -> String {
        match (self, family) {
            (Self::Cyclic, Family::Step5 | Family::Step7) => "OB1".to_owned(),
            (Self::Cyclic, _) => "MAST".to_owned(),
            (Self::Fast, _) => "FAST".to_owned(),
            (Self::Event(number), _) => format!("EVT{number}"),
            (Self::Task(number), _) => format!("task {number}"),
            (Self::Startup, _) => "the start-up blocks".to_owned(),
            (Self::Interrupt(number), _) => format!("OB{number}"),
        }
    }
}

/// One use of an object, with the unit that it stands in.
#[derive(Debug, Clone, Copy)]
pub struct GlobalUse<'a> {
    pub unit: u32,
    /// What is done to the object. Of an actual parameter, this is what the called block's interface says.
    pub mode: Mode,
    pub it: &'a Use,
}

impl GlobalUse<'_> {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.anchor }
    }
}

/// Which modes some uses have; those of all pins count as one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Modes(u16);

impl Modes {
    /// By the number of their bit.
    const ALL: [Mode; 13] = [
        Mode::Read,
        Mode::Rising,
        Mode::Falling,
        Mode::Assign,
        Mode::AssignNot,
        Mode::Set,
        Mode::Reset,
        Mode::Store,
        Mode::Write,
        Mode::EdgeMemory,
        Mode::Drive(Pin::Whole),
        Mode::InOut,
        Mode::Output,
    ];

    const fn bit(mode: Mode) -> u16 {
        1 << match mode {
            Mode::Read => 0,
            Mode::Rising => 1,
            Mode::Falling => 2,
            Mode::Assign => 3,
            Mode::AssignNot => 4,
            Mode::Set => 5,
            Mode::Reset => 6,
            Mode::Store => 7,
            Mode::Write => 8,
            Mode::EdgeMemory => 9,
            Mode::Drive(_) => 10,
            Mode::InOut => 11,
            Mode::Output => 12,
        }
    }

    pub(super) fn insert(&mut self, mode: Mode) {
        self.0 |= Self::bit(mode);
    }

    pub(super) fn join(&mut self, other: Self) {
        self.0 |= other.0;
    }

    fn iter(self) -> impl Iterator<Item = Mode> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let mode = *Self::ALL.get(rest.trailing_zeros() as usize)?;
            rest &= rest - 1;
            Some(mode)
        })
    }

    pub(super) fn set_and_reset(self) -> bool {
        [Mode::Set, Mode::Reset].iter().all(|it| self.0 & Self::bit(*it) != 0)
    }

    /// Whether one of them drives a pin.
    pub(super) fn drive(self) -> bool {
        self.0 & Self::bit(Mode::Drive(Pin::Whole)) != 0
    }

    /// Whether one of the modes may be wanted; which pin is driven is not known here.
    fn may_have(self, wanted: impl Fn(Mode) -> bool) -> bool {
        self.iter().any(|it| matches!(it, Mode::Drive(_)) || wanted(it))
    }

    /// Those that are wanted, those of pins left out.
    pub(super) fn of(wanted: impl Fn(Mode) -> bool) -> Self {
        let mut found = Self::default();
        Self::ALL.into_iter().filter(|it| !matches!(it, Mode::Drive(_)) && wanted(*it)).for_each(|it| found.insert(it));
        found
    }

    /// Whether one of the modes is wanted, those of pins left out.
    pub(super) fn has(self, wanted: impl Fn(Mode) -> bool) -> bool {
        self.meet(Self::of(wanted))
    }

    pub(super) fn meet(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Those that only one of both has.
    pub(super) fn difference(self, other: Self) -> Self {
        Self(self.0 ^ other.0)
    }
}

/// An object with all its uses, in execution order.
#[derive(Debug, Clone)]
pub struct ObjectUses<'a> {
    pub object: &'a Object,
    /// Some unit computes with its value.
    pub number: bool,
    pub uses: Vec<GlobalUse<'a>>,
    modes: Modes,
    /// What was asked to judge it.
    asked: Cell<Questions>,
}

impl<'a> ObjectUses<'a> {
    pub(super) fn with_capacity(object: &'a Object, uses: usize) -> Self {
        Self { object, number: false, uses: Vec::with_capacity(uses), modes: Modes::default(), asked: Cell::default() }
    }

    pub(super) fn push(&mut self, skeleton: &Skeleton<'_>, unit: u32, it: &'a Use) {
        let mode = actual_mode(skeleton, unit, it);
        self.uses.push(GlobalUse { unit, mode, it });
        self.modes.insert(mode);
    }

    /// Most rules want modes that most objects have not: this costs next to nothing then.
    pub fn with_mode(&self, wanted: impl Fn(Mode) -> bool) -> impl Iterator<Item = &GlobalUse<'a>> {
        let uses = if self.modes.may_have(&wanted) { self.uses.as_slice() } else { &[] };
        uses.iter().filter(move |it| wanted(it.mode))
    }

    pub fn has_mode(&self, wanted: impl Fn(Mode) -> bool) -> bool {
        self.with_mode(wanted).next().is_some()
    }

    pub fn is_written(&self) -> bool {
        self.has_mode(|it| it.writes() || matches!(it, Mode::Drive(_)))
    }

    pub fn is_read(&self) -> bool {
        self.has_mode(Mode::reads)
    }

    /// Whether every unit that uses the object writes it before it reads it: a scratch value that does not outlive the
    /// unit, so that units do not disturb one another through it.
    pub fn is_scratch(&self) -> bool {
        matches!(self.object.class, Class::Memory | Class::Symbol)
            && self.is_read()
            && !self.has_mode(|it| it.is_edge() || it == Mode::EdgeMemory)
            && self.with_mode(Mode::reads).all(|it| !it.it.exposed)
    }
}

/// A call resolved to a unit of the program, where it is one.
#[derive(Debug, Clone, Copy)]
pub struct GlobalCall<'a> {
    pub unit: u32,
    /// Index into the unit's calls.
    pub index: u32,
    pub it: &'a FactCall,
    pub target: Option<u32>,
}

impl GlobalCall<'_> {
    pub fn site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.anchor }
    }

    /// Place of the instance data block; the callee's when the call names none.
    pub fn instance_site(&self) -> Site {
        Site { unit: self.unit, anchor: self.it.instance_anchor.unwrap_or(self.it.anchor) }
    }
}

/// A section that runs while a bit is 1.
#[derive(Debug)]
pub struct ConditionalSection<'a> {
    pub condition: &'a Object,
    /// Its parts, in the order of execution.
    pub units: Vec<u32>,
}

/// The units of a program and what runs them: all but their objects.
#[derive(Debug)]
pub struct Skeleton<'a> {
    pub family: Family,
    pub units: Vec<&'a UnitFacts>,
    /// Those of a unit stand together.
    pub calls: Vec<GlobalCall<'a>>,
    /// Of each unit, its first call; then the end.
    first_calls: Vec<u32>,
    /// Calls into each unit, as indices into `calls`.
    pub callers: Vec<SmallVec<[u32; 4]>>,
    /// Contexts that run each unit, sorted.
    pub contexts: Vec<SmallVec<[Context; 2]>>,
    /// Whether the system runs each unit, or code that it runs calls it. The contexts of other units are a guess.
    pub reached: Vec<bool>,
    /// Whether a unit surely runs in each scan of some task: its entry point, and what it calls without a condition.
    pub sure: Vec<bool>,
    /// Rank of each unit in the order of execution.
    pub order: Vec<u32>,
    /// Whether the program has a cyclic entry point and every block that it calls: only then does the absence of a
    /// write, a read or a call say something. A rule that judges an object asks for it by [`ProgramIndex::unseen`].
    pub complete: bool,
    /// Some of the program was not read or not understood.
    pub partial: bool,
    names: FxHashMap<UnitName, u32>,
    charts: OnceCell<Vec<Chart<'a>>>,
    actions: OnceCell<Actions<'a>>,
    layouts: OnceCell<Arc<Layouts>>,
}

/// Objects that several units can share, by footprint. They are collected when they are first asked for.
pub struct Objects<'a> {
    of: Rc<Skeleton<'a>>,
    all: OnceCell<Vec<ObjectUses<'a>>>,
}

impl<'a> Deref for Objects<'a> {
    type Target = [ObjectUses<'a>];

    fn deref(&self) -> &Self::Target {
        self.all.get_or_init(|| collect(&self.of, |_| true))
    }
}

impl<'o, 'a> IntoIterator for &'o Objects<'a> {
    type Item = &'o ObjectUses<'a>;
    type IntoIter = std::slice::Iter<'o, ObjectUses<'a>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl std::fmt::Debug for Objects<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self).finish()
    }
}

/// A program: its skeleton, and the access table over all units or some islands of it.
#[derive(Debug)]
pub struct ProgramIndex<'a> {
    skeleton: Rc<Skeleton<'a>>,
    pub objects: Objects<'a>,
    /// Of a part of a program, the units that have changed.
    changed: Option<Box<[u32]>>,
    /// What is kept of all objects from edit to edit, so that some of them cost less than all.
    islands: OnceCell<Arc<Islands>>,
    access: OnceCell<Access>,
    uncleared: OnceCell<Vec<Footprint>>,
    /// What was asked for no object that is judged.
    asked: Cell<Questions>,
    sequences: OnceCell<Sequences<'a>>,
    sequence_charts: OnceCell<Vec<Chart<'a>>>,
}

impl<'a> Deref for ProgramIndex<'a> {
    type Target = Skeleton<'a>;

    fn deref(&self) -> &Self::Target {
        &self.skeleton
    }
}

impl<'a> ProgramIndex<'a> {
    /// `units`: in path and file order.
    pub fn new(family: Family, units: Vec<&'a UnitFacts>) -> Self {
        Self::of(Rc::new(Skeleton::new(family, units)))
    }

    /// The whole of a program.
    pub fn of(skeleton: Rc<Skeleton<'a>>) -> Self {
        let objects = Objects { of: skeleton.clone(), all: OnceCell::new() };
        let (sequences, sequence_charts) = (OnceCell::new(), OnceCell::new());
        let (islands, access, uncleared) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        let asked = Cell::default();
        Self { skeleton, objects, changed: None, islands, access, uncleared, asked, sequences, sequence_charts }
    }

    /// Takes what is kept of the program as it is.
    pub(crate) fn know(&self, islands: Arc<Islands>) {
        // What is known already is the same.
        let _ = self.islands.set(islands);
    }

    /// What is kept of its objects, if anything is.
    pub(crate) fn known(&self) -> Option<&Arc<Islands>> {
        self.islands.get()
    }

    pub fn skeleton(&self) -> &Rc<Skeleton<'a>> {
        &self.skeleton
    }

    /// Some of its objects, in order, with all that share memory with one of them. `summary`: of the whole program.
    pub(super) fn part(
        skeleton: Rc<Skeleton<'a>>,
        objects: Vec<ObjectUses<'a>>,
        changed: Box<[u32]>,
        summary: Summary,
    ) -> Self {
        let mut part = Self::of(skeleton);
        (part.objects.all, part.changed) = (objects.into(), Some(changed));
        (part.access, part.uncleared) = (summary.access.into(), summary.uncleared.into());
        part
    }

    /// Those of its objects of some classes that are wanted, in their order. Of a few out of many, this spares the others.
    pub fn objects_that(&self, class: impl Fn(Class) -> bool, wanted: impl Fn(&Object) -> bool) -> Vec<ObjectUses<'a>> {
        let is_wanted = |it: &Object| class(it.class) && wanted(it);
        match (self.objects.all.get(), self.islands.get()) {
            (Some(all), _) => all.iter().filter(|it| is_wanted(it.object)).cloned().collect(),
            (None, Some(islands)) => islands.those(&self.skeleton, class, wanted),
            (None, None) => collect(&self.skeleton, is_wanted),
        }
    }

    /// Its part with those objects alone.
    pub fn those(&self, class: impl Fn(Class) -> bool, wanted: impl Fn(&Object) -> bool) -> Self {
        Self::part(self.skeleton.clone(), self.objects_that(class, wanted), Box::default(), self.summary())
    }

    /// What is used of some classes, whatever for, in no order.
    pub fn places(&self, class: impl Fn(Class) -> bool + Copy) -> impl Iterator<Item = &Object> {
        let islands = self.islands.get();
        let collected = islands.is_none().then(|| self.objects.iter().map(|it| it.object));
        let collected = collected.into_iter().flatten().filter(move |it| class(it.class));
        collected.chain(islands.into_iter().flat_map(move |it| it.used(class)))
    }

    /// The units whose own objects, which no other unit can name, are judged with the others.
    pub fn judged_units(&self) -> impl Iterator<Item = (u32, &'a UnitFacts)> {
        let all = (0..).zip(&self.units).map(|(at, it)| (at, *it));
        all.filter(|(at, _)| self.changed.as_ref().is_none_or(|it| it.contains(at)))
    }

    /// Heading of a unit.
    pub fn heading(unit: u32) -> Site {
        Site { unit, anchor: 0 }
    }

    /// What is known of all objects of the program together, also where only some of them are there.
    pub fn summary(&self) -> Summary {
        Summary { access: self.access().clone(), uncleared: self.uncleared().to_vec() }
    }

    pub(super) fn access(&self) -> &Access {
        self.access.get_or_init(|| {
            if let Some(islands) = self.known() {
                return islands.access(self);
            }
            let mut addressed = Modes::default();
            let all = self.objects.iter().filter(|it| Access::is_addressed(it.object));
            all.for_each(|it| addressed.join(it.modes));
            Access::new(self, self.objects.iter().map(|it| (it.object, it.modes)), addressed)
        })
    }

    pub(super) fn uncleared(&self) -> &[Footprint] {
        self.uncleared.get_or_init(|| {
            // A rule that asks for sequences which cannot be had fails by itself.
            let faults = || self.sequences().faults.iter().filter_map(|it| it.table.clone()).collect();
            let asked = self.asked.get();
            let found = catch_unwind(AssertUnwindSafe(faults)).unwrap_or_default();
            // The tables are a part of the summary themselves.
            self.asked.set(asked);
            found
        })
    }

    /// The sequences that the program codes with bits.
    pub fn sequences(&self) -> &Sequences<'a> {
        self.sequences.get_or_init(|| Sequences::new(self))
    }

    /// The same as charts, in their order.
    pub fn sequence_charts(&'a self) -> &'a [Chart<'a>] {
        self.sequence_charts.get_or_init(|| self.sequences().charts())
    }

    /// The object of the program that an object of a unit is, by index; `None` for one that no other unit knows.
    pub fn object_of(&self, it: &FactObject) -> Option<u32> {
        let is_same = |other: &ObjectUses<'_>| {
            let (one, other) = (&it.object, other.object);
            (one.ty, one.indexed) == (other.ty, other.indexed) && one.footprint == other.footprint
        };
        self.objects.iter().position(is_same).map(as_index)
    }

    /// What may be done to an object, which is judged, by places that do not name it.
    pub fn unseen<'p>(&'p self, uses: &'p ObjectUses<'_>) -> Unseen<'p, 'a> {
        Unseen { program: self, object: uses.object, asked: &uses.asked }
    }

    /// The same of an object of which nothing is said alone.
    pub fn unseen_of<'p>(&'p self, object: &'p Object) -> Unseen<'p, 'a> {
        Unseen { program: self, object, asked: &self.asked }
    }

    /// What was asked for each of its objects, as one of its units names it: unit, and index there. And what was asked for
    /// no object that is judged, so that the answers may bear on all of them.
    pub fn asked(&self) -> (AskedFor, Questions) {
        let asked = |it: &ObjectUses<'_>| {
            let first = it.uses.first()?;
            Some(((first.unit, first.it.object), it.asked.get())).filter(|it| !it.1.is_empty())
        };
        let objects = self.objects.all.get().into_iter().flatten();
        (objects.filter_map(asked).collect(), self.asked.get())
    }

    /// Pairs of distinct objects that share memory, by index, the earlier address first.
    pub fn overlaps(&self) -> Vec<(u32, u32)> {
        /// One object is compared with at most this many that start inside it.
        const WINDOW: usize = 256;
        let mut pairs = Vec::new();
        for (at, a) in self.objects.iter().enumerate() {
            let from = &a.object.footprint;
            if !a.object.is_fixed() || matches!(from.area, Area::Symbol(_)) {
                continue;
            }
            for (distance, b) in self.objects[at + 1..].iter().enumerate().take(WINDOW) {
                if !from.overlaps(&b.object.footprint) {
                    break;
                }
                if b.object.is_fixed() {
                    pairs.push((as_index(at), as_index(at + 1 + distance)));
                }
            }
        }
        pairs
    }
}

impl<'a> Skeleton<'a> {
    /// `units`: in path and file order.
    pub fn new(family: Family, units: Vec<&'a UnitFacts>) -> Self {
        let names = unit_names(&units);
        let mut calls = Vec::new();
        let mut first_calls = Vec::with_capacity(units.len() + 1);
        let mut callers = vec![SmallVec::new(); units.len()];
        for (unit, facts) in units.iter().enumerate() {
            first_calls.push(as_index(calls.len()));
            for (index, it) in facts.calls.iter().enumerate() {
                let target = target(facts, &it.callee).and_then(|key| names.get(&key).copied());
                if let Some(target) = target.filter(|_| it.reachable) {
                    callers[target as usize].push(as_index(calls.len()));
                }
                calls.push(GlobalCall { unit: as_index(unit), index: as_index(index), it, target });
            }
        }
        first_calls.push(as_index(calls.len()));
        let callees = Callees { calls: &calls, first: &first_calls };
        let (contexts, reached) = contexts(&units, callees);
        let sure = sure(&units, callees);
        let order = order(family, &units, callees);
        let complete = is_complete(family, &units, &calls);
        let partial = units.iter().any(|it| it.has_gaps || it.is_fragment);
        let (charts, actions, layouts) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Self {
            family,
            units,
            calls,
            first_calls,
            callers,
            contexts,
            reached,
            sure,
            order,
            complete,
            partial,
            names,
            charts,
            actions,
            layouts,
        }
    }

    /// The unit that a call of a unit, by its index there, leads to.
    pub(super) fn target_of(&self, unit: u32, call: u32) -> Option<u32> {
        self.calls.get((self.first_calls.get(unit as usize)? + call) as usize).filter(|it| it.unit == unit)?.target
    }

    /// Whether an object is an item of an instance of a DFB, which has no address.
    pub(super) fn is_item(&self, object: &Object) -> bool {
        let instance = object.text.split_once('.').map(|it| UnitName::Instance(key(it.0)));
        instance.is_some_and(|it| self.names.contains_key(&it))
    }

    /// The charts of the program, whose pages are joined.
    pub fn charts(&self) -> &[Chart<'a>] {
        self.charts.get_or_init(|| chart::join(&self.units))
    }

    /// The actions of their steps.
    pub fn actions(&self) -> &Actions<'a> {
        self.actions.get_or_init(|| Actions::new(&self.units))
    }

    /// Where the fields of the blocks of STEP 7 lie.
    pub fn layouts(&self) -> &Layouts {
        self.layouts.get_or_init(|| Arc::new(fields::layouts(self.units.iter().copied())))
    }

    /// Takes the layouts of its units where they are made already.
    pub(crate) fn know_layouts(&self, layouts: Arc<Layouts>) {
        let _ = self.layouts.set(layouts);
    }

    /// Where the field at a place of a block is declared: in the block, or in the type that it goes by.
    pub fn declaration(&self, block: &BlockName, place: &Place) -> Option<Site> {
        let mut unit = self.unit_named(place.of.as_ref().unwrap_or(block))?;
        // Data of a type, which may be data of another.
        for _ in 0..self.units.len() {
            match self.units.get(unit as usize)?.declared.as_deref()? {
                DataType::Named(of) => unit = self.unit_named(of)?,
                _ => return Some(Site { unit, anchor: place.anchor }),
            }
        }
        None
    }

    /// Whether two writes of one object can both take effect in one scan.
    pub fn clash(&self, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
        if chart::in_exclusive_actions(self.units[a.unit as usize], a.it, self.units[b.unit as usize], b.it) {
            return false;
        }
        if a.unit != b.unit {
            return self.same_scan(a.unit, b.unit);
        }
        let pair = (a.it.anchor.min(b.it.anchor), a.it.anchor.max(b.it.anchor));
        a.it.group != b.it.group && self.units[a.unit as usize].exclusive_uses.binary_search(&pair).is_err()
    }

    /// Whether two units can run in the same scan of the same context.
    pub fn same_scan(&self, a: u32, b: u32) -> bool {
        if a == b {
            return true;
        }
        let (x, y) = (&self.contexts[a as usize], &self.contexts[b as usize]);
        x.iter().any(|it| y.contains(it)) && !self.exclusive_units(a, b)
    }

    /// The tasks that surely run a unit, start-up left out; none when its caller is not known.
    pub fn tasks(&self, unit: u32) -> impl Iterator<Item = Context> + '_ {
        let known = self.reached[unit as usize];
        let contexts = self.contexts[unit as usize].iter().filter(move |_| known);
        contexts.copied().filter(|it| *it != Context::Startup)
    }

    /// Whether an event runs some unit.
    pub fn has_events(&self) -> bool {
        self.contexts.iter().flatten().any(|it| matches!(it, Context::Event(_)))
    }

    /// Whether two units surely run in tasks of which one interrupts the other, and in none that is the same.
    pub fn in_other_tasks(&self, a: u32, b: u32) -> bool {
        let has = |unit: u32| self.tasks(unit).next().is_some();
        has(a) && has(b) && !self.tasks(a).any(|it| self.tasks(b).any(|other| it.is_level_with(other)))
    }

    /// The tasks that run a unit, for a message: `MAST`, `FAST and EVT1`.
    pub fn task_names(&self, unit: u32) -> String {
        let names: Vec<String> = self.tasks(unit).map(|it| it.name(self.family)).collect();
        names.join(" and ")
    }

    /// Whether the system or a call surely runs the unit, but not in each scan.
    pub fn is_passed_by(&self, unit: u32) -> bool {
        self.reached[unit as usize] && !self.sure[unit as usize] && !self.is_startup(unit)
    }

    /// The condition of the section that a unit belongs to.
    pub fn condition(&self, unit: u32) -> Option<&'a Object> {
        let facts = self.units.get(unit as usize)?;
        Some(&facts.objects.get(facts.condition? as usize)?.object)
    }

    /// Whether two units belong to sections that one bit lets run, so that both run or none.
    pub fn run_together(&self, a: u32, b: u32) -> bool {
        let place = |unit: u32| self.condition(unit).filter(|it| it.is_fixed()).map(|it| &it.footprint);
        place(a).is_some_and(|it| place(b) == Some(it))
    }

    /// Why a unit does not run in each scan, with the place: a call that depends on a condition, of those that lead to it,
    /// or the condition of a section.
    pub fn passed_by(&self, unit: u32) -> Option<(Site, String)> {
        let mut seen = FxHashSet::default();
        let mut at = unit;
        while seen.insert(at) {
            if let Some(condition) = self.condition(at) {
                return Some((ProgramIndex::heading(at), format!("this section runs while `{}` is 1", condition.text)));
            }
            let callers = self.callers[at as usize].iter().map(|&it| &self.calls[it as usize]);
            if let Some(call) = callers.clone().find(|it| it.it.conditional) {
                return Some((call.site(), "this call depends on a condition".to_owned()));
            }
            at = callers.map(|it| it.unit).next()?;
        }
        None
    }

    /// The sections that have a condition, in the order of execution.
    pub fn conditional_sections(&self) -> Vec<ConditionalSection<'a>> {
        let mut units: Vec<u32> = (0..as_index(self.units.len())).filter(|&it| self.condition(it).is_some()).collect();
        units.sort_by_key(|&it| self.order[it as usize]);
        let mut sections: Vec<ConditionalSection<'a>> = Vec::new();
        let mut known = FxHashMap::default();
        for unit in units {
            let (Some(condition), Entity::Pl7 { task, section, .. }) = (self.condition(unit), self.entity(unit)) else {
                continue;
            };
            let next = sections.len();
            let at = *known.entry((*task, section.as_ref().map(|it| key(it)))).or_insert(next);
            if at == next {
                sections.push(ConditionalSection { condition, units: Vec::new() });
            }
            sections[at].units.push(unit);
        }
        sections
    }

    /// The units that run only when one of some others does: those themselves, and the subroutines that they alone call.
    pub fn run_by(&self, units: &[u32]) -> FxHashSet<u32> {
        let mut within: FxHashSet<u32> = units.iter().copied().collect();
        let mut open: Vec<u32> = units.to_vec();
        let mut callees: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        for call in self.calls.iter().filter(|it| it.it.reachable) {
            callees.entry(call.unit).or_default().extend(call.target);
        }
        callees.values_mut().for_each(|it| {
            it.sort_unstable();
            it.dedup();
        });
        // A subroutine is asked again for each of its callers.
        while let Some(at) = open.pop() {
            for &callee in callees.get(&at).into_iter().flatten() {
                let mut callers = self.callers[callee as usize].iter().map(|&it| self.calls[it as usize].unit);
                if !self.is_entry(callee) && callers.all(|it| within.contains(&it)) && within.insert(callee) {
                    open.push(callee);
                }
            }
        }
        within
    }

    /// Whether some run of the unit passes by all its writes of the object that one of its uses is of: number of the
    /// condition at the first of them.
    pub fn missed(&self, it: &GlobalUse<'_>) -> Option<u32> {
        self.units[it.unit as usize].objects.get(it.it.object as usize)?.missed
    }

    /// Whether two calls can both happen in the same scan of the same context.
    pub fn calls_in_same_scan(&self, a: &GlobalCall<'_>, b: &GlobalCall<'_>) -> bool {
        let (first, second) = (a.index.min(b.index), a.index.max(b.index));
        a.it.reachable
            && b.it.reachable
            && self.same_scan(a.unit, b.unit)
            && (a.unit != b.unit || !self.are_exclusive(a.unit, first, second))
    }

    /// Whether two calls of a unit, by index, the smaller first, never run in the same scan.
    fn are_exclusive(&self, unit: u32, first: u32, second: u32) -> bool {
        self.units[unit as usize].exclusive_calls.binary_search(&(first, second)).is_ok()
    }

    /// Whether two units are called under conditions that exclude each other, as far as their only calls tell.
    fn exclusive_units(&self, a: u32, b: u32) -> bool {
        let (up_a, up_b) = (self.only_calls(a), self.only_calls(b));
        up_a.iter().any(|&(unit, x)| {
            up_b.iter().any(|&(other, y)| unit == other && self.are_exclusive(unit, x.min(y), x.max(y)))
        })
    }

    /// From the unit upwards: caller and call, as long as there is only one.
    fn only_calls(&self, unit: u32) -> Vec<(u32, u32)> {
        let mut up = Vec::new();
        let mut at = unit;
        while let [only] = self.callers[at as usize][..] {
            let call = &self.calls[only as usize];
            if up.len() > 32 || self.is_entry(at) {
                break;
            }
            up.push((call.unit, call.index));
            at = call.unit;
        }
        up
    }

    /// Whether the system runs the unit by itself.
    pub fn is_entry(&self, unit: u32) -> bool {
        is_entry(&self.units[unit as usize].entity)
    }

    pub fn entity(&self, unit: u32) -> &Entity {
        &self.units[unit as usize].entity
    }

    /// Says that part of the program was not read: files of a language that is not understood.
    pub fn leave_incomplete(&mut self) {
        self.complete = false;
        self.partial = true;
    }

    /// Whether the program's cyclic entry point was read: OB 1, a section of MAST.
    pub fn has_main(&self) -> bool {
        has_main(self.family, &self.units)
    }

    /// Whether only start-up blocks run the unit: once, before the first scan.
    pub fn is_startup(&self, unit: u32) -> bool {
        self.contexts[unit as usize][..] == [Context::Startup]
    }

    /// Whether the unit runs in events alone, each of which something raises.
    pub fn is_in_event(&self, unit: u32) -> bool {
        let contexts = &self.contexts[unit as usize];
        !contexts.is_empty() && contexts.iter().all(|it| matches!(it, Context::Event(_)))
    }

    /// The object of a use as its unit writes it.
    pub fn text_of(&self, it: &GlobalUse<'_>) -> &str {
        let objects = self.units.get(it.unit as usize).map_or(&[][..], |it| &it.objects);
        objects.get(it.it.object as usize).map_or("", |it| it.object.text.as_str())
    }

    /// Index of the data block, FB, ... of that name.
    pub fn unit_named(&self, name: &BlockName) -> Option<u32> {
        self.names.get(&UnitName::Block(name.clone())).copied()
    }

    /// The type of an instance of a DFB, if the program holds both: its unit and its interface.
    pub fn dfb_of(&self, instance: &str) -> Option<(u32, &'a Interface)> {
        let &unit = self.names.get(&UnitName::Instance(key(instance)))?;
        Some((unit, self.units.get(unit as usize)?.interface.as_deref()?))
    }

    /// The calls of instances of DFBs whose type the program holds, with its unit and interface.
    pub fn instance_calls(&self) -> impl Iterator<Item = (&GlobalCall<'a>, &str, u32, &'a Interface)> {
        self.calls.iter().filter_map(|call| {
            let Callee::Instance(name) = &call.it.callee else { return None };
            let (unit, interface) = self.dfb_of(name)?;
            Some((call, name.as_str(), unit, interface))
        })
    }

    /// The object that a call gives to a parameter.
    pub fn given_object(&self, unit: u32, actual: &Actual) -> Option<&'a Object> {
        let Given::Object(id) = actual.given else { return None };
        Some(&self.units.get(unit as usize)?.objects.get(id.0 as usize)?.object)
    }

    /// Whether a symbol names an address, so that it is no instance of a DFB.
    pub fn names_address(&self, symbol: &str) -> bool {
        let name = key(symbol);
        let mut symbols = self.units.iter().flat_map(|it| &it.symbols);
        symbols.any(|it| it.object.is_some() && key(&it.name) == name)
    }
}

fn as_index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum UnitName {
    Subroutine(u32),
    Block(BlockName),
    /// An instance of a DFB, by the key of its name: the unit is its type.
    Instance(SmolStr),
}

/// What the units of a program call.
#[derive(Clone, Copy)]
struct Callees<'c, 'a> {
    calls: &'c [GlobalCall<'a>],
    /// See [`Skeleton::first_calls`].
    first: &'c [u32],
}

impl<'c, 'a> Callees<'c, 'a> {
    fn of(self, unit: u32) -> &'c [GlobalCall<'a>] {
        let place = |at: usize| self.first.get(at).map(|it| *it as usize);
        let range = place(unit as usize).zip(place(unit as usize + 1));
        range.and_then(|(start, end)| self.calls.get(start..end)).unwrap_or_default()
    }
}

fn unit_names(units: &[&UnitFacts]) -> FxHashMap<UnitName, u32> {
    let mut names = FxHashMap::default();
    for (at, facts) in units.iter().enumerate() {
        let name = match &facts.entity {
            Entity::Pl7 { part: Part::Subroutine(number), .. } => UnitName::Subroutine(*number),
            Entity::Block { name, .. } => UnitName::Block(name.clone()),
            _ => continue,
        };
        names.entry(name).or_insert(as_index(at));
    }
    let types: FxHashMap<SmolStr, u32> = (0..)
        .zip(units)
        .filter_map(|(at, facts)| match &facts.entity {
            Entity::Dfb { name } => Some((key(name), at)),
            _ => None,
        })
        .collect();
    let symbols = units.iter().flat_map(|it| &it.symbols).filter(|it| it.object.is_none());
    for symbol in symbols {
        if let Some(&at) = types.get(&key(&symbol.ty)) {
            names.entry(UnitName::Instance(key(&symbol.name))).or_insert(at);
        }
    }
    names
}

fn target(facts: &UnitFacts, callee: &Callee) -> Option<UnitName> {
    match callee {
        Callee::Subroutine(number) => Some(UnitName::Subroutine(*number)),
        Callee::Block(name) => Some(UnitName::Block(name.clone())),
        Callee::Instance(name) => Some(UnitName::Instance(key(name))),
        Callee::LocalInstance(name) => Some(UnitName::Block(facts.type_of_instance(name)?.clone())),
        Callee::Function(_) | Callee::Unknown => None,
    }
}

fn is_entry(entity: &Entity) -> bool {
    match entity {
        Entity::Pl7 { part, .. } => !matches!(part, Part::Subroutine(_)),
        Entity::Block { kind, .. } => *kind == BlockKind::Ob,
        Entity::Listing => true,
        Entity::Dfb { .. } | Entity::Container => false,
    }
}

/// The context that an entry point makes by itself.
fn own_context(facts: &UnitFacts) -> Option<Context> {
    match &facts.entity {
        Entity::Pl7 { task: Task::Mast, .. } => Some(Context::Cyclic),
        Entity::Pl7 { task: Task::Fast, .. } => Some(Context::Fast),
        Entity::Pl7 { task: Task::Event(number), .. } => Some(Context::Event(*number)),
        Entity::Pl7 { task: Task::Numbered(number), .. } => Some(Context::Task(*number)),
        Entity::Block { name: BlockName::Number(BlockKind::Ob, number), .. } => Some(match number {
            1 => Context::Cyclic,
            // GRF:415, 967-978: after a stop, and after a power failure.
            20..=22 if matches!(facts.language, Language::Step5(_)) => Context::Startup,
            100..=102 if !matches!(facts.language, Language::Step5(_)) => Context::Startup,
            other => Context::Interrupt(*other),
        }),
        Entity::Listing => Some(Context::Cyclic),
        Entity::Block { .. } | Entity::Dfb { .. } | Entity::Container => None,
    }
}

/// Contexts of each unit, and whether they are known.
fn contexts(units: &[&UnitFacts], callees: Callees<'_, '_>) -> (Vec<SmallVec<[Context; 2]>>, Vec<bool>) {
    let mut contexts: Vec<SmallVec<[Context; 2]>> = vec![SmallVec::new(); units.len()];
    for (unit, facts) in units.iter().enumerate() {
        let Some(context) = own_context(facts).filter(|_| is_entry(&facts.entity)) else { continue };
        let mut stack = vec![as_index(unit)];
        while let Some(at) = stack.pop() {
            if !contexts[at as usize].contains(&context) {
                contexts[at as usize].push(context);
                stack.extend(callees.of(at).iter().filter(|it| it.it.reachable).filter_map(|it| it.target));
            }
        }
    }
    let reached = contexts.iter().map(|it| !it.is_empty()).collect();
    for (unit, list) in contexts.iter_mut().enumerate() {
        if list.is_empty() {
            list.push(own_context(units[unit]).unwrap_or(Context::Cyclic));
        }
        list.sort_unstable();
    }
    (contexts, reached)
}

/// Which units surely run. What belongs to a step of a chart runs while the step is active, a section that has a condition
/// while that is 1.
fn sure(units: &[&UnitFacts], callees: Callees<'_, '_>) -> Vec<bool> {
    let is_chart = |it: &Entity| matches!(it, Entity::Pl7 { part: Part::Chart(_), .. });
    let is_sure = |it: &UnitFacts| is_entry(&it.entity) && !is_chart(&it.entity) && it.condition.is_none();
    let mut sure: Vec<bool> = units.iter().map(|it| is_sure(it)).collect();
    let mut stack: Vec<u32> = (0..as_index(units.len())).filter(|&it| sure[it as usize]).collect();
    while let Some(at) = stack.pop() {
        let calls = callees.of(at).iter().filter(|it| it.it.reachable && !it.it.conditional);
        for callee in calls.filter_map(|it| it.target) {
            if !std::mem::replace(&mut sure[callee as usize], true) {
                stack.push(callee);
            }
        }
    }
    sure
}

/// Depth-first from the entry points in file order, callees where they are called; then what nothing calls. The parts of a
/// PL7-2 program have an order of their own, wherever they are written.
fn order(family: Family, units: &[&UnitFacts], callees: Callees<'_, '_>) -> Vec<u32> {
    let mut order = vec![u32::MAX; units.len()];
    let mut next = 0;
    let mut entries: Vec<usize> = (0..units.len()).filter(|&it| is_entry(&units[it].entity)).collect();
    match family {
        Family::Pl72 => entries.sort_by_key(|&it| pl7_2_rank(&units[it].entity)),
        Family::Pl7 => order_sections(units, &mut entries),
        Family::Step5 | Family::Step7 => {}
    }
    let mut stack = Vec::new();
    for root in entries.into_iter().chain(0..units.len()) {
        stack.push(as_index(root));
        while let Some(at) = stack.pop() {
            if order[at as usize] != u32::MAX {
                continue;
            }
            order[at as usize] = next;
            next += 1;
            let called = callees.of(at).iter().rev().filter_map(|it| it.target);
            stack.extend(called.filter(|&it| order[it as usize] == u32::MAX));
        }
    }
    order
}

/// The parts of a Grafcet section run one after the other wherever they are written: preliminary processing, chart, posterior
/// processing (PL7:4895). They take the place of the first of them.
fn order_sections(units: &[&UnitFacts], entries: &mut [usize]) {
    let part = |it: usize| match &units[it].entity {
        Entity::Pl7 { task, section, part: Part::Preliminary } => Some(((*task, section.as_ref()), 0)),
        Entity::Pl7 { task, section, part: Part::Chart(_) } => Some(((*task, section.as_ref()), 1)),
        Entity::Pl7 { task, section, part: Part::Posterior } => Some(((*task, section.as_ref()), 2)),
        _ => None,
    };
    let mut first = FxHashMap::default();
    for &it in entries.iter() {
        if let Some((section, _)) = part(it) {
            first.entry(section).or_insert(it);
        }
    }
    entries.sort_by_cached_key(|&it| match part(it) {
        Some((section, rank)) => (first.get(&section).copied().unwrap_or(it), rank),
        None => (it, 0),
    });
}

/// Preliminary, sequential, posterior processing of the master task (PL72:1505-1511); the fast task interrupts them.
fn pl7_2_rank(entity: &Entity) -> u32 {
    match entity {
        Entity::Pl7 { task: Task::Mast, part: Part::Preliminary, .. } => 0,
        Entity::Pl7 { task: Task::Mast, part: Part::Chart(_), .. } => 1,
        Entity::Pl7 { task: Task::Mast, .. } => 2,
        _ => 3,
    }
}

/// Whether the units hold the program's cyclic entry point. The master task of PL7-2 is one text, or the parts of a Grafcet
/// program, of which none but the chart must be there (PL72:1505-1511).
fn has_main(family: Family, units: &[&UnitFacts]) -> bool {
    let is_named = units.iter().any(|it| match (family, &it.entity) {
        // A cross-reference is one of a whole project.
        _ if it.language == Language::Pl7Xref => true,
        (Family::Pl72, Entity::Pl7 { task, part, .. }) => {
            *task == Task::Mast && matches!(part, Part::Main | Part::Chart(_))
        }
        (_, Entity::Pl7 { part: Part::Main, .. }) => true,
        (_, Entity::Block { name: BlockName::Number(BlockKind::Ob, 1), .. }) => true,
        _ => false,
    });
    is_named || family == Family::Pl7 && has_chart(units)
}

/// Whether the master task of PL7 runs a chart that is all of it: the text has the initial steps, and the code before or
/// behind the chart, or actions that drive outputs. A chart that drives none by itself was exported without its posterior
/// processing.
fn has_chart(units: &[&UnitFacts]) -> bool {
    let is_initial = |it: &UnitFacts| {
        let chart = it.chart.as_ref().filter(|chart| chart.defines);
        chart.is_some_and(|chart| chart.steps.iter().any(|step| step.kind == StepKind::Initial))
    };
    let is_chart = |it: &UnitFacts| matches!(it.entity, Entity::Pl7 { task: Task::Mast, part: Part::Chart(_), .. });
    let is_around = |it: &UnitFacts| {
        matches!(it.entity, Entity::Pl7 { task: Task::Mast, part: Part::Preliminary | Part::Posterior, .. })
    };
    let drives = |it: &UnitFacts| {
        let class = |object: u32| it.objects.get(object as usize).map(|it| it.object.class);
        it.uses.iter().any(|it| it.mode.writes() && class(it.object) == Some(Class::Output))
    };
    units.iter().any(|it| is_chart(it) && is_initial(it)) && units.iter().any(|it| is_around(it) || drives(it))
}

/// An FB without its call, a listing pasted from a course: such texts are part of something that was not read.
fn is_complete(family: Family, units: &[&UnitFacts], calls: &[GlobalCall<'_>]) -> bool {
    let entry = has_main(family, units) && !units.iter().any(|it| it.has_gaps || it.is_fragment);
    let closed = calls.iter().all(|call| match &call.it.callee {
        Callee::Block(BlockName::Number(kind, _)) if kind.is_system() => true,
        Callee::Block(name) if family == Family::Step5 && step5::is_function(name) => true,
        Callee::Subroutine(_) | Callee::Block(_) => call.target.is_some(),
        Callee::Unknown => false,
        Callee::LocalInstance(_) | Callee::Function(_) | Callee::Instance(_) => true,
    });
    entry && closed
}

/// What is done to the object of a use: of an actual parameter, what the called block of the program does with it.
pub(super) fn actual_mode(skeleton: &Skeleton<'_>, unit: u32, it: &Use) -> Mode {
    let Some((call, formal)) = it.parameter() else { return it.mode };
    let Some(target) = skeleton.target_of(unit, *call) else { return it.mode };
    let facts = skeleton.units[target as usize];
    match formal {
        Formal::Name(name) => {
            let mut declared = facts.declared.as_deref().map_or(&[][..], DataType::fields).iter();
            let declared = declared.find(|it| it.name.eq_ignore_ascii_case(name));
            match declared.map(|it| it.section) {
                Some(Section::Input) => Mode::Read,
                Some(Section::Output) => Mode::Output,
                _ => it.mode,
            }
        }
        // What cannot be written is not, whatever the call asks for: rule F014 says so.
        Formal::Slot(_) if it.mode == Mode::Read => it.mode,
        Formal::Slot(slot) => match facts.interface.as_ref().and_then(|it| it.parameter(*slot)).map(|it| it.role) {
            Some(Role::Input) => Mode::Read,
            Some(Role::Output) => Mode::Output,
            Some(Role::InOut) => Mode::InOut,
            _ => it.mode,
        },
    }
}

fn collect<'a>(skeleton: &Skeleton<'a>, wanted: impl Fn(&Object) -> bool) -> Vec<ObjectUses<'a>> {
    let units = &skeleton.units;
    let mut by_rank: Vec<u32> = (0..as_index(units.len())).collect();
    by_rank.sort_by_key(|&it| skeleton.order[it as usize]);
    // Which object of the program each object of each unit is.
    let mut ids: HashTable<u32> = HashTable::new();
    let mut firsts: Vec<&'a FactObject> = Vec::new();
    let mut numbers: Vec<bool> = Vec::new();
    let mut counts: Vec<usize> = Vec::new();
    let mut locals: Vec<Vec<Option<u32>>> = vec![Vec::new(); units.len()];
    for &unit in &by_rank {
        let facts = units[unit as usize];
        let local = &mut locals[unit as usize];
        local.extend(facts.objects.iter().map(|fact| {
            if !facts::is_shared(&fact.object) || !wanted(&fact.object) {
                return None;
            }
            let next = as_index(firsts.len());
            let is_same = |&id: &u32| fact.is_same(firsts[id as usize]);
            let id = *ids.entry(fact.hash, is_same, |&id| firsts[id as usize].hash).or_insert(next).get();
            if id == next {
                firsts.push(fact);
                numbers.push(false);
                counts.push(0);
            }
            numbers[id as usize] |= fact.number;
            Some(id)
        }));
        if local.iter().all(Option::is_none) {
            local.clear();
            continue;
        }
        for it in &facts.uses {
            if let Some(Some(id)) = local.get(it.object as usize) {
                counts[*id as usize] += 1;
            }
        }
    }
    let object = |((fact, number), count): ((&&'a FactObject, bool), usize)| ObjectUses {
        number,
        ..ObjectUses::with_capacity(&fact.object, count)
    };
    let mut objects: Vec<ObjectUses<'a>> = firsts.iter().zip(numbers).zip(counts).map(object).collect();
    by_rank.retain(|it| !locals[*it as usize].is_empty());
    for unit in by_rank {
        for it in &units[unit as usize].uses {
            if let Some(Some(id)) = locals[unit as usize].get(it.object as usize) {
                objects[*id as usize].push(skeleton, unit, it);
            }
        }
    }
    objects.retain(|it| !it.uses.is_empty());
    // Areas hold names: they are compared once each, not once a comparison of objects.
    let mut areas: Vec<&Area> =
        objects.iter().map(|it| &it.object.footprint.area).collect::<FxHashSet<_>>().into_iter().collect();
    areas.sort_unstable();
    let ranks: FxHashMap<&Area, u32> = areas.into_iter().zip(0..).collect();
    let key = |(at, it): (u32, &ObjectUses<'_>)| {
        let place = &it.object.footprint;
        let rank = ranks.get(&place.area).copied().unwrap_or(u32::MAX);
        // Those of one place stay in the order in which the program comes across them.
        [rank, place.start, u32::MAX - place.bits, at].into_iter().fold(0, |key, it| key << 32 | u128::from(it))
    };
    let mut keys: Vec<u128> = (0..).zip(&objects).map(key).collect();
    keys.sort_unstable();
    let mut objects: Vec<Option<ObjectUses<'a>>> = objects.into_iter().map(Some).collect();
    keys.into_iter().filter_map(|it| objects.get_mut((it & u128::from(u32::MAX)) as usize)?.take()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::lower;
    use crate::source::entity_from_address;
    use crate::syntax::{self, Language};

    fn units(addresses: &[&str]) -> Vec<UnitFacts> {
        let parse = syntax::parse(Language::Pl7St, "");
        let unit = |address: &&str| {
            let entity = entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
            UnitFacts::new(&lower::lower(parse.syntax(), "", entity, Language::Pl7St))
        };
        addresses.iter().map(unit).collect()
    }

    #[test]
    fn entry_points_of_pl7_2() {
        let complete = |addresses: &[&str]| {
            let units = units(addresses);
            ProgramIndex::new(Family::Pl72, units.iter().collect()).complete
        };
        assert!(complete(&["PL7-2 MAST", "PL7-2 FAST"]));
        assert!(complete(&["PL7-2 PRL", "PL7-2 SEQ", "PL7-2 POST"]));
        assert!(complete(&["PL7-2 SEQ"]));
        assert!(!complete(&["PL7-2 PRL", "PL7-2 POST"]));
        assert!(!complete(&["PL7-2 FAST"]));
    }

    #[test]
    fn a_chart_that_is_all_of_the_master_task() {
        let chart = |action: &str| {
            format!(
                "PROGRAM MAST 'Chart'\nPAGE 0\nINITIAL_STEP 0 AT (C 4,L 3) : END_STEP\nSTEP 1 AT (C 4,L 5) :\n\
                 ACTION (N1,ST) : (*PHRASE*) {action} (*END_PHRASE*) END_ACTION\nEND_STEP\nEND_PAGE\nEND_PROGRAM\n"
            )
        };
        let unit = |address: &str, text: &str, language| {
            let parse = syntax::parse(language, text);
            assert_eq!(parse.errors(), [], "{text}");
            let entity = entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
            UnitFacts::new(&lower::lower(parse.syntax(), text, entity, language))
        };
        let page = |address: &str, action: &str| unit(address, &chart(action), Language::Pl7Gr7);
        let complete = |units: &[UnitFacts]| ProgramIndex::new(Family::Pl7, units.iter().collect()).complete;
        assert!(complete(&[page("MAST - CHART", "SET %Q2.0;")]));
        assert!(!complete(&[page("MAST - CHART", "SET %M0;")]), "what drives the outputs is elsewhere");
        let post = unit("MAST - POST", "", Language::Pl7St);
        assert!(complete(&[page("MAST - CHART", "SET %M0;"), post.clone()]));
        assert!(!complete(&[post]));
        // An action shown alone is no chart.
        let action = unit("MAST - CHART - PAGE 0 %X1 P1", "! SET %Q2.0;", Language::Pl7St);
        assert!(!complete(&[action]));
    }

    #[test]
    fn tasks_interrupt_one_another() {
        let units = units(&["MAST - MAIN", "FAST - MAIN", "EVT0", "EVT1", "EVT2", "MAST - SR1"]);
        let program = ProgramIndex::new(Family::Pl7, units.iter().collect());
        assert!(program.in_other_tasks(0, 1) && program.in_other_tasks(1, 3) && program.in_other_tasks(2, 3));
        assert!(!program.in_other_tasks(3, 4), "events of one priority");
        assert!(!program.in_other_tasks(1, 5), "nothing calls the subroutine");
        assert_eq!((program.task_names(1), program.task_names(5)), ("FAST".to_owned(), String::new()));
        let obs: Vec<UnitFacts> = self::units(&["OB1", "OB35", "OB100", "OB82", "OB86"]);
        let program = ProgramIndex::new(Family::Step7, obs.iter().collect());
        assert!(program.in_other_tasks(0, 1) && program.in_other_tasks(1, 3));
        assert!(!program.in_other_tasks(0, 2), "start-up is over when the cycle begins");
        assert!(!program.in_other_tasks(3, 4), "errors have one priority");
    }

    #[test]
    fn parts_of_pl7_2_run_in_their_own_order() {
        let units = units(&["PL7-2 FAST", "PL7-2 POST", "PL7-2 SEQ - X1", "PL7-2 PRL", "PL7-2 SEQ"]);
        let order = |family| ProgramIndex::new(family, units.iter().collect()).order.clone();
        assert_eq!(order(Family::Pl72), [4, 3, 1, 0, 2]);
        assert_eq!(order(Family::Step7), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn the_parts_of_a_grafcet_section_follow_each_other() {
        let units = units(&[
            "MAST - P - CHART - PAGE 0",
            "MAST - P - POST",
            "MAST - Q",
            "MAST - P - PRL",
            "MAST - P - CHART - PAGE 1",
            "FAST - MAIN",
        ]);
        let order = ProgramIndex::new(Family::Pl7, units.iter().collect()).order.clone();
        assert_eq!(order, [1, 3, 4, 0, 2, 5]);
    }
}

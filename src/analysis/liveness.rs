//! Values that nothing can read: a write that others surely override before anything looks at the object.
//!
//! Statements are walked once, in the order of their execution. A write waits until something reads the object, or any part
//! of its memory, under a condition that can hold together with the write's own; until code runs that may read anything (a
//! call, a place computed at run time); or until writes of all of it, under conditions of which one surely holds, make it
//! lost. A loop is no obstacle when the write and those that override it stand in its body together: the value does not
//! outlive the pass.
//!
//! What is written has an effect of its own in some areas (the periphery, system objects, blocks), which are left out.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::conditions::{Lessons, Space, Verdict};
use super::facts::UnitFacts;
use super::program::{GlobalUse, ObjectUses, ProgramIndex};
use crate::model::UnitModel;
use crate::model::dfb::Role;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId};
use crate::model::granules::Granules;
use crate::model::object::{Area, Class, Footprint, Object, Type};
use crate::model::unit::{Access, Mode, Statement, StatementKind};
use crate::syntax::Language;

/// A write whose value nothing reads. It holds no position, so that it may leave the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lost {
    /// Anchor of the write.
    pub write: u32,
    /// Anchors of the writes that override it, in the order of execution; the last one settles it.
    pub by: Box<[u32]>,
    /// Whether the object is one of the unit alone.
    pub local: bool,
}

/// So many writes wait for one stretch of memory; the oldest is let go. So many writes together may override one.
const MOST_WAITING: usize = 16;

/// Conditions that are larger are not compared.
const LONGEST: usize = 128;

/// The writes of a unit that are lost. A unit that is not understood has none.
pub fn lost(model: &UnitModel) -> Vec<Lost> {
    if model.has_gaps || model.language == Language::Pl7Xref {
        return Vec::new();
    }
    let lessons = Lessons::default();
    let mut walk = Walk {
        model,
        space: Space::of(model).learning(&lessons),
        waiting: Vec::new(),
        lists: Lists::new(&model.granules),
        met: Vec::new(),
        found: Vec::new(),
    };
    let mut part = None;
    let mut accesses = model.accesses.iter().peekable();
    for (at, statement) in (0..).zip(&model.statements) {
        while let Some(access) = accesses.next_if(|it| it.statement <= at) {
            // Between the pieces of code of a chart, those of other pages may run.
            let chart = model.chart.as_deref();
            let here = chart.and_then(|it| it.action_at(access.anchor)).map(|it| it.anchors.start);
            if chart.is_some() && (here != part || here.is_none()) {
                walk.lists.clear();
                part = here;
            }
            walk.access(access, statement);
        }
        if acts_on_anything(model, statement) {
            walk.lists.clear();
        }
    }
    walk.found
}

/// Whether code runs that may read any object, or control may go where paths do not tell.
fn acts_on_anything(model: &UnitModel, statement: &Statement) -> bool {
    match statement.kind {
        StatementKind::Call(_) | StatementKind::Other | StatementKind::Exit | StatementKind::Halt => true,
        // A text block sends the words that it was given, a drum drives bits.
        StatementKind::Drive { access, .. } => {
            model.accesses.get(access as usize).is_none_or(|it| model.object(it.object).class == Class::Block)
        }
        _ => false,
    }
}

/// A write that nothing has read yet.
struct Waiting<'a> {
    access: &'a Access,
    value: ExprId,
    in_loop: Option<u32>,
    /// Conditions under which others have overridden it, and their anchors.
    overridden: Vec<[ExprId; 2]>,
    by: Vec<u32>,
    /// Neither read nor lost.
    open: bool,
}

struct Walk<'a> {
    model: &'a UnitModel,
    space: Space<'a>,
    waiting: Vec<Waiting<'a>>,
    lists: Lists,
    /// What shares memory with the place that is looked at.
    met: Vec<u32>,
    found: Vec<Lost>,
}

/// Indices of what waits, by granule. A list may hold some that wait no more.
struct Lists {
    lists: Vec<List>,
    /// Counts what was cleared. A list from before its area was cleared is empty.
    now: u32,
    /// When all areas were cleared, and when each was.
    all: u32,
    areas: Vec<u32>,
}

#[derive(Clone, Default)]
struct List {
    since: u32,
    waiting: Vec<u32>,
}

impl Lists {
    fn new(granules: &Granules) -> Self {
        let (lists, areas) = (vec![List::default(); granules.count()], vec![0; granules.areas().len()]);
        Self { lists, now: 0, all: 0, areas }
    }

    fn clear(&mut self) {
        self.now += 1;
        self.all = self.now;
    }

    fn clear_area(&mut self, area: u32) {
        self.now += 1;
        if let Some(it) = self.areas.get_mut(area as usize) {
            *it = self.now;
        }
    }

    /// When an area was cleared last.
    fn cleared(&self, area: u32) -> u32 {
        self.areas.get(area as usize).map_or(self.all, |it| self.all.max(*it))
    }

    fn get(&self, area: u32, granule: u32) -> &[u32] {
        let list = self.lists.get(granule as usize).filter(|it| it.since >= self.cleared(area));
        list.map_or(&[], |it| &it.waiting)
    }

    fn list(&mut self, area: u32, granule: u32) -> Option<&mut Vec<u32>> {
        let (now, cleared) = (self.now, self.cleared(area));
        let list = self.lists.get_mut(granule as usize)?;
        if list.since < cleared {
            list.since = now;
            list.waiting.clear();
        }
        Some(&mut list.waiting)
    }
}

impl<'a> Walk<'a> {
    fn access(&mut self, access: &'a Access, statement: &'a Statement) {
        let object = self.model.object(access.object);
        if access.path == Exprs::FALSE {
            return;
        }
        let (value, when) = match statement.kind {
            StatementKind::Assign { access: of, value } | StatementKind::Store { access: of, value }
                if self.is(of, access) =>
            {
                (Some(value), Exprs::TRUE)
            }
            StatementKind::Set { access: of, when } | StatementKind::Reset { access: of, when }
                if self.is(of, access) =>
            {
                (None, when)
            }
            _ => {
                self.read(access);
                return;
            }
        };
        if !object.is_fixed() {
            // It may be any of them, and writes all of none.
            return;
        }
        self.write(access, statement, value, when);
        if let Some(value) = value.filter(|_| self.can_be_lost(object)) {
            let (overridden, by) = (Vec::new(), Vec::new());
            self.wait(Waiting { access, value, in_loop: statement.in_loop, overridden, by, open: true });
        }
    }

    fn is(&self, of: u32, access: &Access) -> bool {
        self.model.accesses.get(of as usize).is_some_and(|it| std::ptr::eq(it, access))
    }

    /// Something may look at the object.
    fn read(&mut self, access: &Access) {
        let object = self.model.object(access.object);
        // One that is too wide reads the whole area, and overrides nothing where it is written.
        let is_wide = self.model.granules.of(access.object).is_empty();
        match &object.footprint.area {
            Area::Indirect => self.lists.clear(),
            _ if !object.is_fixed() && object.class == Class::Symbol => self.lists.clear(),
            // Where the parts of a symbol lie is not known, nor how large it is.
            area if !object.is_fixed() || matches!(area, Area::Symbol(_)) || is_wide => {
                self.lists.clear_area(self.model.granules.area(access.object));
            }
            area => {
                // Which block is open, and whose instance this is, is not known.
                if matches!(area, Area::OpenData | Area::OpenInstance) {
                    self.clear_areas(|it| matches!(it, Area::Data(_)));
                }
                if matches!(area, Area::OpenData | Area::Data(_)) {
                    self.clear_areas(|it| *it == Area::OpenInstance);
                }
                let path = access.path;
                self.each(access.object, |walk, at| {
                    let waiting = &walk.waiting[at];
                    let (write, overridden) = (waiting.access.path, &waiting.overridden);
                    let apart = write != path
                        && walk.is_short(&[write, path])
                        && walk.space.without(&[write, path], overridden) == Verdict::Never;
                    walk.waiting[at].open = apart;
                });
            }
        }
    }

    fn clear_areas(&mut self, wanted: impl Fn(&Area) -> bool) {
        let is_wanted = |it: &(u32, &ObjectId)| wanted(&self.model.object(*it.1).footprint.area);
        let areas = (0..).zip(self.model.granules.areas());
        areas.filter(is_wanted).for_each(|it| self.lists.clear_area(it.0));
    }

    fn write(&mut self, access: &'a Access, statement: &Statement, value: Option<ExprId>, when: ExprId) {
        let (path, in_loop, anchor) = (access.path, statement.in_loop, access.anchor);
        self.each(access.object, |walk, at| {
            let waiting = &mut walk.waiting[at];
            let written = &walk.model.object(waiting.access.object).footprint;
            if !walk.model.object(access.object).footprint.contains(written)
                || waiting.in_loop != in_loop
                || waiting.by.len() >= MOST_WAITING
            {
                return;
            }
            waiting.by.push(anchor);
            let write = waiting.access.path;
            let straight_on = write == path && when == Exprs::TRUE;
            if !straight_on {
                waiting.overridden.push([path, when]);
            }
            let waiting = &walk.waiting[at];
            let surely = straight_on
                || walk.is_short(&[write, path, when])
                    && walk.space.without(&[write], &waiting.overridden) == Verdict::Never;
            if !surely {
                return;
            }
            // What takes the same value again has lost nothing; a constant before the branches is a default, and what is cleared
            // first is cleared to be sure.
            let (is_constant, is_clear) = match *walk.model.exprs.get(waiting.value) {
                Expr::Bool(it) => (true, !it),
                Expr::Int(it) => (true, it == 0),
                Expr::Float(it) => (true, f64::from_bits(it) == 0.0),
                Expr::Text(_) => (true, false),
                _ => (false, false),
            };
            let is_lost = value != Some(waiting.value) && !is_clear && (straight_on || !is_constant);
            // Where control never comes by, nothing is written.
            if is_lost && (write == Exprs::TRUE || walk.space.together(&[write]) != Verdict::Never) {
                let local = is_local(written);
                let by = waiting.by.clone().into_boxed_slice();
                walk.found.push(Lost { write: waiting.access.anchor, by, local });
            }
            walk.waiting[at].open = false;
        });
    }

    fn is_short(&self, conditions: &[ExprId]) -> bool {
        conditions.iter().all(|&it| self.model.exprs.is_within(it, LONGEST))
    }

    fn wait(&mut self, it: Waiting<'a>) {
        let granules = &self.model.granules;
        let (area, of) = (granules.area(it.access.object), granules.of(it.access.object));
        let Ok(at) = u32::try_from(self.waiting.len()) else { return };
        self.waiting.push(it);
        for &granule in of {
            let Some(list) = self.lists.list(area, granule) else { continue };
            list.retain(|&it| self.waiting[it as usize].open);
            if list.len() >= MOST_WAITING {
                self.waiting[list.remove(0) as usize].open = false;
            }
            list.push(at);
        }
    }

    /// Everything that waits and shares memory with an object.
    fn each(&mut self, object: ObjectId, mut each: impl FnMut(&mut Self, usize)) {
        let place = &self.model.object(object).footprint;
        let (area, granules) = (self.model.granules.area(object), self.model.granules.of(object));
        let mut met = std::mem::take(&mut self.met);
        met.clear();
        granules.iter().for_each(|it| met.extend_from_slice(self.lists.get(area, *it)));
        if granules.len() > 1 {
            met.sort_unstable();
            met.dedup();
        }
        for &at in &met {
            let waiting = &self.waiting[at as usize];
            if waiting.open && self.model.object(waiting.access.object).footprint.overlaps(place) {
                each(self, at as usize);
            }
        }
        self.met = met;
    }

    /// Whether a value of the object has no effect but that something may read it in this scan or a later one.
    fn can_be_lost(&self, object: &Object) -> bool {
        match object.class {
            Class::Output | Class::Memory | Class::Symbol | Class::LocalData => true,
            // Which block is open is not known.
            Class::Data | Class::InstanceData | Class::LocalName => match &object.footprint.area {
                Area::Data(_) | Area::Local => true,
                Area::OpenInstance => !self.model.opens_instance,
                // What a caller gave, a function may have under two names.
                Area::LocalName(name) => self.model.interface.as_ref().is_some_and(|it| {
                    let item = it.items.iter().find(|it| it.name.eq_ignore_ascii_case(name));
                    item.is_some_and(|it| it.role != Role::InOut)
                }),
                _ => false,
            },
            _ => false,
        }
    }
}

fn is_local(place: &Footprint) -> bool {
    matches!(place.area, Area::Local | Area::LocalName(_) | Area::OpenInstance)
}

/// What a unit loses of objects that are its own, with their numbers. A variable that lies in a data block which others look
/// into is not: it has a place there.
fn owned(facts: &UnitFacts) -> impl Iterator<Item = (&Lost, u32)> {
    let mut local = facts.lost.iter().filter(|it| it.local).peekable();
    let mut written: FxHashMap<u32, u32> = FxHashMap::default();
    for it in facts.uses.iter().filter(|_| local.peek().is_some()) {
        written.entry(it.anchor).or_insert(it.object);
    }
    let is_own = |it: u32| facts.objects.get(it as usize).is_some_and(|it| is_local(&it.object.footprint));
    local.filter_map(move |it| Some((it, written.get(&it.write).copied().filter(|it| is_own(*it))?)))
}

/// The writes of one object that are lost in one unit.
pub struct LostWrites<'a> {
    pub unit: u32,
    /// As written.
    pub text: &'a str,
    /// In the order of execution.
    pub writes: Vec<&'a Lost>,
}

/// What the units of a program lose, without what other code may see between the write and the one that overrides it, and
/// without the bits of which [`drives`](super::drives) tells that they are driven in several places.
pub fn of_program<'a, 'n>(program: &'a ProgramIndex<'a>, neighbours: impl Fn(u32) -> &'n [u32]) -> Vec<LostWrites<'a>> {
    let mut found = Vec::new();
    for (unit, facts) in program.judged_units() {
        let mut own: BTreeMap<u32, Vec<&Lost>> = BTreeMap::new();
        for (it, object) in owned(facts) {
            own.entry(object).or_default().push(it);
        }
        found.extend(own.into_iter().filter_map(|(object, writes)| {
            let text = facts.objects.get(object as usize)?.object.text.as_str();
            Some(LostWrites { unit, text, writes })
        }));
    }
    let mut shared: FxHashMap<u32, FxHashMap<u32, &Lost>> = FxHashMap::default();
    for (at, uses) in (0..).zip(&program.objects) {
        let lost = |it: &'a GlobalUse<'a>| {
            let facts = program.units.get(it.unit as usize).filter(|it| !it.lost.is_empty())?;
            let all = || {
                let own: Vec<u32> = owned(facts).map(|it| it.0.write).collect();
                facts.lost.iter().filter(|it| !own.contains(&it.write)).map(|it| (it.write, it)).collect()
            };
            Some((it, *shared.entry(it.unit).or_insert_with(all).get(&it.it.anchor)?))
        };
        let writes: Vec<_> = uses.with_mode(|it| it.assigns() || it == Mode::Store).filter_map(lost).collect();
        if writes.is_empty() || is_driven_by_others(program, uses, neighbours(at)) {
            continue;
        }
        let mut lists: BTreeMap<u32, LostWrites<'_>> = BTreeMap::new();
        for (it, lost) in writes {
            let around = neighbours(at).iter().filter_map(|&it| program.objects.get(it as usize));
            let mut reads = around.chain([uses]).flat_map(|it| it.with_mode(|it| !it.assigns() && it != Mode::Store));
            if !reads.any(|read| may_see(program, it, lost, read)) {
                let text = program.text_of(it);
                let list = lists.entry(it.unit).or_insert_with(|| LostWrites { unit: it.unit, text, writes: vec![] });
                list.writes.push(lost);
            }
        }
        found.extend(lists.into_values());
    }
    found
}

/// Whether another rule speaks of the object: of bits that are driven more than once, and of outputs by words.
fn is_driven_by_others(program: &ProgramIndex<'_>, uses: &ObjectUses<'_>, neighbours: &[u32]) -> bool {
    let object = uses.object;
    let neighbour_is_written = || neighbours.iter().any(|&it| program.objects[it as usize].is_written());
    match object.class {
        Class::Output | Class::Memory | Class::Symbol
            if object.ty == Type::Bool || uses.has_mode(|it| matches!(it, Mode::Assign | Mode::AssignNot)) =>
        {
            !uses.is_scratch() || uses.has_mode(|it| matches!(it, Mode::Set | Mode::Reset))
        }
        Class::Output => neighbour_is_written(),
        // What nothing reads at all is another matter.
        _ => {
            !uses.is_read()
                && !neighbours.iter().any(|&it| program.objects[it as usize].is_read())
                && program.unseen(uses).is_complete()
        }
    }
}

/// Whether a read of the object, or of what shares memory with it, comes between: in code that interrupts the unit, or under
/// another name than the unit's.
fn may_see(program: &ProgramIndex<'_>, write: &GlobalUse<'_>, lost: &Lost, read: &GlobalUse<'_>) -> bool {
    if read.unit != write.unit {
        let (own, other) = (&program.contexts[write.unit as usize], &program.contexts[read.unit as usize]);
        return own != other || own.len() > 1;
    }
    let last = lost.by.last().copied().unwrap_or_default();
    let area = |it: &GlobalUse<'_>| {
        let of = program.units.get(it.unit as usize)?.objects.get(it.it.object as usize)?;
        Some(&of.object.footprint.area)
    };
    // What the unit knows for the same memory was looked at there.
    (lost.write..last).contains(&read.it.anchor) && area(read) != area(write)
}

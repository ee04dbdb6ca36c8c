//! One scan of a program, followed from block to block: what each bit is after each write, as a condition over what the
//! bits were when the scan began.
//!
//! A read of an object carries its version: 0 is the value at the start of the scan, each write makes another one. What a
//! version is worth is looked up in [`Trace::expand`]; conditions themselves keep the names that the program gives to
//! values, but for bits that are assigned and then read, which stand for their conditions.

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::code::{Act, How};
use crate::analysis::Site;
use crate::analysis::conditions::{Answer, Lessons, Objects, Space};
use crate::analysis::facts::UnitFacts;
use crate::analysis::program::{Context, ProgramIndex};
use crate::model::entity::{BlockName, Family};
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator, Replaced};
use crate::model::object::{Area, Class, Footprint, Object, Type, step7};
use crate::model::unit::{Callee, Formal};

/// A write of a scan.
#[derive(Debug, Clone)]
pub struct Event {
    pub how: How,
    pub object: ObjectId,
    /// Condition of a set or reset, with the conditions of all calls and jumps that lead to it; of an assignment or store,
    /// those alone.
    pub when: ExprId,
    /// What is assigned or stored, where it is understood.
    pub value: Option<ExprId>,
    pub site: Site,
    /// Network of its unit.
    pub network: u32,
    pub unit: u32,
    /// Which entry point it belongs to: events of different ones have no order.
    pub root: u32,
}

#[derive(Debug)]
pub struct Trace<'a> {
    pub exprs: Exprs,
    /// By [`ObjectId`]; the first are those of the program.
    pub objects: Vec<&'a Object>,
    /// In the order of execution.
    pub events: Vec<Event>,
    pub family: Family,
    /// Some calls were not followed: too deep, in a circle, or too many.
    pub is_cut: bool,
    /// Value of each version but the first of a bit.
    values: FxHashMap<(ObjectId, u32), ExprId>,
    /// Versions at the end of the scan.
    last: Vec<u32>,
    /// Under which condition a timer that is read was started.
    started: FxHashMap<(ObjectId, u32), ExprId>,
    /// All conditions that start a timer.
    starts: FxHashMap<ObjectId, Vec<ExprId>>,
    /// Bits that keep a value for the next scan, with the value.
    memories: FxHashMap<ObjectId, ExprId>,
    expanded: FxHashMap<ExprId, ExprId>,
    flattened: FxHashMap<ExprId, ExprId>,
    lessons: Lessons,
}

/// Objects of the program and of runs of its blocks.
struct Table<'a> {
    objects: Vec<&'a Object>,
    shared: FxHashMap<(&'a Footprint, Type, bool), ObjectId>,
    own: FxHashMap<(u32, &'a Footprint), ObjectId>,
    scopes: FxHashMap<(u32, Instance<'a>), u32>,
    /// By scope, area and byte: the objects of a run that lie there.
    places: FxHashMap<(u32, &'a Area, u32), Vec<ObjectId>>,
    /// Of each object, those that share memory with it.
    neighbours: Vec<Vec<ObjectId>>,
}

/// Where the variables of a run of a block lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Instance<'a> {
    /// Nowhere but in the run.
    None,
    Block(&'a BlockName),
    /// In those of the block that declares the instance: its scope, and the name as the call writes it.
    Local(u32, &'a str),
}

/// What a call gives: the object, and the place where it says so.
type Binding = FxHashMap<SmolStr, (ObjectId, Site)>;

/// By call: names of parameters in lower case, what is given for them, and the anchors of that.
type Arguments = FxHashMap<u32, Vec<(SmolStr, ObjectId, u32)>>;

/// By instance that a block declares: the variables of it that the block names, or its caller.
type Fields = FxHashMap<SmolStr, Vec<(SmolStr, ObjectId)>>;

struct Runner<'p, 'a> {
    program: &'p ProgramIndex<'a>,
    table: Table<'a>,
    trace: Trace<'a>,
    /// What a bit was last assigned, under which path.
    assigned: FxHashMap<ObjectId, (ExprId, ExprId)>,
    now: Vec<u32>,
    /// What a word was last given, where every path gives it.
    words: FxHashMap<(ObjectId, u32), ExprId>,
    first_call: Vec<usize>,
    stack: Vec<u32>,
    budget: usize,
    root: u32,
}

/// Blocks that call one another deeper than controllers allow are not followed.
const DEEPEST: usize = 16;

impl<'a> Trace<'a> {
    /// One scan: the cyclic program, then what interrupts it, each in its order.
    pub fn of_scan(program: &ProgramIndex<'a>) -> Self {
        let is_startup = |it: u32| program.is_startup(it);
        Self::new(program, |it| !is_startup(it))
    }

    /// The start-up blocks.
    pub fn of_startup(program: &ProgramIndex<'a>) -> Self {
        Self::new(program, |it| program.is_startup(it))
    }

    fn new(program: &ProgramIndex<'a>, wanted: impl Fn(u32) -> bool) -> Self {
        let mut units: Vec<u32> = (0..index(program.units.len())).filter(|&it| wanted(it)).collect();
        // The cyclic program before what interrupts it, each in its order.
        let is_interrupt = |it: u32| !program.contexts[it as usize].contains(&Context::Cyclic);
        units.sort_by_key(|&it| (is_interrupt(it), program.order[it as usize]));
        let total: usize = program.units.iter().filter_map(|it| it.code.as_ref()).map(|it| it.size()).sum();
        let mut first_call = Vec::with_capacity(program.units.len());
        let mut next = 0;
        for unit in &program.units {
            first_call.push(next);
            next += unit.calls.len();
        }
        let table = Table::new(program);
        let now = vec![0; table.objects.len()];
        let trace = Self {
            exprs: Exprs::default(),
            objects: Vec::new(),
            events: Vec::new(),
            family: program.family,
            is_cut: false,
            values: FxHashMap::default(),
            last: Vec::new(),
            started: FxHashMap::default(),
            starts: FxHashMap::default(),
            memories: FxHashMap::default(),
            expanded: FxHashMap::default(),
            flattened: FxHashMap::default(),
            lessons: Lessons::default(),
        };
        let mut runner = Runner {
            program,
            table,
            trace,
            assigned: FxHashMap::default(),
            now,
            words: FxHashMap::default(),
            first_call,
            stack: Vec::new(),
            budget: total.saturating_mul(4).saturating_add(100_000),
            root: 0,
        };
        for unit in units {
            // What nothing calls may run, too: who calls it was not read.
            if program.is_entry(unit) || program.callers[unit as usize].is_empty() {
                runner.root = unit;
                runner.run(unit, Instance::None, Exprs::TRUE, &Binding::default());
            }
        }
        let Runner { table, mut trace, now, .. } = runner;
        (trace.objects, trace.last) = (table.objects, now);
        trace
    }

    pub fn object(&self, id: ObjectId) -> &'a Object {
        self.objects[id.0 as usize]
    }

    /// A condition over the values at the start of the scan.
    pub fn expand(&mut self, condition: ExprId) -> ExprId {
        let (values, known) = (&self.values, &mut self.expanded);
        self.exprs.rewrite(condition, known, |exprs, id| match *exprs.get(id) {
            Expr::Read { object, version } => match values.get(&(object, version)) {
                Some(&value) if value != id => Replaced::As(value),
                _ => Replaced::By(id),
            },
            _ => Replaced::By(id),
        })
    }

    /// The same condition asked at the start of the scan.
    pub fn flatten(&mut self, condition: ExprId) -> ExprId {
        self.exprs.rewrite(condition, &mut self.flattened, |exprs, id| match *exprs.get(id) {
            Expr::Read { object, .. } => Replaced::By(exprs.read(object, 0)),
            Expr::Edge { object, rising, .. } => Replaced::By(exprs.edge(object, 0, rising)),
            _ => Replaced::By(id),
        })
    }

    /// The same condition in the next scan, when all that the program does not write stays as it is.
    pub fn next(&mut self, condition: ExprId) -> ExprId {
        let start = self.expand(condition);
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let mut reads = Vec::new();
        self.exprs.each_read(start, |it| reads.push(it));
        for read in reads {
            if let Expr::Read { object, version: 0 } = *self.exprs.get(read) {
                let end = self.end(object);
                known.insert(read, end);
            }
        }
        self.exprs.rewrite(start, &mut known, |_, id| Replaced::By(id))
    }

    /// Value of a bit at the end of the scan.
    pub fn end(&mut self, object: ObjectId) -> ExprId {
        let version = self.last.get(object.0 as usize).copied().unwrap_or(0);
        let read = self.exprs.read(object, version);
        self.expand(read)
    }

    /// Whether the scan gives a bit a value that is known here.
    pub fn is_written(&self, bit: ObjectId) -> bool {
        let last = self.last.get(bit.0 as usize).copied().unwrap_or(0);
        (1..=last).any(|version| self.values.contains_key(&(bit, version)))
    }

    /// Value of a bit at the start of the scan.
    pub fn start(&mut self, object: ObjectId) -> ExprId {
        self.exprs.read(object, 0)
    }

    /// Under which condition a timer was started whose state is read.
    pub fn started(&self, read: ExprId) -> Option<ExprId> {
        let Expr::Read { object, version } = *self.exprs.get(read) else { return None };
        self.started.get(&(object, version)).copied()
    }

    /// Whether a condition asks for a timer that runs from when a bit goes on.
    pub fn waits_since(&mut self, condition: ExprId, bit: ObjectId) -> bool {
        let mut starts: Vec<ExprId> = Vec::new();
        self.exprs.each_object(condition, |it| starts.extend(self.starts.get(&it).into_iter().flatten()));
        starts.into_iter().any(|it| {
            let it = self.expand(it);
            self.mentions(it, |object| object == bit)
        })
    }

    pub fn mentions(&self, condition: ExprId, wanted: impl Fn(ObjectId) -> bool) -> bool {
        let mut found = false;
        self.exprs.each_object(condition, |it| found |= wanted(it));
        found
    }

    /// The signals whose edges a condition asks for: it reads them, and bits that keep their values from the scan before.
    pub fn edges(&self, condition: ExprId) -> FxHashSet<ExprId> {
        let mut read: FxHashSet<ObjectId> = FxHashSet::default();
        self.exprs.each_object(condition, |it| {
            read.insert(it);
        });
        let kept = read.iter().filter_map(|it| self.memories.get(it).copied());
        kept.filter(|&it| self.mentions(it, |it| read.contains(&it)) || self.exprs.is_opaque(it)).collect()
    }

    pub fn space(&self) -> Space<'_> {
        Space::new(&self.exprs, Objects::Units(&self.objects), self.family).learning(&self.lessons)
    }

    pub fn solve(&self, wanted: &[(ExprId, bool)]) -> Answer {
        self.space().solve(wanted)
    }

    /// What a condition asks for together, at most 256 of it.
    pub fn conjuncts(&self, condition: ExprId) -> Vec<ExprId> {
        self.spread(condition, |it| match it {
            Expr::And(a, b) => Some((*a, *b)),
            _ => None,
        })
    }

    /// What a condition asks for one or another of, at most 256 of it.
    pub fn disjuncts(&self, condition: ExprId) -> Vec<ExprId> {
        self.spread(condition, |it| match it {
            Expr::Or(a, b) => Some((*a, *b)),
            _ => None,
        })
    }

    fn spread(&self, condition: ExprId, split: impl Fn(&Expr) -> Option<(ExprId, ExprId)>) -> Vec<ExprId> {
        const MOST: usize = 256;
        let (mut found, mut stack) = (Vec::new(), vec![condition]);
        while let Some(id) = stack.pop() {
            match split(self.exprs.get(id)).filter(|_| stack.len() + found.len() < MOST) {
                Some((a, b)) => stack.extend([b, a]),
                None if found.contains(&id) => {}
                None => found.push(id),
            }
        }
        found
    }
}

/// An instance that a block declares, `#motor`, as the names of its variables begin.
fn instance_key(name: &str) -> String {
    name.trim_matches(['#', '"', ' ']).to_lowercase()
}

fn fields_of(facts: &UnitFacts, ids: &[ObjectId], binding: &Binding) -> Fields {
    let mut fields = Fields::default();
    let mut add = |name: &str, id: ObjectId| {
        if let Some((instance, field)) = name.split_once('.') {
            fields.entry(instance.into()).or_default().push((field.into(), id));
        }
    };
    binding.iter().for_each(|(name, it)| add(name, it.0));
    for (fact, id) in facts.objects.iter().zip(ids) {
        if let Some(name) = step7::local_name(&fact.object) {
            add(&name, *id);
        }
    }
    fields
}

fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// Whether an object holds one bit, as far as is known.
pub fn may_be_bit(object: &Object) -> bool {
    object.is_fixed()
        && object.footprint.bits == 1
        && (object.ty == Type::Bool
            || object.ty == Type::Unknown && matches!(object.class, Class::Symbol | Class::LocalName | Class::Data))
}

impl<'a> Table<'a> {
    fn new(program: &ProgramIndex<'a>) -> Self {
        let objects: Vec<&'a Object> = program.objects.iter().map(|it| it.object).collect();
        let key = |(at, it): (u32, &&'a Object)| ((&it.footprint, it.ty, it.indexed), ObjectId(at));
        let shared = (0..).zip(&objects).map(key).collect();
        let mut neighbours = vec![Vec::new(); objects.len()];
        for (a, b) in program.overlaps() {
            neighbours[a as usize].push(ObjectId(b));
            neighbours[b as usize].push(ObjectId(a));
        }
        Self {
            objects,
            shared,
            own: FxHashMap::default(),
            scopes: FxHashMap::default(),
            places: FxHashMap::default(),
            neighbours,
        }
    }

    fn scope(&mut self, unit: u32, instance: Instance<'a>) -> u32 {
        let next = index(self.scopes.len());
        *self.scopes.entry((unit, instance)).or_insert(next)
    }

    /// An object of a run. Other blocks may know a variable of an instance by its place in the data block.
    fn of(&mut self, object: &'a Object, scope: u32, instance: Instance<'a>) -> ObjectId {
        if let Some(&id) = self.shared.get(&(&object.footprint, object.ty, object.indexed)) {
            return id;
        }
        if let (Instance::Block(name), Area::OpenInstance) = (instance, &object.footprint.area) {
            let place = Footprint { area: Area::Data(name.clone()), ..object.footprint.clone() };
            if let Some(&id) = self.shared.get(&(&place, object.ty, object.indexed)) {
                return id;
            }
        }
        let next = ObjectId(index(self.objects.len()));
        let id = *self.own.entry((scope, &object.footprint)).or_insert(next);
        if id == next {
            self.objects.push(object);
            let neighbours = self.join(object, scope, id);
            self.neighbours.push(neighbours);
        }
        id
    }

    /// Makes a new object of a run known to those that share memory with it, and gives these.
    fn join(&mut self, object: &'a Object, scope: u32, id: ObjectId) -> Vec<ObjectId> {
        let place = &object.footprint;
        let mut found: Vec<ObjectId> = Vec::new();
        for byte in place.start / 8..place.end().div_ceil(8) {
            let there = self.places.entry((scope, &place.area, byte)).or_default();
            found.extend(there.iter().filter(|it| self.objects[it.0 as usize].footprint.overlaps(place)));
            there.push(id);
        }
        found.sort_unstable();
        found.dedup();
        for it in &found {
            self.neighbours[it.0 as usize].push(id);
        }
        found
    }

    fn neighbours(&self, object: ObjectId) -> &[ObjectId] {
        self.neighbours.get(object.0 as usize).map_or(&[], Vec::as_slice)
    }

    /// The bit at a place, if the program names it.
    fn bit(&self, area: &'a Area, start: u32) -> Option<ObjectId> {
        let place = Footprint::new(area.clone(), start, 1);
        self.shared.get(&(&place, Type::Bool, false)).copied()
    }
}

impl<'a> Runner<'_, 'a> {
    fn version(&mut self, object: ObjectId) -> u32 {
        let at = object.0 as usize;
        if self.now.len() <= at {
            self.now.resize(at + 1, 0);
        }
        self.now[at]
    }

    /// Makes a new version of an object, and of all that share memory with it.
    fn bump(&mut self, object: ObjectId) -> u32 {
        for at in 0..self.table.neighbours(object).len() {
            let other = self.table.neighbours(object)[at];
            if !may_be_bit(self.table.objects[other.0 as usize]) {
                self.version(other);
                self.now[other.0 as usize] += 1;
            }
        }
        self.version(object);
        self.now[object.0 as usize] += 1;
        self.now[object.0 as usize]
    }

    fn read(&mut self, object: ObjectId, path: ExprId) -> ExprId {
        if let Some(&(under, value)) = self.assigned.get(&object)
            && self.trace.exprs.has_conjunct_prefix(path, under)
        {
            return value;
        }
        let version = self.version(object);
        self.trace.exprs.read(object, version)
    }

    /// A bit takes a value when control passes here.
    fn give(&mut self, object: ObjectId, value: ExprId, path: ExprId) {
        let before = self.read(object, path);
        let version = self.bump(object);
        self.give_version(object, version, before, value, path);
    }

    fn give_version(&mut self, object: ObjectId, version: u32, before: ExprId, value: ExprId, path: ExprId) {
        let exprs = &mut self.trace.exprs;
        let made = if path == Exprs::TRUE {
            value
        } else {
            let (given, not) = (exprs.and(path, value), exprs.not(path));
            let kept = exprs.and(not, before);
            exprs.or(given, kept)
        };
        self.trace.values.insert((object, version), made);
        self.assigned.insert(object, (path, value));
    }

    fn run(&mut self, unit: u32, instance: Instance<'a>, under: ExprId, binding: &Binding) {
        let program = self.program;
        let facts = program.units[unit as usize];
        let Some(code) = facts.code.as_deref() else { return };
        if self.stack.len() >= DEEPEST || self.stack.contains(&unit) || self.budget < code.size() {
            self.trace.is_cut = true;
            return;
        }
        self.budget -= code.size();
        self.stack.push(unit);
        let scope = self.table.scope(unit, instance);
        let mut sites: FxHashMap<ObjectId, Site> = FxHashMap::default();
        let mut ids: Vec<ObjectId> = Vec::with_capacity(facts.objects.len());
        for fact in &facts.objects {
            let name = step7::local_name(&fact.object).filter(|_| !binding.is_empty());
            ids.push(match name.and_then(|it| binding.get(it.as_str())) {
                Some(&(id, site)) => {
                    sites.insert(id, site);
                    id
                }
                None => self.table.of(&fact.object, scope, instance),
            });
        }
        let mut known: Vec<Option<ExprId>> = vec![None; code.pool.len()];
        let mut arguments: Option<Arguments> = None;
        let mut fields: Option<Fields> = None;
        for act in &code.acts {
            let mut eval = |runner: &mut Self, at: u32, path: ExprId| runner.eval(code, at, &mut known, &ids, path);
            match *act {
                Act::Test(when) => {
                    eval(self, when, under);
                }
                Act::Write { how, object, anchor, network, path, value } => {
                    let path = eval(self, path, under);
                    let path = self.trace.exprs.and(under, path);
                    let value = value.map(|it| eval(self, it, path));
                    let Some(&object) = ids.get(object as usize) else { continue };
                    let site = sites.get(&object).copied().unwrap_or(Site { unit, anchor });
                    self.write(how, object, path, value, site, unit, network);
                }
                Act::Start { timer, path, when } => {
                    let path = eval(self, path, under);
                    let when = eval(self, when, path);
                    let Some(&timer) = ids.get(timer as usize) else { continue };
                    let when = [path, when].into_iter().fold(under, |all, it| self.trace.exprs.and(all, it));
                    let version = self.bump(timer);
                    self.trace.started.insert((timer, version), when);
                    self.trace.starts.entry(timer).or_default().push(when);
                }
                Act::Remember { memory, path, of, pulse, rising } => {
                    let path = eval(self, path, under);
                    let path = self.trace.exprs.and(under, path);
                    let of = eval(self, of, path);
                    let Some(&memory) = ids.get(memory as usize) else { continue };
                    let before = self.read(memory, path);
                    let exprs = &mut self.trace.exprs;
                    let made = if rising {
                        let low = exprs.not(before);
                        exprs.and(of, low)
                    } else {
                        let low = exprs.not(of);
                        exprs.and(low, before)
                    };
                    if let Some(place) = known.get_mut(pulse as usize) {
                        *place = Some(made);
                    }
                    self.trace.memories.insert(memory, of);
                    self.give(memory, of, path);
                }
                Act::Call { call, path, when } => {
                    let path = eval(self, path, under);
                    let when = eval(self, when, path);
                    let path = [path, when].into_iter().fold(under, |all, it| self.trace.exprs.and(all, it));
                    let arguments = arguments.get_or_insert_with(|| {
                        let mut all = Arguments::default();
                        for it in &facts.uses {
                            if let Some((call, Formal::Name(name))) = it.parameter()
                                && let Some(&object) = ids.get(it.object as usize)
                            {
                                all.entry(*call).or_default().push((name.to_lowercase().into(), object, it.anchor));
                            }
                        }
                        all
                    });
                    let given = arguments.get(&call).map_or(&[][..], Vec::as_slice);
                    let place = self.first_call[unit as usize] + call as usize;
                    let target = program.calls.get(place).and_then(|it| it.target);
                    match (target, facts.calls.get(call as usize)) {
                        (Some(target), Some(fact)) => {
                            let site = |object, anchor| sites.get(object).copied().unwrap_or(Site { unit, anchor });
                            let given = given
                                .iter()
                                .map(|(name, object, anchor)| (name.clone(), (*object, site(object, *anchor))));
                            let (instance, mut binding) = match (&fact.callee, &fact.instance) {
                                (Callee::LocalInstance(name), _) => {
                                    let fields = fields.get_or_insert_with(|| fields_of(facts, &ids, binding));
                                    let here = Site { unit, anchor: fact.anchor };
                                    let own = fields.get(instance_key(name).as_str()).into_iter().flatten();
                                    let own = own.map(|(name, id)| (name.clone(), (*id, here)));
                                    (Instance::Local(scope, name.as_str()), own.collect::<Binding>())
                                }
                                (_, Some(name)) => (Instance::Block(name), Binding::default()),
                                _ => (Instance::None, Binding::default()),
                            };
                            binding.extend(given);
                            self.run(target, instance, path, &binding);
                        }
                        // It may do anything with what it is given.
                        _ => {
                            for &(_, object, _) in given {
                                let value = self.trace.exprs.opaque();
                                self.give(object, value, path);
                                self.assigned.remove(&object);
                                self.store_bits(object, None, path);
                            }
                        }
                    }
                }
            }
        }
        self.stack.pop();
    }

    fn eval(
        &mut self,
        code: &super::code::CodeFacts,
        at: u32,
        known: &mut [Option<ExprId>],
        ids: &[ObjectId],
        path: ExprId,
    ) -> ExprId {
        if let Some(Some(id)) = known.get(at as usize) {
            return *id;
        }
        let Self { trace, assigned, now, .. } = self;
        trace.exprs.import_from(&code.pool, at, known, |exprs, leaf| match *leaf {
            Expr::Read { object, .. } => {
                let Some(&object) = ids.get(object.0 as usize) else { return exprs.opaque() };
                match assigned.get(&object) {
                    Some(&(under, value)) if exprs.has_conjunct_prefix(path, under) => value,
                    _ => exprs.read(object, now.get(object.0 as usize).copied().unwrap_or(0)),
                }
            }
            _ => exprs.opaque(),
        })
    }

    #[expect(clippy::too_many_arguments, reason = "a write is all of this")]
    fn write(
        &mut self,
        how: How,
        object: ObjectId,
        path: ExprId,
        value: Option<ExprId>,
        site: Site,
        unit: u32,
        network: u32,
    ) {
        let (mut when, mut given) = (path, value);
        match (how, value) {
            (How::Set | How::Reset, Some(condition)) => {
                when = self.trace.exprs.and(path, condition);
                given = None;
                let before = self.read(object, path);
                let version = self.bump(object);
                let exprs = &mut self.trace.exprs;
                let made = if how == How::Set {
                    exprs.or(before, when)
                } else {
                    let not = exprs.not(when);
                    exprs.and(before, not)
                };
                self.trace.values.insert((object, version), made);
                self.assigned.remove(&object);
            }
            (How::Assign, Some(value)) => {
                // The value of another bit, kept for the next scan.
                if let Expr::Read { object: of, .. } = *self.trace.exprs.get(value)
                    && of != object
                    && path == Exprs::TRUE
                {
                    self.trace.memories.insert(object, value);
                }
                self.give(object, value, path);
            }
            _ => {
                let version = self.bump(object);
                self.assigned.remove(&object);
                if let Some(value) = value.filter(|_| path == Exprs::TRUE) {
                    self.words.insert((object, version), value);
                }
                self.store_bits(object, value, path);
            }
        }
        let root = self.root;
        self.trace.events.push(Event { how, object, when, value: given, site, network, unit, root });
    }

    /// The bits of a word take theirs.
    fn store_bits(&mut self, word: ObjectId, value: Option<ExprId>, path: ExprId) {
        let bits: Vec<ObjectId> = self
            .table
            .neighbours(word)
            .iter()
            .copied()
            .filter(|it| may_be_bit(self.table.objects[it.0 as usize]))
            .collect();
        let place = &self.table.objects[word.0 as usize].footprint;
        // All values are taken before any is given.
        let given: Vec<(ObjectId, Option<ExprId>)> = bits
            .into_iter()
            .map(|bit| {
                let offset = self.table.objects[bit.0 as usize].footprint.start.saturating_sub(place.start);
                (bit, value.and_then(|it| self.bit_of(it, offset, place.bits, path)))
            })
            .collect();
        for (bit, value) in given {
            // The words around it have their new versions already.
            let before = self.read(bit, path);
            let version = self.version(bit) + 1;
            self.now[bit.0 as usize] = version;
            // A bit of a table keeps its name where it is read.
            self.assigned.remove(&bit);
            if let Some(value) = value {
                self.give_version(bit, version, before, value, path);
                if !matches!(self.trace.exprs.get(value), Expr::Bool(_)) {
                    self.assigned.remove(&bit);
                }
            }
        }
    }

    /// A bit of a value, by its distance from the first bit of the first byte, of a word of so many bits.
    fn bit_of(&mut self, value: ExprId, offset: u32, bits: u32, path: ExprId) -> Option<ExprId> {
        /// Values of more parts are not looked into.
        const MOST: usize = 64;
        enum Step {
            Look(ExprId),
            Join(Operator),
        }
        // Most significant byte first; in a byte, bit 0 is the least significant one.
        let bytes = bits / 8;
        let weight = (bytes.checked_sub(1)?.checked_sub(offset / 8)?) * 8 + offset % 8;
        let (mut steps, mut done, mut seen) = (vec![Step::Look(value)], Vec::new(), 0);
        while let Some(step) = steps.pop() {
            seen += 1;
            if seen > MOST {
                return None;
            }
            match step {
                Step::Look(id) => match *self.trace.exprs.get(id) {
                    Expr::Int(constant) => done.push(Exprs::bool(constant >> weight.min(63) & 1 == 1)),
                    Expr::Binary(op @ (Operator::And | Operator::Or | Operator::Xor), a, b) => {
                        steps.extend([Step::Join(op), Step::Look(b), Step::Look(a)]);
                    }
                    Expr::Read { object, version } => {
                        if let Some(&stored) = self.words.get(&(object, version)).filter(|it| **it != id) {
                            steps.push(Step::Look(stored));
                            continue;
                        }
                        let word = self.table.objects[object.0 as usize];
                        if self.version(object) != version || word.footprint.bits != bits {
                            return None;
                        }
                        let bit = self.table.bit(&word.footprint.area, word.footprint.start.checked_add(offset)?)?;
                        done.push(self.read(bit, path));
                    }
                    _ => return None,
                },
                Step::Join(op) => {
                    let (b, a) = (done.pop()?, done.pop()?);
                    let exprs = &mut self.trace.exprs;
                    done.push(match op {
                        Operator::And => exprs.and(a, b),
                        Operator::Or => exprs.or(a, b),
                        _ => exprs.xor(a, b),
                    });
                }
            }
        }
        done.pop()
    }
}

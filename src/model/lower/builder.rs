//! What every lowering shares: objects, versions of values, paths to statements, labels and jumps.

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use crate::model::entity::Entity;
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::granules::{Granules, Numbers};
use crate::model::object::Object;
use crate::model::unit;
use crate::model::unit::{
    Access, Call, DeadCause, Demand, DemandKind, Jump, Label, Loop, LoopKind, Mode, Oddity, OddityKind, Statement,
    StatementKind, UnitModel, Unreachable,
};
use crate::syntax::Language;

/// Builds a [`UnitModel`] while a lowering walks the code once, in execution order.
///
/// The builder keeps the condition under which control is *here* (`path`). A lowering tells it of jumps, labels,
/// branches and ends; statements take the path of the moment.
pub(super) struct Builder {
    pub(super) model: UnitModel,
    numbers: Numbers,
    /// Of each granule.
    writes: Vec<Vec<Write>>,
    /// Of each area, the version of the last write to somewhere in it.
    area_writes: Vec<u32>,
    /// Version of the last event after which everything may have changed.
    wiped: u32,
    /// Version of the last call of code that is not part of this unit.
    called: u32,
    clock: u32,
    path: ExprId,
    /// What made the path FALSE.
    cut: Option<(DeadCause, TextRange)>,
    /// Conditions under which forward jumps arrive at labels not reached yet.
    pending: FxHashMap<SmolStr, ExprId>,
    /// Labels that some jump further down goes back to.
    back_targets: FxHashSet<SmolStr>,
    label_index: FxHashMap<SmolStr, u32>,
    /// Number of the piece of code with labels of its own, and its first jump.
    part: u32,
    first_jump: usize,
    network: u32,
    loops: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Write {
    start: u32,
    end: u32,
    version: u32,
    /// Condition under which the object was surely given a value; `None` when no write was sure.
    sure: Option<ExprId>,
}

impl Builder {
    /// `len`: length of the code, for room in the tables.
    pub(super) fn new(entity: Entity, language: Language, heading: TextRange, len: TextSize) -> Self {
        let len = usize::from(len);
        let mut anchors = Vec::with_capacity(len / 24 + 1);
        anchors.push(heading);
        let model = UnitModel {
            entity,
            language,
            objects: Vec::with_capacity(len / 32),
            ids: HashTable::with_capacity(len / 32),
            granules: Granules::with_capacity(len / 32),
            exprs: Exprs::with_capacity(len / 24),
            statements: Vec::with_capacity(len / 64),
            accesses: Vec::with_capacity(len / 28),
            labels: Vec::new(),
            jumps: Vec::new(),
            calls: Vec::new(),
            loops: Vec::new(),
            declared: None,
            symbols: Vec::new(),
            remarks: Vec::new(),
            indexes: Vec::new(),
            demands: Vec::new(),
            replaced: Vec::new(),
            constants: Vec::new(),
            oddities: Vec::new(),
            unreachable: Vec::new(),
            hollows: Vec::new(),
            pulses: Vec::new(),
            networks: Vec::new(),
            computes: None,
            anchors,
            instance_of: None,
            opens_instance: false,
            instructions: 0,
            reads_indirectly: false,
            writes_indirectly: false,
            of_tia_portal: false,
            has_gaps: false,
            mixes_floats: false,
            chart: None,
            interface: None,
        };
        Self {
            model,
            numbers: Numbers::default(),
            writes: Vec::with_capacity(len / 32),
            area_writes: Vec::new(),
            wiped: 0,
            called: 0,
            clock: 0,
            path: Exprs::TRUE,
            cut: None,
            pending: FxHashMap::default(),
            back_targets: FxHashSet::default(),
            label_index: FxHashMap::default(),
            part: 0,
            first_jump: 0,
            network: 0,
            loops: Vec::new(),
        }
    }

    pub(super) fn exprs(&mut self) -> &mut Exprs {
        &mut self.model.exprs
    }

    pub(super) fn path(&self) -> ExprId {
        self.path
    }

    pub(super) fn next_network(&mut self) {
        self.network += 1;
    }

    pub(super) fn oddity(&mut self, kind: OddityKind, range: TextRange, text: impl Into<SmolStr>) -> &mut Oddity {
        self.model.oddities.push(Oddity { kind, range, text: text.into(), related: Vec::new() });
        let last = self.model.oddities.len() - 1;
        &mut self.model.oddities[last]
    }

    // Objects and accesses.

    pub(super) fn object(&mut self, object: Object) -> ObjectId {
        let objects = &self.model.objects;
        let hash = |object: &Object| unit::hash(&object.text);
        let id = ObjectId(index(objects.len()));
        let is_same = |it: &ObjectId| objects[it.0 as usize] == object;
        let found = self.model.ids.entry(hash(&object), is_same, |it| hash(&objects[it.0 as usize]));
        match found {
            Entry::Occupied(found) => return *found.get(),
            Entry::Vacant(entry) => entry.insert(id),
        };
        self.model.granules.push(&mut self.numbers, &object.footprint);
        self.model.objects.push(object);
        id
    }

    /// Notes an operation that can overflow.
    pub(super) fn computes(&mut self, range: TextRange) {
        if self.model.computes.is_none() {
            self.model.computes = Some(self.anchor(range));
        }
    }

    /// Notes a number that has to lie in a range.
    pub(super) fn demand(&mut self, what: DemandKind, value: ExprId, range: TextRange) {
        let anchor = self.anchor(range);
        let statement = index(self.model.statements.len());
        self.model.demands.push(Demand { what, value, statement, path: self.path, anchor });
    }

    /// A place that facts can name.
    pub(super) fn anchor(&mut self, range: TextRange) -> u32 {
        self.model.anchors.push(range);
        index(self.model.anchors.len() - 1)
    }

    fn access(&mut self, object: ObjectId, mode: Mode, range: TextRange, version: u32, exposed: bool) -> u32 {
        let anchor = self.anchor(range);
        let statement = index(self.model.statements.len());
        self.model.accesses.push(Access {
            object,
            mode,
            statement,
            anchor,
            path: self.path,
            version,
            exposed,
            parameter: None,
        });
        index(self.model.accesses.len() - 1)
    }

    /// Records a read and gives the value as an expression.
    pub(super) fn read(&mut self, object: ObjectId, range: TextRange) -> ExprId {
        let (version, exposed) = self.version(object);
        self.access(object, Mode::Read, range, version, exposed);
        self.model.exprs.read(object, version)
    }

    /// Records an edge test and gives it as an expression.
    pub(super) fn edge(&mut self, object: ObjectId, rising: bool, range: TextRange) -> ExprId {
        let (version, exposed) = self.version(object);
        let mode = if rising { Mode::Rising } else { Mode::Falling };
        self.access(object, mode, range, version, exposed);
        self.model.exprs.edge(object, version, rising)
    }

    /// The value of an object as the controller itself looks at it: no access of the program.
    pub(super) fn peek(&mut self, object: ObjectId) -> ExprId {
        let (version, _) = self.version(object);
        self.model.exprs.read(object, version)
    }

    /// The same of an edge.
    pub(super) fn peek_edge(&mut self, object: ObjectId, rising: bool) -> ExprId {
        let (version, _) = self.version(object);
        self.model.exprs.edge(object, version, rising)
    }

    /// Records an access that is neither a plain read nor a statement of its own: an actual parameter, an edge memory.
    pub(super) fn touch(&mut self, object: ObjectId, mode: Mode, range: TextRange) -> u32 {
        let (version, exposed) = self.version(object);
        let access = self.access(object, mode, range, version, exposed);
        if mode.writes() {
            let version = self.write(object, false);
            if !mode.reads() {
                self.model.accesses[access as usize].version = version;
            }
        }
        access
    }

    /// Version of the value that the object has here, and whether it may stem from outside this run of the unit.
    fn version(&self, object: ObjectId) -> (u32, bool) {
        let area = self.model.granules.area(object);
        let data = &self.model.objects[object.0 as usize];
        let whole = self.area_writes.get(area as usize).copied().unwrap_or(0).max(self.wiped);
        if !data.is_fixed() {
            return (self.clock, true);
        }
        let mut version = whole;
        let mut exposed = true;
        let (start, end) = (data.footprint.start, data.footprint.end());
        for &granule in self.model.granules.of(object) {
            for write in self.writes.get(granule as usize).into_iter().flatten() {
                if write.start < end && start < write.end {
                    version = version.max(write.version);
                    let covers = write.start <= start && end <= write.end;
                    let own = write.version > self.called;
                    if covers && own && write.sure.is_some_and(|it| self.model.exprs.has_conjunct_prefix(self.path, it))
                    {
                        exposed = false;
                    }
                }
            }
        }
        (version, exposed)
    }

    /// Notes that an object gets another value. `sure`: whenever control passes here.
    fn write(&mut self, object: ObjectId, sure: bool) -> u32 {
        self.clock += 1;
        let version = self.clock;
        let data = &self.model.objects[object.0 as usize];
        let (start, end) = (data.footprint.start, data.footprint.end());
        let granules = self.model.granules.of(object);
        if granules.is_empty() || !data.is_fixed() {
            *slot(&mut self.area_writes, self.model.granules.area(object)) = version;
            return version;
        }
        let (path, called) = (self.path, self.called);
        for &granule in granules {
            let list = slot(&mut self.writes, granule);
            match list.iter_mut().find(|it| it.start == start && it.end == end) {
                Some(write) => {
                    let before = write.sure.filter(|_| write.version > called);
                    let kept = before.filter(|&it| self.model.exprs.has_conjunct_prefix(path, it));
                    write.version = version;
                    write.sure = if sure && kept.is_none() { Some(path) } else { before };
                }
                None => list.push(Write { start, end, version, sure: sure.then_some(path) }),
            }
        }
        version
    }

    /// After this, any object may have another value: a loop was entered or left.
    pub(super) fn wipe(&mut self) {
        self.clock += 1;
        self.wiped = self.clock;
    }

    /// Other code of the program ran: any object may have another value, and that value may be another unit's.
    pub(super) fn wipe_by_call(&mut self) {
        self.wipe();
        self.called = self.clock;
    }

    /// A call that surely ran has given the object its answer: no access of its own, the call's is.
    pub(super) fn settle(&mut self, object: ObjectId) {
        self.write(object, true);
    }

    // Statements.

    pub(super) fn statement(&mut self, kind: StatementKind, range: TextRange) -> u32 {
        let in_loop = self.loops.last().copied();
        self.model.statements.push(Statement { kind, range, path: self.path, network: self.network, in_loop });
        index(self.model.statements.len() - 1)
    }

    /// A bit takes a condition. `negated` is how the source writes it; `value` is what the bit takes.
    pub(super) fn assign(&mut self, object: ObjectId, negated: bool, value: ExprId, at: TextRange, range: TextRange) {
        let mode = if negated { Mode::AssignNot } else { Mode::Assign };
        let access = self.written(object, mode, true, at);
        self.statement(StatementKind::Assign { access, value }, range);
    }

    pub(super) fn set(&mut self, object: ObjectId, when: ExprId, at: TextRange, range: TextRange) {
        let access = self.written(object, Mode::Set, when == Exprs::TRUE, at);
        self.statement(StatementKind::Set { access, when }, range);
    }

    pub(super) fn reset(&mut self, object: ObjectId, when: ExprId, at: TextRange, range: TextRange) {
        let access = self.written(object, Mode::Reset, when == Exprs::TRUE, at);
        self.statement(StatementKind::Reset { access, when }, range);
    }

    /// A word, table or text takes a value.
    pub(super) fn store(&mut self, object: ObjectId, value: ExprId, at: TextRange, range: TextRange) {
        let (replaced, _) = self.version(object);
        self.model.replaced.push((index(self.model.accesses.len()), replaced));
        let access = self.written(object, Mode::Store, true, at);
        self.statement(StatementKind::Store { access, value }, range);
    }

    pub(super) fn drive(
        &mut self,
        object: ObjectId,
        pin: super::Pin,
        when: ExprId,
        value: Option<ExprId>,
        at: TextRange,
        range: TextRange,
    ) {
        let version = self.write(object, false);
        let access = self.access(object, Mode::Drive(pin), at, version, false);
        self.statement(StatementKind::Drive { access, pin, when, value }, range);
    }

    fn written(&mut self, object: ObjectId, mode: Mode, sure: bool, at: TextRange) -> u32 {
        let version = self.write(object, sure);
        self.access(object, mode, at, version, false)
    }

    /// Records a call. What it may change is the caller's to say, with [`Self::wipe`].
    pub(super) fn call(&mut self, mut call: Call, range: TextRange) {
        call.statement = index(self.model.statements.len());
        self.model.calls.push(call);
        let index = index(self.model.calls.len() - 1);
        self.statement(StatementKind::Call(index), range);
    }

    // Control flow.

    /// A piece of code begins that is programmed by itself, as an action is: its labels are its own, and other code of the
    /// program may have run before it.
    pub(super) fn begin_part(&mut self) {
        self.resolve_jumps();
        self.part += 1;
        self.label_index.clear();
        self.pending.clear();
        self.back_targets.clear();
        self.loops.clear();
        self.wipe_by_call();
    }

    fn resolve_jumps(&mut self) {
        for jump in self.model.jumps.iter_mut().skip(self.first_jump) {
            jump.target = jump.target.or_else(|| self.label_index.get(&jump.label).copied());
        }
        self.first_jump = self.model.jumps.len();
    }

    /// Tells the labels that some jump goes back to, which a lowering finds before it walks the code: what is known on
    /// the way down does not hold there.
    pub(super) fn set_back_targets(&mut self, labels: FxHashSet<SmolStr>) {
        self.back_targets = labels;
    }

    /// Whether a label of that name was passed already.
    pub(super) fn has_label(&self, name: &str) -> bool {
        self.label_index.contains_key(name)
    }

    pub(super) fn is_reachable(&self) -> bool {
        self.path != Exprs::FALSE
    }

    /// Notes an instruction without effect (`NOP 0`, the `BE` that closes a block): nothing is lost when no path
    /// reaches it.
    pub(super) fn idle_instruction(&mut self) {
        self.model.instructions += 1;
    }

    /// Notes an instruction or statement, which is unreachable when the path is FALSE.
    pub(super) fn instruction(&mut self, range: TextRange) {
        self.model.instructions += 1;
        if self.path != Exprs::FALSE {
            return;
        }
        let Some((cause, cut_by)) = self.cut else { return };
        match self.model.unreachable.last_mut().filter(|it| it.cut_by == cut_by && it.cause == cause) {
            Some(stretch) => stretch.range = stretch.range.cover(range),
            None => self.model.unreachable.push(Unreachable { range, first: range, cause, cut_by }),
        }
    }

    pub(super) fn jump(&mut self, label: SmolStr, text: SmolStr, at: TextRange, when: ExprId, range: TextRange) {
        let target = self.label_index.get(&label).copied();
        let statement = index(self.model.statements.len());
        let anchor = self.anchor(at);
        let part = self.part;
        self.model.jumps.push(Jump { label: label.clone(), text, range: at, anchor, statement, when, target, part });
        let jump = index(self.model.jumps.len() - 1);
        self.statement(StatementKind::Jump(jump), range);
        let taken = self.model.exprs.and(self.path, when);
        match target {
            Some(target) => {
                let first = self.model.labels[target as usize].statement;
                let parent = self.loops.last().copied();
                self.model.loops.push(Loop {
                    kind: LoopKind::Jump,
                    keyword: at,
                    anchor,
                    counting: None,
                    condition: Some(when),
                    condition_range: None,
                    index: None,
                    index_range: None,
                    body: first..statement + 1,
                    exits: when != Exprs::TRUE,
                    parent,
                });
                self.wipe();
            }
            None => {
                let arriving = self.pending.get(&label).copied().unwrap_or(Exprs::FALSE);
                let arriving = self.model.exprs.or(taken, arriving);
                self.pending.insert(label, arriving);
            }
        }
        self.leave(when, DeadCause::Jump, range);
    }

    /// Control goes on only when `when` does not hold.
    pub(super) fn leave(&mut self, when: ExprId, cause: DeadCause, range: TextRange) {
        let stays = self.model.exprs.not(when);
        let was = self.path;
        self.path = self.model.exprs.and(was, stays);
        if was != Exprs::FALSE && self.path == Exprs::FALSE {
            self.cut = Some((cause, range));
        }
    }

    pub(super) fn label(&mut self, name: SmolStr, text: SmolStr, range: TextRange) {
        let label = index(self.model.labels.len());
        let statement = index(self.model.statements.len());
        self.model.labels.push(Label { name: name.clone(), text, range, statement, part: self.part });
        self.label_index.entry(name.clone()).or_insert(label);
        let arriving = self.pending.remove(&name).unwrap_or(Exprs::FALSE);
        self.path = self.model.exprs.or(self.path, arriving);
        if self.back_targets.contains(&name) {
            // Values may stem from a later part of the code; the way in may be a later jump alone.
            self.wipe();
            if self.path == Exprs::FALSE {
                self.path = self.model.exprs.opaque();
            }
        }
    }

    /// Control is here under that condition. `cut`: what to blame when it is never true.
    pub(super) fn enter(&mut self, path: ExprId, cut: Option<(DeadCause, TextRange)>) {
        self.path = path;
        if path == Exprs::FALSE && cut.is_some() {
            self.cut = cut;
        }
    }

    pub(super) fn open_loop(&mut self, it: Loop) -> u32 {
        let id = index(self.model.loops.len());
        self.model.loops.push(Loop { parent: self.loops.last().copied(), ..it });
        self.loops.push(id);
        self.wipe();
        id
    }

    /// Ends the innermost loop.
    pub(super) fn close_loop(&mut self) {
        if let Some(id) = self.loops.pop() {
            let end = index(self.model.statements.len());
            self.model.loops[id as usize].body.end = end;
            self.wipe();
        }
    }

    /// The innermost loop has a way out besides its condition.
    pub(super) fn mark_exit(&mut self) {
        if let Some(&id) = self.loops.last() {
            self.model.loops[id as usize].exits = true;
        }
    }

    /// A jump or return leaves every loop that is open here.
    pub(super) fn mark_all_exits(&mut self) {
        for &id in &self.loops {
            self.model.loops[id as usize].exits = true;
        }
    }

    pub(super) fn finish(mut self) -> UnitModel {
        self.resolve_jumps();
        self.model
    }
}

/// A place in a table that grows as it is used.
fn slot<T: Default + Clone>(table: &mut Vec<T>, at: u32) -> &mut T {
    let at = at as usize;
    if table.len() <= at {
        table.resize(at + 1, T::default());
    }
    &mut table[at]
}

/// Indices are counted in `u32`: a unit is below 4 GiB.
pub(super) fn index(len: usize) -> u32 {
    u32::try_from(len).unwrap_or(u32::MAX)
}

//! The model of one unit: what its code does, in the order in which the controller does it.
//!
//! Places are ranges relative to the unit. Facts that leave the unit name places by *anchor*, an index into
//! [`UnitModel::anchors`], so that they stay equal when code only moves.

use std::hash::BuildHasher as _;
use std::ops::Range;

use hashbrown::HashTable;
use rowan::TextRange;
use rustc_hash::FxBuildHasher;
use smol_str::SmolStr;

use super::chart::{Chart, CodeLanguage};
use super::dfb::Interface;
use super::entity::{BlockName, Entity};
use super::expr::{ExprId, Exprs, ObjectId};
use super::granules::Granules;
use super::ladder::Flaw;
use super::layout::{DataType, Elementary, Field};
use super::literal::{LiteralError, Value};
use super::object::{AddressError, Class, Object};
use super::pl7_kinds::Kind;
use super::symbols::{Remark, Symbol};
use super::work::Network;
use crate::syntax::Language;

/// An input or output of a timer, counter, monostable, register or drum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pin {
    /// Starts a timer or monostable: `SE T1`, `IN %TM1`, `S %MN1`.
    Start,
    /// `R T1`, `R %C8`.
    Reset,
    /// Sets a counter to its preset: `S Z1`, `S %C8`.
    Preset,
    Up,
    Down,
    /// `FR T1`, or an enable input.
    Enable,
    /// A register's `I` (store) and `O` (retrieve).
    Store,
    Retrieve,
    /// A drum's `U`.
    Advance,
    /// Block used as a whole: `BLK %C8`, a call.
    Whole,
}

impl Pin {
    pub fn describe(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Reset => "reset",
            Self::Preset => "preset",
            Self::Up => "count-up",
            Self::Down => "count-down",
            Self::Enable => "enable",
            Self::Store => "store",
            Self::Retrieve => "retrieve",
            Self::Advance => "advance",
            Self::Whole => "whole",
        }
    }
}

/// What is done to an object at one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mode {
    Read,
    /// Rising edge test.
    Rising,
    /// Falling edge test.
    Falling,
    /// A bit takes a condition: coil, `ST`, `:=`, `=`.
    Assign,
    /// A bit takes a negated condition: inverse coil, `STN`.
    AssignNot,
    Set,
    Reset,
    /// A word, table or text takes a value.
    Store,
    /// Written in a way that the source does not tell: by assignment, set, reset or store.
    Write,
    /// The previous value that `FP`/`FN` keeps: read and written.
    EdgeMemory,
    /// A pin of a block takes a condition.
    Drive(Pin),
    /// Given to a call that may read and write it.
    InOut,
    /// Given to a call that writes it: an output actual, a function's result.
    Output,
}

impl Mode {
    pub fn is_edge(self) -> bool {
        matches!(self, Self::Rising | Self::Falling)
    }

    /// Whether the object's value comes out.
    pub fn reads(self) -> bool {
        matches!(self, Self::Read | Self::Rising | Self::Falling | Self::EdgeMemory | Self::InOut)
    }

    /// Whether the object may get another value.
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::Assign
                | Self::AssignNot
                | Self::Set
                | Self::Reset
                | Self::Store
                | Self::Write
                | Self::EdgeMemory
                | Self::InOut
                | Self::Output
        )
    }

    /// Whether the object gets a new value whenever the place is reached: what makes the last writer win.
    pub fn assigns(self) -> bool {
        matches!(self, Self::Assign | Self::AssignNot | Self::Output)
    }

    /// The verb of a secondary label: "also assigned here".
    pub fn verb(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Rising => "tested for a rising edge",
            Self::Falling => "tested for a falling edge",
            Self::Assign => "assigned",
            Self::AssignNot => "assigned (negated)",
            Self::Set => "set",
            Self::Reset => "reset",
            Self::Store | Self::Write => "written",
            Self::EdgeMemory => "used as edge memory",
            Self::Drive(_) => "driven",
            Self::InOut => "passed to a call",
            Self::Output => "written by a call",
        }
    }
}

/// One use of one object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Access {
    pub object: ObjectId,
    pub mode: Mode,
    /// Index of the statement that the access is part of.
    pub statement: u32,
    pub anchor: u32,
    /// Condition under which control reaches the place, within one run of the unit.
    pub path: ExprId,
    /// For reads: version of the value read. For writes: version that the write makes.
    pub version: u32,
    /// For reads: whether the value may stem from before this unit's own assignments, so from another unit or scan.
    pub exposed: bool,
    /// For an actual parameter: the formal one.
    pub parameter: Option<Formal>,
}

/// How a call says which parameter an actual is for.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Formal {
    Name(SmolStr),
    Slot(Slot),
}

/// Where an actual of a DFB stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Slot {
    /// Place among the parameters of a call in text, from 0: positions may be left open.
    Position(u32),
    /// Row on the left of a block in a rung, from 0.
    Left(u32),
    /// Row on its right.
    Right(u32),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StatementKind {
    /// `access` indexes [`UnitModel::accesses`]; `value` is what the bit takes, negation applied.
    Assign {
        access: u32,
        value: ExprId,
    },
    Set {
        access: u32,
        when: ExprId,
    },
    Reset {
        access: u32,
        when: ExprId,
    },
    Store {
        access: u32,
        value: ExprId,
    },
    /// `value` is the preset or duration loaded with it.
    Drive {
        access: u32,
        pin: Pin,
        when: ExprId,
        value: Option<ExprId>,
    },
    Call(u32),
    Jump(u32),
    /// Back to the caller, or end of the unit.
    Return {
        when: ExprId,
        how: Leave,
    },
    /// The program goes one of two ways.
    Branch {
        condition: ExprId,
        of: Fork,
    },
    Halt,
    /// Leaves the innermost loop.
    Exit,
    /// Opens a data block.
    Open,
    /// Anything else that acts: a conversion in place, a master control relay.
    Other,
}

/// Where a program goes one of two ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fork {
    /// `IF`; `ELSIF`, with the statement that is the arm before.
    Arm { after: Option<u32> },
    /// `WHILE`, `REPEAT`.
    Loop,
    /// A transition.
    Receptivity,
}

/// What an instruction leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Leave {
    /// `RET`, `RETURN`: only a subroutine has a caller to go back to.
    Subroutine,
    /// `END`, `BE`, `BEA`, `BEB`: the block or task ends for this scan.
    Unit,
}

/// One step of the program, in execution order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement {
    pub kind: StatementKind,
    pub range: TextRange,
    /// Condition under which control reaches the statement, within one run of the unit.
    pub path: ExprId,
    /// Index of the network or sentence.
    pub network: u32,
    /// Innermost loop, an index into [`UnitModel::loops`].
    pub in_loop: Option<u32>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// As jumps name it: upper case (STEP 7 labels) or the number (`%L20` is `20`).
    pub name: SmolStr,
    /// As written.
    pub text: SmolStr,
    pub range: TextRange,
    /// Index of the first statement after it.
    pub statement: u32,
    /// The piece of code that it belongs to, as [`Jump::part`].
    pub part: u32,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jump {
    /// As [`Label::name`].
    pub label: SmolStr,
    pub text: SmolStr,
    /// Range of the target.
    pub range: TextRange,
    /// The same, for facts.
    pub anchor: u32,
    pub statement: u32,
    /// Condition at the instruction, without the path to it. TRUE when unconditional.
    pub when: ExprId,
    /// The first label of that name, an index into [`UnitModel::labels`].
    pub target: Option<u32>,
    /// Number of the piece of code, with labels of its own, that it belongs to: an action of a chart. 0 elsewhere.
    pub part: u32,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Callee {
    /// SRi of the same application.
    Subroutine(u32),
    /// FC, FB, SFC, SFB or OB.
    Block(BlockName),
    /// `#name`: an instance that the block's own declarations hold.
    LocalInstance(SmolStr),
    /// A PL7 function or operator statement, in upper case.
    Function(SmolStr),
    /// A DFB instance, in lower case.
    Instance(SmolStr),
    /// Computed at run time.
    Unknown,
}

/// A parameter of a call of STEP 7 with what was given for it. It holds no position, so that it may leave the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// Name of the parameter as written, where the call gives one.
    pub name: Option<SmolStr>,
    pub given: Passed,
    /// Place of the name.
    pub anchor: u32,
    /// What is given, as written.
    pub text: SmolStr,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passed {
    Object(ObjectId),
    /// A constant, of the type that its spelling tells.
    Constant(Option<Elementary>),
    /// An area by a pointer, or an operand with a mistake.
    Other,
}

/// What a call gives to a parameter of a DFB. It holds no position, so that it may leave the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Actual {
    pub slot: Slot,
    pub anchor: u32,
    pub given: Given,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Given {
    Object(ObjectId),
    /// A constant, of a kind.
    Constant(Kind),
    /// The value of an expression.
    Expression(Kind),
    /// A wire of a rung.
    Wire,
    /// An operand with a mistake.
    Unknown,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Call {
    pub callee: Callee,
    /// The callee as written.
    pub text: SmolStr,
    pub statement: u32,
    /// Place of the callee.
    pub anchor: u32,
    /// Condition at the instruction, without the path to it. TRUE when unconditional.
    pub when: ExprId,
    /// Instance data block, as written.
    pub instance: Option<BlockName>,
    pub instance_range: Option<TextRange>,
    /// Of STEP 7.
    pub arguments: Vec<Argument>,
    /// Of an instance of a DFB.
    pub actuals: Vec<Actual>,
    /// Whether the instruction can pass parameters and an instance (`CALL`, not `UC`/`CC`), and all that it passes is known.
    pub full: bool,
    /// Of a DFB in a rung: the call of the DFB before it in series, with less room between them than there must be
    /// (PL7:5625).
    pub too_close: Option<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LoopKind {
    While,
    Repeat,
    For,
    /// A backward jump to a label.
    Jump,
}

/// What a loop counts that counts by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Counting {
    /// `FOR`: from the first value to the last, in steps of 1.
    Up { first: ExprId, last: ExprId },
    /// `LOOP`: `left` is the accumulator before it is counted down; control comes to the label with `entry` in the
    /// accumulator from above, and with `turn` on each turn.
    Down { entry: ExprId, turn: ExprId, left: ExprId },
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loop {
    pub kind: LoopKind,
    /// The keyword, or the backward jump.
    pub keyword: TextRange,
    /// The same, for facts.
    pub anchor: u32,
    /// For WHILE: the condition to go on; for REPEAT: the condition to stop.
    pub condition: Option<ExprId>,
    pub condition_range: Option<TextRange>,
    /// FOR index.
    pub index: Option<ObjectId>,
    pub index_range: Option<TextRange>,
    /// How a loop counts that counts by itself.
    pub counting: Option<Counting>,
    /// Statements of the body.
    pub body: Range<u32>,
    /// Whether an EXIT, a jump or a return can leave it.
    pub exits: bool,
    pub parent: Option<u32>,
}

/// What stands in the brackets of an indexed object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Index {
    pub what: IndexKind,
    pub anchor: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IndexKind {
    Object(ObjectId),
    /// An immediate value.
    Constant(i64),
    /// An expression of several terms.
    Computed,
}

/// A number that has to lie in a range for an operation to work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Demand {
    pub what: DemandKind,
    pub value: ExprId,
    /// Index of the statement that it is part of.
    pub statement: u32,
    pub path: ExprId,
    pub anchor: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DemandKind {
    /// It is added to the address of an object of PL7.
    Index(ObjectId),
    /// It divides.
    Divisor,
}

/// A constant of a type whose exact value a rule asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    pub value: Value,
    pub range: TextRange,
    pub text: SmolStr,
}

/// Values are compared by their spelling.
impl Eq for Constant {}

/// Something that the language forbids or that loses a result, found while following the code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OddityKind {
    /// An operand that is no address of the dialect.
    Address(AddressError),
    Literal(LiteralError),

    // PL7 instruction list.
    LabelInParentheses,
    JumpInParentheses,
    StoreInParentheses,
    /// An opening without its closing.
    UnclosedParenthesis,
    /// A closing without its opening.
    UnopenedParenthesis,
    /// Nesting reaches this depth.
    ParenthesisDepth(u32),
    /// This many values on the MPS stack.
    StackDepth(u32),
    StackUnderflow,
    /// This many values left at the end of the sentence.
    StackLeft(u32),
    /// Two paths meet with different stack depths.
    StackMismatch,
    StackInParentheses,
    /// A sequence that starts with an instruction that needs a result.
    SentenceStart,
    /// A test chain whose result nothing uses.
    TestWithoutAction,
    /// Wrong use of BLK, OUT_BLK, END_BLK: the sentence says how.
    BlockStructure(String),
    /// Operand of a type that the instruction does not take: the sentence says which it takes.
    OperandType(String),

    // PL7 ladder.
    Ladder(Flaw),

    // STEP 7 and STEP 5.
    /// The RLO at block start, which is the caller's.
    RloFromCaller,
    /// The RLO after a block call, which the called block left.
    RloAfterCall,
    /// An RLO computed and discarded.
    RloUnused,
    /// An instruction that ignores the RLO of the test before it.
    UnconditionalAfterTest,
    /// A value loaded and lost.
    DeadLoad,
    /// A two-operand instruction with fewer than two loaded values: how many were.
    MissingOperand(u32),
    /// A data block access while none was opened.
    DataBlockNotOpen,
    /// An operation or transfer of another width or kind of number than its operand: the sentence says why.
    OperandWidth(String),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Oddity {
    pub kind: OddityKind,
    pub range: TextRange,
    /// The text in question: operand, mnemonic.
    pub text: SmolStr,
    /// Other places that take part, with their part.
    pub related: Vec<(TextRange, &'static str)>,
}

/// Why code cannot be reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DeadCause {
    Jump,
    Return,
    /// `BE`, `BEA`, `END`, `RET`: the block or program ends there.
    End,
    Halt,
    /// The condition is never true.
    FalseCondition,
}

/// A stretch of code that no path reaches.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreachable {
    /// From the first to the last instruction.
    pub range: TextRange,
    /// First instruction of it.
    pub first: TextRange,
    pub cause: DeadCause,
    /// What cut it off.
    pub cut_by: TextRange,
}

/// An edge of a result, which a bit keeps from scan to scan: `FP M 1.0`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pulse {
    /// What the instruction gives: a value about which expressions know nothing.
    pub value: ExprId,
    /// The result whose edge it is.
    pub of: ExprId,
    pub memory: ObjectId,
    pub rising: bool,
    /// Index of the statement after it.
    pub statement: u32,
    pub path: ExprId,
}

/// A part of a program that may hold code, and holds nothing, not even a remark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hollow {
    pub kind: HollowKind,
    /// Its keyword, or its head.
    pub range: TextRange,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HollowKind {
    /// What an `IF` does when a condition holds, or when none does.
    Branch,
    /// The body of a loop that counts.
    Loop,
    /// A network that has a head.
    Network,
}

/// Part of an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Section {
    Input,
    Output,
    InOut,
    Static,
    Temp,
}

/// Of an object, by its text.
pub(super) fn hash(text: &str) -> u64 {
    FxBuildHasher.hash_one(text)
}

#[derive(Debug, Clone)]
pub struct UnitModel {
    pub entity: Entity,
    pub language: Language,
    pub objects: Vec<Object>,
    /// Objects by their text; most texts name one object, whatever else is to tell two apart.
    pub(super) ids: HashTable<ObjectId>,
    pub granules: Granules,
    pub exprs: Exprs,
    pub statements: Vec<Statement>,
    pub accesses: Vec<Access>,
    pub labels: Vec<Label>,
    pub jumps: Vec<Jump>,
    pub calls: Vec<Call>,
    pub loops: Vec<Loop>,
    /// What a block of STEP 7 declares.
    pub declared: Option<DataType>,
    /// Symbols that the unit declares for the program.
    pub symbols: Vec<Symbol>,
    /// Comments whose length is limited.
    pub remarks: Vec<Remark>,
    /// Indexes of PL7 objects, in the order of the text.
    pub indexes: Vec<Index>,
    /// Divisors, and the indexes of PL7 objects again, with their values; in the order of execution.
    pub demands: Vec<Demand>,
    /// Of each store, by its access: the version that it replaces. In the order of the accesses.
    pub replaced: Vec<(u32, u32)>,
    /// Durations, as written.
    pub constants: Vec<Constant>,
    pub oddities: Vec<Oddity>,
    pub unreachable: Vec<Unreachable>,
    pub hollows: Vec<Hollow>,
    /// Edges of results, in the order of the code.
    pub pulses: Vec<Pulse>,
    /// Networks of PL7-2, in the order in which they are scanned.
    pub networks: Vec<Network>,
    /// Anchor of the first operation of PL7 that can overflow.
    pub computes: Option<u32>,
    /// Ranges that facts name; the first is the unit's heading.
    pub anchors: Vec<TextRange>,
    /// For a data block: the block that it is an instance of.
    pub instance_of: Option<BlockName>,
    /// Whether it opens another data block in place of its instance.
    pub opens_instance: bool,
    /// Instructions and statements read.
    pub instructions: u32,
    /// Some place computed at run time is read (or written): any object may be.
    pub reads_indirectly: bool,
    pub writes_indirectly: bool,
    /// Some instruction or statement was not understood: it may do anything.
    pub has_gaps: bool,
    /// Somewhere a floating-point number meets a number that may not be one.
    pub mixes_floats: bool,
    /// TIA Portal exported the unit: some of its limits are wider than those of STEP 7.
    pub of_tia_portal: bool,
    /// What the unit holds of a chart.
    pub chart: Option<Box<Chart>>,
    /// The parameters and variables of a DFB type.
    pub interface: Option<Box<Interface>>,
}

impl UnitModel {
    pub fn object(&self, id: ObjectId) -> &Object {
        &self.objects[id.0 as usize]
    }

    /// The object that the unit names by an address without index.
    pub fn address(&self, text: &str) -> Option<ObjectId> {
        let names = |it: &ObjectId| {
            let object = self.object(*it);
            let is_address = !matches!(object.class, Class::Indirect | Class::Symbol | Class::LocalName);
            is_address && !object.indexed && object.text == text
        };
        self.ids.find(hash(text), names).copied()
    }

    pub fn statement(&self, access: &Access) -> Option<&Statement> {
        self.statements.get(access.statement as usize)
    }

    /// What some statements read and write. Accesses stand in the order of their statements.
    pub fn accesses_of(&self, statements: &Range<u32>) -> &[Access] {
        let before = |end: u32| self.accesses.partition_point(|it| it.statement < end);
        self.accesses.get(before(statements.start)..before(statements.end)).unwrap_or_default()
    }

    /// The condition of a statement itself, without the path to it: under which it acts, or control goes another way.
    /// `None` for what asks none, such as an assignment.
    pub fn condition(&self, statement: &Statement) -> Option<ExprId> {
        match statement.kind {
            StatementKind::Set { when, .. }
            | StatementKind::Reset { when, .. }
            | StatementKind::Drive { when, .. }
            | StatementKind::Return { when, .. } => Some(when),
            StatementKind::Call(call) => self.calls.get(call as usize).map(|it| it.when),
            StatementKind::Jump(jump) => self.jumps.get(jump as usize).map(|it| it.when),
            StatementKind::Branch { condition, .. } => Some(condition),
            StatementKind::Assign { .. }
            | StatementKind::Store { .. }
            | StatementKind::Halt
            | StatementKind::Exit
            | StatementKind::Open
            | StatementKind::Other => None,
        }
    }

    /// Whether an access is one of structured text.
    pub fn is_structured_text(&self, access: &Access) -> bool {
        match self.chart.as_ref().filter(|_| self.language.is_chart()) {
            Some(chart) => chart.action_at(access.anchor).is_some_and(|it| it.language == Some(CodeLanguage::St)),
            None => self.language == Language::Pl7St,
        }
    }

    /// What a block of STEP 7 or STEP 5 declares by itself.
    pub fn fields(&self) -> &[Field] {
        self.declared.as_ref().map_or(&[], DataType::fields)
    }

    /// Place of an anchor; the heading when there is none.
    pub fn place(&self, anchor: u32) -> TextRange {
        self.anchors.get(anchor as usize).or(self.anchors.first()).copied().unwrap_or_default()
    }

    pub fn heading(&self) -> TextRange {
        self.place(0)
    }
}

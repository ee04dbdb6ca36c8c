//! Every instruction of the S7-300/400 statement list, under both mnemonic sets.
//!
//! [`lookup`] maps a mnemonic to the dialect-neutral [`Op`]; [`Op::operand`] says what may stand after it.

use crate::syntax::Mnemonics;
use crate::syntax::packed::pack;

/// Number format that an arithmetic or compare instruction works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NumberType {
    /// 16-bit integer.
    Int,
    /// 32-bit integer.
    Dint,
    /// 32-bit floating point.
    Real,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Relation {
    Eq,
    Ne,
    Gt,
    Lt,
    Ge,
    Le,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ArithOp {
    Add,
    Sub,
    Mul,
    Div,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LogicOp {
    And,
    Or,
    Xor,
}

/// Operand width of word logic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Width {
    Word,
    Dword,
}

/// How a timer is started (S7:492-561). International mnemonics in the comments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TimerMode {
    /// `SP`
    Pulse,
    /// `SE`
    ExtendedPulse,
    /// `SD`
    OnDelay,
    /// `SS`
    RetentiveOnDelay,
    /// `SF`
    OffDelay,
}

/// When a jump is taken. International mnemonics in the comments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JumpIf {
    /// `JU`
    Always,
    /// `JC`: RLO = 1.
    Rlo,
    /// `JCN`: RLO = 0.
    NotRlo,
    /// `JCB`: RLO = 1, and the RLO is saved in BR.
    RloSave,
    /// `JNB`: RLO = 0, and the RLO is saved in BR.
    NotRloSave,
    /// `JBI`: BR = 1.
    Br,
    /// `JNBI`: BR = 0.
    NotBr,
    /// `JO`: OV = 1.
    Overflow,
    /// `JOS`: OS = 1.
    StoredOverflow,
    /// `JZ`
    Zero,
    /// `JN`
    NotZero,
    /// `JP`
    Plus,
    /// `JM`
    Minus,
    /// `JPZ`
    PlusOrZero,
    /// `JMZ`
    MinusOrZero,
    /// `JUO`
    Unordered,
}

/// Shifts and rotations of accumulator 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shift {
    /// `SSI`
    SignedInt,
    /// `SSD`
    SignedDint,
    /// `SLW`
    LeftWord,
    /// `SRW`
    RightWord,
    /// `SLD`
    LeftDword,
    /// `SRD`
    RightDword,
    /// `RLD`
    RotateLeft,
    /// `RRD`
    RotateRight,
    /// `RLDA`: by one place, through CC 1.
    RotateLeftThroughCc1,
    /// `RRDA`: by one place, through CC 1.
    RotateRightThroughCc1,
}

/// Conversions of accumulator 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Conversion {
    /// `BTI`
    BcdToInt,
    /// `ITB`
    IntToBcd,
    /// `BTD`
    BcdToDint,
    /// `DTB`
    DintToBcd,
    /// `ITD`
    IntToDint,
    /// `DTR`
    DintToReal,
    /// `RND`
    Round,
    /// `RND+`
    RoundUp,
    /// `RND-`
    RoundDown,
    /// `TRUNC`
    Truncate,
    /// `INVI`
    OnesComplementInt,
    /// `INVD`
    OnesComplementDint,
    /// `NEGI`
    NegateInt,
    /// `NEGD`
    NegateDint,
    /// `NEGR`
    NegateReal,
    /// `CAW`
    SwapBytesWord,
    /// `CAD`
    SwapBytesDword,
}

/// Floating-point functions of accumulator 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RealFunction {
    Abs,
    Square,
    SquareRoot,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AddressRegister {
    Ar1,
    Ar2,
}

/// What an instruction does, whatever mnemonic set it was written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Op {
    And,
    AndNot,
    /// With an operand; without one it ORs two AND terms (S7:208-220).
    Or,
    OrNot,
    Xor,
    XorNot,
    AndOpen,
    AndNotOpen,
    OrOpen,
    OrNotOpen,
    XorOpen,
    XorNotOpen,
    /// `)`
    Close,
    Assign,
    /// Sets a bit, or a counter to the value in accumulator 1.
    Set,
    /// Resets a bit, timer or counter.
    Reset,
    /// `NOT`
    NegateRlo,
    /// `SET`
    SetRlo,
    /// `CLR`
    ClearRlo,
    /// `SAVE`: RLO to BR.
    SaveRlo,
    EdgePositive,
    EdgeNegative,
    Load,
    /// `LC`: timer or counter value as BCD.
    LoadBcd,
    Transfer,
    Timer(TimerMode),
    /// `FR`
    Enable,
    CountUp,
    CountDown,
    Compare(Relation, NumberType),
    Arithmetic(ArithOp, NumberType),
    /// `MOD`: remainder of a 32-bit division.
    Modulo,
    /// `+ 5`
    AddConstant,
    Jump(JumpIf),
    /// `JL`: over the list of `JU` that follows, by accumulator 1.
    JumpList,
    Loop,
    Call,
    /// `UC`
    CallUnconditional,
    /// `CC`: if RLO = 1.
    CallConditional,
    BlockEnd,
    /// `BEU`
    BlockEndUnconditional,
    /// `BEC`: if RLO = 1.
    BlockEndConditional,
    /// `OPN`
    OpenDb,
    /// `CDB`: exchanges the shared and the instance data block register.
    SwapDb,
    McrOpen,
    McrClose,
    McrActivate,
    McrDeactivate,
    /// With the constant of its operand, or with accumulator 2.
    WordLogic(LogicOp, Width),
    Shift(Shift),
    Convert(Conversion),
    Real(RealFunction),
    /// `TAK`: exchanges accumulators 1 and 2.
    SwapAccumulators,
    Push,
    Pop,
    /// `ENT`: accumulator stack up (four accumulators).
    Enter,
    /// `LEAVE`: accumulator stack down (four accumulators).
    Leave,
    /// `INC`: adds to the low byte of accumulator 1.
    Increment,
    Decrement,
    LoadAddressRegister(AddressRegister),
    TransferAddressRegister(AddressRegister),
    AddAddressRegister(AddressRegister),
    /// `CAR`: exchanges the address registers.
    SwapAddressRegisters,
    Nop,
    /// `BLD`: display instruction of the programming device, without effect.
    Display,
    /// STEP 5 `P`, `PN`: checks a bit for 1 (`true`) or 0, whatever the RLO was.
    TestBit(bool),
    /// STEP 5 `SU`: sets a bit whatever the RLO is.
    SetAlways,
    /// STEP 5 `RU`.
    ResetAlways,
    /// STEP 5 `E DB`: makes a data block of as many words as accumulator 1 says.
    Generate,
    /// STEP 5 `B MW`: the word is added to the operand of the next instruction.
    Process,
    /// STEP 5 `STP`, `STS`: stops the controller.
    Stop,
    /// STEP 5 instructions to the system, such as `AS`: no effect on what the program computes.
    Control,
    /// STEP 5 `LIR`: from the place whose address is in accumulator 1.
    LoadRegister,
    /// STEP 5 `TIR`, `TNB`: to a place whose address is in an accumulator.
    TransferRegister,
}

/// What kind of operand an instruction works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OperandKind {
    /// A bit, status bit, timer or counter as a bit.
    Bit,
    /// A byte, word, double word, timer, counter or constant.
    Value,
    /// A byte, word or double word that can be written.
    Target,
    Timer,
    Counter,
    TimerOrCounter,
    Label,
    /// An OB-callable block: FB, FC, SFB, SFC or a multi-instance.
    CodeBlock,
    /// A data block, shared (DB) or instance (DI).
    DataBlock,
    /// A constant of the width of the instruction.
    Constant,
    /// A pointer, double word or the other address register.
    Pointer,
    /// A plain number: shift count, increment, display code.
    Number,
}

impl OperandKind {
    /// For messages: `a bit`.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Bit => "a bit",
            Self::Value => "a value",
            Self::Target => "a byte, word or double word",
            Self::Timer => "a timer",
            Self::Counter => "a counter",
            Self::TimerOrCounter => "a timer or counter",
            Self::Label => "a jump label",
            Self::CodeBlock => "a block",
            Self::DataBlock => "a data block",
            Self::Constant => "a constant",
            Self::Pointer => "a pointer",
            Self::Number => "a number",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OperandRule {
    None,
    Optional(OperandKind),
    Required(OperandKind),
}

impl Op {
    pub fn operand(self) -> OperandRule {
        use OperandRule::{None, Optional, Required};
        match self {
            Self::And
            | Self::AndNot
            | Self::OrNot
            | Self::Xor
            | Self::XorNot
            | Self::Assign
            | Self::Set
            | Self::Reset
            | Self::EdgePositive
            | Self::EdgeNegative
            | Self::TestBit(_)
            | Self::SetAlways
            | Self::ResetAlways => Required(OperandKind::Bit),
            Self::Or => Optional(OperandKind::Bit),
            Self::Load | Self::Process => Required(OperandKind::Value),
            Self::LoadBcd | Self::Enable => Required(OperandKind::TimerOrCounter),
            Self::Transfer => Required(OperandKind::Target),
            Self::Timer(_) => Required(OperandKind::Timer),
            Self::CountUp | Self::CountDown => Required(OperandKind::Counter),
            Self::AddConstant => Required(OperandKind::Constant),
            Self::Jump(_) | Self::JumpList | Self::Loop => Required(OperandKind::Label),
            Self::Call | Self::CallUnconditional | Self::CallConditional => Required(OperandKind::CodeBlock),
            Self::OpenDb | Self::Generate => Required(OperandKind::DataBlock),
            Self::LoadRegister | Self::TransferRegister => Required(OperandKind::Number),
            Self::WordLogic(..) => Optional(OperandKind::Constant),
            Self::Shift(Shift::RotateLeftThroughCc1 | Shift::RotateRightThroughCc1) => None,
            Self::Shift(_) => Optional(OperandKind::Number),
            Self::Increment | Self::Decrement | Self::Nop | Self::Display => Required(OperandKind::Number),
            Self::LoadAddressRegister(_) | Self::TransferAddressRegister(_) | Self::AddAddressRegister(_) => {
                Optional(OperandKind::Pointer)
            }
            Self::AndOpen
            | Self::AndNotOpen
            | Self::OrOpen
            | Self::OrNotOpen
            | Self::XorOpen
            | Self::XorNotOpen
            | Self::Close
            | Self::NegateRlo
            | Self::SetRlo
            | Self::ClearRlo
            | Self::SaveRlo
            | Self::Compare(..)
            | Self::Arithmetic(..)
            | Self::Modulo
            | Self::BlockEnd
            | Self::BlockEndUnconditional
            | Self::BlockEndConditional
            | Self::SwapDb
            | Self::McrOpen
            | Self::McrClose
            | Self::McrActivate
            | Self::McrDeactivate
            | Self::Convert(_)
            | Self::Real(_)
            | Self::SwapAccumulators
            | Self::Push
            | Self::Pop
            | Self::Enter
            | Self::Leave
            | Self::SwapAddressRegisters
            | Self::Stop
            | Self::Control => None,
        }
    }
}

/// The mnemonic of `word` in one set, ignoring case. Parentheses belong to the mnemonic: `U(`, `)`, `MCR(`, `)MCR`.
/// `NOP0` is `NOP 0` written together, which leaves it no operand.
pub fn lookup(word: &str, mnemonics: Mnemonics) -> Option<Op> {
    WORDS.lookup(word, mnemonics)
}

/// Every mnemonic of a set.
pub fn all(mnemonics: Mnemonics) -> impl Iterator<Item = &'static str> {
    WORDS.all(mnemonics)
}

/// Like [`lookup`] for `word` with a `(` after it.
pub(super) fn lookup_open(word: &str, mnemonics: Mnemonics) -> Option<Op> {
    WORDS.lookup_before(word, b'(', mnemonics)
}

/// The set that alone has `word`, if one does.
pub(super) fn only_in(word: &[u8]) -> Option<Mnemonics> {
    WORDS.only_in(word)
}

/// Whether `word` is a mnemonic of any set.
pub(super) fn is_mnemonic(word: &[u8]) -> bool {
    WORDS.has(word)
}

/// The mnemonics of a language in both sets: open addressing with at most half of the slots taken, so that probing ends.
pub(in crate::syntax) struct Words {
    slots: [Entry; SLOTS],
    /// Words of both sets, of the German one alone, of the English one alone.
    lists: [&'static [(&'static str, Op)]; 3],
}

#[derive(Clone, Copy)]
struct Entry {
    /// 0 for a free slot.
    key: u64,
    german: Option<Op>,
    english: Option<Op>,
}

const SLOTS: usize = 1024;

impl Words {
    /// Words of both sets, then those of one.
    pub(in crate::syntax) const fn new(
        both: &'static [(&'static str, Op)],
        german: &'static [(&'static str, Op)],
        english: &'static [(&'static str, Op)],
    ) -> Self {
        assert!((both.len() + german.len() + english.len()) * 2 < SLOTS);
        let mut table = [Entry { key: 0, german: None, english: None }; SLOTS];
        let mut at = 0;
        while at < both.len() {
            insert(&mut table, both[at].0, Some(both[at].1), Some(both[at].1));
            at += 1;
        }
        let mut at = 0;
        while at < german.len() {
            insert(&mut table, german[at].0, Some(german[at].1), None);
            at += 1;
        }
        let mut at = 0;
        while at < english.len() {
            insert(&mut table, english[at].0, None, Some(english[at].1));
            at += 1;
        }
        Self { slots: table, lists: [both, german, english] }
    }

    /// Every mnemonic of a set.
    pub(in crate::syntax) fn all(&self, mnemonics: Mnemonics) -> impl Iterator<Item = &'static str> + use<> {
        let [both, german, english] = self.lists;
        let own = match mnemonics {
            Mnemonics::German => german,
            Mnemonics::English => english,
        };
        both.iter().chain(own).map(|it| it.0)
    }

    /// The mnemonic of `word` in one set, ignoring case.
    pub(in crate::syntax) fn lookup(&self, word: &str, mnemonics: Mnemonics) -> Option<Op> {
        self.find(key(word.as_bytes())?, mnemonics)
    }

    /// Like [`Self::lookup`] for `word` with one more character after it.
    pub(in crate::syntax) fn lookup_before(&self, word: &str, last: u8, mnemonics: Mnemonics) -> Option<Op> {
        let key = key(word.as_bytes())?;
        if key >> 56 != 0 {
            return None;
        }
        self.find(key << 8 | pack(&[last]) as u64, mnemonics)
    }

    /// The set that alone has `word`, if one does.
    pub(in crate::syntax) fn only_in(&self, word: &[u8]) -> Option<Mnemonics> {
        let entry = self.entry(key(word)?)?;
        match (entry.german, entry.english) {
            (Some(_), None) => Some(Mnemonics::German),
            (None, Some(_)) => Some(Mnemonics::English),
            _ => None,
        }
    }

    /// Whether `word` is a mnemonic of any set.
    pub(in crate::syntax) fn has(&self, word: &[u8]) -> bool {
        key(word).and_then(|it| self.entry(it)).is_some()
    }

    fn find(&self, key: u64, mnemonics: Mnemonics) -> Option<Op> {
        let entry = self.entry(key)?;
        match mnemonics {
            Mnemonics::German => entry.german,
            Mnemonics::English => entry.english,
        }
    }

    fn entry(&self, key: u64) -> Option<&Entry> {
        let mut slot = slot(key);
        loop {
            let entry = &self.slots[slot];
            if entry.key == key {
                return Some(entry);
            }
            if entry.key == 0 {
                return None;
            }
            slot = (slot + 1) % SLOTS;
        }
    }
}

/// The word as a number; mnemonics are short. `None` for longer and for empty words.
const fn key(word: &[u8]) -> Option<u64> {
    if word.is_empty() || word.len() > 8 {
        return None;
    }
    Some(pack(word) as u64)
}

const fn slot(key: u64) -> usize {
    (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 54) as usize
}

const fn insert(table: &mut [Entry; SLOTS], word: &str, german: Option<Op>, english: Option<Op>) {
    let Some(key) = key(word.as_bytes()) else { panic!("mnemonic too long") };
    let mut slot = slot(key);
    while table[slot].key != 0 && table[slot].key != key {
        slot = (slot + 1) % SLOTS;
    }
    table[slot].key = key;
    if german.is_some() {
        assert!(table[slot].german.is_none(), "mnemonic listed twice");
        table[slot].german = german;
    }
    if english.is_some() {
        assert!(table[slot].english.is_none(), "mnemonic listed twice");
        table[slot].english = english;
    }
}

pub(super) static WORDS: Words = Words::new(BOTH, GERMAN, ENGLISH);

/// Same word and meaning in both sets.
const BOTH: &[(&str, Op)] = {
    use AddressRegister::{Ar1, Ar2};
    use ArithOp::{Add, Div, Mul, Sub};
    use NumberType::{Dint, Int, Real};
    use Relation::{Eq, Ge, Gt, Le, Lt, Ne};
    &[
        ("O", Op::Or),
        ("ON", Op::OrNot),
        ("X", Op::Xor),
        ("XN", Op::XorNot),
        ("O(", Op::OrOpen),
        ("ON(", Op::OrNotOpen),
        ("X(", Op::XorOpen),
        ("XN(", Op::XorNotOpen),
        (")", Op::Close),
        ("=", Op::Assign),
        ("S", Op::Set),
        ("R", Op::Reset),
        ("NOT", Op::NegateRlo),
        ("SET", Op::SetRlo),
        ("CLR", Op::ClearRlo),
        ("SAVE", Op::SaveRlo),
        ("FP", Op::EdgePositive),
        ("FN", Op::EdgeNegative),
        ("L", Op::Load),
        ("LC", Op::LoadBcd),
        ("T", Op::Transfer),
        ("SS", Op::Timer(TimerMode::RetentiveOnDelay)),
        ("FR", Op::Enable),
        ("==I", Op::Compare(Eq, Int)),
        ("<>I", Op::Compare(Ne, Int)),
        (">I", Op::Compare(Gt, Int)),
        ("<I", Op::Compare(Lt, Int)),
        (">=I", Op::Compare(Ge, Int)),
        ("<=I", Op::Compare(Le, Int)),
        ("==D", Op::Compare(Eq, Dint)),
        ("<>D", Op::Compare(Ne, Dint)),
        (">D", Op::Compare(Gt, Dint)),
        ("<D", Op::Compare(Lt, Dint)),
        (">=D", Op::Compare(Ge, Dint)),
        ("<=D", Op::Compare(Le, Dint)),
        ("==R", Op::Compare(Eq, Real)),
        ("<>R", Op::Compare(Ne, Real)),
        (">R", Op::Compare(Gt, Real)),
        ("<R", Op::Compare(Lt, Real)),
        (">=R", Op::Compare(Ge, Real)),
        ("<=R", Op::Compare(Le, Real)),
        ("+I", Op::Arithmetic(Add, Int)),
        ("-I", Op::Arithmetic(Sub, Int)),
        ("*I", Op::Arithmetic(Mul, Int)),
        ("/I", Op::Arithmetic(Div, Int)),
        ("+D", Op::Arithmetic(Add, Dint)),
        ("-D", Op::Arithmetic(Sub, Dint)),
        ("*D", Op::Arithmetic(Mul, Dint)),
        ("/D", Op::Arithmetic(Div, Dint)),
        ("+R", Op::Arithmetic(Add, Real)),
        ("-R", Op::Arithmetic(Sub, Real)),
        ("*R", Op::Arithmetic(Mul, Real)),
        ("/R", Op::Arithmetic(Div, Real)),
        ("MOD", Op::Modulo),
        ("+", Op::AddConstant),
        ("LOOP", Op::Loop),
        ("CALL", Op::Call),
        ("UC", Op::CallUnconditional),
        ("CC", Op::CallConditional),
        ("BE", Op::BlockEnd),
        ("MCR(", Op::McrOpen),
        (")MCR", Op::McrClose),
        ("MCRA", Op::McrActivate),
        ("MCRD", Op::McrDeactivate),
        ("OW", Op::WordLogic(LogicOp::Or, Width::Word)),
        ("XOW", Op::WordLogic(LogicOp::Xor, Width::Word)),
        ("OD", Op::WordLogic(LogicOp::Or, Width::Dword)),
        ("XOD", Op::WordLogic(LogicOp::Xor, Width::Dword)),
        ("SSI", Op::Shift(Shift::SignedInt)),
        ("SSD", Op::Shift(Shift::SignedDint)),
        ("SLW", Op::Shift(Shift::LeftWord)),
        ("SRW", Op::Shift(Shift::RightWord)),
        ("SLD", Op::Shift(Shift::LeftDword)),
        ("SRD", Op::Shift(Shift::RightDword)),
        ("RLD", Op::Shift(Shift::RotateLeft)),
        ("RRD", Op::Shift(Shift::RotateRight)),
        ("RLDA", Op::Shift(Shift::RotateLeftThroughCc1)),
        ("RRDA", Op::Shift(Shift::RotateRightThroughCc1)),
        ("BTI", Op::Convert(Conversion::BcdToInt)),
        ("ITB", Op::Convert(Conversion::IntToBcd)),
        ("BTD", Op::Convert(Conversion::BcdToDint)),
        ("DTB", Op::Convert(Conversion::DintToBcd)),
        ("ITD", Op::Convert(Conversion::IntToDint)),
        ("DTR", Op::Convert(Conversion::DintToReal)),
        ("RND", Op::Convert(Conversion::Round)),
        ("RND+", Op::Convert(Conversion::RoundUp)),
        ("RND-", Op::Convert(Conversion::RoundDown)),
        ("TRUNC", Op::Convert(Conversion::Truncate)),
        ("INVI", Op::Convert(Conversion::OnesComplementInt)),
        ("INVD", Op::Convert(Conversion::OnesComplementDint)),
        ("NEGI", Op::Convert(Conversion::NegateInt)),
        ("NEGD", Op::Convert(Conversion::NegateDint)),
        ("NEGR", Op::Convert(Conversion::NegateReal)),
        ("ABS", Op::Real(RealFunction::Abs)),
        ("SQR", Op::Real(RealFunction::Square)),
        ("SQRT", Op::Real(RealFunction::SquareRoot)),
        ("EXP", Op::Real(RealFunction::Exp)),
        ("LN", Op::Real(RealFunction::Ln)),
        ("SIN", Op::Real(RealFunction::Sin)),
        ("COS", Op::Real(RealFunction::Cos)),
        ("TAN", Op::Real(RealFunction::Tan)),
        ("ASIN", Op::Real(RealFunction::Asin)),
        ("ACOS", Op::Real(RealFunction::Acos)),
        ("ATAN", Op::Real(RealFunction::Atan)),
        ("TAK", Op::SwapAccumulators),
        ("PUSH", Op::Push),
        ("POP", Op::Pop),
        ("ENT", Op::Enter),
        ("LEAVE", Op::Leave),
        ("INC", Op::Increment),
        ("DEC", Op::Decrement),
        ("LAR1", Op::LoadAddressRegister(Ar1)),
        ("LAR2", Op::LoadAddressRegister(Ar2)),
        ("TAR1", Op::TransferAddressRegister(Ar1)),
        ("TAR2", Op::TransferAddressRegister(Ar2)),
        ("+AR1", Op::AddAddressRegister(Ar1)),
        ("+AR2", Op::AddAddressRegister(Ar2)),
        ("NOP", Op::Nop),
        ("NOP0", Op::Nop),
        ("NOP1", Op::Nop),
        ("BLD", Op::Display),
    ]
};

/// SIMATIC mnemonics.
const GERMAN: &[(&str, Op)] = &[
    ("U", Op::And),
    ("UN", Op::AndNot),
    ("U(", Op::AndOpen),
    ("UN(", Op::AndNotOpen),
    ("SI", Op::Timer(TimerMode::Pulse)),
    ("SV", Op::Timer(TimerMode::ExtendedPulse)),
    ("SE", Op::Timer(TimerMode::OnDelay)),
    ("SA", Op::Timer(TimerMode::OffDelay)),
    ("ZV", Op::CountUp),
    ("ZR", Op::CountDown),
    ("SPA", Op::Jump(JumpIf::Always)),
    ("SPB", Op::Jump(JumpIf::Rlo)),
    ("SPBN", Op::Jump(JumpIf::NotRlo)),
    ("SPBB", Op::Jump(JumpIf::RloSave)),
    ("SPBNB", Op::Jump(JumpIf::NotRloSave)),
    ("SPBI", Op::Jump(JumpIf::Br)),
    ("SPBIN", Op::Jump(JumpIf::NotBr)),
    ("SPO", Op::Jump(JumpIf::Overflow)),
    ("SPS", Op::Jump(JumpIf::StoredOverflow)),
    ("SPZ", Op::Jump(JumpIf::Zero)),
    ("SPN", Op::Jump(JumpIf::NotZero)),
    ("SPP", Op::Jump(JumpIf::Plus)),
    ("SPM", Op::Jump(JumpIf::Minus)),
    ("SPPZ", Op::Jump(JumpIf::PlusOrZero)),
    ("SPMZ", Op::Jump(JumpIf::MinusOrZero)),
    ("SPU", Op::Jump(JumpIf::Unordered)),
    ("SPL", Op::JumpList),
    ("BEA", Op::BlockEndUnconditional),
    ("BEB", Op::BlockEndConditional),
    ("AUF", Op::OpenDb),
    ("TDB", Op::SwapDb),
    ("UW", Op::WordLogic(LogicOp::And, Width::Word)),
    ("UD", Op::WordLogic(LogicOp::And, Width::Dword)),
    ("TAW", Op::Convert(Conversion::SwapBytesWord)),
    ("TAD", Op::Convert(Conversion::SwapBytesDword)),
    ("TAR", Op::SwapAddressRegisters),
];

/// International mnemonics.
const ENGLISH: &[(&str, Op)] = &[
    ("A", Op::And),
    ("AN", Op::AndNot),
    ("A(", Op::AndOpen),
    ("AN(", Op::AndNotOpen),
    ("SP", Op::Timer(TimerMode::Pulse)),
    ("SE", Op::Timer(TimerMode::ExtendedPulse)),
    ("SD", Op::Timer(TimerMode::OnDelay)),
    ("SF", Op::Timer(TimerMode::OffDelay)),
    ("CU", Op::CountUp),
    ("CD", Op::CountDown),
    ("JU", Op::Jump(JumpIf::Always)),
    ("JC", Op::Jump(JumpIf::Rlo)),
    ("JCN", Op::Jump(JumpIf::NotRlo)),
    ("JCB", Op::Jump(JumpIf::RloSave)),
    ("JNB", Op::Jump(JumpIf::NotRloSave)),
    ("JBI", Op::Jump(JumpIf::Br)),
    ("JNBI", Op::Jump(JumpIf::NotBr)),
    ("JO", Op::Jump(JumpIf::Overflow)),
    ("JOS", Op::Jump(JumpIf::StoredOverflow)),
    ("JZ", Op::Jump(JumpIf::Zero)),
    ("JN", Op::Jump(JumpIf::NotZero)),
    ("JP", Op::Jump(JumpIf::Plus)),
    ("JM", Op::Jump(JumpIf::Minus)),
    ("JPZ", Op::Jump(JumpIf::PlusOrZero)),
    ("JMZ", Op::Jump(JumpIf::MinusOrZero)),
    ("JUO", Op::Jump(JumpIf::Unordered)),
    ("JL", Op::JumpList),
    ("BEU", Op::BlockEndUnconditional),
    ("BEC", Op::BlockEndConditional),
    ("OPN", Op::OpenDb),
    ("CDB", Op::SwapDb),
    ("AW", Op::WordLogic(LogicOp::And, Width::Word)),
    ("AD", Op::WordLogic(LogicOp::And, Width::Dword)),
    ("CAW", Op::Convert(Conversion::SwapBytesWord)),
    ("CAD", Op::Convert(Conversion::SwapBytesDword)),
    ("CAR", Op::SwapAddressRegisters),
];

//! The instructions of STEP 5 under both mnemonic sets, as the operations that STEP 7 has too.
//!
//! The source document shows the German set (GRF:222-1242); the rest of it, the English set and the substitution
//! instructions for formal operands (`SVZ =`, `RB =`) come from the vendor's general documentation.

use crate::syntax::Mnemonics;
use crate::syntax::awl::ast::Instr;
use crate::syntax::awl::instruction::{
    ArithOp, Conversion, JumpIf, LogicOp, NumberType, Op, Shift, TimerMode, Width, Words,
};

/// The mnemonic of `word` in one set, ignoring case. `(` of `U(` and `=` of `SPA=` belong to it.
pub fn lookup(word: &str, mnemonics: Mnemonics) -> Option<Op> {
    WORDS.lookup(word, mnemonics)
}

/// Every mnemonic of a set.
pub fn all(mnemonics: Mnemonics) -> impl Iterator<Item = &'static str> {
    WORDS.all(mnemonics)
}

/// Like [`lookup`] for `word` with `last` after it.
pub(super) fn lookup_before(word: &str, last: u8, mnemonics: Mnemonics) -> Option<Op> {
    WORDS.lookup_before(word, last, mnemonics)
}

/// The set that alone has `word`, if one does.
pub(super) fn only_in(word: &str) -> Option<Mnemonics> {
    WORDS.only_in(word.as_bytes())
}

/// What an instruction does; `None` for a label alone and for an unknown mnemonic.
pub fn op(instr: Instr<'_>, mnemonics: Mnemonics) -> Option<Op> {
    instr.op_in(&WORDS, mnemonics)
}

static WORDS: Words = Words::new(BOTH, GERMAN, ENGLISH);

/// Same word and meaning in both sets.
const BOTH: &[(&str, Op)] = {
    use crate::syntax::awl::instruction::Relation::{Eq, Ge, Gt, Le, Lt, Ne};
    use ArithOp::{Add, Div, Mul, Sub};
    use NumberType::{Dint, Int, Real};
    &[
        ("O", Op::Or),
        ("ON", Op::OrNot),
        ("O(", Op::OrOpen),
        (")", Op::Close),
        ("=", Op::Assign),
        ("S", Op::Set),
        ("R", Op::Reset),
        ("RB", Op::Reset),
        ("RD", Op::Reset),
        ("SU", Op::SetAlways),
        ("RU", Op::ResetAlways),
        ("L", Op::Load),
        ("LW", Op::Load),
        ("LWD", Op::Load),
        ("LC", Op::LoadBcd),
        ("T", Op::Transfer),
        ("SS", Op::Timer(TimerMode::RetentiveOnDelay)),
        ("FR", Op::Enable),
        ("!=F", Op::Compare(Eq, Int)),
        ("><F", Op::Compare(Ne, Int)),
        (">F", Op::Compare(Gt, Int)),
        ("<F", Op::Compare(Lt, Int)),
        (">=F", Op::Compare(Ge, Int)),
        ("<=F", Op::Compare(Le, Int)),
        ("!=D", Op::Compare(Eq, Dint)),
        ("><D", Op::Compare(Ne, Dint)),
        (">D", Op::Compare(Gt, Dint)),
        ("<D", Op::Compare(Lt, Dint)),
        (">=D", Op::Compare(Ge, Dint)),
        ("<=D", Op::Compare(Le, Dint)),
        ("!=G", Op::Compare(Eq, Real)),
        ("><G", Op::Compare(Ne, Real)),
        (">G", Op::Compare(Gt, Real)),
        ("<G", Op::Compare(Lt, Real)),
        (">=G", Op::Compare(Ge, Real)),
        ("<=G", Op::Compare(Le, Real)),
        ("+F", Op::Arithmetic(Add, Int)),
        ("-F", Op::Arithmetic(Sub, Int)),
        ("XF", Op::Arithmetic(Mul, Int)),
        (":F", Op::Arithmetic(Div, Int)),
        ("+D", Op::Arithmetic(Add, Dint)),
        ("-D", Op::Arithmetic(Sub, Dint)),
        ("+G", Op::Arithmetic(Add, Real)),
        ("-G", Op::Arithmetic(Sub, Real)),
        ("XG", Op::Arithmetic(Mul, Real)),
        (":G", Op::Arithmetic(Div, Real)),
        ("ADD", Op::AddConstant),
        ("OW", Op::WordLogic(LogicOp::Or, Width::Word)),
        ("XOW", Op::WordLogic(LogicOp::Xor, Width::Word)),
        ("SLW", Op::Shift(Shift::LeftWord)),
        ("SRW", Op::Shift(Shift::RightWord)),
        ("SLD", Op::Shift(Shift::LeftDword)),
        ("RLD", Op::Shift(Shift::RotateLeft)),
        ("RRD", Op::Shift(Shift::RotateRight)),
        ("DEF", Op::Convert(Conversion::BcdToInt)),
        ("DUF", Op::Convert(Conversion::IntToBcd)),
        ("DED", Op::Convert(Conversion::BcdToDint)),
        ("DUD", Op::Convert(Conversion::DintToBcd)),
        ("FDG", Op::Convert(Conversion::DintToReal)),
        ("GFD", Op::Convert(Conversion::Round)),
        ("TAK", Op::SwapAccumulators),
        ("ENT", Op::Enter),
        ("I", Op::Increment),
        ("D", Op::Decrement),
        ("LIR", Op::LoadRegister),
        ("TIR", Op::TransferRegister),
        ("TNB", Op::TransferRegister),
        ("TNW", Op::TransferRegister),
        ("BE", Op::BlockEnd),
        ("STP", Op::Stop),
        ("STS", Op::Stop),
        ("STW", Op::Stop),
        ("SIM", Op::Control),
        ("LIM", Op::Control),
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
    ("P", Op::TestBit(true)),
    ("PN", Op::TestBit(false)),
    ("SI", Op::Timer(TimerMode::Pulse)),
    ("SV", Op::Timer(TimerMode::ExtendedPulse)),
    ("SVZ", Op::Timer(TimerMode::ExtendedPulse)),
    ("SE", Op::Timer(TimerMode::OnDelay)),
    ("SSV", Op::Timer(TimerMode::RetentiveOnDelay)),
    ("SA", Op::Timer(TimerMode::OffDelay)),
    ("SAR", Op::Timer(TimerMode::OffDelay)),
    ("ZV", Op::CountUp),
    ("ZR", Op::CountDown),
    ("SPA", Op::CallUnconditional),
    ("SPB", Op::CallConditional),
    ("BA", Op::CallUnconditional),
    ("BAB", Op::CallConditional),
    ("SPA=", Op::Jump(JumpIf::Always)),
    ("SPB=", Op::Jump(JumpIf::Rlo)),
    ("SPZ=", Op::Jump(JumpIf::Zero)),
    ("SPN=", Op::Jump(JumpIf::NotZero)),
    ("SPP=", Op::Jump(JumpIf::Plus)),
    ("SPM=", Op::Jump(JumpIf::Minus)),
    ("SPO=", Op::Jump(JumpIf::Overflow)),
    ("SPS=", Op::Jump(JumpIf::StoredOverflow)),
    ("BEA", Op::BlockEndUnconditional),
    ("BEB", Op::BlockEndConditional),
    ("A", Op::OpenDb),
    ("AX", Op::OpenDb),
    ("E", Op::Generate),
    ("EX", Op::Generate),
    ("B", Op::Process),
    ("UW", Op::WordLogic(LogicOp::And, Width::Word)),
    ("KEW", Op::Convert(Conversion::OnesComplementInt)),
    ("KZW", Op::Convert(Conversion::NegateInt)),
    ("KZD", Op::Convert(Conversion::NegateDint)),
    ("SVW", Op::Shift(Shift::SignedInt)),
    ("SVD", Op::Shift(Shift::SignedDint)),
    ("AS", Op::Control),
    ("AF", Op::Control),
];

/// International mnemonics.
const ENGLISH: &[(&str, Op)] = &[
    ("A", Op::And),
    ("AN", Op::AndNot),
    ("A(", Op::AndOpen),
    ("TB", Op::TestBit(true)),
    ("TBN", Op::TestBit(false)),
    ("LD", Op::LoadBcd),
    ("SP", Op::Timer(TimerMode::Pulse)),
    ("SE", Op::Timer(TimerMode::ExtendedPulse)),
    ("SEC", Op::Timer(TimerMode::ExtendedPulse)),
    // The older manuals write SR.
    ("SD", Op::Timer(TimerMode::OnDelay)),
    ("SR", Op::Timer(TimerMode::OnDelay)),
    ("SSU", Op::Timer(TimerMode::RetentiveOnDelay)),
    ("SF", Op::Timer(TimerMode::OffDelay)),
    ("SFD", Op::Timer(TimerMode::OffDelay)),
    ("CU", Op::CountUp),
    ("CD", Op::CountDown),
    ("JU", Op::CallUnconditional),
    ("JC", Op::CallConditional),
    ("DOU", Op::CallUnconditional),
    ("DOC", Op::CallConditional),
    ("JU=", Op::Jump(JumpIf::Always)),
    ("JC=", Op::Jump(JumpIf::Rlo)),
    ("JZ=", Op::Jump(JumpIf::Zero)),
    ("JN=", Op::Jump(JumpIf::NotZero)),
    ("JP=", Op::Jump(JumpIf::Plus)),
    ("JM=", Op::Jump(JumpIf::Minus)),
    ("JO=", Op::Jump(JumpIf::Overflow)),
    ("JOS=", Op::Jump(JumpIf::StoredOverflow)),
    ("BEU", Op::BlockEndUnconditional),
    ("BEC", Op::BlockEndConditional),
    ("C", Op::OpenDb),
    ("CX", Op::OpenDb),
    ("G", Op::Generate),
    ("GX", Op::Generate),
    ("DO", Op::Process),
    ("AW", Op::WordLogic(LogicOp::And, Width::Word)),
    ("CFW", Op::Convert(Conversion::OnesComplementInt)),
    ("CSW", Op::Convert(Conversion::NegateInt)),
    ("CSD", Op::Convert(Conversion::NegateDint)),
    ("SSW", Op::Shift(Shift::SignedInt)),
    ("SSD", Op::Shift(Shift::SignedDint)),
    ("IA", Op::Control),
    ("RA", Op::Control),
];

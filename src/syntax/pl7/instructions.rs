//! The instructions of the instruction list (PL7:3065-3127, 3130-3310).

use super::word::{self, words};

words! {
    /// Operation of an instruction, without the `(` that `AND(` and `OR(` carry.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum IlOp {
        Ld = "LD",
        LdN = "LDN",
        LdR = "LDR",
        LdF = "LDF",
        And = "AND",
        AndN = "ANDN",
        AndR = "ANDR",
        AndF = "ANDF",
        Or = "OR",
        OrN = "ORN",
        OrR = "ORR",
        OrF = "ORF",
        Xor = "XOR",
        XorN = "XORN",
        XorR = "XORR",
        XorF = "XORF",
        N = "N",
        Mps = "MPS",
        Mrd = "MRD",
        Mpp = "MPP",
        St = "ST",
        StN = "STN",
        S = "S",
        R = "R",
        Jmp = "JMP",
        JmpC = "JMPC",
        JmpCN = "JMPCN",
        Sr = "SR",
        Ret = "RET",
        RetC = "RETC",
        RetCN = "RETCN",
        End = "END",
        EndC = "ENDC",
        EndCN = "ENDCN",
        Halt = "HALT",
        Blk = "BLK",
        OutBlk = "OUT_BLK",
        EndBlk = "END_BLK",
        In = "IN",
        Cu = "CU",
        Cd = "CD",
        I = "I",
        O = "O",
        U = "U",
    }
}

/// What an instruction does with the Boolean result that the instructions before it left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Class {
    /// Makes a new Boolean result.
    Test,
    /// Moves Boolean results between the accumulator and the stack of three (PL7:3232).
    Stack,
    /// Applies the Boolean result.
    Action,
    /// Leaves the sequence, always or as the Boolean result says.
    Branch(When),
    /// Drives an input of a function block, or frames its structured form (PL7:3277-3303).
    Block,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum When {
    Always,
    /// The Boolean result is 1.
    True,
    /// The Boolean result is 0.
    False,
}

/// What must follow an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operand {
    None,
    /// A bit, `TRUE`, `FALSE`, or a comparison in brackets.
    Test,
    /// A bit that the program may write.
    Bit,
    /// A bit that the program may write, or a function block that has an input of the instruction's name. Inside
    /// `BLK ... OUT_BLK` the block goes without saying.
    BitOrBlock,
    /// A function block that has an input of the instruction's name; optional inside `BLK ... OUT_BLK`.
    Input,
    /// A function block.
    Block,
    Label,
    /// The number of a subroutine, which is usually part of the word: `SR5`.
    Subroutine,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    pub op: IlOp,
    pub mnemonic: &'static str,
    pub class: Class,
    pub operand: Operand,
    /// Line of the PL7 manual that gives the instruction. 0: the input of a block that the manual's first volume
    /// shows in a drawing only; the name is that of the second volume.
    pub line: u16,
}

impl Instruction {
    const fn new(op: IlOp, mnemonic: &'static str, class: Class, operand: Operand, line: u16) -> Self {
        Self { op, mnemonic, class, operand, line }
    }

    /// Whether a sequence may start with the instruction: an `LD` or an unconditional one (PL7:3319).
    ///
    /// The manual states no condition for `SRn`, `HALT` and the frame of a block, so they count as unconditional.
    pub fn starts_sequence(&self) -> bool {
        matches!(self.op, IlOp::Ld | IlOp::LdN | IlOp::LdR | IlOp::LdF | IlOp::Blk | IlOp::EndBlk)
            || self.class == Class::Branch(When::Always)
    }
}

/// In the order of [`IlOp`].
const INSTRUCTIONS: &[Instruction] = {
    use Class::{Action, Branch, Stack, Test};
    use IlOp as Op;
    &[
        Instruction::new(Op::Ld, "LD", Test, Operand::Test, 3070),
        Instruction::new(Op::LdN, "LDN", Test, Operand::Test, 3071),
        Instruction::new(Op::LdR, "LDR", Test, Operand::Test, 3072),
        Instruction::new(Op::LdF, "LDF", Test, Operand::Test, 3073),
        Instruction::new(Op::And, "AND", Test, Operand::Test, 3074),
        Instruction::new(Op::AndN, "ANDN", Test, Operand::Test, 3075),
        Instruction::new(Op::AndR, "ANDR", Test, Operand::Test, 3076),
        Instruction::new(Op::AndF, "ANDF", Test, Operand::Test, 3077),
        Instruction::new(Op::Or, "OR", Test, Operand::Test, 3078),
        Instruction::new(Op::OrN, "ORN", Test, Operand::Test, 3079),
        Instruction::new(Op::OrR, "ORR", Test, Operand::Test, 3082),
        Instruction::new(Op::OrF, "ORF", Test, Operand::Test, 3083),
        Instruction::new(Op::Xor, "XOR", Test, Operand::Test, 3086),
        Instruction::new(Op::XorN, "XORN", Test, Operand::Test, 3086),
        Instruction::new(Op::XorR, "XORR", Test, Operand::Test, 3086),
        Instruction::new(Op::XorF, "XORF", Test, Operand::Test, 3086),
        Instruction::new(Op::N, "N", Test, Operand::None, 3088),
        Instruction::new(Op::Mps, "MPS", Stack, Operand::None, 3087),
        Instruction::new(Op::Mrd, "MRD", Stack, Operand::None, 3087),
        Instruction::new(Op::Mpp, "MPP", Stack, Operand::None, 3087),
        Instruction::new(Op::St, "ST", Action, Operand::Bit, 3095),
        Instruction::new(Op::StN, "STN", Action, Operand::Bit, 3096),
        Instruction::new(Op::S, "S", Action, Operand::BitOrBlock, 3097),
        Instruction::new(Op::R, "R", Action, Operand::BitOrBlock, 3098),
        Instruction::new(Op::Jmp, "JMP", Branch(When::Always), Operand::Label, 3099),
        Instruction::new(Op::JmpC, "JMPC", Branch(When::True), Operand::Label, 3102),
        Instruction::new(Op::JmpCN, "JMPCN", Branch(When::False), Operand::Label, 3103),
        Instruction::new(Op::Sr, "SR", Branch(When::Always), Operand::Subroutine, 3104),
        Instruction::new(Op::Ret, "RET", Branch(When::Always), Operand::None, 3105),
        Instruction::new(Op::RetC, "RETC", Branch(When::True), Operand::None, 3106),
        Instruction::new(Op::RetCN, "RETCN", Branch(When::False), Operand::None, 3107),
        Instruction::new(Op::End, "END", Branch(When::Always), Operand::None, 3108),
        Instruction::new(Op::EndC, "ENDC", Branch(When::True), Operand::None, 3109),
        Instruction::new(Op::EndCN, "ENDCN", Branch(When::False), Operand::None, 3110),
        Instruction::new(Op::Halt, "HALT", Branch(When::Always), Operand::None, 3768),
        Instruction::new(Op::Blk, "BLK", Class::Block, Operand::Block, 3299),
        Instruction::new(Op::OutBlk, "OUT_BLK", Class::Block, Operand::None, 3300),
        Instruction::new(Op::EndBlk, "END_BLK", Class::Block, Operand::None, 3301),
        Instruction::new(Op::In, "IN", Class::Block, Operand::Input, 0),
        Instruction::new(Op::Cu, "CU", Class::Block, Operand::Input, 3282),
        Instruction::new(Op::Cd, "CD", Class::Block, Operand::Input, 0),
        Instruction::new(Op::I, "I", Class::Block, Operand::Input, 0),
        Instruction::new(Op::O, "O", Class::Block, Operand::Input, 0),
        Instruction::new(Op::U, "U", Class::Block, Operand::Input, 0),
    ]
};

impl IlOp {
    pub fn info(self) -> &'static Instruction {
        &INSTRUCTIONS[self as usize]
    }

    /// Operation of a word as it stands in a text: `LD`, and also `SR5` and `%SR5`.
    pub fn of_word(text: &str) -> Option<Self> {
        Self::of(text).or_else(|| word::subroutine(text).map(|_| Self::Sr))
    }
}

/// Instruction of that name, in any case. `SR5` is found as `SR`.
pub fn lookup(text: &str) -> Option<&'static Instruction> {
    IlOp::of_word(text).map(IlOp::info)
}

pub fn all() -> &'static [Instruction] {
    INSTRUCTIONS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_follows_the_operations() {
        for (at, instruction) in INSTRUCTIONS.iter().enumerate() {
            assert_eq!(instruction.op as usize, at);
            assert_eq!(IlOp::of(instruction.mnemonic), Some(instruction.op));
            assert_eq!(lookup(&instruction.mnemonic.to_ascii_lowercase()), Some(instruction));
        }
        assert_eq!(INSTRUCTIONS.len(), IlOp::U as usize + 1);
    }

    #[test]
    fn subroutines_are_found_by_number() {
        assert_eq!(lookup("SR5").map(|it| it.op), Some(IlOp::Sr));
        assert_eq!(lookup("%sr5").map(|it| it.op), Some(IlOp::Sr));
        assert_eq!(lookup("SRi"), None);
        assert_eq!(lookup("LDX"), None);
    }

    #[test]
    fn unconditional_instructions_start_a_sequence() {
        let starts = |word| lookup(word).is_some_and(Instruction::starts_sequence);
        assert!(starts("LDF") && starts("JMP") && starts("SR1") && starts("END"));
        assert!(!starts("AND") && !starts("JMPC") && !starts("ST") && !starts("MPS") && !starts("RETCN"));
    }
}

//! Objects and instructions in words, for people who look at them.

use std::fmt::Write as _;

use crate::model::entity::Family;
use crate::model::object::{Class, Object, Rights, Type};
use crate::report::citation;
use crate::syntax::Language;
use crate::syntax::awl::instruction as awl;
use crate::syntax::pl7::{functions, instructions};
use crate::syntax::step5::instruction as step5;

/// `output, 1 bit`.
pub(super) fn kind(object: &Object) -> String {
    let class = class(object.class);
    match size(object.ty) {
        Some(size) => format!("{class}, {size}"),
        None => class.to_owned(),
    }
}

fn class(class: Class) -> &'static str {
    match class {
        Class::Input => "input",
        Class::Output => "output",
        Class::PeripheralInput => "peripheral input",
        Class::PeripheralOutput => "peripheral output",
        Class::Memory => "internal memory",
        Class::Constant => "constant",
        Class::System => "system object",
        Class::Step => "step",
        Class::MacroStep => "macro-step",
        Class::StepTime => "time of a step",
        Class::Fault => "fault of a module or channel",
        Class::ModuleWord => "word exchanged with a module",
        Class::NetworkWord => "common word of the network",
        Class::BlockBit => "bit of a function block",
        Class::BlockWord => "word of a function block",
        Class::Block => "function block",
        Class::Timer => "timer",
        Class::Counter => "counter",
        Class::Data => "data of a data block",
        Class::InstanceData => "instance data",
        Class::LocalData => "local data",
        Class::Symbol => "symbol",
        Class::LocalName => "name of the block's own declarations",
        Class::Indirect => "place computed at run time",
        Class::Status => "status of the processor",
        Class::CodeBlock => "block",
    }
}

fn size(ty: Type) -> Option<String> {
    Some(match ty {
        Type::Bool => "1 bit".to_owned(),
        Type::Byte => "8 bits".to_owned(),
        Type::Word => "16 bits".to_owned(),
        Type::Double => "32 bits".to_owned(),
        Type::Float => "32 bits, floating point".to_owned(),
        Type::BitTable(n) => format!("table of {n} bits"),
        Type::WordTable(n) => format!("table of {n} words"),
        Type::DoubleTable(n) => format!("table of {n} double words"),
        Type::FloatTable(n) => format!("table of {n} floating-point numbers"),
        Type::Text(n) => format!("text of {n} characters"),
        Type::Block | Type::Unknown => return None,
    })
}

/// What a program may do with it, where the manual says so.
pub(super) fn rights(object: &Object) -> Option<String> {
    match object.rights {
        Rights::ReadWrite => Some("the program may read and write it".to_owned()),
        Rights::ReadOnly(source) => Some(format!("the program may not write it ({})", citation(source))),
        Rights::Unknown => None,
    }
}

/// Where it lies: rack, module and channel of PL7; byte and bit of STEP 7.
pub(super) fn place(object: &Object, family: Family) -> Option<String> {
    let is_channel =
        matches!(object.class, Class::Input | Class::Output | Class::Fault | Class::ModuleWord) && object.is_fixed();
    match family {
        Family::Pl7 if is_channel => pl7_place(&object.text),
        // The data blocks of STEP 5 have words.
        Family::Step5 | Family::Step7
            if object.is_fixed()
                && is_memory(object.class)
                && (family == Family::Step7 || !matches!(object.class, Class::Data | Class::InstanceData)) =>
        {
            let (byte, bit) = (object.footprint.start / 8, object.footprint.start % 8);
            Some(match object.ty.bits() {
                Some(1) => format!("byte {byte}, bit {bit}"),
                Some(8) => format!("byte {byte}"),
                Some(bits) => format!("bytes {byte} to {}", byte + bits.div_ceil(8).saturating_sub(1)),
                None => return None,
            })
        }
        _ => None,
    }
}

fn is_memory(class: Class) -> bool {
    use Class as C;
    matches!(
        class,
        C::Input
            | C::Output
            | C::PeripheralInput
            | C::PeripheralOutput
            | C::Memory
            | C::Data
            | C::InstanceData
            | C::LocalData
    )
}

/// Of an address in the rack: `%I102.5` is channel 5 of the module at position 2 of rack 1 (PL7:749-750).
fn pl7_place(address: &str) -> Option<String> {
    let rest = address.strip_prefix('%')?.trim_start_matches(|it: char| it.is_ascii_alphabetic());
    let (module, rest) = rest.split_once('.')?;
    let module: u32 = module.parse().ok()?;
    let mut text = format!("rack {}, module {}", module / 100, module % 100);
    let channel = rest.split(['.', ':']).next().unwrap_or_default();
    match channel.parse::<u32>() {
        Ok(channel) => {
            let _ = write!(text, ", channel {channel}");
        }
        Err(_) if channel == "MOD" => text.push_str(", the module itself"),
        Err(_) => {}
    }
    Some(text)
}

/// An instruction or function in one line, with its place in the manual where the tables have it.
pub(super) fn instruction(word: &str, language: Language) -> Option<String> {
    match language {
        Language::Awl(mnemonics) => s7_instruction(word, awl::lookup(word, mnemonics)?),
        Language::Step5(mnemonics) => s7_instruction(word, step5::lookup(word, mnemonics)?),
        Language::Pl7Il => il_instruction(word).or_else(|| function(word)),
        Language::Pl7St | Language::Pl7Ld | Language::Pl7Gr7 | Language::Sfc => function(word),
        _ => None,
    }
}

fn cited(text: &str, line: u16) -> String {
    if line == 0 { text.to_owned() } else { format!("{text} ({})", citation(&format!("PL7:{line}"))) }
}

fn il_instruction(word: &str) -> Option<String> {
    use instructions::IlOp as Op;
    let it = instructions::lookup(word)?;
    let text = match it.op {
        Op::Ld => "the result is the state of the operand",
        Op::LdN => "the result is the negated state of the operand",
        Op::LdR => "the result is the rising edge of the operand",
        Op::LdF => "the result is the falling edge of the operand",
        Op::And => "AND of the result and the operand",
        Op::AndN => "AND of the result and the negated operand",
        Op::AndR => "AND of the result and the rising edge of the operand",
        Op::AndF => "AND of the result and the falling edge of the operand",
        Op::Or => "OR of the result and the operand",
        Op::OrN => "OR of the result and the negated operand",
        Op::OrR => "OR of the result and the rising edge of the operand",
        Op::OrF => "OR of the result and the falling edge of the operand",
        Op::Xor => "exclusive OR of the result and the operand",
        Op::XorN => "exclusive OR of the result and the negated operand",
        Op::XorR => "exclusive OR of the result and the rising edge of the operand",
        Op::XorF => "exclusive OR of the result and the falling edge of the operand",
        Op::N => "negates the result",
        Op::Mps => "puts the result on the stack",
        Op::Mrd => "reads the result on top of the stack",
        Op::Mpp => "takes the result from the top of the stack",
        Op::St => "the operand takes the result",
        Op::StN => "the operand takes the negated result",
        Op::S => "sets the operand to 1 when the result is 1",
        Op::R => "sets the operand to 0 when the result is 1",
        Op::Jmp => "jumps to the label",
        Op::JmpC => "jumps to the label when the result is 1",
        Op::JmpCN => "jumps to the label when the result is 0",
        Op::Sr => "calls the subroutine",
        Op::Ret => "returns from the subroutine",
        Op::RetC => "returns from the subroutine when the result is 1",
        Op::RetCN => "returns from the subroutine when the result is 0",
        Op::End => "ends the program of this scan",
        Op::EndC => "ends the program of this scan when the result is 1",
        Op::EndCN => "ends the program of this scan when the result is 0",
        Op::Halt => "stops the execution of the program",
        Op::Blk => "begins the structured form of a function block",
        Op::OutBlk => "begins the outputs of a function block",
        Op::EndBlk => "ends the structured form of a function block",
        Op::In => "input that starts a timer or monostable",
        Op::Cu => "input that counts up",
        Op::Cd => "input that counts down",
        Op::I => "input that stores in a register",
        Op::O => "input that retrieves from a register",
        Op::U => "input that advances a drum",
    };
    Some(cited(&format!("`{}`: {text}", it.mnemonic), it.line))
}

fn function(word: &str) -> Option<String> {
    let it = functions::lookup(word)?;
    let count = it.parameters.len();
    let written = it.parameters.iter().filter(|it| it.is_written()).count();
    let mut text = format!("`{}`: ", it.name);
    let what = match (it.form, it.result.is_some()) {
        (functions::Form::Call, true) => "function",
        (functions::Form::Call, false) => "function that is a statement",
        (functions::Form::Infix, _) => "operator between two operands",
        (functions::Form::Prefix, _) => "operator before its operand",
        (functions::Form::Statement, _) => "statement",
        (functions::Form::Flow, _) => "statement that leaves the order of the program",
    };
    text.push_str(what);
    if it.form == functions::Form::Call {
        let open = if it.is_open { " or more" } else { "" };
        let _ = write!(text, " of {count}{open} {}", if count == 1 { "argument" } else { "arguments" });
        if written > 0 {
            let _ = write!(text, ", of which {written} {} written", if written == 1 { "is" } else { "are" });
        }
    }
    Some(cited(&text, it.line))
}

/// Computations by what they compute, and with numbers of which type.
fn s7_computation(op: awl::Op) -> Option<String> {
    use awl::{ArithOp as A, Conversion as C, LogicOp as L, NumberType as N, Op, Relation as R, Width};
    let number = |ty| match ty {
        N::Int => "integers of 16 bits",
        N::Dint => "integers of 32 bits",
        N::Real => "floating-point numbers",
    };
    Some(match op {
        Op::Compare(relation, ty) => {
            let is = match relation {
                R::Eq => "equal to",
                R::Ne => "not equal to",
                R::Gt => "greater than",
                R::Lt => "less than",
                R::Ge => "greater than or equal to",
                R::Le => "less than or equal to",
            };
            format!("the RLO is 1 when accumulator 2 is {is} accumulator 1, as {}", number(ty))
        }
        Op::Arithmetic(operation, ty) => {
            let does = match operation {
                A::Add => "adds accumulator 1 to accumulator 2",
                A::Sub => "subtracts accumulator 1 from accumulator 2",
                A::Mul => "multiplies accumulator 2 by accumulator 1",
                A::Div => "divides accumulator 2 by accumulator 1",
            };
            format!("{does}, as {}; the result is in accumulator 1", number(ty))
        }
        Op::WordLogic(operation, width) => {
            let name = match operation {
                L::And => "AND",
                L::Or => "OR",
                L::Xor => "exclusive OR",
            };
            let bits = if width == Width::Word { 16 } else { 32 };
            format!("{name} of {bits} bits of the accumulators; the result is in accumulator 1")
        }
        Op::Convert(conversion) => {
            let (from, to) = match conversion {
                C::BcdToInt => ("BCD", "an integer of 16 bits"),
                C::IntToBcd => ("an integer of 16 bits", "BCD"),
                C::BcdToDint => ("BCD", "an integer of 32 bits"),
                C::DintToBcd => ("an integer of 32 bits", "BCD"),
                C::IntToDint => ("an integer of 16 bits", "one of 32 bits"),
                C::DintToReal => ("an integer of 32 bits", "a floating-point number"),
                C::Round => ("a floating-point number", "the nearest integer of 32 bits"),
                C::RoundUp => ("a floating-point number", "the next integer of 32 bits above"),
                C::RoundDown => ("a floating-point number", "the next integer of 32 bits below"),
                C::Truncate => ("a floating-point number", "an integer of 32 bits, without what is behind the point"),
                C::OnesComplementInt => ("16 bits", "their complement"),
                C::OnesComplementDint => ("32 bits", "their complement"),
                C::NegateInt => ("an integer of 16 bits", "its negative"),
                C::NegateDint => ("an integer of 32 bits", "its negative"),
                C::NegateReal => ("a floating-point number", "its negative"),
                C::SwapBytesWord => ("16 bits", "its bytes in the other order"),
                C::SwapBytesDword => ("32 bits", "its bytes in the other order"),
            };
            format!("makes of accumulator 1, {from}, {to}")
        }
        _ => return None,
    })
}

fn s7_instruction(word: &str, op: awl::Op) -> Option<String> {
    use awl::Op;
    let text = match op {
        Op::And => "AND of the RLO and the operand",
        Op::AndNot => "AND of the RLO and the negated operand",
        Op::Or => "OR of the RLO and the operand; without an operand, OR of the AND terms around it",
        Op::OrNot => "OR of the RLO and the negated operand",
        Op::Xor => "exclusive OR of the RLO and the operand",
        Op::XorNot => "exclusive OR of the RLO and the negated operand",
        Op::AndOpen => "AND of the RLO and the expression in parentheses",
        Op::AndNotOpen => "AND of the RLO and the negated expression in parentheses",
        Op::OrOpen => "OR of the RLO and the expression in parentheses",
        Op::OrNotOpen => "OR of the RLO and the negated expression in parentheses",
        Op::XorOpen => "exclusive OR of the RLO and the expression in parentheses",
        Op::XorNotOpen => "exclusive OR of the RLO and the negated expression in parentheses",
        Op::Close => "closes an expression in parentheses",
        Op::Assign => "the operand takes the RLO",
        Op::Set => "sets the operand to 1 when the RLO is 1; a counter takes its preset on a rising edge",
        Op::Reset => "sets the operand to 0 when the RLO is 1",
        Op::NegateRlo => "negates the RLO",
        Op::SetRlo => "sets the RLO to 1",
        Op::ClearRlo => "sets the RLO to 0",
        Op::SaveRlo => "saves the RLO in the BR bit",
        Op::EdgePositive => "the RLO is its own rising edge; the operand keeps its state of the scan before",
        Op::EdgeNegative => "the RLO is its own falling edge; the operand keeps its state of the scan before",
        Op::Load => "loads accumulator 1; its old value goes to accumulator 2",
        Op::LoadBcd => "loads the value of a timer or counter in BCD",
        Op::Transfer => "transfers accumulator 1 to the operand",
        Op::Timer(awl::TimerMode::Pulse) => "starts the timer as a pulse, on a rising edge of the RLO",
        Op::Timer(awl::TimerMode::ExtendedPulse) => {
            "starts the timer as an extended pulse, on a rising edge of the RLO"
        }
        Op::Timer(awl::TimerMode::OnDelay) => "starts the timer as an on-delay, on a rising edge of the RLO",
        Op::Timer(awl::TimerMode::RetentiveOnDelay) => {
            "starts the timer as a retentive on-delay, on a rising edge of the RLO"
        }
        Op::Timer(awl::TimerMode::OffDelay) => "starts the timer as an off-delay, on a falling edge of the RLO",
        Op::Enable => "enables the timer or counter for another start, on a rising edge of the RLO",
        Op::CountUp => "counts up, on a rising edge of the RLO",
        Op::CountDown => "counts down, on a rising edge of the RLO",
        Op::Modulo => "remainder of accumulator 2 divided by accumulator 1",
        Op::AddConstant => "adds a constant to accumulator 1",
        Op::Jump(awl::JumpIf::Always) => "jumps to the label",
        Op::Jump(awl::JumpIf::Rlo) => "jumps to the label when the RLO is 1",
        Op::Jump(awl::JumpIf::NotRlo) => "jumps to the label when the RLO is 0",
        Op::Jump(awl::JumpIf::RloSave) => "jumps to the label when the RLO is 1, and saves it in the BR bit",
        Op::Jump(awl::JumpIf::NotRloSave) => "jumps to the label when the RLO is 0, and saves it in the BR bit",
        Op::Jump(awl::JumpIf::Br) => "jumps to the label when the BR bit is 1",
        Op::Jump(awl::JumpIf::NotBr) => "jumps to the label when the BR bit is 0",
        Op::Jump(awl::JumpIf::Overflow) => "jumps to the label when the overflow bit is 1",
        Op::Jump(awl::JumpIf::StoredOverflow) => "jumps to the label when the stored overflow bit is 1",
        Op::Jump(awl::JumpIf::Zero) => "jumps to the label when the result is zero",
        Op::Jump(awl::JumpIf::NotZero) => "jumps to the label when the result is not zero",
        Op::Jump(awl::JumpIf::Plus) => "jumps to the label when the result is above zero",
        Op::Jump(awl::JumpIf::Minus) => "jumps to the label when the result is below zero",
        Op::Jump(awl::JumpIf::PlusOrZero) => "jumps to the label when the result is zero or above",
        Op::Jump(awl::JumpIf::MinusOrZero) => "jumps to the label when the result is zero or below",
        Op::Jump(awl::JumpIf::Unordered) => "jumps to the label when the numbers cannot be compared",
        Op::JumpList => "jumps over the list that follows, by the number in accumulator 1",
        Op::Loop => "counts accumulator 1 down and jumps to the label while it is not zero",
        Op::Call => "calls a block, with parameters",
        Op::CallUnconditional => "calls a block without parameters",
        Op::CallConditional => "calls a block without parameters when the RLO is 1",
        Op::BlockEnd | Op::BlockEndUnconditional => "ends the block",
        Op::BlockEndConditional => "ends the block when the RLO is 1",
        Op::OpenDb => "opens a data block",
        Op::SwapDb => "exchanges the shared data block and the instance data block",
        Op::McrOpen => "opens a zone of the master control relay, which takes the RLO",
        Op::McrClose => "closes a zone of the master control relay",
        Op::McrActivate => "switches the master control relay on",
        Op::McrDeactivate => "switches the master control relay off",
        Op::Shift(_) => "shifts or rotates accumulator 1",
        Op::Compare(..) | Op::Arithmetic(..) | Op::WordLogic(..) | Op::Convert(_) => &s7_computation(op)?,
        Op::Real(_) => "function of the floating-point number in accumulator 1",
        Op::SwapAccumulators => "exchanges accumulators 1 and 2",
        Op::Push => "accumulator 2 takes accumulator 1",
        Op::Pop => "accumulator 1 takes accumulator 2",
        Op::Enter => "moves the stack of accumulators up",
        Op::Leave => "moves the stack of accumulators down",
        Op::Increment => "adds to the low byte of accumulator 1",
        Op::Decrement => "subtracts from the low byte of accumulator 1",
        Op::LoadAddressRegister(_) => "loads an address register",
        Op::TransferAddressRegister(_) => "transfers an address register",
        Op::AddAddressRegister(_) => "adds to an address register",
        Op::SwapAddressRegisters => "exchanges the address registers",
        Op::Nop => "does nothing",
        Op::TestBit(true) => "checks the bit for 1, whatever the RLO was",
        Op::TestBit(false) => "checks the bit for 0, whatever the RLO was",
        Op::SetAlways => "sets the bit, whatever the RLO is",
        Op::ResetAlways => "resets the bit, whatever the RLO is",
        Op::Generate => "makes a data block of as many words as accumulator 1 says",
        Op::Process => "the word is added to the operand of the next instruction",
        Op::Stop => "stops the controller",
        Op::Control => "instruction to the system, without effect on what the program computes",
        Op::LoadRegister => "loads from the place whose address is in accumulator 1",
        Op::TransferRegister => "transfers to a place whose address is in an accumulator",
        Op::Display => "display instruction of the programming device, without effect",
    };
    Some(format!("`{}`: {text}", word.to_uppercase()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::object::{pl7, step7};
    use crate::syntax::Mnemonics;

    #[test]
    fn addresses_are_decoded() {
        let of = |text: &str| place(&pl7::parse(text).unwrap(), Family::Pl7);
        assert_eq!(of("%I102.5").as_deref(), Some("rack 1, module 2, channel 5"));
        assert_eq!(of("%Q4.0").as_deref(), Some("rack 0, module 4, channel 0"));
        assert_eq!(of("%M4"), None);
        assert_eq!(kind(&pl7::parse("%MW10:5").unwrap()), "internal memory, table of 5 words");
        assert!(rights(&pl7::parse("%I1.0").unwrap()).unwrap().contains("not write"));
        let of = |text: &str| place(&step7::parse(text, Mnemonics::German).unwrap(), Family::Step7);
        assert_eq!(of("M 1.3").as_deref(), Some("byte 1, bit 3"));
        assert_eq!(of("EW 4").as_deref(), Some("bytes 4 to 5"));
    }

    #[test]
    fn instructions_are_explained() {
        let help = instruction("ldr", Language::Pl7Il).unwrap();
        assert!(help.starts_with("`LDR`: the result is the rising edge") && help.contains("line 3072"), "{help}");
        assert!(instruction("SPB", Language::Awl(Mnemonics::German)).unwrap().contains("RLO is 1"));
        assert_eq!(instruction("SPB", Language::Awl(Mnemonics::English)), None);
        let help = |word| instruction(word, Language::Awl(Mnemonics::German)).unwrap();
        assert_eq!(help("itd"), "`ITD`: makes of accumulator 1, an integer of 16 bits, one of 32 bits");
        assert!(help("-I").contains("subtracts accumulator 1 from accumulator 2, as integers of 16 bits"));
        assert!(help("<=R").contains("accumulator 2 is less than or equal to accumulator 1"));
        assert!(help("XOD").contains("exclusive OR of 32 bits"));
        assert!(instruction("copy_bit", Language::Pl7St).unwrap().contains("of 1 argument"));
        assert_eq!(instruction("Pump", Language::Pl7St), None);
    }
}

//! Objects: what an operand names, the memory it covers, and what a program may do with it.
//!
//! **Invariant:** whether two objects share memory is decided by their [`Footprint`]s, never by their spelling.

mod address;
pub mod pl7;
pub mod pl72;
pub mod step5;
pub mod step7;

use smol_str::SmolStr;

use super::entity::BlockName;

/// What an object is, as far as rules tell them apart. Its size is its [`Type`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Class {
    /// Process image of the inputs: `%I3.5`, `%IW3.5`, `E 1.0`, `EW 4`.
    Input,
    /// Process image of the outputs: `%Q2.0`, `%QW5.1`, `A 4.0`, `AB 5`.
    Output,
    /// Inputs read from the module itself: `PEW 256`.
    PeripheralInput,
    /// Outputs written to the module itself: `PAW 256`.
    PeripheralOutput,
    /// Memory of the program: `%M10`, `%MW4`, `M 0.0`, `MW 2`.
    Memory,
    /// `%KW30`.
    Constant,
    /// `%S20`, `%SW50`.
    System,
    /// `%X3`, `%X5.9`, `%X5.IN`.
    Step,
    /// `%XM3`.
    MacroStep,
    /// `%X3.T`.
    StepTime,
    /// `%I5.MOD.ERR`, `%I204.3.ERR`.
    Fault,
    /// Words exchanged with a module at the program's request: `%MW2.0.3`, `%KW2.0.3`.
    ModuleWord,
    /// `%NW{2.3}1`.
    NetworkWord,
    /// A bit output of a function block: `%TM8.Q`.
    BlockBit,
    /// A word of a function block: `%TM2.P`, `%C4.V`.
    BlockWord,
    /// A function block as a whole: `%TM8`.
    Block,
    /// `T 5`.
    Timer,
    /// `Z 1`, `C 1`.
    Counter,
    /// `DB5.DBW0`, `DBX 0.0` of the open data block, `"Data".field`.
    Data,
    /// `DIX 0.0`, `DIW 2`.
    InstanceData,
    /// `L 0.0`, `LW 4`.
    LocalData,
    /// A symbol that nothing resolves.
    Symbol,
    /// `#name`, declared by the block itself.
    LocalName,
    /// A place computed at run time: `M [AR1,P#0.0]`.
    Indirect,
    /// A bit or word of the status register: `OV`, `BIE`, `STW`.
    Status,
    /// A block named as an operand: `FC 1`, `DB 5`.
    CodeBlock,
}

/// Size and form of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    Bool,
    /// 8 bits.
    Byte,
    /// 16 bits: word or integer.
    Word,
    /// 32 bits: double word or double integer.
    Double,
    /// 32 bits: floating point, where the address says so (`%MF10`).
    Float,
    /// `%M10:6`: that many bits.
    BitTable(u32),
    /// `%MW10:5`: that many words.
    WordTable(u32),
    DoubleTable(u32),
    FloatTable(u32),
    /// `%MB10:5`: that many characters.
    Text(u32),
    /// A timer, counter or function block.
    Block,
    Unknown,
}

impl Type {
    /// Size in bits, where it is known.
    pub fn bits(self) -> Option<u32> {
        Some(match self {
            Self::Bool => 1,
            Self::Byte => 8,
            Self::Word => 16,
            Self::Double | Self::Float => 32,
            Self::BitTable(n) => n,
            Self::Text(n) => n.saturating_mul(8),
            Self::WordTable(n) => n.saturating_mul(16),
            Self::DoubleTable(n) | Self::FloatTable(n) => n.saturating_mul(32),
            Self::Block | Self::Unknown => return None,
        })
    }

    /// A floating-point number, or a table of them.
    pub fn is_float(self) -> bool {
        matches!(self, Self::Float | Self::FloatTable(_))
    }

    pub fn is_table(self) -> bool {
        matches!(
            self,
            Self::BitTable(_) | Self::WordTable(_) | Self::DoubleTable(_) | Self::FloatTable(_) | Self::Text(_)
        )
    }
}

/// A stretch of addresses in which footprints can be compared. Two areas never share memory.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Area {
    /// Siemens process images, memory and local data, byte 0 first; most significant byte first, so `M0.0` is bit 0 of
    /// byte 0 and `MW0` covers bytes 0 and 1.
    Inputs,
    Outputs,
    PeripheralInputs,
    PeripheralOutputs,
    /// Siemens M, or PL7 words: `%MW0` (PL7-2: `W0`) covers bits 0 to 15, `%MD0` 0 to 31, `%MB1` 8 to 15.
    Words,
    /// PL7 internal bits: `%M7` (PL7-2: `B7`) is bit 7.
    Bits,
    Constants,
    SystemBits,
    SystemWords,
    /// PL7 steps of the main chart: `%X7` is bit 7; of macro-step n: offset 1024 * (n + 1), IN 1000, OUT 1001.
    Steps,
    MacroSteps,
    /// Same numbering as `Steps`, 16 bits each.
    StepTimes,
    /// Bits of the channels of a PL7 module, by the module's address as written (`3`, `102`, `\0.2.1\0`).
    InputChannels(SmolStr),
    OutputChannels(SmolStr),
    /// Words of the channels of a PL7 module: prefix (`IW`, `QW`, `MW`, `KW`) and address.
    ModuleWords(SmolStr),
    Faults(SmolStr),
    /// Words of `%NW{network.station}`; of PL7-2, `COMi,j` of station i in network 0.
    Network(u32, u32),
    /// Items of one function block: `TM`, `C`, `MN`, `R`, `DR`, `T` and its number; of PL7-2, `T`, `C`, `M`, `R`, `D`, `FC`,
    /// `TXT`, and the clock's strings `DT` and `DTP`.
    Block(&'static str, u32),
    Timers,
    Counters,
    /// A data block by name, byte 0 first.
    Data(BlockName),
    /// The data block that is open at that place, and the instance data block.
    OpenData,
    OpenInstance,
    Local,
    /// A symbol without known address, in lower case. Footprints: bit 0, one bit.
    Symbol(SmolStr),
    /// `#name` of the block itself, in lower case.
    LocalName(SmolStr),
    Status(SmolStr),
    CodeBlock(BlockName),
    /// A place that is not known before the program runs.
    Indirect,
}

/// A stretch of bits in an area.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Footprint {
    pub area: Area,
    /// First bit.
    pub start: u32,
    /// Number of bits, at least 1.
    pub bits: u32,
}

impl Footprint {
    pub fn new(area: Area, start: u32, bits: u32) -> Self {
        Self { area, start, bits: bits.max(1) }
    }

    /// One past the last bit.
    pub fn end(&self) -> u32 {
        self.start.saturating_add(self.bits)
    }

    pub fn overlaps(&self, other: &Self) -> bool {
        self.area == other.area && self.start < other.end() && other.start < self.end()
    }

    pub fn contains(&self, other: &Self) -> bool {
        self.area == other.area && self.start <= other.start && other.end() <= self.end()
    }
}

/// What the manual allows a program to do with an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rights {
    ReadWrite,
    /// Not writable by program, with the place in the source that says so.
    ReadOnly(&'static str),
    Unknown,
}

/// What an operand names.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Object {
    /// The operand as written, blanks removed: `%MW10:X4`, `M0.0`, `"Pump"`, `#x`.
    pub text: SmolStr,
    pub class: Class,
    pub ty: Type,
    pub footprint: Footprint,
    pub rights: Rights,
    /// `%MW10:X4`, `%MW10[%MW2]:X4`: the footprint is the bit's own, this is the word's type.
    pub extracted: bool,
    /// The address is a base to which an index is added: the footprint is that of index 0 and only its area is sure.
    pub indexed: bool,
}

/// What an address of PL7 or PL7-2 names, in declarations of variables: without a percent sign it is PL7-2's.
///
/// # Errors
/// Those of [`pl7::parse`] or [`pl72::parse`], by whose address it looks like.
pub fn declared(address: &str) -> Result<Object, AddressError> {
    let older = || pl72::parse(address).map(|it| it.object);
    if address.starts_with('%') { pl7::parse(address).or_else(|error| older().map_err(|_| error)) } else { older() }
}

impl Object {
    /// A symbol of the program that nothing resolves.
    pub fn symbol(text: &str) -> Self {
        let bare = text.trim_matches(['"', '«', '»', ' ', '\u{a0}']);
        Self {
            text: text.into(),
            class: Class::Symbol,
            ty: Type::Unknown,
            footprint: Footprint::new(Area::Symbol(bare.to_lowercase().into()), 0, 1),
            rights: Rights::Unknown,
            extracted: false,
            indexed: false,
        }
    }

    pub fn is_bit(&self) -> bool {
        self.ty == Type::Bool
    }

    /// Whether the program's scan can tell where the object lies.
    pub fn is_fixed(&self) -> bool {
        !self.indexed && self.footprint.area != Area::Indirect
    }
}

/// Why an address is not one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AddressError {
    pub kind: AddressErrorKind,
    /// One sentence without a final stop, with the allowed range and its source where there is one.
    pub message: String,
    /// The nearest valid address.
    pub suggestion: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddressErrorKind {
    /// The dialect has no such address (rule O001).
    Malformed,
    /// The form is right, a number in it is out of every controller's range (rule O002).
    OutOfRange,
}

//! What a unit of a program is called, and what runs it.

use std::fmt;

use smol_str::SmolStr;

use crate::syntax::Language;

/// The vendor family, which decides how blocks are named, called and scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    Pl7,
    /// PL7-2, the language of the TSX 17-20, 27 and 47.
    Pl72,
    /// STEP 5, of the S5 controllers.
    Step5,
    Step7,
}

impl Family {
    /// Whose language it is. `None` where the file around the text must tell.
    pub fn of(language: Language) -> Option<Self> {
        match language {
            Language::Awl(_) | Language::SymbolTable => Some(Self::Step7),
            Language::Step5(_) | Language::Step5Symbols => Some(Self::Step5),
            Language::Pl72Ld | Language::Pl72Gr7 | Language::Pl72Sfc => Some(Self::Pl72),
            Language::Pl7Il
            | Language::Pl7St
            | Language::Pl7Ld
            | Language::Pl7Gr7
            | Language::Sfc
            | Language::Pl7Xref => Some(Self::Pl7),
            Language::Exchange => None,
        }
    }

    /// Whether blocks are Siemens's, named by kind and number.
    pub fn has_blocks(self) -> bool {
        matches!(self, Self::Step5 | Self::Step7)
    }

    /// The software that programs it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Pl7 => "PL7",
            Self::Pl72 => "PL7-2",
            Self::Step5 => "STEP 5",
            Self::Step7 => "STEP 7",
        }
    }
}

/// What scans a unit. Units of different tasks interrupt one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Task {
    Mast,
    Fast,
    /// EVTi of a PL7 application.
    Event(u16),
    /// A task of a PL7 project by the number that the project gives it; which task that is, is not known.
    Numbered(u16),
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mast => f.write_str("MAST"),
            Self::Fast => f.write_str("FAST"),
            Self::Event(number) => write!(f, "EVT{number}"),
            Self::Numbered(number) => write!(f, "task {number}"),
        }
    }
}

/// Kind of a Siemens block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BlockKind {
    Ob,
    Fb,
    Fc,
    Db,
    Udt,
    Sfb,
    Sfc,
    /// Program block of STEP 5.
    Pb,
    /// Sequence block of STEP 5.
    Sb,
    /// Extended function block of STEP 5.
    Fx,
    /// Extended data block of STEP 5.
    Dx,
}

impl BlockKind {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Ob => "OB",
            Self::Fb => "FB",
            Self::Fc => "FC",
            Self::Db => "DB",
            Self::Udt => "UDT",
            Self::Sfb => "SFB",
            Self::Sfc => "SFC",
            Self::Pb => "PB",
            Self::Sb => "SB",
            Self::Fx => "FX",
            Self::Dx => "DX",
        }
    }

    /// The kind with these letters, in any case.
    pub fn of(letters: &str) -> Option<Self> {
        const ALL: [BlockKind; 11] = [
            BlockKind::Ob,
            BlockKind::Fb,
            BlockKind::Fc,
            BlockKind::Db,
            BlockKind::Udt,
            BlockKind::Sfb,
            BlockKind::Sfc,
            BlockKind::Pb,
            BlockKind::Sb,
            BlockKind::Fx,
            BlockKind::Dx,
        ];
        ALL.into_iter().find(|it| it.as_str().eq_ignore_ascii_case(letters))
    }

    /// Whether the block holds code that a program calls.
    pub fn is_callable(self) -> bool {
        matches!(self, Self::Fb | Self::Fc | Self::Pb | Self::Sb | Self::Fx)
    }

    /// Whether the block holds data, and no code.
    pub fn is_data(self) -> bool {
        matches!(self, Self::Db | Self::Dx | Self::Udt)
    }

    /// Whether the block is part of the CPU's own firmware, so that no program contains it.
    pub fn is_system(self) -> bool {
        matches!(self, Self::Sfb | Self::Sfc)
    }
}

/// A Siemens block as a program names it: by number, or by a symbol (kept in lower case: symbols ignore case).
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BlockName {
    Number(BlockKind, u32),
    Symbol(SmolStr),
}

impl fmt::Display for BlockName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(kind, number) => write!(f, "{}{number}", kind.as_str()),
            Self::Symbol(name) => write!(f, "\"{name}\""),
        }
    }
}

/// The part of a PL7 section or task that a unit holds.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// The body of a section, or of a task that has one section only.
    Main,
    /// SRi.
    Subroutine(u32),
    /// Preliminary processing of a Grafcet section.
    Preliminary,
    /// Posterior processing of a Grafcet section.
    Posterior,
    /// An action or a receptivity of a chart, by the rest of its heading: `CHART - PAGE 0 %X1 P1`.
    Chart(SmolStr),
    /// The body of an event task.
    Event,
}

/// What a unit of text holds.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entity {
    /// Code of a PL7 application: `MAST - Peinture - PRL`, `FAST - SR10`, `EVT3`.
    Pl7 { task: Task, section: Option<SmolStr>, part: Part },
    /// A Siemens block. `declared_kind` is the keyword of its header, which a symbolic name does not tell.
    Block { kind: BlockKind, name: BlockName },
    /// A DFB type of a PL7 application, by its name as written.
    Dfb { name: SmolStr },
    /// Siemens code without a block header.
    Listing,
    /// Text around programs: headers of an exchange file, text before the first block.
    Container,
}

impl Entity {
    pub fn task(&self) -> Option<Task> {
        match self {
            Self::Pl7 { task, .. } => Some(*task),
            _ => None,
        }
    }

    pub fn subroutine(&self) -> Option<u32> {
        match self {
            Self::Pl7 { part: Part::Subroutine(number), .. } => Some(*number),
            _ => None,
        }
    }

    /// Name of a Siemens block.
    pub fn name(&self) -> Option<&BlockName> {
        match self {
            Self::Block { name, .. } => Some(name),
            _ => None,
        }
    }

    pub fn block_kind(&self) -> Option<BlockKind> {
        match self {
            Self::Block { kind, .. } => Some(*kind),
            _ => None,
        }
    }
}

/// The vendor's own addressing, as findings show it.
impl fmt::Display for Entity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pl7 { task, section, part } => {
                write!(f, "{task}")?;
                if let Some(section) = section {
                    write!(f, " - {section}")?;
                }
                match part {
                    Part::Main if section.is_none() => write!(f, " - MAIN"),
                    Part::Main | Part::Event => Ok(()),
                    Part::Subroutine(number) => write!(f, " - SR{number}"),
                    Part::Preliminary => write!(f, " - PRL"),
                    Part::Posterior => write!(f, " - POST"),
                    Part::Chart(rest) => write!(f, " - {rest}"),
                }
            }
            Self::Block { kind, name: name @ BlockName::Symbol(_) } => write!(f, "{} {name}", kind.as_str()),
            Self::Block { name, .. } => write!(f, "{name}"),
            Self::Dfb { name } => write!(f, "FUNCTION_BLOCK {name}"),
            Self::Listing => f.write_str("listing"),
            Self::Container => f.write_str("file"),
        }
    }
}

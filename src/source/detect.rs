//! What a file is, by its content first and its extension second: in the field `.LD .ST .GR7 .SEQ .STL .SDF .DB .TXT`
//! all have several meanings.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use super::decode::{Encoding, SourceText, decode, looks_binary};
use super::heading::{
    HeadingLanguage, block_end, block_header, exchange_block, pl7_heading, step5_code, step5_heading,
    strip_prefix_ignore_case, word,
};
use crate::model::entity::{BlockKind, BlockName, Entity, Family};
use crate::model::object;
use crate::syntax::pl7::ladder_words;
use crate::syntax::step5::symbols;

use super::scan::{Comments, Lines};
use super::{stx, symlist};

/// What the user says that files are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dialect {
    #[default]
    Auto,
    Step7,
    Step5,
    /// PL7, its language by content.
    Pl7,
    Pl7Il,
    Pl7St,
    Pl7Gr7,
    Pl7Ld,
    Pl72,
    Sfc,
}

impl Dialect {
    pub const ALL: [Self; 10] = [
        Self::Auto,
        Self::Step7,
        Self::Step5,
        Self::Pl7,
        Self::Pl7Il,
        Self::Pl7St,
        Self::Pl7Ld,
        Self::Pl7Gr7,
        Self::Pl72,
        Self::Sfc,
    ];

    pub fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Step7 => "step7",
            Self::Step5 => "step5",
            Self::Pl7 => "pl7",
            Self::Pl7Il => "pl7-il",
            Self::Pl7St => "pl7-st",
            Self::Pl7Gr7 => "pl7-gr7",
            Self::Pl7Ld => "pl7-ld",
            Self::Pl72 => "pl7-2",
            Self::Sfc => "sfc",
        }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A name of a dialect that plclint does not know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownDialect(pub String);

impl fmt::Display for UnknownDialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known: Vec<&str> = Dialect::ALL.iter().map(|it| it.as_str()).collect();
        write!(f, "unknown dialect `{}`, expected one of {}", self.0, known.join(", "))
    }
}

impl std::error::Error for UnknownDialect {}

impl FromStr for Dialect {
    type Err = UnknownDialect;

    fn from_str(name: &str) -> Result<Self, UnknownDialect> {
        let wanted = name.trim();
        let found = Self::ALL.into_iter().find(|dialect| dialect.as_str().eq_ignore_ascii_case(wanted));
        found.ok_or_else(|| UnknownDialect(name.to_owned()))
    }
}

/// The languages of PL7 whose sections are text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Pl7Text {
    Il,
    St,
    /// Pages of Grafcet in the exchange form.
    Gr7,
    /// A chart in the textual form of IEC 61131-3.
    Sfc,
    Ld,
}

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Detected {
    /// A PL7 source exchange file: blocks in brackets.
    Exchange,
    /// PL7 text without blocks; where no heading says the language, it is this one.
    Pasted(Pl7Text),
    /// PL7-2 text without blocks.
    Pl72,
    /// PL7-2 code in the exchange form of PL7.
    Pl72Exchange,
    /// STEP 7 statement list: a source with block headers or a bare listing.
    Step7,
    /// A symbol table of STEP 7; of a project's, the text is a listing.
    Step7Symbols,
    /// STEP 5 statement list: printed blocks or a bare listing.
    Step5,
    /// Symbols of a STEP 5 program.
    Step5Symbols,
    /// A PL7 project: its text is the listing of its tables.
    Stx,
    /// Part of a controller program, in a form that plclint does not read. `what` names the form.
    Unsupported { what: &'static str },
    /// It should be a controller program by its name, or was asked for, and is not text. `why` completes "not read: ".
    Unreadable { why: &'static str },
    /// Something else.
    NotPlc,
}

/// What is known of a file beside its content.
#[derive(Debug, Clone, Copy, Default)]
pub struct FileHint<'p> {
    pub path: Option<&'p Path>,
    /// Named by the user rather than found in a folder.
    pub explicit: bool,
    pub dialect: Dialect,
    /// The family of the controller that is configured.
    pub family: Option<Family>,
}

/// Names of the forms that are recognised and not read.
pub mod unsupported {
    pub const OTHER_LANGUAGE: &str = "PL7 language other than IL, ST, LD and GR7";
    pub const PL7_2_LANGUAGE: &str = "PL7-2 language other than ladder and Grafcet";
    pub const DFB: &str = "PL7 DFB type";
    pub const VARIABLES: &str = "PL7 variables (SCY)";
    pub const APPLICATION: &str = "PL7 application (FEF)";
    pub const ENCRYPTED: &str = "encrypted PL7 DFB type (UFB)";
    pub const PROJECT: &str = "PL7 project (STX)";
    pub const CONTROL_EXPERT: &str = "Control Expert (Unity Pro) export";
    pub const SCL: &str = "STEP 7 structured control language (SCL)";
    pub const GRAPH: &str = "S7-GRAPH source";
    pub const STEP5: &str = "STEP 5 program file (S5D)";
    pub const BLOCKS: &str = "compiled STEP 7 blocks (SUBBLK.DBF)";
    pub const IEC: &str = "IEC 61131-3 text that is not PL7";

    /// Whether such a file holds code that may use any object and call any block.
    pub fn is_code(what: &str) -> bool {
        !matches!(what, VARIABLES)
    }
}

/// The meaning of an extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Extension {
    /// STEP 7 statement list and nothing else.
    Awl,
    /// STEP 7 statement list or a 3-D mesh.
    Stl,
    /// STEP 5 statement list.
    S5,
    /// A block of TIA Portal, or a data base.
    Tia,
    Il,
    St,
    Ld,
    Gr7,
    Sfc,
    /// A symbol table if the content agrees.
    Table,
    Txt,
    /// One form that is not read. Whether it is text or binary data says more than its content.
    Form(&'static str, Storage),
    /// Considered only if the user names the file.
    Other,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Storage {
    Text,
    Binary,
    Either,
}

const EXTENSIONS: &[(&str, Extension)] = &[
    ("awl", Extension::Awl),
    ("stl", Extension::Stl),
    ("s5", Extension::S5),
    ("db", Extension::Tia),
    ("udt", Extension::Tia),
    ("il", Extension::Il),
    ("st", Extension::St),
    ("ld", Extension::Ld),
    ("gr7", Extension::Gr7),
    ("sfc", Extension::Sfc),
    ("txt", Extension::Txt),
    ("sdf", Extension::Table),
    ("asc", Extension::Table),
    ("seq", Extension::Table),
    ("dif", Extension::Table),
    ("dfb", Extension::Form(unsupported::DFB, Storage::Text)),
    ("scy", Extension::Form(unsupported::VARIABLES, Storage::Text)),
    ("fef", Extension::Form(unsupported::APPLICATION, Storage::Text)),
    ("ufb", Extension::Form(unsupported::ENCRYPTED, Storage::Either)),
    ("stx", Extension::Form(unsupported::PROJECT, Storage::Binary)),
    ("scl", Extension::Form(unsupported::SCL, Storage::Text)),
    ("s5d", Extension::Form(unsupported::STEP5, Storage::Binary)),
    ("xef", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("zef", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Binary)),
    ("xst", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xil", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xld", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xsf", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xbd", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xdb", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xdd", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
    ("xsy", Extension::Form(unsupported::CONTROL_EXPERT, Storage::Text)),
];

/// The containers of a STEP 7 project that hold compiled blocks.
const BLOCK_CONTAINER: &str = "SUBBLK.DBF";

fn extension(path: Option<&Path>) -> Extension {
    if path.and_then(Path::file_name).is_some_and(|it| it.eq_ignore_ascii_case(BLOCK_CONTAINER)) {
        return Extension::Form(unsupported::BLOCKS, Storage::Binary);
    }
    let Some(extension) = path.and_then(Path::extension).and_then(|extension| extension.to_str()) else {
        return Extension::Other;
    };
    EXTENSIONS
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(extension))
        .map_or(Extension::Other, |&(_, meaning)| meaning)
}

/// The extensions of the files that are considered in a folder, in lower case.
pub fn extensions() -> impl Iterator<Item = &'static str> {
    EXTENSIONS.iter().map(|it| it.0)
}

/// Whether a file found in a folder may be part of a controller program, by its extension.
pub fn has_plc_extension(path: &Path) -> bool {
    extension(Some(path)) != Extension::Other || symlist::is_table(path)
}

/// Decodes and recognises a file. Data that is not text is not decoded: its text is empty.
pub fn load(hint: FileHint<'_>, bytes: &[u8], encoding: Option<Encoding>) -> (SourceText, Detected) {
    if let Some(project) = project(hint, bytes, encoding) {
        return match project {
            Ok(source) => (source, Detected::Stx),
            Err(why) => (decode(b"", encoding), Detected::Unreadable { why }),
        };
    }
    if hint.path.is_some_and(symlist::is_table) {
        return match symlist::listing(bytes, encoding) {
            Ok(source) => (source, Detected::Step7Symbols),
            Err(why) => (decode(b"", encoding), Detected::Unreadable { why }),
        };
    }
    if let Some(detected) = detect_binary(hint, bytes, encoding) {
        return (decode(b"", encoding), detected);
    }
    let source = decode(bytes, encoding);
    let detected = detect(hint, &source.text);
    (source, detected)
}

/// The listing of a PL7 project, or why it has none; `None` if the bytes are no project.
fn project(hint: FileHint<'_>, bytes: &[u8], encoding: Option<Encoding>) -> Option<Result<SourceText, &'static str>> {
    let by_name = matches!(extension(hint.path), Extension::Form(unsupported::PROJECT, _));
    if !(by_name || hint.explicit) || matches!(hint.dialect, Dialect::Step7 | Dialect::Step5) || !stx::is_archive(bytes)
    {
        return None;
    }
    let listing = stx::listing(bytes, encoding.filter(|it| it.is_single_byte()));
    // Archives of all kinds go by other names.
    if by_name { Some(listing) } else { listing.ok().map(Ok) }
}

/// What a file is whose bytes are not text in the given encoding; `None` if they are.
pub fn detect_binary(hint: FileHint<'_>, bytes: &[u8], encoding: Option<Encoding>) -> Option<Detected> {
    let extension = extension(hint.path);
    let utf16 = matches!(encoding, Some(Encoding::Utf16Le | Encoding::Utf16Be));
    if utf16 || !looks_binary(bytes) && !is_binary_mesh(bytes) {
        return None;
    }
    Some(match extension {
        Extension::Form(what, Storage::Binary | Storage::Either) => Detected::Unsupported { what },
        _ if hint.dialect != Dialect::Auto => Detected::Unreadable { why: BINARY },
        Extension::Stl => Detected::NotPlc,
        Extension::Tia | Extension::Table | Extension::Txt | Extension::Sfc | Extension::Other if !hint.explicit => {
            Detected::NotPlc
        }
        _ => Detected::Unreadable { why: BINARY },
    })
}

const BINARY: &str = "binary data, not text";
const MARKUP: &str = "markup or data notation, not a program";

/// A 3-D mesh: a header of 80 bytes, the number of triangles, 50 bytes a triangle.
fn is_binary_mesh(bytes: &[u8]) -> bool {
    let Some(count) = bytes.get(80..84).and_then(|count| <[u8; 4]>::try_from(count).ok()) else { return false };
    bytes.len() as u64 == 84 + 50 * u64::from(u32::from_le_bytes(count))
}

/// What a text is.
pub fn detect(hint: FileHint<'_>, text: &str) -> Detected {
    let tally = Tally::of(text);
    match (detect_form(hint, text, &tally), hint.dialect) {
        (Detected::Exchange, Dialect::Pl72) => Detected::Pl72Exchange,
        (Detected::Exchange, Dialect::Auto) if tally.is_pl7_2(hint.family) => Detected::Pl72Exchange,
        (Detected::Pasted(Pl7Text::Ld | Pl7Text::Gr7 | Pl7Text::Sfc), Dialect::Auto)
            if tally.headings() == 0 && tally.is_pl7_2(hint.family) =>
        {
            Detected::Pl72
        }
        (detected, _) => detected,
    }
}

/// What a text is, but for whose ladder and charts it has.
fn detect_form(hint: FileHint<'_>, text: &str, tally: &Tally) -> Detected {
    match hint.dialect {
        Dialect::Auto => {
            if extension(hint.path) == Extension::Table && tally.is_symbols() {
                return if tally.step5_blocks > 0 || hint.path.is_some_and(is_step5_table) {
                    Detected::Step5Symbols
                } else {
                    Detected::Step7Symbols
                };
            }
            detect_auto(extension(hint.path), hint.explicit, text, tally)
        }
        Dialect::Step7 if extension(hint.path) == Extension::Table && tally.is_symbols() => Detected::Step7Symbols,
        Dialect::Step7 => Detected::Step7,
        Dialect::Step5 => Detected::Step5,
        Dialect::Pl7
        | Dialect::Pl7Il
        | Dialect::Pl7St
        | Dialect::Pl7Ld
        | Dialect::Pl7Gr7
        | Dialect::Pl72
        | Dialect::Sfc
            if tally.is_exchange() =>
        {
            Detected::Exchange
        }
        Dialect::Pl7 => Detected::Pasted(tally.pl7_text(extension(hint.path))),
        Dialect::Pl7Il => Detected::Pasted(Pl7Text::Il),
        Dialect::Pl7St => Detected::Pasted(Pl7Text::St),
        Dialect::Pl7Gr7 => Detected::Pasted(Pl7Text::Gr7),
        Dialect::Pl7Ld => Detected::Pasted(Pl7Text::Ld),
        Dialect::Pl72 => Detected::Pl72,
        Dialect::Sfc => Detected::Pasted(Pl7Text::Sfc),
    }
}

/// The language of PL7 text that no heading and no file name tells.
pub(super) fn pl7_text(text: &str) -> Pl7Text {
    Tally::of(text).pl7_text(Extension::Other)
}

/// Whose operands ladder and charts have, by most of the lines that say so; `None` if none does.
pub(super) fn operands_of(text: &str) -> Option<Family> {
    let mut tally = Tally::default();
    for line in Lines::new(text, Comments::Pl7) {
        tally.add_operands(line.code);
    }
    let is_told = tally.pl7_2 + tally.not_pl7_2 > 0;
    is_told.then(|| if tally.is_pl7_2(None) { Family::Pl72 } else { Family::Pl7 })
}

fn detect_auto(extension: Extension, explicit: bool, text: &str, tally: &Tally) -> Detected {
    // Forms that the content proves, whatever the file is called.
    let of_pl7 = matches!(
        extension,
        Extension::Il
            | Extension::St
            | Extension::Ld
            | Extension::Gr7
            | Extension::Form(unsupported::DFB | unsupported::VARIABLES | unsupported::APPLICATION, _)
    );
    // The header of an encrypted block may be legible; what matters is not.
    if extension == Extension::Form(unsupported::ENCRYPTED, Storage::Either) {
        return Detected::Unsupported { what: unsupported::ENCRYPTED };
    }
    if tally.is_exchange() || of_pl7 && tally.blocks > 0 {
        return Detected::Exchange;
    }
    if extension == Extension::Form(unsupported::VARIABLES, Storage::Text) && tally.variables > 0 {
        return Detected::Exchange;
    }
    if extension == Extension::Form(unsupported::DFB, Storage::Text) && tally.block_headers > 0 {
        return Detected::Pasted(tally.pl7_text(extension));
    }
    if !matches!(extension, Extension::Form(..))
        && let Some(detected) = tally.prove()
    {
        return detected;
    }

    let weak = tally.code_lines() > 0 && tally.code_lines() * 5 >= tally.lines && tally.prose * 3 <= tally.lines;
    match extension {
        Extension::Form(_, Storage::Binary) => Detected::NotPlc,
        Extension::Form(unsupported::CONTROL_EXPERT, _) if !tally.markup => Detected::NotPlc,
        Extension::Form(what, _) => Detected::Unsupported { what },
        Extension::Awl if tally.markup => Detected::Unreadable { why: MARKUP },
        Extension::S5 if tally.markup => Detected::Unreadable { why: MARKUP },
        Extension::S5 => Detected::Step5,
        Extension::Awl => Detected::Step7,
        Extension::Stl if tally.lines == 0 && !text.is_empty() => Detected::Step7,
        Extension::Stl if weak && tally.step7 > 0 => Detected::Step7,
        Extension::Il | Extension::St if tally.iec > 0 && tally.pl7 == 0 => {
            Detected::Unsupported { what: unsupported::IEC }
        }
        Extension::Il | Extension::St if tally.lines == 0 || weak && tally.il + tally.st > 0 => {
            Detected::Pasted(tally.pl7_text(extension))
        }
        // A sentence or an expression alone: nothing but what has addresses or marks of PL7.
        Extension::Il | Extension::St if tally.pl7 == tally.lines => Detected::Pasted(tally.pl7_text(extension)),
        Extension::Ld if tally.rung > 0 => Detected::Pasted(Pl7Text::Ld),
        Extension::Gr7 if tally.has_chart() || tally.lines == 0 => Detected::Pasted(Pl7Text::Gr7),
        Extension::Sfc if tally.has_chart() => Detected::Pasted(Pl7Text::Sfc),
        Extension::Table if tally.symbols_step5 * 2 > tally.lines => Detected::Step5Symbols,
        Extension::Other | Extension::Txt if explicit && tally.prose == 0 && tally.code_lines() * 2 > tally.lines => {
            if tally.step7 > tally.il + tally.st {
                Detected::Step7
            } else {
                Detected::Pasted(tally.pl7_text(extension))
            }
        }
        _ => Detected::NotPlc,
    }
}

/// Whether a line declares a variable, with an address or a type.
fn is_variable(line: &str) -> bool {
    let (name, rest) = word(line);
    let rest = rest.trim_start();
    let address = strip_prefix_ignore_case(rest, "AT ").map(str::trim_start);
    !name.is_empty()
        && (rest.starts_with(':') || address.is_some_and(|it| it.starts_with('%') || declared_by_pl7_2(it)))
}

/// Whether a declaration, behind its `AT`, has an address that PL7-2 alone has: `B3`, `I0,05`.
fn declared_by_pl7_2(address: &str) -> bool {
    let end = address.find(|it: char| it.is_whitespace() || matches!(it, ':' | ';' | '(')).unwrap_or(address.len());
    let address = address.get(..end.min(LONGEST_PL7_2)).unwrap_or_default();
    !address.starts_with('%') && object::pl72::class_of(address).is_some_and(|it| it != object::Class::Fault)
}

/// Of this many lines of STEP 5 that STEP 7 has too, one is its own at least: the end of a segment, a call.
const STEP5_SHARE: u32 = 16;

/// How much of a text is looked at.
const SAMPLE: usize = 128 * 1024;

/// Counts of the lines of a text by what they look like. Comments and empty lines are not counted.
#[derive(Debug, Clone, Default)]
struct Tally {
    lines: u32,
    /// STEP 7 instructions with an operand of the right shape, or none where none is due.
    step7: u32,
    /// The same with an operand that may be a symbol without quotes.
    step7_symbols: u32,
    /// PL7 instructions in IL; the same in ST.
    il: u32,
    st: u32,
    /// Lines with something that only PL7 has: `%MW10`, `%L5:`, `!` before a sentence.
    pl7: u32,
    /// Lines with something that only PL7-2 has: `I0,05`, `T0,D`, `W1 -> W2`.
    pl7_2: u32,
    /// Lines with an object that PL7-2 does not have, by its form: `%M5`, `%I1.0`.
    not_pl7_2: u32,
    /// Headings of pasted PL7 text, by language.
    headings_il: u32,
    headings_st: u32,
    headings_ld: u32,
    headings_other: u32,
    /// Headings of PL7-2 text, in any language; the others do not count them.
    headings_pl7_2: u32,
    /// Exchange file blocks, and those among them that no other kind of file has.
    blocks: u32,
    own_blocks: u32,
    /// Headers and ends of STEP 7 blocks.
    block_headers: u32,
    block_ends: u32,
    /// Headers that a DFB type of PL7 has as well as a block of others: `FUNCTION_BLOCK Cpt`.
    dfb_headers: u32,
    /// Lines that in a function block only PL7 has: its types, its statements on bits.
    dfb: u32,
    /// Declarations and other lines that are code in a STEP 7 block but mean nothing elsewhere.
    declarations: u32,
    /// Those among them that no other vendor's block has: `BEGIN`, `NETWORK`.
    step7_words: u32,
    /// Statements of structured languages: assignments in code blocks, IF, CASE.
    scl: u32,
    /// The lines after the last header belong to a code block, not to data.
    in_code_block: bool,
    /// Declaration sections and program units of IEC 61131-3.
    iec: u32,
    /// `Pump AT %M0 : EBOOL;`
    variables: u32,
    /// Words that frame rungs, and elements of them.
    rung: u32,
    cells: u32,
    /// Words of charts, and those among them that only the pages of PL7 have.
    chart: u32,
    pages: u32,
    /// Lines of charts that start with a word which other texts have too.
    chart_words: u32,
    /// Those among them that begin a step.
    steps: u32,
    /// Words of S7-GRAPH.
    graph: u32,
    step5: u32,
    /// Lines of a symbol table, and those of one of STEP 5.
    symbols: u32,
    /// Those among them that name a block which only STEP 5 has.
    step5_blocks: u32,
    /// Lines of a data interchange file: the words of its header, and marks of its rows.
    interchange: u32,
    symbols_step5: u32,
    /// Natural language.
    prose: u32,
    /// The text starts like XML, HTML or JSON.
    markup: bool,
}

impl Tally {
    fn of(text: &str) -> Self {
        let mut end = text.len().min(SAMPLE);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let text = text.get(..end).unwrap_or_default();
        let start = text.trim_start();
        let mut tally = Self { markup: start.starts_with(['<', '{']), ..Self::default() };
        // A line comment is none in PL7, but no PL7 text has `//` outside of comments.
        for line in Lines::new(text, Comments::Step7) {
            let code = before_line_comment(line.code).trim();
            // Parentheses and the dots of an omission alone mean nothing.
            // A semicolon starts a comment of STEP 5.
            if code.contains(|c: char| !matches!(c, ')' | '.' | '…')) && !(code.starts_with(';') && code.len() > 1) {
                tally.add(code);
            }
        }
        tally
    }

    fn add(&mut self, line: &str) {
        self.lines += 1;
        let of_step5 = is_step5_row(line);
        self.symbols += u32::from(of_step5 || is_symbol_row(line));
        self.step5_blocks += u32::from(of_step5);
        self.interchange += u32::from(matches!(line, "TABLE" | "VECTORS" | "TUPLES" | "BOT"));
        self.symbols_step5 += u32::from(symbols::row(line).is_some());
        if let Some((block, _)) = exchange_block(line) {
            self.blocks += 1;
            self.own_blocks += u32::from(matches!(block, "[SOURCE_UNIT]" | "[DATA_UNIT]"));
        } else if let Some(heading) = pl7_heading(line) {
            match heading.language {
                _ if heading.pl7_2 => self.headings_pl7_2 += 1,
                HeadingLanguage::Il => self.headings_il += 1,
                HeadingLanguage::St => self.headings_st += 1,
                HeadingLanguage::Ladder => self.headings_ld += 1,
                HeadingLanguage::Grafcet => self.headings_other += 1,
            }
        } else if let Some(block) = block_header(line) {
            self.block_headers += 1;
            self.dfb_headers += u32::from(is_dfb_header(&block, line));
            self.in_code_block = !matches!(block.block_kind(), Some(BlockKind::Db | BlockKind::Udt));
        } else if block_end(line).is_some() {
            self.block_ends += 1;
        } else {
            self.add_code(line);
        }
    }

    fn add_code(&mut self, line: &str) {
        let is_pl7 = line.starts_with('!') || has_pl7_object(line);
        let code = strip_pl7_label(line.strip_prefix('!').unwrap_or(line).trim_start());
        let first = word(code).0.to_ascii_uppercase();
        let first = first.as_str();
        self.pl7 += u32::from(is_pl7);
        self.add_operands(line);
        self.dfb += u32::from(is_dfb_line(code, first));
        self.variables += u32::from(is_variable(code));
        match pl7_statement(code, first, is_pl7) {
            Some(Pl7Text::Il) => self.il += 1,
            Some(Pl7Text::St) => {
                self.st += 1;
                self.scl += u32::from(self.in_code_block);
            }
            Some(Pl7Text::Ld | Pl7Text::Gr7 | Pl7Text::Sfc) | None => {}
        }
        match first {
            "RUNG" | "END_RUNG" => self.rung += 1,
            // Words without an underscore are words of other languages too.
            _ if first.contains('_') && ladder_words::lookup(first).is_some() => {
                self.rung += 1;
                self.cells += 1;
            }
            "NB_PAGES" | "END_PAGE" | "T_S_OR_LINK" | "S_T_OR_LINK" | "T_S_AND_LINK" | "S_T_AND_LINK"
            | "SOURCE_CONNECTOR" | "DEST_CONNECTOR" => {
                self.chart += 1;
                self.pages += 1;
            }
            "INITIAL_STEP" | "END_STEP" | "END_TRANSITION" | "MACRO_STEP" | "IN_STEP" | "OUT_STEP" => self.chart += 1,
            "STEP" | "TRANSITION" | "ACTION" | "END_ACTION" | "PAGE" if is_chart_line(code, first) => {
                self.chart_words += 1;
                self.steps += u32::from(first == "STEP");
            }
            "SEQUENCE" | "END_SEQUENCE" | "GRAPH7" => self.graph += 1,
            "VAR_GLOBAL" | "PROGRAM" | "END_PROGRAM" | "CONFIGURATION" | "VAR_EXTERNAL" => self.iec += 1,
            "VAR" | "VAR_INPUT" | "VAR_OUTPUT" | "VAR_IN_OUT" | "END_VAR" => {
                self.iec += 1;
                self.declarations += 1;
            }
            "VAR_TEMP" | "STRUCT" | "END_STRUCT" | "BEGIN" | "NETWORK" | "TITLE" | "VERSION" | "AUTHOR" | "FAMILY"
            | "KNOW_HOW_PROTECT" => {
                self.declarations += 1;
                self.step7_words += 1;
            }
            "IF" | "ELSIF" | "ELSE" | "END_IF" | "CASE" | "END_CASE" | "FOR" | "END_FOR" | "WHILE" | "END_WHILE"
            | "REPEAT" | "END_REPEAT" | "REGION" => self.scl += 1,
            _ if is_step5(code) => self.step5 += 1,
            _ if is_step7_instruction(code) => self.step7 += 1,
            _ if is_step7_with_symbol(code) => self.step7_symbols += 1,
            _ if is_declaration(code) => self.declarations += 1,
            _ if !is_pl7 && is_prose(code) => self.prose += 1,
            _ => {}
        }
    }

    fn add_operands(&mut self, line: &str) {
        self.pl7_2 += u32::from(has_pl7_2_object(line));
        self.not_pl7_2 += u32::from(has_pl7_object(line) && has_object_of_pl7_alone(line));
    }

    /// Whether ladder and charts are PL7-2's: most of their operands say so, or where they say nothing, the configuration.
    fn is_pl7_2(&self, configured: Option<Family>) -> bool {
        self.pl7_2 > self.not_pl7_2 || self.not_pl7_2 == 0 && configured == Some(Family::Pl72)
    }

    /// Whether the text is a symbol table of STEP 7. In the data interchange format a row is many lines.
    fn is_symbols(&self) -> bool {
        self.symbols * 2 > self.lines || self.interchange > 2
    }

    fn is_exchange(&self) -> bool {
        self.own_blocks > 0 || self.blocks > 1
    }

    /// Whether steps or pages are there. A step may begin and end on one line.
    fn has_chart(&self) -> bool {
        self.chart + self.steps > 0
    }

    fn headings(&self) -> u32 {
        self.headings_il + self.headings_st + self.headings_ld + self.headings_other
    }

    /// Lines that are code of a dialect that is read.
    fn code_lines(&self) -> u32 {
        self.step7 + self.il + self.st
    }

    /// What a text is that is convincing by itself. Neither prose with listings in it nor the source of another
    /// language is.
    fn prove(&self) -> Option<Detected> {
        let Self { lines, prose, .. } = *self;
        if lines == 0 || self.markup {
            return None;
        }
        // A document may show a whole block or section between its paragraphs.
        if prose * 5 > lines {
            return None;
        }
        if self.block_headers > 0 && self.declarations + self.block_ends + self.step7 > 0 {
            let of_step7 = self.step7_words + self.step7 + self.graph + self.step5;
            let is_open = self.dfb_headers == self.block_headers && of_step7 == 0;
            return Some(if is_open && self.dfb + self.pl7 + self.cells + self.headings() > 0 {
                Detected::Pasted(self.pl7_text(Extension::Other))
            } else if is_open && self.scl + self.st > 0 {
                Detected::Unsupported { what: unsupported::IEC }
            } else if self.graph > 0 && self.chart + self.graph > 1 {
                Detected::Unsupported { what: unsupported::GRAPH }
            } else if self.scl > 1 && self.step7 * 4 < self.scl {
                Detected::Unsupported { what: unsupported::SCL }
            } else {
                Detected::Step7
            });
        }
        // In a text with headings of both, each unit says what it is.
        if self.headings_pl7_2 > 0 && self.headings() == 0 {
            return Some(Detected::Pl72);
        }
        if self.headings() > 0 && self.pl7 + self.il + self.st + self.rung + self.chart > 0 {
            return Some(Detected::Pasted(self.pl7_text(Extension::Other)));
        }
        let of_step5 = self.step5 + self.step7 + self.step7_symbols;
        let is_enough = self.step5 > 1 || self.step5 == 1 && of_step5 == lines && lines > 2;
        if is_enough && of_step5 * 2 > lines && self.step5 * STEP5_SHARE >= self.step7 {
            return Some(Detected::Step5);
        }
        let most = |count: u32| count * 5 >= lines * 3;
        let enough = |count: u32| count > 2 || count > 1 && count == lines;
        if self.rung > 1 && self.cells > 0 && most(self.rung + self.il + self.st) {
            return Some(Detected::Pasted(self.pl7_text(Extension::Other)));
        }
        let step7 = self.step7 + if self.step7 > 0 { self.declarations } else { 0 };
        if enough(self.step7) && most(step7) && self.step7 > self.il + self.st {
            return Some(Detected::Step7);
        }
        if self.step7 > 0 && self.step7_symbols > 2 && (self.step7 + self.step7_symbols) * 5 >= lines * 4 {
            return Some(Detected::Step7);
        }
        let structure = if self.st > 0 { self.scl } else { 0 };
        let charted = most(self.chart + self.chart_words + self.il + self.st + self.rung);
        let is_chart = self.has_chart() && self.chart + self.chart_words > 2 && self.graph == 0;
        if is_chart && charted && (self.pages > 1 || self.pl7 + self.pl7_2 > 0 && self.iec == 0) {
            return Some(Detected::Pasted(self.pl7_text(Extension::Other)));
        }
        if enough(self.pl7) && self.iec == 0 && self.chart == 0 && most(self.il + self.st + structure) {
            return Some(Detected::Pasted(self.pl7_text(Extension::Other)));
        }
        None
    }

    fn pl7_text(&self, extension: Extension) -> Pl7Text {
        // Under headings, each unit says what it is.
        if self.has_chart() && self.headings() == 0 {
            return if self.pages > 0 { Pl7Text::Gr7 } else { Pl7Text::Sfc };
        }
        // Of all words, those of rungs are the least ambiguous; a line of a rung may look like a line of other languages.
        let (il, st, ld) = match (self.headings_il, self.headings_st, self.headings_ld) {
            (0, 0, 0) => (self.il, self.st, self.cells),
            headings => headings,
        };
        if ld > 0 && ld >= il.max(st) {
            return Pl7Text::Ld;
        }
        match il.cmp(&st) {
            std::cmp::Ordering::Greater => Pl7Text::Il,
            std::cmp::Ordering::Equal if extension == Extension::Il => Pl7Text::Il,
            _ => Pl7Text::St,
        }
    }
}

/// Whether the header of a block may be that of a DFB type: its name has neither a number nor quotes.
fn is_dfb_header(block: &Entity, line: &str) -> bool {
    matches!(block, Entity::Block { kind: BlockKind::Fb, name: BlockName::Symbol(_) }) && !line.contains('"')
}

/// Whether a line of a function block can only be one of a DFB type (PL7:5376-5391, PL7:3571-3576, PL7:3808-3811).
fn is_dfb_line(code: &str, first: &str) -> bool {
    match first {
        "VAR_PUBLIC" | "VAR_PRIVATE" | "FTON" | "FTOF" | "FTP" | "FPULSOR" => return true,
        // Statement list has `SET` alone, and `INC 5`.
        "SET" | "RESET" | "INC" | "DEC" => {
            let operand = code.get(first.len()..).unwrap_or_default().trim();
            return operand.starts_with(|it: char| it.is_alphabetic() || it == '_') && operand.ends_with(';');
        }
        _ => {}
    }
    let mut words = code.split(|it: char| !(it.is_alphanumeric() || it == '_'));
    let mut blanks = code.split_whitespace().map(|it| it.trim_start_matches('(')).peekable();
    words.any(|it| ["EBOOL", "AR_X", "AR_W", "AR_D", "AR_R"].iter().any(|ty| ty.eq_ignore_ascii_case(it)))
        || std::iter::from_fn(|| Some((blanks.next()?, blanks.peek()?.chars().next())))
            .any(|(word, next)| matches!(word, "RE" | "FE") && next.is_some_and(char::is_alphabetic))
}

/// Whether a line that starts with a common word is one of a chart: `STEP 3 AT (C 4,L 3) :`, `TRANSITION FROM X0 TO X1`.
fn is_chart_line(code: &str, first: &str) -> bool {
    let rest = word(code).1.trim_start();
    let next = word(rest).0;
    match first {
        "STEP" => !next.is_empty() && rest.contains(':'),
        "ACTION" => rest.starts_with('(') || rest.contains(':') && !rest.starts_with(":="),
        "TRANSITION" => rest.starts_with('(') || ["AT", "FROM"].iter().any(|it| it.eq_ignore_ascii_case(next)),
        "PAGE" => !next.is_empty() && next.bytes().all(|it| it.is_ascii_digit()),
        _ => true,
    }
}

/// The part of a line before `//`.
fn before_line_comment(code: &str) -> &str {
    let mut slashes = memchr::memchr_iter(b'/', code.as_bytes());
    let end = slashes.find(|at| code.as_bytes().get(at + 1) == Some(&b'/')).unwrap_or(code.len());
    code.get(..end).unwrap_or_default()
}

/// Names of PL7 objects between `%` and the number.
const PL7_OBJECTS: [&str; 34] = [
    "I", "Q", "M", "K", "S", "X", "T", "C", "R", "L", "IW", "QW", "MW", "KW", "SW", "ID", "QD", "MD", "KD", "SD", "MB",
    "KB", "MF", "KF", "IF", "QF", "TM", "MN", "DR", "SR", "NW", "XM", "CH", "BLK",
];

/// Whether a line names an object as PL7 does: `%MW10`, `%I1.0`, `%MW 99`, `%X(0)`. Lower case must be followed by the
/// number at once, which no format string of another language is.
fn has_pl7_object(line: &str) -> bool {
    memchr::memchr_iter(b'%', line.as_bytes()).any(|at| {
        let before = line.get(..at).and_then(|before| before.chars().next_back());
        let rest = line.get(at + 1..).unwrap_or_default();
        let end = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
        let (letters, number) = rest.split_at(end);
        let upper = letters.bytes().all(|byte| byte.is_ascii_uppercase());
        let number = if upper { number.trim_start() } else { number };
        !before.is_some_and(|before| before.is_alphanumeric() || before == '%')
            && PL7_OBJECTS.iter().any(|object| object.eq_ignore_ascii_case(letters))
            && number.starts_with(|c: char| c.is_ascii_digit() || upper && c == '(')
    })
}

/// Whether a line names an object, or transfers a value, as PL7-2 alone does: `I0,05`, `T0,D`, `W5,A`, `W1 -> W2`. No symbol
/// has a comma.
fn has_pl7_2_object(line: &str) -> bool {
    let is_part = |it: char| it.is_ascii_alphanumeric() || it == ',';
    // Nearly no line has any of these: to look whether one is there costs less than to look where.
    let mut words = line.split(|it| !is_part(it)).filter(|it| it.len() <= LONGEST_PL7_2 && it.contains(','));
    let mut is_named = || words.any(|it| object::pl72::class_of(it).is_some_and(|it| it != object::Class::Fault));
    let is_transfer = || line.contains("END_BLOCK") && !line.contains(":=");
    let is_declared = || line.split_once(" AT ").is_some_and(|it| declared_by_pl7_2(it.1.trim_start()));
    line.contains(',') && is_named() || line.contains("->") && is_transfer() || line.contains(" AT ") && is_declared()
}

/// Whether a line has an address with a percent sign that PL7-2 does not have. A converter may write the sign before the
/// others too: `%I0,05`, `%X3`.
fn has_object_of_pl7_alone(line: &str) -> bool {
    memchr::memchr_iter(b'%', line.as_bytes()).any(|at| {
        let rest = line.get(at..).unwrap_or_default();
        let is_part = |it: char| it.is_ascii_alphanumeric() || matches!(it, '%' | ',' | '.' | ':');
        let end = rest.find(|it| !is_part(it)).unwrap_or(rest.len()).min(LONGEST_PL7_2 + 2);
        let word = rest.get(..end).unwrap_or_default().trim_end_matches([',', ':', '.']);
        let is_label =
            matches!(word.as_bytes(), [b'%', b'L' | b'l', digits @ ..] if digits.iter().all(u8::is_ascii_digit));
        !is_label && object::pl72::class_of(word).is_none()
    })
}

/// Characters of the longest address with a comma.
const LONGEST_PL7_2: usize = "COM15,3,F".len();

/// What follows `%L10:`.
fn strip_pl7_label(line: &str) -> &str {
    let Some(label) = strip_prefix_ignore_case(line, "%L") else { return line };
    let rest = label.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
    rest.strip_prefix(':').unwrap_or(line).trim_start()
}

/// The language of one line of PL7; `None` if it has none of its own.
fn pl7_statement(code: &str, first: &str, has_object: bool) -> Option<Pl7Text> {
    let rest = code.get(first.len()..).unwrap_or_default().trim();
    match first {
        "LD" | "LDN" | "LDR" | "LDF" | "AND" | "ANDN" | "ANDR" | "ANDF" | "OR" | "ORN" | "ORR" | "ORF" | "XOR"
        | "XORN" | "XORR" | "XORF" | "ST" | "STN" | "S" | "R" | "JMP" | "JMPC" | "JMPCN" | "IN" | "CU" | "CD"
        | "BLK" => {
            let symbol = first.len() > 1 && {
                let (name, rest) = word(rest);
                !name.is_empty() && rest.is_empty()
            };
            let operand = has_object && rest.starts_with(['%', '[', '(']);
            (symbol || operand).then_some(if rest.ends_with("THEN") || rest.ends_with(';') {
                Pl7Text::St
            } else {
                Pl7Text::Il
            })
        }
        "MPS" | "MRD" | "MPP" | "RETC" | "RETCN" | "ENDC" | "ENDCN" | "END_BLK" | "OUT_BLK" if rest.is_empty() => {
            Some(Pl7Text::Il)
        }
        "IF" | "ELSIF" | "ELSEIF" | "WHILE" | "FOR" | "UNTIL" | "SET" | "RESET" | "INC" | "DEC" if has_object => {
            Some(Pl7Text::St)
        }
        _ if code.starts_with('[') && has_object => Some(Pl7Text::Il),
        _ if code.contains(":=") && code.ends_with(';') => Some(Pl7Text::St),
        _ => None,
    }
}

/// Whether a line is a statement list instruction, with an optional label before it.
fn is_step7_instruction(line: &str) -> bool {
    let line = strip_step7_label(line);
    let line = line.split(';').next().unwrap_or_default().trim();
    let end = line.find(|c: char| c.is_ascii_alphanumeric()).unwrap_or(line.len());
    let operator = line.get(..end).unwrap_or_default().trim_end();
    if !operator.is_empty() {
        let rest = line.get(operator.len()..).unwrap_or_default();
        return match operator {
            "=" => is_step7_operand(rest),
            ")" => rest.is_empty() || rest.eq_ignore_ascii_case("MCR"),
            "+" | "-" | "*" | "/" | "==" | "<>" | ">" | "<" | ">=" | "<=" => {
                ["I", "D", "R"].iter().any(|kind| kind.eq_ignore_ascii_case(rest))
                    || operator == "+" && is_step7_operand(rest)
                    || operator == "+" && ["AR1", "AR2"].iter().any(|name| name.eq_ignore_ascii_case(rest))
            }
            // `= "symbol"`, `= #local`, `= « symbol »`.
            _ => operator.strip_prefix('=').is_some_and(|_| is_step7_operand(line.get(1..).unwrap_or_default())),
        };
    }
    let (mnemonic, rest) = word(line);
    let operand = rest.trim();
    match mnemonic.to_ascii_uppercase().as_str() {
        "U" | "UN" | "A" | "AN" | "ON" | "X" | "XN" => operand == "(" || is_step7_operand(operand),
        "O" => matches!(operand, "" | "(") || is_step7_operand(operand),
        "S" | "R" | "FP" | "FN" | "L" | "T" | "SI" | "SV" | "SE" | "SS" | "SA" | "SP" | "SD" | "SF" | "FR" | "ZV"
        | "ZR" | "CU" | "CD" | "LC" | "AUF" | "OPN" | "INC" | "DEC" | "NOP" | "BLD" => is_step7_operand(operand),
        "SPA" | "SPB" | "SPBN" | "SPBB" | "SPBNB" | "SPBI" | "SPBIN" | "SPL" | "SPM" | "SPMZ" | "SPN" | "SPO"
        | "SPP" | "SPPZ" | "SPS" | "SPU" | "SPZ" | "JU" | "JC" | "JCN" | "JCB" | "JNB" | "JBI" | "JNBI" | "JL"
        | "JM" | "JMZ" | "JN" | "JO" | "JP" | "JPZ" | "JOS" | "JUO" | "JZ" | "LOOP" => {
            let (label, rest) = word(operand);
            !label.is_empty() && rest.is_empty()
        }
        "CALL" | "UC" | "CC" => {
            let called = operand.split([',', '(']).next().unwrap_or_default();
            is_step7_operand(called)
        }
        "UW" | "OW" | "XOW" | "UD" | "OD" | "XOD" | "AW" | "AD" | "SSI" | "SSD" | "SLW" | "SRW" | "SLD" | "SRD"
        | "RLD" | "RRD" | "LAR1" | "LAR2" | "TAR1" | "TAR2" => operand.is_empty() || is_step7_operand(operand),
        "BE" | "BEA" | "BEB" | "BEU" | "BEC" | "SET" | "CLR" | "NOT" | "SAVE" | "TAK" | "ENT" | "LEAVE" | "INVI"
        | "INVD" | "NEGI" | "NEGD" | "NEGR" | "BTI" | "ITB" | "BTD" | "DTB" | "ITD" | "DTR" | "RND" | "TRUNC"
        | "TAW" | "TAD" | "CAW" | "CAD" | "TAR" | "CAR" | "TDB" | "CDB" | "MCRA" | "MCRD" | "MOD" | "RLDA" | "RRDA" => {
            operand.is_empty()
        }
        "MCR" => operand == "(",
        _ => false,
    }
}

/// Whether a line is a bit instruction on a bare name, as documents print them: `U Sto`, `UN T2p[21]`.
fn is_step7_with_symbol(line: &str) -> bool {
    let (mnemonic, operand) = match line.strip_prefix('=') {
        Some(operand) => ("=", operand),
        None => word(line),
    };
    let (_, rest) = word(operand.trim_start());
    let index = rest.strip_prefix('[').map_or(Some(rest), |index| index.split_once(']').map(|(_, rest)| rest));
    ["U", "UN", "A", "AN", "O", "ON", "X", "XN", "S", "R", "="].contains(&mnemonic)
        && operand.starts_with([' ', '\t'])
        && index.is_some_and(|rest| matches!(rest.trim(), "" | ";"))
}

/// What follows `M001:`. A label alone is left as it is.
fn strip_step7_label(line: &str) -> &str {
    let (label, rest) = word(line);
    match rest.trim_start().strip_prefix(':') {
        Some(code) if (1..=8).contains(&label.len()) && !code.starts_with('=') && !code.trim().is_empty() => {
            code.trim_start()
        }
        _ => line,
    }
}

/// Prefixes of the absolute operands of STEP 7 and STEP 5 before the number, in both mnemonic sets.
const STEP7_AREAS: [&str; 48] = [
    "E", "EB", "EW", "ED", "A", "AB", "AW", "AD", "I", "IB", "IW", "ID", "Q", "QB", "QW", "QD", "M", "MB", "MW", "MD",
    "L", "LB", "LW", "LD", "T", "Z", "C", "DBX", "DBB", "DBW", "DBD", "DIX", "DIB", "DIW", "DID", "PEB", "PEW", "PED",
    "PAB", "PAW", "PAD", "PIW", "PQW", "OB", "FB", "FC", "DB", "DI",
];

/// Whether a text is an operand of STEP 7 and nothing else: `E 0.0`, `DB1.DBW 2`, `#tem`, `"X0"`, `« X0 »`, `S5T#1S`,
/// `W [AR1,P#0.0]`, `-5`.
fn is_step7_operand(text: &str) -> bool {
    let text = text.trim();
    let quoted = |open: char, close: char| {
        text.strip_prefix(open).and_then(|rest| rest.split_once(close)).is_some_and(|(name, rest)| {
            !name.is_empty() && (rest.is_empty() || rest.starts_with('.') && !rest.contains(' '))
        })
    };
    if quoted('"', '"') || quoted('«', '»') || quoted('\'', '\'') {
        return true;
    }
    if let Some(local) = text.strip_prefix('#') {
        return !local.is_empty() && !local.contains(char::is_whitespace);
    }
    let is_constant = |text: &str| {
        text.chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '#' | '_' | ':' | '+' | '-' | ',' | '(' | ')'))
    };
    if text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-')) {
        return is_constant(text);
    }
    let (prefix, rest) = word(text);
    if rest.starts_with('#') && rest.len() > 1 {
        return prefix.len() <= 4 && !rest.contains(char::is_whitespace);
    }
    if ["SFC", "SFB", "UDT", "STW", "AR1", "AR2", "DBNO", "DBLG", "DINO", "DILG", "OV", "OS", "BIE", "BR", "UO"]
        .iter()
        .any(|name| name.eq_ignore_ascii_case(prefix))
        && rest.trim_start().bytes().all(|byte| byte.is_ascii_digit())
    {
        return true;
    }
    let end = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (area, rest) = text.split_at(end);
    if !STEP7_AREAS.iter().any(|name| name.eq_ignore_ascii_case(area)) {
        return false;
    }
    let rest = rest.trim_start();
    if let Some(indirect) = rest.strip_prefix('[') {
        return indirect.ends_with(']');
    }
    // `0.0`, `1.DBX 0.0`: at most one blank inside.
    rest.starts_with(|c: char| c.is_ascii_digit())
        && rest.bytes().filter(|byte| *byte == b' ').count() <= 1
        && rest.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b' '))
        && (!rest.contains(' ') || rest.contains(".D") || rest.contains(".d"))
}

/// Whether a line can only be STEP 5: a colon before the instruction, the end of a segment, fixed-point operators and
/// constants of its kinds.
fn is_step5(line: &str) -> bool {
    if line.starts_with("***") {
        return true;
    }
    // The address that a print puts before the colon.
    let address = line.find(|it: char| !it.is_ascii_hexdigit()).unwrap_or(0);
    let behind = line.get(address..).unwrap_or_default().trim_start();
    let line = if address >= 4 && behind.starts_with(':') { behind } else { line };
    let line = step5_code(line);
    let heading = step5_heading(line).and_then(|it| it.block_kind());
    if heading.is_some_and(|it| matches!(it, BlockKind::Pb | BlockKind::Sb | BlockKind::Fx | BlockKind::Dx)) {
        return true;
    }
    let (colon, code) = match line.strip_prefix(':') {
        Some(code) if !code.starts_with('=') || code.starts_with("= ") => (true, code.trim_start()),
        _ => (false, line),
    };
    let operator = ["!=F", "><F", "!=G", "><G", "!=D", "><D"].iter().any(|operator| code.starts_with(operator));
    let constant = code.strip_prefix("L ").is_some_and(|operand| {
        let (kind, _) = operand.trim_start().split_at_checked(2).unwrap_or_default();
        ["KB", "KC", "KF", "KG", "KH", "KM", "KT", "KY", "KZ"].contains(&kind)
    });
    operator || constant || colon && is_step7_instruction(code) || is_step5_instruction(strip_step7_label(code))
}

/// Whether an instruction is one that STEP 7 has not: `SPA PB 10`, `SPB= M1`, `A DB 5`, `KEW`, `NAME :INIT`.
fn is_step5_instruction(code: &str) -> bool {
    let (mnemonic, rest) = word(code);
    let rest = rest.trim_start();
    let (operand, after) = word(rest);
    let letters = operand.trim_end_matches(|it: char| it.is_ascii_digit());
    let numbered = letters.len() < operand.len() || after.trim_start().starts_with(|it: char| it.is_ascii_digit());
    match mnemonic {
        "SPA" | "SPB" | "JU" | "JC" | "BA" | "BAB" | "DOU" | "DOC" => {
            numbered && ["OB", "PB", "SB", "FB", "FX"].contains(&letters) || rest.starts_with('=')
        }
        "SPZ" | "SPN" | "SPP" | "SPM" | "SPO" | "JZ" | "JN" | "JP" | "JM" | "JO" => rest.starts_with('='),
        "A" | "E" | "C" | "G" => numbered && letters == "DB" || letters == "DX",
        "KEW" | "KZW" | "CFW" | "CSW" => rest.is_empty(),
        "NAME" | "BEZ" | "DECL" => rest.starts_with(':') && !rest.starts_with(":="),
        _ => false,
    }
}

/// Whether a line declares, initialises or passes a value: `tem : TIMER;`, `duree := S5T#1S`.
fn is_declaration(line: &str) -> bool {
    let name_end = line
        .find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.' | ',' | '[' | ']' | ' ' | '\t')))
        .unwrap_or(line.len());
    let (name, rest) = line.split_at(name_end);
    if name.trim().is_empty() || name.trim().contains(' ') && !name.contains(',') {
        return false;
    }
    match rest.strip_prefix(":=") {
        Some(value) => !value.trim().is_empty(),
        None => rest.strip_prefix(':').is_some_and(|declared| {
            let declared = declared.trim_start();
            let (name, _) = word(declared);
            !name.is_empty()
                && name.bytes().all(|byte| byte.is_ascii_uppercase() || byte == b'_' || byte.is_ascii_digit())
                || declared.starts_with('"')
        }),
    }
}

/// The symbols of a STEP 5 program `PLANTA` lie in `PLANTAZ0.SEQ`.
fn is_step5_table(path: &Path) -> bool {
    let name = path.file_stem().and_then(|it| it.to_str()).unwrap_or_default();
    name.get(name.len().saturating_sub(2)..).is_some_and(|it| it.eq_ignore_ascii_case("Z0"))
}

/// Whether a row of a symbol table names a block that only STEP 5 has.
fn is_step5_row(line: &str) -> bool {
    let has_letters = line.as_bytes().windows(2).any(|it| matches!(it, [b'P' | b'S', b'B'] | [b'F' | b'D', b'X']));
    has_letters
        && line.split(['\t', '"', ',']).any(|field| {
            let (letters, number) = field.trim().split_at_checked(2).unwrap_or_default();
            let number = number.trim();
            matches!(letters, "PB" | "SB" | "FX" | "DX")
                && !number.is_empty()
                && number.bytes().all(|it| it.is_ascii_digit())
        })
}

/// Whether a line is a row of a symbol table: quoted fields, fixed width after `126,`, or an address between tabs.
fn is_symbol_row(line: &str) -> bool {
    line.starts_with("126,")
        || line.starts_with('"') && line.matches("\",\"").count() >= 2
        || line.contains('\t') && line.split('\t').take(2).any(is_step7_operand)
}

/// Whether a line is natural language or markup of a document, rather than code.
fn is_prose(line: &str) -> bool {
    if line.starts_with("```") {
        return true;
    }
    let (mut words, mut natural) = (0, 0);
    for word in line.split_whitespace().take(24) {
        let letters = word.trim_matches(['.', ',', ';', ':', '!', '?', '(', ')', '«', '»', '"']);
        let is_natural = letters.contains(char::is_lowercase)
            && letters.chars().all(|c| c.is_alphabetic() || matches!(c, '\'' | '’' | '-'));
        words += 1;
        natural += u32::from(is_natural);
    }
    words >= 4 && natural * 3 >= words * 2 && !line.contains(":=")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const STEP7: Detected = Detected::Step7;
    const IL: Detected = Detected::Pasted(Pl7Text::Il);
    const ST: Detected = Detected::Pasted(Pl7Text::St);
    const LD: Detected = Detected::Pasted(Pl7Text::Ld);

    fn unsupported(what: &'static str) -> Detected {
        Detected::Unsupported { what }
    }

    fn hint(path: &str) -> FileHint<'_> {
        FileHint { path: Some(Path::new(path)), ..FileHint::default() }
    }

    #[track_caller]
    fn check(path: &str, text: &str, expected: Detected) {
        assert_eq!(load(hint(path), text.as_bytes(), None).1, expected, "{path}: {text}");
    }

    const SOURCE: &str = "FUNCTION FC 1 : VOID\nTITLE = x\nBEGIN\nNETWORK\n  U E 0.0;\n  = A 4.0;\nEND_FUNCTION\n";
    const LISTING: &str = "U     « X0 »   //si l'on est en X0\nL     S5T#1S\nSE    « temp01 »\n...\nBE\n";
    const PL7_ST: &str = "! (*Comptage*)\nIF %M0 AND %M12 THEN\n  INC %MW4;\nEND_IF;\n%MW10:=%MW8+%MW9;\n";
    const PL7_IL: &str = "! %L2:\n  LD %I1.0\n  AND %M10\n  ST %Q2.5\n";
    const RUNG: &str = "RUNG (*fill*) %L10:\nOPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n";

    #[test]
    fn content_is_recognised_in_any_file() {
        for path in ["a.txt", "a.awl", "a.stl", "a.il", "a.ST"] {
            check(path, SOURCE, STEP7);
            check(path, LISTING, STEP7);
            check(path, PL7_ST, ST);
            check(path, PL7_IL, IL);
            check(path, "[HEADER]\nDATE = date#2024-03-01\n[SOURCE_UNIT]\n", Detected::Exchange);
            check(
                path,
                "FUNCTION FC 1 : VOID\nBEGIN\nIF #a THEN\n#b := 1;\nEND_IF;\nEND_FUNCTION",
                unsupported(unsupported::SCL),
            );
            check(
                path,
                "FUNCTION_BLOCK \"f\"\nBEGIN\n  \"x\" := 1;\n y := 2;\nEND_FUNCTION_BLOCK",
                unsupported(unsupported::SCL),
            );
            check(path, "PB 10\n  :U E 0.0\n  :L KF +5\n  := A 4.0\n  :***\n  :BE\n", Detected::Step5);
            check(path, RUNG, LD);
        }
        check("a.txt", "DATA_BLOCK DB 1\nSTRUCT\n a : INT;\nEND_STRUCT;\nBEGIN\n a := 1;\nEND_DATA_BLOCK", STEP7);
        check("a.txt", "U S1\n= Sto\nU X41\nO(\nUN T2p[21]\n)\n= X1", STEP7);
        check("a.txt", "U T1\n= A4.0", STEP7);
        check("a.txt", "ST : MAST - SR10\n%M0 := TRUE;", ST);
        check("a.txt", "LD : MAST - Peinture\nRUNG\nEND_RUNG", LD);
    }

    /// `FUNCTION_BLOCK` begins a DFB type of PL7, a block of STEP 7, and a block of IEC 61131-3.
    #[test]
    fn function_blocks() {
        let interface = "VAR_INPUT\n Raz : BOOL;\n Presel : WORD;\nEND_VAR\n";
        let of =
            |rest: &str| format!("(* count *)\nFUNCTION_BLOCK Cpt_pieces\n{interface}{rest}\nEND_FUNCTION_BLOCK\n");
        for path in ["a.txt", "a.st", "a.il", "a.awl", "a.ld"] {
            for (rest, expected) in [
                ("IF RE Raz THEN\n V_cour := 0;\nEND_IF;", ST),
                ("IF (RE Raz) THEN\n V_cour := 0;\nEND_IF;", ST),
                ("VAR_PUBLIC\n V_cour : WORD;\nEND_VAR\nV_cour := 0;", ST),
                ("VAR\n Memo : EBOOL;\nEND_VAR\nMemo := Raz;", ST),
                ("IF Raz THEN\n SET Done;\nEND_IF;", ST),
                ("! V_cour := 0;", ST),
                ("RUNG\nOPEN_CONTACT(Raz),H_LINK(9),COIL(Done);\nEND_RUNG", LD),
                ("BEGIN\n U #Raz;\n S #Done;", STEP7),
                ("BEGIN\nNETWORK\nTITLE = x", STEP7),
                ("BEGIN\nIF #Raz THEN\n #V_cour := 0;\nEND_IF;", unsupported(unsupported::SCL)),
                ("IF Raz THEN\n V_cour := 0;\nEND_IF;", unsupported(unsupported::IEC)),
                (
                    "VAR\n t : TON;\nEND_VAR\nt(IN := Raz);\nIF t.Q THEN\n Done := TRUE;\nEND_IF;",
                    unsupported(unsupported::IEC),
                ),
            ] {
                check(path, &of(rest), expected);
            }
        }
        check("a.txt", &format!("FUNCTION_BLOCK \"Cpt\"\n{interface}BEGIN\n SET;\nEND_FUNCTION_BLOCK"), STEP7);
        check("a.txt", &format!("FUNCTION_BLOCK FB 3\n{interface}END_FUNCTION_BLOCK\n"), STEP7);
    }

    #[test]
    fn near_misses_are_left_out() {
        for text in [
            "",
            "\n\n// nothing\n",
            "La fonction FC1 est appelée par OB1.\nFUNCTION FC 1 désigne la fonction numéro un du programme.\n\
             L'instruction U E0.0 lit l'entrée.\n",
            "FUNCTION principale du programme\nTYPE de machine\n",
            "# Title\n\nSome words about a program of a controller.\n\n```\nU E 0.0\n= A 4.0\nU E 0.1\n```\n\n\
             - and a list of other words\n- with a second entry in it\n",
            "#include <stdio.h>\nint main(void)\n{\n  printf(\"%d %s3\", 1, x);\n  return 0;\n}\n",
            "{\n  \"name\": \"plc\",\n  \"A\": [1, 2]\n}\n",
            "[HEADER]\nname = x\n[other]\ny = 1\n",
            "solid cube\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n endloop\n endfacet\nendsolid cube\n",
            "MEMORY\n{\n  FLASH (rx) : ORIGIN = 0x8000, LENGTH = 32K\n}\nSECTIONS { .text : { *(.text) } }\n",
            "Object subclass: Foo [\n  bar [ | x | x := 3. ^x ]\n]\n",
            ".assembly extern mscorlib {}\n.class public Foo {\n  ldarg.0\n  ret\n}\n",
            "name,address\npump,1\nvalve,2\n",
        ] {
            for path in ["a.txt", "a.stl", "a.st", "a.il", "a.ld", "a.db", "a.sdf"] {
                if text.starts_with("[HEADER]") && matches!(path, "a.st" | "a.il" | "a.ld") {
                    continue;
                }
                if text.trim().trim_start_matches("// nothing").is_empty() && !matches!(path, "a.txt" | "a.db" | "a.ld")
                {
                    continue;
                }
                check(path, text, Detected::NotPlc);
            }
        }
    }

    #[test]
    fn headings_of_pl7_2() {
        let rung = "RUNG\nOPEN_CONTACT(I0,05),H_LINK(8),COIL(O0,03);\nEND_RUNG\n";
        for path in ["a.txt", "a.ld", "a.gr7"] {
            for heading in ["LD : PL7-2 - POST", "ld : pl7-2 - FAST", "GR7 : PL7-2 - SEQ", "LD : PL7-2"] {
                check(path, &format!("(* press *)\n{heading}\n{rung}"), Detected::Pl72);
            }
            check(path, &format!("LD : PL7-2 - POST\n{rung}ST : MAST - SR1\n! %M1 := %M2;\n"), ST);
            check(path, &format!("LD : MAST - POST\n{rung}"), LD);
        }
        let prose = "A program of the TSX 27 is written under headings of this kind:\n\nLD : PL7-2 - POST\n\n\
                     There is one for each part of the program, as the document says.\n";
        check("a.txt", prose, Detected::NotPlc);
    }

    #[test]
    fn extensions_decide_what_content_does_not() {
        check("a.awl", "", STEP7);
        check("a.AWL", "// nothing yet\n", STEP7);
        check("a.awl", "??? !!!\n", STEP7);
        check("a.awl", "<?xml version='1.0'?>\n<a/>", Detected::Unreadable { why: MARKUP });
        check("a.stl", "// nothing yet\n", STEP7);
        check("a.il", "(* nothing yet *)", IL);
        check("a.st", "", ST);
        check("a.il", "LD Depart\nANDN Arret\nST Moteur\n", IL);
        check("a.st", "Moteur := Depart AND NOT Arret;\n", ST);
        check("a.st", "VAR\n x : INT;\nEND_VAR\nx := x + 1;\n", unsupported(unsupported::IEC));
        check("a.dfb", "FUNCTION_BLOCK Cpt\nEND_FUNCTION_BLOCK", ST);
        check("a.dfb", "Dear reader", unsupported(unsupported::DFB));
        check("a.scy", "Pump AT %M0 : EBOOL (*comment*);", Detected::Exchange);
        check("a.scy", "Cpt_vis : Cpt_pieces;", Detected::Exchange);
        check("a.scy", "Dear reader", unsupported(unsupported::VARIABLES));
        check("a.ufb", "[HEADER]\n[SOURCE_UNIT]\nA8F0\n[EOF]", unsupported(unsupported::ENCRYPTED));
        check("a.fef", "[HEADER]\n[EOF]", Detected::Exchange);
        // The smallest expansion, on a page of its own: its heading says the language, the file none.
        for page in ["", "PAGE 0\n"] {
            let text = format!("GR7 : MAST - P - MACRO2\n{page}IN_STEP AT (C 0,L 1)\nOUT_STEP AT (C 0,L 3)\n");
            check("a.txt", &text, ST);
        }
        check("a.gr7", "NB_PAGES = 8\nPAGE 0\nEND_PAGE", Detected::Pasted(Pl7Text::Gr7));
        check(
            "a.gr7",
            "FUNCTION_BLOCK \"x\"\nVAR\nEND_VAR\nGRAPH7\nSEQUENCE\nINITIAL_STEP S1:\n",
            unsupported(unsupported::GRAPH),
        );
        check("a.scl", "x", unsupported(unsupported::SCL));
        check("a.xef", "<FEFExchangeFile/>", unsupported(unsupported::CONTROL_EXPERT));
        check("a.db", "DATA_BLOCK \"a\"\nSTRUCT\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK", STEP7);
        check("a.sdf", "\"a\",\"I 0.0\",\"BOOL\",\"x\"\n", Detected::Step7Symbols);
        check("a.asc", "126,Pump                    E       0.0 BOOL      x\n", Detected::Step7Symbols);
        check("a.seq", "\tE 0.0\tPump\tcomment\n", Detected::Step7Symbols);
        check("plantZ0.seq", "\tE 0.0\tPump\tcomment\n", Detected::Step5Symbols);
        check("a.seq", "\tPB 10\tPump\tcomment\n\tE 0.0\tLamp\t\n", Detected::Step5Symbols);
        check(
            "a.dif",
            "TABLE\n0,1\n\"\"\nVECTORS\n0,1\n\"\"\nTUPLES\n0,4\n\"\"\nDATA\n0,0\n\"\"\n-1,0\nBOT\n",
            Detected::Step7Symbols,
        );
        check("a.sfc", "INITIAL_STEP X0 : END_STEP", Detected::Pasted(Pl7Text::Sfc));
        check("a.sfc", "<svg/>", Detected::NotPlc);
    }

    #[test]
    fn step5_is_no_step7() {
        let s5 = Detected::Step5;
        for path in ["a.awl", "a.txt", "a.stl", "a.s5"] {
            check(path, "PB 10\n     :U    E 0.0\n     :=    A 4.0\n     :BE\n", s5);
            check(path, "PB 10\nA I 0.0\n= Q 4.0\nJU PB 11\nBE\n", s5);
            check(path, "U t1\nU X1\nS X2\nR X1\n***\nU t2\nU X2\nS X3\nR X2\n***\n", s5);
            check(path, "; start-up\nUN M0.0\nS M0.0\nSPA PB10\nSPA PB20\nBE\n", s5);
            check(path, "0005      :U    E 0.0\n0006      :L    KT 200.1\n0007      :SV   T 3\n0008      :***\n", s5);
        }
        for text in [
            "U E 0.0\n= A 4.0\nSPA M001\nM001: NOP 0\nBE\n",
            "FUNCTION FB 5 : VOID\nBEGIN\nNETWORK\nU E 0.0\n= A 4.0\nEND_FUNCTION\n",
            "AUF DB 5\nL DBW 0\nT MW 2\nU E 0.0\nUC FC 1\nBE\n",
            "(*** pump ***)\nU E 0.0\n= A 4.0\n// *** valve\nU E 0.1\n= A 4.1\n",
        ] {
            check("a.awl", text, STEP7);
        }
        check("z0.seq", "1\tE 0.0\tSTART\tTaster\n2\tMW 10\tZAHL\t\n", Detected::Step5Symbols);
        assert_eq!("step5".parse(), Ok(Dialect::Step5));
        assert_eq!(detect(FileHint { dialect: Dialect::Step5, ..hint("a.awl") }, "U E 0.0\n"), s5);
    }

    #[test]
    fn charts() {
        let page = "NB_PAGES = 8\nPAGE 0\nINITIAL_STEP 0 AT (C 4,L 1) :\nEND_STEP\nTRANSITION (ST) AT (C 4,L 2) :\n\
                    (*PHRASE*) %I1.0 (*END_PHRASE*)\nEND_TRANSITION\nEND_PAGE\n";
        let textual = "INITIAL_STEP X0 : END_STEP\nSTEP X1 : Fill(N); END_STEP\n\
                       TRANSITION FROM X0 TO X1 := %I1.0 AND NOT %M3; END_TRANSITION\n\
                       ACTION Fill : %Q2.0 := TRUE; END_ACTION\n";
        for path in ["a.txt", "a.gr7", "a.st", "a.sfc"] {
            check(path, page, Detected::Pasted(Pl7Text::Gr7));
            check(path, textual, Detected::Pasted(Pl7Text::Sfc));
        }
        check("a.txt", "Step 1: open the valve\nStep 2: close it\nAction: none\n", Detected::NotPlc);
        // A part of a chart may lack the initial step.
        let part = "STEP X1 : Fill(N); END_STEP\nTRANSITION FROM X1 TO X2 := %I1.0; END_TRANSITION\n\
                    STEP X2 : END_STEP\nACTION Fill : %Q2.0 := TRUE; END_ACTION\n";
        for path in ["a.txt", "a.st", "a.sfc"] {
            check(path, part, Detected::Pasted(Pl7Text::Sfc));
            check(path, &part.replace('%', "").replace('.', ",0"), Detected::Pl72);
        }
        assert_eq!(pl7_text("STEP X1 : END_STEP\nTRANSITION FROM X1 TO X2 := I0,01; END_TRANSITION\n"), Pl7Text::Sfc);
        check("a.st", "! Step := 1;\n! Action := %MW3;\n", Detected::Pasted(Pl7Text::St));
    }

    #[test]
    fn data_that_is_not_text() {
        let zip = b"PK\x03\x04\x14\0\0\0\x08\0\0\0";
        let unreadable = Detected::Unreadable { why: BINARY };
        for (path, expected) in [
            ("a.awl", unreadable),
            ("a.il", unreadable),
            ("a.stl", Detected::NotPlc),
            ("a.txt", Detected::NotPlc),
            ("a.db", Detected::NotPlc),
            ("a.stx", Detected::Unreadable { why: stx::DAMAGED }),
            ("a.ufb", unsupported(unsupported::ENCRYPTED)),
            ("a.zef", unsupported(unsupported::CONTROL_EXPERT)),
        ] {
            let (source, detected) = load(hint(path), zip, None);
            assert_eq!((detected, &*source.text), (expected, ""), "{path}");
        }
        let explicit = FileHint { explicit: true, ..hint("a.bin") };
        assert_eq!(load(explicit, zip, None).1, unreadable);

        // A mesh of one triangle whose header and coordinates happen to be printable.
        let mut mesh = vec![b' '; 80];
        mesh.extend(1_u32.to_le_bytes());
        mesh.extend([b'A'; 50]);
        assert_eq!(load(hint("a.stl"), &mesh, None).1, Detected::NotPlc);

        let utf16 = b"U\0 \0E\x000\0.\x000\0\n\0=\0 \0A\x001\0.\x000\0";
        assert_eq!(load(hint("a.txt"), utf16, Some(Encoding::Utf16Le)).1, STEP7);
    }

    #[test]
    fn the_user_may_know_better() {
        let forced = |dialect, text| detect(FileHint { dialect, ..hint("a.txt") }, text);
        assert_eq!(forced(Dialect::Step7, "prose, for all we know"), STEP7);
        assert_eq!(forced(Dialect::Pl7, PL7_IL), IL);
        assert_eq!(forced(Dialect::Pl7, "Moteur := Depart;"), ST);
        assert_eq!(forced(Dialect::Pl7Il, PL7_ST), IL);
        assert_eq!(forced(Dialect::Pl7St, "[SOURCE_UNIT]"), Detected::Exchange);
        assert_eq!(forced(Dialect::Pl72, "RUNG"), Detected::Pl72);
        assert_eq!(forced(Dialect::Pl72, "[SOURCE_UNIT]\nPROGRAM\n[EOF]\n"), Detected::Pl72Exchange);
        assert_eq!(forced(Dialect::Pl7Ld, "RUNG\nOPEN_CONTACT(I0,05);\nEND_RUNG"), Detected::Pasted(Pl7Text::Ld));
        let explicit = FileHint { explicit: true, ..hint("a.xyz") };
        assert_eq!(detect(explicit, "= A 4.0"), STEP7);
        assert_eq!(detect(explicit, "%M0 := 1;"), ST);
        assert_eq!(detect(explicit, "some words that nobody takes for a program"), Detected::NotPlc);
        assert_eq!(detect(hint("a.xyz"), "= A 4.0"), Detected::NotPlc);
    }

    #[test]
    fn dialect_names() {
        for dialect in Dialect::ALL {
            assert_eq!(dialect.as_str().parse(), Ok(dialect));
        }
        assert_eq!("ladder".parse::<Dialect>(), Err(UnknownDialect("ladder".into())));
    }

    #[test]
    fn known_extensions() {
        for path in ["a.awl", "b/A.STL", "x.Txt", "y.fef", "z.gr7"] {
            assert!(has_plc_extension(Path::new(path)), "{path}");
        }
        for path in ["a.md", "a.c", "awl", "a.awl.bak", "", ".awl"] {
            assert!(!has_plc_extension(Path::new(path)), "{path}");
        }
    }

    proptest! {
        #[test]
        fn every_file_is_something(
            text in "([UOLAS=%(){}\\[\\]\"'«»:;.,#* \t\nIF0-9a-z!/<>]|FUNCTION |%MW|END_|:=){0,80}|\\PC*",
            path in "a\\.(awl|stl|st|il|ld|txt|sdf|gr7)",
        ) {
            let _ = detect(hint(&path), &text);
        }
    }

    /// Ladder and charts say by their operands whose they are; where they do not, the configured controller does.
    #[test]
    fn pl7_2_by_its_operands() {
        let rung = |operand: &str| format!("RUNG\nOPEN_CONTACT({operand}),H_LINK(8),COIL(B1);\nEND_RUNG\n");
        let with = |family, text: &str| detect(FileHint { family, ..hint("a.txt") }, text);
        for operand in ["I0,05", "T0,D", "W5,A", "X3,V", "i1,b", "C0,E"] {
            assert_eq!(with(None, &rung(operand)), Detected::Pl72, "{operand}");
        }
        let ladder = Detected::Pasted(Pl7Text::Ld);
        for operand in ["%M0", "%I1.0", "Pump", "B5", "X3", "I1.0"] {
            assert_eq!(with(None, &rung(operand)), ladder, "{operand}");
        }
        for operand in ["B5", "X3", "Pump"] {
            assert_eq!(with(Some(Family::Pl72), &rung(operand)), Detected::Pl72, "{operand}");
            assert_eq!(with(Some(Family::Pl7), &rung(operand)), ladder, "{operand}");
        }
        // An operand of PL7 is never one of PL7-2.
        assert_eq!(with(Some(Family::Pl72), &rung("%I1.0")), ladder);
        assert_eq!(with(None, &format!("{}{}", rung("I0,05"), rung("%I1.0"))), ladder);
        // With the percent sign of a converter, and its labels.
        for operand in ["%I0,05", "%T0,D", "%X3,V"] {
            assert_eq!(with(None, &rung(operand).replace("RUNG\nO", "RUNG %L5:\nO")), Detected::Pl72, "{operand}");
        }
        for operand in ["%X3", "%B5", "%T0"] {
            assert_eq!(with(None, &rung(operand)), ladder, "{operand}");
            assert_eq!(with(Some(Family::Pl72), &rung(operand)), Detected::Pl72, "{operand}");
        }
        let operate = "RUNG\nH_LINK(7),OPERATE 127 -> W10 END_BLOCK;\nEND_RUNG\n";
        assert_eq!(with(None, operate), Detected::Pl72);
        let chart =
            "INITIAL_STEP X0 : END_STEP\nSTEP X1 : END_STEP\nTRANSITION FROM X0 TO X1 := I0,05; END_TRANSITION\n";
        assert_eq!(with(None, chart), Detected::Pl72);
        let exchange =
            |operand: &str| format!("[SOURCE_UNIT]\nLANGUAGE = LD\nPROGRAM\n{}END_PROGRAM\n[EOF]\n", rung(operand));
        assert_eq!(with(None, &exchange("I0,05")), Detected::Pl72Exchange);
        assert_eq!(with(None, &exchange("B5")), Detected::Exchange);
        assert_eq!(with(Some(Family::Pl72), &exchange("B5")), Detected::Pl72Exchange);
        assert_eq!(with(Some(Family::Pl72), &exchange("%M5")), Detected::Exchange);
        // A mistake in one operand changes nothing.
        assert_eq!(with(None, &format!("{}{}{}", rung("I0,05"), rung("T0,D"), rung("%M5"))), Detected::Pl72);
        // Lists and text are PL7's, whatever is configured.
        assert_eq!(with(Some(Family::Pl72), "! %M1 := %M2;\n! %M3 := %M4;\n! %M5 := %M6;\n"), ST);
    }
}

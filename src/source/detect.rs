//! What a file is, by its content first and its extension second: in the field `.LD .ST .GR7 .SEQ .STL .SDF .DB .TXT`
//! all have several meanings.

mod lead;
mod sample;
mod tally;

use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use super::decode::{Encoding, SourceText, decode, looks_binary};
use super::scan::{Comments, Lines};
use super::{stx, symlist};
use crate::model::entity::Family;
pub use sample::Sample;
use tally::{Kind, Signs, Tally, has_pl7_object};

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
    detect_tallied(hint, text, &sample::tally(text, kind(hint)))
}

/// The same of a text that was edited since the sample was last taken.
pub fn detect_edited(hint: FileHint<'_>, text: &Arc<str>, sample: &mut Sample) -> Detected {
    detect_tallied(hint, text, &sample.take(text, kind(hint)))
}

fn kind(hint: FileHint<'_>) -> Kind {
    if extension(hint.path) == Extension::Table { Kind::Table } else { Kind::Other }
}

fn detect_tallied(hint: FileHint<'_>, text: &str, tally: &Tally) -> Detected {
    match (detect_form(hint, text, tally), hint.dialect) {
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
    sample::tally(text, Kind::Other).pl7_text(Extension::Other)
}

/// Whose operands ladder and charts have, by most of the lines that say so; `None` if none does.
pub(super) fn operands_of(text: &str) -> Option<Family> {
    let mut tally = Tally::default();
    for line in Lines::new(text, Comments::Pl7) {
        tally.add_operands(line.code, Signs::of(line.code), has_pl7_object(line.code));
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

/// The symbols of a STEP 5 program `PLANTA` lie in `PLANTAZ0.SEQ`.
fn is_step5_table(path: &Path) -> bool {
    let name = path.file_stem().and_then(|it| it.to_str()).unwrap_or_default();
    name.get(name.len().saturating_sub(2)..).is_some_and(|it| it.eq_ignore_ascii_case("Z0"))
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

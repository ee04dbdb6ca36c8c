//! Addresses of STEP 7 operands (S7:113-146, S7:475-628, S7:1036-1063).
//!
//! The source manual shows the operands by example; letters, the English set and the status bits come from the vendor's
//! general documentation. What only some CPU lacks is the business of [`crate::target`].

use smol_str::{SmolStr, SmolStrBuilder, StrExt, ToSmolStr};

use super::address::upper_case;
use super::{AddressError, AddressErrorKind, Area, Class, Footprint, Object, Rights, Type};
use crate::model::entity::{BlockKind, BlockName};
use crate::syntax::Mnemonics;

/// No S7-300 or S7-400 has a byte, timer, counter or block of a higher number: 16 bits hold it (the vendor's general
/// documentation; S7:66, 477 and 591 leave the CPU's own limits open).
const LAST_NUMBER: u32 = 65_535;

/// Reads an operand, blanks between its parts or not, in either case: `E 1.0`, `MW0`, `DB5.DBX 2.1`, `"Data".DBW0`, `T 5`,
/// `M [AR1,P#0.0]`, `==0`. Sources that TIA Portal exports have a percent sign before it. Symbols and `#names` are not
/// operands of this kind.
///
/// # Errors
/// [`AddressErrorKind::Malformed`] with the nearest valid form where there is one, which for an operand of the other
/// mnemonic set is its translation; [`AddressErrorKind::OutOfRange`] for a number that no CPU has.
pub fn parse(operand: &str, mnemonics: Mnemonics) -> Result<Object, AddressError> {
    let operand = operand.trim();
    let written = compact(operand);
    let compact = written.strip_prefix('%').unwrap_or(&written);
    let found = read(compact, mnemonics);
    found.map(|place| place.object(written.clone())).map_err(|mut error| {
        if error.kind == AddressErrorKind::Malformed {
            error.suggestion = nearest(compact, operand.contains([' ', '\t', '\u{a0}']), mnemonics);
        }
        error
    })
}

/// Reads an address of a symbol table, in whichever mnemonic set it is: no address means two things in the two.
///
/// # Errors
/// Those of [`parse`] in the German set, which is that of the source manual.
pub fn parse_either(operand: &str) -> Result<Object, AddressError> {
    let german = parse(operand, Mnemonics::German);
    german.or_else(|error| parse(operand, Mnemonics::English).map_err(|_| error))
}

/// A symbol, or a field of a block by its symbol, that stands without quotation marks: with them. Sources may leave them out
/// where a symbol has the form of a name. `None` for what has the form of an address, or is one that lacks its number.
pub fn quoted(text: &str, mnemonics: Mnemonics) -> Option<String> {
    /// What the letters of addresses and constants begin with, in either mnemonic set, and in STEP 5.
    const ADDRESSED: &[u8] = b"EAIQMLTZCPDFSOUK";
    let end = text.find(['.', '[']).unwrap_or(text.len());
    let (head, rest) = text.split_at(end);
    let is_start = |it: char| it.is_alphabetic() || it == '_';
    let is_word = |it: &str| it.starts_with(is_start) && it.chars().all(|it| it.is_alphanumeric() || it == '_');
    let fields = rest.split(['.', '[']).skip(1).zip(rest.chars().filter(|it| matches!(it, '.' | '[')));
    let is_field = |(it, by): (&str, char)| match by {
        '.' => is_word(it),
        _ => it.ends_with(']') && it.bytes().all(|it| it.is_ascii_digit() || matches!(it, b',' | b'-' | b']')),
    };
    if !is_word(head) || !fields.into_iter().all(is_field) {
        return None;
    }
    let letters = head.bytes().take_while(u8::is_ascii_alphabetic).count();
    let digits = head.as_bytes().get(letters..).unwrap_or_default();
    let is_address = rest.is_empty()
        && letters <= 4
        && !digits.is_empty()
        && digits.iter().all(u8::is_ascii_digit)
        && head.bytes().next().is_some_and(|it| ADDRESSED.contains(&it.to_ascii_uppercase()));
    let lacks_number = || ["0", "0.0"].iter().any(|it| parse(&format!("{text}{it}"), mnemonics).is_ok());
    (!is_address && !lacks_number()).then(|| format!("\"{head}\"{rest}"))
}

/// How an operand of the other mnemonic set is written in this one; `None` when it is written the same.
pub fn translated(operand: &str, mnemonics: Mnemonics) -> Option<String> {
    let end = operand.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(operand.len());
    let (letters, rest) = operand.split_at_checked(end)?;
    Some(format!("{}{rest}", translate(&letters.to_ascii_uppercase(), mnemonics)?))
}

/// The operand without the blanks that stand outside quotes.
fn compact(operand: &str) -> SmolStr {
    let mut text = SmolStrBuilder::new();
    let (mut is_plain, mut has_blanks) = (true, false);
    for byte in operand.bytes() {
        let is_blank = matches!(byte, b'\t' | b' ');
        has_blanks |= is_blank;
        is_plain &= is_blank || matches!(byte, b'!' | b'#'..=b'~');
    }
    if is_plain && !has_blanks {
        return operand.into();
    }
    if is_plain {
        operand.split([' ', '\t']).for_each(|it| text.push_str(it));
        return text.finish();
    }
    let mut quoted = false;
    for char in operand.chars() {
        match char {
            '"' => quoted = !quoted,
            '«' => quoted = true,
            '»' => quoted = false,
            _ => {}
        }
        if quoted || !char.is_whitespace() {
            text.push(char);
        }
    }
    text.finish()
}

struct Place {
    class: Class,
    ty: Type,
    area: Area,
    start: u32,
}

impl Place {
    fn object(self, text: SmolStr) -> Object {
        // The source writes these, and says of no operand that a program may not write it.
        let rights = match self.class {
            Class::Output | Class::Memory | Class::Data | Class::Timer | Class::Counter => Rights::ReadWrite,
            Class::LocalData | Class::InstanceData | Class::PeripheralOutput => Rights::ReadWrite,
            _ => Rights::Unknown,
        };
        Object {
            text,
            class: self.class,
            ty: self.ty,
            footprint: Footprint::new(self.area, self.start, self.ty.bits().unwrap_or(1)),
            rights,
            extracted: false,
            indexed: false,
        }
    }
}

/// Letters of an area in each set, `None` for the letters that both share.
struct Letters {
    german: &'static str,
    english: &'static str,
    class: Class,
    area: Area,
    /// Whether single bits can be addressed by the bare letters (`M 0.0`) or by those and `X` (`DBX 0.0`).
    bits: Bits,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Bits {
    Bare,
    X,
    None,
}

const AREAS: &[Letters] = &[
    Letters { german: "E", english: "I", class: Class::Input, area: Area::Inputs, bits: Bits::Bare },
    Letters { german: "A", english: "Q", class: Class::Output, area: Area::Outputs, bits: Bits::Bare },
    Letters { german: "M", english: "M", class: Class::Memory, area: Area::Words, bits: Bits::Bare },
    Letters { german: "L", english: "L", class: Class::LocalData, area: Area::Local, bits: Bits::Bare },
    Letters {
        german: "PE",
        english: "PI",
        class: Class::PeripheralInput,
        area: Area::PeripheralInputs,
        bits: Bits::None,
    },
    Letters {
        german: "PA",
        english: "PQ",
        class: Class::PeripheralOutput,
        area: Area::PeripheralOutputs,
        bits: Bits::None,
    },
    Letters { german: "DB", english: "DB", class: Class::Data, area: Area::OpenData, bits: Bits::X },
    Letters { german: "DI", english: "DI", class: Class::InstanceData, area: Area::OpenInstance, bits: Bits::X },
];

const BLOCKS: &[(&str, BlockKind)] = &[
    ("DB", BlockKind::Db),
    // The instance register opens a data block like any other: `AUF DI 5`.
    ("DI", BlockKind::Db),
    ("FB", BlockKind::Fb),
    ("FC", BlockKind::Fc),
    ("SFB", BlockKind::Sfb),
    ("SFC", BlockKind::Sfc),
    ("OB", BlockKind::Ob),
    ("UDT", BlockKind::Udt),
];

/// Bits of the status word that a program can test, words that it can load.
const STATUS_BITS: &[&str] = &["OV", "OS", "UO", "==0", "<>0", ">0", "<0", ">=0", "<=0"];
const STATUS_WORDS: &[&str] = &["STW", "DBLG", "DBNO", "DILG", "DINO"];
const STATUS_BR: (&str, &str) = ("BIE", "BR");

fn letters_in(german: &'static str, english: &'static str, mnemonics: Mnemonics) -> &'static str {
    match mnemonics {
        Mnemonics::German => german,
        Mnemonics::English => english,
    }
}

fn malformed(message: impl Into<String>) -> AddressError {
    AddressError { kind: AddressErrorKind::Malformed, message: message.into(), suggestion: None }
}

/// A run of digits at the start of `text`, what follows it, and its value, `u32::MAX` when it does not fit.
fn number(text: &str) -> Option<(u32, &str)> {
    let end = text.bytes().position(|it| !it.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    let value = digits.bytes().fold(0u32, |sum, it| sum.saturating_mul(10).saturating_add(u32::from(it - b'0')));
    (!digits.is_empty()).then_some((value, rest))
}

fn within(what: &str, value: u32) -> Result<u32, AddressError> {
    if value <= LAST_NUMBER {
        return Ok(value);
    }
    Err(AddressError {
        kind: AddressErrorKind::OutOfRange,
        message: format!("no S7-300 or S7-400 has this {what}: numbers go to {LAST_NUMBER} (vendor's documentation)"),
        suggestion: None,
    })
}

fn read(compact: &str, mnemonics: Mnemonics) -> Result<Place, AddressError> {
    if let Some((name, item)) = quoted_block(compact) {
        return data_item(BlockName::Symbol(name), item, compact);
    }
    let upper = upper_case(compact);
    if let Some(place) = indirect(&upper, mnemonics) {
        return Ok(place);
    }
    let letters_end = upper.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(letters_end);
    // The status has letters alone, or none.
    if (letters.is_empty() || rest.is_empty())
        && let Some(place) = status(&upper, mnemonics)
    {
        return Ok(place);
    }
    let initial = letters.as_bytes().first();
    if let Some((_, kind)) = BLOCKS.iter().find(|(name, _)| name.as_bytes().first() == initial && *name == letters) {
        return block(*kind, letters, rest, compact);
    }
    let counter = letters_in("Z", "C", mnemonics);
    if letters == "T" || letters == counter {
        let (class, area, what) = match letters {
            "T" => (Class::Timer, Area::Timers, "timer"),
            _ => (Class::Counter, Area::Counters, "counter"),
        };
        let Some((value, "")) = number(rest) else {
            return Err(malformed(format!("a {what} is written `{letters}` and its number (S7:494, 599)")));
        };
        return Ok(Place { class, ty: Type::Block, area, start: within(what, value)? });
    }
    for it in AREAS {
        let prefix = letters_in(it.german, it.english, mnemonics);
        if prefix.as_bytes().first() == initial
            && let Some(format) = letters.strip_prefix(prefix)
            && let Some(ty) = format_type(format, it.bits)
        {
            let start = byte_and_bit(ty, rest, letters)?;
            return Ok(Place { class: it.class, ty, area: it.area.clone(), start });
        }
    }
    if let Some(own) = translate(letters, mnemonics) {
        return Err(malformed(format!("`{letters}` is of the other mnemonic set: here it is `{own}`")));
    }
    Err(malformed("no operand has these letters (S7:113-146)"))
}

fn format_type(format: &str, bits: Bits) -> Option<Type> {
    match (format, bits) {
        ("", Bits::Bare) | ("X", Bits::X) => Some(Type::Bool),
        ("B", _) => Some(Type::Byte),
        ("W", _) => Some(Type::Word),
        ("D", _) => Some(Type::Double),
        _ => None,
    }
}

/// Reads `5`, or `5.3` for a bit, up to its end; gives the first bit.
fn byte_and_bit(ty: Type, text: &str, letters: &str) -> Result<u32, AddressError> {
    let Some((byte, rest)) = number(text) else {
        return Err(malformed(format!("the number after `{letters}` is missing")));
    };
    let bit = if ty == Type::Bool {
        let Some(digits) = rest.strip_prefix('.') else {
            return Err(malformed(format!("a bit is written `{letters}`, its byte, `.` and its number (S7:117)")));
        };
        let Some((bit, "")) = number(digits) else {
            return Err(malformed(format!("a bit is written `{letters}`, its byte, `.` and its number (S7:117)")));
        };
        if bit > 7 {
            return Err(AddressError {
                kind: AddressErrorKind::OutOfRange,
                message: "a byte has the bits 0 to 7 only (S7:117)".to_owned(),
                suggestion: None,
            });
        }
        bit
    } else if rest.starts_with('.') {
        return Err(malformed(format!(
            "`{letters}` names a whole byte, word or double word, which has no bit (S7:115)"
        )));
    } else if rest.is_empty() {
        0
    } else {
        return Err(malformed("the end of the operand is not part of its form"));
    };
    // The last byte of the operand must exist too.
    let bytes = ty.bits().unwrap_or(1).div_ceil(8);
    within("byte", byte.saturating_add(bytes - 1))?;
    Ok(byte * 8 + bit)
}

/// `DB 5`, `FC 1`, `DB5.DBW0`, `DB1.depart` (S7:1325).
fn block(kind: BlockKind, letters: &str, rest: &str, compact: &str) -> Result<Place, AddressError> {
    let Some((value, tail)) = number(rest) else {
        return Err(malformed(format!("the number of the block after `{letters}` is missing")));
    };
    let name = BlockName::Number(kind, within("block", value)?);
    match tail.strip_prefix('.') {
        // The tail is ASCII up to here, so it has the same length in the operand as written.
        Some(item) if letters == "DB" => {
            let item = compact.get(compact.len() - item.len()..).unwrap_or_default();
            data_item(name, item, compact)
        }
        None if tail.is_empty() => {
            Ok(Place { class: Class::CodeBlock, ty: Type::Block, area: Area::CodeBlock(name), start: 0 })
        }
        _ => Err(malformed("the end of the operand is not part of its form")),
    }
}

/// What stands after `DB5.` or `"Data".`: `DBW0`, or the name of a field, whose place only the block's declaration tells.
fn data_item(name: BlockName, item: &str, compact: &str) -> Result<Place, AddressError> {
    let upper = upper_case(item);
    let digits = upper.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(digits);
    let ty = letters.strip_prefix("DB").and_then(|format| format_type(format, Bits::X));
    if let Some(ty) = ty.filter(|_| rest.is_empty() || rest.starts_with(|it: char| it.is_ascii_digit())) {
        let start = byte_and_bit(ty, rest, letters)?;
        return Ok(Place { class: Class::Data, ty, area: Area::Data(name), start });
    }
    if ty.is_some() && rest.starts_with('[') {
        return indirect(&upper, Mnemonics::German).ok_or_else(|| malformed("the pointer in brackets is not closed"));
    }
    let is_name = item.starts_with(|it: char| it.is_alphabetic() || matches!(it, '_' | '"' | '#'))
        && !matches!(letters, "DIX" | "DIB" | "DIW" | "DID" if rest.starts_with(|it: char| it.is_ascii_digit()));
    if !is_name {
        return Err(malformed("what follows the data block is `DBX`, `DBB`, `DBW`, `DBD` or a field (S7:1057, 1325)"));
    }
    let area = Area::Symbol(compact.to_lowercase_smolstr());
    Ok(Place { class: Class::Data, ty: Type::Unknown, area, start: 0 })
}

/// Whether an operand names data by an address: `DB1.DBW 2`, `DBX 0.0`, `DIW 4`.
pub fn is_data_address(text: &str) -> bool {
    let item = text.rsplit_once("DB").or_else(|| text.rsplit_once("db")).or_else(|| text.split_once("DI"));
    let item = item.or_else(|| text.split_once("di")).map_or("", |it| it.1);
    let number = item.strip_prefix(['X', 'B', 'W', 'D', 'x', 'b', 'w', 'd']).unwrap_or_default().trim_start();
    !number.is_empty() && number.bytes().all(|it| it.is_ascii_digit() || it == b'.')
}

/// The data block and the field of an object that is named by both, so that the declaration alone tells its place:
/// `DB1.poids`, `"Data".speed[3]`. The path is in lower case.
pub fn field(object: &Object) -> Option<(BlockName, SmolStr)> {
    let Area::Symbol(name) = &object.footprint.area else { return None };
    if object.class != Class::Data {
        return None;
    }
    if let Some((block, path)) = quoted_block(name) {
        return Some((BlockName::Symbol(block), path.into()));
    }
    let (block, path) = name.split_once('.')?;
    let number = block.strip_prefix("db")?.parse().ok()?;
    Some((BlockName::Number(BlockKind::Db, number), path.into()))
}

/// The name of a variable of a block, in lower case, wherever it lies: `#speed`, `="ON"`.
pub fn local_name(object: &Object) -> Option<String> {
    match &object.footprint.area {
        Area::LocalName(name) => Some(name.to_string()),
        _ if object.class == Class::LocalName || object.text.starts_with('#') => {
            Some(object.text.trim_start_matches('#').replace('"', "").to_lowercase())
        }
        _ => None,
    }
}

/// The area of such a field, until its place is known.
pub fn field_area(block: &BlockName, path: &str) -> Area {
    Area::Symbol(format!("{block}.{path}").to_lowercase_smolstr())
}

/// `"Data".DBW0`, `« Data ».DBW0`: the symbol in lower case and what follows the point.
fn quoted_block(compact: &str) -> Option<(SmolStr, &str)> {
    let (inside, close) = match compact.strip_prefix('"') {
        Some(inside) => (inside, '"'),
        None => (compact.strip_prefix('«')?, '»'),
    };
    let (name, rest) = inside.split_once(close)?;
    let name = name.trim_matches([' ', '\u{a0}']);
    let item = rest.strip_prefix('.')?;
    (!name.is_empty()).then(|| (name.to_lowercase_smolstr(), item))
}

/// `M [AR1,P#0.0]`, `DBW [MD 10]`, `[AR2,P#4.0]`, `W [AR1,P#2.0]`, `T [MW 4]`: an operand whose place is computed.
fn indirect(upper: &str, mnemonics: Mnemonics) -> Option<Place> {
    let (letters, pointer) = upper.strip_suffix(']')?.split_once('[')?;
    if pointer.is_empty() || pointer.contains(['[', ']']) {
        return None;
    }
    let counter = letters_in("Z", "C", mnemonics);
    // Through an address register alone, the pointer carries the area: `[AR1,P#0.0]`, `W [AR1,P#0.0]`.
    let by_register = pointer.starts_with("AR");
    let ty = match letters {
        "" if by_register => Type::Bool,
        "B" if by_register => Type::Byte,
        "W" if by_register => Type::Word,
        "D" if by_register => Type::Double,
        "T" => Type::Block,
        _ if letters == counter || BLOCKS.iter().any(|(name, _)| *name == letters) => Type::Block,
        _ => AREAS.iter().find_map(|it| {
            let format = letters.strip_prefix(letters_in(it.german, it.english, mnemonics))?;
            format_type(format, it.bits)
        })?,
    };
    Some(Place { class: Class::Indirect, ty, area: Area::Indirect, start: 0 })
}

fn status(upper: &str, mnemonics: Mnemonics) -> Option<Place> {
    let is_br = upper == letters_in(STATUS_BR.0, STATUS_BR.1, mnemonics);
    let ty = match upper {
        _ if is_br || STATUS_BITS.contains(&upper) => Type::Bool,
        _ if STATUS_WORDS.contains(&upper) => Type::Word,
        _ => return None,
    };
    // One bit has one name in footprints, whatever the set.
    let name = if is_br { STATUS_BR.1 } else { upper };
    Some(Place { class: Class::Status, ty, area: Area::Status(name.to_smolstr()), start: 0 })
}

/// The nearest valid operand of one that is malformed, with a blank after the letters if it was written so.
fn nearest(compact: &str, spaced: bool, mnemonics: Mnemonics) -> Option<String> {
    // A suggestion for an operand longer than any valid one helps nobody.
    if compact.len() > 40 || !compact.is_ascii() {
        return None;
    }
    let upper = compact.to_ascii_uppercase();
    let letters_end = upper.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(letters_end);
    let mut slips = vec![upper.clone(), upper.replace(',', "."), upper.trim_end_matches(['.', ',', ';']).to_owned()];
    let translated = translate(letters, mnemonics);
    if let Some(translated) = &translated {
        slips.push(format!("{translated}{rest}"));
        slips.push(format!("{translated}{rest}").replace(',', "."));
    }
    let letters = translated.as_deref().unwrap_or(letters);
    // A bit of a data block without its `X`.
    if letters == "DB" || letters == "DI" {
        slips.push(format!("{letters}X{rest}"));
    }
    // `M 5` has no bit, `MW 4.0` has one too many, `PE 4.0` needs a width.
    slips.push(format!("{letters}{rest}.0"));
    let is_number = |text: &str| text.bytes().all(|it| it.is_ascii_digit());
    let byte = rest.split_once('.').filter(|(_, bit)| is_number(bit)).map_or(rest, |(byte, _)| byte);
    slips.push(format!("{letters}{byte}"));
    if letters.starts_with('P') {
        slips.push(format!("{letters}B{byte}"));
    }
    if let Some(bare) = letters.strip_suffix('X') {
        slips.push(format!("{bare}{rest}"));
    }
    let found = slips.into_iter().find(|it| *it != upper && read(it, mnemonics).is_ok())?;
    let letters_end = found.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(found.len());
    let (letters, rest) = found.split_at(letters_end);
    Some(if spaced && !rest.is_empty() { format!("{letters} {rest}") } else { found })
}

/// The letters of an operand of the other mnemonic set in this one.
fn translate(letters: &str, mnemonics: Mnemonics) -> Option<String> {
    let pairs = [("E", "I"), ("A", "Q"), ("PE", "PI"), ("PA", "PQ")];
    let from_to = |german: &'static str, english: &'static str| match mnemonics {
        Mnemonics::German => (english, german),
        Mnemonics::English => (german, english),
    };
    let (from, to) = from_to(STATUS_BR.0, STATUS_BR.1);
    if letters == from {
        return Some(to.to_owned());
    }
    let (from, to) = from_to("Z", "C");
    if letters == from {
        return Some(to.to_owned());
    }
    pairs.iter().find_map(|(german, english)| {
        let (from, to) = from_to(german, english);
        let format = letters.strip_prefix(from)?;
        matches!(format, "" | "B" | "W" | "D" | "X").then(|| format!("{to}{format}"))
    })
}

#[cfg(test)]
mod tests {
    use Mnemonics::{English, German};
    use proptest::prelude::*;

    use super::*;

    fn object(operand: &str, mnemonics: Mnemonics) -> Object {
        parse(operand, mnemonics).unwrap_or_else(|error| panic!("{operand}: {error:?}"))
    }

    fn db(number: u32) -> BlockName {
        BlockName::Number(BlockKind::Db, number)
    }

    #[test]
    fn sources_of_tia_portal() {
        let cases = [("%I0.1", "I0.1"), ("%DB3.DBB4", "DB3.DBB4"), ("%L 1.0", "L1.0"), ("%QW 4", "QW4"), ("%T5", "T5")];
        for (percent, plain) in cases {
            assert_eq!(object(percent, English).footprint, object(plain, English).footprint, "{percent}");
        }
        assert!(parse("%%I0.1", English).is_err());
        assert!(parse("%", English).is_err());
    }

    #[test]
    fn process_images_memory_and_data() {
        let open = || Area::OpenData;
        let cases: &[(&str, &str, Class, Type, Area, u32)] = &[
            ("E1.0", "I1.0", Class::Input, Type::Bool, Area::Inputs, 8),
            ("E 0.7", "I 0.7", Class::Input, Type::Bool, Area::Inputs, 7),
            ("eb0", "ib0", Class::Input, Type::Byte, Area::Inputs, 0),
            ("EW0", "IW0", Class::Input, Type::Word, Area::Inputs, 0),
            ("ED 4", "ID 4", Class::Input, Type::Double, Area::Inputs, 32),
            ("A4.0", "Q4.0", Class::Output, Type::Bool, Area::Outputs, 32),
            ("AB5", "QB5", Class::Output, Type::Byte, Area::Outputs, 40),
            ("AW4", "QW4", Class::Output, Type::Word, Area::Outputs, 32),
            ("AD 4", "QD 4", Class::Output, Type::Double, Area::Outputs, 32),
            ("M0.0", "M0.0", Class::Memory, Type::Bool, Area::Words, 0),
            ("M10.1", "M 10.1", Class::Memory, Type::Bool, Area::Words, 81),
            ("MB22", "mb 22", Class::Memory, Type::Byte, Area::Words, 176),
            ("MW1", "MW 1", Class::Memory, Type::Word, Area::Words, 8),
            ("MD30", "MD30", Class::Memory, Type::Double, Area::Words, 240),
            ("L 0.0", "L0.0", Class::LocalData, Type::Bool, Area::Local, 0),
            ("LW 4", "LW4", Class::LocalData, Type::Word, Area::Local, 32),
            ("PEW 256", "PIW 256", Class::PeripheralInput, Type::Word, Area::PeripheralInputs, 2048),
            ("PAB 3", "PQB 3", Class::PeripheralOutput, Type::Byte, Area::PeripheralOutputs, 24),
            ("DBX 2.3", "DBX2.3", Class::Data, Type::Bool, open(), 19),
            ("DBB 2", "DBB2", Class::Data, Type::Byte, open(), 16),
            ("DBW 2", "DBW2", Class::Data, Type::Word, open(), 16),
            ("DBD 2", "DBD2", Class::Data, Type::Double, open(), 16),
            ("DIX 0.0", "DIX0.0", Class::InstanceData, Type::Bool, Area::OpenInstance, 0),
            ("DIW 2", "DIW2", Class::InstanceData, Type::Word, Area::OpenInstance, 16),
            ("DB5.DBW0", "DB 5.DBW 0", Class::Data, Type::Word, Area::Data(db(5)), 0),
            ("DB1.DBB1", "db1.dbb1", Class::Data, Type::Byte, Area::Data(db(1)), 8),
            ("DB2.DBX10.7", "DB2.DBX 10.7", Class::Data, Type::Bool, Area::Data(db(2)), 87),
            ("T1", "T 1", Class::Timer, Type::Block, Area::Timers, 1),
            ("Z1", "C 1", Class::Counter, Type::Block, Area::Counters, 1),
        ];
        for (german, english, class, ty, area, start) in cases {
            for (operand, mnemonics) in [(german, German), (english, English)] {
                let object = object(operand, mnemonics);
                let found = (object.class, object.ty, &object.footprint.area, object.footprint.start);
                assert_eq!(found, (*class, *ty, area, *start), "{operand}");
                assert_eq!(object.footprint.bits, ty.bits().unwrap_or(1), "{operand}");
                assert_eq!(object.text, operand.replace(' ', ""));
                assert!(object.is_fixed());
            }
        }
    }

    #[test]
    fn symbols_without_quotes() {
        for (text, expected) in [
            ("GCS7_GrCtrlDB.Section[1].DBNr", Some("\"GCS7_GrCtrlDB\".Section[1].DBNr")),
            ("A408Z1O1.StStopped", Some("\"A408Z1O1\".StStopped")),
            ("Data[1,-2].x", Some("\"Data\"[1,-2].x")),
            ("Antrieb_links", Some("\"Antrieb_links\"")),
            ("V12", Some("\"V12\"")),
            ("MAL1.Para.x", Some("\"MAL1\".Para.x")),
            ("Störung", Some("\"Störung\"")),
            // Slips in addresses.
            ("MX12", None),
            ("EX0.0", None),
            ("V12.0", None),
            ("MW", None),
            ("DB", None),
            ("M_1.0", None),
            ("Data[i].x", None),
            ("Data.", None),
            ("", None),
            ("[1]", None),
        ] {
            assert_eq!(quoted(text, Mnemonics::German).as_deref(), expected, "{text}");
        }
    }

    #[test]
    fn rights() {
        for operand in ["M0.0", "A4.0", "DB5.DBW0", "DIW0", "LW2", "T1", "Z1", "PAW 256"] {
            assert_eq!(object(operand, German).rights, Rights::ReadWrite, "{operand}");
        }
        for operand in ["E0.0", "PEW 256", "OV", "STW", "DB5", "M[AR1,P#0.0]"] {
            assert_eq!(object(operand, German).rights, Rights::Unknown, "{operand}");
        }
    }

    #[test]
    fn quoted_data_blocks_and_fields() {
        for operand in ["\"My Data\".DBW4", "\"MY DATA\".dbw 4", "« My Data ».DBW4"] {
            let object = object(operand, German);
            assert_eq!(object.footprint, Footprint::new(Area::Data(BlockName::Symbol("my data".into())), 32, 16));
        }
        let field = object("DB1.depart", German);
        assert_eq!((field.class, field.ty), (Class::Data, Type::Unknown));
        assert_eq!(field.footprint, object("db 1.DEPART", English).footprint);
        assert_eq!(object("DB1.Dbx_2", German).footprint.area, Area::Symbol("db1.dbx_2".into()));
        assert!(!field.footprint.overlaps(&object("DB2.depart", German).footprint));
        assert_eq!(object("\"Data\".niveau[3]", German).class, Class::Data);
    }

    #[test]
    fn blocks() {
        let cases = [
            ("DB 5", BlockKind::Db),
            ("DI 5", BlockKind::Db),
            ("FB5", BlockKind::Fb),
            ("fc 5", BlockKind::Fc),
            ("SFB 5", BlockKind::Sfb),
            ("SFC5", BlockKind::Sfc),
            ("OB 5", BlockKind::Ob),
            ("UDT 5", BlockKind::Udt),
        ];
        for (operand, kind) in cases {
            for mnemonics in [German, English] {
                let object = object(operand, mnemonics);
                assert_eq!((object.class, object.ty), (Class::CodeBlock, Type::Block));
                assert_eq!(object.footprint.area, Area::CodeBlock(BlockName::Number(kind, 5)));
            }
        }
    }

    #[test]
    fn status_bits_and_words() {
        for operand in ["OV", "os", "UO", "==0", "<>0", ">0", "<0", ">=0", "<=0", "= = 0"] {
            assert_eq!((object(operand, German).class, object(operand, German).ty), (Class::Status, Type::Bool));
        }
        for operand in ["STW", "DBLG", "DBNO", "DILG", "DINO"] {
            assert_eq!((object(operand, English).class, object(operand, English).ty), (Class::Status, Type::Word));
        }
        assert_eq!(object("BIE", German).footprint, object("BR", English).footprint);
    }

    #[test]
    fn computed_places() {
        let cases = [
            ("M [AR1,P#0.0]", Type::Bool),
            ("E[AR2,P#1.0]", Type::Bool),
            ("DBW [MD 10]", Type::Word),
            ("[AR1,P#0.0]", Type::Bool),
            ("W [AR1,P#2.0]", Type::Word),
            ("DIX[AR2,P#0.1]", Type::Bool),
            ("T [MW 4]", Type::Block),
            ("DB [LW 20]", Type::Block),
            ("DB5.DBW [MD 10]", Type::Word),
            ("\"Data\".DBX [MD 10]", Type::Bool),
        ];
        for (operand, ty) in cases {
            let object = object(operand, German);
            assert_eq!((object.class, object.ty, object.is_fixed()), (Class::Indirect, ty, false), "{operand}");
        }
        for operand in ["W [MD 4]", "XY[AR1,P#0.0]", "M[]", "M[MD 4", "I [MD 4]", "DB5.DBW[MD 4"] {
            assert_eq!(parse(operand, German).map_err(|it| it.kind), Err(AddressErrorKind::Malformed), "{operand}");
        }
    }

    #[test]
    fn overlaps_of_the_manual() {
        let pairs = [
            ("MW0", "MB0"),
            ("MW0", "MB1"),
            ("MW0", "M1.7"),
            ("MW0", "MW1"),
            ("MB1", "M1.0"),
            ("EW0", "E1.0"),
            ("AW4", "A5.0"),
            ("MD4", "MW6"),
            ("DB1.DBW0", "DB1.DBB1"),
            ("DB5.DBW1", "DB5.DBW2"),
        ];
        for (left, right) in pairs {
            assert!(object(left, German).footprint.overlaps(&object(right, German).footprint), "{left} {right}");
        }
        let apart = [
            ("MW0", "MB2"),
            ("MW0", "M2.0"),
            ("MB1", "M0.7"),
            ("EW0", "AW0"),
            ("EW0", "PEW0"),
            ("MD4", "MW8"),
            ("DB1.DBW0", "DB2.DBW0"),
            ("DBW0", "DIW0"),
            ("T1", "Z1"),
            ("T1", "T2"),
            ("DB1", "FC1"),
            ("OV", "OS"),
        ];
        for (left, right) in apart {
            assert!(!object(left, German).footprint.overlaps(&object(right, German).footprint), "{left} {right}");
        }
    }

    #[test]
    fn malformed_with_the_nearest_form() {
        let cases = [
            ("E 0.0", English, Some("I 0.0")),
            ("A4.0", English, Some("Q4.0")),
            ("EW 4", English, Some("IW 4")),
            ("PEW256", English, Some("PIW256")),
            ("Z 1", English, Some("C 1")),
            ("BIE", English, Some("BR")),
            ("I 0.0", German, Some("E 0.0")),
            ("Q4.0", German, Some("A4.0")),
            ("QW4", German, Some("AW4")),
            ("C 1", German, Some("Z 1")),
            ("BR", German, Some("BIE")),
            ("M 5", German, Some("M 5.0")),
            ("MW 4.0", German, Some("MW 4")),
            ("MB4.7", German, Some("MB4")),
            ("E0,1", German, Some("E0.1")),
            ("I0,1", German, Some("E0.1")),
            ("MX0.1", German, Some("M0.1")),
            ("DB 5.3", German, Some("DBX 5.3")),
            ("DB5.DBW0.1", German, None),
            ("PE 4", German, Some("PEB 4")),
            ("PE 4.0", German, Some("PEB 4")),
            ("MW", German, None),
            ("M", German, None),
            ("", German, None),
            ("T", German, None),
            ("T1.0", German, Some("T1")),
            ("FC", German, None),
            ("FC1.DBW0", German, None),
            ("DB1.", German, Some("DB1")),
            ("DB1.DIW0", German, None),
            ("DB1.4", German, Some("DBX1.4")),
            ("\"Data\".", German, None),
            ("\"Data\"", German, None),
            ("#local", German, None),
            ("Xyz", German, None),
            ("Mé0.0", German, None),
            ("X 1.0", German, None),
        ];
        for (operand, mnemonics, suggestion) in cases {
            let error = parse(operand, mnemonics).expect_err(operand);
            assert_eq!(error.kind, AddressErrorKind::Malformed, "{operand}: {error:?}");
            assert_eq!(error.suggestion.as_deref(), suggestion, "{operand}");
            assert!(!error.message.ends_with('.'), "{operand}");
        }
    }

    #[test]
    fn an_operand_of_the_other_set_is_named_so() {
        for (operand, mnemonics) in [("E 0.0", English), ("I 0.0", German), ("Z 1", English), ("PIW 4", German)] {
            let error = parse(operand, mnemonics).expect_err(operand);
            assert!(error.message.contains("other mnemonic set"), "{}", error.message);
        }
        let error = parse("XY 1", German).expect_err("XY 1");
        assert!(!error.message.contains("other mnemonic set"), "{}", error.message);
    }

    #[test]
    fn out_of_range() {
        for operand in [
            "M0.8",
            "M5.9",
            "M65536.0",
            "MW65535",
            "MD 65533",
            "T 65536",
            "Z99999999999",
            "DB 65536",
            "DB65536.DBW0",
            "DBW65535",
        ] {
            let error = parse(operand, German).expect_err(operand);
            assert_eq!((error.kind, error.suggestion), (AddressErrorKind::OutOfRange, None), "{operand}");
        }
        for operand in ["M65535.7", "MW65534", "MD 65532", "MB65535", "T 65535", "DB 65535", "DBW65534"] {
            object(operand, German);
        }
    }

    proptest! {
        #[test]
        fn any_text_is_an_object_or_an_error(text in r"\PC{0,20}", english: bool) {
            holds(&text, if english { English } else { German })?;
        }

        #[test]
        fn any_likely_operand_is_an_object_or_an_error(
            text in r#"["«]?[EAIQMLPTZCDBWXFOS]{0,4} ?[0-9]{0,6}[.,»"\[]?[DBWX]{0,3}[0-9.\]#]{0,6}"#,
            english: bool,
        ) {
            holds(&text, if english { English } else { German })?;
        }
    }

    fn holds(text: &str, mnemonics: Mnemonics) -> Result<(), TestCaseError> {
        match parse(text, mnemonics) {
            Ok(object) => {
                prop_assert!(object.footprint.bits > 0 && object.footprint.end() > object.footprint.start);
                prop_assert_eq!(parse(&object.text, mnemonics), Ok(object));
            }
            Err(error) => {
                prop_assert!(!error.message.is_empty());
                if let Some(suggestion) = error.suggestion {
                    prop_assert!(parse(&suggestion, mnemonics).is_ok(), "{} -> {}", text, suggestion);
                }
            }
        }
        Ok(())
    }
}

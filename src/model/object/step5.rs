//! Addresses of STEP 5 operands. The source document shows `E`, `M`, `T`, `Z` and the blocks (GRF:80-90, 815-900, 1159);
//! the other letters, the English set and the ranges come from the vendor's general documentation.

use smol_str::SmolStr;

use super::{AddressError, AddressErrorKind, Area, Class, Footprint, Object, Rights, Type};
use crate::syntax::Mnemonics;

const VENDOR: &str = "(vendor's documentation)";

/// The last byte of a process image, of flags and of S flags; the last word of a data block that can be addressed; the
/// last timer and counter. What one CPU lacks of them is the business of [`crate::target`].
const LAST_IO_BYTE: u32 = 127;
const LAST_BYTE: u32 = 255;
const LAST_S_BYTE: u32 = 4095;

/// Letters of an area.
struct Letters {
    german: &'static str,
    english: &'static str,
    class: Class,
    area: Area,
    ty: Type,
    /// Bits from one number to the next: numbers count bytes, or words of a data block.
    unit: u32,
    last: u32,
}

const fn bytes(german: &'static str, english: &'static str, class: Class, area: Area, ty: Type, last: u32) -> Letters {
    Letters { german, english, class, area, ty, unit: 8, last }
}

const fn words(letters: &'static str, class: Class, area: Area, ty: Type) -> Letters {
    Letters { german: letters, english: letters, class, area, ty, unit: 16, last: LAST_BYTE }
}

const AREAS: &[Letters] = {
    use Class::{Data, Input, LocalData, Memory, Output, PeripheralInput, System};
    use Type::{Bool, Byte, Double, Word};
    &[
        bytes("E", "I", Input, Area::Inputs, Bool, LAST_IO_BYTE),
        bytes("EB", "IB", Input, Area::Inputs, Byte, LAST_IO_BYTE),
        bytes("EW", "IW", Input, Area::Inputs, Word, LAST_IO_BYTE),
        bytes("ED", "ID", Input, Area::Inputs, Double, LAST_IO_BYTE),
        bytes("A", "Q", Output, Area::Outputs, Bool, LAST_IO_BYTE),
        bytes("AB", "QB", Output, Area::Outputs, Byte, LAST_IO_BYTE),
        bytes("AW", "QW", Output, Area::Outputs, Word, LAST_IO_BYTE),
        bytes("AD", "QD", Output, Area::Outputs, Double, LAST_IO_BYTE),
        bytes("M", "F", Memory, Area::Words, Bool, LAST_BYTE),
        bytes("MB", "FY", Memory, Area::Words, Byte, LAST_BYTE),
        bytes("MW", "FW", Memory, Area::Words, Word, LAST_BYTE),
        bytes("MD", "FD", Memory, Area::Words, Double, LAST_BYTE),
        bytes("S", "S", LocalData, Area::Local, Bool, LAST_S_BYTE),
        bytes("SY", "SY", LocalData, Area::Local, Byte, LAST_S_BYTE),
        bytes("SW", "SW", LocalData, Area::Local, Word, LAST_S_BYTE),
        bytes("SD", "SD", LocalData, Area::Local, Double, LAST_S_BYTE),
        bytes("PB", "PB", PeripheralInput, Area::PeripheralInputs, Byte, LAST_BYTE),
        bytes("PY", "PY", PeripheralInput, Area::PeripheralInputs, Byte, LAST_BYTE),
        bytes("PW", "PW", PeripheralInput, Area::PeripheralInputs, Word, LAST_BYTE),
        words("D", Data, Area::OpenData, Bool),
        words("DL", Data, Area::OpenData, Byte),
        words("DR", Data, Area::OpenData, Byte),
        words("DW", Data, Area::OpenData, Word),
        words("DD", Data, Area::OpenData, Double),
        words("RS", System, Area::SystemWords, Word),
        words("BS", System, Area::SystemWords, Word),
    ]
};

fn malformed(message: String) -> AddressError {
    AddressError { kind: AddressErrorKind::Malformed, message, suggestion: None }
}

fn out_of_range(message: String) -> AddressError {
    AddressError { kind: AddressErrorKind::OutOfRange, message, suggestion: None }
}

/// Reads an operand, blanks between its parts or not, in either case: `E 1.0`, `MW0`, `D 2.15`, `DL 3`, `T 5`, `Z1`.
///
/// In a data block numbers count words. Their bits are 0 to 15; as everywhere the more significant byte comes first,
/// so that `D 2.15` is in `DL 2`, and `D 2.0` in `DR 2`.
///
/// # Errors
/// [`AddressErrorKind::Malformed`], with the nearest valid form where there is one; [`AddressErrorKind::OutOfRange`] for a
/// number that no controller has.
pub fn parse(operand: &str, mnemonics: Mnemonics) -> Result<Object, AddressError> {
    let compact: String = operand.chars().filter(|it| !it.is_whitespace()).collect();
    let (class, ty, footprint) = read(&compact, mnemonics).map_err(|mut error| {
        if error.kind == AddressErrorKind::Malformed {
            error.suggestion = nearest(&compact, operand.trim().contains([' ', '\t']), mnemonics);
        }
        error
    })?;
    let rights = match class {
        Class::Output | Class::Memory | Class::Data | Class::Timer | Class::Counter | Class::LocalData => {
            Rights::ReadWrite
        }
        _ => Rights::Unknown,
    };
    Ok(Object { text: SmolStr::new(&compact), class, ty, footprint, rights, extracted: false, indexed: false })
}

/// As [`parse`], of a text that does not say its mnemonic set: no operand names one place in one set and another in the
/// other.
///
/// # Errors
/// Those of [`parse`] in the German set.
pub fn parse_any(operand: &str) -> Result<Object, AddressError> {
    parse(operand, Mnemonics::German).or_else(|error| parse(operand, Mnemonics::English).map_err(|_| error))
}

fn read(compact: &str, mnemonics: Mnemonics) -> Result<(Class, Type, Footprint), AddressError> {
    let end = compact.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(compact.len());
    let (letters, rest) = compact.split_at(end);
    let letters = letters.to_ascii_uppercase();
    let number = |text: &str| {
        let digits = !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit());
        digits.then(|| text.parse::<u32>().unwrap_or(u32::MAX))
    };
    let counter = if mnemonics == Mnemonics::German { "Z" } else { "C" };
    if letters == "T" || letters == counter {
        let (class, area, what) = match letters.as_str() {
            "T" => (Class::Timer, Area::Timers, "timer"),
            _ => (Class::Counter, Area::Counters, "counter"),
        };
        let (value, bit) = match rest.split_once('.') {
            // Single bits of a timer's word, as `P T 1.15` tests them.
            Some((value, bit)) => (number(value), number(bit).is_some_and(|it| it <= 15)),
            None => (number(rest), true),
        };
        let Some(value) = value.filter(|_| bit) else {
            return Err(malformed(format!("a {what} is written `{letters}` and its number")));
        };
        if value > LAST_BYTE {
            return Err(out_of_range(format!("no S5 controller has this {what}: numbers go to {LAST_BYTE} {VENDOR}")));
        }
        return Ok((class, Type::Block, Footprint::new(area, value, 1)));
    }
    let of_set = |it: &&Letters| letters == if mnemonics == Mnemonics::German { it.german } else { it.english };
    let Some(area) = AREAS.iter().find(of_set) else {
        return Err(match translate(&letters, mnemonics) {
            Some(own) => malformed(format!("`{letters}` is of the other mnemonic set: here it is `{own}`")),
            None => malformed(format!("no operand of STEP 5 has these letters {VENDOR}")),
        });
    };
    let (value, bit) = match (area.ty, rest.split_once('.')) {
        (Type::Bool, Some((value, bit))) => (number(value), number(bit)),
        (Type::Bool, None) => {
            let message = format!("a bit is written `{letters}`, its number, `.` and the bit's number (GRF:89)");
            return Err(malformed(message));
        }
        (_, Some(_)) => return Err(malformed(format!("`{letters}` names a whole byte or word, which has no bit"))),
        (_, None) => (number(rest), Some(0)),
    };
    let (Some(value), Some(bit)) = (value, bit) else {
        return Err(malformed(format!("what follows `{letters}` is not the number of an operand")));
    };
    if bit >= area.unit {
        return Err(out_of_range(format!("the bits go from 0 to {} {VENDOR}", area.unit - 1)));
    }
    let units = area.ty.bits().unwrap_or(1).div_ceil(area.unit);
    if value.saturating_add(units - 1) > area.last {
        return Err(out_of_range(format!("no S5 controller has this operand: numbers go to {} {VENDOR}", area.last)));
    }
    // Bits count from the least significant one of a byte, bytes from the most significant one of a word.
    let within = match (area.unit, letters.as_str()) {
        (16, "DR") => 8,
        (16, "D") if bit >= 8 => bit - 8,
        (16, "D") => bit + 8,
        _ => bit,
    };
    let footprint = Footprint::new(area.area.clone(), value * area.unit + within, area.ty.bits().unwrap_or(1));
    Ok((area.class, area.ty, footprint))
}

/// The letters of an operand of the other mnemonic set in this one.
fn translate(letters: &str, mnemonics: Mnemonics) -> Option<&'static str> {
    match mnemonics {
        Mnemonics::German if letters == "C" => Some("Z"),
        Mnemonics::English if letters == "Z" => Some("C"),
        Mnemonics::German => AREAS.iter().find(|it| it.english == letters).map(|it| it.german),
        Mnemonics::English => AREAS.iter().find(|it| it.german == letters).map(|it| it.english),
    }
}

fn nearest(compact: &str, spaced: bool, mnemonics: Mnemonics) -> Option<String> {
    if compact.len() > super::address::LONGEST_SUGGESTION_SOURCE || !compact.is_ascii() {
        return None;
    }
    let upper = compact.to_ascii_uppercase();
    let end = upper.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(end);
    let letters = translate(letters, mnemonics).unwrap_or(letters);
    let whole = rest.split(['.', ',']).next().unwrap_or_default();
    let slips = [
        format!("{letters}{rest}"),
        format!("{letters}{}", rest.replace(',', ".")),
        format!("{letters}{whole}.0"),
        format!("{letters}{whole}"),
    ];
    let found = slips.into_iter().find(|it| *it != upper && read(it, mnemonics).is_ok())?;
    Some(if spaced { found.replacen(letters, &format!("{letters} "), 1) } else { found })
}

#[cfg(test)]
mod tests {
    use Mnemonics::{English, German};

    use super::*;

    fn object(text: &str) -> Object {
        parse(text, German).unwrap_or_else(|error| panic!("{text}: {error:?}"))
    }

    #[test]
    fn both_sets_name_the_same_places() {
        for (german, english) in [
            ("E 1.0", "I 1.0"),
            ("AB 4", "QB 4"),
            ("M 10.7", "F 10.7"),
            ("MB 10", "FY 10"),
            ("MW 10", "FW 10"),
            ("DW 3", "DW 3"),
            ("Z 1", "C 1"),
            ("T 3", "T 3"),
            ("PY 128", "PY 128"),
        ] {
            let other = parse(english, English).unwrap_or_else(|error| panic!("{english}: {error:?}"));
            assert_eq!(object(german).footprint, other.footprint, "{german}");
        }
    }

    #[test]
    fn data_blocks_are_addressed_by_words() {
        let overlaps = |a: &str, b: &str| object(a).footprint.overlaps(&object(b).footprint);
        assert!(overlaps("DW 2", "DL 2") && overlaps("DW 2", "DR 2") && !overlaps("DL 2", "DR 2"));
        assert!(!overlaps("DW 2", "DW 3") && overlaps("DD 2", "DW 3") && !overlaps("DD 2", "DW 4"));
        assert!(overlaps("D 2.15", "DL 2") && overlaps("D 2.8", "DL 2") && !overlaps("D 2.7", "DL 2"));
        assert!(overlaps("D 2.0", "DR 2") && overlaps("D 2.7", "DR 2"));
        assert!(overlaps("MW 10", "M 11.7") && overlaps("MW 10", "MB 11") && !overlaps("MW 10", "MB 12"));
        assert!(!overlaps("D 2.15", "D 2.7"));
    }

    #[test]
    fn malformed_and_out_of_range() {
        for (text, set, suggestion) in [
            ("E 1", German, Some("E 1.0")),
            ("I 0.0", German, Some("E 0.0")),
            ("M10.1", English, Some("F10.1")),
            ("MW 4.0", German, Some("MW 4")),
            ("C 1", German, Some("Z 1")),
            ("E0,1", German, Some("E0.1")),
            ("XY 1", German, None),
            ("M", German, None),
            ("", German, None),
            ("Mé0.0", German, None),
        ] {
            let error = parse(text, set).expect_err(text);
            assert_eq!((error.kind, error.suggestion.as_deref()), (AddressErrorKind::Malformed, suggestion), "{text}");
        }
        for text in ["M 256.0", "E 128.0", "M 0.8", "D 0.16", "T 256", "MW 255", "DW 256", "M 99999999999.0"] {
            let error = parse(text, German).expect_err(text);
            assert_eq!(error.kind, AddressErrorKind::OutOfRange, "{text}");
        }
        for text in ["M 255.7", "MW 254", "D 255.15", "DL 255", "E 127.7"] {
            object(text);
        }
    }
}

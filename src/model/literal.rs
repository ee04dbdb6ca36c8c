//! Constants and their values.

mod step5;

pub use step5::parse_step5;

use std::borrow::Cow;

/// The value of a constant, with what its spelling says of its type.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Bool(bool),
    /// A whole number: plain, or with a base or width prefix.
    Int {
        value: i64,
        ty: IntType,
    },
    Real(f64),
    /// `S5T#1M_35S_6MS`, in milliseconds, as written.
    S5Time {
        milliseconds: u64,
    },
    /// `T#...`, in milliseconds.
    Time {
        milliseconds: i64,
    },
    /// `C#3`.
    Count(u32),
    /// `'abc'`.
    Text(String),
    /// A date, time of day, pointer or other constant whose value no rule needs.
    Other,
}

/// What the spelling of a whole number says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IntType {
    /// Decimal without a prefix.
    Plain,
    /// `L#-5`.
    Long,
    /// `B#16#..`, `W#16#..`, `DW#16#..`, `2#...`, `16#...`: a pattern of that many bits (0 when the spelling does not say).
    Bits(u8),
}

/// Why a constant is not one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LiteralError {
    /// One sentence without a final stop, with the allowed range and its source where there is one.
    pub message: String,
    /// Whether the constant is a time of STEP 7 (rule C001), or any other (rule V001).
    pub is_s5time: bool,
    /// Whether it is a floating-point number that the format cannot hold (rule T020).
    pub is_real_range: bool,
}

/// How a controller stores a duration in the 16 bits of a STEP 7 timer: three decimal digits and a base (S7:566-579).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct S5Encoding {
    /// 10, 100, 1000 or 10000 milliseconds.
    pub base_ms: u64,
    /// 0 to 999.
    pub count: u64,
    /// The duration really used, in milliseconds.
    pub represented_ms: u64,
}

/// Time bases of a STEP 7 timer in milliseconds, in the order of their codes (S7:574-577).
const S5_BASES: [u64; 4] = [10, 100, 1_000, 10_000];
/// Three decimal digits (S7:579).
const S5_LAST_COUNT: u64 = 999;
/// 2H_46M_30S (S7:485).
pub const S5TIME_MAX_MS: u64 = S5_BASES[3] * S5_LAST_COUNT;

/// What a timer uses for a duration: the finest base whose count has three digits, the rest cut off (S7:481-487,
/// S7:566-587). A duration over [`S5TIME_MAX_MS`] gives the longest one.
pub fn s5time_encoding(milliseconds: u64) -> S5Encoding {
    let base_ms = S5_BASES.into_iter().find(|base| milliseconds / base <= S5_LAST_COUNT).unwrap_or(S5_BASES[3]);
    let count = (milliseconds / base_ms).min(S5_LAST_COUNT);
    S5Encoding { base_ms, count, represented_ms: count * base_ms }
}

/// The longest-unit-first spelling of a duration: `S5T#1M_35S`.
pub fn s5time_text(milliseconds: u64) -> String {
    let units = [("H", 3_600_000), ("M", 60_000), ("S", 1_000), ("MS", 1)];
    let mut rest = milliseconds;
    let mut parts = Vec::new();
    for (unit, length) in units {
        let count = rest / length;
        rest %= length;
        if count > 0 {
            parts.push(format!("{count}{unit}"));
        }
    }
    if parts.is_empty() { "S5T#0MS".to_owned() } else { format!("S5T#{}", parts.join("_")) }
}

/// What a timer reads in a word loaded as its duration, as in `L W#16#2009` (S7:581-587). `None` when a digit is not
/// decimal. Bits 14 and 15 are not used (S7:570).
pub fn s5time_from_word(word: u16) -> Option<S5Encoding> {
    let digits = [word >> 8 & 0xF, word >> 4 & 0xF, word & 0xF];
    if digits.iter().any(|it| *it > 9) {
        return None;
    }
    let count = digits.iter().fold(0, |sum, it| sum * 10 + u64::from(*it));
    let base_ms = S5_BASES[usize::from(word >> 12 & 0b11)];
    Some(S5Encoding { base_ms, count, represented_ms: count * base_ms })
}

/// Reads a STEP 7 constant: `L#-5`, `C#3`, `S5T#1M_35S_6MS`, `W#16#0FFF`, `2#1111.0000`, `B#(1,2)`, `1.35 E+02`, `'abc'`,
/// `P#M 0.0`, `DT#04-5-28-10:12:25:3567`, `#1`, `TRUE`. Prefixes in either case, blanks allowed inside.
///
/// A plain number is taken up to 32 bits: which width the instruction wants is not part of the constant.
///
/// # Errors
/// Text that is no constant, or a value out of the range of its form.
pub fn parse_step7(text: &str) -> Result<Value, LiteralError> {
    let text = text.trim();
    if text.starts_with('\'') {
        return quoted(text);
    }
    let compact = compact(text);
    match &*compact {
        "TRUE" => return Ok(Value::Bool(true)),
        "FALSE" => return Ok(Value::Bool(false)),
        _ => {}
    }
    let Some((prefix, body)) = compact.split_once('#') else {
        return number(&compact, &STEP7);
    };
    match prefix {
        // `L #1`, as S7:364 prints it for a constant of 32 bits.
        "" | "L" => whole(body, IntType::Long, &STEP7),
        "C" => count(body),
        "S5T" | "S5TIME" => s5time(body),
        "T" | "TIME" => time(body),
        "D" | "DATE" => date(body).map(|()| Value::Other),
        "TOD" | "TIME_OF_DAY" => time_of_day(body).map(|()| Value::Other),
        "DT" | "DATE_AND_TIME" => date_and_time(body).map(|()| Value::Other),
        "P" => pointer(body),
        "2" => binary(body, &STEP7),
        "16" => pattern(body, 0, &STEP7),
        "B" | "BYTE" if body.starts_with('(') => byte_list(body),
        "B" | "BYTE" => pattern(sixteen(body)?, 8, &STEP7),
        "W" | "WORD" => pattern(sixteen(body)?, 16, &STEP7),
        "DW" | "DWORD" => pattern(sixteen(body)?, 32, &STEP7),
        _ => Err(error(format!("`{}#` starts no constant of STEP 7", shown(prefix)))),
    }
}

/// Reads a PL7 constant (PL7:594-605): `-32768`, `2#1010`, `16#AB20`, `-1.32E12`, `TRUE`, `'text'`, `T#..`, `D#..`, `TOD#..`,
/// `DT#..`. The formats of times and dates are those of the vendor's general documentation.
///
/// # Errors
/// Text that is no constant, or a value that 32 bits do not hold (PL7:598-603).
pub fn parse_pl7(text: &str) -> Result<Value, LiteralError> {
    let text = text.trim();
    if text.starts_with('\'') {
        return quoted(text);
    }
    let compact = compact(text);
    match &*compact {
        "TRUE" => return Ok(Value::Bool(true)),
        "FALSE" => return Ok(Value::Bool(false)),
        _ => {}
    }
    let Some((prefix, body)) = compact.split_once('#') else {
        return number(&compact, &PL7);
    };
    match prefix {
        "2" => binary(body, &PL7),
        "16" => pattern(body, 0, &PL7),
        "T" | "TIME" => time(body),
        "D" | "DATE" => date(body).map(|()| Value::Other),
        "TOD" | "TIME_OF_DAY" => time_of_day(body).map(|()| Value::Other),
        "DT" | "DATE_AND_TIME" => date_and_time(body).map(|()| Value::Other),
        _ => Err(error(format!("`{}#` starts no constant of PL7 (PL7:596-603)", shown(prefix)))),
    }
}

/// Reads a PL7-2 constant, of one word each (PL72:979-984): `-5`, `L'1010'`, `H'524D'`, `M'MR'`. Prefixes in either case.
///
/// The four spellings of one value that the document gives tell how a message lies in the word: its first character is the
/// low byte. Where one of a single character lies is not told.
///
/// # Errors
/// Text that is no constant, or a value that 16 bits do not hold.
pub fn parse_pl72(text: &str) -> Result<Value, LiteralError> {
    let text = text.trim();
    let Some((prefix, body)) = text.split_once('\'') else {
        let (negative, magnitude) = sign(text);
        if !is_digits(magnitude) {
            return Err(error(format!("`{}` is no constant of PL7-2 (PL72:979-984)", shown(text))));
        }
        let magnitude = i64::try_from(digits(magnitude)).unwrap_or(i64::MAX);
        let value = if negative { -magnitude } else { magnitude };
        return match i16::try_from(value) {
            Ok(_) => Ok(Value::Int { value, ty: IntType::Plain }),
            Err(_) => Err(error(format!("`{}` is beyond 16 bits: -32768 to 32767 (PL72:1023)", shown(text)))),
        };
    };
    let Some(body) = body.strip_suffix('\'') else {
        return Err(error(format!("`{}` is not closed by a quote", shown(text))));
    };
    let radix = match prefix {
        "L" | "l" => 2,
        "H" | "h" => 16,
        "M" | "m" => return message(body),
        _ => return Err(error(format!("`{}'` starts no constant of PL7-2: L, H or M (PL72:981-983)", shown(prefix)))),
    };
    let (name, last) = if radix == 2 { ("binary", 16) } else { ("hexadecimal", 4) };
    if body.is_empty() || !body.chars().all(|it| it.is_digit(radix)) {
        return Err(error(format!("`{}` is no {name} number (PL72:981-982)", shown(text))));
    }
    if body.len() > last {
        return Err(error(format!(
            "`{}` is beyond 16 bits: at most {last} digits (PL72:251, PL72:981-982)",
            shown(text)
        )));
    }
    let value =
        body.chars().filter_map(|it| it.to_digit(radix)).fold(0, |sum, it| sum * i64::from(radix) + i64::from(it));
    Ok(Value::Int { value, ty: IntType::Bits(16) })
}

/// The characters of `M'MR'`.
fn message(body: &str) -> Result<Value, LiteralError> {
    let byte = |it: char| u8::try_from(u32::from(it)).map_err(|_| error(format!("`{it}` has no code of 8 bits")));
    let mut chars = body.chars();
    match (chars.next(), chars.next(), chars.next()) {
        (Some(first), None, None) => byte(first).map(|_| Value::Other),
        (Some(first), Some(second), None) => {
            let value = i64::from(u16::from_le_bytes([byte(first)?, byte(second)?]));
            Ok(Value::Int { value, ty: IntType::Bits(16) })
        }
        _ => Err(error(format!("a word holds one or two characters, not `{}` (PL72:251, PL72:983)", shown(body)))),
    }
}

/// What the two vendors' numbers differ in.
struct Dialect {
    /// Where the ranges of whole numbers are given: base 10, base 2, base 16.
    decimal: &'static str,
    binary: &'static str,
    hexadecimal: &'static str,
    /// Magnitudes of a real other than 0 lie strictly between these.
    real: (f64, f64),
    real_source: &'static str,
}

const STEP7: Dialect = Dialect {
    decimal: "S7:123",
    binary: "S7:123",
    hexadecimal: "S7:123",
    // Single precision, its smallest numbers included: the manual gives no bound.
    real: (0.0, 3.402_823_5e38),
    real_source: "IEEE 754 single precision, S7:123",
};

const PL7: Dialect = Dialect {
    decimal: "PL7:597-598",
    binary: "PL7:599-600",
    hexadecimal: "PL7:601-602",
    real: (1.175_494e-38, 3.402_824e38),
    real_source: "PL7:603",
};

fn error(message: String) -> LiteralError {
    LiteralError { message, is_s5time: false, is_real_range: false }
}

/// The head of a text that may be of any length.
fn shown(text: &str) -> String {
    let mut chars = text.chars();
    let head: String = chars.by_ref().take(24).collect();
    if chars.next().is_some() { head + "..." } else { head }
}

/// The constant without blanks, in upper case, which nearly all are.
fn compact(text: &str) -> Cow<'_, str> {
    if text.bytes().all(|it| it.is_ascii_graphic() && !it.is_ascii_lowercase()) {
        return Cow::Borrowed(text);
    }
    text.chars().filter(|it| !it.is_whitespace()).map(|it| it.to_ascii_uppercase()).collect()
}

/// `'it$'s'`: `$` before a quote, a dollar or a code letter keeps the next character (IEC 61131-3).
fn quoted(text: &str) -> Result<Value, LiteralError> {
    let unclosed = || error("the text constant is not closed by a quote".to_owned());
    let mut chars = text.strip_prefix('\'').ok_or_else(unclosed)?.chars();
    let mut out = String::new();
    loop {
        match chars.next().ok_or_else(unclosed)? {
            '\'' => break,
            '$' => match chars.next().ok_or_else(unclosed)? {
                escaped @ ('\'' | '$') => out.push(escaped),
                other => out.extend(['$', other]),
            },
            other => out.push(other),
        }
    }
    if chars.next().is_none() {
        Ok(Value::Text(out))
    } else {
        Err(error("a text constant ends at its quote".to_owned()))
    }
}

fn sign(text: &str) -> (bool, &str) {
    match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    }
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit())
}

/// The value of digits, `u64::MAX` when it does not fit.
fn digits(text: &str) -> u64 {
    text.bytes().fold(0, |sum: u64, it| sum.saturating_mul(10).saturating_add(u64::from(it.wrapping_sub(b'0') % 10)))
}

/// A number without a prefix: whole or real.
fn number(text: &str, dialect: &Dialect) -> Result<Value, LiteralError> {
    if text.contains(['.', 'E']) { real(text, dialect) } else { whole(text, IntType::Plain, dialect) }
}

fn whole(text: &str, ty: IntType, dialect: &Dialect) -> Result<Value, LiteralError> {
    let (negative, magnitude) = sign(text);
    if !is_digits(magnitude) {
        return Err(error(format!("`{}` is no number", shown(text))));
    }
    let magnitude = digits(magnitude);
    let value = i64::try_from(magnitude).map_or(i64::MAX, |it| if negative { -it } else { it });
    if i32::try_from(value).is_err() {
        let (first, last) = (i32::MIN, i32::MAX);
        return Err(error(format!("`{}` is beyond 32 bits: {first} to {last} ({})", shown(text), dialect.decimal)));
    }
    Ok(Value::Int { value, ty })
}

/// `1.22e+01`: digits on both sides of the point, or an exponent.
fn real(text: &str, dialect: &Dialect) -> Result<Value, LiteralError> {
    let no_number = || error(format!("`{}` is no number: a real is written `1285.28` or `12.8528E2`", shown(text)));
    let (_, magnitude) = sign(text);
    let (mantissa, exponent) = match magnitude.split_once('E') {
        Some((mantissa, exponent)) => (mantissa, Some(sign(exponent).1)),
        None => (magnitude, None),
    };
    let mantissa_holds = match mantissa.split_once('.') {
        Some((before, after)) => is_digits(before) && is_digits(after),
        None => is_digits(mantissa) && exponent.is_some(),
    };
    if !mantissa_holds || exponent.is_some_and(|it| !is_digits(it)) {
        return Err(no_number());
    }
    let value: f64 = text.parse().map_err(|_| no_number())?;
    let (least, greatest) = dialect.real;
    let is_zero = mantissa.bytes().all(|it| matches!(it, b'0' | b'.'));
    let in_range = value.abs() > least && value.abs() < greatest;
    if !is_zero && !in_range {
        let range = if least > 0.0 {
            format!("its magnitude lies between {least:e} and {greatest:e}, both excluded")
        } else {
            format!("its magnitude lies below {greatest:e}")
        };
        let message = format!("`{}` is beyond the range of a real: {range} ({})", shown(text), dialect.real_source);
        return Err(LiteralError { is_real_range: true, ..error(message) });
    }
    Ok(Value::Real(value))
}

/// `C#3`.
fn count(text: &str) -> Result<Value, LiteralError> {
    if !is_digits(text) {
        return Err(error(format!("`C#{}` is no count: `C#` and a number from 0 to 999 (S7:591, 598)", shown(text))));
    }
    match u32::try_from(digits(text)) {
        Ok(value @ 0..=999) => Ok(Value::Count(value)),
        _ => Err(error(format!("`C#{}` is beyond the range of a counter: 0 to 999 (S7:591)", shown(text)))),
    }
}

fn sixteen(text: &str) -> Result<&str, LiteralError> {
    text.strip_prefix("16#").ok_or_else(|| error(format!("`16#` is missing before `{}` (S7:123)", shown(text))))
}

/// Digits of base 2 or 16 without separators, leading zeros dropped; `None` for another character. Separators stand between
/// digits.
fn bare(text: &str, is_digit: impl Fn(u8) -> bool, separators: &[u8]) -> Option<String> {
    let bytes = text.as_bytes();
    let ends = [bytes.first()?, bytes.last()?];
    if ends.iter().any(|it| separators.contains(it)) || !bytes.iter().all(|it| is_digit(*it) || separators.contains(it))
    {
        return None;
    }
    Some(text.chars().filter(|it| it.is_ascii_alphanumeric()).skip_while(|it| *it == '0').collect())
}

/// `2#1111.0000_1111.0000`, as S7:123 separates the digits.
fn binary(text: &str, dialect: &Dialect) -> Result<Value, LiteralError> {
    let Some(bits) = bare(text, |it| matches!(it, b'0' | b'1'), b"_.") else {
        return Err(error(format!("`2#{}` has digits that are neither 0 nor 1 ({})", shown(text), dialect.binary)));
    };
    if bits.len() > 32 {
        return Err(error(format!("`2#{}` has more than 32 bits ({})", shown(text), dialect.binary)));
    }
    let value = bits.bytes().fold(0, |sum, it| sum << 1 | i64::from(it == b'1'));
    Ok(Value::Int { value, ty: IntType::Bits(0) })
}

/// The digits after `16#`, of a pattern of `width` bits, or of 32 when the spelling does not say (0).
fn pattern(text: &str, width: u8, dialect: &Dialect) -> Result<Value, LiteralError> {
    let Some(hex) = bare(text, |it| it.is_ascii_hexdigit(), b"_") else {
        return Err(error(format!("`16#{}` is no hexadecimal number ({})", shown(text), dialect.hexadecimal)));
    };
    let bits = if width == 0 { 32 } else { width };
    if hex.len() > usize::from(bits / 4) {
        let last = "F".repeat(usize::from(bits / 4));
        let source = dialect.hexadecimal;
        return Err(error(format!("`16#{}` is beyond {bits} bits: 16#0 to 16#{last} ({source})", shown(text))));
    }
    let value = hex.bytes().filter_map(|it| char::from(it).to_digit(16)).fold(0, |sum, it| sum << 4 | i64::from(it));
    Ok(Value::Int { value, ty: IntType::Bits(width) })
}

/// `B#(1,2)`, `B#(1,2,3,4)`: bytes in decimal, the highest first.
fn byte_list(text: &str) -> Result<Value, LiteralError> {
    let form = || error("a list of bytes is written `B#(1,2)` or `B#(1,2,3,4)`, each from 0 to 255".to_owned());
    let inside = text.strip_prefix('(').and_then(|it| it.strip_suffix(')')).ok_or_else(form)?;
    let (mut value, mut bytes) = (0, 0);
    for byte in inside.split(',') {
        bytes += 1;
        if bytes > 4 || !is_digits(byte) {
            return Err(form());
        }
        value = value << 8 | i64::from(u8::try_from(digits(byte)).map_err(|_| form())?);
    }
    match bytes {
        2 => Ok(Value::Int { value, ty: IntType::Bits(16) }),
        4 => Ok(Value::Int { value, ty: IntType::Bits(32) }),
        _ => Err(form()),
    }
}

/// Units of durations in milliseconds, the longest first.
const UNITS: [(&str, u64); 5] = [("D", 86_400_000), ("H", 3_600_000), ("M", 60_000), ("S", 1_000), ("MS", 1)];

/// Sum of `1D_2H_3M_4S_5MS` in milliseconds: each unit at most once, in this order, `_` between them or not. One unit alone
/// may have decimals. `None` for another form.
fn duration(text: &str, units: &[(&str, u64)]) -> Option<u64> {
    let (mut rest, mut sum, mut next) = (text, 0u64, 0);
    while !rest.is_empty() {
        let end = rest.bytes().position(|it| !(it.is_ascii_digit() || it == b'.'))?;
        let (amount, tail) = rest.split_at(end);
        let end = tail.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(tail.len());
        let (unit, tail) = tail.split_at(end);
        let index = units.iter().position(|(name, _)| *name == unit).filter(|it| *it >= next)?;
        let (_, milliseconds) = *units.get(index)?;
        let (amount, decimals) = match amount.split_once('.') {
            Some((amount, decimals)) if next == 0 && tail.is_empty() && is_digits(decimals) => (amount, decimals),
            Some(_) => return None,
            None => (amount, ""),
        };
        if !is_digits(amount) {
            return None;
        }
        sum = sum.saturating_add(digits(amount).saturating_mul(milliseconds));
        sum = sum.saturating_add(fraction(decimals, milliseconds));
        next = index + 1;
        rest = match tail.strip_prefix('_') {
            Some("") => return None,
            Some(rest) => rest,
            None => tail,
        };
    }
    (next > 0).then_some(sum)
}

/// `decimals` behind the point of a unit, in whole milliseconds.
fn fraction(decimals: &str, milliseconds: u64) -> u64 {
    // A day has fewer than 10^8 milliseconds: more decimals change nothing, and the product fits.
    let decimals = decimals.get(..9).unwrap_or(decimals);
    let scale = (0..decimals.len()).fold(1, |scale: u64, _| scale * 10);
    digits(decimals) * milliseconds / scale
}

fn s5time(text: &str) -> Result<Value, LiteralError> {
    let error = |message| LiteralError { message, is_s5time: true, is_real_range: false };
    // No days in this form: aH_bM_cS_dMS (S7:481).
    let Some(milliseconds) = duration(text, &UNITS[1..]) else {
        return Err(error(format!("`S5T#{}` is no duration: the form is `S5T#aH_bM_cS_dMS` (S7:481)", shown(text))));
    };
    if milliseconds > S5TIME_MAX_MS {
        return Err(error(format!("`S5T#{}` is beyond the longest time of a timer: 2H_46M_30S (S7:485)", shown(text))));
    }
    Ok(Value::S5Time { milliseconds })
}

fn time(text: &str) -> Result<Value, LiteralError> {
    let (negative, magnitude) = sign(text);
    let Some(milliseconds) = duration(magnitude, &UNITS) else {
        return Err(error(format!("`T#{}` is no duration: the form is `T#aD_bH_cM_dS_eMS`", shown(text))));
    };
    // 32 bits of milliseconds with sign: the vendors' general documentation.
    let limit = if negative { i64::from(i32::MIN).unsigned_abs() } else { u64::from(i32::MAX.unsigned_abs()) };
    match i64::try_from(milliseconds) {
        Ok(value) if milliseconds <= limit => Ok(Value::Time { milliseconds: if negative { -value } else { value } }),
        _ => Err(error(format!("`T#{}` is beyond 32 bits of milliseconds: 24D_20H_31M_23S_647MS", shown(text)))),
    }
}

/// `2004-05-28`, `04-5-28`.
fn date(text: &str) -> Result<(), LiteralError> {
    let form = || error(format!("`{}` is no date: the form is year-month-day", shown(text)));
    let mut parts = text.split('-');
    let (Some(year), Some(month), Some(day), None) = (parts.next(), parts.next(), parts.next(), parts.next()) else {
        return Err(form());
    };
    if !is_digits(year) || !matches!(year.len(), 2 | 4) || !is_digits(month) || !is_digits(day) {
        return Err(form());
    }
    // Two digits are the years 1990 to 2089, whose leap years are those divisible by 4.
    let year = digits(year);
    let leap = year.is_multiple_of(4) && (year < 100 || !year.is_multiple_of(100) || year.is_multiple_of(400));
    let last = match digits(month) {
        4 | 6 | 9 | 11 => 30,
        2 if leap => 29,
        2 => 28,
        1..=12 => 31,
        _ => return Err(error(format!("`{}` has no month from 1 to 12", shown(text)))),
    };
    if (1..=last).contains(&digits(day)) {
        Ok(())
    } else {
        Err(error(format!("`{}` has a day that its month does not have: 1 to {last}", shown(text))))
    }
}

/// `10:12:25`, `10:12:25.356`, also the milliseconds after a colon and a colon at the end, as S7:1290-1311 prints them.
fn time_of_day(text: &str) -> Result<(), LiteralError> {
    let form = || error(format!("`{}` is no time of day: the form is hours:minutes:seconds.milliseconds", shown(text)));
    let mut parts = text.split([':', '.']);
    let (Some(hours), Some(minutes), Some(seconds)) = (parts.next(), parts.next(), parts.next()) else {
        return Err(form());
    };
    let milliseconds = parts.next().unwrap_or_default();
    let points = text.bytes().filter(|it| *it == b'.').count();
    let point_holds =
        points == 0 || points == 1 && is_digits(milliseconds) && text.ends_with(&format!(".{milliseconds}"));
    let all_digits = [hours, minutes, seconds].into_iter().all(|it| is_digits(it) && it.len() <= 2);
    // Four digits of milliseconds hold the day of the week in the last (S7:1287-1292).
    let milliseconds_hold = milliseconds.len() <= 4 && (milliseconds.is_empty() || is_digits(milliseconds));
    if parts.next().is_some() || !point_holds || !all_digits || !milliseconds_hold {
        return Err(form());
    }
    if digits(hours) > 23 || digits(minutes) > 59 || digits(seconds) > 59 {
        return Err(error(format!("`{}` is beyond 23:59:59", shown(text))));
    }
    Ok(())
}

/// `04-5-28-10:12:25:3567`.
fn date_and_time(text: &str) -> Result<(), LiteralError> {
    let Some((day, time)) = text.rsplit_once('-') else {
        return Err(error(format!(
            "`{}` is no date and time: the form is year-month-day-hours:minutes:seconds",
            shown(text)
        )));
    };
    date(day)?;
    time_of_day(time)
}

/// What may stand before the byte of a pointer, in either mnemonic set; nothing for a pointer inside an area.
const POINTER_AREAS: [&str; 12] = ["", "E", "I", "A", "Q", "M", "L", "V", "P", "DBX", "DIX", "DB"];

/// `P#0.0`, `P#M0.0`, `P#DB1.DBX0.0BYTE10`, `P##name`: only the bit number is checked.
fn pointer(text: &str) -> Result<Value, LiteralError> {
    let form = || error(format!("`P#{}` is no pointer: a byte, `.` and a bit from 0 to 7", shown(text)));
    if text.is_empty() {
        return Err(form());
    }
    let place = match text.strip_prefix("DB").and_then(|rest| rest.split_once('.')) {
        Some((number, place)) if is_digits(number) => place,
        _ => text,
    };
    let byte = place.trim_start_matches(|it: char| it.is_ascii_alphabetic());
    let end = byte.bytes().position(|it| !it.is_ascii_digit()).unwrap_or(byte.len());
    let area = place.strip_suffix(byte).unwrap_or_default();
    if end == 0 || !POINTER_AREAS.contains(&area) {
        // The name of a parameter or variable.
        return Ok(Value::Other);
    }
    let (_, bit) = byte.split_at(end);
    let Some(bit) = bit.strip_prefix('.') else { return Err(form()) };
    let end = bit.bytes().position(|it| !it.is_ascii_digit()).unwrap_or(bit.len());
    let (bit, rest) = bit.split_at(end);
    let rest_holds = rest.is_empty() || rest.starts_with(|it: char| it.is_ascii_alphabetic());
    if is_digits(bit) && digits(bit) <= 7 && rest_holds { Ok(Value::Other) } else { Err(form()) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn durations_are_spelled_as_they_are_read() {
        for (milliseconds, text) in
            [(0, "S5T#0MS"), (95_000, "S5T#1M_35S"), (S5TIME_MAX_MS, "S5T#2H_46M_30S"), (3_600_010, "S5T#1H_10MS")]
        {
            assert_eq!(s5time_text(milliseconds), text);
            assert_eq!(parse_step7(text), Ok(Value::S5Time { milliseconds }), "{text}");
        }
    }

    fn int(value: i64, ty: IntType) -> Value {
        Value::Int { value, ty }
    }

    fn check(parse: fn(&str) -> Result<Value, LiteralError>, cases: &[(&str, Value)]) {
        for (text, value) in cases {
            assert_eq!(parse(text).as_ref(), Ok(value), "{text}");
        }
    }

    fn check_errors(parse: fn(&str) -> Result<Value, LiteralError>, cases: &[(&str, &str)]) {
        for (text, part) in cases {
            let error = match parse(text) {
                Err(error) => error,
                Ok(value) => panic!("{text} is {value:?}"),
            };
            assert!(error.message.contains(part) && !error.message.ends_with('.'), "{text}: {}", error.message);
            let is_s5time = text.to_ascii_uppercase().starts_with("S5T");
            assert_eq!(error.is_s5time, is_s5time, "{text}");
        }
    }

    #[test]
    fn step7_constants() {
        let s5 = |milliseconds| Value::S5Time { milliseconds };
        let time = |milliseconds| Value::Time { milliseconds };
        check(
            parse_step7,
            &[
                ("50", int(50, IntType::Plain)),
                ("-32768", int(-32768, IntType::Plain)),
                ("+5", int(5, IntType::Plain)),
                ("#1", int(1, IntType::Long)),
                ("L#30", int(30, IntType::Long)),
                ("l#-2147483648", int(-2_147_483_648, IntType::Long)),
                ("C#3", Value::Count(3)),
                ("C#0", Value::Count(0)),
                ("c#999", Value::Count(999)),
                ("S5T#10S", s5(10_000)),
                ("S5T#1M_35S_6MS", s5(95_006)),
                ("S5T#3s", s5(3_000)),
                ("s5time#1H30M", s5(5_400_000)),
                ("S5T#0H_0M_5S_12MS", s5(5_012)),
                ("S5T#2H_46M_30S", s5(9_990_000)),
                ("S5T#90S", s5(90_000)),
                ("S5T#2.5S", s5(2_500)),
                ("S5T#0MS", s5(0)),
                ("T#1D_2H_3M_4S_5MS", time(93_784_005)),
                ("TIME#-10S", time(-10_000)),
                ("T#24D_20H_31M_23S_647MS", time(2_147_483_647)),
                ("T#-24D20H31M23S648MS", time(-2_147_483_648)),
                ("T#1.5h", time(5_400_000)),
                ("2#0", int(0, IntType::Bits(0))),
                ("2#1111.1111.1111.1111", int(0xFFFF, IntType::Bits(0))),
                ("2#0001_0010", int(0x12, IntType::Bits(0))),
                ("B#16#FF", int(255, IntType::Bits(8))),
                ("B#16#0", int(0, IntType::Bits(8))),
                ("W#16#0FFF", int(0xFFF, IntType::Bits(16))),
                ("w#16#2009", int(0x2009, IntType::Bits(16))),
                ("W#16#20", int(0x20, IntType::Bits(16))),
                ("DW#16#5", int(5, IntType::Bits(32))),
                ("DW#16#FFFF_FFFF", int(0xFFFF_FFFF, IntType::Bits(32))),
                ("B#(1,2)", int(258, IntType::Bits(16))),
                ("B#(1, 2, 3, 4)", int(0x0102_0304, IntType::Bits(32))),
                ("1.22e+01", Value::Real(12.2)),
                ("1.35 E+02", Value::Real(135.0)),
                ("-0.5", Value::Real(-0.5)),
                ("0.0", Value::Real(0.0)),
                ("1e5", Value::Real(1e5)),
                ("TRUE", Value::Bool(true)),
                ("false", Value::Bool(false)),
                ("'abc'", Value::Text("abc".into())),
                ("'a b$'c'", Value::Text("a b'c".into())),
                ("''", Value::Text(String::new())),
                ("D#2004-05-28", Value::Other),
                ("DATE#2000-2-29", Value::Other),
                ("TOD#23:59:59.999", Value::Other),
                ("DT#04-5-28-10 :12 :25:3567", Value::Other),
                ("DT#04-5-28-10:00:00:00", Value::Other),
                ("DT#90-1-1-0:0:0:", Value::Other),
                ("DT#90-1-1-0:0:0.000", Value::Other),
                ("P#0.0", Value::Other),
                ("P#M 10.7", Value::Other),
                ("P#DB1.DBX 0.0 BYTE 10", Value::Other),
                ("P##etape", Value::Other),
                ("P#Tank1.level", Value::Other),
            ],
        );
    }

    #[test]
    fn step7_errors() {
        check_errors(
            parse_step7,
            &[
                ("2147483648", "S7:123"),
                ("-2147483649", "S7:123"),
                ("L#2147483648", "S7:123"),
                ("99999999999999999999999999", "S7:123"),
                ("L#", "no number"),
                ("L#1.5", "no number"),
                ("#etape", "no number"),
                ("", "no number"),
                ("-", "no number"),
                ("1_000", "no number"),
                ("C#1000", "S7:591"),
                ("C#-1", "S7:591"),
                ("C#", "S7:591"),
                ("S5T#2H_46M_31S", "S7:485"),
                ("S5T#9990001MS", "S7:485"),
                ("S5T#99999999999999999999H", "S7:485"),
                ("S5T#", "S7:481"),
                ("S5T#10", "S7:481"),
                ("S5T#1S_1M", "S7:481"),
                ("S5T#1S_1S", "S7:481"),
                ("S5T#1D", "S7:481"),
                ("S5T#1S_", "S7:481"),
                ("S5T#_1S", "S7:481"),
                ("S5T#1M_2.5S", "S7:481"),
                ("S5T#-1S", "S7:481"),
                ("S5T#1Sé", "S7:481"),
                ("T#24D_20H_31M_23S_648MS", "32 bits"),
                ("T#1X", "no duration"),
                ("2#", "S7:123"),
                ("2#102", "S7:123"),
                ("2#1_", "S7:123"),
                ("2#111111111111111111111111111111111", "S7:123"),
                ("B#16#100", "S7:123"),
                ("W#16#10000", "S7:123"),
                ("W#16#", "S7:123"),
                ("W#16#G", "S7:123"),
                ("W#FF", "S7:123"),
                ("DW#16#100000000", "S7:123"),
                ("B#(1)", "B#(1,2)"),
                ("B#(1,2,3)", "B#(1,2)"),
                ("B#(1,256)", "0 to 255"),
                ("B#(1,2,3,4,5)", "B#(1,2)"),
                ("B#(1,2", "B#(1,2)"),
                ("1.", "no number"),
                (".5", "no number"),
                ("1.5E", "no number"),
                ("1E+", "no number"),
                ("3.5e38", "single precision"),
                ("1e999999999", "single precision"),
                ("'abc", "not closed"),
                ("'", "not closed"),
                ("'a'b", "ends at its quote"),
                ("D#2003-2-29", "1 to 28"),
                ("D#2004-13-1", "month"),
                ("D#2004-1", "no date"),
                ("TOD#24:00:00", "23:59:59"),
                ("TOD#10:00", "no time of day"),
                ("TOD#10:00:00.", "no time of day"),
                ("TOD#10.00:00", "no time of day"),
                ("DT#04-5-28", "no date"),
                ("P#0.8", "no pointer"),
                ("P#M10", "no pointer"),
                ("P#", "no pointer"),
                ("X#5", "starts no constant"),
                ("inf", "no number"),
                ("NaN", "no number"),
            ],
        );
    }

    #[test]
    fn pl7_constants() {
        check(
            parse_pl7,
            &[
                ("1506", int(1506, IntType::Plain)),
                ("578963", int(578_963, IntType::Plain)),
                ("-2147483648", int(-2_147_483_648, IntType::Plain)),
                ("16#AB20", int(0xAB20, IntType::Bits(0))),
                ("16#5AC10", int(0x5AC10, IntType::Bits(0))),
                ("16#000000000", int(0, IntType::Bits(0))),
                ("16#ffffffff", int(0xFFFF_FFFF, IntType::Bits(0))),
                ("2#1000111011111011011", int(0x477DB, IntType::Bits(0))),
                ("-1.32E12", Value::Real(-1.32e12)),
                ("1285.28", Value::Real(1285.28)),
                ("12.8528E2", Value::Real(1285.28)),
                ("0.0", Value::Real(0.0)),
                ("3.402823E+38", Value::Real(3.402_823e38)),
                ("1.175495E-38", Value::Real(1.175_495e-38)),
                ("true", Value::Bool(true)),
                ("'Marche'", Value::Text("Marche".into())),
                ("T#10s", Value::Time { milliseconds: 10_000 }),
                ("D#1994-05-01", Value::Other),
                ("TOD#15:25:26", Value::Other),
                ("DT#1984-06-25-15:30:00", Value::Other),
            ],
        );
    }

    #[test]
    fn pl7_errors() {
        check_errors(
            parse_pl7,
            &[
                ("2147483648", "PL7:597"),
                ("-2147483649", "PL7:597"),
                ("2#2", "PL7:599"),
                // Printed at PL7:600 as an example, it has 39 bits.
                ("2#100011101111101101111111110111110111111", "PL7:599"),
                ("16#100000000", "PL7:601"),
                ("16#XY", "PL7:601"),
                ("16#", "PL7:601"),
                ("3.402824E+38", "PL7:603"),
                ("-3.402824E+38", "PL7:603"),
                ("1.175494E-38", "PL7:603"),
                ("1.0E-400", "PL7:603"),
                ("8#17", "PL7:596"),
                ("L#5", "PL7:596"),
                ("%MW4", "no number"),
                ("1.2.3", "no number"),
            ],
        );
    }

    #[test]
    fn what_a_timer_uses() {
        let cases = [
            (0, 10, 0, 0),
            (9, 10, 0, 0),
            (50, 10, 5, 50),
            (9_990, 10, 999, 9_990),
            (9_999, 10, 999, 9_990),
            (10_000, 100, 100, 10_000),
            (95_006, 100, 950, 95_000),
            (5_012, 10, 501, 5_010),
            (99_999, 100, 999, 99_900),
            (100_000, 1_000, 100, 100_000),
            (1_000_000, 10_000, 100, 1_000_000),
            (S5TIME_MAX_MS, 10_000, 999, 9_990_000),
            (u64::MAX, 10_000, 999, 9_990_000),
        ];
        for (milliseconds, base_ms, count, represented_ms) in cases {
            assert_eq!(s5time_encoding(milliseconds), S5Encoding { base_ms, count, represented_ms }, "{milliseconds}");
        }
        assert_eq!(s5time_from_word(0x2009).map(|it| it.represented_ms), Some(9_000));
        assert_eq!(s5time_from_word(0x0005).map(|it| it.represented_ms), Some(50));
        assert_eq!(s5time_from_word(0xF999).map(|it| it.represented_ms), Some(S5TIME_MAX_MS));
        assert_eq!(s5time_from_word(0x200A), None);
    }

    /// The document gives 21069 in its four spellings (PL72:981-984).
    #[test]
    fn words_of_pl7_2() {
        let word = |value| int(value, IntType::Bits(16));
        check(
            parse_pl72,
            &[
                ("21069", int(21_069, IntType::Plain)),
                ("L'101001001001101'", word(21_069)),
                ("H'524D'", word(21_069)),
                ("M'MR'", word(21_069)),
                ("h'ffff'", word(65_535)),
                ("l'1111111111111111'", word(65_535)),
                (" -32768 ", int(-32_768, IntType::Plain)),
                ("+32767", int(32_767, IntType::Plain)),
                ("M''''", word(0x2727)),
                ("M'é '", word(0x20E9)),
                ("M'A'", Value::Other),
            ],
        );
        check_errors(
            parse_pl72,
            &[
                ("32768", "beyond 16 bits"),
                ("-32769", "PL72:1023"),
                ("99999999999999999999", "beyond 16 bits"),
                ("L'2'", "binary"),
                ("L'00000000000000000'", "at most 16"),
                ("H'12345'", "at most 4"),
                ("H'5G'", "hexadecimal"),
                ("H''", "hexadecimal"),
                ("M''", "one or two"),
                ("M'abc'", "one or two"),
                ("M'€'", "8 bits"),
                ("H'5", "not closed"),
                ("X'5'", "L, H or M"),
                ("16#FF", "no constant"),
                ("TRUE", "no constant"),
                ("", "no constant"),
            ],
        );
    }

    proptest! {
        #[test]
        fn any_text_is_a_constant_or_an_error(text in r"\PC{0,24}") {
            let _ = (parse_step7(&text), parse_pl7(&text), parse_pl72(&text));
        }

        #[test]
        fn any_likely_constant_is_one_or_an_error(
            text in r"(S5T|T|DT|TOD|D|P|L|C|B|W|DW|H|M|2|16|)#?(16#)?[-+(']?[0-9A-FHMSX_.:,'$)é-]{0,40}"
        ) {
            for error in [parse_step7(&text), parse_pl7(&text), parse_pl72(&text)].into_iter().filter_map(Result::err) {
                prop_assert!(!error.message.is_empty());
            }
        }

        #[test]
        fn an_encoding_is_the_closest_below(milliseconds in 0..=S5TIME_MAX_MS) {
            let it = s5time_encoding(milliseconds);
            prop_assert!(it.represented_ms <= milliseconds && milliseconds - it.represented_ms < it.base_ms);
            prop_assert!(it.base_ms == 10 || milliseconds / (it.base_ms / 10) > 999);
        }

        #[test]
        fn s5time_adds_its_parts(h in 0u64..2, m in 0u64..60, s in 0u64..60, ms in 0u64..1000) {
            let milliseconds = ((h * 60 + m) * 60 + s) * 1000 + ms;
            prop_assert_eq!(parse_step7(&format!("S5T#{h}H_{m}M_{s}S_{ms}MS")), Ok(Value::S5Time { milliseconds }));
        }
    }
}

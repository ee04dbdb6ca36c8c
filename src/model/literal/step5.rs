//! Constants of STEP 5. The source document shows `KH`, `KT` and `KZ` (GRF:436, 807, 884); forms and ranges are those of
//! the vendor's general documentation.

use super::{IntType, LiteralError, S5_BASES, S5_LAST_COUNT, Value, error};

const VENDOR: &str = "(vendor's documentation)";

/// Reads a STEP 5 constant: `KF +5`, `KH 00FF`, `KM 00000000 11111111`, `KB 200`, `KY 12,34`, `KT 200.1`, `KZ 10`,
/// `KG +1234567+02`, `KC AB`, `DH 00010000`, `BF -3`, or a plain number. In either case; blanks inside mean nothing.
/// A `?` stands for a digit that the author of a listing left open.
///
/// # Errors
/// Text that is no constant, or a value out of the range of its form.
pub fn parse_step5(text: &str) -> Result<Value, LiteralError> {
    let letters = text.trim().get(..2).unwrap_or_default().to_ascii_uppercase();
    let body = text.trim().get(2..).unwrap_or_default();
    if matches!(letters.as_str(), "KC" | "KS") {
        return characters(body.trim());
    }
    let body: String = body.chars().filter(|it| !it.is_whitespace()).collect();
    if body.contains('?') {
        return Ok(Value::Other);
    }
    match letters.as_str() {
        "KF" => whole("KF", &body, -32_768, 32_767),
        "BF" => whole("BF", &body, -128, 127),
        "DF" => whole("DF", &body, i64::from(i32::MIN), i64::from(i32::MAX)),
        "KB" => whole("KB", &body, 0, 255),
        "KH" => pattern("KH", &body, 16, 4),
        "DH" => pattern("DH", &body, 16, 8),
        "KM" => pattern("KM", &body, 2, 16),
        "KY" => two_bytes(&body),
        "KZ" => match whole("KZ", &body, 0, i64::from(u32::MAX))? {
            Value::Int { value, .. } => Ok(Value::Count(u32::try_from(value).unwrap_or(u32::MAX))),
            other => Ok(other),
        },
        "KT" => time(&body),
        "KG" => float(&body),
        _ => {
            let compact: String = text.chars().filter(|it| !it.is_whitespace()).collect();
            let value = compact.parse().map_err(|_| error(format!("`{compact}` is no constant of STEP 5")))?;
            Ok(Value::Int { value, ty: IntType::Plain })
        }
    }
}

fn whole(letters: &str, body: &str, least: i64, most: i64) -> Result<Value, LiteralError> {
    let value = body.parse::<i64>().ok().filter(|it| (least..=most).contains(it));
    let value = value.ok_or_else(|| {
        error(format!("`{letters} {body}` is no constant: `{letters}` is {least} to {most} {VENDOR}"))
    })?;
    Ok(Value::Int { value, ty: IntType::Plain })
}

fn pattern(letters: &str, body: &str, base: u32, digits: usize) -> Result<Value, LiteralError> {
    let fits = !body.is_empty() && body.len() <= digits;
    match i64::from_str_radix(body, base).ok().filter(|it| fits && *it >= 0) {
        Some(value) => Ok(Value::Int { value, ty: IntType::Bits(if digits == 8 { 32 } else { 16 }) }),
        None => {
            let kind = if base == 2 { "binary" } else { "hexadecimal" };
            Err(error(format!(
                "`{letters} {body}` is no constant: `{letters}` has up to {digits} {kind} digits {VENDOR}"
            )))
        }
    }
}

fn two_bytes(body: &str) -> Result<Value, LiteralError> {
    let byte = |it: &str| it.parse::<u8>().ok().map(i64::from);
    match body.split_once(',').and_then(|(high, low)| Some((byte(high)?, byte(low)?))) {
        Some((high, low)) => Ok(Value::Int { value: high << 8 | low, ty: IntType::Bits(16) }),
        None => {
            Err(error(format!("`KY {body}` is no constant: `KY` is two bytes of 0 to 255, as in `KY 12,34` {VENDOR}")))
        }
    }
}

/// `KT 200.1`: how many of the base, and the base: 10 ms, 100 ms, 1 s, 10 s (GRF:884: 20 s).
fn time(body: &str) -> Result<Value, LiteralError> {
    let error = |message| LiteralError { message, is_s5time: true, is_real_range: false };
    let Some((count, base)) = body.split_once('.').and_then(|(count, base)| {
        let digits = |it: &str| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit());
        (digits(count) && digits(base)).then(|| (count.parse::<u64>(), base.parse::<usize>()))
    }) else {
        return Err(error(format!("`KT {body}` is no time: the form is a number, `.` and the base, as in `KT 200.1`")));
    };
    let count = count.ok().filter(|it| *it <= S5_LAST_COUNT);
    match (count, base.ok().and_then(|it| S5_BASES.get(it))) {
        (Some(count), Some(base)) => Ok(Value::S5Time { milliseconds: count * base }),
        (_, None) => {
            Err(error(format!("`KT {body}` has no time base: 0 is 10 ms, 1 is 100 ms, 2 is 1 s, 3 is 10 s {VENDOR}")))
        }
        (None, Some(_)) => Err(error(format!("`KT {body}` is beyond the three digits of a timer: 999 {VENDOR}"))),
    }
}

/// `+1234567+02`: 0.1234567 times 10 to the power of 2.
fn float(body: &str) -> Result<Value, LiteralError> {
    let fault = || error(format!("`KG {body}` is no constant: the form is `KG +1234567+02` {VENDOR}"));
    let (sign, digits) = match body.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, body.strip_prefix('+').unwrap_or(body)),
    };
    let at = digits.find(['+', '-']).unwrap_or(digits.len());
    let (mantissa, exponent) = digits.split_at(at);
    let exponent = exponent.strip_prefix('+').unwrap_or(exponent);
    let exponent: i32 = if exponent.is_empty() { 0 } else { exponent.parse().map_err(|_| fault())? };
    if mantissa.is_empty()
        || mantissa.len() > 7
        || !mantissa.bytes().all(|it| it.is_ascii_digit())
        || exponent.abs() > 38
    {
        return Err(fault());
    }
    let value: f64 = format!("0.{mantissa}e{exponent}").parse().map_err(|_| fault())?;
    Ok(Value::Real(sign * value))
}

fn characters(body: &str) -> Result<Value, LiteralError> {
    let text = body.trim_matches(['\'', '"']);
    match text.chars().count() {
        1..=2 => Ok(Value::Text(text.to_owned())),
        _ => Err(error(format!("`KC {body}` is no constant: `KC` is two characters {VENDOR}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values() {
        let int = |value| Ok(Value::Int { value, ty: IntType::Plain });
        let bits = |value| Ok(Value::Int { value, ty: IntType::Bits(16) });
        for (text, value) in [
            ("KF +5", int(5)),
            ("KF-32768", int(-32_768)),
            ("KB 255", int(255)),
            ("KH0000", bits(0)),
            ("kh ffff", bits(0xFFFF)),
            ("KM 00000000 11111111", bits(0xFF)),
            ("KY 1,2", bits(0x102)),
            ("KZ 10", Ok(Value::Count(10))),
            ("KT 200.1", Ok(Value::S5Time { milliseconds: 20_000 })),
            ("KT 999.3", Ok(Value::S5Time { milliseconds: 9_990_000 })),
            ("KG +1234567+02", Ok(Value::Real(12.34567))),
            ("KG -5", Ok(Value::Real(-0.5))),
            ("KC AB", Ok(Value::Text("AB".to_owned()))),
            ("KH????", Ok(Value::Other)),
            ("12", int(12)),
        ] {
            assert_eq!(parse_step5(text), value, "{text}");
        }
    }

    #[test]
    fn what_is_no_constant() {
        for (text, is_time) in [
            ("KF +32768", false),
            ("KF", false),
            ("KB 256", false),
            ("KH 10000", false),
            ("KH XY", false),
            ("KM 2", false),
            ("KY 1.2", false),
            ("KY 256,0", false),
            ("KT 10.4", true),
            ("KT 1000.0", true),
            ("KT 10", true),
            ("KT .1", true),
            ("KG +12345678+02", false),
            ("KG x", false),
            ("KC ABC", false),
            ("", false),
            ("é", false),
        ] {
            let error = parse_step5(text).expect_err(text);
            assert_eq!(error.is_s5time, is_time, "{text}");
            assert!(!error.message.ends_with('.'));
        }
    }
}

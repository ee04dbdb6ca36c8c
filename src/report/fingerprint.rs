//! The fingerprint of a line as GitHub code scanning computes it, so that a finding keeps its identity when lines
//! above it come and go.
//!
//! The fingerprint of a line is a polynomial hash (base 37, modulo 2^64) of the 100 UTF-16 units from the line's start
//! on, blanks and tabs left out and every end of line taken as LF. The text is followed by one unit 0xFFFF and then by
//! as many zeros as are needed. It is written in hexadecimal, with the number of times that it occurred so far.

use rustc_hash::FxHashMap;

use crate::lint::SourceView;
use crate::source::decode::{Encoding, encode};

const WINDOW: usize = 100;
const BASE: u64 = 37;
const END: u16 = 0xFFFF;

/// Fingerprints of a file's lines.
pub(super) struct Fingerprints(Vec<(u64, u32)>);

impl Fingerprints {
    pub(super) fn of(file: &SourceView) -> Self {
        Self::new(&as_uploaded(file))
    }

    fn new(text: &str) -> Self {
        let mut units = Vec::with_capacity(text.len() + 1);
        let mut starts = Vec::new();
        let mut at_start = true;
        let mut after_return = false;
        for unit in text.encode_utf16() {
            let (is_return, is_feed) = (unit == u16::from(b'\r'), unit == u16::from(b'\n'));
            let second_half = after_return && is_feed;
            let skipped = second_half || unit == u16::from(b' ') || unit == u16::from(b'\t');
            after_return = is_return;
            if skipped {
                continue;
            }
            if at_start {
                starts.push(units.len());
            }
            at_start = is_return || is_feed;
            units.push(if is_return { u16::from(b'\n') } else { unit });
        }
        if at_start {
            starts.push(units.len());
        }
        units.push(END);
        Self(hashes(&units, &starts))
    }

    /// The fingerprint of a line, counted from 1.
    pub(super) fn line(&self, line: u32) -> Option<String> {
        let (hash, count) = self.0.get((line as usize).checked_sub(1)?)?;
        Some(format!("{hash:x}:{count}"))
    }
}

/// Hash of the window at each start, and how often it occurred so far.
fn hashes(units: &[u16], starts: &[usize]) -> Vec<(u64, u32)> {
    let unit = |at: usize| u64::from(units.get(at).copied().unwrap_or(0));
    let leaving = BASE.wrapping_pow(WINDOW as u32);
    let mut counts: FxHashMap<u64, u32> = FxHashMap::default();
    let mut hash = (0..WINDOW).fold(0u64, |hash, at| hash.wrapping_mul(BASE).wrapping_add(unit(at)));
    let mut at = 0;
    let mut out = Vec::with_capacity(starts.len());
    for &start in starts {
        while at < start {
            hash = hash.wrapping_mul(BASE).wrapping_add(unit(at + WINDOW)).wrapping_sub(leaving.wrapping_mul(unit(at)));
            at += 1;
        }
        let count = counts.entry(hash).or_insert(0);
        *count += 1;
        out.push((hash, *count));
    }
    out
}

/// The text as the code host reads the file: as UTF-8, whatever it was written in.
fn as_uploaded(file: &SourceView) -> std::borrow::Cow<'_, str> {
    if file.text.is_ascii() {
        return (&*file.text).into();
    }
    match bytes(file) {
        Some(bytes) => String::from_utf8_lossy(&bytes).into_owned().into(),
        None => (&*file.text).into(),
    }
}

/// The bytes that a file of a single-byte encoding was decoded from.
fn bytes(file: &SourceView) -> Option<Vec<u8>> {
    let encoding: Encoding = file.encoding.parse().ok()?;
    if encoding.is_single_byte() { encode(&file.text, encoding, false).ok() } else { None }
}

/// Length in bytes of the file on disk, where it can be told from the text. A byte order mark is not counted.
pub(super) fn length(file: &SourceView) -> Option<usize> {
    match file.encoding.parse().ok()? {
        Encoding::Utf8 => Some(file.text.len()),
        Encoding::Utf16Le | Encoding::Utf16Be => Some(2 * file.text.encode_utf16().count()),
        _ => Some(file.text.chars().count()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::view;

    fn lines(text: &str) -> Vec<String> {
        let it = Fingerprints::new(text);
        (1..).map_while(|line| it.line(line)).collect()
    }

    // The values are those that the code host's own upload step computes for these texts.
    #[test]
    fn values_agree_with_the_code_host() {
        assert_eq!(lines(""), ["c129715d7a2bc9a3:1"]);
        assert_eq!(
            lines(" a\nb\n  \t\tc\n d"),
            ["271789c17abda88f:1", "54703d4cd895b18:1", "180aee12dab6264:1", "a23a3dc5e078b07b:1",]
        );
        let expected = [
            "e9496ae3ebfced30:1",
            "fb7c023a8b9ccb3f:1",
            "ce8ba1a563dcdaca:1",
            "e20e36e16fcb0cc8:1",
            "b3edc88f2938467e:1",
            "c8e28b0b4002a3a0:1",
            "c129715d7a2bc9a3:1",
        ];
        for end in ["\n", "\r", "\r\n"] {
            let text = " hello; \t\nworld!!!\n\n\n  \t\tGreetings\n End\n".replace('\n', end);
            assert_eq!(lines(&text), expected);
        }
    }

    #[test]
    fn repeated_lines_are_counted() {
        let all = lines(&"Lorem ipsum dolor sit amet.\n".repeat(10));
        assert_eq!(all[..6], [1, 2, 3, 4, 5, 6].map(|it| format!("a7f2ff13bc495cf2:{it}")));
        assert_eq!(
            all[6..],
            [
                "a7f2ff1481e87703:1",
                "a9cf91f7bbf1862b:1",
                "55ec222b86bcae53:1",
                "cc97dc7b1d7d8f7b:1",
                "c129715d7a2bc9a3:1",
            ]
        );
    }

    #[test]
    fn other_encodings_are_hashed_as_the_code_host_reads_them() {
        let ansi = view("a.awl", "// Größe\n", "windows-1252");
        let expected = Fingerprints::new("// Gr\u{fffd}\u{fffd}e\n").line(1);
        assert_eq!(Fingerprints::of(&ansi).line(1), expected);
        assert_eq!(length(&ansi), Some(9));
        let utf8 = view("a.awl", "// Größe\n", "utf-8");
        assert_eq!(Fingerprints::of(&utf8).line(1), Fingerprints::new("// Größe\n").line(1));
        assert_eq!(length(&utf8), Some(11));
    }
}

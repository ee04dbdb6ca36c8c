//! Bytes to text and back.
//!
//! A byte order mark decides; without one, what is valid UTF-8 is UTF-8; everything else is Windows-1252, of which the
//! ISO 8859-1 of PL7 exchange files is a subset in practice. Short texts are guessed wrong now and then, so the
//! encoding is also a setting, and a text keeps the encoding it came in.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use memchr::{memchr, memchr2, memchr3, memchr3_iter};

/// How the characters of a file are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Encoding {
    Utf8,
    Utf16Le,
    Utf16Be,
    /// Western European Windows; ISO 8859-1 but for 27 characters in the range of the C1 controls.
    Windows1252,
    /// Cyrillic Windows.
    Windows1251,
    /// DOS, Western European.
    Ibm850,
    /// DOS, the original character set of the PC.
    Ibm437,
}

/// Upper halves of the DOS code pages, from the mapping tables that the Unicode Consortium publishes. The lower half
/// is ASCII.
const IBM850: [char; 128] = upper_half(
    "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø×ƒáíóúñÑªº¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµþÞÚÛÙýÝ¯´\
     \u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}",
);
const IBM437: [char; 128] = upper_half(
    "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜ¢£¥₧ƒáíóúñÑªº¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩\
     ≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
);

/// Spreads 128 characters of one, two or three bytes over a table. Evaluated by the compiler.
const fn upper_half(characters: &str) -> [char; 128] {
    let bytes = characters.as_bytes();
    let mut table = ['\0'; 128];
    let (mut at, mut n) = (0, 0);
    while at < bytes.len() {
        let (len, lead) = match bytes[at] {
            0x00..=0x7f => (1, bytes[at] as u32),
            0x80..=0xdf => (2, (bytes[at] & 0x1f) as u32),
            _ => (3, (bytes[at] & 0x0f) as u32),
        };
        let mut scalar = lead;
        let mut i = 1;
        while i < len {
            scalar = scalar << 6 | (bytes[at + i] & 0x3f) as u32;
            i += 1;
        }
        table[n] = match char::from_u32(scalar) {
            Some(character) => character,
            None => panic!("a string holds scalar values only"),
        };
        at += len;
        n += 1;
    }
    assert!(n == 128);
    table
}

impl Encoding {
    pub const ALL: [Self; 7] =
        [Self::Utf8, Self::Utf16Le, Self::Utf16Be, Self::Windows1252, Self::Windows1251, Self::Ibm850, Self::Ibm437];

    /// The name under which reports and settings know the encoding.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Utf8 => "utf-8",
            Self::Utf16Le => "utf-16le",
            Self::Utf16Be => "utf-16be",
            Self::Windows1252 => "windows-1252",
            Self::Windows1251 => "windows-1251",
            Self::Ibm850 => "cp850",
            Self::Ibm437 => "cp437",
        }
    }

    /// Reads the value of the option `encoding`. `auto` is no encoding: the bytes decide.
    ///
    /// # Errors
    /// The name is none that plclint knows.
    pub fn parse_option(name: &str) -> Result<Option<Self>, UnknownEncoding> {
        if name.trim().eq_ignore_ascii_case("auto") { Ok(None) } else { name.parse().map(Some) }
    }

    /// Whether each character is one byte of the file.
    pub fn is_single_byte(self) -> bool {
        match self {
            Self::Utf8 | Self::Utf16Le | Self::Utf16Be => false,
            Self::Windows1252 | Self::Windows1251 | Self::Ibm850 | Self::Ibm437 => true,
        }
    }

    /// The mark that files in this encoding may begin with; empty where there is none.
    pub fn byte_order_mark(self) -> &'static [u8] {
        match self {
            Self::Utf8 => b"\xef\xbb\xbf",
            Self::Utf16Le => b"\xff\xfe",
            Self::Utf16Be => b"\xfe\xff",
            Self::Windows1252 | Self::Windows1251 | Self::Ibm850 | Self::Ibm437 => b"",
        }
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A name of an encoding that plclint does not know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownEncoding(pub String);

impl fmt::Display for UnknownEncoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown encoding `{}`, expected auto", self.0)?;
        Encoding::ALL.iter().try_for_each(|encoding| write!(f, ", {encoding}"))
    }
}

impl std::error::Error for UnknownEncoding {}

impl FromStr for Encoding {
    type Err = UnknownEncoding;

    fn from_str(name: &str) -> Result<Self, UnknownEncoding> {
        Ok(match name.trim().to_ascii_lowercase().as_str() {
            "utf-8" | "utf8" => Self::Utf8,
            "utf-16le" | "utf-16-le" | "utf16le" => Self::Utf16Le,
            "utf-16be" | "utf-16-be" | "utf16be" => Self::Utf16Be,
            "windows-1252" | "cp1252" | "1252" | "iso-8859-1" | "latin1" | "latin-1" => Self::Windows1252,
            "windows-1251" | "cp1251" | "1251" => Self::Windows1251,
            "cp850" | "ibm850" | "850" => Self::Ibm850,
            "cp437" | "ibm437" | "437" => Self::Ibm437,
            _ => return Err(UnknownEncoding(name.to_owned())),
        })
    }
}

/// The text of a file, and how it was stored.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SourceText {
    /// Without the byte order mark. Line breaks are those of the file.
    pub text: Arc<str>,
    pub encoding: Encoding,
    /// Whether the file began with a byte order mark.
    pub bom: bool,
    /// Some bytes mean nothing in the encoding. They stand in the text as U+FFFD, or as the control character of the
    /// same number.
    pub malformed: bool,
    /// Some of the text was stored as UTF-8 and some not: accented letters read as two or three others.
    pub mixed: bool,
}

/// Turns the bytes of a file into text: those of a byte order mark, then of `forced`, then of UTF-8 if it is valid,
/// then of Windows-1252. Total for all bytes.
///
/// The text is at most three times as long as the bytes.
pub fn decode(bytes: &[u8], forced: Option<Encoding>) -> SourceText {
    let marked = [Encoding::Utf8, Encoding::Utf16Le, Encoding::Utf16Be]
        .into_iter()
        .find(|encoding| bytes.starts_with(encoding.byte_order_mark()));
    let bytes = marked.map_or(bytes, |encoding| bytes.get(encoding.byte_order_mark().len()..).unwrap_or_default());
    let bom = marked.is_some();
    let source = |text: Arc<str>, encoding, malformed| SourceText { text, encoding, bom, malformed, mixed: false };

    match marked.or(forced) {
        None => match std::str::from_utf8(bytes) {
            Ok(text) => source(text.into(), Encoding::Utf8, false),
            Err(_) => {
                let mixed = mixes_utf8(bytes);
                let decoded = decode_as(bytes, Encoding::Windows1252);
                SourceText { mixed, ..source(decoded.0, Encoding::Windows1252, decoded.1) }
            }
        },
        Some(encoding) => {
            let (text, malformed) = decode_as(bytes, encoding);
            source(text, encoding, malformed)
        }
    }
}

/// The text, and whether some bytes mean nothing in the encoding.
fn decode_as(bytes: &[u8], encoding: Encoding) -> (Arc<str>, bool) {
    let standard = match encoding {
        Encoding::Utf8 => encoding_rs::UTF_8,
        Encoding::Utf16Le => encoding_rs::UTF_16LE,
        Encoding::Utf16Be => encoding_rs::UTF_16BE,
        Encoding::Windows1252 => encoding_rs::WINDOWS_1252,
        Encoding::Windows1251 => encoding_rs::WINDOWS_1251,
        Encoding::Ibm850 => return (decode_table(bytes, &IBM850), false),
        Encoding::Ibm437 => return (decode_table(bytes, &IBM437), false),
    };
    let (text, replaced) = standard.decode_without_bom_handling(bytes);
    // The encoding standard gives a meaning to the five bytes that Windows-1252, and the one that Windows-1251 leaves
    // undefined.
    let undefined = match encoding {
        Encoding::Windows1252 => memchr3(0x81, 0x8d, 0x8f, bytes).is_some() || memchr2(0x90, 0x9d, bytes).is_some(),
        Encoding::Windows1251 => memchr(0x98, bytes).is_some(),
        _ => false,
    };
    (text.into(), replaced || undefined)
}

fn decode_table(bytes: &[u8], upper: &[char; 128]) -> Arc<str> {
    let mut text = String::with_capacity(bytes.len());
    text.extend(bytes.iter().map(|&byte| match byte {
        0x00..=0x7f => char::from(byte),
        _ => upper[usize::from(byte & 0x7f)],
    }));
    text.into()
}

/// Whether bytes that are not valid UTF-8 hold sequences that can hardly be anything else: Latin-1 letters, no-break
/// space, guillemets and general punctuation stored as UTF-8. As Windows-1252 these would read `Ã©`, `Â«`, `â€™`.
fn mixes_utf8(bytes: &[u8]) -> bool {
    memchr3_iter(0xc2, 0xc3, 0xe2, bytes).any(|at| match bytes.get(at..) {
        Some([0xc2, 0xa0..=0xbf, ..] | [0xc3, 0x80..=0xbf, ..]) => true,
        Some([0xe2, 0x80, last @ 0x80..=0xbf, ..]) => (0x90..=0xba).contains(last),
        _ => false,
    })
}

/// A character that an encoding cannot store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unmappable(pub char);

impl fmt::Display for Unmappable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the file's encoding has no character `{}`", self.0.escape_debug())
    }
}

impl std::error::Error for Unmappable {}

/// Turns text back into the bytes of a file.
///
/// # Errors
/// The encoding does not have one of the characters; nothing is replaced.
pub fn encode(text: &str, encoding: Encoding, bom: bool) -> Result<Vec<u8>, Unmappable> {
    let mut bytes = Vec::with_capacity(text.len() + 3);
    if bom {
        bytes.extend_from_slice(encoding.byte_order_mark());
    }
    match encoding {
        Encoding::Utf8 => bytes.extend_from_slice(text.as_bytes()),
        Encoding::Utf16Le => bytes.extend(text.encode_utf16().flat_map(u16::to_le_bytes)),
        Encoding::Utf16Be => bytes.extend(text.encode_utf16().flat_map(u16::to_be_bytes)),
        Encoding::Windows1252 => encode_standard(text, encoding_rs::WINDOWS_1252, &mut bytes)?,
        Encoding::Windows1251 => encode_standard(text, encoding_rs::WINDOWS_1251, &mut bytes)?,
        Encoding::Ibm850 => encode_table(text, &IBM850, &mut bytes)?,
        Encoding::Ibm437 => encode_table(text, &IBM437, &mut bytes)?,
    }
    Ok(bytes)
}

fn encode_standard(
    text: &str,
    standard: &'static encoding_rs::Encoding,
    bytes: &mut Vec<u8>,
) -> Result<(), Unmappable> {
    let mut encoder = standard.new_encoder();
    let mut rest = text;
    loop {
        let (result, read) = encoder.encode_from_utf8_to_vec_without_replacement(rest, bytes, true);
        match result {
            encoding_rs::EncoderResult::InputEmpty => return Ok(()),
            encoding_rs::EncoderResult::Unmappable(character) => return Err(Unmappable(character)),
            encoding_rs::EncoderResult::OutputFull => {
                rest = rest.get(read..).unwrap_or_default();
                bytes.reserve(rest.len() + 16);
            }
        }
    }
}

fn encode_table(text: &str, upper: &[char; 128], bytes: &mut Vec<u8>) -> Result<(), Unmappable> {
    for character in text.chars() {
        let byte = match u8::try_from(character) {
            Ok(ascii @ 0x00..=0x7f) => ascii,
            _ => match upper.iter().position(|&other| other == character) {
                Some(index) => 0x80 | index as u8,
                None => return Err(Unmappable(character)),
            },
        };
        bytes.push(byte);
    }
    Ok(())
}

/// How much of a file is looked at to tell text from other data.
const BINARY_SAMPLE: usize = 8 * 1024;

/// Whether bytes are data rather than text: over 3 % of the start are control characters that no text has. A stray NUL
/// in a long text, tabs, form feeds and the end-of-file mark of DOS are text. Bytes that begin with the byte order mark
/// of UTF-16 are text.
pub fn looks_binary(bytes: &[u8]) -> bool {
    if bytes.starts_with(Encoding::Utf16Le.byte_order_mark()) || bytes.starts_with(Encoding::Utf16Be.byte_order_mark())
    {
        return false;
    }
    let sample = bytes.get(..BINARY_SAMPLE).unwrap_or(bytes);
    let controls = sample.iter().filter(|byte| matches!(byte, 0x00..=0x08 | 0x0e..=0x19 | 0x1c..=0x1f | 0x7f)).count();
    controls * 32 > sample.len()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[track_caller]
    fn check(bytes: &[u8], forced: Option<Encoding>, text: &str, encoding: Encoding, bom: bool) {
        let source = decode(bytes, forced);
        assert_eq!((&*source.text, source.encoding, source.bom), (text, encoding, bom));
        assert!(!source.malformed);
        assert_eq!(encode(&source.text, encoding, bom).as_deref(), Ok(bytes));
    }

    #[test]
    fn bytes_decide() {
        check(b"", None, "", Encoding::Utf8, false);
        check(b"U E 0.0\r\n", None, "U E 0.0\r\n", Encoding::Utf8, false);
        check("« été »".as_bytes(), None, "« été »", Encoding::Utf8, false);
        check(b"\xef\xbb\xbfA", None, "A", Encoding::Utf8, true);
        check(b"\xef\xbb\xbf", None, "", Encoding::Utf8, true);
        check(b"\xff\xfeU\0\xe9\0", None, "Ué", Encoding::Utf16Le, true);
        check(b"\xfe\xff\0U\xd8\x3d\xde\x00", None, "U😀", Encoding::Utf16Be, true);
        check(b"\xe9t\xe9 \x80", None, "été €", Encoding::Windows1252, false);
    }

    #[test]
    fn settings_decide_unless_there_is_a_mark() {
        check(b"\x82t\x82", Some(Encoding::Ibm850), "été", Encoding::Ibm850, false);
        check(b"\x9c\xe3\xff", Some(Encoding::Ibm437), "£π\u{a0}", Encoding::Ibm437, false);
        check(b"\xcf\xf3\xf1\xea", Some(Encoding::Windows1251), "Пуск", Encoding::Windows1251, false);
        check("é".as_bytes(), Some(Encoding::Windows1252), "Ã©", Encoding::Windows1252, false);
        check(b"A\0", Some(Encoding::Utf16Le), "A", Encoding::Utf16Le, false);
        check(b"\xef\xbb\xbf\xc3\xa9", Some(Encoding::Windows1252), "é", Encoding::Utf8, true);
    }

    #[test]
    fn tables_agree_with_the_standard_where_they_should() {
        // Both pages hold the same letters in the first half of their upper half, and box drawing in place.
        assert_eq!((IBM850[0], IBM850[2], IBM850[0x7f]), ('Ç', 'é', '\u{a0}'));
        assert_eq!((IBM850[0x44], IBM437[0x44], IBM437[0x61]), ('─', '─', 'ß'));
        for table in [&IBM850, &IBM437] {
            let mut sorted = *table;
            sorted.sort_unstable();
            assert!(sorted.windows(2).all(|pair| pair[0] < pair[1] && pair[0] > '\u{7f}'));
        }
    }

    #[test]
    fn malformed_text_is_said_to_be() {
        for (bytes, forced, text) in [
            (&b"\xef\xbb\xbfa\xe9b"[..], None, "a\u{fffd}b"),
            (b"a\xe9b", Some(Encoding::Utf8), "a\u{fffd}b"),
            (b"\xff\xfeA\0B", None, "A\u{fffd}"),
            (b"\xff\xfe\x00\xd8A\0", None, "\u{fffd}A"),
            (b"\xe9\x81", None, "é\u{81}"),
            (b"\x98", Some(Encoding::Windows1251), "\u{98}"),
        ] {
            let source = decode(bytes, forced);
            assert_eq!((&*source.text, source.malformed), (text, true));
        }
    }

    #[test]
    fn mixed_encodings_are_noticed() {
        let mixed = |bytes: &[u8]| decode(bytes, None).mixed;
        assert!(mixed("// é en UTF-8".as_bytes().iter().copied().chain(*b" \xe9").collect::<Vec<_>>().as_slice()));
        assert!(mixed(b"\xe2\x80\x99 \xe9"));
        assert!(!mixed(b"\xe9t\xe9"));
        assert!(!mixed(b"\xabACTIVIT\xc9\xbb"), "É» is no UTF-8 of a text in Latin letters");
        assert!(!mixed("été".as_bytes()));
    }

    #[test]
    fn encoding_refuses_what_it_cannot_store() {
        assert_eq!(encode("a→", Encoding::Windows1252, false), Err(Unmappable('→')));
        assert_eq!(encode("ж", Encoding::Ibm850, false), Err(Unmappable('ж')));
        assert_eq!(encode("Ж", Encoding::Windows1251, false).as_deref(), Ok(&b"\xc6"[..]));
    }

    #[test]
    fn option_names() {
        assert_eq!(Encoding::parse_option("auto"), Ok(None));
        assert_eq!(Encoding::parse_option("CP1251"), Ok(Some(Encoding::Windows1251)));
        for encoding in Encoding::ALL {
            assert_eq!(Encoding::parse_option(encoding.as_str()), Ok(Some(encoding)));
        }
        let error = Encoding::parse_option("ebcdic").unwrap_err();
        assert!(error.to_string().starts_with("unknown encoding `ebcdic`, expected auto, utf-8"));
    }

    #[test]
    fn binary_data() {
        for text in [
            &b""[..],
            b"U E 0.0\r\n\t= A 4.0\x0c\x1a",
            b"\xff\xfeU\0 \0E\0",
            "« été » пуск".as_bytes(),
            b"A long enough text may have one stray NUL at the end of its only line.\0",
        ] {
            assert!(!looks_binary(text));
        }
        for data in [&b"PK\x03\x04\x14\0\0\0\x08\0"[..], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"U\0 \0E\0", b"\0"] {
            assert!(looks_binary(data));
        }
    }

    proptest! {
        #[test]
        fn every_byte_string_has_a_text(bytes: Vec<u8>) {
            for forced in [None].into_iter().chain(Encoding::ALL.map(Some)) {
                let source = decode(&bytes, forced);
                prop_assert!(source.text.len() <= 3 * bytes.len());
                if !source.malformed {
                    let encoded = encode(&source.text, source.encoding, source.bom);
                    prop_assert_eq!(encoded.as_deref(), Ok(&bytes[..]));
                }
            }
        }

        #[test]
        fn every_text_survives_unicode(text: String, bom: bool) {
            for encoding in [Encoding::Utf8, Encoding::Utf16Le, Encoding::Utf16Be] {
                let bytes = encode(&text, encoding, bom).unwrap();
                let source = decode(&bytes, Some(encoding));
                if bom || !text.starts_with(['\u{feff}', '\u{fffe}']) {
                    prop_assert_eq!(&*source.text, &text);
                    prop_assert_eq!((source.bom, source.malformed), (bom, false));
                }
            }
        }
    }
}

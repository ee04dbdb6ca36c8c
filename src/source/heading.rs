//! The lines that say where a unit starts, ends and what it holds.

use smol_str::SmolStr;

use crate::model::entity::{BlockKind, BlockName, Entity, Part, Task};

/// Splits off the first word: letters, digits and underscores.
pub(super) fn word(text: &str) -> (&str, &str) {
    const IS_PART: [bool; 256] = {
        let mut is_part = [false; 256];
        let mut byte = 0;
        while byte < is_part.len() {
            is_part[byte] = (byte as u8).is_ascii_alphanumeric() || byte as u8 == b'_';
            byte += 1;
        }
        is_part
    };
    let ascii = text.bytes().position(|it| !IS_PART[usize::from(it)]).unwrap_or(text.len());
    // Nearly all words end at a sign or a blank.
    let more = match text.as_bytes().get(ascii) {
        Some(it) if !it.is_ascii() => {
            let rest = text.get(ascii..).unwrap_or_default();
            rest.find(|it: char| !it.is_alphanumeric() && it != '_').unwrap_or(rest.len())
        }
        _ => 0,
    };
    text.split_at(ascii + more)
}

/// What follows `prefix`, in any case, at the start of `text`.
pub(super) fn strip_prefix_ignore_case<'t>(text: &'t str, prefix: &str) -> Option<&'t str> {
    let start = text.get(..prefix.len())?;
    if start.eq_ignore_ascii_case(prefix) { text.get(prefix.len()..) } else { None }
}

/// Splits off a decimal number. One that no controller has is as large as can be.
fn number(text: &str) -> Option<(u32, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    (!digits.is_empty()).then(|| (digits.parse().unwrap_or(u32::MAX), rest))
}

const BLOCK_KEYWORDS: [(&str, BlockKind); 5] = [
    ("ORGANIZATION_BLOCK", BlockKind::Ob),
    ("FUNCTION_BLOCK", BlockKind::Fb),
    ("FUNCTION", BlockKind::Fc),
    ("DATA_BLOCK", BlockKind::Db),
    ("TYPE", BlockKind::Udt),
];

/// Reads the header of a STEP 7 block at the start of a line: `FUNCTION FC 1 : VOID`, `DATA_BLOCK "Data"`.
///
/// A name without number or quotes is one only if nothing but a type follows, so that no text that happens to start
/// with `function` or `type` is a header.
pub(super) fn block_header(line: &str) -> Option<Entity> {
    if !matches!(line.as_bytes().first()? | 0x20, b'o' | b'f' | b'd' | b't') {
        return None;
    }
    let (keyword, rest) = word(line);
    let &(_, kind) = BLOCK_KEYWORDS.iter().find(|(name, _)| name.eq_ignore_ascii_case(keyword))?;
    if !rest.starts_with(|c: char| c.is_whitespace() || c == '"') {
        return None;
    }
    let rest = rest.trim_start();
    if let Some((name, _)) = numbered_block(rest) {
        return Some(Entity::Block { kind, name });
    }
    if let Some(quoted) = rest.strip_prefix('"') {
        let (name, _) = quoted.split_once('"')?;
        return (!name.is_empty()).then(|| Entity::Block { kind, name: symbol(name) });
    }
    let (name, rest) = word(rest);
    let rest = rest.trim_start();
    let complete = match rest.strip_prefix(':') {
        Some(result) if kind == BlockKind::Fc => {
            let result = result.trim_start();
            result.starts_with('"') || ends(word(result).1)
        }
        _ => kind != BlockKind::Fc && ends(rest),
    };
    let named = name.starts_with(|c: char| c.is_alphabetic() || c == '_') && complete;
    named.then(|| Entity::Block { kind, name: symbol(name) })
}

/// Whether nothing but a comment follows.
fn ends(rest: &str) -> bool {
    let rest = rest.trim_start();
    rest.is_empty() || rest.starts_with("//") || rest.starts_with("(*")
}

/// Symbols ignore case.
fn symbol(name: &str) -> BlockName {
    BlockName::Symbol(name.trim().to_lowercase().into())
}

/// `FC 1`, `fb1`, and what follows.
fn numbered_block(text: &str) -> Option<(BlockName, &str)> {
    let end = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (letters, rest) = text.split_at(end);
    let kind =
        [BlockKind::Ob, BlockKind::Fb, BlockKind::Fc, BlockKind::Db, BlockKind::Udt, BlockKind::Sfb, BlockKind::Sfc]
            .into_iter()
            .find(|kind| kind.as_str().eq_ignore_ascii_case(letters))?;
    let (number, rest) = number(rest.trim_start())?;
    (!rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')).then_some((BlockName::Number(kind, number), rest))
}

/// Reads the heading of a printed STEP 5 block: `PB 10`, `FB5`, `BAUSTEIN : OB 1`, alone on its line or with what a print
/// says of it behind (`LAE=22`).
pub(super) fn step5_heading(line: &str) -> Option<Entity> {
    if !line.starts_with(|it: char| it.is_ascii_alphabetic()) {
        return None;
    }
    let names: &[&str] = if line.starts_with(['B', 'b']) { &["BAUSTEIN", "BLOCK", "BLOC", "BLOQUE"] } else { &[] };
    let named = names.iter().find_map(|it| {
        let rest = strip_prefix_ignore_case(line, it)?;
        rest.starts_with([' ', '\t', ':']).then(|| rest.trim_start())
    });
    let name = named.map_or(line, |it| it.strip_prefix(':').map_or(it, str::trim_start));
    let end = name.find(|it: char| !it.is_ascii_alphabetic())?;
    let (letters, rest) = name.split_at(end);
    let kind = BlockKind::of(letters).filter(|it| STEP5_BLOCKS.contains(it))?;
    let (number, rest) = number(rest.trim_start_matches([' ', '\t']))?;
    let rest = rest.trim_start();
    let (key, value) = word(rest);
    let ends = rest.is_empty()
        || rest == ":"
        || rest.starts_with(',')
        || !key.is_empty() && value.trim_start().starts_with('=');
    ends.then_some(Entity::Block { kind, name: BlockName::Number(kind, number) })
}

const STEP5_BLOCKS: [BlockKind; 7] =
    [BlockKind::Ob, BlockKind::Pb, BlockKind::Sb, BlockKind::Fb, BlockKind::Fx, BlockKind::Db, BlockKind::Dx];

/// What of a line of STEP 5 stands before its comment.
pub(super) fn step5_code(line: &str) -> &str {
    let bytes = line.as_bytes();
    let is_comment = |&at: &usize| bytes.get(at) == Some(&b';') || bytes.get(at + 1) == Some(&b'/');
    let end = memchr::memchr2_iter(b';', b'/', bytes).find(is_comment).unwrap_or(line.len());
    line.get(..end).unwrap_or_default().trim()
}

/// What follows the keyword that ends a STEP 7 block, if a line starts with one.
pub(super) fn block_end(line: &str) -> Option<&str> {
    if !line.starts_with(['E', 'e']) {
        return None;
    }
    let rest = strip_prefix_ignore_case(line, "END_")?;
    let (keyword, rest) = word(rest);
    BLOCK_KEYWORDS.iter().any(|(name, _)| name.eq_ignore_ascii_case(keyword)).then_some(rest)
}

/// Reads a line that names the listing after it, as courses and documents write: `Bloc FC1 :`, `Block OB 1`,
/// `Bloc OB1 (ou autre bloc appelant) :` (S7:838, 1316).
pub(super) fn listing_name(line: &str) -> Option<Entity> {
    if !matches!(line.as_bytes().first()? | 0x20, b'b') {
        return None;
    }
    let (keyword, rest) = word(line);
    if !["BLOC", "BLOCK", "BAUSTEIN"].iter().any(|name| name.eq_ignore_ascii_case(keyword)) {
        return None;
    }
    let (name, rest) = numbered_block(rest.trim_start())?;
    let mut rest = rest.trim_start();
    if let Some(remark) = rest.strip_prefix('(') {
        rest = remark.split_once(')')?.1.trim_start();
    }
    let rest = rest.strip_prefix(':').unwrap_or(rest);
    let BlockName::Number(kind, _) = name else { return None };
    ends(rest).then_some(Entity::Block { kind, name })
}

/// The language word of a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HeadingLanguage {
    Ladder,
    Il,
    St,
    Grafcet,
}

/// A heading in the form that the PL7 manual gives to the parts of a program (PL7:422, 4549).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Heading {
    pub(super) language: HeadingLanguage,
    pub(super) entity: Entity,
    /// The part belongs to a PL7-2 program.
    pub(super) pl7_2: bool,
}

/// Reads `ST : MAST - SR10`, `IL : MAST - Peinture - PRL`, `ST : EVT3`.
pub(super) fn pl7_heading(line: &str) -> Option<Heading> {
    if !matches!(line.as_bytes().first()? | 0x20, b's' | b'i' | b'l' | b'g') {
        return None;
    }
    let (name, rest) = word(line);
    let address = rest.trim_start().strip_prefix(':')?.trim();
    let languages = [
        ("LD", HeadingLanguage::Ladder),
        ("IL", HeadingLanguage::Il),
        ("ST", HeadingLanguage::St),
        ("GR7", HeadingLanguage::Grafcet),
    ];
    let (_, language) = languages.into_iter().find(|(language, _)| language.eq_ignore_ascii_case(name))?;
    if let Some(module) = strip_prefix_ignore_case(address, "PL7-2") {
        return Some(Heading { language, entity: pl7_2_entity(module)?, pl7_2: true });
    }
    Some(Heading { language, entity: pl7_address(address)?, pl7_2: false })
}

/// The module of a PL7-2 program: preliminary, sequential and posterior processing of the master task (PL72:1505-1511), or a
/// whole task. Of the sequential processing, what follows names the step or the transition: `SEQ - X3`, `SEQ - X3 --> X4`.
pub(super) fn pl7_2_entity(module: &str) -> Option<Entity> {
    let (first, rest) = address_word(module);
    let (task, part) = match first.to_ascii_uppercase().as_str() {
        "" | "MAST" => (Task::Mast, Part::Main),
        "PRL" => (Task::Mast, Part::Preliminary),
        "SEQ" => (Task::Mast, Part::Chart(chart("SEQ", rest))),
        "POST" => (Task::Mast, Part::Posterior),
        "FAST" => (Task::Fast, Part::Main),
        _ => return None,
    };
    let is_whole = rest.is_empty() || matches!(part, Part::Chart(_));
    is_whole.then_some(Entity::Pl7 { task, section: None, part })
}

/// Reads an address in the vendor's own form, as settings, exchange files and headings write it: `MAST SR3`,
/// `MAST - Peinture - PRL`, `EVT3`, `MAST 'Chart'`, `PL7-2 PRL`, `OB1`, `FC 12`.
pub fn entity_from_address(address: &str) -> Option<Entity> {
    let address = address.trim();
    if let Some(module) = strip_prefix_ignore_case(address, "PL7-2") {
        return pl7_2_entity(module);
    }
    if let Some((name @ BlockName::Number(kind, _), rest)) = numbered_block(address) {
        return rest.trim().is_empty().then_some(Entity::Block { kind, name });
    }
    pl7_address(address)
}

pub(super) fn pl7_address(address: &str) -> Option<Entity> {
    let (task, rest) = task(address)?;
    let (first, rest) = address_word(rest);
    let (section, part) = match (task, first) {
        (_, "") if !rest.is_empty() => return None,
        (Task::Event(_), "") => (None, Part::Event),
        (Task::Event(_), main) if main.eq_ignore_ascii_case("MAIN") && rest.is_empty() => (None, Part::Event),
        (Task::Event(_), _) => return None,
        (_, "") => (None, Part::Main),
        (_, first) => match part(first, rest) {
            Some(part) => (None, part),
            None => {
                let (second, rest) = address_word(rest);
                let part = if second.is_empty() { Part::Main } else { part(second, rest)? };
                if first.is_empty() || !rest.is_empty() && !matches!(part, Part::Chart(_)) {
                    return None;
                }
                (Some(SmolStr::new(first)), part)
            }
        },
    };
    Some(Entity::Pl7 { task, section, part })
}

/// Splits off the task. Blanks after it may be missing where a quote or hyphen follows.
fn task(address: &str) -> Option<(Task, &str)> {
    let (first, rest) = word(address);
    let task = match first.to_ascii_uppercase().as_str() {
        "MAST" => Task::Mast,
        "FAST" => Task::Fast,
        name => {
            let digits = name.strip_prefix("EVT").filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()))?;
            Task::Event(digits.parse().ok()?)
        }
    };
    Some((task, rest))
}

/// Splits off a word of an address with the blanks, hyphens and quotes around it.
fn address_word(text: &str) -> (&str, &str) {
    let between = |c: char| c.is_whitespace() || matches!(c, '-' | '\'' | '"');
    let (first, rest) = word(text.trim_start_matches(between));
    if rest.starts_with(|c| !between(c)) {
        return ("", text);
    }
    (first, rest.trim_start_matches(between))
}

/// The part of a section or task that the last words of an address say.
fn part(first: &str, rest: &str) -> Option<Part> {
    let upper = first.to_ascii_uppercase();
    let numbered = |prefix| upper.strip_prefix(prefix).and_then(|digits: &str| digits.parse::<u32>().ok());
    let part = match upper.as_str() {
        "MAIN" => Part::Main,
        "PRL" => Part::Preliminary,
        "POST" => Part::Posterior,
        "CHART" => return Some(Part::Chart(chart("CHART", rest))),
        _ => match (numbered("SR"), numbered("MACRO")) {
            (Some(number), _) => Part::Subroutine(number),
            (_, Some(_)) => return Some(Part::Chart(chart(&upper, rest))),
            (None, None) => return None,
        },
    };
    rest.is_empty().then_some(part)
}

fn chart(first: &str, rest: &str) -> SmolStr {
    if rest.is_empty() { first.into() } else { SmolStr::from(format!("{first} - {}", rest.trim_end())) }
}

/// The blocks of a PL7 exchange file.
pub(super) const EXCHANGE_BLOCKS: [&str; 6] =
    ["[HEADER]", "[APPLICATION]", "[VENDOR]", "[SOURCE_UNIT]", "[DATA_UNIT]", "[EOF]"];

/// The name, in brackets, of the exchange file block that a line starts, and what follows.
pub(super) fn exchange_block(line: &str) -> Option<(&'static str, &str)> {
    let inner = line.strip_prefix('[')?;
    let (name, rest) = word(inner.trim_start());
    let rest = rest.trim_start().strip_prefix(']')?;
    let block = EXCHANGE_BLOCKS.into_iter().find(|block| block[1..block.len() - 1].eq_ignore_ascii_case(name))?;
    Some((block, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn shows(entity: Option<Entity>, expected: Option<&str>) {
        assert_eq!(entity.map(|entity| entity.to_string()).as_deref(), expected);
    }

    #[test]
    fn block_headers() {
        for (line, expected) in [
            ("ORGANIZATION_BLOCK OB 1", Some("OB1")),
            ("function fc1:void title = x", Some("FC1")),
            ("FUNCTION FC 1 : VOID", Some("FC1")),
            ("FUNCTION_BLOCK \"Schrittkette 3 (Greifer)\"", Some("FB \"schrittkette 3 (greifer)\"")),
            ("FUNCTION_BLOCK\"A\"", Some("FB \"a\"")),
            ("DATA_BLOCK DB 2 FB 1", Some("DB2")),
            ("TYPE UDT 1", Some("UDT1")),
            ("FUNCTION SFC 46 : INT", Some("SFC46")),
            ("FUNCTION_BLOCK Motor // x", Some("FB \"motor\"")),
            ("FUNCTION Sum : INT", Some("FC \"sum\"")),
            ("FUNCTION Sum : \"Record\"", Some("FC \"sum\"")),
            ("FUNCTIONS FC 1", None),
            ("type : INT;", None),
            ("TYPE", None),
            ("TYPE = 1", None),
            ("Function of the block FC 1", None),
            ("DATA_BLOCK DB 99999999999", Some("DB4294967295")),
            ("FUNCTION FC1a", None),
            ("FUNCTION \"open", None),
            ("FUNCTION \"\"", None),
            ("DATA_BLOCK é", Some("DB \"é\"")),
            ("T MW 10", None),
            ("", None),
        ] {
            shows(block_header(line), expected);
        }
        assert_eq!(block_end("End_Function_Block // x"), Some(" // x"));
        assert_eq!(block_end("END_VAR"), None);
    }

    #[test]
    fn listing_names() {
        for (line, expected) in [
            ("Bloc FC1 :", Some("FC1")),
            ("Block OB 1:", Some("OB1")),
            ("Bloc OB100", Some("OB100")),
            ("bloc OB1 (ou autre bloc appelant) :", Some("OB1")),
            ("Bloc FC1 // initialisation", Some("FC1")),
            ("Bloc FC1 appelle FC2 :", None),
            ("Blocs FC1", None),
            ("Bloc OB1 (", None),
            ("BLD 103", None),
        ] {
            shows(listing_name(line), expected);
        }
    }

    #[test]
    fn pl7_headings() {
        for (line, expected) in [
            ("ST : MAST - SR10", Some("MAST - SR10")),
            ("IL:MAST-Peinture-PRL", Some("MAST - Peinture - PRL")),
            ("ST : EVT3", Some("EVT3")),
            ("ST : MAST - MAIN", Some("MAST - MAIN")),
            ("LD : FAST - Découpe", Some("FAST - Découpe")),
            ("ST : MAST - Peinture - CHART - PAGE 0 %X1 P1", Some("MAST - Peinture - CHART - PAGE 0 %X1 P1")),
            (
                "st : mast - Peinture - chart - PAGE 0 %X(0) --> %X(1)",
                Some("MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)"),
            ),
            ("ST : MAST - Peinture - MACRO2 - PAGE 0 %X2.1 N1", Some("MAST - Peinture - MACRO2 - PAGE 0 %X2.1 N1")),
            ("LD : PL7-2 - POST", Some("MAST - POST")),
            ("LD : PL7-2 - SEQ", Some("MAST - SEQ")),
            ("LD : PL7-2 - SEQ - X3", Some("MAST - SEQ - X3")),
            ("ld:pl7-2 - seq - X3 --> X4", Some("MAST - SEQ - X3 --> X4")),
            ("LD : PL7-2 - PRL", Some("MAST - PRL")),
            ("LD : PL7-2 - MAST", Some("MAST - MAIN")),
            ("GR7 : PL7-2 - SEQ", Some("MAST - SEQ")),
            ("LD : PL7-2 - FAST", Some("FAST - MAIN")),
            ("LD : PL7-2", Some("MAST - MAIN")),
            ("LD : PL7-2 - PRL - X3", None),
            ("LD : PL7-2 - SR1", None),
            ("LD : PL7-2 (x)", None),
            ("LD : PL7-20", None),
            ("ST : MAST - a b c", None),
            ("ST : MAST - Peinture - SR1x", None),
            ("ST : MASTER", None),
            ("ST : EVT", None),
            ("ST : EVT70000", None),
            ("ST := MAST", None),
            ("LD %M0", None),
            ("ST :", None),
        ] {
            shows(pl7_heading(line).map(|heading| heading.entity), expected);
        }
        assert!(pl7_heading("LD : PL7-2 - POST").unwrap().pl7_2);
    }

    #[test]
    fn addresses() {
        for (address, expected) in [
            ("MAST SR1", Some("MAST - SR1")),
            ("FAST MAIN", Some("FAST - MAIN")),
            ("MAST Chart", Some("MAST - CHART")),
            ("MAST'Chart'", Some("MAST - CHART")),
            ("MAST MACRO2", Some("MAST - MACRO2")),
            ("EVT3", Some("EVT3")),
            ("EVT3 MAIN", Some("EVT3")),
            ("mast Peinture post", Some("MAST - Peinture - POST")),
            ("PL7-2 PRL", Some("MAST - PRL")),
            ("OB1", Some("OB1")),
            (" fc 12 ", Some("FC12")),
            ("FC 12 x", None),
            ("EVT3 SR1", None),
            ("MAST (x)", None),
            ("SR1", None),
            ("", None),
        ] {
            shows(entity_from_address(address), expected);
        }
    }

    #[test]
    fn exchange_blocks() {
        assert_eq!(exchange_block("[HEADER]"), Some(("[HEADER]", "")));
        assert_eq!(exchange_block("[ source_unit ] SU_TYPE = PROG"), Some(("[SOURCE_UNIT]", " SU_TYPE = PROG")));
        for line in ["[%MW0:=%MW1]", "[HEADER", "[HEADERS]", "HEADER]", "["] {
            assert_eq!(exchange_block(line), None);
        }
    }
}

//! Counts of the lines of a text by what they look like.

use std::borrow::Cow;

use super::super::heading::{
    HeadingLanguage, block_end, block_header, exchange_block, pl7_heading, step5_code, step5_heading,
    strip_prefix_ignore_case, word,
};
use super::lead::Lead;
use super::{Detected, Extension, Pl7Text, unsupported};
use crate::model::entity::{BlockKind, BlockName, Entity, Family};
use crate::model::object;
use crate::syntax::step5::symbols;

/// Whether a line declares a variable, with an address or a type.
fn is_variable(name: &str, rest: &str) -> bool {
    let rest = rest.trim_start();
    let address = strip_prefix_ignore_case(rest, "AT ").map(str::trim_start);
    !name.is_empty()
        && (rest.starts_with(':') || address.is_some_and(|it| it.starts_with('%') || declared_by_pl7_2(it)))
}

/// Whether a declaration, behind its `AT`, has an address that PL7-2 alone has: `B3`, `I0,05`.
fn declared_by_pl7_2(address: &str) -> bool {
    let end = address.find(|it: char| it.is_whitespace() || matches!(it, ':' | ';' | '(')).unwrap_or(address.len());
    let address = address.get(..end.min(LONGEST_PL7_2)).unwrap_or_default();
    address.starts_with(|it: char| it.is_ascii_alphabetic())
        && object::pl72::class_of(address).is_some_and(|it| it != object::Class::Fault)
}

/// Of this many lines of STEP 5 that STEP 7 has too, one is its own at least: the end of a segment, a call.
const STEP5_SHARE: u32 = 16;

/// What a text can be by its name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Kind {
    /// A symbol table: in any other file, nobody asks whether lines are rows of one.
    Table,
    #[default]
    Other,
}

/// Which of the signs that tell languages apart a line has. To look through it once costs less than to look for each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Signs(u32);

impl Signs {
    /// `//`
    const SLASHES: u32 = 1;
    /// `->`
    const ARROW: u32 = 1 << 1;
    /// `AT`, in any case.
    const AT: u32 = 1 << 2;
    /// `EB` and `R_`, in any case.
    const EB: u32 = 1 << 3;
    const R_: u32 = 1 << 4;
    /// `RE` or `FE`.
    const EDGE: u32 = 1 << 5;
    const PERCENT: u32 = 1 << 8;
    const COMMA: u32 = 1 << 9;
    const COLON: u32 = 1 << 10;
    const SEMICOLON: u32 = 1 << 11;
    /// A small letter, or what may be one.
    const SMALL: u32 = 1 << 12;

    /// The first bits are the signs of two bytes that a byte may end.
    const PAIRS: u32 = 0xFF;
    /// Where the signs of two bytes are that a byte may begin.
    const BEGINS: u32 = 16;

    const OF: [u32; 256] = {
        let mut of = [0; 256];
        let mut byte = 0;
        while byte < of.len() {
            of[byte] = match byte as u8 {
                b'/' => Self::SLASHES | Self::SLASHES << Self::BEGINS,
                b'-' => Self::ARROW << Self::BEGINS,
                b'>' => Self::ARROW,
                b'A' | b'a' => Self::AT << Self::BEGINS,
                b'T' | b't' => Self::AT,
                b'R' => (Self::R_ | Self::EDGE) << Self::BEGINS,
                b'r' => Self::R_ << Self::BEGINS,
                b'_' => Self::R_,
                b'F' => Self::EDGE << Self::BEGINS,
                b'E' => Self::EDGE | Self::EB << Self::BEGINS,
                b'e' => Self::EB << Self::BEGINS,
                b'B' | b'b' => Self::EB,
                b'%' => Self::PERCENT,
                b',' => Self::COMMA,
                b':' => Self::COLON,
                b';' => Self::SEMICOLON,
                _ => 0,
            };
            if byte >= 0x80 || (byte as u8).is_ascii_lowercase() {
                of[byte] |= Self::SMALL;
            }
            byte += 1;
        }
        of
    };

    pub(super) fn of(line: &str) -> Self {
        let add = |(signs, before): (u32, u32), it| {
            let own = Self::OF[usize::from(it)];
            (signs | own & (before >> Self::BEGINS | !Self::PAIRS), own)
        };
        Self(line.bytes().fold((0, 0), add).0)
    }

    fn has(self, sign: u32) -> bool {
        self.0 & sign != 0
    }
}

/// Counts of the lines of a text by what they look like. Comments and empty lines are not counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Tally {
    kind: Kind,
    pub(super) lines: u32,
    /// STEP 7 instructions with an operand of the right shape, or none where none is due.
    pub(super) step7: u32,
    /// The same with an operand that may be a symbol without quotes.
    step7_symbols: u32,
    /// PL7 instructions in IL; the same in ST.
    pub(super) il: u32,
    pub(super) st: u32,
    /// Lines with something that only PL7 has: `%MW10`, `%L5:`, `!` before a sentence.
    pub(super) pl7: u32,
    /// Lines with something that only PL7-2 has: `I0,05`, `T0,D`, `W1 -> W2`.
    pub(super) pl7_2: u32,
    /// Lines with an object that PL7-2 does not have, by its form: `%M5`, `%I1.0`.
    pub(super) not_pl7_2: u32,
    /// Headings of pasted PL7 text, by language.
    headings_il: u32,
    headings_st: u32,
    headings_ld: u32,
    headings_other: u32,
    /// Headings of PL7-2 text, in any language; the others do not count them.
    headings_pl7_2: u32,
    /// Exchange file blocks, and those among them that no other kind of file has.
    pub(super) blocks: u32,
    own_blocks: u32,
    /// Headers and ends of STEP 7 blocks.
    pub(super) block_headers: u32,
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
    pub(super) in_code_block: bool,
    /// Declaration sections and program units of IEC 61131-3.
    pub(super) iec: u32,
    /// `Pump AT %M0 : EBOOL;`
    pub(super) variables: u32,
    /// Words that frame rungs, and elements of them.
    pub(super) rung: u32,
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
    pub(super) symbols: u32,
    /// Those among them that name a block which only STEP 5 has.
    pub(super) step5_blocks: u32,
    /// Lines of a data interchange file: the words of its header, and marks of its rows.
    interchange: u32,
    pub(super) symbols_step5: u32,
    /// Natural language.
    pub(super) prose: u32,
    /// The text starts like XML, HTML or JSON.
    pub(super) markup: bool,
}

impl Tally {
    /// Of a text that starts so.
    pub(super) fn of_start(text: &str, kind: Kind) -> Self {
        Self { markup: text.trim_start().starts_with(['<', '{']), kind, ..Self::default() }
    }

    /// Of lines behind others.
    pub(super) fn behind(in_code_block: bool, kind: Kind) -> Self {
        Self { in_code_block, kind, ..Self::default() }
    }

    /// Counts what a line, as [`Lines`] cuts it, has besides blanks and comments. A line comment is none in PL7, but no PL7
    /// text has `//` outside of comments.
    pub(super) fn add_line(&mut self, code: &str) {
        let signs = Signs::of(code);
        let code = if signs.has(Signs::SLASHES) { before_line_comment(code) } else { code }.trim();
        // Parentheses and the dots of an omission alone mean nothing.
        // A semicolon starts a comment of STEP 5.
        if code.contains(|c: char| !matches!(c, ')' | '.' | '…')) && !(code.starts_with(';') && code.len() > 1) {
            self.add(code, signs);
        }
    }

    /// Goes on with what was counted behind it.
    pub(super) fn join(&mut self, behind: &Self) {
        macro_rules! sum {
            ($($count:ident)*) => {
                let Self { $($count,)* in_code_block, markup: _, kind: _ } = *behind;
                $(self.$count += $count;)*
                self.in_code_block = in_code_block;
            };
        }
        sum! {
            lines step7 step7_symbols il st pl7 pl7_2 not_pl7_2 headings_il headings_st headings_ld
            headings_other headings_pl7_2 blocks own_blocks block_headers block_ends dfb_headers dfb
            declarations step7_words scl iec variables rung cells chart pages chart_words steps graph step5
            symbols step5_blocks interchange symbols_step5 prose
        }
    }

    /// `signs`: at least those of the line.
    fn add(&mut self, line: &str, signs: Signs) {
        self.lines += 1;
        if self.kind == Kind::Table {
            self.add_row(line);
        }
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
            self.add_code(line, signs);
        }
    }

    fn add_row(&mut self, line: &str) {
        let of_step5 = is_step5_row(line);
        self.symbols += u32::from(of_step5 || is_symbol_row(line));
        self.step5_blocks += u32::from(of_step5);
        self.interchange += u32::from(matches!(line, "TABLE" | "VECTORS" | "TUPLES" | "BOT"));
        self.symbols_step5 += u32::from(symbols::row(line).is_some());
    }

    /// `line`: without blanks at its ends.
    fn add_code(&mut self, line: &str, signs: Signs) {
        let has_object = signs.has(Signs::PERCENT) && has_pl7_object(line);
        let is_pl7 = line.starts_with('!') || has_object;
        let code = strip_pl7_label(line.strip_prefix('!').unwrap_or(line).trim_start());
        let (name, rest) = word(code);
        let first = &*upper(name);
        let lead = Lead::of(first);
        self.pl7 += u32::from(is_pl7);
        self.add_operands(line, signs, has_object);
        self.dfb += u32::from(is_dfb_line(code, rest, lead, signs));
        self.variables += u32::from(signs.has(Signs::COLON | Signs::AT) && is_variable(name, rest));
        match pl7_statement(code, rest, lead, is_pl7) {
            Some(Pl7Text::Il) => self.il += 1,
            Some(Pl7Text::St) => {
                self.st += 1;
                self.scl += u32::from(self.in_code_block);
            }
            Some(Pl7Text::Ld | Pl7Text::Gr7 | Pl7Text::Sfc) | None => {}
        }
        if lead.is(Lead::RUNG) {
            self.rung += 1;
        } else if lead.is(Lead::CELL) {
            self.rung += 1;
            self.cells += 1;
        } else if lead.is(Lead::PAGE) {
            self.chart += 1;
            self.pages += 1;
        } else if lead.is(Lead::CHART) {
            self.chart += 1;
        } else if lead.is(Lead::CHART_LINE) && is_chart_line(first, rest) {
            self.chart_words += 1;
            self.steps += u32::from(first == "STEP");
        } else if lead.is(Lead::GRAPH) {
            self.graph += 1;
        } else if lead.is(Lead::IEC) {
            self.iec += 1;
        } else if lead.is(Lead::SECTION) {
            self.iec += 1;
            self.declarations += 1;
        } else if lead.is(Lead::STEP7) {
            self.declarations += 1;
            self.step7_words += 1;
        } else if lead.is(Lead::SCL) {
            self.scl += 1;
        } else if is_step5(code, signs) {
            self.step5 += 1;
        } else if is_step7_instruction(code, signs) {
            self.step7 += 1;
        } else if is_step7_with_symbol(code) {
            self.step7_symbols += 1;
        } else if signs.has(Signs::COLON) && is_declaration(code) {
            self.declarations += 1;
        } else if !is_pl7 && is_prose(code, signs) {
            self.prose += 1;
        }
    }

    /// `has_object`: [`has_pl7_object`].
    pub(super) fn add_operands(&mut self, line: &str, signs: Signs, has_object: bool) {
        self.pl7_2 += u32::from(has_pl7_2_object(line, signs));
        self.not_pl7_2 += u32::from(has_object && has_object_of_pl7_alone(line));
    }

    /// Whether ladder and charts are PL7-2's: most of their operands say so, or where they say nothing, the configuration.
    pub(super) fn is_pl7_2(&self, configured: Option<Family>) -> bool {
        self.pl7_2 > self.not_pl7_2 || self.not_pl7_2 == 0 && configured == Some(Family::Pl72)
    }

    /// Whether the text is a symbol table of STEP 7. In the data interchange format a row is many lines.
    pub(super) fn is_symbols(&self) -> bool {
        self.symbols * 2 > self.lines || self.interchange > 2
    }

    pub(super) fn is_exchange(&self) -> bool {
        self.own_blocks > 0 || self.blocks > 1
    }

    /// Whether steps or pages are there. A step may begin and end on one line.
    pub(super) fn has_chart(&self) -> bool {
        self.chart + self.steps > 0
    }

    pub(super) fn headings(&self) -> u32 {
        self.headings_il + self.headings_st + self.headings_ld + self.headings_other
    }

    /// Lines that are code of a dialect that is read.
    pub(super) fn code_lines(&self) -> u32 {
        self.step7 + self.il + self.st
    }

    /// What a text is that is convincing by itself. Neither prose with listings in it nor the source of another
    /// language is.
    pub(super) fn prove(&self) -> Option<Detected> {
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

    pub(super) fn pl7_text(&self, extension: Extension) -> Pl7Text {
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
fn is_dfb_line(code: &str, rest: &str, lead: Lead, signs: Signs) -> bool {
    if lead.is(Lead::DFB) {
        return true;
    }
    // Statement list has `SET` alone, and `INC 5`.
    if lead.is(Lead::DFB_OPERAND) {
        let operand = rest.trim();
        return operand.starts_with(|it: char| it.is_alphabetic() || it == '_') && operand.ends_with(';');
    }
    let mut words = code.split(|it: char| !(it.is_alphanumeric() || it == '_'));
    let mut blanks = code.split_whitespace().map(|it| it.trim_start_matches('(')).peekable();
    signs.has(Signs::EB | Signs::R_)
        && words.any(|it| ["EBOOL", "AR_X", "AR_W", "AR_D", "AR_R"].iter().any(|ty| ty.eq_ignore_ascii_case(it)))
        || signs.has(Signs::EDGE)
            && std::iter::from_fn(|| Some((blanks.next()?, blanks.peek()?.chars().next())))
                .any(|(word, next)| matches!(word, "RE" | "FE") && next.is_some_and(char::is_alphabetic))
}

/// Whether a line that starts with a common word is one of a chart: `STEP 3 AT (C 4,L 3) :`, `TRANSITION FROM X0 TO X1`.
fn is_chart_line(first: &str, rest: &str) -> bool {
    let rest = rest.trim_start();
    let next = word(rest).0;
    match first {
        "STEP" => !next.is_empty() && rest.contains(':'),
        "ACTION" => rest.starts_with('(') || rest.contains(':') && !rest.starts_with(":="),
        "TRANSITION" => rest.starts_with('(') || ["AT", "FROM"].iter().any(|it| it.eq_ignore_ascii_case(next)),
        "PAGE" => !next.is_empty() && next.bytes().all(|it| it.is_ascii_digit()),
        _ => true,
    }
}

fn upper(word: &str) -> Cow<'_, str> {
    match word.bytes().any(|it| it.is_ascii_lowercase()) {
        true => Cow::Owned(word.to_ascii_uppercase()),
        false => Cow::Borrowed(word),
    }
}

/// The part of a line before `//`.
fn before_line_comment(code: &str) -> &str {
    let mut slashes = memchr::memchr_iter(b'/', code.as_bytes());
    let end = slashes.find(|at| code.as_bytes().get(at + 1) == Some(&b'/')).unwrap_or(code.len());
    code.get(..end).unwrap_or_default()
}

/// Whether letters stand for a kind of PL7 objects, between `%` and the number, in any case.
fn is_pl7_kind(letters: &str) -> bool {
    let mut upper = [0; 3];
    let Some(upper) = upper.get_mut(..letters.len()) else { return false };
    upper.copy_from_slice(letters.as_bytes());
    upper.make_ascii_uppercase();
    matches!(
        &*upper,
        [b'I' | b'Q' | b'M' | b'K' | b'S' | b'X' | b'T' | b'C' | b'R' | b'L']
            | [b'I' | b'Q' | b'M' | b'K' | b'S', b'W' | b'D']
            | [b'I' | b'Q' | b'M' | b'K', b'F']
            | [b'M' | b'K', b'B']
            | b"TM"
            | b"MN"
            | b"DR"
            | b"SR"
            | b"NW"
            | b"XM"
            | b"CH"
            | b"BLK"
    )
}

/// Whether a line names an object as PL7 does: `%MW10`, `%I1.0`, `%MW 99`, `%X(0)`. Lower case must be followed by the
/// number at once, which no format string of another language is.
pub(super) fn has_pl7_object(line: &str) -> bool {
    memchr::memchr_iter(b'%', line.as_bytes()).any(|at| {
        let before = line.get(..at).and_then(|before| before.chars().next_back());
        let rest = line.get(at + 1..).unwrap_or_default();
        let end = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
        let (letters, number) = rest.split_at(end);
        let upper = letters.bytes().all(|byte| byte.is_ascii_uppercase());
        let number = if upper { number.trim_start() } else { number };
        !before.is_some_and(|before| before.is_alphanumeric() || before == '%')
            && is_pl7_kind(letters)
            && number.starts_with(|c: char| c.is_ascii_digit() || upper && c == '(')
    })
}

/// Whether a line names an object, or transfers a value, as PL7-2 alone does: `I0,05`, `T0,D`, `W5,A`, `W1 -> W2`. No symbol
/// has a comma.
fn has_pl7_2_object(line: &str, signs: Signs) -> bool {
    let bytes = line.as_bytes();
    let is_part = |it: &u8| it.is_ascii_alphanumeric() || *it == b',';
    // The first comma of a word stands behind letters, or a number behind them.
    let word_with = |comma: usize| {
        let behind = |end: usize, is: fn(&u8) -> bool| end - bytes[..end].iter().rev().take_while(|it| is(it)).count();
        let letters = behind(comma, u8::is_ascii_digit);
        let start = behind(letters, u8::is_ascii_alphabetic);
        if start == letters || bytes[..start].last().is_some_and(is_part) {
            return None;
        }
        let rest = bytes[comma..].iter().take(LONGEST_PL7_2 + 1).take_while(|it| is_part(it)).count();
        line.get(start..comma + rest).filter(|it| it.len() <= LONGEST_PL7_2)
    };
    let is_address = |it: &str| object::pl72::class_of(it).is_some_and(|it| it != object::Class::Fault);
    let is_named = || memchr::memchr_iter(b',', bytes).filter_map(word_with).any(is_address);
    let has_arrow =
        || signs.has(Signs::ARROW) && memchr::memchr_iter(b'>', bytes).any(|at| at > 0 && bytes[at - 1] == b'-');
    let is_transfer = || line.contains("END_BLOCK") && !line.contains(":=");
    let address = || {
        let at = memchr::memchr_iter(b'A', bytes).find(|&at| at > 0 && bytes[at - 1..].starts_with(b" AT "))?;
        line.get(at + 3..)
    };
    signs.has(Signs::COMMA) && is_named()
        || has_arrow() && is_transfer()
        || signs.has(Signs::AT) && address().is_some_and(|it| declared_by_pl7_2(it.trim_start()))
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
fn pl7_statement(code: &str, rest: &str, lead: Lead, has_object: bool) -> Option<Pl7Text> {
    if lead.is(Lead::PL7_OPERAND) {
        let operand = rest.trim();
        let symbol = code.len() > rest.len() + 1 && {
            let (name, rest) = word(operand);
            !name.is_empty() && rest.is_empty()
        };
        let is_st = operand.ends_with("THEN") || operand.ends_with(';');
        return (symbol || has_object && operand.starts_with(['%', '[', '('])).then_some(if is_st {
            Pl7Text::St
        } else {
            Pl7Text::Il
        });
    }
    if lead.is(Lead::PL7_BARE) && rest.trim().is_empty() {
        Some(Pl7Text::Il)
    } else if lead.is(Lead::PL7_STATEMENT) && has_object {
        Some(Pl7Text::St)
    } else if code.starts_with('[') && has_object {
        Some(Pl7Text::Il)
    } else if code.ends_with(';') && code.contains(":=") {
        Some(Pl7Text::St)
    } else {
        None
    }
}

/// Whether a line, which no blanks begin or end, is a statement list instruction, with an optional label before it.
fn is_step7_instruction(line: &str, signs: Signs) -> bool {
    let line = strip_step7_label(line);
    let line = match signs.has(Signs::SEMICOLON) {
        true => line.split(';').next().unwrap_or_default().trim_end(),
        false => line,
    };
    if line.starts_with(|it: char| !it.is_ascii_alphanumeric()) {
        let end = line.find(|c: char| c.is_ascii_alphanumeric()).unwrap_or(line.len());
        let operator = line.get(..end).unwrap_or_default().trim_end();
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
    let lead = Lead::of(&upper(mnemonic));
    let operand = rest.trim_start();
    if lead.is(Lead::CHECK) {
        operand == "(" || is_step7_operand(operand)
    } else if lead.is(Lead::OR) {
        matches!(operand, "" | "(") || is_step7_operand(operand)
    } else if lead.is(Lead::OPERAND) {
        is_step7_operand(operand)
    } else if lead.is(Lead::JUMP) {
        let (label, rest) = word(operand);
        !label.is_empty() && rest.is_empty()
    } else if lead.is(Lead::CALL) {
        let called = operand.split([',', '(']).next().unwrap_or_default();
        is_step7_operand(called)
    } else if lead.is(Lead::OPTIONAL) {
        operand.is_empty() || is_step7_operand(operand)
    } else if lead.is(Lead::ALONE) {
        operand.is_empty()
    } else if lead.is(Lead::OPEN) {
        operand == "("
    } else {
        false
    }
}

/// Whether a line is a bit instruction on a bare name, as documents print them: `U Sto`, `UN T2p[21]`.
fn is_step7_with_symbol(line: &str) -> bool {
    let (mnemonic, operand) = match line.strip_prefix('=') {
        Some(operand) => ("=", operand),
        None => word(line),
    };
    if !["U", "UN", "A", "AN", "O", "ON", "X", "XN", "S", "R", "="].contains(&mnemonic) {
        return false;
    }
    let (_, rest) = word(operand.trim_start());
    let index = rest.strip_prefix('[').map_or(Some(rest), |index| index.split_once(']').map(|(_, rest)| rest));
    operand.starts_with([' ', '\t']) && index.is_some_and(|rest| matches!(rest.trim(), "" | ";"))
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

/// Whether letters stand before the number in absolute operands of STEP 7 or STEP 5, in either mnemonic set.
fn is_step7_area(letters: &str) -> bool {
    let mut upper = [0; 3];
    let Some(upper) = upper.get_mut(..letters.len()) else { return false };
    upper.copy_from_slice(letters.as_bytes());
    upper.make_ascii_uppercase();
    matches!(
        &*upper,
        [b'E' | b'A' | b'I' | b'Q' | b'M' | b'L' | b'T' | b'Z' | b'C']
            | [b'E' | b'A' | b'I' | b'Q' | b'M' | b'L', b'B' | b'W' | b'D']
            | [b'D', b'B' | b'I', b'X' | b'B' | b'W' | b'D']
            | [b'P', b'E' | b'A', b'B' | b'W' | b'D']
            | [b'P', b'I' | b'Q', b'W']
            | [b'O', b'B']
            | [b'F', b'B' | b'C']
            | [b'D', b'B' | b'I']
    )
}

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
    let end = text.bytes().position(|it| !it.is_ascii_alphabetic()).unwrap_or(text.len());
    let (area, number) = text.split_at(end);
    if !is_step7_area(area) {
        return [
            "SFC", "SFB", "UDT", "STW", "AR1", "AR2", "DBNO", "DBLG", "DINO", "DILG", "OV", "OS", "BIE", "BR", "UO",
        ]
        .iter()
        .any(|name| name.eq_ignore_ascii_case(prefix))
            && rest.trim_start().bytes().all(|byte| byte.is_ascii_digit());
    }
    let number = number.trim_start();
    if let Some(indirect) = number.strip_prefix('[') {
        return indirect.ends_with(']');
    }
    // `0.0`, `1.DBX 0.0`: at most one blank inside.
    number.starts_with(|c: char| c.is_ascii_digit())
        && number.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b' '))
        && match number.bytes().filter(|byte| *byte == b' ').count() {
            0 => true,
            1 => number.contains(".D") || number.contains(".d"),
            _ => false,
        }
}

/// Whether a line can only be STEP 5: a colon before the instruction, the end of a segment, fixed-point operators and
/// constants of its kinds.
fn is_step5(line: &str, signs: Signs) -> bool {
    if line.starts_with("***") {
        return true;
    }
    // The address that a print puts before the colon.
    let address = line.bytes().take_while(u8::is_ascii_hexdigit).count();
    let behind = || line.get(address..).unwrap_or_default().trim_start();
    let line = if address >= 4 && address < line.len() && behind().starts_with(':') { behind() } else { line };
    let line = if signs.has(Signs::SEMICOLON) { step5_code(line) } else { line };
    let heading = step5_heading(line).and_then(|it| it.block_kind());
    if heading.is_some_and(|it| matches!(it, BlockKind::Pb | BlockKind::Sb | BlockKind::Fx | BlockKind::Dx)) {
        return true;
    }
    let (colon, code) = match line.strip_prefix(':') {
        Some(code) if !code.starts_with('=') || code.starts_with("= ") => (true, code.trim_start()),
        _ => (false, line),
    };
    let operator =
        matches!(code.as_bytes(), [b'!', b'=', b'F' | b'G' | b'D', ..] | [b'>', b'<', b'F' | b'G' | b'D', ..]);
    let constant = code.strip_prefix("L ").is_some_and(|operand| {
        let kinds = [b'B', b'C', b'F', b'G', b'H', b'M', b'T', b'Y', b'Z'];
        matches!(operand.trim_start().as_bytes(), [b'K', kind, ..] if kinds.contains(kind))
    });
    operator || constant || colon && is_step7_instruction(code, signs) || is_step5_instruction(strip_step7_label(code))
}

/// Whether an instruction is one that STEP 7 has not: `SPA PB 10`, `SPB= M1`, `A DB 5`, `KEW`, `NAME :INIT`.
fn is_step5_instruction(code: &str) -> bool {
    let (mnemonic, rest) = word(code);
    let rest = rest.trim_start();
    // The letters of an operand, and whether a number follows.
    let operand = || {
        let (operand, after) = word(rest);
        let letters = operand.trim_end_matches(|it: char| it.is_ascii_digit());
        let is_numbered = letters.len() < operand.len();
        (letters, is_numbered || after.trim_start().starts_with(|it: char| it.is_ascii_digit()))
    };
    match mnemonic {
        "SPA" | "SPB" | "JU" | "JC" | "BA" | "BAB" | "DOU" | "DOC" => {
            rest.starts_with('=') || matches!(operand(), ("OB" | "PB" | "SB" | "FB" | "FX", true))
        }
        "SPZ" | "SPN" | "SPP" | "SPM" | "SPO" | "JZ" | "JN" | "JP" | "JM" | "JO" => rest.starts_with('='),
        "A" | "E" | "C" | "G" => matches!(operand(), ("DB", true) | ("DX", _)),
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
fn is_prose(line: &str, signs: Signs) -> bool {
    if line.starts_with("```") {
        return true;
    }
    if !signs.has(Signs::SMALL) {
        return false;
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

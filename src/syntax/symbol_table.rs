//! Symbol tables of STEP 7: one declaration a row, in one of the four forms that its symbol editor exports (the vendor's
//! documentation).
//!
//! | form | a row |
//! |---|---|
//! | SDF | `"Motor","A 4.0","BOOL","conveyor"` |
//! | ASC | `126,`, then 24 characters of symbol, 12 of address, 10 of type, and the comment |
//! | SEQ | tab, address, tab, symbol, tab, comment |
//! | DIF | between two marks `BOT`, each field as a line `1,0` and a line in quotes |
//!
//! A row is the node of a declaration: its name, its address and its type are nodes, its comment is free text. Rows
//! without name and address are remarks of whoever made the table.

use super::SyntaxKind::{
    Address, Comma, Error, FreeText, Ident, Newline, ObjectRef, TypeRef, VarDecl, VarName, Whitespace,
};
use super::tokens::Tokens;
use super::{Language, Memo, Parse, Parser, SyntaxKind};

/// Parses one table. Total and linear for every text; what is no row is an error node.
pub fn parse(text: &str) -> Parse {
    super::parse(Language::SymbolTable, text)
}

pub(super) fn parse_with(text: &str, memo: &mut Memo) -> Parse {
    let mut rows = Rows::default();
    let form = Form::of(text);
    let mut dif = Dif::Header;
    for line in text.split_inclusive(['\n', '\r']) {
        let (code, end) = line.split_at(line.trim_end_matches(['\n', '\r']).len());
        match form {
            _ if code.trim().is_empty() => rows.push(Whitespace, code.len()),
            Form::Sdf => sdf(&mut rows, code),
            Form::Asc => asc(&mut rows, code),
            Form::Seq => seq(&mut rows, code),
            Form::Dif => dif = dif.line(&mut rows, code),
        }
        rows.push(Newline, end.len());
    }
    rows.parse(text, memo)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Sdf,
    Asc,
    Seq,
    Dif,
}

impl Form {
    /// By the first line that says something.
    fn of(text: &str) -> Self {
        let line = text.lines().find(|it| !it.trim().is_empty()).unwrap_or_default();
        let digits = line.bytes().take_while(u8::is_ascii_digit).count();
        if line.trim().eq_ignore_ascii_case("TABLE") {
            Self::Dif
        } else if digits > 0 && line.get(digits..).is_some_and(|it| it.starts_with(',')) {
            Self::Asc
        } else if line.trim_start_matches(' ').starts_with('\t') || !line.contains('"') && line.contains('\t') {
            Self::Seq
        } else {
            Self::Sdf
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::syntax) enum Field {
    Name,
    Address,
    Type,
    Comment,
}

/// The order of the fields in all forms but SEQ.
const FIELDS: [Field; 4] = [Field::Name, Field::Address, Field::Type, Field::Comment];

/// Tokens, and what the grammar makes of those that are no trivia.
#[derive(Default)]
pub(in crate::syntax) struct Rows {
    tokens: Tokens,
    steps: Vec<Step>,
    /// Fields of the row that is open: where its steps start, whether it has a name, an address.
    open: Option<(usize, bool, bool)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Open,
    Token,
    Field(SyntaxKind),
    Close(SyntaxKind),
    Lacks(&'static str),
}

impl Rows {
    /// A token outside of the fields. Those of unknown characters are parted by line ends.
    pub(in crate::syntax) fn push(&mut self, kind: SyntaxKind, len: usize) {
        self.tokens.push(kind, len);
        if len > 0 && !kind.is_trivia() {
            self.steps.push(Step::Token);
        }
    }

    pub(in crate::syntax) fn open(&mut self) {
        self.close();
        self.open = Some((self.steps.len(), false, false));
        self.steps.push(Step::Open);
    }

    /// A field with the blanks around it.
    pub(in crate::syntax) fn field(&mut self, field: Field, text: &str) {
        let value = text.trim();
        let start = text.len() - text.trim_start().len();
        self.push(Whitespace, start);
        if !value.is_empty() {
            let (token, node) = match field {
                Field::Name => (Ident, Some(VarName)),
                Field::Address => (Address, Some(ObjectRef)),
                Field::Type => (Ident, Some(TypeRef)),
                Field::Comment => (FreeText, None),
            };
            self.push(token, value.len());
            if let (Some(node), Some(last)) = (node, self.steps.last_mut()) {
                *last = Step::Field(node);
            }
            if let Some(open) = &mut self.open {
                open.1 |= field == Field::Name;
                open.2 |= field == Field::Address;
            }
        }
        self.push(Whitespace, text.len() - start - value.len());
    }

    pub(in crate::syntax) fn close(&mut self) {
        let Some((start, name, address)) = self.open.take() else { return };
        let (kind, lacks) = match (name, address) {
            (true, true) => (Some(VarDecl), None),
            (true, false) => (Some(VarDecl), Some("this symbol has no address")),
            (false, true) => (Some(Error), Some("this address has no symbol")),
            (false, false) => (None, None),
        };
        match kind {
            Some(kind) => {
                self.steps.extend(lacks.map(Step::Lacks));
                self.steps.push(Step::Close(kind));
            }
            None => {
                self.steps.remove(start);
            }
        }
    }

    /// A line that belongs to no form.
    fn unknown(&mut self, line: &str) {
        self.close();
        let start = line.len() - line.trim_start().len();
        self.push(Whitespace, start);
        self.steps.push(Step::Open);
        self.push(SyntaxKind::Unknown, line.trim().len());
        self.steps.push(Step::Lacks("this line is no row of a symbol table"));
        self.steps.push(Step::Close(Error));
        self.push(Whitespace, line.len() - start - line.trim().len());
    }

    pub(in crate::syntax) fn parse(mut self, text: &str, memo: &mut Memo) -> Parse {
        self.close();
        let mut p = Parser::new(text, &self.tokens, memo);
        let mut row = None;
        for step in &self.steps {
            match *step {
                Step::Open => row = Some(p.start()),
                Step::Token => p.bump(),
                Step::Field(kind) => {
                    let field = p.start();
                    p.bump();
                    p.complete(field, kind);
                }
                Step::Lacks(what) => {
                    let range = p.previous_range();
                    p.error_at(range, what);
                }
                Step::Close(kind) => {
                    if let Some(row) = row.take() {
                        p.complete(row, kind);
                    }
                }
            }
        }
        p.finish()
    }
}

/// `"Motor","A 4.0","BOOL","conveyor"`; the quotes may be missing, and fields behind the fourth mean nothing here.
fn sdf(rows: &mut Rows, line: &str) {
    if !line.contains(',') {
        return rows.unknown(line);
    }
    rows.open();
    let mut rest = line;
    let mut at = 0;
    while !rest.is_empty() {
        let blanks = rest.len() - rest.trim_start_matches(' ').len();
        rows.push(Whitespace, blanks);
        rest = rest.get(blanks..).unwrap_or_default();
        let quoted = rest.strip_prefix('"');
        let inner = quoted.unwrap_or(rest);
        rows.push(Comma, rest.len() - inner.len());
        // A quote within a field is none that ends it: behind that stands a comma, or the end.
        let ends = |at: usize| {
            inner.get(at + 1..).is_some_and(|it| it.trim_start().is_empty() || it.trim_start().starts_with(','))
        };
        let end = match quoted {
            Some(_) => memchr::memchr_iter(b'"', inner.as_bytes()).find(|&it| ends(it)),
            None => inner.find(','),
        };
        let end = end.unwrap_or(inner.len());
        let (value, behind) = inner.split_at_checked(end).unwrap_or((inner, ""));
        // Without its first quote, `TIMER"` still ends with one.
        let bare = if quoted.is_none() { value.trim_end().strip_suffix('"').unwrap_or(value) } else { value };
        rows.field(FIELDS.get(at).copied().unwrap_or(Field::Comment), bare);
        let comma = behind.find(',').map_or(behind.len(), |it| it + 1);
        rows.push(Comma, value.len() - bare.len() + comma);
        rest = behind.get(comma..).unwrap_or_default();
        at += 1;
    }
    rows.close();
}

/// Characters of symbol, address and type; the comment takes the rest.
const WIDTHS: [(Field, usize); 3] = [(Field::Name, 24), (Field::Address, 12), (Field::Type, 10)];

fn asc(rows: &mut Rows, line: &str) {
    let digits = line.bytes().take_while(u8::is_ascii_digit).count();
    let Some(mut rest) = line.get(digits..).and_then(|it| it.strip_prefix(',')).filter(|_| digits > 0) else {
        return rows.unknown(line);
    };
    rows.open();
    rows.push(Comma, digits + 1);
    for (field, width) in WIDTHS {
        let end = rest.char_indices().nth(width).map_or(rest.len(), |it| it.0);
        let (value, behind) = rest.split_at_checked(end).unwrap_or((rest, ""));
        rows.field(field, value);
        rest = behind;
    }
    rows.field(Field::Comment, rest);
    rows.close();
}

fn seq(rows: &mut Rows, line: &str) {
    let start =
        line.find('\t').map_or(0, |it| if line.get(..it).is_some_and(|it| it.trim().is_empty()) { it + 1 } else { 0 });
    let rest = line.get(start..).unwrap_or_default();
    if !rest.contains('\t') {
        return rows.unknown(line);
    }
    rows.open();
    rows.push(Whitespace, start);
    let mut order = [Field::Address, Field::Name, Field::Comment];
    // Some tools write the symbol first.
    let mut fields = rest.split('\t').map(is_address);
    if let (Some(false), Some(true)) = (fields.next(), fields.next()) {
        order.swap(0, 1);
    }
    for (at, (field, value)) in order.into_iter().zip(rest.splitn(3, '\t')).enumerate() {
        rows.push(Whitespace, usize::from(at > 0));
        rows.field(field, value);
    }
    rows.close();
}

/// Whether a field has the form of an address: letters and a number.
fn is_address(field: &str) -> bool {
    let field = field.trim();
    let letters = field.bytes().take_while(u8::is_ascii_alphabetic).count();
    let number = field.get(letters..).unwrap_or_default().trim_start();
    (1..=3).contains(&letters) && !number.is_empty() && number.bytes().all(|it| it.is_ascii_digit() || it == b'.')
}

/// Where in a file of the data interchange format a line stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Dif {
    Header,
    /// Lines that are left of the header's last record.
    Data(u8),
    /// The type and number of a value are next; this many values of the row were read.
    Kind(usize),
    /// The text of such a value, which is the field of that number; `None` for a mark.
    Text(usize, bool),
}

impl Dif {
    fn line(self, rows: &mut Rows, line: &str) -> Self {
        match self {
            Self::Header => {
                rows.field(Field::Comment, line);
                if line.trim().eq_ignore_ascii_case("DATA") { Self::Data(2) } else { self }
            }
            Self::Data(left) => {
                rows.field(Field::Comment, line);
                if left > 1 { Self::Data(left - 1) } else { Self::Kind(0) }
            }
            Self::Kind(at) => {
                rows.push(Comma, line.len());
                Self::Text(at, line.trim_start().starts_with('1'))
            }
            Self::Text(at, true) => {
                let value = line.trim();
                let inner = value.strip_prefix('"').unwrap_or(value);
                let inner = inner.strip_suffix('"').unwrap_or(inner);
                let start = line.find(inner).unwrap_or(0);
                rows.push(Comma, start);
                rows.field(FIELDS.get(at).copied().unwrap_or(Field::Comment), inner);
                rows.push(Comma, line.len() - start - inner.len());
                Self::Kind(at + 1)
            }
            Self::Text(at, false) => {
                let mark = line.trim();
                if mark.eq_ignore_ascii_case("BOT") {
                    rows.open();
                } else if mark.eq_ignore_ascii_case("EOD") {
                    rows.close();
                }
                rows.push(Comma, line.len());
                Self::Kind(if mark.eq_ignore_ascii_case("BOT") { 0 } else { at + 1 })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Name, address, type of each row.
    fn rows(text: &str) -> Vec<[String; 3]> {
        let parse = parse(text);
        let root = parse.syntax();
        let decls = root.descendants().filter(|it| it.kind() == VarDecl);
        decls
            .map(|row| {
                [VarName, ObjectRef, TypeRef].map(|kind| {
                    row.children().find(|it| it.kind() == kind).map(|it| it.text().into_owned()).unwrap_or_default()
                })
            })
            .collect()
    }

    fn expected(rows: &[[&str; 3]]) -> Vec<[String; 3]> {
        rows.iter().map(|it| it.map(str::to_owned)).collect()
    }

    const BOTH: [[&str; 3]; 2] = [["green_phase_ped.", "T 2", "TIMER"], ["Dépôt, été", "A 4.0", "BOOL"]];

    #[test]
    fn quoted_fields() {
        // The vendor's documentation itself leaves a quote out.
        let text = "\" \",\" \",\" \",\"made by hand\"\r\n\"green_phase_ped.\", \"T 2\", TIMER\",\"Duration\"\r\n\r\n\
                    \"Dépôt, été\",\"A 4.0\",\"BOOL\",\"a \"\"b\"\" c\",\"True\"\r\n";
        assert_eq!(rows(text), expected(&BOTH));
        assert_eq!(parse(text).errors(), []);
    }

    #[test]
    fn fixed_width() {
        let text = format!(
            "126,{:<24}{:<12}{:<10}{}\r\n126,{:<24}{:<12}BOOL\n",
            "green_phase_ped.", "T       2", "TIMER", "Duration", "Dépôt, été", "A 4.0"
        );
        let mut both = expected(&BOTH);
        both[0][1] = "T       2".to_owned();
        assert_eq!(rows(&text), both);
    }

    #[test]
    fn tabs() {
        let text = "\tT 2\tgreen_phase_ped.\tDuration\r\n\tA 4.0\tDépôt, été\t\r\nA 4.1\tLampe\tx\ty\n";
        let found: Vec<[String; 2]> = rows(text).into_iter().map(|[name, address, _]| [name, address]).collect();
        assert_eq!(
            found,
            [["green_phase_ped.", "T 2"], ["Dépôt, été", "A 4.0"], ["Lampe", "A 4.1"]].map(|it| it.map(str::to_owned))
        );
    }

    #[test]
    fn data_interchange() {
        let value = |text: &str| format!("1,0\r\n\"{text}\"\r\n");
        let row = |it: [&str; 3]| format!("-1,0\r\nBOT\r\n{}{}", it.map(value).concat(), value("comment"));
        let text = format!(
            "TABLE\r\n0,1\r\n\"S7\"\r\nVECTORS\r\n0,2\r\n\"\"\r\nTUPLES\r\n0,4\r\n\"\"\r\nDATA\r\n0,0\r\n\"\"\r\n{}-1,0\r\nEOD\r\n",
            BOTH.map(row).concat()
        );
        assert_eq!(rows(&text), expected(&BOTH));
        assert_eq!(parse(&text).errors(), []);
    }

    #[test]
    fn rows_that_lack_something_are_said() {
        let errors = |text: &str| parse(text).errors().iter().map(|it| it.message.to_string()).collect::<Vec<_>>();
        assert_eq!(errors("\"Motor\",\"\",\"BOOL\",\"\"\n"), ["this symbol has no address"]);
        assert_eq!(errors("\"\",\"A 4.0\",\"BOOL\",\"\"\n"), ["this address has no symbol"]);
        assert_eq!(errors("\"Motor\",\"A 4.0\",\"BOOL\",\"\"\nhello\n"), ["this line is no row of a symbol table"]);
    }

    proptest! {
        #[test]
        fn tree_is_the_text(
            text in "(TABLE\n|126,|\t|)(\\PC|[\r\n\t \",]|DATA\n|0,0\n|1,0\n|-1,0\nBOT\n|\"A 4.0\",){0,40}",
        ) {
            let parse = parse(&text);
            let found = parse.syntax().text();
            prop_assert_eq!(found.as_ref(), text.as_str());
        }
    }
}

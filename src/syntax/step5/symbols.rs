//! The symbol table of a STEP 5 program, `...Z0.SEQ`: an operand, its symbol, and a comment in each line.
//!
//! The fields are parted by tabs, or by the control characters of a form with fixed records. Which field is the operand
//! is told by its form. The layout of the records is not published: assumed is that control characters, or two
//! blanks at least, part their fields.

use std::ops::Range;

use crate::syntax::SyntaxKind::{Newline, Unknown, Whitespace};
use crate::syntax::symbol_table::{Field, Rows};
use crate::syntax::{Language, Memo, Parse};

/// Fields of a line, by their places in it: the operand, the symbol, and the comment behind them, which may be empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Row {
    operand: Range<usize>,
    symbol: Range<usize>,
    comment: Range<usize>,
}

/// Reads a line, without its end. `None` if it names no operand and symbol, in this order.
pub(crate) fn row(line: &str) -> Option<Row> {
    let is_break = |it: char| it.is_control();
    // Nearly all lines that are no row end here.
    let first = line.trim_start_matches(|it: char| is_break(it) || it.is_whitespace());
    let letters = first.bytes().take_while(u8::is_ascii_alphabetic).count();
    if !first.starts_with(|it: char| it.is_ascii_digit()) && !super::lexer::is_area(&first[..letters]) {
        return None;
    }
    let by_blanks = !line.contains(is_break);
    let text = |field: &Range<usize>| line.get(field.clone()).unwrap_or_default();
    let mut at = 0;
    let mut next = || {
        let rest = line.get(at..).unwrap_or_default();
        // A break may be a blank too.
        let rest = rest.trim_start_matches(|it: char| is_break(it) || it.is_whitespace());
        if rest.is_empty() {
            return None;
        }
        let start = line.len() - rest.len();
        let end = if by_blanks { rest.find("  ") } else { rest.find(is_break) };
        let field = rest.get(..end.unwrap_or(rest.len())).unwrap_or_default();
        at = start + field.len();
        Some(start..start + field.trim_end().len())
    };
    let mut operand = next()?;
    // The number of the line may stand before the operand.
    if text(&operand).bytes().all(|it| it.is_ascii_digit()) {
        operand = next()?;
    }
    let symbol = next()?;
    let comment = next().unwrap_or(symbol.end..symbol.end);
    let is_symbol = text(&symbol).chars().count() <= LONGEST_SYMBOL && !is_operand(text(&symbol));
    (is_operand(text(&operand)) && is_symbol).then_some(Row { operand, symbol, comment })
}

/// Characters of the longest symbol that the programming device takes (the vendor's general documentation).
const LONGEST_SYMBOL: usize = 24;

fn is_operand(field: &str) -> bool {
    let letters = field.bytes().take_while(u8::is_ascii_alphabetic).count();
    let number = field[letters..].trim_start();
    super::lexer::is_area(&field[..letters])
        && number.starts_with(|it: char| it.is_ascii_digit())
        && number.bytes().all(|it| it.is_ascii_digit() || it == b'.')
}

/// Parses a table. Total and linear for every text. A line that is no row is kept, and is no error.
pub fn parse(text: &str) -> Parse {
    crate::syntax::parse(Language::Step5Symbols, text)
}

pub(in crate::syntax) fn parse_with(text: &str, memo: &mut Memo) -> Parse {
    let mut rows = Rows::default();
    for whole in text.split_inclusive(['\n', '\r']) {
        let (line, end) = whole.split_at(whole.trim_end_matches(['\n', '\r']).len());
        match row(line) {
            Some(row) => {
                rows.open();
                let mut at = 0;
                for (field, part) in
                    [(Field::Address, row.operand), (Field::Name, row.symbol), (Field::Comment, row.comment)]
                {
                    rows.push(Whitespace, part.start.saturating_sub(at));
                    at = part.end;
                    rows.field(field, line.get(part).unwrap_or_default());
                }
                rows.push(Whitespace, line.len() - at);
                rows.close();
            }
            None if line.trim().is_empty() => rows.push(Whitespace, line.len()),
            None => rows.push(Unknown, line.len()),
        }
        rows.push(Newline, end.len());
    }
    rows.parse(text, memo)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::SyntaxKind::VarDecl;

    #[test]
    fn rows_in_both_forms() {
        let fields = |line: &'static str| row(line).map(|it| [it.operand, it.symbol, it.comment].map(|it| &line[it]));
        for line in [
            "1\tE 0.0\tSTART\tTaster",
            "\tE 0.0\tSTART\tTaster",
            "\u{1}E 0.0   \u{2}START   \u{3}Taster",
            "E 0.0   START     Taster",
        ] {
            assert_eq!(fields(line), Some(["E 0.0", "START", "Taster"]), "{line:?}");
        }
        // The order of STEP 7's tables.
        for line in ["\tPump\tE 0.0\tcomment", "", "E 0.0", "text without an operand", "\tx\ty\tz"] {
            assert_eq!(row(line), None, "{line:?}");
        }
    }

    #[test]
    fn any_table_is_kept() {
        for text in ["\tE 0.0\tSTART\tTaster\r\n\n\tMW 10\tZAHL\nrest", "", "\u{0}\u{1}", "é\té\té"] {
            let parse = parse(text);
            assert_eq!(parse.syntax().text(), text);
        }
        let parse = parse("\tE 0.0\tSTART\tTaster\n\tMW 10\tZAHL\t\n");
        assert_eq!(parse.syntax().children().filter(|it| it.kind() == VarDecl).count(), 2);
    }
}

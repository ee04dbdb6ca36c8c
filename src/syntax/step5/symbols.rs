//! The symbol table of a STEP 5 program, `...Z0.SEQ`: an operand, its symbol, and a comment in each line.
//!
//! The fields are parted by tabs, or by the control characters of a form with fixed records. Which field is the operand
//! is told by its form. The layout of the records is not published: assumed is that control characters, or two
//! blanks at least, part their fields.

use crate::syntax::SyntaxKind::{FreeText, Ident, Newline, ObjectRef, Unknown, VarDecl, VarName, Whitespace};
use crate::syntax::{Parse, Parser, SyntaxKind, Token};

/// Fields of a line: where the operand is, the symbol, and the comment behind them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Row<'t> {
    pub(crate) operand: &'t str,
    pub(crate) symbol: &'t str,
    pub(crate) comment: &'t str,
}

/// Reads a line, without its end. `None` if it names no operand and symbol, in this order.
pub(crate) fn row(line: &str) -> Option<Row<'_>> {
    let is_break = |it: char| it.is_control();
    let by_blanks = !line.contains(is_break);
    let mut rest = line;
    let mut next = || loop {
        rest = rest.trim_start_matches(|it: char| is_break(it) || it == ' ');
        if rest.is_empty() {
            return None;
        }
        let end = if by_blanks { rest.find("  ") } else { rest.find(is_break) };
        let (field, behind) = rest.split_at(end.unwrap_or(rest.len()));
        rest = behind;
        let field = field.trim();
        if !field.is_empty() {
            return Some(field);
        }
    };
    let mut field = next()?;
    // The number of the line may stand before the operand.
    if field.bytes().all(|it| it.is_ascii_digit()) {
        field = next()?;
    }
    let operand = Some(field).filter(|it| is_operand(it))?;
    let symbol = next().filter(|it| it.chars().count() <= LONGEST_SYMBOL && !is_operand(it))?;
    Some(Row { operand, symbol, comment: next().unwrap_or_default() })
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

/// Parses a table. Total and linear for every text. `Root > VarDecl*`; `VarDecl > ObjectRef, VarName, FreeText?`.
pub fn parse(text: &str) -> Parse {
    let tokens = lex(text);
    let mut p = Parser::new(text, &tokens);
    let starts = |p: &Parser<'_>| p.at(Ident) && p.nth(1) == Some(FreeText);
    while !p.at_end() {
        if !starts(&p) {
            p.bump();
            continue;
        }
        let decl = p.start();
        let operand = p.start();
        p.bump();
        p.complete(operand, ObjectRef);
        let name = p.start();
        p.bump_as(Ident);
        p.complete(name, VarName);
        if !p.newline_before() {
            p.eat(FreeText);
        }
        p.complete(decl, VarDecl);
    }
    p.finish()
}

fn lex(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut push = |kind: SyntaxKind, text: &str| {
        // Units are below 4 GiB: the source layer reads no larger file.
        if let Some(len) = u32::try_from(text.len()).ok().filter(|&it| it > 0) {
            tokens.push(Token { kind, len });
        }
    };
    for whole in text.split_inclusive(['\n', '\r']) {
        let line = whole.trim_end_matches(['\n', '\r']);
        let mut at = 0;
        if let Some(row) = row(line) {
            for (kind, field) in [(Ident, row.operand), (FreeText, row.symbol), (FreeText, row.comment)] {
                // The fields are parts of the line, in order.
                let Some(start) = (field.as_ptr() as usize).checked_sub(line.as_ptr() as usize).filter(|it| *it >= at)
                else {
                    continue;
                };
                push(Whitespace, line.get(at..start).unwrap_or_default());
                push(kind, field);
                at = start + field.len();
            }
            push(Whitespace, line.get(at..).unwrap_or_default());
        } else {
            let blank = line.trim().is_empty();
            push(if blank { Whitespace } else { Unknown }, line);
        }
        push(Newline, &whole[line.len()..]);
    }
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_in_both_forms() {
        let expected = Some(Row { operand: "E 0.0", symbol: "START", comment: "Taster" });
        for line in [
            "1\tE 0.0\tSTART\tTaster",
            "\tE 0.0\tSTART\tTaster",
            "\u{1}E 0.0   \u{2}START   \u{3}Taster",
            "E 0.0   START     Taster",
        ] {
            assert_eq!(row(line), expected, "{line:?}");
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

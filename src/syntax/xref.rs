//! The cross-reference of a PL7 project, in the form that the source layer gives it: a heading, then a line for each
//! entry, `%MW41:X0 R`, and between them the numbers of the places that they stand in, `@20`.

use super::SyntaxKind::{
    Error, FreeText, Heading, Ident, Newline, ObjectRef, Unknown, Whitespace, XrefEntry, XrefPlace,
};
use super::tokens::Tokens;
use super::{Language, Memo, Parse, Parser, SyntaxKind};

/// Ways in which an entry may use its object: reads, writes, executes, writes by a function, reads and writes by one.
pub const MODES: [&str; 5] = ["R", "W", "E", "O", "V"];

/// Parses one unit. Total and linear for every text; what is no entry is an error node.
pub fn parse(text: &str) -> Parse {
    super::parse(Language::Pl7Xref, text)
}

pub(super) fn parse_with(text: &str, memo: &mut Memo) -> Parse {
    let tokens = lex(text);
    let mut p = Parser::new(text, &tokens, memo);
    while !p.at_end() {
        let m = p.start();
        let kind = match (p.current(), p.nth(1)) {
            (Some(FreeText), _) if p.current_text().starts_with('[') => Heading,
            (Some(FreeText), _) => XrefPlace,
            (Some(Unknown), Some(Ident)) if !p.nth_newline_before(1) && MODES.contains(&p.nth_text(1)) => XrefEntry,
            _ => Error,
        };
        if kind == XrefEntry {
            let object = p.start();
            p.bump();
            p.complete(object, ObjectRef);
        }
        p.bump();
        while kind == Error && !p.newline_before() {
            p.bump();
        }
        p.complete(m, kind);
    }
    p.finish()
}

/// Of each line: a heading or place as one token, or an object (of any form) and the word behind it.
fn lex(text: &str) -> Tokens {
    let mut tokens = Tokens::default();
    let mut push = |kind: SyntaxKind, text: &str| tokens.push(kind, text.len());
    for line in text.split_inclusive('\n') {
        let code = line.trim_end();
        let (line, end) = line.split_at(line.trim_end_matches(['\n', '\r']).len());
        let start = code.trim_start();
        let behind = line.get(code.len()..).unwrap_or_default();
        push(Whitespace, code.get(..code.len() - start.len()).unwrap_or_default());
        if start.starts_with(['[', '@']) {
            push(FreeText, start);
        } else {
            let word = start.rfind(char::is_whitespace).map_or(start.len(), |at| {
                at + start.get(at..).and_then(|it| it.chars().next()).map_or(0, char::len_utf8)
            });
            let (object, mode) = start.split_at_checked(word).unwrap_or((start, ""));
            let (object, gap) = object.split_at_checked(object.trim_end().len()).unwrap_or((object, ""));
            push(Unknown, object);
            push(Whitespace, gap);
            push(Ident, mode);
        }
        push(Whitespace, behind);
        push(Newline, end);
    }
    tokens
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn entries_and_what_is_none() {
        let text = "[XREF] MAST - module 0\n@20\n%MW41:X0 R\r\n  %MW0[%MW5 + 1]  W \n\nREAD_VAR E\n%M1\n%M2 Z\n";
        let parse = parse(text);
        assert_eq!(parse.errors(), []);
        let found: Vec<(SyntaxKind, String)> =
            parse.syntax().children().map(|it| (it.kind(), it.text().into_owned())).collect();
        let expected = [
            (Heading, "[XREF] MAST - module 0"),
            (XrefPlace, "@20"),
            (XrefEntry, "%MW41:X0 R"),
            (XrefEntry, "%MW0[%MW5 + 1]  W"),
            (XrefEntry, "READ_VAR E"),
            (Error, "%M1"),
            (Error, "%M2 Z"),
        ];
        assert_eq!(found, expected.map(|it| (it.0, it.1.to_owned())));
    }

    proptest! {
        #[test]
        fn tree_is_the_text(text in "(\\PC|[\r\n\t @\\[%]|%M1 R\n){0,40}") {
            let parse = parse(&text);
            let found = parse.syntax().text();
            prop_assert_eq!(found.as_ref(), text.as_str());
        }
    }
}

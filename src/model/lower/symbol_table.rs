//! Symbol tables of STEP 7 and STEP 5: the names that a program gives to its addresses and blocks.

use rowan::TextRange;
use smol_str::SmolStr;

use super::builder::Builder;
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::object::{Object, step5, step7};
use crate::model::symbols::Symbol;
use crate::model::unit::OddityKind;
use crate::syntax::{Language, SyntaxKind, SyntaxNode};

pub(super) fn lower(root: SyntaxNode<'_>, entity: Entity, language: Language) -> UnitModel {
    let mut b = Builder::new(entity, language, TextRange::default(), root.text_range().len());
    for row in root.children().filter(|it| it.kind() == SyntaxKind::VarDecl) {
        declaration(&mut b, row, language);
    }
    b.finish()
}

fn declaration(b: &mut Builder, row: SyntaxNode<'_>, language: Language) {
    let child = |kind| row.children().find(|it| it.kind() == kind);
    let joined = |it: SyntaxNode<'_>| SmolStr::from(it.text().split_whitespace().collect::<String>());
    let Some(name) = child(SyntaxKind::VarName) else { return };
    let object = child(SyntaxKind::ObjectRef).and_then(|it| address(b, language, &joined(it), it.text_range()));
    let comment = row.tokens().find(|it| it.kind() == SyntaxKind::FreeText);
    let symbol = Symbol {
        name: name.text().trim().into(),
        object,
        ty: child(SyntaxKind::TypeRef).map(joined).unwrap_or_default(),
        initial: None,
        comment: comment.map(|it| it.text().into()),
        anchor: b.anchor(name.text_range()),
    };
    b.model.symbols.push(symbol);
}

/// What an address without blanks names.
fn address(b: &mut Builder, language: Language, address: &SmolStr, place: TextRange) -> Option<Object> {
    let error = match language {
        // The form of these tables is assumed: what cannot be read in them is no mistake of theirs.
        Language::Step5Symbols => return step5::parse_any(address).ok(),
        _ => match step7::parse_either(address) {
            Ok(object) => return Some(object),
            Err(error) => error,
        },
    };
    // A table of variables is no part of the program.
    if !is_variable_table(address) {
        b.oddity(OddityKind::Address(error), place, address.clone());
    }
    None
}

/// `VAT1`
fn is_variable_table(address: &str) -> bool {
    let (letters, number) = address.split_at_checked(3).unwrap_or_default();
    letters.eq_ignore_ascii_case("VAT") && !number.is_empty() && number.bytes().all(|it| it.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::facts::UnitFacts;
    use crate::analysis::symbols::{SymbolTable, resolve};
    use crate::model::entity::Family;
    use crate::model::object::{Area, Class};
    use crate::syntax::{Mnemonics, symbol_table};

    #[test]
    fn addresses_of_both_sets_and_blocks() {
        let text = "\"a\",\"E 1.0\",\"BOOL\",\"x\"\n\"b\",\"Q     4.0\",\"BOOL\",\"\"\n\"c\",\"Z 1\",\"COUNTER\",\"\"\n\
                    \"Motor\",\"FB    1\",\"FB    1\",\"\"\n\"Valve\",\"UDT 2\",\"UDT 2\",\"\"\n\"View\",\"VAT 1\",\"\",\"\"\n\
                    \"d\",\"C 2\",\"COUNTER\",\"\"\n\"e\",\"M 1.9\",\"BOOL\",\"\"\n\"f\",\"MX 3\",\"BOOL\",\"\"\n";
        let parse = symbol_table::parse(text);
        assert_eq!(parse.errors(), []);
        let model = lower(parse.syntax(), Entity::Container, Language::SymbolTable);
        let found: Vec<_> =
            model.symbols.iter().map(|it| (it.name.as_str(), it.object.as_ref().map(|it| it.class))).collect();
        let expected = [
            ("a", Some(Class::Input)),
            ("b", Some(Class::Output)),
            ("c", Some(Class::Counter)),
            ("Motor", Some(Class::CodeBlock)),
            ("Valve", Some(Class::CodeBlock)),
            ("View", None),
            ("d", Some(Class::Counter)),
            ("e", None),
            ("f", None),
        ];
        assert_eq!(found, expected);
        assert_eq!(model.symbols[3].ty, "FB1");
        assert_eq!(model.symbols[0].comment.as_deref(), Some("x"));
        let wrong: Vec<&str> = model.oddities.iter().map(|it| it.text.as_str()).collect();
        assert_eq!(wrong, ["M1.9", "MX3"]);
    }

    #[test]
    fn symbols_are_the_operands_that_they_name() {
        let facts = |text: &str, language: Language| {
            let parse = crate::syntax::parse(language, text);
            UnitFacts::new(&crate::model::lower::lower(parse.syntax(), text, Entity::Listing, language))
        };
        let table = facts("\tE 0.0\tSTART\tTaster\n\tMW 10\tZAHL\t\n\tF 1.0\tMERKER\t\n", Language::Step5Symbols);
        let table = SymbolTable::new(Family::Step5, [&table]);
        let code = facts("U -START\n= -MERKER\nL -Zahl\nT -OTHER\n", Language::Step5(Mnemonics::German));
        let resolved = resolve(&table, &code);
        let area = |text: &str| {
            let found = resolved.objects.iter().find(|it| it.object.text == text);
            found.map(|it| (it.object.footprint.area.clone(), it.object.footprint.start))
        };
        assert_eq!(area("-START"), Some((Area::Inputs, 0)));
        assert_eq!(area("-MERKER"), Some((Area::Words, 8)));
        assert_eq!(area("-Zahl"), Some((Area::Words, 80)));
        assert_eq!(area("-OTHER"), Some((Area::Symbol("other".into()), 0)));
        assert_eq!(table.annotate("`-START` and `MW10`"), "`-START` (`E0.0`) and `MW10` (`ZAHL`)");
    }
}

//! The symbol table of a STEP 5 program.

use rowan::TextRange;
use smol_str::SmolStr;

use super::builder::Builder;
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::object::step5;
use crate::model::symbols::Symbol;
use crate::syntax::{Language, SyntaxKind, SyntaxNode};

pub(super) fn lower(root: SyntaxNode<'_>, entity: Entity) -> UnitModel {
    let mut b = Builder::new(entity, Language::Step5Symbols, TextRange::default(), root.text_range().len());
    for node in root.children().filter(|it| it.kind() == SyntaxKind::VarDecl) {
        let child = |kind| node.children().find(|it| it.kind() == kind);
        let (Some(operand), Some(name)) = (child(SyntaxKind::ObjectRef), child(SyntaxKind::VarName)) else { continue };
        let comment = node.tokens().find(|it| it.kind() == SyntaxKind::FreeText).map(|it| SmolStr::new(it.text()));
        let operand = operand.text();
        let object = step5::parse_any(&operand).ok();
        let symbol = Symbol {
            name: name.text().trim().into(),
            object,
            ty: SmolStr::default(),
            initial: None,
            comment,
            anchor: b.anchor(name.text_range()),
        };
        b.model.symbols.push(symbol);
    }
    b.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::facts::UnitFacts;
    use crate::analysis::symbols::{SymbolTable, resolve};
    use crate::model::entity::Family;
    use crate::model::object::Area;
    use crate::syntax::Mnemonics;

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

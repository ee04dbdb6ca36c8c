//! The cross-reference of a PL7 project: accesses without order, conditions and values.

use super::builder::Builder;
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::object::{Object, pl7};
use crate::model::unit::{Mode, Pin, StatementKind};
use crate::syntax::{Language, SyntaxKind, SyntaxNode};

pub(super) fn lower(root: SyntaxNode<'_>, entity: Entity) -> UnitModel {
    let heading = root.children().find(|it| it.kind() == SyntaxKind::Heading);
    let heading = heading.map(SyntaxNode::text_range).unwrap_or_default();
    let mut b = Builder::new(entity, Language::Pl7Xref, heading, root.text_range().len());
    // Whether control reaches an entry is not known of any.
    let unknown = b.exprs().opaque();
    b.enter(unknown, None);
    for node in root.children() {
        match node.kind() {
            SyntaxKind::XrefPlace => b.next_network(),
            SyntaxKind::XrefEntry => entry(&mut b, node),
            SyntaxKind::Error => b.model.has_gaps = true,
            _ => {}
        }
    }
    b.finish()
}

fn entry(b: &mut Builder, node: SyntaxNode<'_>) {
    let object = node.children().find(|it| it.kind() == SyntaxKind::ObjectRef);
    let mode = node.tokens().find(|it| it.kind() == SyntaxKind::Ident);
    let (Some(object), Some(mode)) = (object, mode) else { return };
    let range = node.text_range();
    b.instruction(range);
    let text: String = object.text().split_whitespace().collect();
    let mode = match mode.text() {
        "R" => Mode::Read,
        "W" => Mode::Write,
        // Given to a function, which may leave it as it is.
        "O" | "V" => Mode::InOut,
        // A function, a subroutine, an instance of a DFB: which unit of the project it is, its number does not tell.
        _ if !text.starts_with('%') => return,
        _ => Mode::Drive(Pin::Whole),
    };
    let parsed = match text.split_once('[') {
        Some((base, rest)) => {
            let suffix = rest.rsplit_once(']').map(|it| it.1).filter(|it| !it.is_empty());
            pl7::parse_indexed(base, suffix).ok()
        }
        None if text.starts_with('%') => pl7::parse(&text).ok(),
        None => Some(Object::symbol(&text)),
    };
    let Some(parsed) = parsed else {
        // The vendor's table holds no mistake: it is we who do not know the object.
        b.model.has_gaps = true;
        return;
    };
    let id = b.object(Object { text: text.into(), ..parsed });
    match mode {
        Mode::Drive(pin) => {
            let when = b.path();
            b.drive(id, pin, when, None, range, range);
        }
        _ => {
            b.touch(id, mode, range);
            b.statement(StatementKind::Other, range);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Part, Task};
    use crate::syntax::xref;

    fn model(text: &str) -> UnitModel {
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        lower(xref::parse(text).syntax(), entity)
    }

    #[test]
    fn letters_are_modes() {
        let model = model("[XREF] MAST - MAIN\n@20\n%M1 R\n%M2 W\nREAD_VAR E\n%MW0:4 O\n%MW9:4 V\n%TM0 E\nCpt.In W\n");
        let found: Vec<(&str, Mode)> =
            model.accesses.iter().map(|it| (model.object(it.object).text.as_str(), it.mode)).collect();
        let expected = [
            ("%M1", Mode::Read),
            ("%M2", Mode::Write),
            ("%MW0:4", Mode::InOut),
            ("%MW9:4", Mode::InOut),
            ("%TM0", Mode::Drive(Pin::Whole)),
            ("Cpt.In", Mode::Write),
        ];
        assert_eq!(found, expected);
        assert!(!model.has_gaps);
        assert!(model.accesses.iter().all(|it| it.exposed || !it.mode.reads()), "a value may stem from anywhere");
    }

    #[test]
    fn what_is_not_known_is_a_gap() {
        for text in ["%FOO1 R\n", "%M1 Z\n", "%M1\n"] {
            assert!(model(text).has_gaps, "{text}");
        }
        let indexed = model("%MW10[%MW3] W\n%MW10[%MW3]:X2 R\n");
        assert!(!indexed.has_gaps && indexed.objects.iter().all(|it| it.indexed));
    }
}

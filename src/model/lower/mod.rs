//! Trees to models: one file a language.

mod awl;
mod builder;
mod il;
mod pl7;
mod st;

use rowan::TextRange;

use super::UnitModel;
use super::entity::Entity;
use super::unit::Pin;
use crate::syntax::{Language, SyntaxNode};

/// What the code of a unit does. `text` is the tree's text. Total: what is not understood leaves no statement.
pub fn lower(root: &SyntaxNode, text: &str, entity: Entity, language: Language) -> UnitModel {
    match language {
        Language::Awl(mnemonics) => awl::lower(root, entity, mnemonics),
        Language::Pl7Il => il::lower(root, text, entity),
        Language::Pl7St => st::lower(root, text, entity),
        Language::Exchange => builder::Builder::new(entity, language, TextRange::default()).finish(),
    }
}

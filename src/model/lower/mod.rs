//! Trees to models: one file a language.

mod awl;
mod builder;
mod chart;
mod dfb;
mod exchange;
mod il;
mod interface;
mod ladder;
mod pl7;
mod pl72;
mod st;
mod symbol_table;
mod width;
mod work;
mod xref;

use super::UnitModel;
use super::entity::Entity;
use super::unit::Pin;
use crate::syntax::{Language, SyntaxNode};
use crate::target::pl72::BLOCKS;

/// What the code of a unit does. `text` is the tree's text. Total: what is not understood leaves no statement.
pub fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity, language: Language) -> UnitModel {
    match language {
        Language::Awl(_) | Language::Step5(_) => awl::lower(root, entity, language),
        Language::Pl7Il => il::lower(root, text, entity),
        Language::Pl7St => st::lower(root, text, entity),
        Language::Exchange => exchange::lower(root, text, entity),
        Language::SymbolTable | Language::Step5Symbols => symbol_table::lower(root, entity, language),
        Language::Pl7Xref => xref::lower(root, entity),
        Language::Pl7Ld | Language::Pl72Ld => ladder::lower(root, text, entity, language),
        Language::Pl7Gr7 | Language::Sfc | Language::Pl72Gr7 | Language::Pl72Sfc => {
            chart::lower(root, text, entity, language)
        }
    }
}

/// Whether an input of a block of PL7-2 acts when it rises, and not while it is 1; by the symbol of the block.
pub fn acts_on_edge(block: &str, input: Pin) -> bool {
    let of = BLOCKS.iter().filter(|it| it.symbol == Some(block));
    of.flat_map(|it| it.inputs).any(|it| it.edge && pl72::pin(block, it.name) == input)
}

#[cfg(test)]
mod testing {
    use crate::model::UnitModel;
    use crate::model::expr::{Expr, ExprId};
    use crate::model::unit::StatementKind;

    /// What each statement does, with the path to it.
    pub(super) fn statements(model: &UnitModel) -> Vec<String> {
        let name = |access: u32| model.object(model.accesses[access as usize].object).text.to_string();
        let mut lines = Vec::new();
        for it in &model.statements {
            let what = match it.kind {
                StatementKind::Assign { access, value } | StatementKind::Store { access, value } => {
                    format!("{} := {}", name(access), show(model, value))
                }
                StatementKind::Set { access, when } => format!("set {} when {}", name(access), show(model, when)),
                StatementKind::Reset { access, when } => format!("reset {} when {}", name(access), show(model, when)),
                StatementKind::Drive { access, pin, when, .. } => {
                    format!("{} of {} when {}", pin.describe(), name(access), show(model, when))
                }
                StatementKind::Call(call) => {
                    let call = &model.calls[call as usize];
                    format!("call {} when {}", call.text, show(model, call.when))
                }
                StatementKind::Jump(jump) => format!("jump when {}", show(model, model.jumps[jump as usize].when)),
                StatementKind::Return { when, .. } => format!("return when {}", show(model, when)),
                StatementKind::Branch { condition, .. } => format!("branch on {}", show(model, condition)),
                StatementKind::Halt => "halt".to_owned(),
                _ => continue,
            };
            let path = show(model, it.path);
            lines.push(if path == "true" { what } else { format!("{path}: {what}") });
        }
        lines
    }

    /// An expression, written out.
    pub(super) fn show(model: &UnitModel, id: ExprId) -> String {
        match model.exprs.get(id) {
            Expr::Bool(value) => value.to_string(),
            Expr::Int(value) => value.to_string(),
            Expr::Float(bits) => format!("{:?}", f64::from_bits(*bits)),
            Expr::Text(text) => text.to_string(),
            Expr::Read { object, .. } => model.object(*object).text.to_string(),
            Expr::Edge { object, rising, .. } => {
                format!("{}{}", if *rising { "^" } else { "v" }, model.object(*object).text)
            }
            Expr::Not(a) => format!("!{}", show(model, *a)),
            Expr::And(a, b) => format!("({} & {})", show(model, *a), show(model, *b)),
            Expr::Or(a, b) => format!("({} | {})", show(model, *a), show(model, *b)),
            Expr::Xor(a, b) => format!("({} ^ {})", show(model, *a), show(model, *b)),
            Expr::Compare(op, a, b) => format!("({} {} {})", show(model, *a), op.as_str(), show(model, *b)),
            Expr::Binary(op, a, b) => format!("{op:?}({}, {})", show(model, *a), show(model, *b)),
            Expr::Negate(a) => format!("-{}", show(model, *a)),
            Expr::Call(name, list) => {
                let list: Vec<String> = list.iter().map(|it| show(model, *it)).collect();
                format!("{name}({})", list.join(", "))
            }
            Expr::Opaque(_) => "?".to_owned(),
        }
    }
}

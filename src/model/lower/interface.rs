//! What a STEP 7 block declares: its parameters and variables, the fields of a data block or of a type.

use super::builder::Builder;
use crate::model::layout::{DataType, Field};
use crate::model::unit::Section;
use crate::syntax::AstNode as _;
use crate::syntax::SyntaxNode;
use crate::syntax::awl::ast;

/// All that a block declares; of a data block that goes by another's declarations, that block. A function that returns a
/// value has the parameter `RET_VAL`.
pub(super) fn declared(block: SyntaxNode<'_>, b: &mut Builder) -> DataType {
    let typed = ast::Block::cast(block);
    let keyword = typed.and_then(|it| it.header()?.keyword().map(|it| it.text().to_ascii_uppercase()));
    let of = typed.and_then(|it| it.type_ref());
    let mut fields = Vec::new();
    for section in block.children().filter_map(ast::VarSection::cast) {
        let Some(keyword) = section.keyword() else { continue };
        let kind = match keyword.text().to_ascii_uppercase().as_str() {
            "VAR_INPUT" => Section::Input,
            "VAR_OUTPUT" => Section::Output,
            "VAR_IN_OUT" => Section::InOut,
            "VAR_TEMP" => Section::Temp,
            _ => Section::Static,
        };
        add(&mut fields, section.decls(), kind, b);
    }
    match (keyword.as_deref(), of) {
        (Some("DATA_BLOCK"), Some(of)) => return DataType::parse(&of.text()),
        (Some("FUNCTION"), Some(of)) if !of.text().trim().eq_ignore_ascii_case("VOID") => {
            let anchor = b.anchor(of.range());
            let ty = DataType::parse(&of.text());
            fields.push(Field { name: "ret_val".into(), section: Section::Output, ty, anchor });
        }
        _ => {}
    }
    DataType::Struct(fields.into())
}

fn add<'t>(fields: &mut Vec<Field>, decls: impl Iterator<Item = ast::VarDecl<'t>>, section: Section, b: &mut Builder) {
    // `x AT y` is another view of a variable, and has no place of its own.
    for decl in decls.filter(|it| it.view_of().is_none()) {
        let ty = data_type(decl.type_ref(), decl.array_type(), decl.struct_type(), section, b);
        for name in decl.names() {
            let anchor = b.anchor(name.range());
            fields.push(Field { name: name.text().to_lowercase().into(), section, ty: ty.clone(), anchor });
        }
    }
}

fn data_type(
    name: Option<ast::TypeRef<'_>>,
    array: Option<ast::ArrayType<'_>>,
    components: Option<ast::StructType<'_>>,
    section: Section,
    b: &mut Builder,
) -> DataType {
    if let Some(array) = array {
        let number = |it: &str| it.parse::<i32>().ok();
        let bounds: Option<Vec<(i32, i32)>> =
            array.bounds().iter().map(|(low, high)| Some((number(low)?, number(high)?))).collect();
        let of = data_type(array.type_ref(), array.array_type(), array.struct_type(), section, b);
        return match bounds.filter(|it| !it.is_empty()) {
            Some(bounds) => DataType::Array(bounds.into(), Box::new(of)),
            None => DataType::Unknown,
        };
    }
    if let Some(components) = components {
        let mut fields = Vec::new();
        add(&mut fields, components.decls(), section, b);
        return DataType::Struct(fields.into());
    }
    name.map_or(DataType::Unknown, |it| DataType::parse(&it.text()))
}

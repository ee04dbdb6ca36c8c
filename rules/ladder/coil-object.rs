//! L010: a coil on an object that cannot have one.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Class, Object, Rights, Type, pl72};
use crate::syntax::pl7::ast::{Cell, Expr};
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for cell in cx.nodes(SyntaxKind::Cell).filter_map(Cell::cast) {
        let is_saved = match cell.element() {
            Some(Element::SaveCoil) => true,
            Some(Element::Coil | Element::NotCoil | Element::SetCoil | Element::ResetCoil) => false,
            _ => continue,
        };
        let Some(operand @ Expr::Object(it)) = cell.operand() else { continue };
        let Ok(address) = pl72::parse(&it.address()) else { continue };
        let object = address.object;
        let place = operand.syntax().text_range();
        if matches!(object.ty, Type::BitTable(_)) {
            let message = format!("a coil takes one bit, and `{}` is a string of them", object.text);
            sink.report(place, message).note("strings are for transfers, according to PL72:986-990");
        } else if is_saved && object.is_bit() && !may_be_saved(&object) && !is_read_only(&object) {
            let message = format!("`{}` cannot be saved: saved coils are for outputs and internal bits", object.text);
            sink.report(place, message).note("the table of coils is at PL72:410");
        }
    }
}

/// `Oxy,i`, `Ox,i`, `Bi` (PL72:410).
fn may_be_saved(object: &Object) -> bool {
    matches!(object.class, Class::Output | Class::Memory) && !object.extracted
}

/// The business of W004, whatever the coil.
fn is_read_only(object: &Object) -> bool {
    matches!(object.rights, Rights::ReadOnly(_))
}

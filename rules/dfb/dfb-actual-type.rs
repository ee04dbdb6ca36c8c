//! F012: an actual of a DFB of another type than its parameter.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::{Item, ItemType, Role};
use crate::model::object::{Class, Object, Type};
use crate::model::pl7_kinds::Kind;
use crate::model::unit::Given;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (call, _, unit, interface) in cx.program.instance_calls() {
        for actual in &call.it.actuals {
            let Some(item) = interface.parameter(actual.slot) else { continue };
            let flaw = match actual.given {
                Given::Object(_) => cx.program.given_object(call.unit, actual).and_then(|it| of_object(item, it)),
                Given::Wire if item.ty.is_bit() && item.role != Role::InOut || item.ty == ItemType::Unknown => None,
                Given::Wire => Some("a wire".to_owned()),
                // Of values that an in/out or an output is given, F014 speaks.
                Given::Constant(kind) | Given::Expression(kind) if item.role == Role::Input => {
                    of_value(item.ty, kind, matches!(actual.given, Given::Constant(_)))
                }
                Given::Constant(_) | Given::Expression(_) | Given::Unknown => None,
            };
            let Some(flaw) = flaw else { continue };
            let (role, name, ty) = (item.role.describe(), &item.name, item.ty.describe());
            let message = format!("the {role} `{name}` of `{}` is of type {ty}, and is given {flaw}", call.it.text);
            sink.report(Site { unit: call.unit, anchor: actual.anchor }, message)
                .related(Site { unit, anchor: item.ty_anchor }, "the type of the parameter");
        }
    }
}

/// What an object is that does not fit.
fn of_object(item: &Item, object: &Object) -> Option<String> {
    if !item.ty.takes(object.ty) {
        return Some(match object.ty {
            Type::DoubleTable(_) => format!("`{}`, a table of double words", object.text),
            ty => format!("`{}`, {}", object.text, Kind::of_type(ty).describe()),
        });
    }
    // Of what an in/out is given, the former state must be kept or not as the type says (PL7:5382, 5591).
    match item.ty {
        ItemType::Ebool if item.role == Role::InOut && object.extracted => {
            Some(format!("`{}`, a BOOL, which keeps no former state", object.text))
        }
        ItemType::Bool if item.role == Role::InOut && is_ebool(object) => Some(format!("`{}`, an EBOOL", object.text)),
        _ => None,
    }
}

/// Whether an object is surely of type EBOOL (PL7:5382).
fn is_ebool(object: &Object) -> bool {
    matches!(object.class, Class::Memory | Class::Input | Class::Output) && object.is_bit() && !object.extracted
}

/// What a value is that an input cannot take.
fn of_value(ty: ItemType, kind: Kind, is_constant: bool) -> Option<String> {
    let fits = match (ty, kind) {
        (ItemType::Unknown, _) | (_, Kind::Unknown) => true,
        // A constant 0 or 1 is a bit; expressions of bits are not taken (PL7:5659).
        (ItemType::Bool | ItemType::Ebool, kind) => is_constant && matches!(kind, Kind::Bit | Kind::Integer),
        (ItemType::Word | ItemType::Double, kind) => kind.is_integer(),
        (ItemType::Real, kind) => kind.is_float(),
        (ItemType::Text(_), kind) => kind == Kind::Text,
        (ItemType::Array(..), _) => false,
    };
    let what = if is_constant { "a constant that is" } else { "an expression whose value is" };
    (!fits).then(|| match (ty.is_bit(), kind) {
        (true, Kind::Bit) => "an expression, where only an object or a constant can stand".to_owned(),
        _ => format!("{what} {}", kind.describe()),
    })
}

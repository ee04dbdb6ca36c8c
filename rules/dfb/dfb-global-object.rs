//! F007: an object of the application in the code of a DFB.

use std::collections::BTreeMap;

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Class, Object, Type};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(interface) = &cx.model.interface else { return };
    let mut found: BTreeMap<u32, Vec<TextRange>> = BTreeMap::new();
    for it in &cx.model.accesses {
        let object = cx.model.object(it.object);
        let is_undeclared = object.class == Class::Symbol && !interface.items.is_empty();
        if is_undeclared || is_global(object) {
            found.entry(it.object.0).or_default().push(cx.model.place(it.anchor));
        }
    }
    for (object, places) in found {
        let (Some(object), [first, others @ ..]) = (cx.model.objects.get(object as usize), &places[..]) else {
            continue;
        };
        let message = if object.class == Class::Symbol {
            format!("`{}` is no parameter or variable of the DFB", object.text)
        } else {
            format!("`{}` belongs to the application, which the code of a DFB cannot reach", object.text)
        };
        sink.report(*first, message).related_all(others.iter().map(|it| (*it, "also here".to_owned())));
    }
}

/// Whether an address is one of the application. Channels and function blocks stand in instructions that are not allowed.
fn is_global(object: &Object) -> bool {
    object.ty != Type::Block
        && matches!(
            object.class,
            Class::Input
                | Class::Output
                | Class::Memory
                | Class::Constant
                | Class::Step
                | Class::MacroStep
                | Class::StepTime
                | Class::Fault
                | Class::ModuleWord
                | Class::NetworkWord
        )
}

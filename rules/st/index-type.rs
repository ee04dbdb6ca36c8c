//! T008: an index of a kind that the controller does not take.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Area, Class, Object, Type};
use crate::model::unit::IndexKind;

/// What an index is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fitness {
    Everywhere,
    /// A constant word or an immediate value, which only some controllers take.
    Constant,
    Nowhere,
    Unknown,
}

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let takes_constants = cx.target.has_constant_index();
    for index in &cx.model.indexes {
        let fitness = match index.what {
            IndexKind::Object(object) => fitness(cx.model.object(object)),
            IndexKind::Constant(_) => Fitness::Constant,
            IndexKind::Computed => Fitness::Nowhere,
        };
        let fits = match fitness {
            Fitness::Everywhere | Fitness::Unknown => true,
            Fitness::Constant => takes_constants,
            Fitness::Nowhere => false,
        };
        if fits {
            continue;
        }
        let wanted = if takes_constants {
            "an internal word `%MWi`, a constant word `%KWi` or an immediate value"
        } else {
            "an internal word `%MWi`"
        };
        let on = cx.target.controller().map_or_else(String::new, |it| format!(" on a {it}"));
        let text = match index.what {
            IndexKind::Computed => "an expression".to_owned(),
            _ => format!("`{}`", cx.text_of(index.range)),
        };
        sink.report(index.range, format!("{text} cannot be an index{on}: an index is {wanted}"))
            .note("the kinds of index are given in PL7:1077-1080");
    }
}

fn fitness(object: &Object) -> Fitness {
    match (object.class, object.ty, &object.footprint.area) {
        // A symbol may be any word, and what an erroneous address means is not known.
        (Class::Symbol | Class::Indirect, ..) => Fitness::Unknown,
        // Whether an index may be indexed is not said.
        _ if object.indexed => Fitness::Unknown,
        (Class::Memory, Type::Word, Area::Words) => Fitness::Everywhere,
        (Class::Constant, Type::Word, _) => Fitness::Constant,
        _ => Fitness::Nowhere,
    }
}

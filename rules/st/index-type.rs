//! T008: an index of a kind that the controller does not take.

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::expr::ObjectId;
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

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let takes_constants = cx.target.has_constant_index();
    let wanted = if takes_constants {
        "an internal word `%MWi`, a constant word `%KWi` or an immediate value"
    } else {
        "an internal word `%MWi`"
    };
    let on = cx.target.controller().map_or_else(String::new, |it| format!(" on a {it}"));
    for (unit, facts) in (0..).zip(&cx.program.units) {
        for index in &facts.indexes {
            let object = |it: ObjectId| Some(&facts.objects.get(it.0 as usize)?.object);
            let fitness = match index.what {
                IndexKind::Object(it) => object(it).map_or(Fitness::Unknown, fitness),
                IndexKind::Constant(_) => Fitness::Constant,
                IndexKind::Computed => Fitness::Nowhere,
            };
            let fits = match fitness {
                Fitness::Everywhere | Fitness::Unknown => true,
                Fitness::Constant => takes_constants,
                Fitness::Nowhere => false,
            };
            if !fits {
                let text = match index.what {
                    IndexKind::Object(it) => format!("`{}`", object(it).map_or("", |it| &it.text)),
                    IndexKind::Constant(value) => format!("`{value}`"),
                    IndexKind::Computed => "an expression".to_owned(),
                };
                let message = format!("{text} cannot be an index{on}: an index is {wanted}");
                sink.report(Site { unit, anchor: index.anchor }, message)
                    .note("the kinds of index are given in PL7:1077-1080");
            }
        }
    }
}

fn fitness(object: &Object) -> Fitness {
    match (object.class, object.ty, &object.footprint.area) {
        // A symbol may be any word, and what an erroneous address means is not known. Of the items of a DFB, which uses no
        // other words, the manual does not say which can be an index.
        (Class::Symbol | Class::Indirect | Class::LocalName, ..) => Fitness::Unknown,
        // Whether an index may be indexed is not said.
        _ if object.indexed => Fitness::Unknown,
        (Class::Memory, Type::Word, Area::Words) => Fitness::Everywhere,
        (Class::Constant, Type::Word, _) => Fitness::Constant,
        _ => Fitness::Nowhere,
    }
}

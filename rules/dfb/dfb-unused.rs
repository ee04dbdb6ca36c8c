//! F018: an instance, a parameter or a variable of a DFB that nothing uses.

use std::cell::LazyCell;

use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::dfb::Role;
use crate::model::object::{Area, Class};
use crate::model::symbols::key;
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    items(cx, sink);
    if cx.program.complete {
        instances(cx, sink);
    }
}

/// Of a type whose code is understood: what the code does not name. A public variable may serve the rest of the program.
fn items(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let outside: LazyCell<FxHashSet<(u32, SmolStr)>, _> = LazyCell::new(|| {
        let symbols = cx.program.places(|it| it == Class::Symbol);
        let items = symbols.filter_map(|it| {
            let (instance, item) = it.text.split_once('.')?;
            let (unit, _) = cx.program.dfb_of(instance)?;
            Some((unit, key(item.split(['.', ':', '[']).next().unwrap_or_default())))
        });
        items.collect()
    });
    for (unit, facts) in (0..).zip(&cx.program.units) {
        let Some(interface) =
            facts.interface.as_ref().filter(|_| facts.instructions > 0 && !facts.has_gaps && !facts.is_fragment)
        else {
            continue;
        };
        let named =
            facts.uses.iter().filter_map(|it| match &facts.objects.get(it.object as usize)?.object.footprint.area {
                Area::LocalName(name) => Some(name),
                _ => None,
            });
        let named: FxHashSet<&SmolStr> = named.collect();
        for item in &interface.items {
            let name = key(&item.name);
            if named.contains(&name) || item.role == Role::Public && outside.contains(&(unit, name)) {
                continue;
            }
            let message = format!("the code of the DFB does not use its {} `{}`", item.role.describe(), item.name);
            sink.report(Site { unit, anchor: item.anchor }, message);
        }
    }
}

fn instances(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let called: FxHashSet<SmolStr> = cx
        .program
        .calls
        .iter()
        .filter_map(|it| match &it.it.callee {
            Callee::Instance(name) => Some(key(name)),
            _ => None,
        })
        .collect();
    for (unit, facts) in (0..).zip(&cx.program.units) {
        for symbol in facts.symbols.iter().filter(|it| it.object.is_none() && !called.contains(&key(&it.name))) {
            if cx.program.dfb_of(&symbol.name).is_some() {
                let message = format!("nothing calls `{}`, an instance of the DFB `{}`", symbol.name, symbol.ty);
                sink.report(Site { unit, anchor: symbol.anchor }, message);
            }
        }
    }
}

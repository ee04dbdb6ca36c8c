//! N004: a symbol whose object the program never uses.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::analysis::Site;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::BlockName;
use crate::model::object::{Area, Footprint};
use crate::model::symbols::key;
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    if !program.complete || !program.units.iter().any(|it| it.symbols.iter().any(|it| it.object.is_some())) {
        return;
    }
    let used = Used::new(cx);
    for (unit, facts) in (0..).zip(&program.units) {
        for symbol in &facts.symbols {
            // Code that goes by a symbol with two objects is resolved to neither.
            let by_name = Footprint::new(Area::Symbol(key(&symbol.name)), 0, 1);
            let Some(object) = symbol.object.as_ref() else { continue };
            if used.has_block(&object.footprint.area) {
                continue;
            }
            let raises = cx.settings.events().iter().filter_map(|it| it.trigger.as_ref());
            let is_trigger = raises.into_iter().any(|it| it.get_ref().0.footprint.overlaps(&object.footprint));
            if is_trigger || used.covers(&object.footprint) || used.covers(&by_name) {
                continue;
            }
            let message = format!("the program does not use `{}`, the symbol of `{}`", symbol.name, object.text);
            sink.report(Site { unit, anchor: symbol.anchor }, message)
                .note("this assumes that no operator panel, other station or tool uses it");
        }
    }
}

/// Memory that the program uses.
struct Used<'a> {
    /// Of each area: first and last bit of each stretch, sorted, without overlaps.
    stretches: FxHashMap<&'a Area, Vec<(u32, u32)>>,
    /// Areas of which an index chooses the place.
    indexed: FxHashSet<&'a Area>,
    blocks: FxHashSet<&'a BlockName>,
}

impl<'a> Used<'a> {
    fn new(cx: &ProgramCx<'a>) -> Self {
        let blocks = blocks(cx);
        let mut used = Self { stretches: FxHashMap::default(), indexed: FxHashSet::default(), blocks };
        // Objects are sorted by area and first bit.
        for it in &cx.program.objects {
            let place = &it.object.footprint;
            if it.object.indexed {
                used.indexed.insert(&place.area);
            }
            let list = used.stretches.entry(&place.area).or_default();
            match list.last_mut().filter(|it| place.start < it.1) {
                Some(last) => last.1 = last.1.max(place.end()),
                None => list.push((place.start, place.end())),
            }
        }
        used
    }

    fn has_block(&self, area: &Area) -> bool {
        matches!(area, Area::CodeBlock(name) if self.blocks.contains(name))
    }

    fn covers(&self, place: &Footprint) -> bool {
        let overlaps = |list: &Vec<(u32, u32)>| {
            let at = list.partition_point(|it| it.1 <= place.start);
            list.get(at).is_some_and(|it| it.0 < place.end())
        };
        self.indexed.contains(&place.area) || self.stretches.get(&place.area).is_some_and(overlaps)
    }
}

/// Blocks that the program holds, calls, opens or declares data of.
fn blocks<'a>(cx: &ProgramCx<'a>) -> FxHashSet<&'a BlockName> {
    let mut blocks = FxHashSet::default();
    for facts in &cx.program.units {
        blocks.extend(facts.entity.name());
        blocks.extend(&facts.instance_of);
        for call in &facts.calls {
            blocks.extend(&call.instance);
            if let Callee::Block(name) = &call.callee {
                blocks.insert(name);
            }
        }
        blocks.extend(facts.objects.iter().filter_map(|it| match &it.object.footprint.area {
            Area::Data(name) | Area::CodeBlock(name) => Some(name),
            _ => None,
        }));
        if let Some(declared) = &facts.declared {
            declared.each_named(&mut |it| {
                blocks.insert(it);
            });
        }
    }
    blocks
}

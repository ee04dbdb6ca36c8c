//! The memory and the blocks that a program uses, whatever it does with them.

use rustc_hash::{FxHashMap, FxHashSet};

use super::program::ProgramIndex;
use crate::model::entity::BlockName;
use crate::model::object::{Area, Footprint};
use crate::model::unit::Callee;

/// The memory and the blocks that a program uses.
#[derive(Debug)]
pub struct Used<'a> {
    /// Of each area: first and last bit of each stretch, sorted, without overlaps.
    stretches: FxHashMap<&'a Area, Vec<(u32, u32)>>,
    /// Areas of which an index chooses the place.
    indexed: FxHashSet<&'a Area>,
    blocks: FxHashSet<&'a BlockName>,
}

impl<'a> Used<'a> {
    pub fn new(program: &ProgramIndex<'a>) -> Self {
        let blocks = blocks(program);
        let mut used = Self { stretches: FxHashMap::default(), indexed: FxHashSet::default(), blocks };
        // Objects are sorted by area and first bit.
        for it in &program.objects {
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

    /// Whether an area is that of a block which the program holds, calls, opens or declares data of.
    pub fn has_block(&self, area: &Area) -> bool {
        matches!(area, Area::CodeBlock(name) if self.blocks.contains(name))
    }

    /// Whether some access shares memory with a place, or may: by an index.
    pub fn covers(&self, place: &Footprint) -> bool {
        let overlaps = |list: &Vec<(u32, u32)>| {
            let at = list.partition_point(|it| it.1 <= place.start);
            list.get(at).is_some_and(|it| it.0 < place.end())
        };
        self.indexed.contains(&place.area) || self.stretches.get(&place.area).is_some_and(overlaps)
    }
}

/// Blocks that the program holds, calls, opens or declares data of.
fn blocks<'a>(program: &ProgramIndex<'a>) -> FxHashSet<&'a BlockName> {
    let mut blocks = FxHashSet::default();
    for facts in &program.units {
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

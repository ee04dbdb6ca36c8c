//! The memory and the blocks that a program uses, whatever it does with them.

use rustc_hash::FxHashSet;

use super::program::ProgramIndex;
use super::stretches::Stretches;
use crate::model::entity::BlockName;
use crate::model::object::{Area, Footprint};
use crate::model::unit::Callee;

/// The memory and the blocks that a program uses.
#[derive(Debug)]
pub struct Used<'a> {
    memory: Stretches<'a>,
    /// Areas of which an index chooses the place.
    indexed: FxHashSet<&'a Area>,
    blocks: FxHashSet<&'a BlockName>,
}

impl<'a> Used<'a> {
    pub fn new(program: &'a ProgramIndex<'a>) -> Self {
        let places = || program.places(|_| true);
        let indexed = places().filter(|it| it.indexed).map(|it| &it.footprint.area).collect();
        Self { memory: places().map(|it| &it.footprint).collect(), indexed, blocks: blocks(program) }
    }

    /// Whether an area is that of a block which the program holds, calls, opens or declares data of.
    pub fn has_block(&self, area: &Area) -> bool {
        matches!(area, Area::CodeBlock(name) if self.blocks.contains(name))
    }

    /// Whether some access shares memory with a place, or may: by an index.
    pub fn covers(&self, place: &Footprint) -> bool {
        self.indexed.contains(&place.area) || self.memory.overlap(place)
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

//! Fields of STEP 7's data blocks: `DB1.poids`, `DB1.DBW 2` and, in the function block whose only instance that is, `#poids`
//! are one object.
//!
//! The declarations of all blocks are needed for that, so it comes after symbols, and before
//! [`ProgramIndex`](super::program::ProgramIndex).

use std::borrow::Cow;

use rustc_hash::{FxHashMap, FxHashSet};

use super::facts::{FactObject, UnitFacts};
use super::symbols::join_aliases;
use crate::model::entity::{BlockKind, BlockName};
use crate::model::layout::{Elementary, Layouts, Place};
use crate::model::object::{Area, Class, Footprint, Object, Rights, Type, step7};
use crate::model::unit::{Mode, Section};

/// The layouts of all blocks that the units declare.
pub fn layouts<'a>(units: impl IntoIterator<Item = &'a UnitFacts>) -> Layouts {
    let blocks = units.into_iter().filter_map(|it| Some((it.entity.name()?, it.declared.as_deref()?)));
    Layouts::new(blocks)
}

/// The facts of the units of a program with the places of the fields that they name.
pub fn resolve(units: Vec<Cow<'_, UnitFacts>>) -> Vec<Cow<'_, UnitFacts>> {
    let layouts = layouts(units.iter().map(AsRef::as_ref));
    let instances = Instances::new(units.iter().map(AsRef::as_ref));
    units.into_iter().map(|it| resolve_unit(&layouts, &instances, it)).collect()
}

/// Of each function block, the data block that is its only instance, if other blocks look into that.
struct Instances(FxHashMap<BlockName, BlockName>);

impl Instances {
    fn new<'a>(units: impl Iterator<Item = &'a UnitFacts> + Clone) -> Self {
        let mut only: FxHashMap<&BlockName, Vec<&BlockName>> = FxHashMap::default();
        let mut nested: FxHashSet<&BlockName> = FxHashSet::default();
        let mut seen: FxHashSet<BlockName> = FxHashSet::default();
        for facts in units {
            if let (Some(of), Some(name)) = (&facts.instance_of, facts.entity.name()) {
                only.entry(of).or_default().push(name);
            } else if let Some(declared) = &facts.declared {
                declared.each_named(&mut |it| {
                    nested.insert(it);
                });
            }
            seen.extend(facts.objects.iter().filter_map(|it| match &it.object.footprint.area {
                Area::Data(name) => Some(name.clone()),
                _ => step7::field(&it.object).map(|it| it.0),
            }));
        }
        let only = only.into_iter().filter_map(|(of, names)| match names[..] {
            [name] if seen.contains(name) && !nested.contains(of) => Some((of.clone(), name.clone())),
            _ => None,
        });
        Self(only.collect())
    }

    /// The instance that the variables of a unit lie in.
    fn of(&self, facts: &UnitFacts) -> Option<&BlockName> {
        let name = facts.entity.name().filter(|_| facts.entity.block_kind() == Some(BlockKind::Fb))?;
        self.0.get(name)
    }
}

fn resolve_unit<'a>(layouts: &Layouts, instances: &Instances, facts: Cow<'a, UnitFacts>) -> Cow<'a, UnitFacts> {
    let instance = instances.of(&facts);
    let found: Vec<Option<Object>> =
        facts.objects.iter().map(|it| place(layouts, &facts, instance, &it.object)).collect();
    if found.iter().all(Option::is_none) {
        return facts;
    }
    let mut facts = facts.into_owned();
    for it in &mut facts.uses {
        // Code writes `=` for a bit and `T` for anything else: the mode says what it is, unless the place says otherwise.
        if let Some(Some(object)) = found.get(it.object as usize) {
            it.mode = match (it.mode, object.ty) {
                (Mode::Store, Type::Bool) => Mode::Assign,
                (mode, _) => mode,
            };
        }
    }
    for (fact, object) in facts.objects.iter_mut().zip(found) {
        if let Some(object) = object {
            *fact = FactObject::new(&object, fact.number, fact.missed);
        }
    }
    join_aliases(&mut facts);
    Cow::Owned(facts)
}

/// The object at the place that a field has.
fn place(layouts: &Layouts, facts: &UnitFacts, instance: Option<&BlockName>, object: &Object) -> Option<Object> {
    let at = |block: &BlockName, it: &Place| Object {
        class: Class::Data,
        ty: it.ty.map_or(Type::Unknown, Elementary::operand),
        footprint: Footprint::new(Area::Data(block.clone()), it.start, it.bits),
        rights: Rights::ReadWrite,
        ..object.clone()
    };
    if let Some((block, path)) = step7::field(object) {
        return Some(at(&block, &layouts.of(&block)?.place(&path)?));
    }
    if object.footprint.area != Area::OpenInstance || facts.opens_instance {
        return None;
    }
    // What a call gives and takes is written and read by the call.
    let block = instance?;
    layouts.of(block)?.at(object.footprint.start).filter(|it| it.section == Section::Static)?;
    let area = Area::Data(block.clone());
    Some(Object { class: Class::Data, footprint: Footprint { area, ..object.footprint.clone() }, ..object.clone() })
}

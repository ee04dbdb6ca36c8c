//! Fields of STEP 7's data blocks: `DB1.poids`, `DB1.DBW 2` and, in the function block whose only instance that is, `#poids`
//! are one object.
//!
//! The declarations of all blocks are needed for that, so it comes after symbols, and before
//! [`ProgramIndex`](super::program::ProgramIndex).

use std::borrow::Cow;
use std::sync::Arc;

use rustc_hash::{FxHashMap, FxHashSet};

use super::facts::{FactObject, UnitFacts};
use super::symbols::join_aliases;
use crate::model::entity::{BlockKind, BlockName};
use crate::model::layout::{DataType, Elementary, Layouts, Place};
use crate::model::object::{Area, Class, Footprint, Object, Rights, Type, step7};
use crate::model::unit::{Mode, Section};

/// The layouts of all blocks that the units declare.
pub fn layouts<'a>(units: impl IntoIterator<Item = &'a UnitFacts>) -> Layouts {
    let blocks = units.into_iter().filter_map(|it| Some((it.entity.name()?, lasting(it)?)));
    Layouts::new(blocks)
}

/// What a unit declares that lies in a data block: functions and organization blocks keep nothing.
fn lasting(facts: &UnitFacts) -> Option<&DataType> {
    let keeps = !matches!(facts.entity.block_kind(), Some(BlockKind::Fc | BlockKind::Ob));
    facts.declared.as_deref().filter(|_| keeps)
}

/// What a unit declares, and into which data blocks it looks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Declaration {
    name: Option<BlockName>,
    declared: Option<Box<DataType>>,
    instance_of: Option<BlockName>,
    /// Sorted, each once.
    looks_into: Vec<BlockName>,
}

impl Declaration {
    /// `facts`: symbols resolved.
    pub fn new(facts: &UnitFacts) -> Self {
        let objects = facts.objects.iter().filter_map(|it| match &it.object.footprint.area {
            Area::Data(name) => Some(name.clone()),
            _ => step7::field(&it.object).map(|it| it.0),
        });
        let mut looks_into: Vec<BlockName> = objects.collect();
        looks_into.sort_unstable();
        looks_into.dedup();
        let declared = lasting(facts).cloned().map(Box::new);
        Self { name: facts.entity.name().cloned(), declared, instance_of: facts.instance_of.clone(), looks_into }
    }
}

/// The declarations of all units of a program.
#[derive(Debug, PartialEq, Eq)]
pub struct Declarations {
    layouts: Arc<Layouts>,
    instances: Instances,
}

impl Declarations {
    pub fn new<'a>(units: impl Iterator<Item = &'a Declaration> + Clone) -> Self {
        let blocks = units.clone().filter_map(|it| Some((it.name.as_ref()?, it.declared.as_deref()?)));
        Self { layouts: Arc::new(Layouts::new(blocks)), instances: Instances::new(units) }
    }

    /// What [`layouts`] makes of the facts of these units.
    pub fn layouts(&self) -> &Arc<Layouts> {
        &self.layouts
    }

    /// The facts of a unit, symbols resolved, with the places of the fields that they name.
    pub fn resolve<'a>(&self, facts: Cow<'a, UnitFacts>) -> Cow<'a, UnitFacts> {
        resolve_unit(&self.layouts, &self.instances, facts)
    }
}

/// Of each function block, the data block that is its only instance, if other blocks look into that.
#[derive(Debug, PartialEq, Eq)]
struct Instances(FxHashMap<BlockName, BlockName>);

impl Instances {
    fn new<'a>(units: impl Iterator<Item = &'a Declaration>) -> Self {
        let mut only: FxHashMap<&BlockName, Vec<&BlockName>> = FxHashMap::default();
        let mut nested: FxHashSet<&BlockName> = FxHashSet::default();
        let mut seen: FxHashSet<&BlockName> = FxHashSet::default();
        for it in units {
            if let (Some(of), Some(name)) = (&it.instance_of, &it.name) {
                only.entry(of).or_default().push(name);
            } else if let Some(declared) = &it.declared {
                declared.each_named(&mut |it| {
                    nested.insert(it);
                });
            }
            seen.extend(&it.looks_into);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::program::ProgramIndex;
    use crate::analysis::symbols::{self, SymbolTable};
    use crate::model::entity::{Entity, Family};
    use crate::model::lower;
    use crate::source::detect::Detected;
    use crate::source::split::{SplitHint, split};
    use crate::syntax::{self, Language, Mnemonics};

    /// Facts of the blocks of a source, and of a symbol table.
    fn program(text: &str, table: &str) -> Vec<UnitFacts> {
        let hint = SplitHint { entity: None, mnemonics: Some(Mnemonics::German) };
        let mut units: Vec<UnitFacts> = split(text, Detected::Step7, &hint)
            .into_iter()
            .map(|it| {
                let part = &text[std::ops::Range::<usize>::from(it.range)];
                let parse = syntax::parse(it.language, part);
                assert_eq!(parse.errors(), [], "{part}");
                UnitFacts::new(&lower::lower(parse.syntax(), part, it.entity, it.language))
            })
            .collect();
        let parse = syntax::parse(Language::SymbolTable, table);
        assert_eq!(parse.errors(), []);
        units.push(UnitFacts::new(&lower::lower(parse.syntax(), table, Entity::Container, Language::SymbolTable)));
        units
    }

    /// The objects of data blocks with how often the program uses them.
    fn data(text: &str, table: &str) -> Vec<String> {
        let units = program(text, table);
        let table = SymbolTable::new(Family::Step7, &units);
        let units: Vec<_> = units.iter().map(|it| symbols::resolve(&table, it)).collect();
        let declared: Vec<Declaration> = units.iter().map(|it| Declaration::new(it)).collect();
        let declarations = Declarations::new(declared.iter());
        let units: Vec<_> = units.into_iter().map(|it| declarations.resolve(it)).collect();
        let index = ProgramIndex::new(Family::Step7, units.iter().map(AsRef::as_ref).collect());
        let objects = index.objects.iter().filter(|it| it.object.class == Class::Data);
        objects
            .map(|it| {
                let place = &it.object.footprint;
                let Area::Data(block) = &place.area else { return format!("{} ?", it.object.text) };
                format!("{block} {}.{} {} uses", place.start / 8, place.start % 8, it.uses.len())
            })
            .collect()
    }

    const BLOCKS: &str = "DATA_BLOCK DB 1\nSTRUCT\n a : BOOL;\n poids : WORD;\n tab : ARRAY [1..3] OF INT;\nEND_STRUCT;\nBEGIN\n\
                          END_DATA_BLOCK\n";

    #[test]
    fn a_field_by_its_name_its_address_and_its_block() {
        let code = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n L DB1.poids;\n T DB1.DBW 2;\n AUF DB 1;\n L DBW 2;\n T \"Data\".Poids;\n\
                    L \"Data\".DBW 2;\n T DB1.tab[3];\n U \"data\".a;\n = DB1.missing;\nEND_FUNCTION\n";
        let found = data(&format!("{BLOCKS}{code}"), "\"Data\",\"DB 1\",\"DB 1\",\"\"\n");
        assert_eq!(found, ["DB1 0.0 1 uses", "DB1 2.0 5 uses", "DB1 8.0 1 uses", "DB1.missing ?"]);
    }

    #[test]
    fn a_full_name_opens_its_block() {
        let code = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n L \"Data\".poids;\n T DBW 4;\n AUF \"Data\";\n L DBW 4;\n T MW 0;\nEND_FUNCTION\n";
        let found = data(&format!("{BLOCKS}{code}"), "\"Data\",\"DB 1\",\"DB 1\",\"\"\n");
        assert_eq!(found, ["DB1 2.0 1 uses", "DB1 4.0 2 uses"]);
    }

    const INSTANCE: &str = "FUNCTION_BLOCK FB 1\nVAR_INPUT\n go : BOOL;\nEND_VAR\nVAR\n n : INT;\n s : BOOL;\nEND_VAR\nBEGIN\nNETWORK\n\
                            U #go;\n = #s;\n L DIW 2;\n T #n;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 5\nFB 1\nBEGIN\nEND_DATA_BLOCK\n\
                            ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n L DB5.n;\n T MW 0;\n U DB5.DBX 4.0;\n = A 4.0;\n";

    #[test]
    fn variables_lie_in_the_only_instance() {
        let end = "END_ORGANIZATION_BLOCK\n";
        let found = data(&format!("{INSTANCE}{end}"), "");
        assert_eq!(found, ["DB5 2.0 3 uses", "DB5 4.0 2 uses"], "what the call gives is not among them");
        let second = "END_ORGANIZATION_BLOCK\nDATA_BLOCK DB 6\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
        let found = data(&format!("{INSTANCE}{second}"), "");
        assert_eq!(found, ["DB5 2.0 1 uses", "DB5 4.0 1 uses"], "which instance it is, hangs on the call");
    }

    #[test]
    fn symbols_of_blocks_and_timers() {
        let code = "FUNCTION_BLOCK \"Motor\"\nBEGIN\nNETWORK\nEND_FUNCTION_BLOCK\nORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n\
                    CALL FB 1, \"Motor_1\";\n U E 0.0;\n L C#3;\n S \"count.\";\n U Z 2;\n = A 4.0;\nEND_ORGANIZATION_BLOCK\n";
        let table = "\"Motor\",\"FB 1\",\"FB 1\",\"\"\n\"Motor_1\",\"DB 7\",\"FB 1\",\"\"\n\"count.\",\"C 2\",\"COUNTER\",\"\"\n";
        let units = program(code, table);
        let table = SymbolTable::new(Family::Step7, &units);
        let units: Vec<_> = units.iter().map(|it| symbols::resolve(&table, it)).collect();
        let index = ProgramIndex::new(Family::Step7, units.iter().map(AsRef::as_ref).collect());
        assert_eq!(index.calls[0].target, Some(0), "the block is called by its number, and defined by its symbol");
        assert_eq!(index.calls[0].it.instance, Some(BlockName::Number(BlockKind::Db, 7)));
        let counter = index.objects.iter().find(|it| it.object.class == Class::Counter).unwrap();
        assert_eq!(counter.uses.len(), 2, "`C 2` and `Z 2` are one counter");
        assert!(matches!(counter.uses[0].mode, Mode::Drive(_)));
        assert_eq!(table.annotate("`Z2` and `FB1`"), "`Z2` (`\"count.\"`) and `FB1` (`\"Motor\"`)");
    }
}

//! What stands at a place, in terms of the program: what all requests about a position share.

use rowan::{TextRange, TextSize};
use smol_str::SmolStr;

use super::snapshot::InFile;
use crate::analysis::Site;
use crate::analysis::facts::{FactSymbol, UnitFacts};
use crate::analysis::program::{GlobalCall, GlobalUse, ProgramIndex};
use crate::db::{self, FilePlace, Places, Program, Unit};
use crate::model::UnitModel;
use crate::model::chart::{Graph, StepName};
use crate::model::dfb::Item;
use crate::model::entity::{BlockKind, Entity, Family, Part};
use crate::model::layout::{DataType, Elementary, Field, Place};
use crate::model::object::{Area, Class, Footprint, Object, Rights, Type, pl7, pl72, step7};
use crate::model::symbols::key;
use crate::model::unit::{Callee, Mode};
use crate::syntax::{SyntaxKind, SyntaxToken};

/// The unit that holds a place, in its program.
pub(super) struct InUnit<'s> {
    pub(super) it: InFile<'s>,
    pub(super) unit: Unit<'s>,
    /// Where the unit starts in the file.
    pub(super) offset: TextSize,
    /// The place, in the unit.
    pub(super) at: TextSize,
    pub(super) model: &'s UnitModel,
}

/// What a place names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum What {
    /// An object of the unit, by index.
    Object(u32),
    /// A label or a jump to it.
    Label { name: SmolStr, part: u32 },
    /// A call, by index.
    Call(u32),
    /// A declaration of the unit, by index.
    Declaration(u32),
    /// A parameter or variable of a DFB type, by index.
    Item(u32),
    /// The declaration of a symbol, by index.
    Symbol(u32),
    /// A step of a chart, by index.
    Step(u32),
    /// The heading of the unit.
    Heading,
}

/// What stands at a place, with its range in the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Target {
    pub(super) what: What,
    pub(super) range: TextRange,
}

impl<'s> InUnit<'s> {
    pub(super) fn at(it: InFile<'s>, at: TextSize) -> Option<Self> {
        let layout = db::layout(it.db, it.file);
        let units = layout.iter().enumerate().take_while(|(_, unit)| unit.1 <= u32::from(at));
        // Behind the last character of a unit, the unit is still meant; before the first of the next, that one.
        let (_, &(unit, offset)) = units.last()?;
        let offset = TextSize::new(offset);
        Some(Self { it, unit, offset, at: at.checked_sub(offset)?, model: db::model(it.db, unit) })
    }

    /// A range of the unit as one of the file.
    pub(super) fn in_file(&self, range: TextRange) -> TextRange {
        range.checked_add(self.offset).unwrap_or(range)
    }

    pub(super) fn text(&self, range: TextRange) -> &'s str {
        self.unit.text(self.it.db).get(std::ops::Range::<usize>::from(range)).unwrap_or_default()
    }

    /// What stands at the place: of several things the shortest, of those the first.
    pub(super) fn target(&self) -> Option<Target> {
        let model = self.model;
        let mut best: Option<Target> = None;
        let mut offer = |range: TextRange, what: &dyn Fn() -> What| {
            let is_better = range.contains_inclusive(self.at)
                && !range.is_empty()
                && best.as_ref().is_none_or(|it| range.len() < it.range.len());
            if is_better {
                best = Some(Target { what: what(), range });
            }
        };
        let number = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        for it in &model.labels {
            offer(it.range, &|| What::Label { name: it.name.clone(), part: it.part });
        }
        for it in &model.jumps {
            offer(it.range, &|| What::Label { name: it.label.clone(), part: it.part });
        }
        for (at, it) in model.calls.iter().enumerate() {
            offer(model.place(it.anchor), &|| What::Call(number(at)));
        }
        for it in &model.accesses {
            offer(model.place(it.anchor), &|| What::Object(it.object.0));
        }
        for (at, it) in model.fields().iter().enumerate() {
            offer(model.place(it.anchor), &|| What::Declaration(number(at)));
        }
        for (at, it) in model.interface.iter().flat_map(|it| it.items.iter().enumerate()) {
            offer(model.place(it.anchor), &|| What::Item(number(at)));
        }
        for (at, it) in model.symbols.iter().enumerate() {
            offer(model.place(it.anchor), &|| What::Symbol(number(at)));
        }
        for (at, it) in model.chart.iter().flat_map(|it| it.steps.iter().enumerate()) {
            offer(it.range, &|| What::Step(number(at)));
        }
        if !matches!(self.unit.entity(self.it.db), Entity::Listing | Entity::Container) {
            offer(model.heading(), &|| What::Heading);
        }
        best
    }

    /// The token at the place that is no blank.
    pub(super) fn token(&self) -> Option<SyntaxToken<'s>> {
        let tree = db::tree(self.it.db, self.unit);
        let tokens = tree.syntax().descendant_tokens();
        let touching = tokens
            .skip_while(|it| it.text_range().end() < self.at)
            .take_while(|it| it.text_range().start() <= self.at)
            .filter(|it| !matches!(it.kind(), SyntaxKind::Whitespace | SyntaxKind::Newline));
        // Of two that meet there, the word counts, and else the one behind.
        let tokens: Vec<SyntaxToken<'_>> = touching.collect();
        tokens.iter().copied().find(|it| it.kind() == SyntaxKind::Ident).or(tokens.last().copied())
    }

    /// The program of the unit and the number of the unit in it.
    pub(super) fn program(&self) -> Option<(Program<'s>, u32)> {
        program_with(self.it, self.unit)
    }
}

/// The program that a unit of the file belongs to, and its number there.
pub(super) fn program_with<'s>(it: InFile<'s>, unit: Unit<'s>) -> Option<(Program<'s>, u32)> {
    db::programs_of(it.db, it.file).iter().find_map(|&program| {
        let at = db::program_units(it.db, program).iter().position(|it| *it == unit)?;
        Some((program, u32::try_from(at).ok()?))
    })
}

/// A program with its facts, which an index borrows from.
pub(super) struct InProgram<'s> {
    pub(super) it: InFile<'s>,
    pub(super) program: Program<'s>,
    facts: db::Facts,
}

impl<'s> InProgram<'s> {
    pub(super) fn new(it: InFile<'s>, program: Program<'s>) -> Self {
        Self { it, program, facts: db::program_facts(it.db, program) }
    }

    pub(super) fn index(&self) -> ProgramIndex<'_> {
        db::index(self.it.db, self.program, &self.facts)
    }

    pub(super) fn places(&self) -> Places<'s> {
        Places::new(self.it.db, self.program)
    }
}

/// An object that a place names, as its program sees it.
#[derive(Debug, Clone)]
pub(super) struct Named {
    /// With the address in place of a symbol.
    pub(super) object: Object,
    /// For an object that only its own unit knows: that unit.
    pub(super) only_in: Option<u32>,
}

impl Named {
    pub(super) fn new(cursor: &InUnit<'_>, target: &Target, unit: u32, index: &ProgramIndex<'_>) -> Option<Self> {
        let model = cursor.model;
        let facts = index.units.get(unit as usize)?;
        let of_unit = |object: u32| {
            let fact = facts.objects.get(object as usize)?;
            Some(Self { object: fact.object.clone(), only_in: (fact.hash == 0).then_some(unit) })
        };
        // The whole of it, not a part.
        let local = |name: &str| {
            let is_it = |it: &Object| is_local(it) && key(it.text.trim_start_matches('#')) == key(name);
            let found = facts.objects.iter().position(|it| is_it(&it.object));
            found.and_then(|it| of_unit(u32::try_from(it).ok()?))
        };
        match &target.what {
            What::Object(object) => of_unit(*object),
            What::Declaration(at) => {
                let name = &model.fields().get(*at as usize)?.name;
                let found = of_data_block(facts, name, index).map(|object| Self { object, only_in: None });
                let is_data = facts.entity.block_kind().is_some_and(BlockKind::is_data);
                found.or_else(|| local(name)).or_else(|| (!is_data).then(|| Self::declared(name, unit)))
            }
            What::Item(at) => {
                let name = &model.interface.as_ref()?.items.get(*at as usize)?.name;
                local(name).or_else(|| Some(Self::declared(name, unit)))
            }
            What::Symbol(at) => {
                let object = model.symbols.get(*at as usize)?.object.clone()?;
                Some(Self { object, only_in: None })
            }
            What::Step(at) => {
                let name = model.chart.as_ref()?.steps.get(*at as usize)?.name.as_ref()?;
                Some(Self { object: step_bit(name, facts.chart.as_ref()?.graph, index.family)?, only_in: None })
            }
            What::Label { .. } | What::Call(_) | What::Heading => None,
        }
    }

    /// A name that a unit declares, and of which it uses parts at most.
    fn declared(name: &str, unit: u32) -> Self {
        let object = Object { class: Class::LocalName, ..Object::symbol(name) };
        Self { object, only_in: Some(unit) }
    }

    /// Uses of the object and of all that shares memory with it, with what is used.
    pub(super) fn uses<'i, 'a>(&self, index: &'i ProgramIndex<'a>) -> Vec<(&'i Object, GlobalUse<'a>)>
    where
        'a: 'i,
    {
        let is_meant = |it: &Object| {
            if self.object.is_fixed() && it.is_fixed() {
                return it.footprint.overlaps(&self.object.footprint);
            }
            // Where an index leads is not known: what is written alike is meant.
            !self.object.is_fixed()
                && (it.indexed, it.ty) == (self.object.indexed, self.object.ty)
                && it.footprint == self.object.footprint
                && it.text == self.object.text
        };
        if let Some(unit) = self.only_in {
            let Some(&facts) = index.units.get(unit as usize) else { return Vec::new() };
            let is_whole = is_local(&self.object) && !self.object.text.contains(['.', '[', ':']);
            let name = self.object.text.trim_start_matches('#');
            let uses = facts.uses.iter().filter_map(|it| {
                let object = &facts.objects.get(it.object as usize)?.object;
                let is_part = is_whole && is_local(object) && is_named(object, name);
                (is_meant(object) || is_part).then_some((object, GlobalUse { unit, mode: it.mode, it }))
            });
            return uses.collect();
        }
        let objects = index.objects.iter().filter(|it| is_meant(it.object));
        objects.flat_map(|it| it.uses.iter().map(move |used| (it.object, *used))).collect()
    }
}

/// What a call, the heading of a unit, or the declaration of an instance names.
pub(super) struct Called {
    /// Symbols resolved. `None` for a heading.
    pub(super) callee: Option<Callee>,
    /// The unit that is called, where the program holds it.
    pub(super) unit: Option<u32>,
    /// The unit that names it.
    by: u32,
}

impl Called {
    pub(super) fn new(cursor: &InUnit<'_>, target: &Target, unit: u32, index: &ProgramIndex<'_>) -> Option<Self> {
        let (callee, called) = match &target.what {
            What::Call(at) => match index.calls.iter().find(|it| (it.unit, it.index) == (unit, *at)) {
                Some(call) => (call.it.callee.clone(), call.target),
                None => (cursor.model.calls.get(*at as usize)?.callee.clone(), None),
            },
            What::Symbol(at) => {
                let symbol = cursor.model.symbols.get(*at as usize).filter(|it| it.object.is_none())?;
                let ty = dfb(&symbol.ty, index);
                (Callee::Instance(key(&symbol.name)), ty)
            }
            What::Heading => return Some(Self { callee: None, unit: Some(unit), by: unit }),
            _ => return None,
        };
        Some(Self { callee: Some(callee), unit: called, by: unit })
    }

    /// The calls of the same unit; of an instance, the calls of that instance.
    pub(super) fn calls<'i, 'a>(&'i self, index: &'i ProgramIndex<'a>) -> impl Iterator<Item = &'i GlobalCall<'a>> {
        index.calls.iter().filter(|it| match (&self.callee, self.unit) {
            (Some(callee @ Callee::Instance(_)), _) => it.it.callee == *callee,
            (Some(callee @ Callee::LocalInstance(_)), _) => it.unit == self.by && it.it.callee == *callee,
            (_, Some(unit)) => it.target == Some(unit),
            (Some(callee), None) => it.target.is_none() && it.it.callee == *callee,
            (None, None) => false,
        })
    }
}

/// The unit of a type of DFBs.
pub(super) fn dfb(ty: &str, index: &ProgramIndex<'_>) -> Option<u32> {
    let is_it = |it: &UnitFacts| matches!(&it.entity, Entity::Dfb { name } if key(name) == key(ty));
    let at = index.units.iter().position(|it| is_it(it))?;
    u32::try_from(at).ok()
}

/// The bit of a step, as its family writes it.
pub(super) fn step_bit(name: &StepName, graph: Graph, family: Family) -> Option<Object> {
    let bit = name.bit(graph);
    match family {
        Family::Pl72 => Some(pl72::parse(bit.trim_start_matches('%')).ok()?.object),
        _ => pl7::parse(&bit).ok(),
    }
}

/// A field of a data block that declares it itself.
fn of_data_block(facts: &UnitFacts, name: &str, index: &ProgramIndex<'_>) -> Option<Object> {
    let block = facts.entity.name().filter(|_| facts.entity.block_kind() == Some(BlockKind::Db))?;
    let place = index.layouts().of(block)?.place(name)?;
    Some(Object {
        text: format!("{block}.{name}").into(),
        class: Class::Data,
        ty: place.ty.map_or(Type::Unknown, Elementary::operand),
        footprint: Footprint::new(Area::Data(block.clone()), place.start, place.bits),
        rights: Rights::ReadWrite,
        extracted: false,
        indexed: false,
    })
}

/// Where a data block, or the function block whose instance it is, declares the field that an object is or lies in.
pub(super) fn field(object: &Object, index: &ProgramIndex<'_>) -> Option<(Site, Place)> {
    let (block, place) = match &object.footprint.area {
        Area::Data(name) if object.is_fixed() => (name.clone(), index.layouts().of(name)?.at(object.footprint.start)?),
        _ => {
            let (name, path) = step7::field(object)?;
            let place = index.layouts().of(&name)?.place(&path)?;
            (name, place)
        }
    };
    let mut owner = place.of.clone().unwrap_or(block);
    // An instance has the fields of its function block, and a block of a type those of the type.
    for _ in 0..MOST_NESTED {
        let (unit, facts) = (0..).zip(&index.units).find(|it| it.1.entity.name() == Some(&owner))?;
        match facts.declared.as_deref() {
            Some(DataType::Named(of)) => owner = of.clone(),
            _ => return Some((Site { unit, anchor: place.anchor }, place)),
        }
    }
    None
}

/// The parameter or variable of a DFB that `Instance.name` names outside of it.
pub(super) fn member<'i>(object: &Object, index: &'i ProgramIndex<'_>) -> Option<(Site, &'i Item)> {
    let (_, name) = object.text.split_once('.')?;
    let instance = index.units.iter().flat_map(|it| &it.symbols);
    let instance = instance.filter(|it| it.object.is_none()).find(|it| is_named(object, &it.name))?;
    let unit = dfb(&instance.ty, index)?;
    let items = &index.units.get(unit as usize)?.interface.as_ref()?.items;
    let name = key(name.split(['.', '[', ':']).next().unwrap_or(name));
    let item = items.iter().find(|it| key(&it.name) == name)?;
    Some((Site { unit, anchor: item.anchor }, item))
}

/// Types that stand for types, further than anybody goes.
const MOST_NESTED: usize = 16;

fn is_local(object: &Object) -> bool {
    matches!(object.class, Class::LocalName | Class::Symbol)
}

pub(super) fn is_named(object: &Object, name: &str) -> bool {
    let text = object.text.trim_start_matches('#');
    key(text.split(['.', '[', ':']).next().unwrap_or(text)) == key(name)
}

/// The declaration of a name of the unit itself.
pub(super) fn declaration<'m>(model: &'m UnitModel, object: &Object) -> Option<&'m Field> {
    if object.class != Class::LocalName {
        return None;
    }
    model.fields().iter().find(|it| is_named(object, &it.name))
}

/// Where the symbol of an address is declared, or an instance of a DFB by its name. An element of a table that an index
/// tells goes by the symbol of the table.
pub(super) fn symbol_places(program: &InProgram<'_>, index: &ProgramIndex<'_>, of: &Object) -> Vec<FilePlace> {
    let mut places = program.places();
    declaring(index, of).filter_map(|(unit, symbol)| places.of(Site { unit, anchor: symbol.anchor })).collect()
}

/// The declarations of the symbol of an object, with their units.
pub(super) fn declaring<'i>(
    index: &'i ProgramIndex<'_>,
    of: &'i Object,
) -> impl Iterator<Item = (u32, &'i FactSymbol)> {
    let all = (0..).zip(&index.units).flat_map(|(unit, facts)| facts.symbols.iter().map(move |it| (unit, it)));
    all.filter(|(_, symbol)| match &symbol.object {
        Some(object) if of.indexed => object.footprint == of.footprint && is_named(of, &symbol.name),
        Some(object) => *object == Object { text: object.text.clone(), ..of.clone() },
        None => of.class == Class::Symbol && is_named(of, &symbol.name),
    })
}

/// Whether what is done may change the object.
pub(super) fn writes(mode: Mode) -> bool {
    mode.writes() || matches!(mode, Mode::Drive(_))
}

/// A symbol without the marks that code sets on it, to compare it.
pub(super) fn key_in_code(text: &str) -> SmolStr {
    key(text.trim_start_matches('-').trim_matches(['"', '«', '»', ' ', '\u{a0}']))
}

/// Whether something else calls a unit: the system calls what it runs itself.
pub(super) fn is_called(entity: &Entity) -> bool {
    use BlockKind as B;
    matches!(
        entity,
        Entity::Dfb { .. }
            | Entity::Pl7 { part: Part::Subroutine(_), .. }
            | Entity::Block { kind: B::Fb | B::Fc | B::Sfb | B::Sfc | B::Pb | B::Sb | B::Fx, .. }
    )
}

//! Numbers of objects against how many of them there are.

use std::cell::OnceCell;

use super::program::{ObjectUses, ProgramIndex};
use super::{Site, drives};
use crate::model::entity::Family;
use crate::model::object::{Area, Class, Object, pl7};
use crate::target::pl7::BLOCK_COUNTS;
use crate::target::pl72;
use crate::target::{Count, Counted, CountedBy, Target};

/// The object as written; of an item, its block: `%TM64` for `%TM64.Q`.
pub fn name(object: &Object) -> &str {
    match object.class {
        Class::BlockBit | Class::BlockWord => object.text.split(['.', ',']).next().unwrap_or_default(),
        _ => &object.text,
    }
}

/// What an object is counted as, and the highest number that it takes: `%MD4` is the words 4 and 5. `None` for an object
/// that has no such number, and for an indexed one, whose number is known when the program runs.
pub fn number(family: Family, object: &Object) -> Option<(Counted, u32)> {
    if object.is_fixed() { own_number(family, object) } else { None }
}

/// The same of an indexed object without its index.
pub fn own_number(family: Family, object: &Object) -> Option<(Counted, u32)> {
    let last = object.footprint.end().saturating_sub(1);
    Some(match (family, &object.footprint.area) {
        (Family::Pl7, Area::Bits) => (Counted::Bits, last),
        (Family::Pl7, Area::Words) => (Counted::Words, last / 16),
        (Family::Pl7, Area::Constants) => (Counted::Constants, last / 16),
        (Family::Pl7, Area::SystemBits) => (Counted::SystemBits, last),
        (Family::Pl7, Area::MacroSteps) => (Counted::MacroSteps, last),
        (Family::Pl7, Area::Steps | Area::StepTimes) => match pl7::macro_step_of(object) {
            Some(macro_step) => (Counted::MacroSteps, macro_step),
            None if object.class == Class::StepTime => (Counted::Steps, last / 16),
            None => (Counted::Steps, last),
        },
        (Family::Pl7, Area::Block(symbol, number)) => {
            (BLOCK_COUNTS.iter().find(|it| it.symbol == *symbol)?.what, *number)
        }
        (Family::Pl72, Area::Bits) => (Counted::Bits, last),
        (Family::Pl72, Area::Words) => (Counted::Words, last / 16),
        (Family::Pl72, Area::Constants) => (Counted::Constants, last / 16),
        (Family::Pl72, Area::SystemBits) => (Counted::SystemBits, last),
        (Family::Pl72, Area::SystemWords) => (Counted::SystemWords, last / 16),
        (Family::Pl72, Area::Block(symbol, number)) => (pl72::block_of_symbol(symbol)?, *number),
        (Family::Step5 | Family::Step7, Area::Words) => (Counted::Bytes, last / 8),
        (Family::Step5 | Family::Step7, Area::Timers) => (Counted::Timers, last),
        (Family::Step5 | Family::Step7, Area::Counters) => (Counted::Counters, last),
        _ => return None,
    })
}

/// An object with what it is counted as and the highest number that it takes.
#[derive(Debug, Clone, Copy)]
pub struct Numbered<'a> {
    pub uses: &'a ObjectUses<'a>,
    pub what: Counted,
    pub last: u32,
}

/// The objects of a program that are counted, in the order of their addresses.
pub fn numbers<'p>(program: &'p ProgramIndex<'_>) -> Vec<Numbered<'p>> {
    let number = |uses: &'p ObjectUses<'p>| {
        let (what, last) = number(program.family, uses.object)?;
        Some(Numbered { uses, what, last })
    };
    program.objects.iter().filter_map(number).collect()
}

/// The counts of a target, each looked up once.
pub struct Ends<'t> {
    target: &'t Target,
    known: [OnceCell<Option<Count>>; Counted::ALL.len()],
}

impl<'t> Ends<'t> {
    pub fn new(target: &'t Target) -> Self {
        Self { target, known: Default::default() }
    }

    pub fn of(&self, what: Counted) -> Option<Count> {
        *self.known.get(what as usize)?.get_or_init(|| self.target.count(what))
    }

    /// The count that a number does not fit.
    fn passed_by(&self, what: Counted, number: u32) -> Option<Count> {
        self.of(what).filter(|it| number >= it.value)
    }
}

/// An object with a number that there is not.
#[derive(Debug)]
pub struct Beyond<'a> {
    /// The object, or the items of the block that the program uses.
    objects: Vec<&'a ObjectUses<'a>>,
    pub what: Counted,
    pub count: Count,
}

/// The objects of a program that lie beyond what its controller or its configuration has: each bit, word and step, by
/// address.
pub fn beyond<'a>(numbers: &[Numbered<'a>], target: &Target) -> Vec<Beyond<'a>> {
    let ends = Ends::new(target);
    let mut found = Vec::new();
    for &Numbered { uses, what, last } in numbers.iter().filter(|it| !it.what.is_block()) {
        if let Some(count) = ends.passed_by(what, last) {
            found.push(Beyond { objects: vec![uses], what, count });
        }
    }
    found
}

/// The same of timers, counters and other function blocks: each block with all its items.
pub fn beyond_blocks<'a>(numbers: &[Numbered<'a>], target: &Target) -> Vec<Beyond<'a>> {
    let ends = Ends::new(target);
    let mut found: Vec<(u32, Beyond<'a>)> = Vec::new();
    // Items of one block stand together, for objects are in the order of their addresses.
    for &Numbered { uses, what, last } in numbers.iter().filter(|it| it.what.is_block()) {
        let Some(count) = ends.passed_by(what, last) else { continue };
        match found.last_mut().filter(|(number, before)| *number == last && before.what == what) {
            Some((_, before)) => before.objects.push(uses),
            None => found.push((last, Beyond { objects: vec![uses], what, count })),
        }
    }
    found.into_iter().map(|it| it.1).collect()
}

/// The object with the highest number of a kind that is not beyond its count.
pub fn highest<'a>(numbers: &[Numbered<'a>], target: &Target, what: Counted) -> Option<&'a ObjectUses<'a>> {
    let count = target.count(what)?;
    let existing = numbers.iter().filter(|it| it.what == what && it.last < count.value);
    existing.max_by_key(|it| it.last).map(|it| it.uses)
}

/// How many blocks of a kind a program takes: they are counted from 0 up to the highest number that is not beyond its count.
pub fn taken<'o>(
    family: Family,
    objects: impl Iterator<Item = &'o Object>,
    target: &Target,
    what: Counted,
) -> Option<u32> {
    let count = target.count(what)?;
    let numbers = objects.filter_map(|it| number(family, it));
    let last = numbers.filter(|it| it.0 == what && it.1 < count.value).map(|it| it.1).max()?;
    Some(last.saturating_add(1))
}

impl Beyond<'_> {
    /// Its places in the order of execution: the first, and the others.
    pub fn sites(&self, program: &ProgramIndex<'_>) -> Option<(Site, impl Iterator<Item = Site>)> {
        let mut uses: Vec<_> = self.objects.iter().flat_map(|it| it.uses.iter().copied()).collect();
        drives::in_order(program, &mut uses);
        let mut sites = uses.into_iter().map(|it| it.site());
        Some((sites.next()?, sites))
    }

    /// One sentence: what there is instead.
    pub fn message(&self, target: &Target) -> String {
        let text = self.objects.first().map_or("", |it| name(it.object));
        let Some(numbered) = target.numbered(self.what) else { return format!("`{text}` does not exist") };
        let what = numbered.plural;
        let head = match self.count.by {
            CountedBy::Configuration => format!("`{text}` is not configured"),
            CountedBy::Controller(name) => format!("`{text}` does not exist on a {name}"),
            CountedBy::Family => format!("`{text}` exists on no controller"),
        };
        // The letters of a block are the program's own: `Z` or `C` for a counter.
        let letters = text.split(|it: char| it.is_ascii_digit()).next().unwrap_or_default();
        let prefix = if self.what.is_block() { letters } else { numbered.prefix };
        match self.count.value.checked_sub(1) {
            None => format!("{head}: there are no {what}"),
            Some(last) => format!("{head}: {what} are `{prefix}0` to `{prefix}{last}`"),
        }
    }

    /// Who says so.
    pub fn note(&self) -> String {
        let Count { value, by, source } = self.count;
        match by {
            CountedBy::Configuration => format!("the configuration says `{source} = {value}`"),
            CountedBy::Controller(_) | CountedBy::Family => format!("the count is given in {source}"),
        }
    }
}

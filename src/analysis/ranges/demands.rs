//! Numbers against what operations take: indexes that leave their area, and divisors that are 0.

use rustc_hash::FxHashMap;

use super::Ranges;
use super::span::{Number, Span};
use crate::analysis::Site;
use crate::analysis::counts::{self, Ends};
use crate::analysis::facts::UnitFacts;
use crate::analysis::program::{ObjectUses, ProgramIndex};
use crate::analysis::stretches::Stretches;
use crate::model::entity::Family;
use crate::model::expr::{Expr, Exprs};
use crate::model::object::{Area, Class, Object, Type};
use crate::model::unit::{DemandKind, Mode};
use crate::target::{Count, Counted, CountedBy, Limit, pl7};

/// A number that has to lie in a range, with what its unit knows of it. It holds no position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Demanded {
    pub what: DemandKind,
    pub anchor: u32,
    pub span: Span,
    /// The object that it is the value of, when it is no more than that: an index into the facts' objects.
    pub object: Option<u32>,
    /// The object may hold what other code, or another scan, left in it.
    pub is_left: bool,
    /// Control comes by in each run of the unit.
    pub is_sure: bool,
}

/// The demands of a unit of which something is known, or the program may know something.
pub fn of_unit(ranges: &Ranges<'_>) -> Vec<Demanded> {
    let model = ranges.model();
    let known = model.demands.iter().filter_map(|it| {
        let (object, is_left) = match *model.exprs.get(it.value) {
            Expr::Read { object, version } => (Some(object.0), ranges.may_be_left(object, version, it.path)),
            _ => (None, false),
        };
        let number = match *model.exprs.get(it.value) {
            Expr::Float(bits) if f64::from_bits(bits) == 0.0 => Number::constant(0),
            _ => ranges.of(it.value, it.statement, it.path)?,
        };
        let is_told = number.span.tells_first || number.span.tells_last;
        let is_sure = it.path == Exprs::TRUE;
        (is_told || is_left && is_sure).then_some(Demanded {
            what: it.what,
            anchor: it.anchor,
            span: number.span,
            object,
            is_left,
            is_sure,
        })
    });
    known.collect()
}

/// The bits by which an index of 1 moves an object: that of a double word counts double words (PL7:1126-1132).
pub fn step_bits(object: &Object) -> Option<i64> {
    Some(match object.ty {
        _ if object.extracted => 16,
        Type::Bool | Type::BitTable(_) => 1,
        Type::Word | Type::WordTable(_) => 16,
        Type::Double | Type::Float | Type::DoubleTable(_) | Type::FloatTable(_) => 32,
        _ => return None,
    })
}

/// A demand that is not met, with the numbers that do not meet it.
#[derive(Debug)]
pub struct Unmet<'a> {
    pub site: Site,
    pub facts: &'a UnitFacts,
    pub it: &'a Demanded,
    /// No number meets it.
    pub always: bool,
    /// One number that does not.
    pub number: i64,
    /// Where the number comes from.
    pub because: Vec<(Site, String)>,
    /// It holds when nothing but the program writes the object.
    pub assumes_writes: bool,
}

/// The object that an index belongs to.
pub fn indexed<'f>(facts: &'f UnitFacts, it: &Demanded) -> Option<&'f Object> {
    match it.what {
        DemandKind::Index(object) => facts.objects.get(object.0 as usize).map(|it| &it.object),
        DemandKind::Divisor => None,
    }
}

impl<'a> Unmet<'a> {
    /// See [`indexed`].
    pub fn object(&self) -> Option<&'a Object> {
        indexed(self.facts, self.it)
    }

    /// The number as code writes it, for a message.
    pub fn name(&self) -> Option<&'a str> {
        let object = self.it.object.and_then(|it| self.facts.objects.get(it as usize))?;
        Some(object.object.text.as_str())
    }
}

/// What a demand takes.
#[derive(Debug, Clone, Copy)]
pub struct Accepted {
    pub first: i64,
    pub last: i64,
    /// All but 0.
    pub not_zero: bool,
}

impl Accepted {
    pub const NOT_ZERO: Self = Self { first: i64::MIN, last: i64::MAX, not_zero: true };

    /// A number that the code tells and that is not taken, and whether none is.
    fn unmet(self, span: Span) -> Option<(i64, bool)> {
        if self.not_zero {
            let ends = span.tells_first && span.tells_last;
            let is_told = ends || span.first == 0 && span.tells_first || span.last == 0 && span.tells_last;
            return (span.contains(0) && is_told).then_some((0, span.is_one()));
        }
        if span.tells_first && span.first > self.last || span.tells_last && span.last < self.first {
            let number = if span.first > self.last { span.first } else { span.last };
            return Some((number, true));
        }
        if span.tells_last && span.last > self.last {
            return Some((span.last, false));
        }
        (span.tells_first && span.first < self.first).then_some((span.first, false))
    }
}

/// The demands of a kind that are not met, in the order of the units. `accepted` says what one takes; `None` where that is
/// not known.
pub fn unmet<'a>(
    program: &ProgramIndex<'a>,
    accepted: impl Fn(&UnitFacts, &Demanded) -> Option<Accepted>,
) -> Vec<Unmet<'a>> {
    let mut found = Vec::new();
    let mut open: Vec<(Unmet<'a>, Accepted, &'a Object)> = Vec::new();
    for (unit, &facts) in (0..).zip(&program.units) {
        let is_run = program.sure.get(unit as usize).copied().unwrap_or(false);
        for it in &facts.demands {
            let Some(accepted) = accepted(facts, it) else { continue };
            let site = Site { unit, anchor: it.anchor };
            let unmet = |(number, always)| {
                let because = it.span.by.map(|anchor| (Site { unit, anchor }, "it gets its value here".to_owned()));
                let because = because.into_iter().filter(|it| it.0 != site).collect();
                Unmet { site, facts, it, always, number, because, assumes_writes: false }
            };
            if let Some(told) = accepted.unmet(it.span) {
                found.push(unmet(told));
            } else if it.is_left && it.is_sure && is_run && program.complete && !program.partial {
                let object = it.object.and_then(|it| facts.objects.get(it as usize));
                open.extend(object.map(|it| (unmet((0, false)), accepted, &it.object)));
            }
        }
    }
    if open.is_empty() {
        return found;
    }
    let asked: Stretches<'_> = open.iter().map(|it| &it.2.footprint).collect();
    let written = Written::new(&program.those(|_| true, |it| asked.overlap(&it.footprint)));
    for (it, accepted, _) in open {
        if let Some((number, because)) = written.unmet(it.site.unit, it.it, accepted) {
            found.push(Unmet { number, because, assumes_writes: true, ..it });
        }
    }
    found.sort_by_key(|it| it.site);
    found
}

/// The constants that a program writes to objects that it writes nothing else to.
struct Written {
    /// Of each object of each unit, which one of `known` it is.
    places: FxHashMap<(u32, u32), usize>,
    known: Vec<Vec<(i64, Site)>>,
}

impl Written {
    /// `program`: its part with the objects that are asked for, and all that share memory with them.
    fn new(program: &ProgramIndex<'_>) -> Self {
        let objects = || program.objects.iter().enumerate();
        let mut shares_writes = vec![false; program.objects.len()];
        for (a, b) in program.overlaps() {
            for (it, other) in [(a, b), (b, a)] {
                shares_writes[it as usize] |= program.objects[other as usize].is_written();
            }
        }
        let places = |(at, it): (usize, &ObjectUses<'_>)| -> Vec<((u32, u32), usize)> {
            it.uses.iter().map(|it| ((it.unit, it.it.object), at)).collect()
        };
        let known = objects().map(|(at, it)| if shares_writes[at] { Vec::new() } else { constants(program, it) });
        Self { known: known.collect(), places: objects().flat_map(places).collect() }
    }

    fn unmet(&self, unit: u32, it: &Demanded, accepted: Accepted) -> Option<(i64, Vec<(Site, String)>)> {
        let known = self.known.get(*self.places.get(&(unit, it.object?))?)?;
        let is_wrong = |value: i64| accepted.unmet(Span::exactly(value)).is_some();
        // Two writes behind the last wrong one may be the two ways of one choice, which leave nothing of it.
        if known.iter().rev().take_while(|(value, _)| !is_wrong(*value)).count() > 1 {
            return None;
        }
        let wrong: Vec<(i64, Site)> =
            known.iter().filter(|(value, _)| it.span.contains(*value) && is_wrong(*value)).copied().collect();
        let number = wrong.first()?.0;
        Some((number, wrong.into_iter().map(|(value, site)| (site, format!("{value} is written here"))).collect()))
    }
}

/// None when another value may be written, or when a write that nothing passes by replaces what the others wrote.
fn constants(program: &ProgramIndex<'_>, uses: &ObjectUses<'_>) -> Vec<(i64, Site)> {
    let is_own = uses.object.class == Class::Memory
        && uses.object.is_fixed()
        && !program.unseen(uses).is_written()
        && !program.unseen(uses).has_unresolved(Mode::writes);
    let mut writes = uses.with_mode(|it| it.writes() || matches!(it, Mode::Drive(_))).peekable();
    if !is_own || writes.peek().is_none() {
        return Vec::new();
    }
    let mut found = Vec::new();
    for it in writes {
        let is_passed_by = it.it.conditional || !program.sure.get(it.unit as usize).copied().unwrap_or(false);
        match it.it.constant() {
            Some(value) if it.mode == Mode::Store && is_passed_by => found.push((value, it.site())),
            Some(value) if it.mode == Mode::Store && found.is_empty() => found.push((value, it.site())),
            _ => return Vec::new(),
        }
    }
    found
}

/// The room that an indexed object of PL7 has.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// What is counted; `None` for the channels of a module.
    pub what: Option<Counted>,
    /// The first and the last number that the object has without its index.
    own: (i64, i64),
    /// How many numbers an index of 1 moves it on.
    step: i64,
    pub count: Count,
}

impl Room {
    /// `None` where nothing tells how many there are, or the object is beyond them by itself.
    pub fn new(object: &Object, ends: &Ends<'_>) -> Option<Self> {
        let place = &object.footprint;
        let (what, count, last) = match place.area {
            Area::InputChannels(_) | Area::OutputChannels(_) => {
                let Limit { value, source } = pl7::MODULE_CHANNELS;
                (None, Count { value, by: CountedBy::Family, source }, place.end().saturating_sub(1))
            }
            _ => {
                let (what, last) = counts::own_number(Family::Pl7, object)?;
                (Some(what), ends.of(what)?, last)
            }
        };
        let is_step = what.is_some_and(|it| matches!(it, Counted::Steps | Counted::MacroSteps));
        let in_words = matches!(place.area, Area::Words | Area::Constants | Area::StepTimes);
        // Of the steps of a macro-step, nothing tells where they end.
        if last >= count.value || is_step && pl7_macro(object) {
            return None;
        }
        let unit = if in_words { 16 } else { 1 };
        let own = (i64::from(place.start) / unit, last.into());
        Some(Self { what, own, step: step_bits(object)? / unit, count })
    }

    pub fn accepted(&self) -> Accepted {
        let last = i64::from(self.count.value) - 1 - self.own.1;
        Accepted { first: -self.own.0.div_euclid(self.step), last: last.div_euclid(self.step), not_zero: false }
    }

    /// The number of the object that an index leads to; the last one where it takes several.
    pub fn reached(&self, index: i64) -> i64 {
        let (first, last) = self.own;
        let moved = index.saturating_mul(self.step);
        if index < 0 { first.saturating_add(moved) } else { last.saturating_add(moved) }
    }
}

fn pl7_macro(object: &Object) -> bool {
    crate::model::object::pl7::macro_step_of(object).is_some()
}

//! What is done to memory by places that do not name it: what can be said of all objects of a program together, and which
//! of them asked for it.
//!
//! **Invariant:** a rule that judges an object asks for it by [`ProgramIndex::unseen`], last of all. So what it says holds
//! good as long as the objects that asked would get the same answers.

use std::cell::Cell;

use rustc_hash::FxHashSet;

use super::program::{Modes, ProgramIndex, Skeleton};
use crate::model::object::{Area, Class, Footprint, Object};
use crate::model::unit::Mode;

/// Places computed at run time.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Indirect {
    /// By a pointer, or an index on a symbol that nothing resolves.
    anywhere: bool,
    /// By an index on an address, which does not lead out of its area: where it would, the controller takes 0 for it
    /// (PL7:1134-1143).
    areas: FxHashSet<Area>,
}

impl Indirect {
    fn insert(&mut self, object: &Object) {
        let area = &object.footprint.area;
        self.anywhere |= matches!(area, Area::Indirect | Area::Symbol(_));
        if object.indexed && !self.areas.contains(area) {
            self.areas.insert(area.clone());
        }
    }

    fn may_be_in(&self, area: &Area) -> bool {
        // What is meant by a symbol that nothing resolves may lie anywhere.
        self.anywhere || self.areas.contains(area) || matches!(area, Area::Symbol(_)) && !self.areas.is_empty()
    }
}

/// What can be said of all objects together, which those that judge a single one want to know.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Summary {
    pub(super) access: Access,
    /// Tables of steps that the program does not clear, of which rule Q007 tells.
    pub(super) uncleared: Vec<Footprint>,
}

/// How places are used that code does not name, or not by their address.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Access {
    written: Indirect,
    read: Indirect,
    /// Of the uses by a symbol that nothing resolves and that drives no block.
    unresolved: Modes,
    /// Of the uses of outputs, memory and data by address.
    addressed: Modes,
    /// See [`Skeleton::complete`].
    complete: bool,
}

impl Access {
    /// `objects`: at least those that are [`Self::is_odd`], with the modes of their uses. `addressed`: of the uses of those
    /// that are [`Self::is_addressed`].
    pub(super) fn new<'o>(
        skeleton: &Skeleton<'_>,
        objects: impl Iterator<Item = (&'o Object, Modes)>,
        addressed: Modes,
    ) -> Self {
        let mut found = Self { addressed, complete: skeleton.complete, ..Self::default() };
        found.written.anywhere = skeleton.units.iter().any(|it| it.writes_indirectly);
        found.read.anywhere = skeleton.units.iter().any(|it| it.reads_indirectly);
        for (object, modes) in objects.filter(|it| Self::is_odd(it.0)) {
            if !object.is_fixed() && (modes.drive() || modes.has(Mode::writes)) {
                found.written.insert(object);
            }
            if !object.is_fixed() && modes.has(Mode::reads) {
                found.read.insert(object);
            }
            if matches!(object.footprint.area, Area::Symbol(_)) && !modes.drive() && !skeleton.is_item(object) {
                found.unresolved.join(modes);
            }
        }
        found
    }

    /// Whether the place of an object is not known.
    pub(super) fn is_odd(object: &Object) -> bool {
        !object.is_fixed() || matches!(object.footprint.area, Area::Symbol(_))
    }

    pub(super) fn is_addressed(object: &Object) -> bool {
        matches!(object.class, Class::Output | Class::Memory | Class::Data)
    }
}

/// Parts of a [`Summary`]: those that were asked for, or in which one is not as another.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Questions {
    written: bool,
    read: bool,
    uncleared: bool,
    unresolved: Modes,
    addressed: Modes,
    complete: bool,
}

/// What was asked for which objects. Each goes by the name of a unit: the unit, and the number of the object there.
pub type AskedFor = Vec<((u32, u32), Questions)>;

impl Questions {
    pub fn is_empty(self) -> bool {
        self == Self::default()
    }

    #[must_use]
    pub fn join(mut self, other: Self) -> Self {
        self.written |= other.written;
        self.read |= other.read;
        self.uncleared |= other.uncleared;
        self.unresolved.join(other.unresolved);
        self.addressed.join(other.addressed);
        self.complete |= other.complete;
        self
    }

    pub fn meet(self, other: Self) -> bool {
        self.written && other.written
            || self.read && other.read
            || self.uncleared && other.uncleared
            || self.unresolved.meet(other.unresolved)
            || self.addressed.meet(other.addressed)
            || self.complete && other.complete
    }
}

impl Summary {
    /// See [`Skeleton::complete`].
    pub fn is_complete(&self) -> bool {
        self.access.complete
    }

    /// In what parts another one is not the same.
    pub fn difference(&self, other: &Self) -> Questions {
        let (a, b) = (&self.access, &other.access);
        Questions {
            written: a.written != b.written,
            read: a.read != b.read,
            uncleared: self.uncleared != other.uncleared,
            unresolved: a.unresolved.difference(b.unresolved),
            addressed: a.addressed.difference(b.addressed),
            complete: a.complete != b.complete,
        }
    }

    /// Whether another one answers otherwise to what was asked for an object. `changed`: [`Self::difference`].
    pub fn tells_otherwise(&self, other: &Self, changed: Questions, asked: Questions, object: &Object) -> bool {
        let (place, a, b) = (&object.footprint, &self.access, &other.access);
        let is_other = |a: &Indirect, b: &Indirect| {
            let answers = |it: &Indirect| (it.may_be_in(&place.area), it.areas.contains(&place.area));
            answers(a) != answers(b)
        };
        asked.meet(changed)
            && (asked.unresolved.meet(changed.unresolved)
                || asked.addressed.meet(changed.addressed)
                || asked.complete && changed.complete
                || asked.uncleared && self.is_uncleared(place) != other.is_uncleared(place)
                || asked.written && is_other(&a.written, &b.written)
                || asked.read && is_other(&a.read, &b.read))
    }

    fn is_uncleared(&self, place: &Footprint) -> bool {
        is_in(&self.uncleared, place)
    }
}

fn is_in(tables: &[Footprint], place: &Footprint) -> bool {
    tables.iter().any(|it| it.contains(place))
}

/// What may be done to an object by places that do not name it. Whatever is asked is noted.
pub struct Unseen<'p, 'a> {
    pub(super) program: &'p ProgramIndex<'a>,
    pub(super) object: &'p Object,
    pub(super) asked: &'p Cell<Questions>,
}

impl Unseen<'_, '_> {
    fn ask(&self, questions: Questions) {
        self.asked.set(self.asked.get().join(questions));
    }

    /// Whether the program shows all that is done by name: see [`Skeleton::complete`].
    pub fn is_complete(&self) -> bool {
        self.ask(Questions { complete: true, ..Questions::default() });
        self.program.access().complete
    }

    /// Whether some unit writes a place computed at run time that may be the object: the absence of another write says
    /// nothing then.
    pub fn is_written(&self) -> bool {
        self.ask(Questions { written: true, ..Questions::default() });
        self.program.access().written.may_be_in(&self.object.footprint.area)
    }

    /// Whether an indexed object, which may be any of its area, is written in the area of the object.
    pub fn is_written_by_index(&self) -> bool {
        self.ask(Questions { written: true, ..Questions::default() });
        self.program.access().written.areas.contains(&self.object.footprint.area)
    }

    /// Whether some unit reads a place computed at run time that may be the object.
    pub fn is_read(&self) -> bool {
        self.ask(Questions { read: true, ..Questions::default() });
        self.program.access().read.may_be_in(&self.object.footprint.area)
    }

    /// Whether a use of that kind goes by a symbol that nothing resolves: it may be of any address. The items of an
    /// instance of a DFB have none.
    pub fn has_unresolved(&self, wanted: impl Fn(Mode) -> bool) -> bool {
        let unresolved = Modes::of(wanted);
        self.ask(Questions { unresolved, ..Questions::default() });
        self.program.access().unresolved.meet(unresolved)
    }

    /// Whether a use of that kind is one of an output, of memory or of data by its address.
    fn has_addressed(&self, wanted: impl Fn(Mode) -> bool) -> bool {
        let addressed = Modes::of(wanted);
        self.ask(Questions { addressed, ..Questions::default() });
        self.program.access().addressed.meet(addressed)
    }

    /// Whether a bit lies in a table of steps that the program does not clear.
    pub fn is_in_uncleared_table(&self) -> bool {
        self.ask(Questions { uncleared: true, ..Questions::default() });
        is_in(self.program.uncleared(), &self.object.footprint)
    }

    /// Whether what is missing, the set or the reset of a bit, may be done by code that is not there, by a pointer or an
    /// index, or under another name: by a symbol that nothing resolves for an address, and by any address for such a symbol.
    pub fn may_give(&self, missing: Mode) -> bool {
        if !self.is_complete() {
            return true;
        }
        let gives = |mode: Mode| mode.writes() && (mode == missing || !matches!(mode, Mode::Set | Mode::Reset));
        let by_another_name =
            if self.object.class == Class::Symbol { self.has_addressed(gives) } else { self.has_unresolved(gives) };
        by_another_name || self.is_written()
    }
}

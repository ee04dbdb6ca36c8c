//! Channels of modules that the system exchanges together (PL7:2407-2509).

use std::collections::BTreeMap;

use super::program::{Context, GlobalUse, ProgramIndex};
use crate::model::object::{Area, Class, Footprint, Object};

/// Discrete channels are exchanged by so many (PL7:2422-2423, 2502).
const GROUP: u32 = 8;

/// Bits from this one on are no channels of a discrete module: they have a rank, or belong to the module as a whole.
const CHANNELS: u32 = 128;

/// Channels of a discrete module that the system exchanges together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Group<'a> {
    pub area: &'a Area,
    pub number: u32,
}

/// Of a discrete output or input in the rack, or a table of them: the position of its module and its last channel.
pub fn discrete(object: &Object) -> Option<(u32, u32)> {
    let (Area::InputChannels(module) | Area::OutputChannels(module)) = &object.footprint.area else { return None };
    let last = object.footprint.end().saturating_sub(1);
    // What lies on a bus has another form of address.
    let position = module.parse().ok()?;
    (object.is_fixed() && last < CHANNELS).then_some((position, last))
}

impl<'a> Group<'a> {
    /// The groups that a discrete input or output, or a table of them, lies in. None for another object, and for one
    /// that an index moves.
    pub fn all_of(object: &'a Object) -> impl Iterator<Item = Self> {
        let Footprint { area, start, .. } = &object.footprint;
        let discrete = matches!(area, Area::InputChannels(_) | Area::OutputChannels(_));
        let last = object.footprint.end().saturating_sub(1) / GROUP;
        let numbers = start / GROUP..=last;
        let known = discrete && *start < CHANNELS && object.is_fixed();
        numbers.filter(move |_| known).map(move |number| Self { area, number })
    }

    /// First and last channel.
    pub fn channels(&self) -> (u32, u32) {
        (self.number * GROUP, self.number * GROUP + GROUP - 1)
    }
}

/// What the system exchanges as one for an event.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exchange<'a> {
    /// A module, by the digits of its address (PL7:2491).
    Module(&'a str),
    /// Eight discrete channels (PL7:2502).
    Group(Group<'a>),
    /// A channel of another module: the area of the module, whether it is one of inputs, and its address (PL7:2503-2504).
    Channel(&'a Area, bool, String),
}

impl<'a> Exchange<'a> {
    /// The module that an input or output lies in.
    pub fn module(object: &'a Object) -> Option<Self> {
        match &object.footprint.area {
            Area::InputChannels(it) | Area::OutputChannels(it) => Some(Self::Module(it)),
            Area::ModuleWords(it) => Some(Self::Module(it.trim_start_matches(|it: char| it.is_ascii_alphabetic()))),
            _ => None,
        }
    }

    /// The groups of discrete channels that it lies in.
    pub fn groups(object: &'a Object) -> Vec<Self> {
        Group::all_of(object).map(Self::Group).collect()
    }

    /// The channel that a word lies in: `%IW3.0.2` is of the channel 3.0.
    pub fn word_channel(object: &'a Object) -> Option<Self> {
        let area @ Area::ModuleWords(_) = &object.footprint.area else { return None };
        let address = object.text.split(':').next().unwrap_or_default();
        let digits = address.trim_start_matches(|it: char| !it.is_ascii_digit() && it != '\\');
        let channel: Vec<&str> = digits.rsplit('\\').next().unwrap_or_default().split('.').take(2).collect();
        Some(Self::Channel(area, object.class == Class::Input, channel.join(".")))
    }
}

/// Whether an object comes with the channel that raises an event.
pub fn comes_with(trigger: &Object, object: &Object) -> bool {
    let group = Group::all_of(trigger).next();
    let is_word = matches!(object.footprint.area, Area::ModuleWords(_)) && object.class == Class::Input;
    group.is_some_and(|group| Group::all_of(object).any(|it| it == group))
        || trigger.footprint.overlaps(&object.footprint)
        || is_word && trigger.class == Class::Input && Exchange::module(trigger) == Exchange::module(object)
}

/// What each event has exchanged: the inputs that it reads and the outputs that it writes, with the subroutines that it
/// calls. Reading an output does not exchange it.
pub fn of_events<'a>(program: &ProgramIndex<'a>) -> BTreeMap<u16, Vec<(&'a Object, GlobalUse<'a>)>> {
    let mut events: BTreeMap<u16, Vec<(&'a Object, GlobalUse<'a>)>> = BTreeMap::new();
    if !program.has_events() {
        return events;
    }
    for uses in program.objects_that(|it| matches!(it, Class::Input | Class::Output), Object::is_fixed) {
        let object = uses.object;
        for it in uses.uses.into_iter().filter(|it| object.class == Class::Input || it.mode.writes()) {
            for task in program.tasks(it.unit) {
                if let Context::Event(number) = task {
                    events.entry(number).or_default().push((object, it));
                }
            }
        }
    }
    events
}

//! Channels of modules that the system exchanges together (PL7:2407-2509).

use crate::model::object::{Area, Footprint, Object};

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

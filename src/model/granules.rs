//! Memory in stretches of equal size, numbered for each unit: what shares memory shares a granule.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::expr::ObjectId;
use super::object::{Area, Footprint};

/// Bits of an area that one granule covers.
const SIZE: u32 = 32;

/// An object over more granules than this counts as the whole area.
const MOST: u32 = 64;

/// The granules that the objects of a unit lie in.
#[derive(Debug, Clone, Default)]
pub struct Granules {
    /// By [`ObjectId`].
    of: Vec<Of>,
    all: Vec<u32>,
    /// An object of each area.
    areas: Vec<ObjectId>,
}

#[derive(Debug, Clone)]
struct Of {
    area: u32,
    /// Those of the object among `all`; none of one that is too wide.
    granules: Range<u32>,
}

/// What numbers areas and granules, while objects are found.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    areas: FxHashMap<Area, u32>,
    granules: FxHashMap<(u32, u32), u32>,
}

/// Tables are counted in `u32`: a unit is below 4 GiB.
fn number(len: usize) -> u32 {
    u32::try_from(len).unwrap_or(u32::MAX)
}

impl Granules {
    pub(super) fn with_capacity(objects: usize) -> Self {
        Self { of: Vec::with_capacity(objects), all: Vec::with_capacity(objects), areas: Vec::new() }
    }

    /// Adds the next object.
    pub(super) fn push(&mut self, numbers: &mut Numbers, place: &Footprint) {
        let object = ObjectId(number(self.of.len()));
        let known = numbers.areas.get(&place.area).copied();
        let area = known.unwrap_or_else(|| {
            let next = number(self.areas.len());
            numbers.areas.insert(place.area.clone(), next);
            self.areas.push(object);
            next
        });
        let first = place.start / SIZE;
        let range = first..(place.end().saturating_sub(1) / SIZE).max(first) + 1;
        let first = number(self.all.len());
        for granule in range.clone().filter(|_| range.len() <= MOST as usize) {
            let next = number(numbers.granules.len());
            self.all.push(*numbers.granules.entry((area, granule)).or_insert(next));
        }
        self.of.push(Of { area, granules: first..number(self.all.len()) });
    }

    /// Number of the area of an object.
    pub fn area(&self, object: ObjectId) -> u32 {
        self.of.get(object.0 as usize).map_or(u32::MAX, |it| it.area)
    }

    /// Numbers of the granules of an object; none when it is too wide.
    pub fn of(&self, object: ObjectId) -> &[u32] {
        let it = self.of.get(object.0 as usize).map(|it| it.granules.start as usize..it.granules.end as usize);
        it.and_then(|it| self.all.get(it)).unwrap_or_default()
    }

    /// An object of each area, by the numbers of the areas.
    pub fn areas(&self) -> &[ObjectId] {
        &self.areas
    }

    /// Number of granules.
    pub fn count(&self) -> usize {
        self.all.iter().max().map_or(0, |it| *it as usize + 1)
    }
}

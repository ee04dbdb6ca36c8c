//! Parts of memory.

use rustc_hash::FxHashMap;

use crate::model::object::{Area, Footprint};

/// Of each area, first and last bit of each stretch, sorted, without overlaps.
#[derive(Debug, Default)]
pub struct Stretches<'a>(FxHashMap<&'a Area, Vec<(u32, u32)>>);

impl<'a> FromIterator<&'a Footprint> for Stretches<'a> {
    fn from_iter<I: IntoIterator<Item = &'a Footprint>>(places: I) -> Self {
        let mut of: FxHashMap<&'a Area, Vec<(u32, u32)>> = FxHashMap::default();
        for it in places {
            of.entry(&it.area).or_default().push((it.start, it.end()));
        }
        for list in of.values_mut() {
            list.sort_unstable();
            list.dedup_by(|next, last| {
                let is_within = next.0 < last.1;
                last.1 = last.1.max(if is_within { next.1 } else { 0 });
                is_within
            });
        }
        Self(of)
    }
}

impl Stretches<'_> {
    /// Whether some of them share memory with a place.
    pub fn overlap(&self, place: &Footprint) -> bool {
        self.0.get(&place.area).is_some_and(|list| {
            let at = list.partition_point(|it| it.1 <= place.start);
            list.get(at).is_some_and(|it| it.0 < place.end())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_share_memory_or_not() {
        let place = |start, bits| Footprint::new(Area::Words, start, bits);
        let places = [place(32, 16), place(0, 16), place(8, 2), place(40, 24), place(64, 1)];
        let stretches: Stretches<'_> = places.iter().collect();
        for (start, bits) in (0..80).flat_map(|start| (1..20).map(move |bits| (start, bits))) {
            let it = place(start, bits);
            assert_eq!(stretches.overlap(&it), places.iter().any(|other| other.overlaps(&it)), "{start} {bits}");
        }
        assert!(!stretches.overlap(&Footprint::new(Area::Bits, 0, 16)));
    }
}

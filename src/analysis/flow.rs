//! Where values go, from network to network, as far as which objects each reads and writes tells.

use rustc_hash::{FxHashMap, FxHashSet};

use super::program::ProgramIndex;
use crate::model::unit::Mode;

/// Which networks read an object, and what each writes and whether it drives a block.
pub struct Flow {
    readers: Vec<Vec<(u32, u32)>>,
    networks: FxHashMap<(u32, u32), Network>,
}

#[derive(Default)]
struct Network {
    /// Indices of objects of the program.
    writes: Vec<u32>,
    drives: bool,
}

impl Flow {
    pub fn new(program: &ProgramIndex<'_>) -> Self {
        let mut flow = Self { readers: Vec::new(), networks: FxHashMap::default() };
        for (at, uses) in (0..).zip(&program.objects) {
            let mut readers = Vec::new();
            for it in &uses.uses {
                let place = (it.unit, it.it.network);
                if it.mode.reads() {
                    readers.push(place);
                }
                if it.mode.writes() {
                    flow.networks.entry(place).or_default().writes.push(at);
                }
                if matches!(it.mode, Mode::Drive(_)) {
                    flow.networks.entry(place).or_default().drives = true;
                }
            }
            flow.readers.push(readers);
        }
        flow
    }

    /// Whether a block is driven by what depends on one of some objects, from network to network.
    pub fn reaches_block(&self, from: Vec<u32>) -> bool {
        let mut seen: FxHashSet<u32> = from.iter().copied().collect();
        let mut open = from;
        while let Some(at) = open.pop() {
            let readers = self.readers.get(at as usize).into_iter().flatten();
            for network in readers.filter_map(|it| self.networks.get(it)) {
                if network.drives {
                    return true;
                }
                open.extend(network.writes.iter().filter(|it| seen.insert(**it)));
            }
        }
        false
    }
}

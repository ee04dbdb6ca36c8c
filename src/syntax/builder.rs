//! Green-tree builder with a fixed-size, direct-mapped token cache.
//!
//! rowan's own `NodeCache` spends most of its time waiting for memory in its intern table; a cache that stays in the
//! processor's own and forgets on collision builds the same tree in two thirds of the time.

use rowan::{GreenNode, GreenToken, NodeOrToken};

use super::kind::{SyntaxKind, raw};

const MOST_SLOTS: usize = 4096;

/// Longer tokens (comments, strings) hardly ever repeat.
const LONGEST_CACHED: usize = 24;

pub(super) struct TreeBuilder<'t> {
    cache: TokenCache<'t>,
    /// Finished nodes, and tokens, that no node holds yet.
    children: Vec<Child>,
}

enum Child {
    Node(GreenNode),
    /// A token that is not made yet: it may still become the node that holds it alone.
    Token {
        raw: rowan::SyntaxKind,
        start: u32,
        len: u32,
    },
}

impl Child {
    fn is_trivia(&self) -> bool {
        match self {
            Self::Node(_) => false,
            Self::Token { raw, .. } => raw::leaf(*raw).is_none() && raw::kind(*raw).is_trivia(),
        }
    }
}

impl<'t> TreeBuilder<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { cache: TokenCache::new(text), children: Vec::with_capacity(64) }
    }

    /// Number of children that no node holds yet.
    pub(super) fn len(&self) -> usize {
        self.children.len()
    }

    /// The first child from `first` on that is neither blank nor comment.
    pub(super) fn skip_trivia(&self, first: usize) -> usize {
        let trivia = self.children.iter().skip(first).take_while(|it| it.is_trivia());
        first + trivia.count()
    }

    pub(super) fn token(&mut self, kind: SyntaxKind, start: u32, len: u32) {
        self.children.push(Child::Token { raw: raw::of(kind), start, len });
    }

    /// Makes a node of all children from `first` on.
    pub(super) fn node(&mut self, kind: SyntaxKind, first: usize) {
        if let Some([Child::Token { raw, .. }]) = self.children.get_mut(first..)
            && raw::leaf(*raw).is_none()
        {
            *raw = raw::of_leaf(kind, raw::kind(*raw));
            return;
        }
        let first = first.min(self.children.len());
        let cache = &mut self.cache;
        let children = self.children.drain(first..).map(|it| cache.element(it));
        let node = GreenNode::new(raw::of(kind), children);
        self.children.push(Child::Node(node));
    }

    /// The one root.
    pub(super) fn finish(mut self) -> GreenNode {
        let cache = &mut self.cache;
        GreenNode::new(raw::of(SyntaxKind::Root), self.children.drain(..).map(|it| cache.element(it)))
    }
}

struct TokenCache<'t> {
    text: &'t str,
    slots: Vec<Option<GreenToken>>,
    /// Tokens of one ASCII character by that character: blanks, signs. A third of all tokens.
    signs: [Option<GreenToken>; 128],
}

impl<'t> TokenCache<'t> {
    /// A cache of its own for each tree keeps its tokens together in memory; a small text needs few.
    fn new(text: &'t str) -> Self {
        let slots = (text.len() / 8).next_power_of_two().clamp(64, MOST_SLOTS);
        Self { text, slots: vec![None; slots], signs: [const { None }; 128] }
    }

    fn element(&mut self, child: Child) -> NodeOrToken<GreenNode, GreenToken> {
        match child {
            Child::Node(it) => NodeOrToken::Node(it),
            Child::Token { raw, start, len } => NodeOrToken::Token(self.token(raw, start, len)),
        }
    }

    fn token(&mut self, raw: rowan::SyntaxKind, start: u32, len: u32) -> GreenToken {
        let text = &self.text[start as usize..(start + len) as usize];
        if let [byte @ 0..128] = text.as_bytes() {
            let slot = &mut self.signs[usize::from(*byte)];
            return match slot {
                Some(it) if it.kind() == raw => it.clone(),
                _ => slot.insert(GreenToken::new(raw, text)).clone(),
            };
        }
        if text.len() > LONGEST_CACHED {
            return GreenToken::new(raw, text);
        }
        let slot = hash(raw, text.as_bytes()) & (self.slots.len() - 1);
        let slot = &mut self.slots[slot];
        match slot {
            Some(it) if it.kind() == raw && it.text() == text => it.clone(),
            _ => slot.insert(GreenToken::new(raw, text)).clone(),
        }
    }
}

/// Of up to 24 bytes; its low bits are mixed.
fn hash(raw: rowan::SyntaxKind, text: &[u8]) -> usize {
    const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;
    let mix = |hash: u64, word: u64| (hash ^ word).wrapping_mul(MULTIPLIER).rotate_left(29);
    let mut hash = u64::from(raw.0) ^ (text.len() as u64) << 16;
    // The pieces may overlap: together they are all of the text.
    match (text.first_chunk::<8>(), text.last_chunk::<8>()) {
        (Some(first), Some(last)) => {
            hash = mix(hash, u64::from_le_bytes(*first));
            if let Some(middle) = text.get(8..16).and_then(<[u8]>::first_chunk) {
                hash = mix(hash, u64::from_le_bytes(*middle));
            }
            hash = mix(hash, u64::from_le_bytes(*last));
        }
        _ => {
            let word = match (text.first_chunk::<4>(), text.last_chunk::<4>()) {
                (Some(first), Some(last)) => {
                    u64::from(u32::from_le_bytes(*first)) << 32 | u64::from(u32::from_le_bytes(*last))
                }
                _ => text.iter().fold(0, |word, byte| word << 8 | u64::from(*byte)),
            };
            hash = mix(hash, word);
        }
    }
    (hash >> 20) as usize
}

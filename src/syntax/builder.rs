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
            Self::Token { raw, .. } => raw::is_trivia(*raw),
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

    /// Spaces behind a token that does not end with one.
    pub(super) fn spaces(&mut self, start: u32, len: u32) {
        // No node opens or closes between the token and these: they are children of one node.
        match self.children.last_mut() {
            Some(Child::Token { raw, len: before, .. }) if raw::takes_spaces(*raw) => {
                *raw = raw::with_spaces(*raw);
                *before += len;
            }
            _ => self.token(SyntaxKind::Whitespace, start, len),
        }
    }

    /// Makes a node of all children from `first` on.
    pub(super) fn node(&mut self, kind: SyntaxKind, first: usize) {
        if let Some([Child::Token { raw, .. }]) = self.children.get_mut(first..)
            && raw::leaf(*raw).is_none()
            && !raw::has_spaces(*raw)
        {
            *raw = raw::of_leaf(kind, *raw);
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
        let slots = (text.len() / 16).next_power_of_two().clamp(64, MOST_SLOTS);
        Self { text, slots: vec![None; slots], signs: [const { None }; 128] }
    }

    #[inline]
    fn element(&mut self, child: Child) -> NodeOrToken<GreenNode, GreenToken> {
        match child {
            Child::Node(it) => NodeOrToken::Node(it),
            Child::Token { raw, start, len } => NodeOrToken::Token(self.token(raw, start, len)),
        }
    }

    fn token(&mut self, raw: rowan::SyntaxKind, start: u32, len: u32) -> GreenToken {
        let range = start as usize..(start + len) as usize;
        let text = &self.text.as_bytes()[range.clone()];
        let new = || GreenToken::new(raw, &self.text[range]);
        if let [byte @ 0..128] = text {
            let slot = &mut self.signs[usize::from(*byte)];
            return match slot {
                Some(it) if it.kind() == raw => it.clone(),
                _ => slot.insert(new()).clone(),
            };
        }
        if text.len() > LONGEST_CACHED {
            return new();
        }
        let words = words(text);
        let slot = hash(raw, text.len(), words) & (self.slots.len() - 1);
        let slot = &mut self.slots[slot];
        match slot {
            Some(it)
                if it.kind() == raw && it.text().len() == text.len() && self::words(it.text().as_bytes()) == words =>
            {
                it.clone()
            }
            _ => slot.insert(new()).clone(),
        }
    }
}

/// All of up to 24 bytes: texts of one length are equal when these are. The pieces may overlap.
fn words(text: &[u8]) -> [u64; 3] {
    match (text.first_chunk::<8>(), text.last_chunk::<8>()) {
        (Some(first), Some(last)) => {
            let middle = text.get(8..16).and_then(<[u8]>::first_chunk).map_or(0, |it| u64::from_le_bytes(*it));
            [u64::from_le_bytes(*first), middle, u64::from_le_bytes(*last)]
        }
        _ => match (text.first_chunk::<4>(), text.last_chunk::<4>()) {
            (Some(first), Some(last)) => {
                [u64::from(u32::from_le_bytes(*first)) << 32 | u64::from(u32::from_le_bytes(*last)), 0, 0]
            }
            _ => match *text {
                [a, b] => [u64::from(u16::from_le_bytes([a, b])), 0, 0],
                [a, b, c] => [u64::from(u32::from_le_bytes([a, b, c, 0])), 0, 0],
                _ => [text.iter().fold(0, |word, byte| word << 8 | u64::from(*byte)), 0, 0],
            },
        },
    }
}

/// Its low bits are mixed.
fn hash(raw: rowan::SyntaxKind, len: usize, [first, middle, last]: [u64; 3]) -> usize {
    const MULTIPLIERS: [u64; 3] = [0x9E37_79B9_7F4A_7C15, 0xC2B2_AE3D_27D4_EB4F, 0x1656_67B1_9E37_79F9];
    let [a, b, c] = MULTIPLIERS;
    let own = u64::from(raw.0) ^ (len as u64) << 16;
    let mixed = (first ^ own).wrapping_mul(a) ^ middle.wrapping_mul(b) ^ last.wrapping_mul(c);
    (mixed >> 40) as usize
}

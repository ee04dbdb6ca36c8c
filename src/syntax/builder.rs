//! Green-tree builder with a fixed-size, direct-mapped token cache.
//!
//! rowan's own `NodeCache` spends most of its time waiting for memory in its intern table; a cache that stays in the
//! processor's own and forgets on collision builds the same tree in two thirds of the time.

use rowan::{GreenNode, GreenToken, NodeOrToken};

use super::kind::{SyntaxKind, raw};
use super::memo::{Key, Memo};

/// Longer tokens (comments, strings) hardly ever repeat.
const LONGEST_CACHED: usize = 24;

pub(super) struct TreeBuilder<'t> {
    text: &'t str,
    memo: &'t mut Memo,
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
    pub(super) fn new(text: &'t str, memo: &'t mut Memo) -> Self {
        Self { text, memo, children: Vec::with_capacity(64) }
    }

    /// Number of children that no node holds yet.
    pub(super) fn len(&self) -> usize {
        self.children.len()
    }

    /// The first child from `first` on that is neither blank nor comment.
    pub(super) fn skip_trivia(&self, first: usize) -> usize {
        let own = self.children.get(first..).unwrap_or_default();
        first + own.iter().take_while(|it| it.is_trivia()).count()
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
        let (cache, text) = (&mut self.memo.tokens, self.text);
        let children = self.children.drain(first..).map(|it| cache.element(text, it));
        let node = GreenNode::new(raw::of(kind), children);
        self.children.push(Child::Node(node));
    }

    /// The one root.
    pub(super) fn finish(mut self) -> GreenNode {
        let (cache, text) = (&mut self.memo.tokens, self.text);
        GreenNode::new(raw::of(SyntaxKind::Root), self.children.drain(..).map(|it| cache.element(text, it)))
    }

    /// The node that a piece was when it was read before in the same context.
    pub(super) fn known(&self, key: Key, context: u32) -> Option<GreenNode> {
        self.memo.node(key, context).cloned()
    }

    pub(super) fn push(&mut self, node: GreenNode) {
        self.children.push(Child::Node(node));
    }

    /// Keeps what a piece has become, if that is one node, and the only one from `first` on.
    pub(super) fn remember(&mut self, key: Key, context: u32, first: usize) {
        if let Some([Child::Node(node)]) = self.children.get(self.skip_trivia(first)..) {
            self.memo.keep_node(key, context, node);
        }
    }
}

pub(super) struct TokenCache {
    /// Tokens of up to eight bytes with what they are: nine of ten.
    short: Vec<Short>,
    long: Vec<Option<GreenToken>>,
}

/// A token that is known without a look at it.
#[derive(Clone)]
struct Short {
    text: u64,
    /// Kind and length; 0 for none.
    form: u32,
    token: Option<GreenToken>,
}

impl TokenCache {
    /// The number of slots is a power of two.
    pub(super) fn new(slots: usize) -> Self {
        let short = vec![Short { text: 0, form: 0, token: None }; slots];
        Self { short, long: vec![None; slots / 2] }
    }

    #[inline]
    fn element(&mut self, text: &str, child: Child) -> NodeOrToken<GreenNode, GreenToken> {
        match child {
            Child::Node(it) => NodeOrToken::Node(it),
            Child::Token { raw, start, len } => NodeOrToken::Token(self.token(text, raw, start, len)),
        }
    }

    #[inline]
    fn token(&mut self, whole: &str, raw: rowan::SyntaxKind, start: u32, len: u32) -> GreenToken {
        let eight = whole.as_bytes().get(start as usize..).and_then(<[u8]>::first_chunk::<8>);
        if let (Some(eight), 1..=8) = (eight, len) {
            let text = u64::from_le_bytes(*eight) & u64::MAX >> (64 - 8 * len);
            let form = u32::from(raw.0) << 4 | len;
            let mixed = (text ^ u64::from(form) << 40).wrapping_mul(MULTIPLIERS[0]);
            let slot = (mixed >> 48) as usize & self.short.len().wrapping_sub(1);
            if let Some(Short { text: known, form: known_form, token: Some(token) }) = self.short.get(slot)
                && *known == text
                && *known_form == form
            {
                return token.clone();
            }
            return self.new_short(whole, raw, (start, len), Short { text, form, token: None }, slot);
        }
        self.long(whole, raw, start, len)
    }

    #[cold]
    fn new_short(
        &mut self,
        whole: &str,
        raw: rowan::SyntaxKind,
        (start, len): (u32, u32),
        short: Short,
        slot: usize,
    ) -> GreenToken {
        let token = GreenToken::new(raw, &whole[start as usize..(start + len) as usize]);
        if let Some(slot) = self.short.get_mut(slot) {
            *slot = Short { token: Some(token.clone()), ..short };
        }
        token
    }

    fn long(&mut self, whole: &str, raw: rowan::SyntaxKind, start: u32, len: u32) -> GreenToken {
        let text = &whole[start as usize..(start + len) as usize];
        if text.len() > LONGEST_CACHED {
            return GreenToken::new(raw, text);
        }
        let words = words(text.as_bytes());
        let slot = hash(raw, text.len(), words) & self.long.len().wrapping_sub(1);
        let Some(slot) = self.long.get_mut(slot) else { return GreenToken::new(raw, text) };
        match slot {
            Some(it)
                if it.kind() == raw && it.text().len() == text.len() && self::words(it.text().as_bytes()) == words =>
            {
                it.clone()
            }
            _ => slot.insert(GreenToken::new(raw, text)).clone(),
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

const MULTIPLIERS: [u64; 3] = [0x9E37_79B9_7F4A_7C15, 0xC2B2_AE3D_27D4_EB4F, 0x1656_67B1_9E37_79F9];

/// Its low bits are mixed.
fn hash(raw: rowan::SyntaxKind, len: usize, [first, middle, last]: [u64; 3]) -> usize {
    let [a, b, c] = MULTIPLIERS;
    let own = u64::from(raw.0) ^ (len as u64) << 16;
    let mixed = (first ^ own).wrapping_mul(a) ^ middle.wrapping_mul(b) ^ last.wrapping_mul(c);
    (mixed >> 40) as usize
}

//! Views of a tree: a borrowed green node or token with its place.
//!
//! A view is a few words, copied freely, and knows what is below it, not what is above: who needs the way down to a place
//! keeps it. Walking costs nothing but reading the tree, which is why the whole pipeline works on views and not on nodes
//! that allocate and count references.

use std::borrow::Cow;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::iter::FusedIterator;
use std::marker::PhantomData;

use rowan::{GreenNodeData, GreenTokenData, NodeOrToken, TextRange, TextSize};

use super::kind::{SyntaxKind, raw};

/// A node and its place in the unit.
#[derive(Clone, Copy)]
pub struct SyntaxNode<'t> {
    green: Green<'t>,
    start: TextSize,
}

#[derive(Clone, Copy)]
enum Green<'t> {
    Node(&'t GreenNodeData),
    /// A node that is stored as its one token.
    Leaf(&'t GreenTokenData),
}

/// A token and its place in the unit.
#[derive(Clone, Copy)]
pub struct SyntaxToken<'t> {
    green: &'t GreenTokenData,
    /// Where what is stored begins.
    start: TextSize,
    part: Part,
}

/// What of a stored token a token is: one with the spaces behind it is two.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Part {
    All,
    BeforeSpaces,
    Spaces,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SyntaxElement<'t> {
    Node(SyntaxNode<'t>),
    Token(SyntaxToken<'t>),
}

/// Identity, not structure: tokens are shared, so the place counts too.
impl PartialEq for SyntaxNode<'_> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = match (self.green, other.green) {
            (Green::Node(a), Green::Node(b)) => std::ptr::eq(a, b),
            (Green::Leaf(a), Green::Leaf(b)) => std::ptr::eq(a, b),
            (Green::Node(_), Green::Leaf(_)) | (Green::Leaf(_), Green::Node(_)) => false,
        };
        is_same && self.start == other.start
    }
}

impl Eq for SyntaxNode<'_> {}

impl Hash for SyntaxNode<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self.green {
            Green::Node(it) => std::ptr::from_ref(it).hash(state),
            Green::Leaf(it) => std::ptr::from_ref(it).hash(state),
        }
        self.start.hash(state);
    }
}

impl PartialEq for SyntaxToken<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.green, other.green) && self.start == other.start && self.part == other.part
    }
}

impl Eq for SyntaxToken<'_> {}

impl Hash for SyntaxToken<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::from_ref(self.green).hash(state);
        self.start.hash(state);
        self.part.hash(state);
    }
}

impl<'t> SyntaxNode<'t> {
    pub(super) fn new_root(green: &'t GreenNodeData) -> Self {
        Self { green: Green::Node(green), start: TextSize::new(0) }
    }

    pub fn kind(self) -> SyntaxKind {
        match self.green {
            Green::Node(it) => raw::node(it.kind()),
            Green::Leaf(it) => raw::leaf(it.kind()).unwrap_or(SyntaxKind::Error),
        }
    }

    /// Whether the node holds one token and nothing else.
    pub fn is_leaf(self) -> bool {
        matches!(self.green, Green::Leaf(_))
    }

    pub fn text_range(self) -> TextRange {
        let len = match self.green {
            Green::Node(it) => it.text_len(),
            Green::Leaf(it) => it.text_len(),
        };
        TextRange::at(self.start, len)
    }

    /// The text of all tokens; borrowed when there is one.
    pub fn text(self) -> Cow<'t, str> {
        if let Green::Leaf(token) = self.green {
            return Cow::Borrowed(token.text());
        }
        let mut tokens = self.descendant_tokens();
        let Some(first) = tokens.next() else { return Cow::Borrowed("") };
        let Some(second) = tokens.next() else { return Cow::Borrowed(first.text()) };
        let mut text = String::with_capacity(self.text_range().len().into());
        for token in [first, second].into_iter().chain(tokens) {
            text.push_str(token.text());
        }
        Cow::Owned(text)
    }

    pub fn children_with_tokens(self) -> Elements<'t> {
        match self.green {
            Green::Node(it) => Elements { raw: Some(it.children()), next: None, start: self.start },
            Green::Leaf(green) => {
                let next = Some(SyntaxToken { green, start: self.start, part: Part::All });
                Elements { raw: None, next, start: self.start }
            }
        }
    }

    pub fn children(self) -> impl Iterator<Item = SyntaxNode<'t>> + Clone {
        Children(self.children_with_tokens())
    }

    /// The node's own tokens, blanks and comments too.
    pub fn tokens(self) -> impl Iterator<Item = SyntaxToken<'t>> + Clone {
        self.children_with_tokens().filter_map(SyntaxElement::into_token)
    }

    /// Enters and leaves every node below and this one, and enters every token.
    pub fn walk(self) -> Walk<'t> {
        Walk { open: Vec::new(), next: Some(self) }
    }

    /// Whether part of it was not understood.
    pub fn has_error(self) -> bool {
        self.descendants().any(|it| it.kind() == SyntaxKind::Error)
    }

    /// This node and every node below it, in the order of the text.
    pub fn descendants(self) -> impl Iterator<Item = SyntaxNode<'t>> {
        std::iter::once(self).chain(self.below(|_| true))
    }

    /// The nodes below this one that are of a kind, in the order of the text. Below them none is looked for.
    pub fn outermost(self, kind: SyntaxKind) -> impl Iterator<Item = SyntaxNode<'t>> {
        self.below(move |it| it.kind() != kind).filter(move |it| it.kind() == kind)
    }

    /// The nodes below this one, in the order of the text, and of those that are opened what is below.
    fn below(self, opens: impl Fn(SyntaxNode<'t>) -> bool) -> impl Iterator<Item = SyntaxNode<'t>> {
        let mut open = Vec::with_capacity(8);
        open.push(self.children_with_tokens());
        std::iter::from_fn(move || {
            loop {
                let Some(node) = open.last_mut()?.next_node() else {
                    open.pop();
                    continue;
                };
                if !node.is_leaf() && opens(node) {
                    open.push(node.children_with_tokens());
                }
                return Some(node);
            }
        })
    }

    /// Every token below this node, in the order of the text.
    pub fn descendant_tokens(self) -> impl Iterator<Item = SyntaxToken<'t>> {
        let mut open = Vec::with_capacity(8);
        open.push(self.children_with_tokens());
        std::iter::from_fn(move || {
            loop {
                match open.last_mut()?.next() {
                    Some(SyntaxElement::Token(token)) => return Some(token),
                    Some(SyntaxElement::Node(node)) => match node.green {
                        Green::Leaf(green) => return Some(SyntaxToken { green, start: node.start, part: Part::All }),
                        Green::Node(_) => open.push(node.children_with_tokens()),
                    },
                    None => {
                        open.pop();
                    }
                }
            }
        })
    }
}

/// The tree in indented lines.
impl fmt::Debug for SyntaxNode<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return write!(f, "{:?}@{:?}", self.kind(), self.text_range());
        }
        let mut depth = 0_usize;
        for event in self.walk() {
            match event {
                WalkEvent::Enter(node) => {
                    writeln!(f, "{:1$}{node:?}", "", depth * 2)?;
                    depth += 1;
                }
                WalkEvent::Token(token) => writeln!(f, "{:1$}{token:?}", "", depth * 2)?,
                WalkEvent::Leave(_) => depth = depth.saturating_sub(1),
            }
        }
        Ok(())
    }
}

impl<'t> SyntaxToken<'t> {
    #[inline]
    pub fn kind(self) -> SyntaxKind {
        match self.part {
            Part::All | Part::BeforeSpaces => raw::token(self.green.kind()),
            Part::Spaces => SyntaxKind::Whitespace,
        }
    }

    #[inline]
    pub fn text(self) -> &'t str {
        let text = self.green.text();
        match self.part {
            Part::All => text,
            Part::BeforeSpaces => &text[..before_spaces(text)],
            Part::Spaces => &text[before_spaces(text)..],
        }
    }

    #[inline]
    pub fn text_range(self) -> TextRange {
        let text = self.green.text();
        let parted = || TextSize::of(&text[..before_spaces(text)]);
        match self.part {
            Part::All => TextRange::at(self.start, self.green.text_len()),
            Part::BeforeSpaces => TextRange::at(self.start, parted()),
            Part::Spaces => TextRange::new(self.start + parted(), self.start + self.green.text_len()),
        }
    }
}

fn before_spaces(text: &str) -> usize {
    text.bytes().rposition(|it| it != b' ').map_or(0, |it| it + 1)
}

impl fmt::Debug for SyntaxToken<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}@{:?} {:?}", self.kind(), self.text_range(), self.text())
    }
}

impl<'t> SyntaxElement<'t> {
    pub fn kind(self) -> SyntaxKind {
        match self {
            Self::Node(it) => it.kind(),
            Self::Token(it) => it.kind(),
        }
    }

    pub fn into_node(self) -> Option<SyntaxNode<'t>> {
        match self {
            Self::Node(it) => Some(it),
            Self::Token(_) => None,
        }
    }

    pub fn into_token(self) -> Option<SyntaxToken<'t>> {
        match self {
            Self::Node(_) => None,
            Self::Token(it) => Some(it),
        }
    }
}

/// Children of a node with their places.
#[derive(Debug, Clone)]
pub struct Elements<'t> {
    /// `None` of a node that is stored as its one token.
    raw: Option<rowan::Children<'t>>,
    /// What comes before the rest: that one token, or the spaces that are stored with the token given last.
    next: Option<SyntaxToken<'t>>,
    start: TextSize,
}

impl<'t> Iterator for Elements<'t> {
    type Item = SyntaxElement<'t>;

    #[inline]
    fn next(&mut self) -> Option<SyntaxElement<'t>> {
        if let Some(token) = self.next.take() {
            return Some(SyntaxElement::Token(token));
        }
        let start = self.start;
        Some(match self.raw.as_mut()?.next()? {
            NodeOrToken::Node(it) => {
                self.start += it.text_len();
                SyntaxElement::Node(SyntaxNode { green: Green::Node(it), start })
            }
            NodeOrToken::Token(green) => {
                self.start += green.text_len();
                let raw = green.kind();
                if raw::leaf(raw).is_some() {
                    return Some(SyntaxElement::Node(SyntaxNode { green: Green::Leaf(green), start }));
                }
                if !raw::has_spaces(raw) {
                    return Some(SyntaxElement::Token(SyntaxToken { green, start, part: Part::All }));
                }
                self.next = Some(SyntaxToken { green, start, part: Part::Spaces });
                SyntaxElement::Token(SyntaxToken { green, start, part: Part::BeforeSpaces })
            }
        })
    }
}

impl FusedIterator for Elements<'_> {}

impl<'t> Elements<'t> {
    /// The next that is a node: what tokens are is not looked at.
    #[inline]
    fn next_node(&mut self) -> Option<SyntaxNode<'t>> {
        self.next_node_or(|_| false)?.into_node()
    }

    /// The next that is a node, or a token of a kind that is wanted; no kind of blanks is.
    #[inline]
    pub fn next_node_or(&mut self, is_wanted: impl Fn(SyntaxKind) -> bool) -> Option<SyntaxElement<'t>> {
        if let Some(token) = self.next.take().filter(|it| is_wanted(it.kind())) {
            return Some(SyntaxElement::Token(token));
        }
        let stored = self.raw.as_mut()?;
        loop {
            let start = self.start;
            match stored.next()? {
                NodeOrToken::Node(it) => {
                    self.start += it.text_len();
                    return Some(SyntaxElement::Node(SyntaxNode { green: Green::Node(it), start }));
                }
                NodeOrToken::Token(green) => {
                    self.start += green.text_len();
                    let kind = green.kind();
                    if raw::leaf(kind).is_some() {
                        return Some(SyntaxElement::Node(SyntaxNode { green: Green::Leaf(green), start }));
                    }
                    if is_wanted(raw::token(kind)) {
                        let part = if raw::has_spaces(kind) { Part::BeforeSpaces } else { Part::All };
                        return Some(SyntaxElement::Token(SyntaxToken { green, start, part }));
                    }
                }
            }
        }
    }
}

/// See [`SyntaxNode::children`].
#[derive(Debug, Clone)]
struct Children<'t>(Elements<'t>);

impl<'t> Iterator for Children<'t> {
    type Item = SyntaxNode<'t>;

    #[inline]
    fn next(&mut self) -> Option<SyntaxNode<'t>> {
        self.0.next_node()
    }
}

/// A step of [`SyntaxNode::walk`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WalkEvent<'t> {
    Enter(SyntaxNode<'t>),
    Token(SyntaxToken<'t>),
    Leave(SyntaxNode<'t>),
}

/// See [`SyntaxNode::walk`].
#[derive(Debug, Clone)]
pub struct Walk<'t> {
    open: Vec<(SyntaxNode<'t>, Elements<'t>)>,
    next: Option<SyntaxNode<'t>>,
}

impl<'t> Iterator for Walk<'t> {
    type Item = WalkEvent<'t>;

    fn next(&mut self) -> Option<WalkEvent<'t>> {
        if let Some(node) = self.next.take() {
            self.open.push((node, node.children_with_tokens()));
            return Some(WalkEvent::Enter(node));
        }
        let (node, children) = self.open.last_mut()?;
        match children.next() {
            Some(SyntaxElement::Node(child)) => {
                self.open.push((child, child.children_with_tokens()));
                Some(WalkEvent::Enter(child))
            }
            Some(SyntaxElement::Token(token)) => Some(WalkEvent::Token(token)),
            None => {
                let node = *node;
                self.open.pop();
                Some(WalkEvent::Leave(node))
            }
        }
    }
}

impl FusedIterator for Walk<'_> {}

/// A typed view of a node.
pub trait AstNode<'t>: Copy {
    fn can_cast(kind: SyntaxKind) -> bool;

    fn cast(node: SyntaxNode<'t>) -> Option<Self>;

    fn syntax(self) -> SyntaxNode<'t>;

    /// Place of the node. Blanks and comments stand before the node whose first token they precede, so it has none at
    /// its ends.
    fn range(self) -> TextRange {
        self.syntax().text_range()
    }

    /// The first child of a type.
    fn child<N: AstNode<'t>>(self) -> Option<N> {
        self.children().next()
    }

    fn children<N: AstNode<'t>>(self) -> AstChildren<'t, N> {
        AstChildren { elements: self.syntax().children_with_tokens(), kind: PhantomData }
    }

    /// The first token of a kind.
    fn child_token(self, kind: SyntaxKind) -> Option<SyntaxToken<'t>> {
        self.syntax().tokens().find(|it| it.kind() == kind)
    }

    /// Tokens that are neither blanks nor comments.
    fn significant(self) -> impl Iterator<Item = SyntaxToken<'t>> + Clone {
        Significant(self.syntax().children_with_tokens())
    }
}

/// See [`AstNode::significant`].
#[derive(Debug, Clone)]
struct Significant<'t>(Elements<'t>);

impl<'t> Iterator for Significant<'t> {
    type Item = SyntaxToken<'t>;

    #[inline]
    fn next(&mut self) -> Option<SyntaxToken<'t>> {
        loop {
            if let SyntaxElement::Token(it) = self.0.next_node_or(|it| !it.is_trivia())? {
                return Some(it);
            }
        }
    }
}

/// Children of one type.
#[derive(Debug, Clone)]
pub struct AstChildren<'t, N> {
    elements: Elements<'t>,
    kind: PhantomData<N>,
}

impl<'t, N: AstNode<'t>> Iterator for AstChildren<'t, N> {
    type Item = N;

    fn next(&mut self) -> Option<N> {
        std::iter::from_fn(|| self.elements.next_node()).find_map(N::cast)
    }
}

/// Typed views of nodes that are of one kind each.
macro_rules! nodes {
    ($($(#[$meta:meta])* $name:ident),* $(,)?) => {$(
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $name<'t>($crate::syntax::SyntaxNode<'t>);

        impl<'t> $crate::syntax::AstNode<'t> for $name<'t> {
            fn can_cast(kind: $crate::syntax::SyntaxKind) -> bool {
                kind == $crate::syntax::SyntaxKind::$name
            }

            fn cast(node: $crate::syntax::SyntaxNode<'t>) -> Option<Self> {
                Self::can_cast(node.kind()).then_some(Self(node))
            }

            fn syntax(self) -> $crate::syntax::SyntaxNode<'t> {
                self.0
            }
        }
    )*};
}

/// Typed views of nodes that are of one of several types.
macro_rules! choices {
    ($($(#[$meta:meta])* $name:ident { $($variant:ident($node:ident)),* $(,)? })*) => {$(
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name<'t> { $($variant($node<'t>)),* }

        impl<'t> $crate::syntax::AstNode<'t> for $name<'t> {
            fn can_cast(kind: $crate::syntax::SyntaxKind) -> bool {
                $($node::can_cast(kind))||*
            }

            fn cast(node: $crate::syntax::SyntaxNode<'t>) -> Option<Self> {
                let kind = node.kind();
                $(if $node::can_cast(kind) {
                    return $node::cast(node).map(Self::$variant);
                })*
                None
            }

            fn syntax(self) -> $crate::syntax::SyntaxNode<'t> {
                match self { $(Self::$variant(it) => it.syntax()),* }
            }
        }
    )*};
}

pub(crate) use {choices, nodes};

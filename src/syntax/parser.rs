//! The parser kit: a cursor over tokens that a grammar drives, and the tree that grows behind it.
//!
//! A grammar sees significant tokens only. It opens a node with [`Parser::start`], closes it with
//! [`Parser::complete`], and may wrap a finished node afterwards with [`Parser::precede`]. Whatever a grammar does,
//! every token is in the tree exactly once and in order: [`Parser::finish`] appends those that were not consumed.
//! No event is kept: a node is built when it is closed, from the finished children that stand behind its marker.

use rowan::{GreenNode, TextRange, TextSize};

use super::builder::TreeBuilder;
use super::kind::SyntaxKind;
use super::node::SyntaxNode;

/// Nesting beyond this is reported once and read flat, so that no input can exhaust the stack.
pub const MAX_DEPTH: u32 = 128;

/// One lexed token: kind and length in bytes. The lengths of all tokens add up to the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    pub kind: SyntaxKind,
    pub len: u32,
}

/// The tokens of a text, as a lexer finds them one behind the other.
#[derive(Debug, Default)]
pub(super) struct Tokens(Vec<Token>);

impl Tokens {
    pub(super) fn with_capacity(tokens: usize) -> Self {
        Self(Vec::with_capacity(tokens))
    }

    /// Nothing for an empty token; runs of unknown characters become one.
    #[inline]
    pub(super) fn push(&mut self, kind: SyntaxKind, len: usize) {
        // Units are below 4 GiB: the source layer reads no larger file.
        let Some(len) = u32::try_from(len).ok().filter(|&it| it > 0) else { return };
        match self.0.last_mut() {
            Some(last) if kind == SyntaxKind::Unknown && last.kind == kind => last.len += len,
            _ => self.0.push(Token { kind, len }),
        }
    }

    pub(super) fn finish(self) -> Vec<Token> {
        self.0
    }
}

/// How many spaces stand between here and something visible in ASCII on the same line. Spaces are a third of all tokens,
/// and no affair of a lexer's state machine; other blanks are.
pub(super) fn spaces(rest: &str) -> usize {
    let rest = rest.as_bytes();
    let spaces = rest.iter().take_while(|it| **it == b' ').count();
    if rest.get(spaces).is_some_and(u8::is_ascii_graphic) { spaces } else { 0 }
}

/// A place that the grammar does not allow, with what was expected. The range is relative to the unit.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SyntaxError {
    pub range: TextRange,
    pub message: String,
}

/// Always a tree, plus what was wrong with the text. The tree's text is the input, for every input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parse {
    green: GreenNode,
    errors: Box<[SyntaxError]>,
}

impl Parse {
    /// The root.
    pub fn syntax(&self) -> SyntaxNode<'_> {
        SyntaxNode::new_root(&self.green)
    }

    pub fn errors(&self) -> &[SyntaxError] {
        &self.errors
    }
}

#[derive(Debug, Clone, Copy)]
struct Significant {
    kind: SyntaxKind,
    start: u32,
    len: u32,
    newline_before: bool,
}

pub struct Parser<'t> {
    text: &'t str,
    tokens: &'t [Token],
    significant: Vec<Significant>,
    pos: usize,
    /// How many of the tokens are in the tree, and where in the text the next one starts.
    built: usize,
    offset: u32,
    builder: TreeBuilder<'t>,
    errors: Vec<SyntaxError>,
    depth: u32,
}

/// An open node: where among the finished children its own begin.
#[must_use = "a started node must be completed or abandoned"]
pub struct Marker(usize);

/// A closed node, which `precede` can wrap: where it is among the finished children.
#[derive(Debug, Clone, Copy)]
pub struct Completed(usize);

impl<'t> Parser<'t> {
    pub fn new(text: &'t str, tokens: &'t [Token]) -> Self {
        let mut significant = Vec::with_capacity(tokens.len() * 2 / 3 + 1);
        let mut start = 0;
        let mut newline_before = true;
        for token in tokens {
            match token.kind {
                SyntaxKind::Newline => newline_before = true,
                kind if kind.is_trivia() => {}
                kind => {
                    significant.push(Significant { kind, start, len: token.len, newline_before });
                    newline_before = false;
                }
            }
            start += token.len;
        }
        let builder = TreeBuilder::new(text);
        Self { text, tokens, significant, pos: 0, built: 0, offset: 0, builder, errors: Vec::new(), depth: 0 }
    }

    pub fn at_end(&self) -> bool {
        self.pos >= self.significant.len()
    }

    pub fn current(&self) -> Option<SyntaxKind> {
        self.nth(0)
    }

    pub fn nth(&self, n: usize) -> Option<SyntaxKind> {
        self.significant.get(self.pos + n).map(|it| it.kind)
    }

    pub fn at(&self, kind: SyntaxKind) -> bool {
        self.current() == Some(kind)
    }

    /// Text of the current token, empty at the end.
    pub fn current_text(&self) -> &'t str {
        self.nth_text(0)
    }

    pub fn nth_text(&self, n: usize) -> &'t str {
        match self.significant.get(self.pos + n) {
            Some(it) => &self.text[it.start as usize..(it.start + it.len) as usize],
            None => "",
        }
    }

    pub fn at_text(&self, text: &str) -> bool {
        self.current_text().eq_ignore_ascii_case(text)
    }

    /// Whether the current token is the first significant one on its line. True at the end.
    pub fn newline_before(&self) -> bool {
        self.nth_newline_before(0)
    }

    pub fn nth_newline_before(&self, n: usize) -> bool {
        self.significant.get(self.pos + n).is_none_or(|it| it.newline_before)
    }

    /// Whether blanks or comments stand before the n-th token from here.
    pub fn nth_gap_before(&self, n: usize) -> bool {
        let at = self.pos + n;
        match (self.significant.get(at), at.checked_sub(1).and_then(|it| self.significant.get(it))) {
            (Some(this), Some(before)) => before.start + before.len != this.start,
            _ => true,
        }
    }

    /// Whether a tab, or three blanks, part the current token from the one before: it stands in a column of its own.
    pub fn in_next_column(&self) -> bool {
        const COLUMN: usize = 3;
        let (start, end) = (self.previous_range().end(), self.current_range().start());
        let gap = self.text.get(usize::from(start)..usize::from(end)).unwrap_or_default();
        gap.len() >= COLUMN || gap.contains('\t')
    }

    /// Index of the current token: grows with every `bump`, so a loop can assert its own progress.
    pub fn position(&self) -> usize {
        self.pos
    }

    pub fn bump(&mut self) {
        if let Some(kind) = self.current() {
            self.bump_as(kind);
        }
    }

    /// Consumes the current token under another kind: contextual keywords and free text.
    pub fn bump_as(&mut self, kind: SyntaxKind) {
        if !self.at_end() {
            self.trivia();
            self.token(Some(kind));
            self.pos += 1;
        }
    }

    /// Moves blanks and comments before the current token to the tree.
    fn trivia(&mut self) {
        while self.tokens.get(self.built).is_some_and(|it| it.kind.is_trivia()) {
            self.token(None);
        }
    }

    fn token(&mut self, kind: Option<SyntaxKind>) {
        if let Some(token) = self.tokens.get(self.built) {
            self.builder.token(kind.unwrap_or(token.kind), self.offset, token.len);
            self.offset += token.len;
            self.built += 1;
        }
    }

    pub fn eat(&mut self, kind: SyntaxKind) -> bool {
        let found = self.at(kind);
        if found {
            self.bump();
        }
        found
    }

    pub fn start(&mut self) -> Marker {
        Marker(self.builder.len())
    }

    /// Closes a node. Blanks and comments before its first token stay outside of it.
    pub fn complete(&mut self, marker: Marker, kind: SyntaxKind) -> Completed {
        let first = self.builder.skip_trivia(marker.0);
        if first == self.builder.len() {
            // An empty node stands where the next token is.
            self.trivia();
            let first = self.builder.len();
            self.builder.node(kind, first);
            return Completed(first);
        }
        self.builder.node(kind, first);
        Completed(first)
    }

    /// Forgets an open node; its tokens go to the node around it.
    pub fn abandon(&mut self, Marker(_): Marker) {}

    /// Opens a node that wraps the completed one.
    pub fn precede(&mut self, completed: Completed) -> Marker {
        Marker(completed.0)
    }

    /// Range of the current token; empty, after the last significant token, at the end.
    pub fn current_range(&self) -> TextRange {
        match self.significant.get(self.pos) {
            Some(it) => TextRange::at(TextSize::new(it.start), TextSize::new(it.len)),
            None => TextRange::empty(self.previous_range().end()),
        }
    }

    /// Range of the token consumed last.
    pub fn previous_range(&self) -> TextRange {
        match self.pos.checked_sub(1).and_then(|it| self.significant.get(it)) {
            Some(it) => TextRange::at(TextSize::new(it.start), TextSize::new(it.len)),
            None => TextRange::empty(TextSize::new(0)),
        }
    }

    /// Reports the current token.
    pub fn error(&mut self, message: impl Into<String>) {
        let range = self.current_range();
        self.error_at(range, message);
    }

    pub fn error_at(&mut self, range: TextRange, message: impl Into<String>) {
        self.errors.push(SyntaxError { range, message: message.into() });
    }

    /// Runs `inner` one level deeper, or reports the depth and returns `None`: the caller then skips to the end of
    /// the construct without recursion.
    pub fn nested<T>(&mut self, inner: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.depth >= MAX_DEPTH {
            self.error(format!("nesting deeper than {MAX_DEPTH} levels is not read"));
            return None;
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        Some(result)
    }

    /// The tree under one [`SyntaxKind::Root`].
    pub fn finish(mut self) -> Parse {
        while self.built < self.tokens.len() {
            self.token(None);
        }
        self.errors.sort_by_key(|it| (it.range.start(), it.range.end()));
        Parse { green: self.builder.finish(), errors: self.errors.into_boxed_slice() }
    }
}

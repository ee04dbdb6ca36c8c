//! The parser kit: a cursor over tokens that a grammar drives, and the tree that grows behind it.
//!
//! A grammar sees significant tokens only. It opens a node with [`Parser::start`], closes it with
//! [`Parser::complete`], and may wrap a finished node afterwards with [`Parser::precede`]. Whatever a grammar does,
//! every token is in the tree exactly once and in order: [`Parser::finish`] appends those that were not consumed.
//! No event is kept: a node is built when it is closed, from the finished children that stand behind its marker.

use rowan::{GreenNode, TextRange, TextSize};

use super::builder::TreeBuilder;
use super::kind::SyntaxKind;
use super::memo::{Key, LONGEST_PIECE, Memo};
use super::node::SyntaxNode;
use super::tokens::{Piece, Significant, Tokens, Trivia};

/// Nesting beyond this is reported once and read flat, so that no input can exhaust the stack.
pub const MAX_DEPTH: u32 = 128;

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

pub struct Parser<'t> {
    text: &'t str,
    significant: &'t [Significant],
    trivia: &'t [Trivia],
    pos: usize,
    /// How many of the blanks and comments are in the tree, and where in the text the next token starts.
    built: usize,
    offset: u32,
    pieces: &'t [Piece],
    /// The pieces before it have been passed.
    next_piece: usize,
    builder: TreeBuilder<'t>,
    errors: Vec<SyntaxError>,
    /// What went wrong so far, reported or not.
    faults: usize,
    depth: u32,
    /// In tests, the furthest token that a grammar has looked at, and of which it asked whether it starts its line.
    seen: std::cell::Cell<usize>,
    seen_line: std::cell::Cell<usize>,
}

/// An open node: where among the finished children its own begin.
#[must_use = "a started node must be completed or abandoned"]
pub struct Marker(usize);

/// A piece whose text may have been read before.
#[derive(Debug)]
pub(super) struct Known {
    key: Key,
    /// How many tokens it has that a grammar sees.
    pub(super) len: usize,
    first: usize,
    ends_line: bool,
    children: usize,
    faults: usize,
}

/// A closed node, which `precede` can wrap: where it is among the finished children.
#[derive(Debug, Clone, Copy)]
pub struct Completed(usize);

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t str, tokens: &'t Tokens, memo: &'t mut Memo) -> Self {
        Self {
            text,
            significant: &tokens.significant,
            trivia: &tokens.trivia,
            pos: 0,
            built: 0,
            offset: 0,
            pieces: &tokens.pieces,
            next_piece: 0,
            builder: TreeBuilder::new(text, memo),
            errors: Vec::new(),
            faults: 0,
            depth: 0,
            seen: Default::default(),
            seen_line: Default::default(),
        }
    }

    /// Of each token that a grammar sees, from the first on: what it is as a word.
    pub(super) fn words<T: Copy>(&self, of: impl Fn(&str) -> Option<T>) -> Vec<Option<T>> {
        let mut words = vec![None; self.significant.len()];
        for (word, it) in words.iter_mut().zip(self.significant) {
            if it.kind == SyntaxKind::Ident {
                *word = of(&self.text[it.start as usize..(it.start + it.len) as usize]);
            }
        }
        words
    }

    pub fn at_end(&self) -> bool {
        self.pos >= self.significant.len()
    }

    pub fn current(&self) -> Option<SyntaxKind> {
        self.nth(0)
    }

    pub fn nth(&self, n: usize) -> Option<SyntaxKind> {
        self.look(n);
        self.significant.get(self.pos + n).map(|it| it.kind)
    }

    /// Every look at a token: what a tree depends on. Kept in tests alone.
    #[inline(always)]
    fn look(&self, n: usize) {
        if cfg!(debug_assertions) {
            self.seen.set(self.seen.get().max(self.pos + n));
        }
    }

    pub fn at(&self, kind: SyntaxKind) -> bool {
        self.current() == Some(kind)
    }

    /// Text of the current token, empty at the end.
    pub fn current_text(&self) -> &'t str {
        self.nth_text(0)
    }

    pub fn nth_text(&self, n: usize) -> &'t str {
        self.look(n);
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
        if cfg!(debug_assertions) {
            self.seen_line.set(self.seen_line.get().max(self.pos + n));
        }
        self.significant.get(self.pos + n).is_none_or(|it| it.newline_before)
    }

    /// Whether blanks or comments stand before the n-th token from here.
    pub fn nth_gap_before(&self, n: usize) -> bool {
        self.look(n);
        let at = self.pos + n;
        match (self.significant.get(at), at.checked_sub(1).and_then(|it| self.significant.get(it))) {
            (Some(this), Some(before)) => before.start + before.len != this.start,
            _ => true,
        }
    }

    /// Whether a tab, or three blanks, part the current token from the one before: it stands in a column of its own.
    pub fn in_next_column(&self) -> bool {
        const COLUMN: usize = 3;
        self.look(0);
        let (start, end) = (self.previous_range().end(), self.current_range().start());
        let gap = self.text.get(usize::from(start)..usize::from(end)).unwrap_or_default();
        gap.len() >= COLUMN || gap.contains('\t')
    }

    /// Index of the current token: grows with every `bump`, so a loop can assert its own progress.
    pub fn position(&self) -> usize {
        self.pos
    }

    pub fn bump(&mut self) {
        if let Some(token) = self.significant.get(self.pos) {
            self.consume(*token, token.kind);
        }
    }

    /// Consumes the current token under another kind: contextual keywords and free text.
    pub fn bump_as(&mut self, kind: SyntaxKind) {
        if let Some(token) = self.significant.get(self.pos) {
            self.consume(*token, kind);
        }
    }

    #[inline]
    fn consume(&mut self, token: Significant, kind: SyntaxKind) {
        if self.offset < token.start {
            self.trivia_before(token.trivia as usize);
        }
        self.builder.token(kind, token.start, token.len);
        self.offset = token.start + token.len;
        self.pos += 1;
    }

    /// Moves blanks and comments before the current token to the tree.
    fn trivia(&mut self) {
        let until = self.significant.get(self.pos).map_or(self.trivia.len(), |it| it.trivia as usize);
        self.trivia_before(until);
    }

    #[inline]
    fn trivia_before(&mut self, until: usize) {
        while self.built < until
            && let Some(token) = self.trivia.get(self.built)
        {
            if token.is_spaces {
                self.builder.spaces(self.offset, token.len);
            } else {
                self.builder.token(token.kind, self.offset, token.len);
            }
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
        self.faults += usize::from(kind == SyntaxKind::Error);
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
            Some(it) => it.range(),
            None => TextRange::empty(self.previous_range().end()),
        }
    }

    /// Range of the token consumed last.
    pub fn previous_range(&self) -> TextRange {
        match self.pos.checked_sub(1).and_then(|it| self.significant.get(it)) {
            Some(it) => it.range(),
            None => TextRange::empty(TextSize::new(0)),
        }
    }

    /// Reports the current token.
    pub fn error(&mut self, message: impl Into<String>) {
        let range = self.current_range();
        self.error_at(range, message);
    }

    pub fn error_at(&mut self, range: TextRange, message: impl Into<String>) {
        self.fault();
        self.errors.push(SyntaxError { range, message: message.into() });
    }

    /// Counts what is wrong though it is not reported: it depends on what stands around it.
    pub(super) fn fault(&mut self) {
        self.faults += 1;
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

    /// The piece that starts at the current token, if the node of one may be asked for or kept here.
    #[inline]
    pub(super) fn piece(&mut self) -> Option<Known> {
        while self.pieces.get(self.next_piece).is_some_and(|it| (it.first as usize) < self.pos) {
            self.next_piece += 1;
        }
        let Piece { first, len, ends_line, key } = *self.pieces.get(self.next_piece)?;
        // Nothing in a piece nests deeper than it is long, so that the depth is no part of the context.
        if first as usize != self.pos || self.depth + LONGEST_PIECE as u32 > MAX_DEPTH {
            return None;
        }
        if cfg!(debug_assertions) {
            self.seen.set(self.pos);
            self.seen_line.set(self.pos);
        }
        let (children, faults) = (self.builder.len(), self.faults);
        Some(Known { key, len: len as usize, first: self.pos, ends_line, children, faults })
    }

    /// Consumes the piece at hand as the node that it was when it was read in the same context.
    #[inline]
    pub(super) fn recall(&mut self, piece: &Known, context: u32) -> bool {
        let Some([first, .., last] | [first @ last]) = self.significant.get(self.pos..self.pos + piece.len) else {
            return false;
        };
        let Some(node) = self.builder.known(piece.key, context) else { return false };
        if self.offset < first.start {
            self.trivia();
        }
        self.builder.push(node);
        self.pos += piece.len;
        self.built = last.trivia as usize;
        self.offset = last.start + last.len;
        true
    }

    /// Keeps the node that a piece has become, if it is one node without a fault. Whatever the grammar looked at was the
    /// piece, what `context` says, and if a line ends there, that the token behind it starts one. That token itself is
    /// part of the context where the grammar `knows_next`.
    pub(super) fn remember(&mut self, piece: &Known, context: u32, knows_next: bool) {
        let end = piece.first + piece.len;
        if self.pos != end || self.faults != piece.faults || self.offset != u32::from(self.previous_range().end()) {
            return;
        }
        if cfg!(debug_assertions) {
            let seen = end + usize::from(knows_next);
            assert!(self.seen.get() < seen, "the grammar looked beyond what is remembered");
            assert!(self.seen_line.get() < seen + usize::from(piece.ends_line), "the grammar looked beyond the line");
        }
        self.builder.remember(piece.key, context, piece.children);
    }

    /// The tree under one [`SyntaxKind::Root`].
    pub fn finish(mut self) -> Parse {
        while !self.at_end() {
            self.bump();
        }
        self.trivia();
        self.errors.sort_by_key(|it| (it.range.start(), it.range.end()));
        Parse { green: self.builder.finish(), errors: self.errors.into_boxed_slice() }
    }
}

//! The parser kit: a cursor over tokens that a grammar drives, and the tree that grows behind it.
//!
//! A grammar sees significant tokens only. It opens a node with [`Parser::start`], closes it with
//! [`Parser::complete`], and may wrap a finished node afterwards with [`Parser::precede`]. Whatever a grammar does,
//! every token is in the tree exactly once and in order: [`Parser::finish`] appends those that were not consumed.
//! No event is kept: a node is built when it is closed, from the finished children that stand behind its marker.

use rowan::{GreenNode, TextRange, TextSize};

use super::builder::TreeBuilder;
use super::kind::SyntaxKind;
use super::memo::{Grammar, Key, LONGEST_PIECE, Memo, PieceToken, PieceTrivia, Unread};
use super::node::SyntaxNode;

/// Nesting beyond this is reported once and read flat, so that no input can exhaust the stack.
pub const MAX_DEPTH: u32 = 128;

/// One lexed token: kind and length in bytes. The lengths of all tokens add up to the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    pub kind: SyntaxKind,
    pub len: u32,
}

/// A blank or comment.
#[derive(Debug, Clone, Copy)]
struct Trivia {
    kind: SyntaxKind,
    /// Whether it is spaces alone, behind a token that does not end with one.
    is_spaces: bool,
    len: u32,
}

/// The tokens of a text, as a lexer finds them one behind the other: those that a grammar sees, and those between.
#[derive(Debug, Default)]
pub(super) struct Tokens {
    significant: Vec<Significant>,
    trivia: Vec<Trivia>,
    end: u32,
    /// Whether a significant token stands on the line at hand.
    on_line: bool,
    pieces: Vec<Piece>,
    /// The piece at hand that was not read before.
    open: Option<OpenPiece>,
}

/// Tokens of a text that a [`Memo`] knows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    first: u32,
    len: u32,
    ends_line: bool,
    key: Key,
}

#[derive(Debug, Clone, Copy)]
struct OpenPiece {
    unread: Unread,
    start: u32,
    end: u32,
    last: Last,
    significant: usize,
    trivia: usize,
}

/// What ends a piece: no token that starts before goes on behind it, if this is its last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Last {
    /// A token of its own.
    Token(SyntaxKind),
    /// Whatever stands before the end of a line.
    OfLine,
}

#[derive(Debug, Clone, Copy)]
struct Significant {
    kind: SyntaxKind,
    newline_before: bool,
    start: u32,
    len: u32,
    /// How many of the blanks and comments of the text stand before it.
    trivia: u32,
}

impl Significant {
    fn range(&self) -> TextRange {
        TextRange::at(TextSize::new(self.start), TextSize::new(self.len))
    }
}

impl Tokens {
    /// Room for so many tokens, of which half are blanks.
    pub(super) fn with_capacity(tokens: usize) -> Self {
        let (significant, trivia) = (Vec::with_capacity(tokens * 2 / 3 + 1), Vec::with_capacity(tokens / 2 + 1));
        Self { significant, trivia, ..Self::default() }
    }

    /// Nothing for an empty token; runs of unknown characters become one.
    #[inline]
    pub(super) fn push(&mut self, kind: SyntaxKind, len: usize) {
        // Units are below 4 GiB: the source layer reads no larger file.
        let len = len as u32;
        if kind.is_trivia() || kind == SyntaxKind::Unknown || len == 0 {
            return self.push_other(kind, len);
        }
        self.push_significant(kind, len);
    }

    #[inline]
    fn push_significant(&mut self, kind: SyntaxKind, len: u32) {
        // As many as fit the text.
        let (start, trivia) = (self.end, self.trivia.len() as u32);
        self.end += len;
        let newline_before = !std::mem::replace(&mut self.on_line, true);
        self.significant.push(Significant { kind, newline_before, start, len, trivia });
    }

    #[inline(never)]
    fn push_other(&mut self, kind: SyntaxKind, len: u32) {
        if len == 0 {
            return;
        }
        if kind.is_trivia() {
            self.end += len;
            self.on_line &= kind != SyntaxKind::Newline;
            self.trivia.push(Trivia { kind, is_spaces: false, len });
            return;
        }
        if let Some(last) = self.significant.last_mut()
            && last.kind == kind
            && last.start + last.len == self.end
        {
            last.len += len;
            self.end += len;
            return;
        }
        self.push_significant(kind, len);
    }

    /// What stands behind a token that does not end with a space itself: the line feed there, or else the spaces, if
    /// something visible in ASCII follows. They are a third of all tokens, and no affair of a lexer's state machine; other
    /// blanks are. Gives their length and whether a line was begun.
    #[inline]
    pub(super) fn push_blanks(&mut self, rest: &str) -> (usize, bool) {
        match rest.as_bytes() {
            [b' ' | b'\n' | b'\r', ..] => self.push_any_blanks(rest.as_bytes()),
            _ => (0, false),
        }
    }

    fn push_any_blanks(&mut self, rest: &[u8]) -> (usize, bool) {
        let mut len = match rest {
            [b'\n', ..] => 1,
            [b'\r', b'\n', ..] => 2,
            _ => 0,
        };
        let is_spaces = len == 0;
        while rest.get(len) == Some(&b' ') {
            len += 1;
        }
        if len == 0 || !rest.get(len).is_some_and(u8::is_ascii_graphic) {
            return (0, false);
        }
        let kind = if is_spaces { SyntaxKind::Whitespace } else { SyntaxKind::Newline };
        self.trivia.push(Trivia { kind, is_spaces, len: len as u32 });
        self.end += len as u32;
        self.on_line &= is_spaces;
        (len, !is_spaces)
    }

    /// The `len` bytes at hand: the tokens that they were when they were read before, and true; else they may be read
    /// again, if [`end_piece`](Self::end_piece) is called behind each of their tokens. They hold no line break.
    pub(super) fn piece(
        &mut self,
        memo: &mut Memo,
        grammar: Grammar,
        text: &str,
        (len, hash): (usize, u64),
        last: Last,
    ) -> bool {
        let start = self.end;
        // Pieces do not lie in each other: the label of a statement begins one that goes on behind it.
        if self.open.is_some_and(|it| it.end > start) {
            return false;
        }
        let range = start as usize..start as usize + len;
        let (Some(piece), true) = (text.as_bytes().get(range), (4..=LONGEST_PIECE).contains(&len)) else {
            return false;
        };
        let (significant, trivia) = (self.significant.len(), self.trivia.len());
        // No longer than a piece, and the text is below 4 GiB.
        let end = start + len as u32;
        let (key, known) = match memo.find(grammar, piece, hash) {
            Ok(known) => known,
            Err(unread) => {
                self.open = unread.map(|unread| OpenPiece { unread, start, end, last, significant, trivia });
                return false;
            }
        };
        let before = u32::try_from(trivia).unwrap_or(u32::MAX);
        let mut newline_before = !std::mem::replace(&mut self.on_line, true);
        self.significant.extend(known.significant().iter().map(|it| Significant {
            kind: it.kind,
            newline_before: std::mem::take(&mut newline_before),
            start: start + u32::from(it.start),
            len: u32::from(it.len),
            trivia: before + u32::from(it.trivia),
        }));
        let blank = |it: &PieceTrivia| Trivia { kind: it.kind, is_spaces: it.is_spaces, len: u32::from(it.len) };
        self.trivia.extend(known.trivia().iter().map(blank));
        let first = u32::try_from(significant).unwrap_or(u32::MAX);
        let ends_line = last == Last::OfLine;
        self.pieces.push(Piece { first, len: known.significant().len() as u32, ends_line, key });
        self.end = end;
        true
    }

    /// The piece that starts here in a text of PL7: an element of a rung up to its parenthesis, elsewhere a statement up to
    /// its `;` or the line. Gives its length, and whether another starts behind it.
    #[inline]
    pub(super) fn pl7_piece(
        &mut self,
        memo: &mut Memo,
        grammar: Grammar,
        text: &str,
        rest: &str,
    ) -> Option<(usize, bool)> {
        let rest = rest.as_bytes();
        let stops = if grammar.is_ladder() { *b")\n" } else { *b";\n" };
        let (end, hash) = super::memo::until(rest, stops)?;
        let (len, last) = match rest.get(end)? {
            b')' => (end + 1, Last::Token(SyntaxKind::RParen)),
            b';' => (end + 1, Last::Token(SyntaxKind::Semicolon)),
            _ if grammar.is_ladder() => return None,
            _ => (end - usize::from(rest.get(..end)?.ends_with(b"\r")), Last::OfLine),
        };
        let is_known = self.piece(memo, grammar, text, (len, hash), last);
        is_known.then_some((len, last == Last::Token(SyntaxKind::Semicolon)))
    }

    /// Behind a token: whether the piece at hand ends here is seen, and it is kept.
    #[inline]
    pub(super) fn end_piece(&mut self, memo: &mut Memo, text: &str) {
        if let Some(open) = self.open.take_if(|it| it.end <= self.end) {
            self.keep_piece(memo, text, open);
        }
    }

    #[inline(never)]
    fn keep_piece(&mut self, memo: &mut Memo, text: &str, open: OpenPiece) {
        let OpenPiece { unread, start, end, last, significant: first, trivia: first_trivia } = open;
        let significant = self.significant.get(first..).unwrap_or_default();
        let trivia = self.trivia.get(first_trivia..).unwrap_or_default();
        let (Some(last_token), true) = (significant.last(), self.end == end) else { return };
        let is_last = match last {
            Last::Token(kind) => last_token.kind == kind && last_token.start + last_token.len == end,
            Last::OfLine => true,
        };
        // A run of unknown characters may have begun before.
        let is_whole = significant.first().is_some_and(|it| it.start >= start);
        let is_on_line = significant.iter().skip(1).all(|it| !it.newline_before)
            && trivia.iter().all(|it| it.kind != SyntaxKind::Newline);
        let Some(piece) = text.as_bytes().get(start as usize..end as usize) else { return };
        if !(is_last && is_whole && is_on_line) {
            return;
        }
        // All of it is within a piece, whose length fits a byte.
        let token = |it: &Significant| PieceToken {
            kind: it.kind,
            start: (it.start - start) as u8,
            len: it.len as u8,
            trivia: (it.trivia as usize - first_trivia) as u8,
        };
        let blank = |it: &Trivia| PieceTrivia { kind: it.kind, is_spaces: it.is_spaces, len: it.len as u8 };
        if let Some(key) = memo.keep(unread, piece, significant.iter().map(token), trivia.iter().map(blank)) {
            let first = u32::try_from(first).unwrap_or(u32::MAX);
            let ends_line = last == Last::OfLine;
            self.pieces.push(Piece { first, len: significant.len() as u32, ends_line, key });
        }
    }

    /// Length of the comment that is not closed, and so ends the text.
    pub(super) fn unclosed_comment(&self) -> Option<u32> {
        self.trivia.last().filter(|it| it.kind == SyntaxKind::UnclosedComment).map(|it| it.len)
    }

    /// All tokens in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = Token> {
        let mut seen = 0;
        self.significant.iter().map(Some).chain([None]).flat_map(move |it| {
            let until = it.map_or(self.trivia.len(), |it| it.trivia as usize);
            let before = self.trivia.get(seen..until).unwrap_or_default();
            seen = until;
            let before = before.iter().map(|it| Token { kind: it.kind, len: it.len });
            before.chain(it.map(|it| Token { kind: it.kind, len: it.len }))
        })
    }
}

/// Length of a comment that started before, with its `*)`; `None` where that is missing.
pub(super) fn comment_length(rest: &str) -> Option<usize> {
    let rest = rest.as_bytes();
    let is_end = |at: &usize| at.checked_sub(1).is_some_and(|star| rest[star] == b'*');
    memchr::memchr_iter(b')', rest).find(is_end).map(|it| it + 1)
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

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
        Self { significant, trivia, end: 0, on_line: false }
    }

    /// Nothing for an empty token; runs of unknown characters become one.
    #[inline]
    pub(super) fn push(&mut self, kind: SyntaxKind, len: usize) {
        // Units are below 4 GiB: the source layer reads no larger file.
        let Some(len) = u32::try_from(len).ok().filter(|&it| it > 0) else { return };
        let start = self.end;
        self.end += len;
        if kind.is_trivia() {
            self.on_line &= kind != SyntaxKind::Newline;
            self.trivia.push(Trivia { kind, is_spaces: false, len });
            return;
        }
        if kind == SyntaxKind::Unknown
            && let Some(last) = self.significant.last_mut()
            && last.kind == kind
            && last.start + last.len == start
        {
            last.len += len;
            return;
        }
        let trivia = u32::try_from(self.trivia.len()).unwrap_or(u32::MAX);
        let newline_before = !std::mem::replace(&mut self.on_line, true);
        self.significant.push(Significant { kind, newline_before, start, len, trivia });
    }

    /// What stands behind a token that does not end with a space itself: the line feed there, or else the spaces, if
    /// something visible in ASCII follows. They are a third of all tokens, and no affair of a lexer's state machine; other
    /// blanks are. Gives their length and whether a line was begun.
    #[inline]
    pub(super) fn push_blanks(&mut self, rest: &str) -> (usize, bool) {
        let (line_feed, rest) = match rest.as_bytes() {
            [b' ', ..] => (0, rest.as_bytes()),
            [b'\n', rest @ ..] => (1, rest),
            [b'\r', b'\n', rest @ ..] => (2, rest),
            _ => return (0, false),
        };
        let spaces = rest.iter().take_while(|it| **it == b' ').count();
        let len = line_feed + spaces;
        let (true, Ok(short)) = (rest.get(spaces).is_some_and(u8::is_ascii_graphic), u32::try_from(len)) else {
            return (0, false);
        };
        let is_spaces = line_feed == 0;
        let kind = if is_spaces { SyntaxKind::Whitespace } else { SyntaxKind::Newline };
        self.trivia.push(Trivia { kind, is_spaces, len: short });
        self.end += short;
        self.on_line &= is_spaces;
        (len, !is_spaces)
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
    pub(super) fn new(text: &'t str, tokens: &'t Tokens) -> Self {
        Self {
            text,
            significant: &tokens.significant,
            trivia: &tokens.trivia,
            pos: 0,
            built: 0,
            offset: 0,
            builder: TreeBuilder::new(text),
            errors: Vec::new(),
            depth: 0,
        }
    }

    /// Of each token that a grammar sees, from the first on: what it is as a word.
    pub(super) fn words<T>(&self, of: impl Fn(&str) -> Option<T>) -> Vec<Option<T>> {
        let text = |it: &Significant| &self.text[it.start as usize..(it.start + it.len) as usize];
        self.significant.iter().map(|it| if it.kind == SyntaxKind::Ident { of(text(it)) } else { None }).collect()
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
        if let Some(token) = self.significant.get(self.pos) {
            if self.offset < token.start {
                self.trivia();
            }
            self.builder.token(kind, token.start, token.len);
            self.offset = token.start + token.len;
            self.pos += 1;
        }
    }

    /// Moves blanks and comments before the current token to the tree.
    fn trivia(&mut self) {
        let until = self.significant.get(self.pos).map_or(self.trivia.len(), |it| it.trivia as usize);
        for token in self.trivia.get(self.built..until).unwrap_or_default() {
            if token.is_spaces {
                self.builder.spaces(self.offset, token.len);
            } else {
                self.builder.token(token.kind, self.offset, token.len);
            }
            self.offset += token.len;
        }
        self.built = until;
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
        while !self.at_end() {
            self.bump();
        }
        self.trivia();
        self.errors.sort_by_key(|it| (it.range.start(), it.range.end()));
        Parse { green: self.builder.finish(), errors: self.errors.into_boxed_slice() }
    }
}

//! The tokens of a text, apart from the blanks and comments between them, and the pieces of it that were read before.
//!
//! A lexer pushes them one behind the other; the parser kit reads them ([`Parser`](super::parser::Parser)).

use logos::Logos;
use rowan::{TextRange, TextSize};

use super::kind::SyntaxKind;
use super::memo::{self, Key, LONGEST_PIECE, Memo, PieceToken, PieceTrivia, Pieces, Unread};

/// One lexed token: kind and length in bytes. The lengths of all tokens add up to the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    pub kind: SyntaxKind,
    pub len: u32,
}

/// A blank or comment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trivia {
    pub(super) kind: SyntaxKind,
    /// Whether it is spaces alone, behind a token that does not end with one.
    pub(super) is_spaces: bool,
    pub(super) len: u32,
}

/// The tokens of a text, as a lexer finds them one behind the other: those that a grammar sees, and those between.
#[derive(Debug, Default)]
pub(super) struct Tokens {
    pub(super) significant: Vec<Significant>,
    pub(super) trivia: Vec<Trivia>,
    end: u32,
    /// Whether a significant token stands on the line at hand.
    on_line: bool,
    pub(super) pieces: Vec<Piece>,
    /// The piece at hand that was not read before.
    open: Option<OpenPiece>,
}

/// Tokens of a text that a [`Memo`] knows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) first: u32,
    pub(super) len: u32,
    pub(super) ends_line: bool,
    pub(super) key: Key,
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
enum Last {
    /// A token of its own.
    Token(SyntaxKind),
    /// Whatever stands before the end of a line.
    OfLine,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Significant {
    pub(super) kind: SyntaxKind,
    pub(super) newline_before: bool,
    pub(super) start: u32,
    pub(super) len: u32,
    /// How many of the blanks and comments of the text stand before it.
    pub(super) trivia: u32,
}

impl Significant {
    pub(super) fn range(&self) -> TextRange {
        TextRange::at(TextSize::new(self.start), TextSize::new(self.len))
    }
}

impl Tokens {
    /// Room for so many tokens, of which half are blanks.
    pub(super) fn with_capacity(tokens: usize) -> Self {
        let (significant, trivia) = (Vec::with_capacity(tokens * 3 / 4 + 1), Vec::with_capacity(tokens / 2 + 1));
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

    /// The tokens of a text of PL7 or PL7-2, where pieces of it may have been read before. `suffix`: how long the token is
    /// that belongs to the one before it and only there.
    pub(super) fn of_pl7<'t, L>(
        text: &'t str,
        pieces: Option<Pieces>,
        memo: &mut Memo,
        suffix: impl Fn(SyntaxKind, &[u8]) -> usize,
    ) -> Self
    where
        L: Logos<'t, Source = str, Extras: Default>,
        SyntaxKind: From<L>,
    {
        let mut tokens = Self::with_capacity(text.len() / 4 + 1);
        let mut lexer = L::lexer(text);
        // What piece may start here.
        let mut starts = pieces;
        loop {
            if let Some(of) = starts
                && let Some(last) = tokens.known_piece(memo, of, text)
            {
                lexer.bump(tokens.end as usize - lexer.span().end);
                let (blanks, begins_line) = tokens.push_blanks(lexer.remainder());
                lexer.bump(blanks);
                starts = (begins_line || last == Last::Token(SyntaxKind::Semicolon)).then_some(of);
                continue;
            }
            let Some(lexeme) = lexer.next() else { break };
            let kind = lexeme.map_or(SyntaxKind::Unknown, SyntaxKind::from);
            tokens.push(kind, lexer.slice().len());
            let suffix = suffix(kind, lexer.remainder().as_bytes());
            if suffix > 0 {
                lexer.bump(suffix);
                tokens.push(SyntaxKind::ObjectSuffix, suffix);
            }
            tokens.end_piece(memo, text);
            let (blanks, begins_line) = tokens.push_blanks(lexer.remainder());
            lexer.bump(blanks);
            starts = pieces.filter(|it| begins_line || it.starts_piece(kind));
        }
        tokens
    }

    /// The piece that starts here: an element of a rung up to its parenthesis, elsewhere a statement up to its `;` or the
    /// line. If it was read before, its tokens are what they were then, and what ends it is given. Else it may be read
    /// again, if [`end_piece`](Self::end_piece) is called behind each of its tokens.
    #[inline]
    fn known_piece(&mut self, memo: &mut Memo, of: Pieces, text: &str) -> Option<Last> {
        let start = self.end;
        // Pieces do not lie in each other: the label of a statement begins one that goes on behind it.
        if self.open.is_some_and(|it| it.end > start) {
            return None;
        }
        let rest = text.as_bytes().get(start as usize..)?;
        let stops = if of.is_ladder() { *b")\n" } else { *b";\n" };
        let (until, hash) = memo::until(rest, stops)?;
        let (len, last) = match rest.get(until)? {
            b')' => (until + 1, Last::Token(SyntaxKind::RParen)),
            b';' => (until + 1, Last::Token(SyntaxKind::Semicolon)),
            _ if of.is_ladder() => return None,
            _ => (until - usize::from(rest.get(..until)?.ends_with(b"\r")), Last::OfLine),
        };
        let piece = rest.get(..len).filter(|_| (4..=LONGEST_PIECE).contains(&len))?;
        let (significant, trivia) = (self.significant.len(), self.trivia.len());
        // No longer than a piece, and the text is below 4 GiB.
        let end = start + len as u32;
        let (key, known) = match memo.find(of, piece, hash) {
            Ok(known) => known,
            Err(unread) => {
                self.open = unread.map(|unread| OpenPiece { unread, start, end, last, significant, trivia });
                return None;
            }
        };
        let (first, before) = (significant as u32, trivia as u32);
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
        let ends_line = last == Last::OfLine;
        self.pieces.push(Piece { first, len: known.significant().len() as u32, ends_line, key });
        self.end = end;
        Some(last)
    }

    /// Behind a token: whether the piece at hand ends here is seen, and it is kept.
    #[inline]
    fn end_piece(&mut self, memo: &mut Memo, text: &str) {
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
            let ends_line = last == Last::OfLine;
            self.pieces.push(Piece { first: first as u32, len: significant.len() as u32, ends_line, key });
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

//! What texts have in common: words and statements that were read before are neither read nor made again.
//!
//! A program says most of its statements many times. Of a piece of text that is read again the tokens are copied, and
//! where its first reading gave one whole node without a fault, that node is shared. A lexer says where pieces may lie
//! ([`Tokens::of_pl7`](super::tokens::Tokens::of_pl7)), a grammar which nodes it asks for
//! ([`Parser::recall`](super::Parser)). The statements of lists and of structured text hardly repeat: they have no pieces.
//!
//! **Invariant**: a tree is the same with any memo. So a piece ends where no token can go on, whatever follows; a node is
//! shared only where what the grammar looked at was the piece and the context that is compared with it.
//!
//! Half of the statements of a program stand there once: nothing but a mark is kept of a piece before it is seen again.
//! The slots are as many as stay in the processor's own memory, and forget on collision.

use rowan::GreenNode;

use super::builder::TokenCache;
use super::kind::SyntaxKind;
use super::{Language, Parse};

const MOST_SLOTS: usize = 4096;

/// Marks of pieces that were seen once, for each slot.
const MARKS: usize = 4;

/// Longer lines hardly ever repeat.
pub(super) const LONGEST_PIECE: usize = 64;
pub(super) const MOST_TOKENS: usize = 20;
pub(super) const MOST_TRIVIA: usize = 14;

/// What is kept from one text to the next. Bounded in size, whatever is read.
pub struct Memo {
    pub(super) tokens: TokenCache,
    slots: Vec<Slot>,
    /// Hashes of the pieces in the slots: a look into one of these is spared.
    hashes: Vec<u32>,
    /// Hashes of pieces that were seen.
    marks: Vec<u16>,
    /// How many slots there are once a piece is seen.
    most: usize,
    stamp: u32,
}

/// A piece of text that was not read before, or not often enough.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unread {
    slot: u32,
    hash: u32,
    of: Pieces,
}

impl Default for Memo {
    /// For texts of any size.
    fn default() -> Self {
        Self::with_slots(MOST_SLOTS)
    }
}

impl std::fmt::Debug for Memo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Memo").finish_non_exhaustive()
    }
}

/// A token of a piece that a grammar sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct PieceToken {
    pub(super) kind: SyntaxKind,
    /// From the start of the piece.
    pub(super) start: u8,
    pub(super) len: u8,
    /// How many of the blanks and comments of the piece stand before it.
    pub(super) trivia: u8,
}

/// A blank or comment of a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct PieceTrivia {
    pub(super) kind: SyntaxKind,
    pub(super) is_spaces: bool,
    pub(super) len: u8,
}

/// The last piece of those with one hash.
#[derive(Clone)]
pub(super) struct Slot {
    /// Which filling of a slot it is: no two of a memo have the same. 0 when empty.
    stamp: u32,
    of: Pieces,
    len: u8,
    text: [u8; LONGEST_PIECE],
    significant_len: u8,
    trivia_len: u8,
    significant: [PieceToken; MOST_TOKENS],
    trivia: [PieceTrivia; MOST_TRIVIA],
    node: Option<(u32, GreenNode)>,
}

impl Slot {
    const EMPTY: Self = Self {
        stamp: 0,
        of: Pieces::Ld,
        len: 0,
        text: [0; LONGEST_PIECE],
        significant_len: 0,
        trivia_len: 0,
        significant: [PieceToken { kind: SyntaxKind::Unknown, start: 0, len: 0, trivia: 0 }; MOST_TOKENS],
        trivia: [PieceTrivia { kind: SyntaxKind::Whitespace, is_spaces: false, len: 0 }; MOST_TRIVIA],
        node: None,
    };

    pub(super) fn significant(&self) -> &[PieceToken] {
        self.significant.get(..usize::from(self.significant_len)).unwrap_or_default()
    }

    pub(super) fn trivia(&self) -> &[PieceTrivia] {
        self.trivia.get(..usize::from(self.trivia_len)).unwrap_or_default()
    }
}

/// Where the tokens of a piece are kept, unless others have taken their place since.
#[derive(Debug, Clone, Copy)]
pub(super) struct Key {
    slot: u32,
    stamp: u32,
}

/// Whose pieces: those of another grammar have other tokens and nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Pieces {
    Ld,
    Chart,
    Pl72Ld,
    Pl72Chart,
}

impl Memo {
    fn with_slots(slots: usize) -> Self {
        Self {
            tokens: TokenCache::new(slots),
            slots: Vec::new(),
            hashes: Vec::new(),
            marks: Vec::new(),
            most: slots,
            stamp: 0,
        }
    }

    /// For one text alone: a small one needs few slots.
    pub(super) fn for_text(text: &str) -> Self {
        Self::with_slots((text.len() / 32).next_power_of_two().clamp(32, MOST_SLOTS))
    }

    /// Parses one unit. Total and linear for every text; the tree is that of [`parse`](super::parse).
    pub fn parse(&mut self, language: Language, text: &str) -> Parse {
        super::parse_with(language, text, self)
    }

    /// The tokens of the piece, if they are kept; else whether they should be.
    #[inline]
    pub(super) fn find(&mut self, of: Pieces, text: &[u8], hash: u64) -> Result<(Key, &Slot), Option<Unread>> {
        if self.slots.is_empty() {
            self.slots = vec![Slot::EMPTY; self.most];
            self.hashes = vec![0; self.most];
            self.marks = vec![0; self.most * MARKS];
        }
        let hash = (hash ^ of as u64).wrapping_mul(MULTIPLIER);
        let at = (hash >> 52) as usize & self.slots.len().wrapping_sub(1);
        let (slot, tag) = (at as u32, hash as u32);
        if self.hashes.get(at) == Some(&tag)
            && let Some(it) = self.slots.get(at)
            && it.stamp != 0
            && it.of == of
            && it.text.get(..usize::from(it.len)) == Some(text)
        {
            return Ok((Key { slot, stamp: it.stamp }, it));
        }
        let mark = (hash >> 48) as usize & self.marks.len().wrapping_sub(1);
        let Some(mark) = self.marks.get_mut(mark) else { return Err(None) };
        let is_seen = std::mem::replace(mark, hash as u16) == hash as u16;
        Err(is_seen.then_some(Unread { slot, hash: tag, of }))
    }

    /// Keeps the tokens of a piece; `None` if they are more than a slot takes.
    pub(super) fn keep(
        &mut self,
        Unread { slot, hash, of }: Unread,
        text: &[u8],
        significant: impl ExactSizeIterator<Item = PieceToken>,
        trivia: impl ExactSizeIterator<Item = PieceTrivia>,
    ) -> Option<Key> {
        let fits = text.len() <= LONGEST_PIECE && significant.len() <= MOST_TOKENS && trivia.len() <= MOST_TRIVIA;
        let it = self.slots.get_mut(slot as usize).filter(|_| fits)?;
        it.text.get_mut(..text.len())?.copy_from_slice(text);
        it.len = u8::try_from(text.len()).ok()?;
        it.of = of;
        it.significant_len = u8::try_from(significant.len()).ok()?;
        it.trivia_len = u8::try_from(trivia.len()).ok()?;
        it.significant.iter_mut().zip(significant).for_each(|(kept, it)| *kept = it);
        it.trivia.iter_mut().zip(trivia).for_each(|(kept, it)| *kept = it);
        it.node = None;
        // Keys live no longer than a parse, and no text has that many pieces.
        self.stamp = self.stamp.wrapping_add(1).max(1);
        it.stamp = self.stamp;
        *self.hashes.get_mut(slot as usize)? = hash;
        Some(Key { slot, stamp: it.stamp })
    }

    /// The node that the piece was when it was read in the same context.
    pub(super) fn node(&self, key: Key, context: u32) -> Option<&GreenNode> {
        let slot = self.slots.get(key.slot as usize).filter(|it| it.stamp == key.stamp)?;
        slot.node.as_ref().filter(|it| it.0 == context).map(|it| &it.1)
    }

    pub(super) fn keep_node(&mut self, key: Key, context: u32, node: &GreenNode) {
        if let Some(slot) = self.slots.get_mut(key.slot as usize).filter(|it| it.stamp == key.stamp) {
            slot.node = Some((context, node.clone()));
        }
    }
}

impl Pieces {
    /// Whether a piece may start behind a token.
    pub(super) fn starts_piece(self, kind: SyntaxKind) -> bool {
        match kind {
            SyntaxKind::Newline | SyntaxKind::Semicolon => true,
            SyntaxKind::Comma => self.is_ladder(),
            _ => false,
        }
    }

    /// Whether rungs stand there and nothing else.
    pub(super) fn is_ladder(self) -> bool {
        matches!(self, Self::Ld | Self::Pl72Ld)
    }
}

const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;

/// What stands before the first of two characters, of ASCII, and a hash of it; `None` where neither is near.
#[inline]
pub(super) fn until(rest: &[u8], [a, b]: [u8; 2]) -> Option<(usize, u64)> {
    const ONES: u64 = 0x0101_0101_0101_0101;
    const HIGHS: u64 = 0x8080_8080_8080_8080;
    let (words, _) = rest.get(..LONGEST_PIECE + 8).unwrap_or(rest).as_chunks::<8>();
    let (a, b) = (ONES * u64::from(a), ONES * u64::from(b));
    let (mut hash, mut at) = (0_u64, 0);
    for word in words {
        let word = u64::from_le_bytes(*word);
        // A byte that is zero has its high bit set here, and so may bytes behind it.
        let zeros = |it: u64| it.wrapping_sub(ONES) & !it & HIGHS;
        let found = zeros(word ^ a) | zeros(word ^ b);
        if found != 0 {
            let before = (found & found.wrapping_neg()).wrapping_sub(1) >> 7;
            hash = (hash.rotate_left(23) ^ word & before).wrapping_mul(MULTIPLIER);
            return Some((at + found.trailing_zeros() as usize / 8, hash));
        }
        hash = (hash.rotate_left(23) ^ word).wrapping_mul(MULTIPLIER);
        at += 8;
    }
    // The last bytes of a text are of no account.
    None
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const RUNGS: [&str; 16] = [
        "RUNG",
        "RUNG (* pompe *) %L1:",
        "END_RUNG",
        "OPEN_CONTACT(%I1.0),CLOSED_CONTACT(%M5),H_LINK(7),COIL(%M1);",
        "OPEN_CONTACT(%I1.0),H_LINK,EMPTY_CELL(8);",
        "COMPARE %MW6>100 END_BLOCK,H_LINK(8),COIL(%M6);",
        "P_CONTACT(%I8.13),H_LINK(6),OPERATE %MW1:=%MW1+1 END_BLOCK;",
        "OPERATE %MW1:=1; %MW2:=2 END_BLOCK,COIL(%M1)",
        "OPERATE %MW1:=SQRT(%MW1)",
        "END_BLOCK;",
        "COIL(%M1)",
        ",OPEN_CONTACT(%I1.0)",
        "SR_CALL(SR5);",
        "OPEN_CONTACT(%I1.0",
        "COIL(é);",
        "(* open",
    ];

    const PL7_2: [&str; 12] = [
        "RUNG (* pompe *) L2:",
        "END_RUNG",
        "OPEN_CONTACT(I1,04),OPEN_CONTACT(B0),H_LINK(6),COIL(O0,01);",
        "COMPARE W3 > 100 END_BLOCK,H_LINK(7),COIL(B3);",
        "P_CONTACT(I0,07),OPERATE W10 + 1 -> W10 END_BLOCK;",
        "OPERATE W10 -> W11",
        "OPERATE W1 -> W5(W10)",
        "END_BLOCK,COIL(W5(W10));",
        ",V END_BLOCK;",
        "COIL(B1),H_LINK;",
        "STEP 1 AT (C 0,L 3) : END_STEP",
        "(B1)",
    ];

    const PAGES: [&str; 20] = [
        "PAGE 0",
        "END_PAGE",
        "INITIAL_STEP 0 (*pret*) AT (C 0,L 1) : END_STEP",
        "STEP 1 AT (C 0,L 3) : END_STEP",
        "STEP 2 AT (C 0,L 5) :",
        "ACTION (P1,ST) :",
        "ACTION (N1,LD) :",
        "(*PHRASE*) %MW0:=5; SET %M4; (*END_PHRASE*)",
        "END_ACTION",
        "END_STEP",
        "TRANSITION (ST) AT (C 0,L 2) :",
        "TRANSITION (LD) AT (C 0,L 4) :",
        "(*PHRASE*) NOT %M0 AND %M1 (*END_PHRASE*)",
        "END_TRANSITION",
        "S_T_OR_LINK FROM (C 0,L 1) TO (C 1,L 2)",
        "SOURCE_CONNECTOR 79 AT (C 0,L 0)",
        "RUNG OPEN_CONTACT(%M1),COIL(#);",
        "OPEN_CONTACT(%I1.0),H_LINK(10);",
        ";",
        "(*PHRASE*) Step : %M0 := (%M1",
    ];

    fn texts(parts: &'static [&'static str]) -> impl Strategy<Value = Vec<String>> {
        let ends = prop::sample::select(vec!["\n", "\n", "\n", "\r\n", " ", " \n", "\t", ""]);
        let line = (prop::sample::select(parts), ends).prop_map(|(part, end)| format!("{part}{end}"));
        prop::collection::vec(prop::collection::vec(line, 0..24).prop_map(|it| it.concat()), 1..8)
    }

    /// Each text twice, so that every piece of it is one that was seen.
    fn check(language: Language, texts: &[String]) -> Result<(), TestCaseError> {
        let mut memo = Memo::with_slots(64);
        for text in texts.iter().chain(texts).chain(texts) {
            let alone = super::super::parse_with(language, text, &mut Memo::with_slots(0));
            let parse = memo.parse(language, text);
            prop_assert_eq!(parse.syntax().text(), text.as_str());
            prop_assert_eq!(parse.errors(), alone.errors(), "{}", text);
            prop_assert_eq!(&parse, &alone, "{}", text);
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn a_rung_is_the_same_with_any_memo(texts in texts(&RUNGS)) {
            check(Language::Pl7Ld, &texts)?;
        }

        #[test]
        fn a_chart_is_the_same_with_any_memo(texts in texts(&PAGES)) {
            check(Language::Pl7Gr7, &texts)?;
            check(Language::Pl72Gr7, &texts)?;
        }

        #[test]
        fn a_network_of_pl7_2_is_the_same_with_any_memo(texts in texts(&PL7_2)) {
            check(Language::Pl72Ld, &texts)?;
            check(Language::Pl72Gr7, &texts)?;
        }

        #[test]
        fn the_end_of_a_piece_is_the_first(text in r"[a-z;\n\x80é]{0,90}") {
            let bytes = text.as_bytes();
            let found = until(bytes, *b";\n").map(|it| it.0);
            let first = bytes.iter().position(|it| matches!(it, b';' | b'\n'));
            prop_assert!(found.is_none_or(|it| first == Some(it)));
            prop_assert!(found.is_some() || first.is_none_or(|it| it + 8 > bytes.len() || it + 8 > LONGEST_PIECE));
        }
    }

    /// A token of such length is in no cache: it is one token only in one node.
    #[test]
    fn a_line_that_was_read_before_is_shared() {
        let mut memo = Memo::default();
        let text = "PAGE 0\nSTEP 0 (*a comment of that length*) AT (C 0,L 1) : END_STEP\nEND_PAGE\n";
        let parses = [(); 4].map(|()| memo.parse(Language::Pl7Gr7, text));
        let comments = parses.each_ref().map(|it| {
            let comment = it.syntax().descendant_tokens().find(|it| it.kind() == SyntaxKind::Comment);
            comment.expect("a comment").text().as_ptr()
        });
        assert_ne!(comments[0], comments[1]);
        assert_eq!(comments[2], comments[3]);
    }
}

//! Words as numbers, which a table can be searched for: told apart without allocation and regardless of case.

/// Bit that parts a small letter of ASCII from the capital. No two characters of words differ by it alone: letters,
/// digits, `_`, the signs of operators.
const CASE: u128 = 0x2020_2020_2020_2020_2020_2020_2020_2020;

/// A word of at most 16 bytes, the last of them lowest; 0 for a longer word and for none.
pub(super) const fn pack(word: &[u8]) -> u128 {
    // Two pieces that may overlap are all of the word: where they do, they are the same.
    let packed = if let (1..=16, Some(first), Some(last)) = (word.len(), word.first_chunk(), word.last_chunk()) {
        (u64::from_be_bytes(*first) as u128) << ((word.len() - 8) * 8) | u64::from_be_bytes(*last) as u128
    } else if let (1..=8, Some(first), Some(last)) = (word.len(), word.first_chunk(), word.last_chunk()) {
        ((u32::from_be_bytes(*first) as u64) << ((word.len() - 4) * 8) | u32::from_be_bytes(*last) as u64) as u128
    } else {
        match *word {
            [a] => a as u128,
            [a, b] => (a as u128) << 8 | b as u128,
            [a, b, c] => (a as u128) << 16 | (b as u128) << 8 | c as u128,
            _ => 0,
        }
    };
    packed & !CASE
}

/// Slots of an [`Index`]: at least twice as many as words, so that probing ends.
const SLOTS: usize = 1024;

/// Longer words count as of the last length.
const LENGTHS: usize = 32;

/// The words of a list, to be found by open addressing.
pub(super) struct Index<const N: usize> {
    words: [&'static str; N],
    keys: [u128; N],
    /// Place in the list, counted from 1; 0 for a free slot.
    slots: [u16; SLOTS],
    /// By length, which letters the words start with: most of what is looked up is no word.
    starts: [u32; LENGTHS],
}

impl<const N: usize> Index<N> {
    pub(super) const fn new(words: [&'static str; N]) -> Self {
        assert!(N <= SLOTS / 2, "probing ends at a free slot");
        let (mut keys, mut slots, mut starts) = ([0; N], [0; SLOTS], [0; LENGTHS]);
        let mut at = 0;
        while at < N {
            keys[at] = key(words[at].as_bytes());
            starts[length(words[at].as_bytes())] |= start(words[at].as_bytes()[0]);
            let mut slot = slot(keys[at]);
            while slots[slot] != 0 {
                slot = (slot + 1) % SLOTS;
            }
            at += 1;
            slots[slot] = at as u16;
        }
        Self { words, keys, slots, starts }
    }

    /// Place in the list of a word in any case.
    #[inline]
    pub(super) fn find(&self, word: &str) -> Option<usize> {
        if self.starts[length(word.as_bytes())] & start(*word.as_bytes().first()?) == 0 {
            return None;
        }
        let key = key(word.as_bytes());
        let mut slot = slot(key);
        let at = loop {
            let at = usize::from(self.slots[slot]).checked_sub(1)?;
            if self.keys[at] == key {
                break at;
            }
            slot = (slot + 1) % SLOTS;
        };
        let found = self.words[at];
        // The key of a long word leaves some of it out.
        (found.len() == word.len() && (word.len() <= 16 || found.eq_ignore_ascii_case(word))).then_some(at)
    }
}

const fn length(word: &[u8]) -> usize {
    if word.len() < LENGTHS { word.len() } else { LENGTHS - 1 }
}

/// A letter in any case.
const fn start(letter: u8) -> u32 {
    1 << (letter % 32)
}

const fn slot(key: u128) -> usize {
    const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;
    let mixed = (key as u64 ^ ((key >> 64) as u64).rotate_left(29)).wrapping_mul(MULTIPLIER);
    (mixed >> 48) as usize % SLOTS
}

/// The [`Index`] of a list by the field that holds the word of each entry.
macro_rules! index {
    ($entries:ident, $word:tt) => {
        $crate::syntax::packed::Index::new({
            let (mut words, mut at) = ([""; $entries.len()], 0);
            while at < $entries.len() {
                words[at] = $entries[at].$word;
                at += 1;
            }
            words
        })
    };
}
pub(super) use index;

/// [`pack`], and of a longer word its first and last eight bytes.
const fn key(word: &[u8]) -> u128 {
    match (word.first_chunk::<8>(), word.last_chunk::<8>()) {
        (Some(first), Some(last)) if word.len() > 16 => pack(first) << 64 | pack(last),
        _ => pack(word),
    }
}

#[cfg(test)]
mod tests {
    use super::{Index, pack};

    #[test]
    fn long_words_are_compared() {
        let index = Index::new(["TO", "DESTINATION_CONNECTOR", "AT"]);
        let words = ["at", "Destination_Connector", "TO", "DESTINATIVE_CONNECTOR", "DESTINATONNECTOR", "OT", ""];
        assert_eq!(words.map(|it| index.find(it)), [Some(2), Some(1), Some(0), None, None, None, None]);
    }

    #[test]
    fn words_of_all_lengths_are_told_apart() {
        let text = b"ABCABCABCABCABCABCA";
        let words: Vec<&[u8]> = (1..=16).flat_map(|len| (0..3).map(move |from| &text[from..from + len])).collect();
        for (at, word) in words.iter().enumerate() {
            assert_eq!(pack(word), pack(&word.to_ascii_lowercase()));
            assert_eq!(words.iter().position(|it| pack(it) == pack(word)), Some(at), "{word:?}");
        }
        assert_eq!([pack(b""), pack(&text[..17])], [0, 0]);
    }
}

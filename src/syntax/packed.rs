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

/// The words of a list, to be found by binary search.
pub(super) struct Index<const N: usize> {
    words: [&'static str; N],
    /// Each with its place in the list, in the order of the keys.
    keys: [(u128, usize); N],
}

impl<const N: usize> Index<N> {
    pub(super) const fn new(words: [&'static str; N]) -> Self {
        let mut keys = [(0, 0); N];
        let mut filled = 0;
        while filled < N {
            let key = key(words[filled].as_bytes());
            let mut place = filled;
            while place > 0 && keys[place - 1].0 > key {
                keys[place] = keys[place - 1];
                place -= 1;
            }
            keys[place] = (key, filled);
            filled += 1;
        }
        Self { words, keys }
    }

    /// Place in the list of a word in any case.
    pub(super) fn find(&self, word: &str) -> Option<usize> {
        let key = key(word.as_bytes());
        let at = self.keys[self.keys.binary_search_by_key(&key, |it| it.0).ok()?].1;
        let found = self.words[at];
        // The key of a long word leaves some of it out.
        (found.len() == word.len() && (word.len() <= 16 || found.eq_ignore_ascii_case(word))).then_some(at)
    }
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

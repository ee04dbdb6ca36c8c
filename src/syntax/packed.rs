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

#[cfg(test)]
mod tests {
    use super::pack;

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

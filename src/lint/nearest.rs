//! The nearest known name to a misspelt one, for messages.

/// The candidate that takes the fewest edits, when they are few enough to be a slip of the keyboard: one edit in a
/// name of up to four characters, two up to eight, three above. Case is ignored. Earlier candidates win ties.
pub fn nearest<'a>(wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong: Vec<char> = wrong.chars().take(MAX + 1).flat_map(char::to_lowercase).collect();
    if wrong.is_empty() || wrong.len() > MAX {
        return None;
    }
    let limit = match wrong.len() {
        ..=4 => 1,
        5..=8 => 2,
        _ => 3,
    };
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let distance = distance(&wrong, candidate);
        if distance <= limit && best.is_none_or(|it| distance < it.0) {
            best = Some((distance, candidate));
        }
    }
    best.map(|it| it.1)
}

/// Longer input is no name: it is not compared.
const MAX: usize = 64;

/// Edits between two words: insertion, deletion, replacement, and exchange of neighbours.
fn distance(left: &[char], right: &str) -> usize {
    let right: Vec<char> = right.chars().flat_map(char::to_lowercase).collect();
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=right.len()).collect();
    for (row, &l) in left.iter().enumerate() {
        let mut current = Vec::with_capacity(right.len() + 1);
        current.push(row + 1);
        for (column, &r) in right.iter().enumerate() {
            let replaced = above[column] + usize::from(l != r);
            let mut cost = replaced.min(above[column + 1] + 1).min(current[column] + 1);
            if row > 0 && column > 0 && l == right[column - 1] && left[row - 1] == r {
                cost = cost.min(before[column - 1] + 1);
            }
            current.push(cost);
        }
        before = std::mem::replace(&mut above, current);
    }
    above.last().copied().unwrap_or(left.len())
}

#[cfg(test)]
mod tests {
    use super::nearest;

    const NAMES: [&str; 4] = ["single-write", "mixed-write", "W001", "J001"];

    #[test]
    fn a_slip_finds_its_name() {
        assert_eq!(nearest("singel-write", NAMES), Some("single-write"));
        assert_eq!(nearest("mixedwrite", NAMES), Some("mixed-write"));
        assert_eq!(nearest("w01", NAMES), Some("W001"));
    }

    #[test]
    fn another_word_finds_nothing() {
        assert_eq!(nearest("halt", NAMES), None);
        assert_eq!(nearest("", NAMES), None);
        assert_eq!(nearest(&"x".repeat(100_000), NAMES), None);
    }
}

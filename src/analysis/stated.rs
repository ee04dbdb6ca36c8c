//! Relations that comments state of two operands: `MW10 > MW20`, in signs or in words.

use crate::model::expr::Comparison;

/// The relation of `a` to `b` that a comment states, where it names each of them once and puts one relation, and nothing that
/// may be another matter, between them.
pub fn stated(comment: &str, a: &str, b: &str) -> Option<Comparison> {
    let (a, b) = (words(a), words(b));
    let all = words(comment);
    if a == b || all.iter().any(|it| is_negation(it)) {
        return None;
    }
    let (at_a, at_b) = (only(&all, &a)?, only(&all, &b)?);
    if at_a < at_b {
        relation(all.get(at_a + a.len()..at_b)?)
    } else {
        Some(relation(all.get(at_b + b.len()..at_a)?)?.mirrored())
    }
}

/// Words, numbers, addresses and signs, in lower case; a blank within an address is none.
fn words(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let is_word = |it: char| it.is_alphanumeric() || matches!(it, '_' | '.' | '#');
        let is_sign = |it: char| matches!(it, '<' | '>' | '=');
        let end = match first {
            '-' => 1 + rest[1..].find(|it| !is_word(it)).unwrap_or(rest.len() - 1),
            '\'' | '’' => {
                // `n'est`, `l'entrée`: what stands before is a word of its own.
                rest = rest[first.len_utf8()..].trim_start();
                continue;
            }
            it if is_word(it) => rest.find(|it| !is_word(it)).unwrap_or(rest.len()),
            it if is_sign(it) => rest.find(|it| !is_sign(it)).unwrap_or(rest.len()),
            it => it.len_utf8(),
        };
        let (word, behind) = rest.split_at(end);
        rest = behind.trim_start();
        let word = word.trim_end_matches('.').trim_matches('#').to_lowercase();
        if word.is_empty() || matches!(first, '"' | '«' | '»' | '“' | '”') {
            continue;
        }
        let is_number = word.starts_with(|it: char| it.is_ascii_digit());
        match found.last_mut() {
            Some(before) if is_number && is_area(before) => before.push_str(&word),
            _ => found.push(word.strip_prefix("l#").map(str::to_owned).unwrap_or(word)),
        }
    }
    found
}

/// Letters of an address, which a number follows.
fn is_area(word: &str) -> bool {
    const AREAS: &[&str] = &[
        "mb", "mw", "md", "eb", "ew", "ed", "ib", "iw", "id", "ab", "aw", "ad", "qb", "qw", "qd", "pew", "piw", "ped",
        "pid", "peb", "pib", "dbb", "dbw", "dbd", "db",
    ];
    AREAS.contains(&word)
}

/// Where a sequence of words stands, when it stands in one place alone.
fn only(all: &[String], wanted: &[String]) -> Option<usize> {
    if wanted.is_empty() {
        return None;
    }
    let mut found = all.windows(wanted.len()).enumerate().filter(|it| it.1 == wanted).map(|it| it.0);
    found.next().filter(|_| found.next().is_none())
}

fn is_negation(word: &str) -> bool {
    const NEGATIONS: &[&str] = &[
        "n", "ne", "non", "pas", "sinon", "sauf", "nicht", "kein", "keine", "sonst", "not", "no", "never", "unless",
        "else",
    ];
    NEGATIONS.contains(&word)
}

/// The relation that words between two operands state.
fn relation(between: &[String]) -> Option<Comparison> {
    let (mut order, mut is_equal) = (None, false);
    for word in between {
        let stated = match word.as_str() {
            ">" => Comparison::Gt,
            "<" => Comparison::Lt,
            ">=" | "=>" | "≥" => Comparison::Ge,
            "<=" | "=<" | "≤" => Comparison::Le,
            "supérieur" | "supérieure" | "superieur" | "superieure" | "grand" | "grande" | "dépasse" | "depasse"
            | "größer" | "grösser" | "groesser" | "höher" | "greater" | "bigger" | "larger" | "higher" | "exceeds" => {
                Comparison::Gt
            }
            "inférieur" | "inférieure" | "inferieur" | "inferieure" | "petit" | "petite" | "kleiner" | "niedriger"
            | "less" | "smaller" | "lower" => Comparison::Lt,
            "égal" | "égale" | "egal" | "egale" | "gleich" | "equal" | "equals" => {
                is_equal = true;
                continue;
            }
            it if is_filler(it) => continue,
            _ => return None,
        };
        if order.replace(stated).is_some() {
            return None;
        }
    }
    Some(match order? {
        Comparison::Gt if is_equal => Comparison::Ge,
        Comparison::Lt if is_equal => Comparison::Le,
        it => it,
    })
}

fn is_filler(word: &str) -> bool {
    const FILLERS: &[&str] = &[
        "est", "soit", "plus", "que", "qu", "à", "a", "au", "aux", "de", "du", "la", "le", "les", "l", "d", "celui",
        "celle", "contenu", "valeur", "mot", "ou", "ist", "wird", "als", "der", "die", "das", "dem", "den", "wert",
        "inhalt", "von", "oder", "is", "gets", "than", "the", "of", "to", "value", "content", "contents", "or", "that",
    ];
    FILLERS.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_words_in_three_languages() {
        let of = |comment: &str| stated(comment, "MW10", "MW20").map(Comparison::as_str);
        // S7:451.
        assert_eq!(of("M0.0 sera mis à « 1 » si le contenu de MW10 est plus grand que celui de MW20."), Some(">"));
        assert_eq!(of("// MW10 > MW20"), Some(">"));
        assert_eq!(of("// MW 20 > MW 10 ?"), Some("<"));
        assert_eq!(of("MW10<=MW20"), Some("<="));
        assert_eq!(of("si MW10 supérieur ou égal à MW20"), Some(">="));
        assert_eq!(of("MW10 ist kleiner als MW20"), Some("<"));
        assert_eq!(of("if mw20 is greater than mw10"), Some("<"));
        assert_eq!(of("MW10 größer oder gleich MW20"), Some(">="));
    }

    #[test]
    fn what_states_nothing() {
        let of = |comment: &str| stated(comment, "MW10", "5");
        assert_eq!(of("MW10 and 5 are compared: > sets M0.0"), None);
        assert_eq!(of("MW10 not > 5"), None);
        assert_eq!(of("MW10 n'est pas > 5"), None);
        assert_eq!(of("MW10 = 5"), None, "an order is wanted");
        assert_eq!(of("MW10 > 5 or MW10 < 5"), None);
        assert_eq!(of("MW10 > 55"), None);
        assert_eq!(of("MW100 > 5"), None);
        assert_eq!(of("step 5: MW10 > limit"), None);
        assert_eq!(of("5 < temperature, MW10"), None);
        assert_eq!(stated("MW10 > L#5", "MW10", "L#5"), Some(Comparison::Gt));
        assert_eq!(stated("Vitesse > « Seuil haut »", "\"Vitesse\"", "\"Seuil haut\""), Some(Comparison::Gt));
        assert_eq!(stated("#speed > -5", "#speed", "-5"), Some(Comparison::Gt));
    }
}

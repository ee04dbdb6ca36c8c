//! Citations of the source documents, spelt out.

/// `PL7:1463` as a reader finds it: the document's title and the line of its text. A citation of another form is
/// returned as it is.
pub fn citation(source: &str) -> String {
    let Some((document, lines)) = source.split_once(':') else { return source.to_owned() };
    let title = match document {
        "PL7" => "PL7 Micro/Junior/Pro reference manual, volume 1",
        "GRF" => "GRAFCET on controllers without a GRAFCET kernel",
        "PL72" => "PL7-2 language summary",
        "S7" => "Introduction to STEP 7",
        _ => return source.to_owned(),
    };
    let word = if lines.contains(['-', ',']) { "lines" } else { "line" };
    format!("{title}, {word} {lines}")
}

#[cfg(test)]
mod tests {
    use super::citation;

    #[test]
    fn documents_are_named() {
        assert_eq!(citation("PL7:3139"), "PL7 Micro/Junior/Pro reference manual, volume 1, line 3139");
        assert_eq!(citation("S7:301-310"), "Introduction to STEP 7, lines 301-310");
        assert_eq!(citation("IEC 61131-3"), "IEC 61131-3");
    }
}

//! The invariants of docs/architecture.md that types do not keep.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files below a folder of the crate, with their path relative to its root.
fn files(folder: &str, extension: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == extension) {
                let text = fs::read_to_string(&path).expect("source files are UTF-8");
                found.push((relative(&path), text));
            }
        }
    }
    found.sort();
    found
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string().replace('\\', "/")
}

/// Code of a file without its tests, comments and string literals' neighbours: lines that are not comments.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    text.lines().filter(|it| !it.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

fn assert_absent(folder: &str, words: &[&str], except: &[&str]) {
    let mut wrong = Vec::new();
    for (path, text) in files(folder, "rs") {
        if except.iter().any(|it| path.starts_with(it)) || path.ends_with("/tests.rs") || path.contains("/testing") {
            continue;
        }
        let code = code(&text);
        wrong.extend(words.iter().filter(|it| code.contains(**it)).map(|word| format!("{path}: `{word}`")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn syntax_knows_no_other_layer() {
    let words =
        ["salsa", "crate::lint", "crate::model", "crate::analysis", "crate::target", "crate::db", "crate::source"];
    assert_absent("src/syntax", &words, &[]);
}

#[test]
fn the_model_knows_no_rule_and_no_database() {
    assert_absent("src/model", &["salsa", "crate::lint", "crate::analysis", "crate::db", "crate::report"], &[]);
    assert_absent("src/target", &["salsa", "crate::lint", "crate::analysis", "crate::db"], &[]);
    assert_absent(
        "src/analysis",
        &["salsa", "crate::lint", "crate::db", "crate::report", "crate::syntax::awl", "crate::syntax::pl7"],
        &[],
    );
}

#[test]
fn only_the_database_knows_salsa() {
    assert_absent("src", &["salsa::"], &["src/db.rs"]);
    assert_absent("rules", &["salsa", "crate::db", "crate::report", "crate::cli", "crate::source"], &[]);
}

#[test]
fn only_the_server_knows_the_protocol() {
    assert_absent("src", &["lsp_types", "lsp_server"], &["src/server/"]);
    assert_absent("rules", &["lsp_types", "lsp_server", "crate::server"], &[]);
}

#[test]
fn only_reports_and_the_command_line_do_output() {
    let words = ["println!", "eprintln!", "print!(", "dbg!", "io::stdout", "io::stderr"];
    assert_absent("src", &words, &["src/report/", "src/cli/", "src/main.rs"]);
    assert_absent("rules", &words, &[]);
}

#[test]
fn only_walking_and_the_command_line_touch_files() {
    let words = ["std::fs", "fs::read", "fs::write", "File::open", "std::env", "std::net"];
    assert_absent("src", &words, &["src/source/walk.rs", "src/load/", "src/cli/", "src/main.rs"]);
    assert_absent("rules", &words, &[]);
}

#[test]
fn nothing_is_unsafe() {
    assert_absent("src", &["unsafe "], &[]);
    assert_absent("rules", &["unsafe "], &[]);
}

/// An empty sentence, a list that cannot be empty: such facts belong into types or into a `let else`.
#[test]
fn no_panic_by_hand() {
    let words = [".unwrap()", ".expect(", "panic!(", "todo!(", "unimplemented!("];
    // Constant evaluation panics at compile time.
    assert_absent("src", &words, &["src/syntax/awl/instruction.rs", "src/source/decode.rs", "src/syntax/pl7/word.rs"]);
    assert_absent("rules", &words, &[]);
}

#[test]
fn every_rule_has_its_page_and_every_page_its_rule() {
    let stems = |extension: &str| -> Vec<String> {
        files("rules", extension).into_iter().map(|it| it.0.trim_end_matches(extension).to_owned()).collect()
    };
    assert_eq!(stems("rs"), stems("md"));
}

/// A rule that grows wants an analysis that it can ask.
#[test]
fn rules_are_short() {
    let long: Vec<String> = files("rules", "rs")
        .into_iter()
        .filter(|(_, text)| code(text).lines().filter(|it| !it.trim().is_empty()).count() > 120)
        .map(|it| it.0)
        .collect();
    assert!(long.is_empty(), "{long:?}");
}

#[test]
fn text_is_clean() {
    let mut wrong = Vec::new();
    for folder in ["src", "rules", "tests", "benches", "docs"] {
        for extension in ["rs", "md", "toml"] {
            for (path, text) in files(folder, extension) {
                if text.lines().any(|it| it.trim_end() != it) {
                    wrong.push(format!("{path}: blanks at the end of a line"));
                }
                if !text.is_empty() && !text.ends_with('\n') {
                    wrong.push(format!("{path}: no line break at the end"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A rule names the manual, and the line exists in the form in which the catalogue cites.
#[test]
fn rules_cite_their_sources() {
    for rule in plclint::lint::rules() {
        assert!(!rule.sources.is_empty(), "{} cites nothing", rule.name);
        for source in rule.sources {
            let known = ["PL7:", "PL72:", "GRF:", "S7:"].iter().any(|it| source.starts_with(it));
            let lines = source.split_once(':').map(|it| it.1).unwrap_or_default();
            let numbers = lines.split('-').all(|it| it.parse::<u32>().is_ok());
            assert!(known && numbers || *source == "plclint", "{}: `{source}`", rule.name);
        }
    }
}

/// A row of `docs/coverage.md`: first and last line, and the rules.
fn coverage_rows(table: &str) -> Vec<(u32, u32, Vec<&str>)> {
    let rows = table.lines().filter_map(|it| it.strip_prefix("| ")).map(|it| it.split('|').map(str::trim));
    rows.filter_map(|mut cells| {
        let (first, last) = cells.nth(1)?.split_once('-')?;
        Some((first.parse().ok()?, last.parse().ok()?, cells.next()?.split_whitespace().collect()))
    })
    .collect()
}

/// The checklists of the manuals leave no line out, and name each rule where it cites them.
#[test]
fn the_checklists_of_the_manuals_are_complete() {
    let text = fs::read_to_string(root().join("docs/coverage.md")).expect("the page is there");
    let mut wrong = Vec::new();
    for (document, last) in [("PL7", 5952), ("PL72", 2019)] {
        let table = text.split("\n## ").find(|it| it.contains(&format!("(`{document}`)\n"))).expect("a section");
        let rows = coverage_rows(table);
        let mut next = 1;
        for (first, end, _) in &rows {
            if *first != next {
                wrong.push(format!("{document}: lines {next} to {first} are in no row"));
            }
            next = end + 1;
        }
        assert_eq!(next, last + 1, "{document}: the last row");
        for (first, end, codes) in &rows {
            let cites = |rule: &plclint::lint::Rule| {
                let lines = rule.sources.iter().filter_map(|it| it.split_once(':').filter(|it| it.0 == document));
                let mut starts = lines.filter_map(|it| it.1.split('-').next()?.parse::<u32>().ok());
                starts.any(|it| (*first..=*end).contains(&it))
            };
            let mut expected: Vec<&str> =
                plclint::lint::rules().iter().filter(|it| cites(it)).map(|it| it.code).collect();
            expected.sort_unstable();
            if *codes != expected {
                wrong.push(format!(
                    "{document}:{first}-{end}: `{}`, and it is `{}`",
                    codes.join(" "),
                    expected.join(" ")
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

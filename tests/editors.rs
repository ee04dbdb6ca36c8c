//! What the editors' files say of languages is what plclint says.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use serde_json::{Map, Value, json};

/// Set to write the files that are made from plclint's tables.
const UPDATE: &str = "PLCLINT_UPDATE";

fn path(relative: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(relative)
}

fn read(relative: &str) -> String {
    fs::read_to_string(path(relative)).unwrap_or_else(|error| panic!("{relative}: {error}"))
}

/// The words that the grammars of editors colour are those of the lexers.
#[test]
fn words_are_those_of_the_lexers() {
    let lists = plclint::syntax::words::lists();
    assert!(lists.iter().all(|it| it.words.len() >= 7), "{lists:?}");
    let lists: Map<String, Value> = lists.into_iter().map(|it| (it.name.to_owned(), json!(it.words))).collect();
    let expected = serde_json::to_string_pretty(&lists).unwrap() + "\n";
    let file = "editors/vscode/words.json";
    if std::env::var_os(UPDATE).is_some() {
        fs::write(path(file), &expected).unwrap();
    }
    assert!(read(file) == expected, "{file} is out of date: run `{UPDATE}=1 cargo test --test editors`");
}

/// Extensions that plclint considers and that editors leave to others: of symbol tables and plain text, whose names mean
/// other things as a rule, and of what is not read.
const OTHERS: [&str; 21] = [
    "txt", "sdf", "asc", "seq", "dif", "db", "udt", "ufb", "stx", "scl", "s5d", "xef", "zef", "xst", "xil", "xld",
    "xsf", "xbd", "xdb", "xdd", "xsy",
];

fn programs() -> BTreeSet<String> {
    let all = plclint::source::detect::extensions();
    all.filter(|it| !OTHERS.contains(it)).map(str::to_owned).collect()
}

/// The words in quotes between two pieces of a text.
fn quoted(text: &str, from: &str, to: &str, quote: char) -> BTreeSet<String> {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("{from}"));
    let (list, _) = rest.split_once(to).unwrap_or_else(|| panic!("{to}"));
    list.split(quote).skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn all_editors_know_the_extensions_of_programs() {
    let expected = programs();
    assert!(expected.contains("awl") && expected.contains("gr7"));
    assert_eq!(quoted(&read("editors/neovim/init.lua"), "local extensions = {", "}", '\''), expected, "Neovim");
    let both: BTreeSet<String> = expected.iter().flat_map(|it| [it.clone(), it.to_uppercase()]).collect();
    assert_eq!(quoted(&read("editors/helix/languages.toml"), "file-types = [", "]", '"'), both, "Helix");
    assert_eq!(
        quoted(&read("editors/emacs/plclint.el"), "defconst plclint-extensions\n  '(", ")", '"'),
        expected,
        "Emacs"
    );
    let package: Value = serde_json::from_str(&read("editors/vscode/package.json")).unwrap();
    let languages = package["contributes"]["languages"].as_array().unwrap();
    let extensions: Vec<String> = languages
        .iter()
        .flat_map(|it| it["extensions"].as_array().unwrap())
        .map(|it| it.as_str().unwrap().trim_start_matches('.').to_owned())
        .collect();
    let distinct: BTreeSet<String> = extensions.iter().cloned().collect();
    assert_eq!(extensions.len(), distinct.len(), "each belongs to one language");
    assert_eq!(distinct, expected, "VS Code");
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
}

/// A lock file that names the place of each download would tie the project to one registry.
#[test]
fn lock_files_name_no_registry() {
    let lock: Value = serde_json::from_str(&read("editors/vscode/package-lock.json")).unwrap();
    let packages = lock["packages"].as_object().unwrap();
    assert!(packages.len() > 100);
    for (name, package) in packages {
        assert!(package.get("resolved").is_none(), "{name}: install with `--omit-lockfile-registry-resolved`");
        assert!(name.is_empty() || package.get("integrity").is_some(), "{name}: what is installed cannot be verified");
    }
}

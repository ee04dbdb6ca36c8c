//! Writes the registry of rules from the folder `rules/`: a rule is one `.rs` and one `.md`, nothing else.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=rules");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo")).join("rules");
    let mut pages = Vec::new();
    for group in sorted(&root) {
        println!("cargo::rerun-if-changed={}", group.display());
        for file in sorted(&group) {
            if file.extension().is_some_and(|it| it == "md") {
                pages.push(Page::read(&file));
            }
        }
    }
    pages.sort_by(|a, b| a.get("code").cmp(b.get("code")));
    let mut out = String::new();
    for page in &pages {
        let module = page.get("name").replace('-', "_");
        let source = page.path.with_extension("rs");
        assert!(source.exists(), "{} has no rule file beside it", page.path.display());
        writeln!(out, "#[path = {:?}]\nmod {module};", source.display().to_string()).expect("a string");
    }
    writeln!(out, "pub(super) static RULES: &[super::Rule] = &[").expect("a string");
    for page in &pages {
        page.entry(&mut out);
    }
    writeln!(out, "];").expect("a string");
    let target = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo")).join("rules.rs");
    fs::write(target, out).expect("the output folder is writable");
}

fn sorted(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.filter_map(|it| it.ok().map(|it| it.path())).collect();
    paths.sort();
    paths
}

struct Page {
    path: PathBuf,
    keys: Vec<(String, String)>,
    body: String,
}

impl Page {
    fn read(path: &Path) -> Self {
        println!("cargo::rerun-if-changed={}", path.display());
        let text = fs::read_to_string(path).expect("a rule page is UTF-8");
        let rest = text.strip_prefix("---\n").unwrap_or_else(|| panic!("{} has no front matter", path.display()));
        let (front, body) = rest.split_once("\n---\n").unwrap_or_else(|| panic!("{}: front matter", path.display()));
        let keys = front
            .lines()
            .map(|line| {
                let (key, value) = line.split_once(':').unwrap_or_else(|| panic!("{}: {line}", path.display()));
                (key.trim().to_owned(), value.trim().to_owned())
            })
            .collect();
        Self { path: path.to_owned(), keys, body: body.trim_start().to_owned() }
    }

    fn get(&self, key: &str) -> &str {
        match self.keys.iter().find(|it| it.0 == key) {
            Some((_, value)) => value,
            None => panic!("{}: no `{key}:` in the front matter", self.path.display()),
        }
    }

    /// A key that may be missing: `yes`, or not at all.
    fn flag(&self, key: &str) -> bool {
        match self.keys.iter().find(|it| it.0 == key).map(|it| it.1.as_str()) {
            None => false,
            Some("yes") => true,
            Some(other) => panic!("{}: {key} {other}", self.path.display()),
        }
    }

    fn list(&self, key: &str) -> Vec<&str> {
        self.get(key).split(',').map(str::trim).filter(|it| !it.is_empty()).collect()
    }

    fn entry(&self, out: &mut String) {
        let name = self.get("name");
        let module = name.replace('-', "_");
        let group = self.path.parent().and_then(Path::file_name).and_then(|it| it.to_str()).expect("a group folder");
        assert_eq!(self.path.file_stem().and_then(|it| it.to_str()), Some(name), "a page is named after its rule");
        let severity = match self.get("severity") {
            "error" => "Error",
            "warning" => "Warning",
            "advice" => "Advice",
            other => panic!("{}: severity {other}", self.path.display()),
        };
        let default = match self.get("default") {
            "on" => true,
            "off" => false,
            other => panic!("{}: default {other}", self.path.display()),
        };
        let scope = match self.get("scope") {
            "unit" => "Unit",
            "object" => "Object",
            "program" => "Program",
            "file" => "File",
            other => panic!("{}: scope {other}", self.path.display()),
        };
        writeln!(
            out,
            "    super::Rule {{ code: {:?}, name: {name:?}, group: {group:?}, summary: {:?}, severity: \
             super::Severity::{severity}, default: {default}, by_controller: {}, dialects: &{:?}, sources: &{:?}, page: \
             {:?}, check: super::Check::{scope}({module}::check) }},",
            self.get("code"),
            self.get("summary"),
            self.flag("controller"),
            self.list("dialects"),
            self.list("sources"),
            self.body,
        )
        .expect("a string");
    }
}

//! The corpus: every finding in it was judged by hand, and a snapshot of each folder keeps it so.
//!
//! A folder of `corpus/` that holds programs is checked by itself, as a user would: once with the rules that are on
//! from the start, once with all of them, and with its `plclint.toml` where it has one. `corpus/README.md` says where the programs are from.

use std::fs;
use std::path::{Path, PathBuf};

use plclint::db::{self, Input};
use plclint::lint::settings::{self, Folders, Overrides, Settings};
use plclint::lint::{Diagnostic, Location, Outcome};
use plclint::report::{self, Format, Options};
use plclint::source::detect::{self, Dialect, FileHint};

/// Programs without a defect, full of what comes close to one.
const CLEAN: [&str; 5] =
    ["charts/barriere", "charts/embouteillage", "charts/perceuse", "programs/four-tunnel", "programs/station-pompage"];

/// Listings of the manual that neither name nor content shows to be PL7 for certain: a sentence on one line, code of a
/// DFB that names no object, an expression alone. They are read when the user says what they are.
const UNRECOGNISED: [&str; 2] = ["documents/pl7-manual/dfb-boucles.st", "documents/pl7-manual/dfb-compteur.st"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")
}

/// Folders that hold files, and those files, each sorted.
fn folders() -> Vec<(String, Vec<PathBuf>)> {
    let mut found = Vec::new();
    let mut open = vec![root()];
    while let Some(folder) = open.pop() {
        let mut files = Vec::new();
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_none_or(|it| it != "md" && it != "toml") {
                files.push(path);
            }
        }
        if !files.is_empty() {
            files.sort();
            found.push((relative(&folder), files));
        }
    }
    found.sort();
    found
}

fn relative(path: &Path) -> String {
    let path = path.strip_prefix(root()).expect("a path of the corpus");
    path.iter().map(|it| it.to_str().expect("UTF-8")).collect::<Vec<_>>().join("/")
}

fn load(path: &Path, dialect: Dialect) -> Input {
    let hint = FileHint { path: Some(path), explicit: false, dialect, family: None };
    let (source, detected) = detect::load(hint, &fs::read(path).expect("a file"), None);
    Input { path: relative(path), source, detected }
}

fn check(files: &[PathBuf], select: Option<&str>) -> Outcome {
    let overrides = Overrides { select: select.map(|it| vec![it.to_owned()]), ..Overrides::default() };
    let folder = files.first().and_then(|it| it.parent()).expect("a file in a folder");
    let file = folder.join(settings::FILE_NAME);
    let text = if file.exists() { fs::read_to_string(&file).expect("UTF-8") } else { String::new() };
    let folders = Folders { root: folder.to_owned(), current: root() };
    let settings = Settings::parse(&text, &file, folders, overrides).expect("a configuration");
    let inputs = files.iter().map(|path| {
        let known = !UNRECOGNISED.contains(&relative(path).as_str());
        load(path, if known { Dialect::Auto } else { Dialect::Pl7St })
    });
    db::check(inputs.collect(), settings)
}

fn findings(outcome: &Outcome) -> String {
    let mut out = Vec::new();
    report::write(Format::Concise, outcome, &Options::default(), &mut out).expect("memory");
    String::from_utf8(out).expect("UTF-8")
}

/// The findings that only the larger selection has.
fn added(larger: &str, smaller: &str) -> String {
    larger.lines().filter(|line| !smaller.lines().any(|it| it == *line)).map(|line| format!("{line}\n")).collect()
}

#[test]
fn findings_are_those_that_were_judged() {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("corpus");
    let _bound = settings.bind_to_scope();
    for (folder, files) in folders() {
        let default = check(&files, None);
        let all = check(&files, Some("all"));
        for outcome in [&default, &all] {
            assert_eq!(outcome.internal_errors, [""; 0], "{folder}");
        }
        let default = findings(&default);
        let all = added(&findings(&all), &default);
        let text = if all.is_empty() { default } else { format!("{default}\nwith all rules:\n{all}") };
        insta::assert_snapshot!(folder.replace('/', "."), text);
    }
}

#[test]
fn every_file_is_read() {
    let files = folders().into_iter().flat_map(|it| it.1);
    let left = files.filter(|path| db::family(load(path, Dialect::Auto).detected).is_none());
    let left: Vec<String> = left.map(|path| relative(&path)).collect();
    assert_eq!(left, UNRECOGNISED);
    for (folder, files) in folders() {
        assert!(check(&files, None).unread.is_empty(), "{folder}");
    }
}

#[test]
fn clean_programs_have_no_finding() {
    let folders = folders();
    for name in CLEAN {
        let (_, files) = folders.iter().find(|it| it.0 == name).expect("a folder of the corpus");
        for select in [None, Some("all")] {
            assert_eq!(findings(&check(files, select)), "", "{name}");
        }
    }
}

/// The same program in both mnemonic sets, with its symbols in two forms.
#[test]
fn both_mnemonic_sets_have_the_same_findings() {
    let folders = folders();
    let found = |name: &str| {
        let (_, files) = folders.iter().find(|it| it.0 == name).expect("a folder of the corpus");
        let outcome = check(files, Some("all"));
        let place = |it: &Diagnostic| (it.finding.rule.code, at_line(&outcome, it.finding.place));
        let mut found: Vec<_> = outcome.diagnostics.iter().map(place).collect();
        found.sort_unstable();
        found
    };
    let german = found("programs/convoyeur-s7");
    assert!(german.len() > 5);
    assert_eq!(german, found("programs/convoyeur-s7-en"));
}

/// Whether a place is in code, and its line.
fn at_line(outcome: &Outcome, at: Location) -> (bool, usize) {
    let file = &outcome.files[at.file as usize];
    let line = file.text[..usize::from(at.range.start())].matches('\n').count();
    (file.path.ends_with(".awl"), line)
}

/// What a finding says, and the text of the lines that it points at with the column: the same however the program was
/// exported.
fn said(outcome: &Outcome) -> Vec<String> {
    let place = |at: Location| {
        let text = &outcome.files[at.file as usize].text;
        let (start, end) = (usize::from(at.range.start()), usize::from(at.range.end()));
        let from = text[..start].rfind('\n').map_or(0, |it| it + 1);
        let to = text[end..].find('\n').map_or(text.len(), |it| end + it);
        format!("{}: {}", start - from, text[from..to].replace("\r\n", "\n").trim_end())
    };
    let all = outcome.diagnostics.iter().map(|it| {
        let (entity, it) = (&it.entity, &it.finding);
        let related: Vec<String> = it.related.iter().map(|it| format!("{} {}", place(it.place), it.message)).collect();
        let (code, severity, here) = (it.rule.code, it.severity, place(it.place));
        format!("{entity} {code} {severity:?} {} {:?} {here} {related:?} {:?}", it.message, it.label, it.notes)
    });
    let mut all: Vec<String> = all.collect();
    all.sort();
    all
}

#[test]
fn an_application_file_has_the_findings_of_its_sections() {
    let folders = folders();
    let files = |name: &str| &folders.iter().find(|it| it.0 == name).expect("a folder of the corpus").1;
    let (sections, application) = (files("programs/traitement-surface"), files("programs/traitement-surface-fef"));
    assert!(sections.len() > 20 && application.len() == 1);
    for select in [None, Some("all")] {
        let (sections, application) = (check(sections, select), check(application, select));
        assert!(said(&sections).len() > 15);
        assert_eq!(said(&sections), said(&application), "{select:?}");
        // What the vendor keeps for himself is counted, and nothing else.
        assert!(sections.files.iter().all(|it| it.not_understood == 0));
        let text = &application.files[0].text;
        let vendor = text.split("[VENDOR]").nth(1).and_then(|it| it.split("[SOURCE_UNIT]").next()).expect("the block");
        let missed = application.files[0].not_understood;
        assert!(missed > vendor.len() / 2 && missed <= vendor.len(), "{missed} of {}", vendor.len());
        assert_eq!(application.files[0].encoding, "windows-1252");
    }
}

/// Correct charts, and one with each defect.
#[test]
fn every_rule_about_charts_finds_something() {
    let outcomes = folders().into_iter().filter(|it| it.0.starts_with("charts/")).map(|it| check(&it.1, Some("all")));
    let found: std::collections::BTreeSet<&str> =
        outcomes.flat_map(|it| it.diagnostics.into_iter().map(|it| it.finding.rule.code)).collect();
    let all = plclint::lint::rules().iter().filter(|it| it.code.starts_with('G'));
    let silent: Vec<&str> = all.map(|it| it.code).filter(|it| !found.contains(it)).collect();
    assert_eq!(silent, [""; 0]);
}

/// The corpus would prove nothing if a rule could fall silent on all of it.
#[test]
fn a_fault_of_a_document_is_found() {
    let folders = folders();
    let (_, files) = folders.iter().find(|it| it.0 == "documents/step7-course/chenillard-fc1").expect("a folder");
    assert!(findings(&check(files, None)).contains("R001"));
}

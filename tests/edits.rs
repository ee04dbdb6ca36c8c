//! What is found after an edit is what a fresh run finds, though only the objects that the edit touches are judged anew.

#[path = "common/numbers.rs"]
mod numbers;

use std::path::{Path, PathBuf};

use plclint::db::{self, FileFinding, RootDatabase, SourceFile};
use plclint::lint::settings::{FILE_NAME, Folders, Overrides, Settings};
use plclint::load;
use plclint::source::detect::Dialect;

use numbers::Numbers;

fn settings(folder: &Path) -> Settings {
    let text = std::fs::read_to_string(folder.join(FILE_NAME)).unwrap_or_default();
    Settings::parse(&text, Path::new(FILE_NAME), Folders::default(), Overrides::default()).unwrap()
}

fn open(inputs: Vec<db::Input>, settings: Settings) -> (RootDatabase, Vec<SourceFile>) {
    let mut db = RootDatabase::new(settings, None);
    let files = db.set_files(inputs);
    (db, files)
}

/// All findings with all their places.
fn found(db: &RootDatabase, files: &[SourceFile]) -> Vec<String> {
    let place = |it: &db::FilePlace| format!("{}:{:?}", it.file.path(db), it.range);
    let line = |it: &FileFinding| {
        let FileFinding { finding, suppressed, .. } = it;
        let related: Vec<String> =
            finding.related.iter().map(|it| format!("{} {}", place(&it.place), it.message)).collect();
        format!(
            "{} {} {:?} {} {related:?} {:?} {suppressed:?}",
            place(&finding.place),
            finding.rule.code,
            finding.severity,
            finding.message,
            finding.notes
        )
    };
    let all = files.iter().flat_map(|&file| db::file_findings(db, file)).map(line);
    all.chain(db::configuration_findings(db).iter().map(line)).collect()
}

/// One edit as people make them: mostly such that the text goes on to mean something. `units`: where they start.
fn edited(text: &str, units: &[usize], numbers: &mut Numbers) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let line = numbers.below(lines.len());
    if lines.is_empty() {
        return text.to_owned();
    }
    match numbers.below(9) {
        // Another number: most are addresses.
        0..=2 => {
            let digits: Vec<usize> =
                text.bytes().enumerate().filter(|it| it.1.is_ascii_digit()).map(|it| it.0).collect();
            let Some(&at) = digits.get(numbers.below(digits.len())) else { return text.to_owned() };
            format!("{}{}{}", &text[..at], numbers.below(10), &text[at + 1..])
        }
        3 => lines.iter().enumerate().filter(|it| it.0 != line).map(|it| *it.1).collect(),
        4 => {
            let mut lines = lines;
            let copied = lines[line];
            lines.insert(numbers.below(lines.len() + 1), copied);
            lines.concat()
        }
        // A character that mostly breaks a statement, or the heading of a unit.
        kind @ 5..=6 => {
            let unit = if kind == 6 { units.get(numbers.below(units.len())).copied() } else { None };
            let first = unit.unwrap_or_default();
            let length = if unit.is_some() { 16 } else { usize::MAX };
            let places: Vec<usize> = text[first..].char_indices().map(|it| first + it.0).take(length).collect();
            let at = places.get(numbers.below(places.len())).copied().unwrap_or_default();
            let character = ["(", ";", "N", "=", " "][numbers.below(5)];
            format!("{}{character}{}", &text[..at], &text[at..])
        }
        // A unit goes.
        7 => {
            let at = numbers.below(units.len());
            let end = units.get(at + 1).copied().unwrap_or(text.len());
            units.get(at).map_or_else(|| text.to_owned(), |start| format!("{}{}", &text[..*start], &text[end..]))
        }
        _ => {
            let mut lines = lines;
            if line > 0 {
                lines.swap(line - 1, line);
            }
            lines.concat()
        }
    }
}

fn edit_at_random(folder: &Path, seed: u64, edits: usize) {
    let settings = settings(folder);
    let inputs = load::read(&[folder.to_owned()], &settings, Dialect::Auto).inputs;
    let (mut db, files) = open(inputs.clone(), settings.clone());
    let mut texts: Vec<String> = inputs.iter().map(|it| it.source.text.to_string()).collect();
    let mut numbers = Numbers(seed);
    let mut undo: Vec<(usize, String)> = Vec::new();
    found(&db, &files);
    for n in 0..edits {
        let at = numbers.below(texts.len());
        let (at, text) = match undo.pop() {
            // Most edits are taken back, so that the program stays one.
            Some(it) if numbers.below(5) > 1 => it,
            other => {
                undo.extend(other);
                undo.push((at, texts[at].clone()));
                let units: Vec<usize> = db::layout(&db, files[at]).iter().map(|it| it.1 as usize).collect();
                (at, edited(&texts[at], &units, &mut numbers))
            }
        };
        db.set_text(files[at], text.as_str());
        texts[at] = text;
        let mut fresh = inputs.clone();
        for (input, text) in fresh.iter_mut().zip(&texts) {
            input.source.text = text.as_str().into();
        }
        let (fresh, of_fresh) = open(fresh, settings.clone());
        assert_eq!(found(&db, &files), found(&fresh, &of_fresh), "{} after {n} edits", folder.display());
    }
}

/// A step that the program sets bears on every object whose conditions ask for steps of its chart.
#[test]
fn what_moves_steps_is_felt_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    of(
        "chart.txt",
        "GR7 : MAST - Cycle - CHART\nINITIAL_STEP X0 : END_STEP\nSTEP X1 : END_STEP\nTRANSITION FROM X0 TO X1 := %I1.0; \
         END_TRANSITION\nTRANSITION FROM X1 TO X0 := %I1.1; END_TRANSITION\n",
    );
    of(
        "post.txt",
        "ST : MAST - Cycle - POST\n! IF %X0 THEN %Q2.0 := %I1.4; END_IF;\n! IF %X1 THEN %Q2.0 := %I1.5; END_IF;\n",
    );
    of("prl.txt", "ST : MAST - Cycle - PRL\n! IF %M0 THEN SET %M1; END_IF;\n");
    let settings = settings(folder.path());
    let inputs = load::read(&[folder.path().to_owned()], &settings, Dialect::Auto).inputs;
    let (mut db, files) = open(inputs.clone(), settings);
    let preliminary = inputs.iter().position(|it| it.source.text.contains("SET %M1")).unwrap();
    let mut moved = |step: &str| {
        let text = format!("ST : MAST - Cycle - PRL\n! IF %M0 THEN {step}; END_IF;\n");
        db.set_text(files[preliminary], text.as_str());
        found(&db, &files).iter().any(|it| it.contains(" W001 ") && it.contains("%Q2.0"))
    };
    assert!(!moved("SET %M1"));
    assert!(moved("SET %X1"));
    assert!(!moved("SET %M2"));
    assert!(!moved("RESET %X1"));
    assert!(moved("SET %X1"));
}

/// What is missing is missing in a whole program alone, and a statement that is not understood leaves none whole.
#[test]
fn a_mistake_elsewhere_hides_what_is_missing() {
    let block = |number: u32, code: &str| format!("FUNCTION FC {number} : VOID\nBEGIN\n{code}\nEND_FUNCTION\n");
    let main = "ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FC 1;\nCALL FC 2;\nEND_ORGANIZATION_BLOCK\n";
    let uses = block(1, "U M 1.0;\n= A 0.0;\nU E 0.0;\nS M 2.0;\nU M 2.0;\n= A 0.1;\nU T 5;\n= A 0.2;");
    let text = |code: &str| format!("{main}{uses}{}", block(2, code));
    let whole = Settings::default();
    let input = |text: &str| db::Input::from_text("p/a.awl", text, Dialect::Step7);
    let (mut db, files) = open(vec![input(&text("U E 1.0;\n= A 1.0;"))], whole.clone());
    let missing = |found: &[String]| -> Vec<&str> {
        ["O007", "W003", "C005"].into_iter().filter(|code| found.iter().any(|it| it.contains(code))).collect()
    };
    let all = vec!["O007", "W003", "C005"];
    let (right, wrong) = ("U E 1.0;\n= A 1.0;", "U E 1.0;\n= A (1.0;");
    let texts = [(right, &all), (wrong, &vec![]), ("U E 1.1;\n= A 1.0;", &all), (wrong, &vec![]), (right, &all)];
    for (code, expected) in texts {
        let text = text(code);
        db.set_text(files[0], text.as_str());
        let found = found(&db, &files);
        assert_eq!(missing(&found), *expected, "{code}");
        let (fresh, of_fresh) = open(vec![input(&text)], whole.clone());
        assert_eq!(found, self::found(&fresh, &of_fresh), "{code}");
    }
}

fn corpus(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(folder);
    let mut folders: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|it| it.unwrap().path()).collect();
    folders.sort();
    folders.retain(|it| it.is_dir());
    folders
}

fn edits() -> usize {
    std::env::var("PLCLINT_EDITS").ok().and_then(|it| it.parse().ok()).unwrap_or(24)
}

#[test]
fn programs_may_be_edited() {
    for (seed, folder) in (1..).zip(corpus("programs")) {
        edit_at_random(&folder, seed * 0x9e37_79b9, edits());
    }
}

#[test]
fn charts_may_be_edited() {
    for (seed, folder) in (1..).zip(corpus("charts")) {
        edit_at_random(&folder, seed * 0x2545_f491, edits() / 3);
    }
}

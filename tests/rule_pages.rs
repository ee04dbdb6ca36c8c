//! Rule pages as tests: their examples are executed, their sections are complete.

use std::fmt::Write as _;
use std::path::Path;

use plclint::db::{self, Input};
use plclint::lint::settings::{Folders, Overrides, Settings};
use plclint::lint::{Rule, rules};
use plclint::model::entity::Family;
use plclint::source::detect::Dialect;

const SECTIONS: [&str; 6] = ["What it does", "Why", "What to do instead", "Limits", "Sources", "Examples"];

struct Example {
    line: usize,
    dialect: Dialect,
    bad: bool,
    /// ```` ```awl,bad,CPU 314 ````: checked for that controller.
    controller: Option<String>,
    /// ```` ```toml,example ```` before it: the `plclint.toml` that it is checked with.
    config: String,
    text: String,
}

fn examples(rule: &Rule) -> Vec<Example> {
    let mut examples = Vec::new();
    let mut open: Option<Example> = None;
    let mut skip = false;
    let mut config: Option<String> = None;
    let mut next_config = String::new();
    for (line, text) in rule.page.lines().enumerate() {
        if let Some(example) = &mut open {
            if text.trim_end() == "```" {
                examples.extend(open.take());
            } else {
                writeln!(example.text, "{text}").expect("a string");
            }
        } else if let Some(open) = &mut config {
            if text.trim_end() == "```" {
                next_config = config.take().unwrap_or_default();
            } else {
                writeln!(open, "{text}").expect("a string");
            }
        } else if skip {
            skip = text.trim_end() != "```";
        } else if let Some(info) = text.strip_prefix("```") {
            let (language, verdict) = info.split_once(',').unwrap_or((info, ""));
            if info == "toml,example" {
                config = Some(String::new());
                continue;
            }
            if language == "toml" {
                // A setting, not a program: its lines hold no fence.
                skip = true;
                continue;
            }
            let (verdict, controller) = match verdict.split_once(',') {
                Some((verdict, controller)) => (verdict, Some(controller.to_owned())),
                None => (verdict, None),
            };
            let dialect = match language {
                "awl" => Dialect::Step7,
                "s5" => Dialect::Step5,
                "il" => Dialect::Pl7Il,
                "st" => Dialect::Pl7St,
                "ld" => Dialect::Pl7Ld,
                "pl7" | "dfb" => Dialect::Pl7,
                "gr7" => Dialect::Pl7Gr7,
                "sfc" => Dialect::Sfc,
                "pl72" => Dialect::Pl72,
                other => panic!("{}: line {}: language `{other}`", rule.name, line + 1),
            };
            assert!(matches!(verdict, "bad" | "good"), "{}: line {}: `{info}`", rule.name, line + 1);
            let config = std::mem::take(&mut next_config);
            open = Some(Example {
                line: line + 1,
                dialect,
                bad: verdict == "bad",
                controller,
                config,
                text: String::new(),
            });
        }
    }
    assert!(open.is_none(), "{}: an example is not closed", rule.name);
    examples
}

fn found(example: &Example) -> Vec<(&'static str, String)> {
    let controller = example.controller.clone();
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), controller, ..Overrides::default() };
    let name = Path::new("plclint.toml");
    let settings = Settings::parse(&example.config, name, Folders::default(), overrides).expect("settings");
    let extension = if example.dialect == Dialect::Step7 { "awl" } else { "txt" };
    let input = Input::from_text(&format!("example.{extension}"), &example.text, example.dialect);
    let outcome = db::check(vec![input], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    let open = outcome.diagnostics.into_iter().filter(|it| it.suppressed.is_none());
    open.map(|it| (it.finding.rule.code, it.finding.message)).collect()
}

#[test]
fn examples_do_what_the_pages_say() {
    let mut wrong = String::new();
    for rule in rules() {
        for example in examples(rule) {
            let found = found(&example);
            let fires = found.iter().any(|it| it.0 == rule.code);
            if fires != example.bad {
                let verdict = if example.bad { "bad, but silent" } else { "good, but reported" };
                writeln!(wrong, "{} line {}: {verdict}: {found:?}\n{}", rule.name, example.line, example.text)
                    .expect("a string");
            }
            // An example that cannot be read shows nothing.
            if rule.code != "X001" && found.iter().any(|it| it.0 == "X001") {
                writeln!(wrong, "{} line {}: not read: {found:?}\n{}", rule.name, example.line, example.text)
                    .expect("a string");
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// Each rule has a bad example in every dialect it is for, and a near miss.
#[test]
fn every_dialect_has_its_examples() {
    let mut missing = String::new();
    for rule in rules() {
        let examples = examples(rule);
        for dialect in rule.dialects {
            let wanted: &[Dialect] = match *dialect {
                "all" => &[Dialect::Step7, Dialect::Step5, Dialect::Pl7Il, Dialect::Pl7St, Dialect::Pl72],
                "pl7" => &[Dialect::Pl7Il, Dialect::Pl7St],
                "s7" => &[Dialect::Step7],
                "il" => &[Dialect::Pl7Il],
                "st" => &[Dialect::Pl7St],
                "ld" => &[Dialect::Pl7Ld],
                "g7" => &[Dialect::Pl7Gr7],
                "dfb" => &[Dialect::Pl7],
                "pl72" => &[Dialect::Pl72],
                "s5" => &[Dialect::Step5],
                other => panic!("{}: dialect `{other}`", rule.name),
            };
            for &wanted in wanted {
                let any = examples.iter().any(|it| it.bad && (it.dialect == wanted || it.dialect == Dialect::Pl7));
                // What X003 is about is no language; what L009 is about fills pages, and of PL7 what M003 is about.
                let fills_pages = rule.code == "L009" || rule.code == "M003" && *dialect == "pl7";
                // STEP 5 has no operand that a program cannot write.
                let is_writable = rule.code == "W004" && wanted == Dialect::Step5;
                if !any && rule.code != "X003" && !fills_pages && !is_writable {
                    writeln!(missing, "{} has no bad example for {wanted:?}", rule.name).expect("a string");
                }
            }
        }
        if !examples.iter().any(|it| !it.bad) {
            writeln!(missing, "{} has no good example", rule.name).expect("a string");
        }
    }
    assert!(missing.is_empty(), "\n{missing}");
}

/// A TSX 37-05 holds 2048 instructions of a list, 1638 elements of ladder or 1331 statements of text (PL7:1535-1538).
#[test]
fn programs_that_fill_the_memory() {
    let has = |dialect: Dialect, text: String| {
        let controller = Some("TSX 37-05".to_owned());
        let example = Example { line: 0, dialect, bad: true, controller, config: String::new(), text };
        found(&example).iter().any(|it| it.0 == "M003")
    };
    let list = |sentences: usize| "!    LD   %I1.0\n     ST   %Q2.0\n".repeat(sentences);
    assert!(!has(Dialect::Pl7Il, list(1024)) && has(Dialect::Pl7Il, list(1026)));
    let text = |statements: usize| "! %MW4 := %MW5;\n".repeat(statements);
    assert!(!has(Dialect::Pl7St, text(1331)) && has(Dialect::Pl7St, text(1333)));
    let ladder = |rungs: usize| "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n".repeat(rungs);
    assert!(!has(Dialect::Pl7Ld, ladder(819)) && has(Dialect::Pl7Ld, ladder(821)));
}

#[test]
fn pages_have_their_sections() {
    for rule in rules() {
        let headings: Vec<&str> = rule.page.lines().filter_map(|it| it.strip_prefix("## ")).collect();
        for section in SECTIONS {
            assert!(headings.contains(&section), "{}: no section `{section}`", rule.name);
        }
        assert!(rule.page.starts_with(&format!("# {} ({})\n", rule.name, rule.code)), "{}: title", rule.name);
        assert!(!rule.help().is_empty() && !rule.why().is_empty(), "{}: empty section", rule.name);
        let families: Vec<&str> = [Family::Pl7, Family::Pl72, Family::Step7]
            .into_iter()
            .filter(|it| rule.is_for_family(*it))
            .map(Family::as_str)
            .collect();
        let parts = rule.page.lines().filter_map(|it| it.strip_prefix("### "));
        for family in parts.flat_map(|it| it.split(',')).map(str::trim) {
            assert!(families.contains(&family), "{}: `### {family}` is no family that the rule is for", rule.name);
        }
        assert!(rule.summary.ends_with('.'), "{}: the summary is a sentence", rule.name);
        assert!(rule.name.chars().all(|it| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '-'));
    }
}

#[test]
fn codes_and_names_are_unique() {
    let mut codes: Vec<&str> = rules().iter().flat_map(|it| [it.code, it.name]).collect();
    codes.sort_unstable();
    let before = codes.len();
    codes.dedup();
    assert_eq!(codes.len(), before);
}

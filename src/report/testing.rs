//! Outcomes for tests of reports.

use std::sync::Arc;
use std::time::Duration;

use rowan::{TextRange, TextSize};

use crate::lint::testing::RULES;
use crate::lint::{
    Applicability, Diagnostic, Edit, Finding, Fix, Location, Outcome, Related, Rule, Severity, SourceView, Unread,
    UnreadReason,
};
use crate::model::entity::Family;

pub(crate) fn empty() -> Outcome {
    Outcome::default()
}

pub(crate) fn rule(code: &str) -> &'static Rule {
    RULES.iter().find(|it| it.code == code).unwrap()
}

pub(crate) fn view(path: &str, text: &str, encoding: &'static str) -> SourceView {
    SourceView {
        path: path.into(),
        text: Arc::from(text),
        encoding,
        dialect: "STEP 7 AWL (German mnemonics)".into(),
        entities: 2,
        not_understood: 0,
        made_of: None,
        is_variant: false,
        is_configuration: false,
    }
}

/// The `nth` occurrence of a word in a file.
pub(crate) fn place(files: &[SourceView], file: u32, word: &str, nth: usize) -> Location {
    let (start, _) = files[file as usize].text.match_indices(word).nth(nth).unwrap();
    let start = TextSize::new(start as u32);
    Location { file, range: TextRange::at(start, TextSize::of(word)) }
}

pub(crate) fn diagnostic(finding: Finding<Location>) -> Diagnostic {
    Diagnostic { finding, entity: "FC1".into(), family: Some(Family::Step7), suppressed: None }
}

/// Two files with umlauts, findings of every severity, a fix, a suppression and files left out.
pub(crate) fn sample() -> Outcome {
    let a = "FUNCTION FC 1 : VOID\r\nU E 0.0; // Größe\r\n= \u{ab}Ventil\u{bb};\r\nSPA M999;\r\nEND_FUNCTION\r\n";
    let b = "// Übergabe\nFUNCTION FC 2 : VOID\n= \u{ab}Ventil\u{bb};\nX0: ) U E 0.1;\nEND_FUNCTION\n";
    let files = vec![view("line1/a b.awl", a, "windows-1252"), view("line1/b.awl", b, "utf-8")];
    let mut write = Finding::new(
        rule("W001"),
        place(&files, 0, "\u{ab}Ventil\u{bb}", 0),
        "\u{ab}Ventil\u{bb} (A 4.0) is driven in 2 places",
    );
    write.label = Some("overrides the first".into());
    write
        .related
        .push(Related { place: place(&files, 1, "\u{ab}Ventil\u{bb}", 0), message: "also driven here".into() });
    write.notes.push("FC1 and FC2 are taken to run in the same cycle".into());
    let jump = Finding::new(rule("J001"), place(&files, 0, "M999", 0), "label M999 is defined twice");
    let mut parenthesis = Finding::new(rule("I004"), place(&files, 1, ")", 0), "`)` closes nothing");
    parenthesis.fixes.push(Fix {
        title: "Remove `)`".into(),
        applicability: Applicability::Unsafe,
        edits: vec![Edit { place: place(&files, 1, ") ", 0), replacement: String::new() }],
    });
    let mut unused = Finding::new(rule("J005"), place(&files, 1, "X0", 0), "no jump targets X0");
    unused.severity = Severity::Advice;
    let mut unused = diagnostic(unused);
    unused.suppressed = Some("entry for the test bench".into());
    let mut again = unused.clone();
    again.suppressed = None;
    Outcome {
        diagnostics: vec![diagnostic(write), diagnostic(jump), unused, again, diagnostic(parenthesis)],
        files,
        unread: vec![
            Unread { path: "line1/a.ld".into(), reason: UnreadReason::Unsupported("PL7 ladder (.LD)".into()) },
            Unread { path: "line1/c.awl".into(), reason: UnreadReason::Io("permission denied".into()) },
            Unread { path: "line1/d.png".into(), reason: UnreadReason::NotPlc },
        ],
        active: RULES.iter().collect(),
        untargeted: Vec::new(),
        internal_errors: Vec::new(),
        elapsed: Duration::from_millis(1234),
    }
}

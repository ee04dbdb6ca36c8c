//! Fixes, carried out: what they leave is read without an error, and the finding is gone.

use plclint::db::{self, Input};
use plclint::lint::settings::Settings;
use plclint::lint::{Diagnostic, Outcome};
use plclint::source::detect::Dialect;

fn check(dialect: Dialect, text: &str) -> Outcome {
    let outcome = db::check(vec![Input::from_text("a.txt", text, dialect)], Settings::default());
    assert_eq!(outcome.internal_errors, [""; 0]);
    outcome
}

fn of<'o>(outcome: &'o Outcome, code: &str) -> Vec<&'o Diagnostic> {
    outcome.diagnostics.iter().filter(|it| it.finding.rule.code == code).collect()
}

/// The text with the first fix of each finding of a rule carried out.
fn fixed(text: &str, findings: &[&Diagnostic]) -> String {
    let fixes = findings.iter().filter_map(|it| it.finding.fixes.first());
    let mut edits: Vec<_> = fixes.flat_map(|it| &it.edits).collect();
    edits.sort_by_key(|it| std::cmp::Reverse((it.place.range.start(), it.place.range.end())));
    let mut text = text.to_owned();
    for it in edits {
        text.replace_range(usize::from(it.place.range.start())..usize::from(it.place.range.end()), &it.replacement);
    }
    text
}

/// A chart whose step 0 is left by transitions with these receptivities.
fn page(receptivities: &[&str]) -> String {
    let mut text = "PAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) : END_STEP\nSOURCE_CONNECTOR 1 AT (C 0,L 0)\n".to_owned();
    for (column, receptivity) in receptivities.iter().enumerate() {
        let step = column + 1;
        let language = match receptivity.split_whitespace().next() {
            Some("RUNG") => "LD",
            Some("LD" | "LDN" | "LDR" | "LDF") => "IL",
            _ => "ST",
        };
        text += &format!(
            "TRANSITION ({language}) AT (C {column},L 2) : {receptivity} END_TRANSITION\nSTEP {step} AT (C {column},L 3) : END_STEP\n\
             TRANSITION (ST) AT (C {column},L 4) : %I9.{column} END_TRANSITION\nDEST_CONNECTOR 0 AT (C {column},L 5)\n"
        );
        if column > 0 {
            text += &format!(
                "S_T_OR_LINK FROM (C 0,L 1) TO (C {column},L 2) := [H_LINK FROM (C 0,L 1) TO (C {column},L 2)]\n"
            );
        }
    }
    text + "END_PAGE\n"
}

/// The receptivities behind the first, after the fixes; that nothing is left to find is checked.
fn with_priority(receptivities: &[&str]) -> Vec<String> {
    let text = page(receptivities);
    let before = check(Dialect::Pl7Gr7, &text);
    let findings = of(&before, "G001");
    assert!(!findings.is_empty() && findings.iter().all(|it| !it.finding.fixes.is_empty()), "{text}\n{findings:#?}");
    let text = fixed(&text, &findings);
    let after = check(Dialect::Pl7Gr7, &text);
    for code in ["X001", "G001", "G008", "G009", "G010", "I004", "L001", "L002", "L003"] {
        let left: Vec<&str> = of(&after, code).iter().map(|it| it.finding.message.as_str()).collect();
        assert_eq!(left, [""; 0], "{code}\n{text}");
    }
    let receptivity = |it: &str| Some(it.split_once(",L 2) : ")?.1.split_once(" END_TRANSITION")?.0.to_owned());
    text.split("TRANSITION (").skip(1).filter_map(receptivity).skip(1).collect()
}

fn is_without(receptivities: &[&str]) {
    let text = page(receptivities);
    let outcome = check(Dialect::Pl7Gr7, &text);
    let findings = of(&outcome, "G001");
    assert!(!findings.is_empty() && findings.iter().all(|it| it.finding.fixes.is_empty()), "{text}");
}

const RUNG: &str = "RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),HASH_COIL;\nEND_RUNG";

#[test]
fn priority_in_structured_text() {
    assert_eq!(with_priority(&["%I1.0", "%I1.1"]), ["%I1.1 AND NOT %I1.0"]);
    assert_eq!(
        with_priority(&["%I1.0 OR RE %I1.3", "%I1.1 OR %MW4 > 5"]),
        ["(%I1.1 OR %MW4 > 5) AND NOT (%I1.0 OR (RE %I1.3))"]
    );
    assert_eq!(
        with_priority(&["%I1.0", "%I1.1 AND %M3", "NOT %I1.2"]),
        ["%I1.1 AND %M3 AND NOT %I1.0", "(NOT %I1.2) AND NOT %I1.0 AND NOT (%I1.1 AND %M3)"]
    );
    assert_eq!(with_priority(&["%MW10 > 15", "%MW10 < 20"]), ["(%MW10 < 20) AND NOT (%MW10 > 15)"]);
    assert_eq!(
        with_priority(&["(*PHRASE*) %I1.0 (*END_PHRASE*)", "(*PHRASE*) %X0.T > 30 (*END_PHRASE*)"]),
        ["(*PHRASE*) (%X0.T > 30) AND NOT %I1.0 (*END_PHRASE*)"]
    );
}

#[test]
fn priority_in_instruction_list() {
    assert_eq!(with_priority(&["LD %I1.0", "LD %I1.1"]), ["LD %I1.1 ANDN %I1.0"]);
    assert_eq!(
        with_priority(&["LD %I1.0 ANDN %M2", "LD %I1.1 OR %M3", "LD [%MW4>5]"]),
        ["LD %I1.1 OR %M3 AND(N %I1.0 OR %M2 )", "LD [%MW4>5] AND(N %I1.0 OR %M2 ) ANDN %I1.1 ANDN %M3"]
    );
    assert_eq!(
        with_priority(&["(%I1.0 OR %M7) AND (%I1.5 OR %M8)", "LD %I1.1"]),
        ["LD %I1.1 AND(N %I1.0 ANDN %M7 OR(N %I1.5 ANDN %M8 ) )"]
    );
}

#[test]
fn priority_in_ladder() {
    let with =
        |contacts: &str, rest: u32| format!("RUNG\nOPEN_CONTACT(%I1.1),{contacts},H_LINK({rest}),HASH_COIL;\nEND_RUNG");
    assert_eq!(with_priority(&["%I1.0", RUNG]), [with("CLOSED_CONTACT(%I1.0)", 8)]);
    let third = RUNG.replace("%I1.1", "%I1.2");
    assert_eq!(
        with_priority(&["%I1.0 OR NOT %M4", RUNG, &third]),
        [
            with("CLOSED_CONTACT(%I1.0),OPEN_CONTACT(%M4)", 7),
            third.replace("H_LINK(9)", "CLOSED_CONTACT(%I1.0),OPEN_CONTACT(%M4),CLOSED_CONTACT(%I1.1),H_LINK(6)")
        ]
    );
    let branches = "RUNG\nOPEN_CONTACT(%I1.1),SHORT_CIRCUIT,H_LINK(8),HASH_COIL;\n\
                    OPEN_CONTACT(%M1),H_LINK,EMPTY_CELL(9);\nEND_RUNG";
    assert_eq!(
        with_priority(&[RUNG.replace("%I1.1", "%I1.0").as_str(), branches]),
        [branches.replace("H_LINK(8)", "CLOSED_CONTACT(%I1.0),H_LINK(7)")]
    );
}

/// What follows cannot be written where there is room for it.
#[test]
fn no_fix_is_better_than_a_bad_one() {
    // A comment, an edge that no contact and no instruction negates, contacts in series, which need rows of their own.
    is_without(&["%I1.0", "%I1.1 (* manuel *) AND %M3"]);
    is_without(&["RE %I1.0", "LD %I1.1"]);
    is_without(&["RE %I1.0", RUNG]);
    is_without(&["%I1.0 AND %M2", RUNG]);
    // No free link before the end.
    let contacts: Vec<String> = (0..10).map(|it| format!("OPEN_CONTACT(%I2.{it})")).collect();
    is_without(&["%I1.0", &format!("RUNG\n{},HASH_COIL;\nEND_RUNG", contacts.join(","))]);
    let two_ways = "RUNG\nOPEN_CONTACT(%I1.1),H_LINK(8),SHORT_CIRCUIT,HASH_COIL;\nOPEN_CONTACT(%M1),H_LINK(9),EMPTY_CELL;\nEND_RUNG";
    is_without(&["%I1.0", two_ways]);
    // The later branch would never be taken.
    is_without(&["%MW10 > 10", "%MW10 > 20"]);
    is_without(&["TRUE", "%I1.1"]);
    // A pattern of bits, a value of a stack.
    is_without(&["%MW10 = 16#FFFF", "%I1.1"]);
    is_without(&["%I1.0", "LD %I1.1 MPS AND %M3 MPP"]);
}

#[test]
fn priority_in_pl7_2() {
    let text = "INITIAL_STEP X0 : END_STEP\nSTEP X1 : END_STEP\nSTEP X2 : END_STEP\n\
                TRANSITION FROM X0 TO X1 := I0,05 AND B2; END_TRANSITION\nTRANSITION FROM X0 TO X2 := I0,06; END_TRANSITION\n\
                TRANSITION FROM X1 TO X0 := I0,07; END_TRANSITION\nTRANSITION FROM X2 TO X0 := I0,08; END_TRANSITION\n";
    let before = check(Dialect::Pl72, text);
    let findings = of(&before, "G001");
    let text = fixed(text, &findings);
    assert!(text.contains(":= I0,06 AND NOT (I0,05 AND B2);"), "{text}");
    let after = check(Dialect::Pl72, &text);
    assert!(of(&after, "G001").is_empty() && of(&after, "X001").is_empty());
}

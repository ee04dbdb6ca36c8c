//! Numbers against controllers and configured counts: what the examples of rule pages, which have no configuration, do not
//! show.

use std::path::Path;

use plclint::db::{self, Input};
use plclint::lint::Outcome;
use plclint::lint::settings::{FILE_NAME, Folders, Overrides, Settings};
use plclint::report::Summary;
use plclint::source::detect::Dialect;

fn check(configuration: &str, dialect: Dialect, text: &str) -> Outcome {
    let settings = Settings::parse(configuration, Path::new(FILE_NAME), Folders::default(), Overrides::default());
    let settings = settings.unwrap_or_else(|error| panic!("{error}"));
    let extension = if dialect == Dialect::Step7 { "awl" } else { "txt" };
    let outcome = db::check(vec![Input::from_text(&format!("a.{extension}"), text, dialect)], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    outcome
}

/// Codes and messages of the rules that judge numbers.
fn found(configuration: &str, dialect: Dialect, text: &str) -> Vec<String> {
    let outcome = check(configuration, dialect, text);
    let codes = ["O002", "O003", "O004", "C006", "P003"];
    let judged = outcome.diagnostics.iter().filter(|it| codes.contains(&it.finding.rule.code));
    judged.map(|it| format!("{} {}", it.finding.rule.code, it.finding.message)).collect()
}

const MICRO: &str = "[target]\ncontroller = 'TSX 37-22'\n";

#[test]
fn configured_counts_are_the_end() {
    let text = "! %MW99 := %KW49; %MD99 := 0; %M0 := %TM7.Q AND %TM8.Q AND %X19;";
    let configured = format!("{MICRO}[objects]\nMW = 100\nKW = 49\nTM = 8\nX = 19");
    assert_eq!(
        found(&configured, Dialect::Pl7St, text),
        [
            "O003 `%KW49` is not configured: constant words are `%KW0` to `%KW48`",
            "O003 `%MD99` is not configured: internal words are `%MW0` to `%MW99`",
            "C006 `%TM8` is not configured: timers are `%TM0` to `%TM7`",
            "O003 `%X19` is not configured: steps of the main chart are `%X0` to `%X18`",
        ]
    );
    assert_eq!(found(MICRO, Dialect::Pl7St, text), [""; 0]);
}

#[test]
fn a_count_of_zero_says_that_there_are_none() {
    let text = "! %M0 := %XM0 AND %X1.IN;";
    let found = found(MICRO, Dialect::Pl7St, text);
    assert_eq!(found[0], "O003 `%XM0` does not exist on a TSX 37-22: there are no macro-steps");
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn counts_of_step_7() {
    let text = "      L     MD 98\n      T     MD 94\n      U     T 20\n      =     A 4.0\n      U     Z 3\n      =     A 4.1\n";
    let found = found("[objects]\nM = 100\nT = 20\nZ = 3", Dialect::Step7, text);
    assert_eq!(
        found,
        [
            "O003 `MD98` is not configured: bytes of memory are `MB 0` to `MB 99`",
            "C006 `T20` is not configured: timers are `T0` to `T19`",
            "C006 `Z3` is not configured: counters are `Z0` to `Z2`",
        ]
    );
    // A block keeps the letters of the program.
    let english = "      A     I 0.0\n      CU    C 3\n";
    let found = self::found("[objects]\nZ = 3", Dialect::Step7, english);
    assert_eq!(found, ["C006 `C3` is not configured: counters are `C0` to `C2`"]);
}

#[test]
fn a_controller_of_the_other_vendor_says_nothing() {
    let text = "! %MW600 := 0; %TM70.P := 1;";
    let other = "[target]\ncontroller = 'CPU 314'\n[objects]\nM = 10\nT = 5";
    assert_eq!(found(other, Dialect::Pl7St, text), [""; 0]);
}

#[test]
fn one_finding_for_one_object_and_one_cause() {
    // All items of a block are the block.
    let text = "! %M0 := %TM64.Q; %MW0 := %TM64.V; START %TM64;";
    let outcome = check(MICRO, Dialect::Pl7St, text);
    let found: Vec<_> = outcome.diagnostics.iter().filter(|it| it.finding.rule.code == "C006").collect();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].finding.related.len(), 2);
    // A number that no address can have is said once.
    let found = |text: &str| self::found(MICRO, Dialect::Pl7St, text);
    assert!(matches!(&found("! %M0 := %TM255.Q;")[..], [one] if one.starts_with("O002 ")));
    assert!(matches!(&found("! %MW65536 := 0;")[..], [one] if one.starts_with("O002 ")));
    assert!(matches!(&found("! %M0 := %S128;")[..], [one] if one.starts_with("O002 ")));
    // A timer that is too high by itself does not make the total too high.
    assert!(matches!(&found("! %M0 := %TM70.Q AND %T5.D;")[..], [one] if one.starts_with("C006 ")));
    assert_eq!(
        found("! %M0 := %TM60.Q AND %TM9.Q AND %T5.D;"),
        ["O004 `%TM60` and `%T5` take 67 timers, and a TSX 37-22 has 64 together"]
    );
}

#[test]
fn an_indexed_object_has_no_number() {
    assert_eq!(found("[objects]\nMW = 10", Dialect::Pl7St, "! %MW9 := %MW500[%MW2];"), [""; 0]);
}

#[test]
fn the_last_line_says_that_no_controller_was_given() {
    let line = |configuration: &str, dialect, text: &str| Summary::of(&check(configuration, dialect, text)).line(None);
    let says = "; no controller given for PL7: only limits that all share were checked";
    assert!(line("", Dialect::Pl7St, "! %M0 := %M1;").ends_with(says));
    assert!(line("[target]\ncontroller = 'CPU 314'", Dialect::Pl7St, "! %M0 := %M1;").ends_with(says));
    assert!(!line(MICRO, Dialect::Pl7St, "! %M0 := %M1;").contains("controller"));
    // Nothing would have been found for one controller that is not found for another.
    assert!(!line("[rules]\nselect = ['W']", Dialect::Pl7St, "! %M0 := %M1;").contains("controller"));
    assert!(line("", Dialect::Step7, "      U     M 0.0\n      =     A 4.0\n").contains(" for STEP 7: "));
}

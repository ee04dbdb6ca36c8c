//! One program in ladder, instruction list and structured text: the same findings, but for those about a language.

use plclint::db::{self, Input};
use plclint::lint::settings::{Folders, Overrides, Settings};
use plclint::source::detect::Dialect;

/// Groups of rules that look at the form of one language.
const OF_ONE_LANGUAGE: [&str; 3] = ["I", "T", "L"];

/// What a whole program should have: these here are sentences of one.
const OF_WHOLE_PROGRAMS: [&str; 3] = ["N005", "P008", "V004"];

/// Code of each finding that no language has alone, with the object that its message names.
fn found(text: &str) -> Vec<(&'static str, String)> {
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), ..Overrides::default() };
    let settings = Settings::without_file(Folders::default(), overrides).expect("`all` is a selection");
    let outcome = db::check(vec![Input::from_text("program.txt", text, Dialect::Pl7)], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    let mut found: Vec<_> = outcome
        .diagnostics
        .into_iter()
        .filter(|it| it.suppressed.is_none())
        .map(|it| {
            // Statements are quoted as each language writes them.
            let object = it.finding.message.split('`').nth(1).filter(|it| it.starts_with('%') || it.contains('.'));
            (it.finding.rule.code, object.unwrap_or_default().to_owned())
        })
        .collect();
    assert!(found.iter().all(|it| it.0 != "X001"), "{found:?}\n{text}");
    let left_out = |code: &str| OF_ONE_LANGUAGE.iter().chain(&OF_WHOLE_PROGRAMS).any(|it| code.starts_with(it));
    found.retain(|it| !left_out(it.0));
    found.sort();
    found
}

/// Sections in the three languages, each without its heading; `codes` are what all three must give.
#[track_caller]
fn same(codes: &[&str], ld: &str, il: &str, st: &str) {
    let expected = found(&format!("ST : MAST - MAIN\n{st}"));
    let of = |list: &[(&'static str, String)]| -> Vec<&'static str> { list.iter().map(|it| it.0).collect() };
    assert_eq!(of(&expected), codes, "ST: {expected:?}");
    assert_eq!(found(&format!("IL : MAST - MAIN\n{il}")), expected, "IL\n{il}");
    assert_eq!(found(&format!("LD : MAST - MAIN\n{ld}")), expected, "LD\n{ld}");
}

#[test]
fn writes() {
    same(
        &["W001"],
        "RUNG\nOPEN_CONTACT(%I1.0),CLOSED_CONTACT(%I1.1),H_LINK(8),COIL(%Q2.0);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.2),H_LINK(9),NOT_COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     ANDN %I1.1\n     ST   %Q2.0\n!    LD   %I1.2\n     STN  %Q2.0\n",
        "! %Q2.0 := %I1.0 AND NOT %I1.1;\n! %Q2.0 := NOT %I1.2;\n",
    );
    // A branch, and a circuit that holds itself.
    same(
        &[],
        "RUNG\nOPEN_CONTACT(%I1.0),SHORT_CIRCUIT,CLOSED_CONTACT(%I1.1),H_LINK(7),COIL(%Q2.0);\n\
         OPEN_CONTACT(%Q2.0),H_LINK,EMPTY_CELL(9);\nEND_RUNG\n",
        "!    LD   %I1.0\n     OR   %Q2.0\n     ANDN %I1.1\n     ST   %Q2.0\n",
        "! %Q2.0 := (%I1.0 OR %Q2.0) AND NOT %I1.1;\n",
    );
    // A bit that no program may write.
    same(
        &["W004"],
        "RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%TM1.Q);\nEND_RUNG\n",
        "!    LD   %I1.1\n     ST   %TM1.Q\n",
        "! %TM1.Q := %I1.1;\n",
    );
}

#[test]
fn set_and_reset() {
    same(
        &["W002"],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),RESET_COIL(%Q2.0);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     R    %Q2.0\n!    LD   %I1.1\n     ST   %Q2.0\n",
        "! IF %I1.0 THEN RESET %Q2.0; END_IF;\n! %Q2.0 := %I1.1;\n",
    );
    same(
        &["W003"],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),SET_COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     S    %Q2.0\n",
        "! IF %I1.0 THEN SET %Q2.0; END_IF;\n",
    );
}

#[test]
fn edges() {
    same(
        &["E001"],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),SET_COIL(%M10);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),RESET_COIL(%M10);\nEND_RUNG\n\
         RUNG\nP_CONTACT(%M10),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     S    %M10\n!    LD   %I1.1\n     R    %M10\n!    LDR  %M10\n     ST   %Q2.0\n",
        "! IF %I1.0 THEN SET %M10; END_IF;\n! IF %I1.1 THEN RESET %M10; END_IF;\n! %Q2.0 := RE %M10;\n",
    );
    same(
        &["E006", "O007"],
        "RUNG\nN_CONTACT(%MW10:X4),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LDF  %MW10:X4\n     ST   %Q2.0\n",
        "! %Q2.0 := FE %MW10:X4;\n",
    );
}

#[test]
fn jumps_and_calls() {
    same(
        &["J002"],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),JUMP_COIL(%L20);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     JMPC %L20\n!    LD   %I1.1\n     ST   %Q2.0\n",
        "! IF %I1.0 THEN JUMP %L20; END_IF;\n! %Q2.0 := %I1.1;\n",
    );
    // Of two assignments, a jump lets one be reached.
    same(
        &[],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),JUMP_COIL(%L10);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n\
         RUNG\nH_LINK(10),JUMP_COIL(%L20);\nEND_RUNG\n\
         RUNG %L10:\nOPEN_CONTACT(%I1.2),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n\
         RUNG %L20:\nOPEN_CONTACT(%I1.3),H_LINK(9),COIL(%Q2.1);\nEND_RUNG\n",
        "!    LD   %I1.0\n     JMPC %L10\n!    LD   %I1.1\n     ST   %Q2.0\n!    JMP  %L20\n! %L10:\n     LD   %I1.2\n     ST   \
         %Q2.0\n! %L20:\n     LD   %I1.3\n     ST   %Q2.1\n",
        "! IF %I1.0 THEN JUMP %L10; END_IF;\n! %Q2.0 := %I1.1;\n! JUMP %L20;\n! %L10: %Q2.0 := %I1.2;\n! %L20: %Q2.1 := \
         %I1.3;\n",
    );
    same(
        &["D001"],
        "RUNG\nH_LINK(10),JUMP_COIL(%L10);\nEND_RUNG\nRUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.1);\nEND_RUNG\n\
         RUNG %L10:\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    JMP  %L10\n!    LD   %I1.0\n     ST   %Q2.1\n! %L10:\n     LD   %I1.1\n     ST   %Q2.0\n",
        "! JUMP %L10;\n! %Q2.1 := %I1.0;\n! %L10: %Q2.0 := %I1.1;\n",
    );
    let subroutine = "IL : MAST - SR5\n!    LD   %I1.2\n     ST   %Q2.1\n     SR5\n";
    same(
        &["J011"],
        &format!("RUNG\nH_LINK(10),CALL_COIL(SR5);\nEND_RUNG\n{subroutine}"),
        &format!("!    SR5\n{subroutine}"),
        &format!("! SR5;\n{subroutine}"),
    );
    same(
        &["J012"],
        "RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),RETURN_COIL;\nEND_RUNG\n",
        "!    LD   %I1.0\n     RETC\n",
        "! IF %I1.0 THEN RETURN; END_IF;\n",
    );
}

#[test]
fn blocks() {
    same(
        &["C003", "C005"],
        "RUNG\nH_LINK,BLOCK(%TM1),EMPTY_CELL(8);\nEND_RUNG\nRUNG\nH_LINK,BLOCK(%TM1),EMPTY_CELL(8);\nEND_RUNG\n",
        "!    LD   TRUE\n     IN   %TM1\n!    LD   TRUE\n     IN   %TM1\n",
        "! START %TM1;\n! START %TM1;\n",
    );
    // The output of the block is wired, or read.
    same(
        &["W001"],
        "RUNG\nOPEN_CONTACT(%I1.0),BLOCK(%TM1),H_LINK(7),COIL(%Q2.0);\nEND_RUNG\n\
         RUNG\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   %I1.0\n     IN   %TM1\n     LD   %TM1.Q\n     ST   %Q2.0\n!    LD   %I1.1\n     ST   %Q2.0\n",
        "! IF %I1.0 THEN START %TM1; END_IF;\n  %Q2.0 := %TM1.Q;\n! %Q2.0 := %I1.1;\n",
    );
}

#[test]
fn comparisons_and_operations() {
    same(
        &["O001"],
        "RUNG\nCOMPARE X3.T>=150 END_BLOCK,H_LINK(8),COIL(%Q2.0);\nEND_RUNG\n",
        "!    LD   [X3.T>=150]\n     ST   %Q2.0\n",
        "! %Q2.0 := X3.T>=150;\n",
    );
    same(
        &["O007", "O007", "W004"],
        "RUNG\nCOMPARE %MW0>5 END_BLOCK,H_LINK(5),OPERATE %KW4:=%MW1+1 END_BLOCK;\nEND_RUNG\n",
        "!    LD   [%MW0>5]\n     [%KW4:=%MW1+1]\n",
        "! IF %MW0>5 THEN %KW4 := %MW1+1; END_IF;\n",
    );
}

#[test]
fn the_comment_of_a_rung_covers_it() {
    let rungs = |comment: &str| {
        let rung = "OPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.0);\nOPEN_CONTACT(%I1.1),H_LINK(9),COIL(%Q2.0);\nEND_RUNG";
        found(&format!(
            "LD : MAST - MAIN\n{comment}\n{rung}\nRUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.1);\nEND_RUNG\n"
        ))
    };
    assert_eq!(rungs("RUNG (*two*)").len(), 1);
    for comment in
        ["RUNG (*plclint: allow(W001)*)", "(*plclint: allow(W001)*)\nRUNG (*two*)", "RUNG (*plclint: allow(W001)*) :"]
    {
        assert_eq!(rungs(comment), [], "{comment}");
    }
}

#[test]
fn a_block_holds_so_much_text() {
    let operation = |terms: usize| {
        let text = format!("RUNG\nH_LINK(7),OPERATE\n%MW0:=%MW1{}\nEND_BLOCK;\nEND_RUNG\n", "+(%MW2)".repeat(terms));
        let overrides = Overrides { select: Some(vec!["L009".to_owned()]), ..Overrides::default() };
        let settings = Settings::without_file(Folders::default(), overrides).expect("a rule");
        let outcome = db::check(vec![Input::from_text("program.txt", &text, Dialect::Pl7)], settings);
        outcome.diagnostics.into_iter().map(|it| it.finding.message).collect::<Vec<_>>()
    };
    // Ten characters, and seven for each term.
    assert_eq!(operation(583), [""; 0]);
    let message = "this block holds 4098 characters, and no block holds more than 4096";
    assert_eq!(operation(584), [message]);
}

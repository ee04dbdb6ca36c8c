//! Sequences coded with bits: what is taken for one, what is not, and what is said of it.

#[path = "common/structure.rs"]
mod structure;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use structure::{Block, block};

use plclint::analysis::facts::UnitFacts;
use plclint::analysis::program::ProgramIndex;
use plclint::analysis::sequences::judge::DeviationKind;
use plclint::analysis::sequences::trace::Trace;
use plclint::db::{self, Input};
use plclint::lint::settings::{Folders, Overrides, Settings};
use plclint::model::entity::Family;
use plclint::model::expr::ObjectId;
use plclint::model::lower;
use plclint::source::detect::{Detected, Dialect};
use plclint::source::entity_from_address;
use plclint::source::split::{SplitHint, split};
use plclint::syntax::{self, Language, Mnemonics};
use proptest::prelude::*;

/// Codes of the findings about sequences.
#[track_caller]
fn found(text: &str) -> Vec<&'static str> {
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), ..Overrides::default() };
    let settings = Settings::without_file(Folders::default(), overrides).expect("`all` is a selection");
    let outcome = db::check(vec![Input::from_text("program.awl", text, Dialect::Step7)], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    let codes: Vec<&'static str> = outcome.diagnostics.iter().map(|it| it.finding.rule.code).collect();
    assert!(!codes.contains(&"X001"), "{text}");
    codes.into_iter().filter(|it| it.starts_with('Q')).collect()
}

/// Blocks by their addresses.
fn with_program<T>(blocks: &[(&str, String)], look: impl FnOnce(&ProgramIndex<'_>) -> T) -> T {
    let language = Language::Awl(Mnemonics::German);
    let facts: Vec<UnitFacts> = blocks
        .iter()
        .map(|(address, text)| {
            let parse = syntax::parse(language, text);
            assert_eq!(parse.errors(), [], "{text}");
            let entity = entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
            UnitFacts::new(&lower::lower(parse.syntax(), text, entity, language))
        })
        .collect();
    look(&ProgramIndex::new(Family::Step7, facts.iter().collect()))
}

type Transitions = BTreeSet<(Vec<String>, Vec<String>)>;

/// Steps and transitions of each sequence that is recovered.
fn recovered(blocks: &[(&str, String)]) -> Vec<(Vec<String>, Transitions)> {
    with_program(blocks, |program| {
        let names = |it: &plclint::analysis::sequences::Sequence<'_>, steps: &[usize]| {
            let mut names: Vec<String> = steps.iter().map(|step| it.name(*step).to_owned()).collect();
            names.sort();
            names
        };
        let one = |it: &plclint::analysis::sequences::Sequence<'_>| {
            let all: Vec<usize> = (0..it.steps.len()).collect();
            let transitions = it.transitions.iter().map(|t| (names(it, &t.found.sources), names(it, &t.found.targets)));
            (names(it, &all), transitions.collect())
        };
        program.sequences().list.iter().map(one).collect()
    })
}

fn ob(number: u32, code: &str) -> String {
    format!("ORGANIZATION_BLOCK OB {number}\nBEGIN\nNETWORK\n{code}END_ORGANIZATION_BLOCK\n")
}

/// One instruction a word: `U.M10.0`, separated by blanks; a `/` begins a network.
fn awl(code: &str) -> String {
    let line = |it: &str| match it {
        "/" => "NETWORK\n".to_owned(),
        _ => format!("      {}\n", it.replacen('.', " ", 1).replace('_', " ")),
    };
    code.split_whitespace().map(line).collect()
}

const START: &str = "SET S.M10.0 R.M10.1 R.M10.2 R.M10.3 R.M10.4";

#[track_caller]
fn judged(code: &str, codes: &[&str]) {
    let text = ob(100, &awl(START)) + &ob(1, &awl(code));
    assert_eq!(found(&text), codes, "{text}");
}

/// The forms of the document, GRF:193-283.
#[test]
fn forms_of_the_document() {
    // 3.1: from top to bottom, from bottom to top.
    let (a, b, c) = (
        "/ U.M10.0 U.E0.0 S.M10.1 R.M10.0 ",
        "/ U.M10.1 U.E0.1 S.M10.2 R.M10.1 ",
        "/ U.M10.2 U.E0.2 UN.E0.0 S.M10.0 R.M10.2 ",
    );
    judged(&[a, b, c].concat(), &["Q001"]);
    judged(&[c, b, a].concat(), &[]);
    // Where the loop closes, one pair is left.
    judged(&[&c.replace("UN.E0.0 ", ""), b, a].concat(), &["Q001"]);
    // The operands in any order, the reset first, one network for all.
    judged("U.E0.0 U.M10.0 R.M10.0 S.M10.1 U.E0.1 U.M10.1 R.M10.1 S.M10.2 U.E0.2 U.M10.2 R.M10.2 S.M10.0", &["Q001"]);
    // Set and reset in networks of their own.
    judged(
        "/ U.M10.0 U.E0.0 S.M10.1 / U.M10.0 U.E0.0 R.M10.0 / U.M10.1 U.E0.1 S.M10.2 / U.M10.1 U.E0.1 R.M10.1 / \
            U.M10.2 U.E0.2 S.M10.0 / U.M10.2 U.E0.2 R.M10.2",
        &["Q001"],
    );
    // 3.2: a shift register; its first step stays on.
    let start = "U.E0.0 FP.M9.0 =.M9.1 ";
    let (a, b, c, d) = (
        "/ U.M9.1 U.M10.0 S.M10.1 ",
        "/ U.M9.1 U.M10.1 S.M10.2 R.M10.1 ",
        "/ U.M9.1 U.M10.2 S.M10.3 R.M10.2 ",
        "/ U.M9.1 U.M10.3 R.M10.3 ",
    );
    judged(&[start, d, c, b, a].concat(), &[]);
    judged(&[start, a, b, c, d].concat(), &["Q001"]);
    // The same with all conditions first: nothing runs through, but what comes is lost.
    let first = "/ U.M9.1 U.M10.1 =.M9.4 / U.M9.1 U.M10.2 =.M9.5 / U.M9.1 U.M10.3 =.M9.6 ";
    let (b, c, d) = ("/ U.M9.4 S.M10.2 R.M10.1 ", "/ U.M9.5 S.M10.3 R.M10.2 ", "/ U.M9.6 R.M10.3 ");
    judged(&[start, first, d, c, b, a].concat(), &[]);
    judged(&[start, first, b, c, d, a].concat(), &["Q003", "Q003"]);
    // 3.3, case 1: branches that come together.
    let rest = "/ U.M10.0 U.E1.0 UN.E1.1 S.M10.1 R.M10.0 / U.M10.0 U.E1.1 UN.E1.0 S.M10.2 R.M10.0 ";
    judged(
        &format!(
            "/ U.M10.3 U.E0.3 UN.E1.0 UN.E1.1 S.M10.0 R.M10.3 / U.E0.1 U.M10.1 S.M10.3 R.M10.1 / U.E0.2 U.M10.2 S.M10.3 R.M10.2 {rest}"
        ),
        &[],
    );
    // Cases 2 and 3: parallel branches.
    judged(
        "/ U.M10.3 U.M10.4 U.E0.5 UN.E0.0 S.M10.0 R.M10.3 R.M10.4 / U.E0.1 U.M10.1 S.M10.3 R.M10.1 / U.E0.2 U.M10.2 S.M10.4 R.M10.2 \
         / U.E0.0 U.M10.0 S.M10.1 S.M10.2 R.M10.0",
        &[],
    );
    // Case 4: three networks; both branches are taken, which is a defect of the chart, and is coded as the rules say.
    let back = "/ U.M10.1 U.E1.1 UN.E0.1 UN.E0.2 S.M10.0 R.M10.1 / U.M10.2 U.E1.2 UN.E0.1 UN.E0.2 S.M10.0 R.M10.2 ";
    judged(
        &format!("{back} / U.E0.1 U.M10.0 S.M10.1 / U.E0.2 U.M10.0 S.M10.2 / U( U.E0.1 O.E0.2 ) U.M10.0 R.M10.0"),
        &["Q012"],
    );
    judged(&format!("{back} / U.E0.1 U.M10.0 S.M10.1 R.M10.0 / U.E0.2 U.M10.0 S.M10.2 R.M10.0"), &["Q004"]);
    judged(&format!("{back} / U.E0.1 U.M10.0 S.M10.1 R.M10.0 / U.E0.2 UN.E0.1 U.M10.0 S.M10.2 R.M10.0"), &[]);
    // 3.4: two steps.
    judged("/ U.M10.1 U.E0.1 S.M10.0 R.M10.1 / U.M10.0 U.E0.0 S.M10.1 R.M10.0", &["Q002"]);
    judged("/ U.M10.0 U.E0.0 S.M10.1 R.M10.0 / U.M10.1 U.E0.1 S.M10.0 R.M10.1", &["Q002"]);
    judged("/ U.M10.1 UN.E0.0 S.M10.0 R.M10.1 / U.M10.0 U.E0.0 S.M10.1 R.M10.0", &[]);
}

/// What keeps a step from being passed.
#[test]
fn steps_that_are_not_passed() {
    // A lock: one transition a scan.
    judged(
        "CLR =.M9.0 / U.M10.0 U.E0.0 UN.M9.0 S.M10.1 R.M10.0 S.M9.0 / U.M10.1 U.E0.1 UN.M9.0 S.M10.2 R.M10.1 S.M9.0 \
         / U.M10.2 U.E0.2 UN.M9.0 S.M10.0 R.M10.2 S.M9.0",
        &[],
    );
    // The block ends behind a transition.
    judged(
        "/ U.M10.0 U.E0.0 S.M10.1 R.M10.0 BEB / U.M10.1 U.E0.1 S.M10.2 R.M10.1 BEB / U.M10.2 U.E0.2 S.M10.0 R.M10.2",
        &[],
    );
    // Jumps over each transition that is not crossed, and over the rest where one is.
    let text = ob(100, &awl(START))
        + &ob(
            1,
            "U M10.0\nU E0.0\nSPBN A1\nSET\nS M10.1\nR M10.0\nSPA ENDE\nA1: U M10.1\nU E0.1\nSPBN A2\nSET\nS M10.2\nR M10.1\n\
             SPA ENDE\nA2: U M10.2\nU E0.2\nSPBN ENDE\nSET\nS M10.0\nR M10.2\nENDE: NOP 0\n",
        );
    assert_eq!(found(&text), [""; 0]);
    // Edges of different buttons come in different scans; one and the same edge does not.
    let edges = "/ U.E0.0 FP.M9.0 =.M9.1 / U.E0.1 FP.M9.2 =.M9.3 / U.E0.2 FP.M9.4 =.M9.5 ";
    judged(
        &format!(
            "{edges} / U.M10.0 U.M9.1 S.M10.1 R.M10.0 / U.M10.1 U.M9.3 S.M10.2 R.M10.1 / U.M10.2 U.M9.5 S.M10.0 R.M10.2"
        ),
        &[],
    );
    judged(
        &format!(
            "{edges} / U.M10.0 U.M9.1 S.M10.1 R.M10.0 / U.M10.1 U.M9.1 S.M10.2 R.M10.1 / U.M10.2 U.M9.5 S.M10.0 R.M10.2"
        ),
        &["Q001"],
    );
    // Numbers that exclude each other.
    judged(
        "/ U.M10.0 U( L.MW20 L.1 ==I ) S.M10.1 R.M10.0 / U.M10.1 U( L.MW20 L.2 ==I ) S.M10.2 R.M10.1 / U.M10.2 U( L.MW20 L.3 ==I ) S.M10.0 R.M10.2",
        &[],
    );
    // A step that resets the one before it lasts into the next scan.
    judged(
        "/ U.M10.0 U.E0.0 S.M10.1 U.M10.2 R.M10.1 / U.M10.1 U.E0.1 S.M10.2 U.M10.3 R.M10.2 / U.M10.2 U.E0.2 S.M10.3 U.M10.0 R.M10.3 \
         / U.M10.3 U.E0.3 S.M10.0 U.M10.1 R.M10.0",
        &[],
    );
}

/// Bits that are no steps.
#[test]
fn near_misses() {
    let claimed = |code: &str| recovered(&[("OB1", ob(1, &awl(code)))]).len();
    let none = [
        // A motor, its fault, an acknowledgement.
        "U.E0.0 S.M1.0 U.E0.1 R.M1.0 U.E0.2 S.M1.1 U.E0.3 R.M1.1",
        "U.E0.0 UN.M1.1 S.M1.0 ON.E0.1 O.M1.1 R.M1.0 U.E0.2 S.M1.1 U.E0.3 R.M1.1",
        // Buttons that exclude each other, two and three.
        "U.E0.0 S.M1.0 R.M1.1 U.E0.1 S.M1.1 R.M1.0",
        "U.E0.0 S.M1.0 R.M1.1 R.M1.2 U.E0.1 S.M1.1 R.M1.0 R.M1.2 U.E0.2 S.M1.2 R.M1.0 R.M1.1",
        "U.E0.0 UN.M1.1 S.M1.0 R.M1.2 U.E0.1 UN.M1.2 S.M1.1 R.M1.0 U.E0.2 UN.M1.0 S.M1.2 R.M1.1",
        // Alarms that come, and are acknowledged.
        "U.E0.0 S.M1.0 U.M1.0 U.E0.7 S.M2.0 R.M1.0 UN.E0.0 R.M2.0",
        "U.E0.7 U.M1.0 S.M2.0 R.M1.0 U.E0.7 U.M1.1 S.M2.0 R.M1.1 U.E0.7 U.M1.2 S.M2.0 R.M1.2 U.E0.6 R.M2.0 \
         U.E0.0 S.M1.0 U.E0.1 S.M1.1 U.E0.2 S.M1.2",
        // A request that is taken.
        "U.E0.0 S.M1.0 U.M1.0 UN.M1.1 S.M1.1 R.M1.0 U.E0.1 R.M1.1",
        // A flip-flop of one bit.
        "U.E0.0 FP.M9.0 =.M9.1 U.M9.1 UN.M1.0 S.M1.0 SPB.ENDE U.M9.1 U.M1.0 R.M1.0 ENDE:.NOP_0",
        // Assigned bits.
        "U.M1.0 U.E0.0 S.M1.1 R.M1.0 U.M1.1 U.E0.1 S.M1.2 R.M1.1 U.M1.2 U.E0.2 S.M1.0 R.M1.2 U.E1.0 =.M1.0 U.E1.1 =.M1.1 U.E1.2 =.M1.2",
        // Outputs are no steps.
        "U.A4.0 U.E0.0 S.A4.1 R.A4.0 U.A4.1 U.E0.1 S.A4.2 R.A4.1 U.A4.2 U.E0.2 S.A4.0 R.A4.2",
        // Lamps that follow one another without asking.
        "U.T1 S.M1.1 R.M1.0 U.T2 S.M1.2 R.M1.1 U.T3 S.M1.0 R.M1.2",
    ];
    for code in none {
        assert_eq!(claimed(&code.replace("ENDE:.NOP_0", "NOP_0").replace("SPB.ENDE", "BEB")), 0, "{code}");
    }
}

/// A word that is written, or given to a block that was not read, takes the bits in it along.
#[test]
fn words_change_their_bits() {
    let still_asks = |code: &str| {
        with_program(&[("OB1", ob(1, code))], |program| {
            let place = |text: &str| program.objects.iter().position(|it| it.object.text == text);
            let id = |text: &str| ObjectId(u32::try_from(place(text).expect("an object")).expect("few objects"));
            let mut trace = Trace::of_scan(program);
            let end = trace.end(id("M10.1"));
            trace.mentions(end, |it| it == id("E0.0"))
        })
    };
    let call = |given: &str| still_asks(&format!("U E 0.0\n= M 10.1\nCALL FC 99 (x := {given})\n"));
    assert!(call("MW 12"));
    assert!(!call("MW 10"));
    assert!(!call("MD 8"));
    assert!(!call("M 10.1"));
    let store = |word: &str| still_asks(&format!("U E 0.0\n= L 2.1\nL MW 20\nT {word}\nU L 2.1\n= M 10.1\n"));
    for apart in ["LW 0", "LB 3", "LD 4", "MW 30"] {
        assert!(store(apart), "{apart}");
    }
    for over in ["LW 2", "LB 2", "LD 0", "LW 1"] {
        assert!(!store(over), "{over}");
    }
    // Bits of a constant are known.
    assert!(!still_asks("U E 0.0\n= L 2.1\nL 0\nT LW 2\nU L 2.1\nU E 0.0\n= M 10.1\n"));
}

fn names(steps: &[&str]) -> Vec<String> {
    steps.iter().map(|it| (*it).to_owned()).collect()
}

fn transitions(list: &[(&[&str], &[&str])]) -> Transitions {
    list.iter().map(|it| (names(it.0), names(it.1))).collect()
}

/// S7:893-957: a block that is called once a step.
#[test]
fn a_step_is_a_call() {
    let block = "FUNCTION_BLOCK FB 1\nVAR_INPUT\n  tem : TIMER;\n  duree : S5TIME;\nEND_VAR\nVAR_IN_OUT\n  etape_actuelle : BOOL;\n\
                 etape_suivante : BOOL;\nEND_VAR\nBEGIN\nNETWORK\nU #etape_actuelle\nL #duree\nSE #tem\nU #tem\nR #etape_actuelle\n\
                 S #etape_suivante\nBE\nEND_FUNCTION_BLOCK\n";
    let call = |at: u32| {
        format!(
            "CALL FB1, DB1 (tem := T{}, duree := S5T#1S, etape_actuelle := \"X{at}\", etape_suivante := \"X{}\");\n",
            at + 1,
            (at + 1) % 3
        )
    };
    let main = ob(1, &(call(0) + &call(1) + &call(2)));
    let start = ob(100, "SET\nS \"X0\"\nR \"X1\"\nR \"X2\"\n");
    let expected = transitions(&[(&["\"X0\""], &["\"X1\""]), (&["\"X1\""], &["\"X2\""]), (&["\"X2\""], &["\"X0\""])]);
    let found_here = recovered(&[("FB1", block.to_owned()), ("OB1", main.clone()), ("OB100", start.clone())]);
    assert_eq!(found_here, [(names(&["\"X0\"", "\"X1\"", "\"X2\""]), expected)]);
    assert_eq!(found(&format!("{block}{main}{start}")), [""; 0], "its timer keeps each step on");
}

/// A step as a function block: its bit is what the instance keeps.
const STEP: &str = "FUNCTION_BLOCK FB 2\nVAR_INPUT\n  set : BOOL;\n  reset : BOOL;\nEND_VAR\nVAR_OUTPUT\n  x : BOOL;\nEND_VAR\nVAR\n  \
                    entry : BOOL;\nEND_VAR\nBEGIN\nNETWORK\nU #set\nS #x\nU #reset\nR #x\nU #x\nFP #entry\nS M99.0\nEND_FUNCTION_BLOCK\n";

/// Instances that a function block declares, of the block of the course and of one that keeps its step itself. In the
/// latter, the transitions are computed before any step is, so that none is passed.
#[test]
fn steps_are_instances() {
    let instances = "VAR\n  s0 : FB 2;\n  s1 : FB 2;\n  s2 : FB 2;\nEND_VAR\nVAR_TEMP\n  t0 : BOOL;\n  t1 : BOOL;\n  t2 : BOOL;\n  \
                     start : BOOL;\nEND_VAR\n";
    let transitions_of = "U #s0.x\nU E0.0\n= #t0\nU #s1.x\nU E0.1\n= #t1\nU #s2.x\nU E0.2\n= #t2\nUN #s0.x\nUN #s1.x\nUN \
                          #s2.x\nO #t2\n= #start\n";
    let calls = "CALL #s0 (set := #start, reset := #t0)\nCALL #s1 (set := #t0, reset := #t1)\nCALL #s2 (set := #t1, reset := #t2)\n";
    let block = format!("FUNCTION_BLOCK FB 10\n{instances}BEGIN\nNETWORK\n{transitions_of}{calls}END_FUNCTION_BLOCK\n");
    let main = ob(1, "CALL FB 10, DB 10\n");
    let blocks = [("FB2", STEP.to_owned()), ("FB10", block.clone()), ("OB1", main.clone())];
    let expected = transitions(&[(&["#s0.x"], &["#s1.x"]), (&["#s1.x"], &["#s2.x"]), (&["#s2.x"], &["#s0.x"])]);
    assert_eq!(recovered(&blocks), [(names(&["#s0.x", "#s1.x", "#s2.x"]), expected.clone())]);
    let data = "DATA_BLOCK DB 10\nFB 10\nBEGIN\nEND_DATA_BLOCK\n";
    let clean = found(&format!("{STEP}{block}{data}{main}"));
    assert_eq!(clean, [""; 0], "an instance is no other one");

    // The step takes itself back from the one before: from the last step to the first, none is passed.
    let call = |at: u32| format!("CALL #s{at} (previous := #s{}.x, condition := M5.{at})\n", (at + 2) % 3);
    let judged = |calls: [u32; 3]| {
        let start = format!("UN #s0.x\nUN #s1.x\nUN #s2.x\nS #s0.x\n{CONDITIONS}");
        let calls: String = calls.map(call).concat();
        let block = format!(
            "FUNCTION_BLOCK FB 10\n{}BEGIN\nNETWORK\n{start}{calls}END_FUNCTION_BLOCK\n",
            instances.replace("FB 2", "FB 3")
        );
        found(&format!("{TAKING_STEP}{block}{data}{main}"))
    };
    assert_eq!(judged([2, 1, 0]), [""; 0]);
    assert_eq!(judged([1, 2, 0]), ["Q001"]);
}

/// Where the loop closes, they exclude each other.
const CONDITIONS: &str = "UN E0.2\n= M5.0\nU E0.1\n= M5.1\nU E0.2\n= M5.2\n";

/// A step that is given the one before it.
const TAKING_STEP: &str = "FUNCTION_BLOCK FB 3\nVAR_INPUT\n  condition : BOOL;\nEND_VAR\nVAR_OUTPUT\n  x : BOOL;\nEND_VAR\nVAR_IN_OUT\n  \
                           previous : BOOL;\nEND_VAR\nBEGIN\nNETWORK\nU #previous\nU #condition\nS #x\nR #previous\nEND_FUNCTION_BLOCK\n";

/// The same with a data block for each, as other blocks see them.
#[test]
fn steps_are_data_blocks() {
    let data = |n: u32| format!("DATA_BLOCK DB {n}\nFB 2\nBEGIN\nEND_DATA_BLOCK\n");
    let code = "U DB20.x\nU E0.0\n= M0.0\nU DB21.x\nU E0.1\n= M0.1\nU DB22.x\nU E0.2\n= M0.2\nCALL FB 2, DB 20 (set := M0.2, \
                reset := M0.0)\nCALL FB 2, DB 21 (set := M0.0, reset := M0.1)\nCALL FB 2, DB 22 (set := M0.1, reset := M0.2)\n";
    let (main, start) = (ob(1, code), ob(100, "SET\nS DB20.x\n"));
    let text = [STEP, &data(20), &data(21), &data(22), &main, &start].concat();
    assert_eq!(found(&text), [""; 0]);
    let data = |n: u32| data(n).replace("FB 2", "FB 3");
    let judged = |calls: [u32; 3]| {
        let call = |at: u32| format!("CALL FB 3, DB 2{at} (previous := DB2{}.x, condition := M5.{at})\n", (at + 2) % 3);
        let main = ob(1, &format!("{CONDITIONS}{}", calls.map(call).concat()));
        found(&[TAKING_STEP, &data(20), &data(21), &data(22), &main, &start].concat())
    };
    assert_eq!(judged([2, 1, 0]), [""; 0]);
    assert_eq!(judged([1, 2, 0]), ["Q001"]);
}

/// The sequence in one block, its conditions in another one, its outputs in a third.
#[test]
fn blocks_in_the_order_of_their_calls() {
    let conditions = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\nU M10.0\nU E0.0\n= M20.0\nU M10.1\nU E0.1\n= M20.1\nU M10.2\nU E0.2\n= M20.2\n\
                      END_FUNCTION\n";
    let steps = "FUNCTION FC 2 : VOID\nBEGIN\nNETWORK\nU M20.0\nS M10.1\nR M10.0\nU M20.1\nS M10.2\nR M10.1\nU M20.2\nS M10.0\n\
                 R M10.2\nEND_FUNCTION\n";
    let main = |first: &str, second: &str| ob(1, &format!("CALL {first}\nCALL {second}\n"));
    let start = ob(100, &awl(START));
    assert_eq!(found(&format!("{conditions}{steps}{start}{}", main("FC 1", "FC 2"))), [""; 0]);
    let expected = transitions(&[(&["M10.0"], &["M10.1"]), (&["M10.1"], &["M10.2"]), (&["M10.2"], &["M10.0"])]);
    let all = [("OB1", main("FC 1", "FC 2")), ("FC1", conditions.to_owned()), ("FC2", steps.to_owned())];
    assert_eq!(recovered(&all), [(names(&["M10.0", "M10.1", "M10.2"]), expected)]);
}

/// The blocks of a graph in tables (GRF:393-419, 489, 666-690), called in the order of GRF:1001-1009. Ts is MW10, Tp MW12, Tf0
/// MW14, Tf1 MW16, Tt MW120, Td MW124, Ta MW126.
struct Tables {
    refresh: &'static str,
    receptivities: &'static str,
    steps: &'static str,
    clear_forces: &'static str,
    forces: &'static str,
    result: &'static str,
    outputs: &'static str,
    calls: &'static str,
}

const RECEPTIVITIES_OF_TABLES: &str =
    "L.0 T.MW120 / U.E0.0 S.M120.0 / U.E0.1 S.M120.1 / U.E0.2 S.M120.2 / U.E0.3 S.M120.3";

/// Chapter V: the transitions one by one, with a divergence and a parallel one.
const ONE_BY_ONE: Tables = Tables {
    refresh: "L.MW10 T.MW12",
    receptivities: RECEPTIVITIES_OF_TABLES,
    steps: "L.0 T.MW126 T.MW124 / U.M120.0 U.M12.0 S.M126.1 S.M126.2 S.M124.0 / U.M120.1 U.M12.1 S.M126.3 S.M124.1 \
            / U.M120.2 U.M12.2 S.M126.4 S.M124.2 / U.M120.3 U.M12.3 U.M12.4 S.M126.0 S.M124.3 S.M124.4 \
            / L.MW124 INVI L.MW12 UW L.MW126 OW T.MW10",
    clear_forces: "L.0 T.MW14 T.MW16",
    forces: "U.E1.0 S.M14.1 U.E1.0 S.M16.0",
    result: "L.MW14 INVI L.MW10 UW L.MW16 OW T.MW10",
    outputs: "U.M10.1 =.A4.1 U.M10.2 =.A4.2",
    calls: "CALL.FC_10 CALL.FC_13 CALL.FC_14 CALL.FC_15 CALL.FC_16 CALL.FC_17 CALL.FC_18",
};

/// Chapter IV: an equation a step.
const STEP_BY_STEP: Tables = Tables {
    steps: "/ U.M120.0 U.M12.0 =.M100.5 / UN.M100.5 U.M12.0 =.M100.6 / U.M12.3 U.M12.4 U.M120.3 =.M100.7 / U.M100.6 O.M100.7 =.M10.0 \
            / UN.M120.1 U.M12.1 =.M100.6 / U.M12.0 U.M120.0 =.M100.7 / U.M100.6 O.M100.7 =.M10.1 \
            / UN.M120.2 U.M12.2 =.M100.6 / U.M12.0 U.M120.0 =.M100.7 / U.M100.6 O.M100.7 =.M10.2 \
            / U.M12.4 U.M120.3 =.M100.5 / UN.M100.5 U.M12.3 =.M100.6 / U.M12.1 U.M120.1 =.M100.7 / U.M100.6 O.M100.7 =.M10.3 \
            / U.M12.3 U.M120.3 =.M100.5 / UN.M100.5 U.M12.4 =.M100.6 / U.M12.2 U.M120.2 =.M100.7 / U.M100.6 O.M100.7 =.M10.4",
    ..ONE_BY_ONE
};

impl Tables {
    fn blocks(&self) -> Vec<(&'static str, String)> {
        let block = |number: u32, code: &str| {
            format!("FUNCTION FC {number} : VOID\nBEGIN\nNETWORK\n{}END_FUNCTION\n", awl(code))
        };
        vec![
            ("FC10", block(10, self.clear_forces)),
            ("FC13", block(13, self.refresh)),
            ("FC14", block(14, self.receptivities)),
            ("FC15", block(15, self.steps)),
            ("FC16", block(16, self.forces)),
            ("FC17", block(17, self.result)),
            ("FC18", block(18, self.outputs)),
            ("OB1", ob(1, &awl(self.calls))),
            ("OB100", ob(100, &awl("L.W#16#100 T.MW10 T.MW12"))),
        ]
    }

    fn found(&self) -> Vec<&'static str> {
        found(&self.blocks().into_iter().map(|it| it.1).collect::<String>())
    }
}

#[test]
fn tables() {
    let expected = transitions(&[
        (&["M10.0"], &["M10.1", "M10.2"]),
        (&["M10.1"], &["M10.3"]),
        (&["M10.2"], &["M10.4"]),
        (&["M10.3", "M10.4"], &["M10.0"]),
    ]);
    // Steps that no place of the program reads go by another table.
    let as_steps = |it: Vec<(Vec<String>, Transitions)>| -> Vec<Transitions> {
        let step = |it: &String| it.replace("M12.", "M10.").replace("M126.", "M10.").replace("M124.", "M10.");
        let all = |it: Vec<String>| it.iter().map(step).collect::<Vec<String>>();
        it.into_iter().map(|it| it.1.into_iter().map(|it| (all(it.0), all(it.1))).collect()).collect()
    };
    for tables in [&ONE_BY_ONE, &STEP_BY_STEP] {
        assert_eq!(as_steps(recovered(&tables.blocks())), std::slice::from_ref(&expected));
        assert_eq!(tables.found(), [""; 0]);
    }
}

/// Activations and deactivations are common to all graphs (GRF:1120): each clears them.
#[test]
fn graphs_share_their_tables() {
    let graph = |now: u32, before: u32, input: u32| {
        format!(
            "L.MW{now} T.MW{before} / L.0 T.MW126 T.MW124 / U.E{input}.0 U.M{before}.0 S.M126.1 S.M124.0 / U.E{input}.1 U.M{before}.1 \
             S.M126.2 S.M124.1 / U.E{input}.2 U.M{before}.2 S.M126.0 S.M124.2 / L.MW124 INVI L.MW{before} UW L.MW126 OW T.MW{now} "
        )
    };
    let start = ob(100, &awl("L.W#16#100 T.MW10 T.MW12 T.MW20 T.MW22"));
    let both = |first: &str, second: &str| ob(1, &awl(&[first, " / ", second].concat()));
    let (first, second) = (graph(10, 12, 0), graph(20, 22, 1));
    assert_eq!(found(&(both(&first, &second) + &start)), [""; 0]);
    let shapes = recovered(&[("OB1", both(&first, &second)), ("OB100", start.clone())]);
    assert_eq!(shapes.iter().map(|it| (it.0.len(), it.1.len())).collect::<Vec<_>>(), [(3, 3), (3, 3)]);
    let kept = second.replace("/ L.0 T.MW126 T.MW124 ", "");
    assert_eq!(found(&(both(&first, &kept) + &start)), ["Q007", "Q007"]);
}

/// Three graphs by equations, whose tables lie as far from one another: each is one, forced and frozen or not.
#[test]
fn graphs_of_the_corpus() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus/programs/bidons-s5/bidons.s5");
    let text = std::fs::read_to_string(path).expect("a program of the corpus");
    let language = Language::Step5(Mnemonics::German);
    let hint = SplitHint { entity: None, mnemonics: Some(Mnemonics::German) };
    let facts: Vec<UnitFacts> = split(&text, Detected::Step5, &hint)
        .into_iter()
        .map(|it| {
            let part = &text[std::ops::Range::<usize>::from(it.range)];
            let parse = syntax::parse(language, part);
            assert_eq!(parse.errors(), [], "{part}");
            UnitFacts::new(&lower::lower(parse.syntax(), part, it.entity, language))
        })
        .collect();
    let program = ProgramIndex::new(Family::Step5, facts.iter().collect());
    let sequences = program.sequences();
    let shapes: Vec<(usize, usize, usize)> =
        sequences.list.iter().map(|it| (it.steps.len(), it.transitions.len(), it.starts.len())).collect();
    assert_eq!(shapes, [(4, 7, 1), (4, 4, 1), (4, 4, 1)]);
    assert_eq!(sequences.faults.len(), 0, "{:?}", sequences.faults);
}

/// Lines that the document asks for, each left out or changed.
#[test]
fn each_line_of_the_tables_counts() {
    let check = |tables: Tables, codes: &[&str]| assert_eq!(tables.found(), codes, "{}", tables.steps);
    for base in [|| ONE_BY_ONE, || STEP_BY_STEP] {
        // No copy; one after the steps; one more write.
        check(Tables { refresh: "NOP.0", ..base() }, &["Q006"]);
        let late = "CALL.FC_10 CALL.FC_14 CALL.FC_15 CALL.FC_13 CALL.FC_16 CALL.FC_17 CALL.FC_18";
        check(Tables { calls: late, ..base() }, &["Q006"]);
        check(Tables { outputs: "U.M10.1 =.A4.1 U.E7.0 S.M12.1", ..base() }, &["Q006"]);
        // The receptivities, and the forces, stay.
        let kept = "/ U.E0.0 S.M120.0 / U.E0.1 S.M120.1 / U.E0.2 S.M120.2 / U.E0.3 S.M120.3 / L.MW120 T.MW122";
        check(Tables { receptivities: kept, ..base() }, &["Q007"]);
        check(Tables { clear_forces: "L.0 T.MW14", ..base() }, &["Q007"]);
        check(Tables { clear_forces: "L.0 T.MW16", ..base() }, &["Q007"]);
        // The forces to 0 win.
        check(Tables { result: "L.MW10 L.MW16 OW L.MW14 INVI UW T.MW10", ..base() }, &["Q010"]);
        // The outputs before the forces, before the steps.
        let early = "CALL.FC_10 CALL.FC_13 CALL.FC_14 CALL.FC_15 CALL.FC_16 CALL.FC_18 CALL.FC_17";
        check(Tables { calls: early, ..base() }, &["Q008"]);
    }
    let steps = |from: &str, to: &str| -> &'static str { ONE_BY_ONE.steps.replace(from, to).leak() };
    check(Tables { steps: steps("T.MW126 T.MW124", "T.MW126"), ..ONE_BY_ONE }, &["Q007"]);
    check(Tables { steps: steps("T.MW126 T.MW124", "T.MW124"), ..ONE_BY_ONE }, &["Q007"]);
    // A branch is left open, or closed as alternatives: a defect of the chart.
    let open = steps("U.M12.3 U.M12.4 S.M126.0 S.M124.3 S.M124.4", "U.M12.3 S.M126.0 S.M124.3");
    assert!(Tables { steps: open, ..ONE_BY_ONE }.found().contains(&"Q012"));
    // A branch that begins by itself, where nothing is computed while nothing is active.
    let source = steps("/ L.MW124 INVI", "/ U.E0.4 S.M126.5 / U.E0.5 U.M12.5 S.M124.5 / L.MW124 INVI");
    assert_eq!(Tables { steps: source, ..ONE_BY_ONE }.found(), [""; 0]);
    let skipped: &'static str = format!("L.MW12 L.0 ==I BEB / {source}").leak();
    check(Tables { steps: skipped, ..ONE_BY_ONE }, &["Q011"]);
}

#[derive(Default)]
struct Writer {
    steps: usize,
    transitions: Vec<(Vec<usize>, Vec<usize>)>,
}

impl Writer {
    fn step(&mut self) -> usize {
        self.steps += 1;
        self.steps - 1
    }

    /// First and last step.
    fn write(&mut self, block: &Block) -> (usize, usize) {
        match block {
            Block::Step => {
                let step = self.step();
                (step, step)
            }
            Block::Sequence(blocks) => {
                let ends: Vec<(usize, usize)> = blocks.iter().map(|it| self.write(it)).collect();
                for pair in ends.windows(2) {
                    self.transitions.push((vec![pair[0].1], vec![pair[1].0]));
                }
                (ends[0].0, ends[ends.len() - 1].1)
            }
            Block::Alternatives(blocks) | Block::Parallel(blocks) => {
                let (first, last) = (self.step(), self.step());
                let ends: Vec<(usize, usize)> = blocks.iter().map(|it| self.write(it)).collect();
                let (starts, stops): (Vec<usize>, Vec<usize>) = ends.into_iter().unzip();
                if matches!(block, Block::Parallel(_)) {
                    self.transitions.push((vec![first], starts));
                    self.transitions.push((stops, vec![last]));
                } else {
                    self.transitions.extend(starts.iter().map(|it| (vec![first], vec![*it])));
                    self.transitions.extend(stops.iter().map(|it| (vec![*it], vec![last])));
                }
                (first, last)
            }
        }
    }
}

fn bit(step: usize) -> String {
    format!("M{}.{}", 10 + step / 8, step % 8)
}

/// A transition of networks: what it asks for, its steps.
fn network(receptivity: &str, from: &[usize], to: &[usize]) -> String {
    let mut text = "NETWORK\n".to_owned();
    from.iter().for_each(|it| writeln!(text, "U {}", bit(*it)).expect("a string"));
    text += receptivity;
    to.iter().for_each(|it| writeln!(text, "S {}", bit(*it)).expect("a string"));
    from.iter().for_each(|it| writeln!(text, "R {}", bit(*it)).expect("a string"));
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// A correct chart, correctly coded: recovered as it was, and nothing is said of it.
    #[test]
    fn what_was_coded_is_recovered(block in block(2)) {
        let mut writer = Writer::default();
        let (first, last) = writer.write(&block);
        let (a, b) = (writer.step(), writer.step());
        writer.transitions.extend([(vec![last], vec![a]), (vec![a], vec![b]), (vec![b], vec![first])]);
        let receptivity = |at: usize| format!("U(\nL MW 80\nL {at}\n==I\n)\n");
        let code: String =
            writer.transitions.iter().enumerate().rev().map(|(at, it)| network(&receptivity(at), &it.0, &it.1)).collect();
        let start = ob(100, &format!("SET\nS {}\n", bit(first)));
        let main = ob(1, &code);
        let sorted = |it: &[usize]| {
            let mut names: Vec<String> = it.iter().map(|it| bit(*it)).collect();
            names.sort();
            names
        };
        let expected: Transitions = writer.transitions.iter().map(|it| (sorted(&it.0), sorted(&it.1))).collect();
        let all: Vec<usize> = (0..writer.steps).collect();
        prop_assert_eq!(recovered(&[("OB1", main.clone()), ("OB100", start.clone())]), [(sorted(&all), expected)]);
        prop_assert_eq!(found(&(main + &start)), [""; 0]);
    }
}

const RECEPTIVITIES: [&str; 5] = ["U E0.0\n", "UN E0.0\n", "U E0.1\n", "U E0.0\nU E0.1\n", "U E0.2\nUN E0.1\n"];

fn holds(receptivity: usize, inputs: u8) -> bool {
    let bit = |n: u8| inputs >> n & 1 == 1;
    match receptivity {
        0 => bit(0),
        1 => !bit(0),
        2 => bit(1),
        3 => bit(0) && bit(1),
        _ => bit(2) && !bit(1),
    }
}

#[derive(Debug, Clone)]
struct Drawn {
    from: BTreeSet<usize>,
    to: BTreeSet<usize>,
    receptivity: usize,
}

type Steps = BTreeSet<usize>;

/// All situations by the rules of evolution, of branches of one step the first that can be taken.
fn situations(drawn: &[Drawn]) -> BTreeSet<Steps> {
    let mut known = BTreeSet::new();
    let mut open: Vec<Steps> = vec![[0].into()];
    while let Some(steps) = open.pop() {
        if !known.insert(steps.clone()) {
            continue;
        }
        for inputs in 0..8 {
            let (mut off, mut on) = (Steps::new(), Steps::new());
            for it in drawn.iter().filter(|it| it.from.is_subset(&steps) && holds(it.receptivity, inputs)) {
                if it.from.is_disjoint(&off) {
                    off.extend(&it.from);
                    on.extend(&it.to);
                }
            }
            open.push(steps.difference(&off).chain(&on).copied().collect());
        }
    }
    known
}

/// By running the code: steps that go on and off in one scan, or go off though the rules keep them on; steps that one branch
/// takes from another one.
fn simulate(drawn: &[Drawn]) -> (Steps, Steps) {
    let (mut passed, mut shadowed) = (Steps::new(), Steps::new());
    for start in situations(drawn) {
        for inputs in 0..8 {
            let mut now = start.clone();
            let mut crossed = vec![false; drawn.len()];
            for (at, it) in drawn.iter().enumerate() {
                if it.from.is_subset(&now) && holds(it.receptivity, inputs) {
                    crossed[at] = true;
                    now.extend(&it.to);
                    it.from.iter().for_each(|step| {
                        now.remove(step);
                    });
                }
            }
            let valid = |it: &Drawn| it.from.is_subset(&start) && holds(it.receptivity, inputs);
            for (a, first) in drawn.iter().enumerate().filter(|it| crossed[it.0]) {
                for (b, second) in drawn.iter().enumerate().skip(a + 1) {
                    if crossed[b] {
                        let both = first.to.intersection(&second.from).filter(|it| !first.from.contains(it));
                        // On before, the rules keep it only when both are crossed by what held at the start.
                        let is_passed = |it: &&usize| {
                            !now.contains(it)
                                && if start.contains(it) {
                                    valid(first) && valid(second)
                                } else {
                                    first.from.is_subset(&start)
                                }
                        };
                        passed.extend(both.filter(is_passed));
                    } else if valid(first) && valid(second) && first.to != second.to {
                        shadowed.extend(first.from.intersection(&second.from));
                    }
                }
            }
        }
    }
    (passed, shadowed)
}

fn drawn() -> impl Strategy<Value = Vec<Drawn>> {
    let ends = || prop::collection::btree_set(0..5_usize, 1..=2);
    let one = (ends(), ends(), 0..RECEPTIVITIES.len()).prop_filter("ends apart", |it| it.0.is_disjoint(&it.1));
    let one = one.prop_map(|(from, to, receptivity)| Drawn { from, to, receptivity });
    prop::collection::vec(one, 3..=7)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is said is what running the scan and the rules side by side shows.
    #[test]
    fn as_a_scan_does(drawn in drawn()) {
        let list = |it: &BTreeSet<usize>| it.iter().copied().collect::<Vec<usize>>();
        let code: String =
            drawn.iter().map(|it| network(RECEPTIVITIES[it.receptivity], &list(&it.from), &list(&it.to))).collect();
        let blocks = [("OB1", ob(1, &code)), ("OB100", ob(100, "SET\nS M10.0\n"))];
        with_program(&blocks, |program| {
            let [sequence] = &program.sequences().list[..] else { return Ok(()) };
            // Parts of a chart, or conditions written twice, are another chart.
            let used: BTreeSet<usize> = drawn.iter().flat_map(|it| it.from.union(&it.to).copied()).collect();
            if sequence.steps.len() != used.len() || sequence.transitions.len() != drawn.len() || !used.contains(&0) {
                return Ok(());
            }
            let number = |step: usize| (0..5).find(|it| bit(*it) == sequence.name(step)).unwrap();
            let of = |wanted: &[DeviationKind]| -> Steps {
                let all = sequence.deviations.iter().filter(|it| wanted.contains(&it.kind));
                all.map(|it| number(it.step)).collect()
            };
            let (passed, shadowed) = simulate(&drawn);
            use DeviationKind::{Lost, Shadowed, Skipped, Undone};
            prop_assert_eq!(of(&[Skipped, Undone, Lost]), passed, "{}", code);
            prop_assert_eq!(of(&[Shadowed]), shadowed, "{}", code);
            Ok(())
        })?;
    }
}

//! Any bytes: the whole pipeline ends, loses nothing, nests safely, and takes linear time.

use std::path::Path;
use std::time::{Duration, Instant};

use plclint::db::{self, Input};
use plclint::lint::Outcome;
use plclint::lint::settings::{Folders, Overrides, Settings};
use plclint::source::decode::Encoding;
use plclint::source::detect::{self, Dialect, FileHint};
use plclint::source::split::{self, SplitHint};
use plclint::syntax;
use proptest::prelude::*;

const DIALECTS: [Dialect; 9] = [
    Dialect::Auto,
    Dialect::Step7,
    Dialect::Pl7,
    Dialect::Pl7Il,
    Dialect::Pl7St,
    Dialect::Pl7Ld,
    Dialect::Pl7Gr7,
    Dialect::Pl72,
    Dialect::Sfc,
];

fn check(bytes: &[u8], dialect: Dialect, encoding: Option<Encoding>) -> Outcome {
    let hint = FileHint { path: Some(Path::new("hostile.awl")), explicit: true, dialect, family: None };
    let (source, detected) = detect::load(hint, bytes, encoding);
    let spans = split::split(&source.text, detected, &SplitHint::default());
    let mut at = 0;
    for span in &spans {
        let range = std::ops::Range::<usize>::from(span.range);
        assert_eq!(range.start, at, "units tile the text");
        at = range.end;
        let text = &source.text[range];
        assert_eq!(syntax::parse(span.language, text).syntax().text(), text, "no byte is lost");
    }
    assert_eq!(at, source.text.len());
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), ..Overrides::default() };
    let settings = Settings::without_file(Folders::default(), overrides).expect("`all` is a selection");
    let outcome = db::check(vec![Input { path: "hostile.awl".to_owned(), source, detected }], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    for it in &outcome.diagnostics {
        let text = &outcome.files[it.finding.place.file as usize].text;
        let range = std::ops::Range::<usize>::from(it.finding.place.range);
        assert!(text.get(range).is_some(), "a finding lies in its file, between characters");
    }
    outcome
}

const AWL: &str = "FUNCTION FC 1 : VOID\nVAR_TEMP\n a : INT;\nEND_VAR\nBEGIN\nNETWORK\nTITLE = x\n U( ;\n O E 0.0;\n ON M 1.1;\n );\n \
                   L S5T#10S;\n SE T 1;\n SPB M001;\n L DB5.DBW 2;\n L 5;\n +I ;\n T #a;\nM001: CALL FB 1, DB 2 (x := 1);\n BE;\nEND_FUNCTION\n";
const ST: &str = "ST : MAST - SR1\n! (*x*) %L1: IF RE %M0 AND (%MW2[%MW3]:X4 OR %I1.0) THEN %MW4 := SQRT(%MW5) + 16#FF; \
                  ELSIF %X1.T > 10 THEN FOR %MW1 := 0 TO 5 DO INC %MW2; EXIT; END_FOR; ELSE JUMP %L1; END_IF;\n";
const IL: &str = "IL : MAST - SR2\n! %L2: LD %I1.0\n AND(N %M1\n OR([%MW0>5]\n )\n )\n MPS\n ST %Q2.0\n MPP\n [%MW1:=%MW2*3]\n JMPC %L2\n";

const GR7: &str = "GR7 : MAST - P - CHART\nNB_PAGES = 8\nPAGE 0\nINITIAL_STEP 0 AT (C 4,L 3) :\nACTION (N1,ST) : (*PHRASE*) %L1: \
                   IF %X0.T > 5 THEN JUMP %L1; END_IF; (*END_PHRASE*) END_ACTION\nACTION (P0,IL) : ! LD %I1.0 S %M5 END_ACTION\n\
                   END_STEP\nTRANSITION (*go*) (ST) AT (C 4,L 4) : %M0 := %M1 END_TRANSITION\nT_S_OR_LINK FROM (C 4,L 4) TO \
                   (C 4,L 3) := [H_LINK FROM (C 4,L 4) TO (C 5,L 4)]\nDEST_CONNECTOR 1 AT (C 4,L 5)\nEND_PAGE\nPAGE 1\n\
                   SOURCE_CONNECTOR 0 AT (C 0,L 0)\nSTEP 1 AT (C 0,L 1) :\nACTION (P1,LD) : RUNG\nH_LINK(10),COIL(%M0);\nEND_RUNG \
                   END_ACTION\nEND_STEP\nEND_PAGE\n";
const SFC: &str = "INITIAL_STEP X0 : END_STEP\nSTEP X1 : Fill(N); %Q2.1(S); END_STEP\nTRANSITION FROM X0 TO (X1,X2) := %I1.0; \
                   END_TRANSITION\nACTION Fill : %Q2.0 := TRUE; END_ACTION\n";
const LD: &str = "LD : MAST - SR3\nRUNG (*x*) %L3:\nOPEN_CONTACT(%I1.0),SHORT_CIRCUIT,BLOCK(%TM0),H_LINK(6),COIL(%Q2.0);\n\
                  P_CONTACT(%M1),H_LINK,EMPTY_CELL(9);\nCOMPARE %MW0>5 END_BLOCK,H_LINK(5),OPERATE %MW1:=%MW2[%MW3] END_BLOCK;\n\
                  EMPTY_LINE;\nEMPTY_CELL(2),V_LINK,BLOCK(%C8),H_LINK(4),JUMP_COIL(%L3);\nEND_RUNG\n";
const PL7_2: &str = "LD : PL7-2 - PRL\nRUNG (*x*) L3:\nOPEN_CONTACT(I0,05),SHORT_CIRCUIT,BLOCK(T0),H_LINK(5),COIL(O1,3);\n\
                     CLOSED_CONTACT(%B1),H_LINK,EMPTY_CELL(8);\nCOMPARE W0 > = H'5' END_BLOCK,H_LINK(5),OPERATE W5(W10) -> B0[8] \
                     END_BLOCK;\nH_LINK(7),OPERATE SLC 3 W1 -> W2 END_BLOCK;\nEND_RUNG\nRUNG L4:\nOPEN_CONTACT(W5,A),\
                     BLOCK(WEEK(W1,CW2)),H_LINK(6),JUMP_COIL(L3);\nEND_RUNG\nGR7 : PL7-2 - SEQ\nPAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) :\n\
                     ACTION (N1,LD) : RUNG L1:\nOPEN_CONTACT(X0),H_LINK(8),SAVE_COIL(B2);\nEND_RUNG END_ACTION\nEND_STEP\n\
                     TRANSITION (LD) AT (C 0,L 2) : RUNG\nOPEN_CONTACT(I1,B),H_LINK(8);\nEND_RUNG END_TRANSITION\nEND_PAGE\n";

fn mutated(base: &'static str) -> impl Strategy<Value = Vec<u8>> {
    let edits = prop::collection::vec((any::<prop::sample::Index>(), 0_usize..6, any::<u8>()), 1..12);
    edits.prop_map(move |edits| {
        let mut bytes = base.as_bytes().to_vec();
        for (at, what, byte) in edits {
            let at = at.index(bytes.len() + 1).min(bytes.len().saturating_sub(1));
            match what {
                0 => bytes.truncate(at),
                1 => bytes.insert(at, byte),
                2 => bytes.insert(at, b'('),
                3 => bytes.insert(at, b'\n'),
                4 if !bytes.is_empty() => {
                    bytes.remove(at);
                }
                _ => {
                    let copy: Vec<u8> = bytes[at..].iter().take(40).copied().collect();
                    bytes.extend(copy);
                }
            }
            if bytes.is_empty() {
                bytes.push(byte);
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400), dialect in prop::sample::select(&DIALECTS[..])) {
        check(&bytes, dialect, None);
    }

    #[test]
    fn any_text(text in "\\PC{0,200}", dialect in prop::sample::select(&DIALECTS[..])) {
        check(text.as_bytes(), dialect, None);
    }

    #[test]
    fn mutated_code(
        bytes in prop_oneof![mutated(AWL), mutated(ST), mutated(IL), mutated(LD), mutated(GR7), mutated(SFC), mutated(PL7_2)],
        dialect in prop::sample::select(&DIALECTS[..]),
        encoding in prop::sample::select(&[None, Some(Encoding::Windows1252), Some(Encoding::Utf8)][..]),
    ) {
        check(&bytes, dialect, encoding);
    }
}

#[test]
fn deep_nesting_is_reported_and_survived() {
    for text in [
        "U(\n".repeat(100_000),
        format!("! %M0 := {}1{};", "(".repeat(100_000), ")".repeat(100_000)),
        format!("! LD %I1.0\n{}ST %Q2.0", "AND( %M1\n".repeat(100_000)),
        format!("! {}", "IF %M0 THEN ".repeat(100_000)),
        format!("! %MW0 := {}1;", "NOT ".repeat(100_000)),
        format!("! %MW0 := {}1;", "1+".repeat(100_000)),
        format!("! %MW0{}", "[%MW0".repeat(100_000)),
        "(*".repeat(100_000),
        format!("RUNG\nCOMPARE {}", "(".repeat(100_000)),
        format!("RUNG\n{}", "OPERATE ".repeat(100_000)),
        format!("RUNG\nOPERATE {}", "SLC 3 - -> ".repeat(100_000)),
        format!("RUNG\nBLOCK({}", "WEEK(".repeat(100_000)),
        format!("RUNG\n{}", "X(".repeat(100_000)),
        format!("RUNG\n{}COIL(%M0);END_RUNG", "OPEN_CONTACT(%M1),".repeat(20_000)),
        format!("DATA_BLOCK DB 1\n{}", "a : STRUCT\n".repeat(100_000)),
        format!("L MW {}", "[".repeat(100_000)),
        format!("STEP 1 : ACTION (N1,ST) : {}", "IF %M0 THEN ".repeat(50_000)),
        "STEP 1 : ACTION (N1,ST) : ".repeat(20_000),
        "T_S_OR_LINK FROM (C 1,L 1) TO (C 1,L 1) := [".repeat(20_000),
    ] {
        for dialect in [Dialect::Step7, Dialect::Pl7Il, Dialect::Pl7St, Dialect::Pl7Ld, Dialect::Pl7Gr7, Dialect::Pl72]
        {
            check(text.as_bytes(), dialect, None);
        }
    }
}

#[test]
fn odd_files() {
    for bytes in [
        vec![0_u8; 100_000],
        b"\xff\xfeU\0 \0E\0".to_vec(),
        b"\xef\xbb\xbfU E0.0\n= A4.0".to_vec(),
        b"\r".repeat(1000),
        "U E0.0 // \u{e9}\u{2028}\u{85}\n= A4.0".as_bytes().to_vec(),
        b"U E0.0 // \xe9t\xe9\n= A4.0".to_vec(),
        b"U".repeat(10_000_000),
        b"U E 0.0; ".repeat(100_000),
        b"%M0 := %M1; ".repeat(50_000),
    ] {
        for dialect in [Dialect::Auto, Dialect::Step7, Dialect::Step5, Dialect::Pl7St] {
            check(&bytes, dialect, None);
        }
    }
}

#[test]
fn lines_of_ten_megabytes() {
    let mnemonics = syntax::Mnemonics::German;
    for (line, language) in [
        ("U E 0.0; ", syntax::Language::Awl(mnemonics)),
        ("%M0 := %M1; ", syntax::Language::Pl7St),
        ("LD %M0 ST %M1 ", syntax::Language::Pl7Il),
        ("%MW0 = = ( ", syntax::Language::Pl7St),
        ("RUNG COIL(%M0); ", syntax::Language::Pl7Ld),
        ("COMPARE ( ,; ", syntax::Language::Pl7Ld),
        ("RUNG COIL(W5(W1)); ", syntax::Language::Pl72Ld),
        ("U E 0.0 = ( ", syntax::Language::Step5(mnemonics)),
        ("OPERATE W1 + -> ", syntax::Language::Pl72Ld),
    ] {
        let text = line.repeat(10_000_000 / line.len());
        assert!(syntax::parse(language, &text).syntax().text() == text.as_str());
    }
}

/// Twice the text takes about twice the time. The factor is wide, for machines that do other things besides: what it
/// catches is quadratic growth, which shows as a factor of 16 and more.
#[test]
fn time_is_linear() {
    let shapes: [(&str, Dialect); 24] = [
        ("U(\nU E 0.0\n)\n= A 4.0\n", Dialect::Step7),
        ("U E 0.0\nO M 1.0\n", Dialect::Step7),
        ("L MW 2\nL 5\n+I\nT MW 4\n", Dialect::Step7),
        ("U E 0.0\nSPB M1\nM2: NOP 0\n", Dialect::Step7),
        ("U E 0.0\n= M 0.0\nU M 0.0\n= A 4.0\n", Dialect::Step7),
        ("PB #\n:U E 0.0\n:= A 4.0\n:***\n:BE\n", Dialect::Step5),
        (":SPA FB 5\nNAME :X\nEIN :E 0.0\n", Dialect::Step5),
        ("M# :U( :O t# O X3 ) = M 1.0 ***\n", Dialect::Step5),
        ("! %M0 := %M1 OR %M2;\n", Dialect::Pl7St),
        ("! IF %M0 THEN %MW1 := %MW2 + 1; END_IF;\n", Dialect::Pl7St),
        ("! LD %M0\nOR %M1\nST %M2\n", Dialect::Pl7Il),
        ("STEP # AT (C #,L 1) : ACTION (N1,ST) : %L1: %M0 := %M1; JUMP %L1; END_ACTION END_STEP\n", Dialect::Pl7Gr7),
        ("STEP # AT (C #,L 1) : END_STEP TRANSITION (ST) AT (C #,L 2) : %M# END_TRANSITION\n", Dialect::Pl7Gr7),
        ("S_T_AND_LINK FROM (C #,L 1) TO (C 0,L 2)\nSTEP # AT (C #,L 1) : END_STEP\n", Dialect::Pl7Gr7),
        ("SOURCE_CONNECTOR # AT (C #,L 0)\nDEST_CONNECTOR # AT (C #,L 3)\n", Dialect::Pl7Gr7),
        ("STEP X# : A#(N); Fill(N); %M#(N); END_STEP\nACTION A# : %M0 := %M1; END_ACTION\n", Dialect::Sfc),
        ("TRANSITION FROM X# TO (X1,X#) := %M0; END_TRANSITION\n", Dialect::Sfc),
        ("RUNG\nOPEN_CONTACT(%M0),H_LINK(9),COIL(%M1);\nEND_RUNG\n", Dialect::Pl7Ld),
        // All in one rung: networks apart, branches, one row.
        ("OPEN_CONTACT(%M0),H_LINK(9),COIL(%M1);\n", Dialect::Pl7Ld),
        ("OPEN_CONTACT(%M0),SHORT_CIRCUIT,CLOSED_CONTACT(%M1),H_LINK(7),COIL(%M2);\n", Dialect::Pl7Ld),
        ("OPEN_CONTACT(%M0),SHORT_CIRCUIT,V_LINK,", Dialect::Pl7Ld),
        ("RUNG L1:\nOPEN_CONTACT(I0,05),H_LINK(6),OPERATE W5(W1) -> W#(W1) END_BLOCK;\nEND_RUNG\n", Dialect::Pl72),
        ("OPEN_CONTACT(B0),SHORT_CIRCUIT,CLOSED_CONTACT(B1),H_LINK(6),COIL(B2);\n", Dialect::Pl72),
        ("OPEN_CONTACT(B0),SHORT_CIRCUIT,V_LINK,", Dialect::Pl72),
    ];
    for (shape, dialect) in shapes {
        let time = |count: usize| {
            // `#` is the number of the repetition. What is no rung of its own is read as one.
            let is_rung = matches!(dialect, Dialect::Pl7Ld | Dialect::Pl72) && !shape.starts_with("RUNG");
            let repeated: String = (0..count).map(|it| shape.replace('#', &it.to_string())).collect();
            let text = format!("{}{repeated}", if is_rung { "RUNG\n" } else { "" });
            let mut best = Duration::MAX;
            for _ in 0..2 {
                let start = Instant::now();
                check(text.as_bytes(), dialect, None);
                best = best.min(start.elapsed());
            }
            best
        };
        let small = time(250);
        let large = time(4000);
        assert!(large < small * 100 + Duration::from_millis(50), "{shape:?}: {small:?} for 250, {large:?} for 4000");
    }
}

//! PL7 applications as they lie on disk: projects, variables, application files, encrypted blocks.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use std::process::Command;

use plclint::db::{self, Input};
use plclint::lint::Outcome;
use plclint::lint::settings::{Folders, Overrides, Settings};
use plclint::source::detect::{self, Detected, Dialect, FileHint};
use plclint::source::stx;
use plclint::target::Target;
use proptest::prelude::*;
use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

#[path = "../src/source/testing.rs"]
mod testing;

use testing::table;

fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        zip.start_file(*name, options).expect("a new file");
        zip.write_all(bytes).expect("memory");
    }
    zip.finish().expect("memory").into_inner()
}

const INI: &[u8] =
    b"[DOSSIER]\r\nApiCible=TSX 57\r\n[PL7TOOL3]\r\nRefProcess=TSX 3722   V3.0\r\nNomAppli=STATION /  0.0\r\n";
const KEY: [(&str, u8); 5] = [("OBJET", 5), ("IND1", 5), ("IND2", 5), ("IND3", 5), ("IND4", 2)];
const XREF: [(&str, u8); 5] = [("TACHE", 5), ("MODULE", 6), ("POSTECAT", 5), ("OBJECT", 60), ("MODE", 1)];
const CHART: [(&str, u8); 6] =
    [("TACHE", 5), ("MODULE", 6), ("POSTECAT", 5), ("NUMPAGE", 4), ("NUMSSMOD", 4), ("TYPSSMOD", 4)];

fn symbols(rows: &[&[&str]]) -> Vec<u8> {
    table(&[&KEY[..], &[("REPERE", 36), ("SYMBOLE", 32), ("ISCMT", 1)]].concat(), rows)
}

/// A small project: two modules and a chart of MAST, a module of another task.
fn project() -> Vec<u8> {
    let symbols = symbols(&[
        &["VIX", "00002", "00000", "00000", "", "%I2.0", "Départ", "1"],
        &["VQX", "00003", "00000", "00000", "", "%Q3.0", "Pompe", ""],
        &["MW", "00005", "", "", "", "%MW5", "Vitesse", ""],
        &["MW", "00009", "", "", "", "%MW9", "Reste", ""],
        &["MW", "00010", "", "", "", "%MW10", "", ""],
    ]);
    let comments = table(
        &[&KEY[..], &[("CMT1", 20), ("CMT2", 20)]].concat(),
        &[&["VIX", "00002", "00000", "00000", "", "bouton vert (nord)  ", "*) près de la porte"]],
    );
    let instances =
        table(&[("NOMOBJET", 32), ("NOMTYPE", 16), ("COMMENT", 40)], &[&["Cpt_vis", "Cpt_pieces", "vis en boîte"]]);
    let references = table(
        &XREF,
        &[
            &["772", "-8192", "20", "%I2.0", "R"],
            &["772", "-8192", "20", "%Q3.0", "W"],
            &["772", "-8192", "22", "%MW5", "R"],
            &["772", "-8192", "22", "%TM0", "E"],
            &["772", "-8192", "22", "READ_VAR", "E"],
            &["772", "-8191", "24", "%MW6", "R"],
            &["772", "-8191", "24", "%MW6", "W"],
            &["772", "-15616", "69", "%Q3.1", "W"],
            &["772", "-15616", "71", "%X1", "R"],
            &["516", "-8190", "30", "%I2.0", "W"],
        ],
    );
    let chart = table(&CHART, &[&["772", "-15616", "69", "0", "1", "2"], &["772", "-15616", "71", "0", "1", "0"]]);
    archive(&[
        ("EXE/PROG/PL7.BIN", &[0xDD; 64]),
        ("STATION.INI", INI),
        ("PL7.DBF", &symbols),
        ("PL7CMT.DBF", &comments),
        ("INSTANCE.DBF", &instances),
        ("XREF.DBF", &references),
        ("XRG7.DBF", &chart),
    ])
}

fn listing(bytes: &[u8]) -> Result<String, &'static str> {
    stx::listing(bytes, None).map(|it| it.text.to_string())
}

#[test]
fn a_project_is_a_listing_of_its_tables() {
    let expected = "\
[STATION]
PROCESSOR = 'TSX 3722   V3.0'
NAME = 'STATION /  0.0'
[DATA_UNIT]
VAR_GLOBAL
Départ AT %I2.0 (*bouton vert (nord)* ) près de la porte*);
Pompe AT %Q3.0;
Vitesse AT %MW5;
Reste AT %MW9;
Cpt_vis : Cpt_pieces (*vis en boîte*);
END_VAR
[XREF] MAST - module 0
@20
%I2.0 R
%Q3.0 W
@22
%MW5 R
%TM0 E
READ_VAR E
[XREF] MAST - module 1
@24
%MW6 R
%MW6 W
[XREF] MAST - CHART - PAGE 0 %X1
@69
%Q3.1 W
[XREF] MAST - CHART - PAGE 0 - transition 1
@71
%X1 R
[XREF] task 516 - module 2
@30
%I2.0 W
";
    assert_eq!(listing(&project()), Ok(expected.to_owned()));
    assert_eq!(stx::controller(expected), Some("TSX 3722"));
}

#[test]
fn the_controller_of_a_project() {
    let named = |it: &str| Target::of_project(it).and_then(|it| it.controller());
    assert_eq!(named("TSX 3722"), Some("TSX 37-22"));
    assert_eq!(named("TSX 57103"), Some("TSX 57-103"));
    assert_eq!(named("TSX 57999"), Some("TSX 57"), "one of the series");
    assert_eq!(named("TSX 47"), None);
}

fn check(path: &str, bytes: &[u8]) -> Outcome {
    let hint = FileHint { path: Some(Path::new(path)), explicit: true, dialect: Dialect::Auto, family: None };
    let (source, detected) = detect::load(hint, bytes, None);
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), ..Overrides::default() };
    let settings = Settings::without_file(Folders::default(), overrides).expect("`all` is a selection");
    let outcome = db::check(vec![Input { path: path.to_owned(), source, detected }], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    outcome
}

fn found(outcome: &Outcome) -> Vec<(&str, &str, &str)> {
    let all = outcome.diagnostics.iter();
    all.map(|it| (it.finding.rule.code, it.finding.message.as_str(), it.entity.as_str())).collect()
}

#[test]
fn what_a_project_shows() {
    let outcome = check("a.stx", &project());
    let expected = [
        ("N004", "the program does not use `Reste`, the symbol of `%MW9`", "file"),
        ("O007", "`%MW5` (`Vitesse`) is read and never written", "MAST - module 0"),
        ("W004", "`%I2.0` (`Départ`) is an input, which a program cannot write", "task 516 - module 2"),
    ];
    assert_eq!(found(&outcome), expected);
    let notes = &outcome.diagnostics[1].finding.notes;
    assert!(notes.iter().any(|it| it.contains("cross-reference")), "{notes:?}");
    assert_eq!(outcome.files[0].entities, 5);
    assert_eq!(outcome.files[0].not_understood, 0);
}

#[test]
fn without_a_cross_reference_nothing_is_unused() {
    let symbols = symbols(&[&["MW", "00009", "", "", "", "%MW9", "Reste", ""]]);
    let empty = table(&XREF, &[]);
    for files in [&[("PL7.DBF", &symbols[..])][..], &[("PL7.DBF", &symbols), ("XREF.DBF", &empty)]] {
        let outcome = check("a.stx", &archive(files));
        assert_eq!(found(&outcome), []);
        assert!(outcome.files[0].made_of.is_some_and(|it| !it.cross_reference));
    }
}

/// An object or a way of access that is not known may be what seems to be missing.
#[test]
fn what_is_unknown_in_a_table_is_counted_and_silences() {
    for row in [["772", "-8192", "20", "%MW5", "Z"], ["772", "-8192", "20", "%FOO3", "R"]] {
        let references = table(&XREF, &[&["772", "-8192", "20", "%MW5", "R"], &row]);
        let outcome = check("a.stx", &archive(&[("STATION.INI", INI), ("XREF.DBF", &references)]));
        assert_eq!(found(&outcome), [], "{row:?}");
        assert_eq!(outcome.files[0].not_understood > 0, row[4] == "Z");
    }
}

#[test]
fn archives_that_are_no_project_or_damaged() {
    assert_eq!(listing(&archive(&[("a.txt", b"x")])), Err(stx::NO_PROJECT));
    assert_eq!(listing(b"PK\x03\x04"), Err(stx::DAMAGED));
    assert_eq!(listing(&archive(&[("XREF.DBF", b"not a table")])), Err("the table XREF.DBF is damaged"));
    let good = project();
    for cut in (0..good.len()).step_by(97) {
        assert_eq!(listing(&good[..cut]), Err(stx::DAMAGED), "cut at {cut}");
    }
    let (_, detected) =
        detect::load(FileHint { path: Some(Path::new("a.stx")), ..FileHint::default() }, b"PK\x03\x04", None);
    assert_eq!(detected, Detected::Unreadable { why: stx::DAMAGED });
}

#[test]
fn an_archive_that_unpacks_to_too_much_is_left() {
    let zeros = vec![0; 65 << 20];
    let bomb = archive(&[("STATION.INI", &zeros)]);
    assert!(bomb.len() < 1 << 20);
    assert_eq!(listing(&bomb), Err(stx::TOO_LARGE));
    // Together they are too large as well.
    let half = &zeros[..40 << 20];
    assert_eq!(listing(&archive(&[("STATION.INI", half), ("PL7.DBF", half)])), Err(stx::TOO_LARGE));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_in_an_archive(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        tail in prop::collection::vec(any::<u8>(), 0..64),
    ) {
        let mut bytes = project();
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        check("a.stx", &bytes);
        check("a.stx", &[b"PK\x03\x04", &tail[..]].concat());
        check("a.stx", &[&bytes[..], &tail].concat());
    }

    #[test]
    fn any_bytes_in_its_tables(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8),
        row in "(\\PC|[\r\n\\[@;%(*)]){0,40}",
    ) {
        let row: String = row.chars().filter(|it| u32::from(*it) < 256).collect();
        let symbols = symbols(&[&["MW", "1", "", "", "", "%MW1", &row, ""], &["MW", "1", "", "", "", &row, "Pompe", ""]]);
        let mut references = table(&XREF, &[&[&row, "-8192", "20", "%MW5", "R"], &["772", &row, "20", &row, "W"]]);
        for (at, byte) in edits {
            let at = at.index(references.len());
            references[at] = byte;
        }
        check("a.stx", &archive(&[("STATION.INI", row.as_bytes()), ("PL7.DBF", &symbols), ("XREF.DBF", &references)]));
    }
}

const VARIABLES: &str = "[HEADER]\nDATE = date#2024-03-01\n[DATA_UNIT]\nVAR_GLOBAL\n\
    Pump AT %Q2.0 : EBOOL (*north (old) tank*); Motor AT %Q2.1 : EBOOL;\nCpt_vis : Cpt_pieces;\nEND_VAR\n[EOF]\n";
const MAIN: &str = "[SOURCE_UNIT]\nSU_TYPE = PROG NAME = 'MAST_MAIN' LANGUAGE = ST BODY =\nADDRESS = MAST MAIN\nPROGRAM\n\
    (*PHRASE*) Pump := %I1.0; (*END_PHRASE*)\n(*PHRASE*) %Q2.0 := %I1.1; (*END_PHRASE*)\nEND_PROGRAM\n[EOF]\n";

fn application() -> String {
    let vendor = "[VENDOR]\nNB_TM = 64\n{binary} ;; 12 (*PHRASE*\n";
    format!("[HEADER]\n[APPLICATION]\nNAME = 'Peinture'\n{vendor}{}{VARIABLES}", MAIN.replace("[EOF]\n", ""))
}

fn run(folder: &Path, arguments: &[&str]) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plclint"));
    command.current_dir(folder).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").env("TERM", "dumb");
    let output = command.arg("check").args(arguments).output().expect("the program starts");
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("output is UTF-8");
    (text(&output.stdout), text(&output.stderr))
}

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let file = |path: &str, bytes: &[u8]| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    };
    file("project/plant.stx", &project());
    file("project/broken.stx", b"PK\x03\x04 and no more");
    file("export/variables.scy", VARIABLES.as_bytes());
    file("export/main.st", MAIN.as_bytes());
    file("application/plant.fef", application().as_bytes());
    file("application/secret.ufb", b"[HEADER]\nDATE = x\n[SOURCE_UNIT]\nA9F0\n");
    folder
}

#[test]
fn a_folder_with_everything() {
    let folder = folder();
    let (out, _) = run(folder.path(), &["--format", "concise", "--ignore", "P008"]);
    let lines: Vec<&str> = out.lines().collect();
    let expected = [
        "application/plant.fef:12:12: W001[single-write] warning: `Pump` (`%Q2.0`) is assigned in more than one place \
         [MAST - MAIN]",
        "export/main.st:6:12: W001[single-write] warning: `Pump` (`%Q2.0`) is assigned in more than one place [MAST - MAIN]",
        "project/plant.stx: O007[read-never-written] warning: `%MW5` (`Vitesse`) is read and never written \
         [MAST - module 0, place 22: %MW5 R]",
        "project/plant.stx: W004[write-to-read-only] error: `%I2.0` (`Départ`) is an input, which a program cannot write \
         [task 516 - module 2, place 30: %I2.0 W]",
        "application/secret.ufb: not read: encrypted PL7 DFB type (UFB) is not supported",
        "project/broken.stx: not read: damaged archive",
    ];
    assert_eq!(lines[..lines.len() - 1], expected);
    let summary = lines[lines.len() - 1];
    for part in [
        "4 files, 7 programs and blocks",
        // The vendor's part of the application.
        "98 % understood",
        "left out: 1 unreadable, 1 × encrypted PL7 DFB type (UFB)",
        "of 1 PL7 project the cross-reference is read, not the code",
    ] {
        assert!(summary.contains(part), "{part}: {summary}");
    }
}

/// An application and exports of its parts: two programs, and the exported variables belong to the exported sections.
#[test]
fn an_application_beside_exports_of_its_parts() {
    let folder = TempDir::new().expect("a temporary folder");
    let write = |path: &str, text: &str| fs::write(folder.path().join(path), text).expect("a file");
    write("main.st", MAIN);
    write("plant.fef", &application().replace("Motor AT %Q2.1", "Fan AT %Q2.7"));
    write("variables.scy", VARIABLES);
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "W001,N004,N001"]);
    let lines: Vec<&str> = out.lines().collect();
    let expected = [
        "main.st:6:12: W001[single-write] warning: `Pump` (`%Q2.0`) is assigned in more than one place [MAST - MAIN]",
        "plant.fef:12:12: W001[single-write] warning: `Pump` (`%Q2.0`) is assigned in more than one place [MAST - MAIN]",
        "plant.fef:18:45: N004[symbol-unused] note: the program does not use `Fan`, the symbol of `%Q2.7` [file]",
        "variables.scy:5:45: N004[symbol-unused] note: the program does not use `Motor`, the symbol of `%Q2.1` [file]",
    ];
    assert_eq!(lines[..lines.len() - 1], expected);
    // A second version of the section: the variables are for each of the two, and what one does not use says nothing.
    write("old.st", MAIN);
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "W001,N004,N001"]);
    let lines: Vec<&str> = out.lines().collect();
    let old = expected[0].replace("main.st", "old.st");
    assert_eq!(lines[..lines.len() - 1], [expected[0], &old, expected[1], expected[2]]);
    let summary = lines[lines.len() - 1];
    assert!(summary.contains("; 2 files define what others of the folder define too"), "{summary}");
    // What the variables have wrong is said once.
    write("variables.scy", &VARIABLES.replace("Motor AT", "_Motor AT"));
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "N001"]);
    assert_eq!(out.matches("N001").count(), 1, "{out}");
}

/// Findings of a text that is given as one file.
fn findings_of(path: &str, text: &str) -> Vec<(String, String, String)> {
    let outcome = check(path, text.as_bytes());
    outcome.diagnostics.into_iter().map(|it| (it.finding.rule.code.into(), it.entity, it.finding.message)).collect()
}

#[test]
fn parts_of_pl7_and_of_pl7_2_in_one_text() {
    let rung =
        |input: &str, operand: &str| format!("RUNG L1:\nOPEN_CONTACT({input}),H_LINK(8),COIL({operand});\nEND_RUNG\n");
    let text = format!("LD : MAST - MAIN\n{}LD : PL7-2 - MAST\n{}", rung("%M0", "%M1"), rung("I0,00", "B1"));
    let outcome = check("both.txt", text.as_bytes());
    assert!(outcome.unread.is_empty(), "{:?}", outcome.unread);
    let [file] = &outcome.files[..] else { panic!("one file") };
    assert_eq!((file.not_understood, file.entities, file.dialect.as_str()), (0, 2, "PL7 and PL7-2"));
    assert_eq!(outcome.diagnostics.iter().filter(|it| it.finding.rule.code == "X001").count(), 0);
    // Each is a program of its own: the bit of one is not written in the other.
    let twice = format!("{text}LD : PL7-2 - POST\n{}", rung("I0,01", "B1"));
    let found = findings_of("both.txt", &twice);
    assert!(found.iter().any(|it| it.0.starts_with('W') && it.2.contains("`B1`")), "{found:?}");
    assert!(!found.iter().any(|it| it.0.starts_with('W') && it.2.contains("`%M1`")), "{found:?}");
}

#[test]
fn a_part_in_a_language_that_pl7_2_does_not_have() {
    let found =
        findings_of("both.txt", "ST : MAST - MAIN\n! %M1 := %I1.0;\n\n(* A *)\nST : PL7-2 - FAST\n! %M2 := %M1;\n");
    let conflicts: Vec<_> = found.iter().filter(|it| it.0 == "X001").collect();
    let [(_, entity, message)] = &conflicts[..] else { panic!("{found:?}") };
    assert_eq!(entity, "FAST - MAIN");
    assert!(message.starts_with("PL7-2 has ladder and Grafcet"), "{message}");
}

/// What a page lacks is told where a heading says what the chart is, whichever page it is.
#[test]
fn every_page_of_a_chart_is_under_its_heading() {
    let page = |number: u32, step: u32, action: &str| {
        let next = step + 1;
        format!(
            "PAGE {number}\nINITIAL_STEP {step} AT (C 0,L 1) :\nEND_STEP\n\
             TRANSITION (ST) AT (C 0,L 2) : (*PHRASE*) %I1.{step} (*END_PHRASE*) END_TRANSITION\n\
             STEP {next} AT (C 0,L 3) :\n\
             ACTION (P1,ST) : (*PHRASE*) {action}; (*END_PHRASE*) END_ACTION\nEND_STEP\n\
             TRANSITION (ST) AT (C 0,L 4) : (*PHRASE*) %X{next}.T > 50 (*END_PHRASE*) END_TRANSITION\n\
             DEST_CONNECTOR {step} AT (C 0,L 5)\nSOURCE_CONNECTOR {next} AT (C 0,L 0)\nEND_PAGE\n"
        )
    };
    let chart = |second: &str| format!("{}{}", page(0, 0, "INC %MW1"), page(1, 4, second));
    let codes = |text: &str| -> Vec<String> { findings_of("a.gr7", text).into_iter().map(|it| it.0).collect() };
    let headed = |second: &str| codes(&format!("GR7 : MAST - P - CHART\n{}", chart(second)));
    assert!(headed("SET %Q2.0").contains(&"G011".to_owned()), "{:?}", headed("SET %Q2.0"));
    assert!(!headed("INC %MW2").contains(&"G011".to_owned()));
    assert!(!codes(&chart("SET %Q2.0")).contains(&"G011".to_owned()), "a part of a chart");
}

/// A DFB type that somebody saved without the frame of the exchange format belongs to the sections beside it.
#[test]
fn a_dfb_type_without_a_frame() {
    let folder = TempDir::new().expect("a temporary folder");
    let write = |path: &str, text: &str| fs::write(folder.path().join(path), text).expect("a file");
    write("main.st", &MAIN.replace("Pump := %I1.0", "Cpt_vis(%I1.0, Pump)"));
    write("variables.scy", VARIABLES);
    let dfb = "(* Compteur *)\nFUNCTION_BLOCK Cpt_pieces\nVAR_INPUT\n Count : EBOOL;\nEND_VAR\nVAR_OUTPUT\n Done : BOOL;\n\
               END_VAR\nVAR\n V_cour : WORD;\nEND_VAR\nIF RE Count THEN\n INC V_cour;\nEND_IF;\nDone := V_cour > 9;\n\
               %M5 := Done;\nEND_FUNCTION_BLOCK\n";
    write("cpt_pieces.txt", dfb);
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "W001,F"]);
    let lines: Vec<&str> = out.lines().collect();
    let expected = [
        "cpt_pieces.txt:16:1: F007[dfb-global-object] error: `%M5` belongs to the application, which the code of a DFB \
         cannot reach [FUNCTION_BLOCK Cpt_pieces]",
        "main.st:6:12: W001[single-write] warning: `Pump` (`%Q2.0`) is assigned in more than one place [MAST - MAIN]",
    ];
    assert_eq!(lines[..lines.len() - 1], expected);
}

/// A binary file has no lines: no report gives any.
#[test]
fn places_in_a_project() {
    let folder = folder();
    let (human, _) = run(folder.path(), &["project/plant.stx"]);
    assert!(human.contains("╭─[ project/plant.stx ]\n   │ MAST - module 0, place 22: %MW5 R\n"), "{human}");

    let (json, _) = run(folder.path(), &["project/plant.stx", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let finding = &json["findings"][0];
    assert_eq!(finding["entry"], "MAST - module 0, place 22: %MW5 R");
    assert!(finding["start"].is_null() && finding["end"].is_null());

    let (sarif, _) = run(folder.path(), &["project/plant.stx", "--format", "sarif"]);
    let sarif: serde_json::Value = serde_json::from_str(&sarif).expect("JSON");
    let run = &sarif["runs"][0];
    assert!(run["artifacts"][0]["encoding"].is_null() && run["artifacts"][0]["length"].is_null());
    let result = &run["results"][0];
    let location = &result["locations"][0];
    assert_eq!(location["physicalLocation"]["artifactLocation"]["uri"], "project/plant.stx");
    assert!(location["physicalLocation"]["region"].is_null());
    let logical = &location["logicalLocations"][0];
    assert_eq!(logical["name"], "%MW5 R");
    assert_eq!(logical["fullyQualifiedName"], "MAST - module 0, place 22: %MW5 R");
    assert!(result["message"]["text"].as_str().is_some_and(|it| it.contains("(MAST - module 0, place 22: %MW5 R)")));
}

const SYMLIST: [(&str, u8); 5] = [("_SKZ", 24), ("_OPIEC", 12), ("_OPHIST", 12), ("_DATATYP", 10), ("_COMMENT", 80)];

/// A STEP 7 project as its tool leaves it on disk: the file of the project, sources in numbered folders, the symbol table in
/// a numbered folder of its own, and tables of the tool.
fn step7_project(root: &Path, sources: &[(&str, &str)], symbols: &[&[&str]]) {
    let file = |path: &str, bytes: &[u8]| {
        let path = root.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    };
    file("plant.s7p", b"\x00\x01plant\x00 no text");
    for (path, text) in sources {
        file(path, text.as_bytes());
    }
    file("s7asrcom/S7CNTREF.DBF", &table(&[("ID", 5)], &[&["1"]]));
    file("YDBs/SYMLISTS.DBF", &table(&[("_DBPATH", 10)], &[&["10394"]]));
    file("YDBs/10394/SYMLIST.DBF", &table(&SYMLIST, symbols));
    file("ombstx/offline/00000001/BAUSTEIN.DBF", &table(&[("ID", 5)], &[]));
}

#[test]
fn a_project_folder_of_step_7() {
    let folder = TempDir::new().expect("a temporary folder");
    let main = "ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n      CALL \"Pumps\"\n      U     \"Start\"\n      =     \"Pump\"\nEND_ORGANIZATION_BLOCK\n";
    // In the other mnemonic set, and by the address: it is the same pump.
    let pumps = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      A     I 0.1;\n      =     Q 4.0;\n      A     \"Missing\";\n      =     \"L\u{e4}mpchen\";\nEND_FUNCTION\n";
    let sources = [("s7asrcom/00000001/00000001.AWL", main), ("s7asrcom/00000001/00000002.awl", pumps)];
    let symbols: [&[&str]; 5] = [
        &["Start", "I       0.0", "E       0.0", "BOOL", ""],
        &["Pump", "Q       4.0", "A       4.0", "BOOL", "north"],
        &["Pumps", "FC      1", "FC      1", "FC      1", ""],
        &["L\u{e4}mpchen", "Q       4.1", "A       4.1", "BOOL", ""],
        &["Old", "", "A       4.7", "BOOL", ""],
    ];
    step7_project(&folder.path().join("plant"), &sources, &symbols);
    // Beside it, one with other names for the same addresses.
    let other: [&[&str]; 1] = [&["Fan", "Q       4.0", "A       4.0", "BOOL", ""]];
    let fan = [(
        "S7ASRCOM/00000007/1.AWL",
        "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      U     E 0.0\n      =     \"Fan\"\n      U     \"Pump\"\n      S     M 0.0\nEND_FUNCTION\n",
    )];
    step7_project(&folder.path().join("fans"), &fan, &other);
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "W001,B012,N004,X001"]);
    let lines: Vec<&str> = out.lines().collect();
    let expected = [
        "fans/S7ASRCOM/00000007/1.AWL:6:13: B012[call-parameter] error: `\"Pump\"` is not in the symbol table [FC1]",
        "plant/YDBs/10394/SYMLIST.DBF:5:2: N004[symbol-unused] note: the program does not use `Old`, the symbol of `A4.7` [file]",
        "plant/s7asrcom/00000001/00000002.awl:5:13: W001[single-write] warning: `\"Pump\"` (`Q4.0`) is assigned in more than one \
         place [FC1]",
        "plant/s7asrcom/00000001/00000002.awl:6:13: B012[call-parameter] error: `\"Missing\"` is not in the symbol table [FC1]",
    ];
    assert_eq!(lines[..lines.len() - 1], expected);
    assert!(lines[lines.len() - 1].starts_with("5 files, 3 programs and blocks"), "{out}");
    // Both places of the pump, each in its source.
    let (out, _) = run(folder.path(), &["--format", "json", "--select", "W001"]);
    let report: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    let finding = &report["findings"][0];
    assert_eq!(finding["related"][0]["path"], "plant/s7asrcom/00000001/00000001.AWL");
    assert_eq!(finding["related"][0]["start"]["line"], 6);
    // Compiled blocks are not read: what is missing may be in them.
    let blocks = folder.path().join("plant/ombstx/offline/00000001/SUBBLK.DBF");
    fs::write(blocks, table(&[("ID", 5)], &[])).expect("a file");
    let (out, _) = run(folder.path(), &["--format", "concise", "--select", "W001,B012,N004,X001"]);
    let lines: Vec<&str> = out.lines().collect();
    let unread =
        "plant/ombstx/offline/00000001/SUBBLK.DBF: not read: compiled STEP 7 blocks (SUBBLK.DBF) is not supported";
    assert_eq!(lines[..lines.len() - 1], [expected[0], expected[2], unread]);
    // Without its table, the symbols are names that nothing resolves, and the pump is driven once.
    fs::remove_file(folder.path().join("plant/YDBs/10394/SYMLIST.DBF")).expect("a file");
    let (out, _) = run(&folder.path().join("plant"), &["--format", "concise", "--select", "W001,B012,N004,X001"]);
    assert_eq!(out.lines().filter(|it| it.contains("[FC1]")).count(), 0, "{out}");
}

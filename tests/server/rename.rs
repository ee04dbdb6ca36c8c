//! Another name for what a program of Siemens declares.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use crate::client::{Client, able};
use crate::edits::program;
use crate::requests::{at, edited, locations};

const SYMBOLS: &str = "\"Motor\",\"FB      1\",\"FB      1\",\"starts and stops\"
\"Data\",\"DB     10\",\"DB     10\",\"\"
\"Lamp\",\"A       4.0\",\"BOOL\",\"red\"
";

const BLOCKS: &str = "TYPE UDT 1
STRUCT
  on : BOOL;
  lamp : INT;
END_STRUCT
END_TYPE
FUNCTION_BLOCK \"Motor\"
VAR_INPUT
  Go : BOOL;
END_VAR
VAR
  state : UDT 1;
  old : ARRAY [1..2] OF UDT 1;
END_VAR
BEGIN
      U     #Go;
      U     GO;
      =     #state.on;
      U     old[2].on;
      =     \"Lamp\";
      SPB   go;
go:   NOP   0;
END_FUNCTION_BLOCK
DATA_BLOCK DB 10
STRUCT
  state : UDT 1;
  go : INT;
END_STRUCT
BEGIN
  state.on := TRUE;
  go := 1;
END_DATA_BLOCK
DATA_BLOCK DB 1
  FB 1
BEGIN
  state.on := TRUE;
END_DATA_BLOCK
FUNCTION FC 1 : INT
BEGIN
      L     5;
      T     #RET_VAL;
END_FUNCTION
ORGANIZATION_BLOCK OB 1
BEGIN
      CALL  FC 1 (
           RET_VAL := MW 2);
      CALL  \"Motor\" , DB 1 (
           Go := \"Data\".state.on);
      CALL  FB 1 , DB 1 (
           go := Lamp);
      L     \"Data\".go;
      L     DB10.state.lamp;
      U     DB1.state.on;
      L     P##lamp;
      SPBN  go;
go:   NOP   0;
END_ORGANIZATION_BLOCK
";

fn rename(
    client: &mut Client,
    path: &str,
    text: &str,
    (needle, within): (&str, usize),
    new: &str,
) -> Result<Value, i32> {
    let mut params = at(client, path, text, needle, within);
    params["newName"] = json!(new);
    client.try_ask("textDocument/rename", params)
}

/// Replaces a word in lines, counted from 1.
fn with(text: &str, lines: &[usize], old: &str, new: &str) -> String {
    let lines = text.split_inclusive('\n').zip(1..).map(|(line, at)| {
        let is_changed = lines.contains(&at);
        assert!(!is_changed || line.contains(old), "{line}");
        if is_changed { line.replacen(old, new, 1) } else { line.to_owned() }
    });
    lines.collect()
}

#[test]
fn symbols_of_siemens_are_renamed_with_their_tables() {
    let mut client = Client::start(able(), &[("a.awl", BLOCKS), ("a.sdf", SYMBOLS)]);
    let edit = rename(&mut client, "a.awl", BLOCKS, ("\"Lamp\"", 1), "red lamp, left").unwrap_err();
    assert_eq!(edit, -32803, "it stands without quotation marks in a call");
    for quoted in ["Light", "\"Light\""] {
        let edit = rename(&mut client, "a.awl", BLOCKS, ("\"Lamp\"", 1), quoted).unwrap();
        assert_eq!(
            edited(&client, &edit, "a.awl", BLOCKS),
            BLOCKS.replace("Lamp", "Light"),
            "not the field of that name"
        );
        assert_eq!(edited(&client, &edit, "a.sdf", SYMBOLS), SYMBOLS.replace("Lamp", "Light"));
    }
    let edit = rename(&mut client, "a.sdf", SYMBOLS, ("Motor", 0), "Moteur à bande").unwrap();
    assert_eq!(edited(&client, &edit, "a.awl", BLOCKS), BLOCKS.replace("\"Motor\"", "\"Moteur à bande\""));
    assert_eq!(edited(&client, &edit, "a.sdf", SYMBOLS), SYMBOLS.replace("Motor", "Moteur à bande"));
    for wrong in ["", "data", "a \"b\"", "\t", "more than twenty-four characters", "M1.0", "1st", "STW"] {
        assert_eq!(rename(&mut client, "a.awl", BLOCKS, ("\"Lamp\"", 1), wrong), Err(-32803), "{wrong}");
    }
    assert!(rename(&mut client, "a.awl", BLOCKS, ("\"Lamp\"", 1), "LAMP").is_ok(), "its own name in other letters");
    client.stop();
}

#[test]
fn what_programs_name_that_are_not_read_keeps_its_name() {
    let scl = "FUNCTION FC 9 : VOID\nBEGIN\n  IF \"LAMP\" THEN\n    FB1.DB1(Go := TRUE);\n    old := 1;\n  END_IF;\nEND_FUNCTION\n";
    let mut client = Client::start(able(), &[("a.awl", BLOCKS), ("a.sdf", SYMBOLS), ("b.scl", scl)]);
    for (place, new) in [(("\"Lamp\"", 1), "Light"), (("Go : BOOL", 1), "Start")] {
        assert_eq!(rename(&mut client, "a.awl", BLOCKS, place, new), Err(-32803), "{new}");
    }
    assert!(rename(&mut client, "a.awl", BLOCKS, ("\"Lamp\"", 1), "LAMP").is_ok());
    // What is named there as something else, or not at all.
    for (place, new) in [(("state : UDT", 1), "now"), (("\"Motor\"", 1), "Moteur"), (("on : BOOL", 1), "up")] {
        assert!(rename(&mut client, "a.awl", BLOCKS, place, new).is_ok(), "{new}");
    }
    client.stop();
}

#[test]
fn what_blocks_declare_is_renamed_wherever_it_is_named() {
    let mut client = Client::start(able(), &[("a.awl", BLOCKS), ("a.sdf", SYMBOLS)]);
    let mut after = |place, new| {
        let edit = rename(&mut client, "a.awl", BLOCKS, place, new).unwrap();
        edited(&client, &edit, "a.awl", BLOCKS)
    };
    // A parameter: in its block with and without the mark, and in the calls.
    let go = with(&BLOCKS.replace("Go", "Start"), &[17], "GO", "Start");
    let go = with(&go, &[50], "go", "Start");
    assert_eq!(after(("Go : BOOL", 1), "Start"), go);
    assert_eq!(after(("#Go", 0), "#Start"), go, "from the mark before it");
    assert_eq!(after(("go := Lamp", 1), "Start"), go, "from a call");
    // A field of a data block, and none of the same name elsewhere.
    assert_eq!(after(("\"Data\".go", 8), "run"), with(&with(BLOCKS, &[27, 31], "go", "run"), &[51], ".go", ".run"));
    // A component of a type, wherever the type is.
    let on = with(BLOCKS, &[3, 18, 19, 30, 36, 48, 53], "on", "up");
    assert_eq!(after(("on : BOOL", 0), "up"), on);
    assert_eq!(after(("DB1.state.on", 11), "up"), on);
    // A variable of a function block, in its instances too.
    let state = with(BLOCKS, &[12, 18, 36, 53], "state", "now");
    assert_eq!(after(("#state.on", 1), "now"), state);
    assert_eq!(after(("DB1.state.on", 5), "now"), state, "from the middle of a path");
    for wrong in ["old", "OLD", "1a", "a b", "", "STRUCT", "end_var", "INT", "more_than_twenty_four_characters"] {
        assert_eq!(rename(&mut client, "a.awl", BLOCKS, ("#state.on", 1), wrong), Err(-32803), "{wrong}");
    }
    for wrong in ["M1", "T 5", "OV"] {
        let refused = rename(&mut client, "a.awl", BLOCKS, ("Go : BOOL", 1), wrong);
        assert_eq!(refused, Err(-32803), "{wrong}: the block names it without its mark");
    }
    // What nothing declares.
    for (needle, within) in [("P##lamp", 3), ("DB 10", 1), ("TYPE UDT", 1), ("#RET_VAL", 2), ("RET_VAL :=", 1)] {
        assert_eq!(client.ask("textDocument/prepareRename", at(&client, "a.awl", BLOCKS, needle, within)), Value::Null);
    }
    let mut find = |needle: &str, within: usize| {
        let params = at(&client, "a.awl", BLOCKS, needle, within);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("DB1.state.on", 5), ["a.awl:12:3-12:8"], "the middle of a path");
    assert_eq!(find("DB1.state.on", 11), ["a.awl:3:3-3:5"]);
    assert_eq!(find("\"Data\".go", 2), ["a.awl:24:1-24:17"], "the block before a field");
    assert_eq!(find("go := Lamp", 0), ["a.awl:9:3-9:5"], "a parameter in a call");
    client.stop();
}

const DFB: &str = "[HEADER]
STANDARD = 'IEC 1131-3'
[SOURCE_UNIT]
SU_TYPE = DFB
NAME = 'Moteur'
LANGUAGE = ST
BODY =
FUNCTION_BLOCK Moteur
VAR_INPUT
    Cde : BOOL;
END_VAR
VAR_OUTPUT
    Sortie : BOOL;
END_VAR
VAR_PUBLIC
    Nb : WORD;
END_VAR
(*PHRASE*)
IF Cde THEN INC Nb; END_IF;
Sortie := cde;
(*END_PHRASE*)
END_FUNCTION_BLOCK
[EOF]
";

#[test]
fn what_a_dfb_declares_is_renamed_in_it_and_behind_its_instances() {
    let variables = "[HEADER]\nSTANDARD = 'IEC 1131-3'\n[DATA_UNIT]\nVAR_GLOBAL\n    Pompe : Moteur;\n    \
                     Sortie AT %Q2.0 : EBOOL;\n    Nb AT %MW1 : WORD;\nEND_VAR\n[EOF]\n";
    let st = "ST : MAST - MAIN\n! Pompe(%I1.0);\n! Sortie := Pompe.Sortie;\n! Nb := Pompe.nb + %MW5[Pompe.Nb];\n";
    let ladder = "LD : MAST - SR1\nRUNG\nOPEN_CONTACT(Pompe.Sortie),H_LINK(9),COIL(%M1);\nEND_RUNG\n";
    let files = [("a.st", st), ("b.ld", ladder), ("moteur.dfb", DFB), ("v.scy", variables)];
    let mut client = Client::start(able(), &files);
    let mut after = |path, text, place, new| -> Vec<String> {
        let edit = rename(&mut client, path, text, place, new).unwrap();
        files.iter().map(|it| edited(&client, &edit, it.0, it.1)).collect()
    };
    let nb = [
        st.replace("Pompe.nb", "Pompe.Total").replace("Pompe.Nb", "Pompe.Total"),
        ladder.into(),
        DFB.replace("Nb", "Total"),
        variables.into(),
    ];
    assert_eq!(after("moteur.dfb", DFB, ("Nb : WORD", 1), "Total"), nb);
    assert_eq!(after("a.st", st, ("Pompe.nb", 7), "Total"), nb);
    let output = [
        st.replace("Pompe.Sortie", "Pompe.Q"),
        ladder.replace("Pompe.Sortie", "Pompe.Q"),
        DFB.replace("Sortie", "Q"),
        variables.into(),
    ];
    assert_eq!(after("b.ld", ladder, ("Pompe.Sortie", 8), "Q"), output);
    // The symbol of that name is another thing.
    let symbol = [st.replace("! Sortie", "! Vanne"), ladder.into(), DFB.into(), variables.replace("Sortie", "Vanne")];
    assert_eq!(after("a.st", st, ("! Sortie", 3), "Vanne"), symbol);
    let input = [st.into(), ladder.into(), DFB.replace("Cde", "Ordre").replace("cde", "Ordre"), variables.into()];
    assert_eq!(after("moteur.dfb", DFB, ("IF Cde", 4), "Ordre"), input);
    for wrong in ["Nb", "nb", "Pompe", "Trop_long", "é", "_a", "a b", "AND", ""] {
        let refused = rename(&mut client, "moteur.dfb", DFB, ("IF Cde", 4), wrong);
        assert_eq!(refused, Err(-32803), "{wrong}");
    }
    for wrong in ["AND", "Pompe", "_a", "a_"] {
        assert_eq!(rename(&mut client, "a.st", st, ("! Sortie", 3), wrong), Err(-32803), "{wrong}");
    }
    let mut find = |needle: &str, within: usize| {
        let params = at(&client, "a.st", st, needle, within);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("Pompe.Sortie", 7), ["moteur.dfb:13:5-13:11"]);
    assert_eq!(find("Pompe.Sortie", 2), ["v.scy:5:5-5:10"], "the instance before its output");
    client.stop();
}

#[test]
fn columns_of_a_table_stay_where_they_are() {
    let code = "FUNCTION FC 1 : VOID\nBEGIN\n      U     \"Lamp\";\n      =     \"Horn\";\nEND_FUNCTION\n";
    let row = |name: &str, address: &str| format!("126,{name:<24}{address:<12}{:<10}text\n", "BOOL");
    let table = |lamp: &str| row(lamp, "A       4.0") + &row("Horn", "A       4.1");
    let mut client = Client::start(able(), &[("a.awl", code), ("a.asc", &table("Lamp"))]);
    for new in ["L", "Signal lamp, red, left", "123456789012345678901234"] {
        let edit = rename(&mut client, "a.awl", code, ("Lamp", 1), new).unwrap();
        assert_eq!(edited(&client, &edit, "a.asc", &table("Lamp")), table(new));
    }
    client.stop();
    let step5 = "PB 1\n:U -LAMPE\n:= -HUPE\n:BE\n";
    let tabs = "\tA 4.0\tLAMPE\trot\n\tA 4.1\tHUPE\tlaut\n";
    let blanks = "A 4.0   LAMPE      rot\nA 4.1   HUPE       laut\n";
    let mut client = Client::start(able(), &[("a.s5", step5), ("AZ0.SEQ", tabs)]);
    let edit = rename(&mut client, "a.s5", step5, ("LAMPE", 1), "-LICHT_ROT").unwrap();
    assert_eq!(edited(&client, &edit, "a.s5", step5), step5.replace("LAMPE", "LICHT_ROT"));
    assert_eq!(edited(&client, &edit, "AZ0.SEQ", tabs), tabs.replace("LAMPE", "LICHT_ROT"));
    for wrong in ["", "a b", "1A", "hupe", "A,B"] {
        assert_eq!(rename(&mut client, "a.s5", step5, ("LAMPE", 1), wrong), Err(-32803), "{wrong}");
    }
    client.stop();
    let mut client = Client::start(able(), &[("a.s5", step5), ("AZ0.SEQ", blanks)]);
    let edit = rename(&mut client, "a.s5", step5, ("LAMPE", 1), "LICHT_ROT").unwrap();
    assert_eq!(edited(&client, &edit, "AZ0.SEQ", blanks), blanks.replace("LAMPE    ", "LICHT_ROT"));
    assert_eq!(rename(&mut client, "a.s5", step5, ("LAMPE", 1), "LICHT_ROT_1"), Err(-32803), "two blanks part fields");
    client.stop();
}

#[test]
fn variants_share_what_a_table_declares() {
    let code = |lamp: &str| {
        format!("FUNCTION FC 1 : VOID\nBEGIN\n      U     \"{lamp}\";\n      =     M 1.0;\nEND_FUNCTION\n")
    };
    let table = "\"Lamp\",\"A 4.0\",\"BOOL\",\"\"\n";
    let mut client =
        Client::start(able(), &[("a.awl", &code("Lamp")), ("b.awl", &code("LAMP")), ("shared.sdf", table)]);
    for (path, text) in [("a.awl", code("Lamp")), ("b.awl", code("LAMP")), ("shared.sdf", table.to_owned())] {
        let needle = if path == "b.awl" { "LAMP" } else { "Lamp" };
        let edit = rename(&mut client, path, &text, (needle, 1), "Horn").unwrap();
        assert_eq!(edited(&client, &edit, "a.awl", &code("Lamp")), code("Horn"), "{path}");
        assert_eq!(edited(&client, &edit, "b.awl", &code("LAMP")), code("Horn"), "{path}");
        assert_eq!(edited(&client, &edit, "shared.sdf", table), table.replace("Lamp", "Horn"), "{path}");
    }
    client.stop();
    let main = |pump: &str, entity: &str| format!("ST : MAST - {entity}\n! {pump} := %I1.0;\n");
    let variables =
        "[HEADER]\nSTANDARD = 'IEC 1131-3'\n[DATA_UNIT]\nVAR_GLOBAL\n    Pump AT %Q2.0 : EBOOL;\nEND_VAR\n[EOF]\n";
    let (a, b) = (main("Pump", "MAIN"), main("Pump", "MAIN"));
    let mut client = Client::start(able(), &[("a.st", &a), ("b.st", &b), ("shared.scy", variables)]);
    let edit = rename(&mut client, "a.st", &a, ("Pump", 1), "Valve").unwrap();
    for (path, text) in [("a.st", a.as_str()), ("b.st", &b), ("shared.scy", variables)] {
        assert_eq!(edited(&client, &edit, path, text), text.replace("Pump", "Valve"), "{path}");
    }
    client.stop();
    let old = "LD : PL7-2 - POST\nRUNG L1:\nOPEN_CONTACT(Start),H_LINK(8),COIL(Pump);\nEND_RUNG\n";
    let variables = variables.replace("Pump AT %Q2.0 : EBOOL;", "Pump AT O2,0 : BOOL; Start AT I1,0 : BOOL;");
    let mut client = Client::start(able(), &[("old.ld", old), ("old.scy", &variables)]);
    let edit = rename(&mut client, "old.ld", old, ("Pump", 1), "Valve").unwrap();
    assert_eq!(edited(&client, &edit, "old.ld", old), old.replace("Pump", "Valve"));
    assert_eq!(edited(&client, &edit, "old.scy", &variables), variables.replace("Pump", "Valve"));
    assert_eq!(rename(&mut client, "old.ld", old, ("Pump", 1), "start"), Err(-32803));
    client.stop();
}

/// Whatever is renamed, the program is the same: the same rules find the same lines.
#[test]
fn a_program_with_another_name_in_it_is_the_same() {
    let mut able = able();
    able["general"]["positionEncodings"] = json!(["utf-8"]);
    let (mut renamed, mut occurrences) = (0, 0);
    for folder in ["convoyeur-s7-en", "verpackung", "perceuse", "bidons-s5", "ventilation", "traitement-surface"] {
        let files = program(&format!("programs/{folder}"));
        let given: Vec<(&str, &str)> = files.iter().map(|it| (it.0.as_str(), it.1.as_str())).collect();
        let mut client = Client::start(able.clone(), &given);
        let before = lines(&client.check());
        let mut seen = BTreeSet::new();
        for (path, text) in &files {
            let is_start = |(at, it): &(usize, char)| {
                it.is_alphabetic() && !text[..*at].ends_with(|it: char| it.is_alphanumeric() || it == '_')
            };
            let mut asked: BTreeMap<&str, usize> = BTreeMap::new();
            for (offset, _) in text.char_indices().filter(is_start) {
                let word = text[offset..].split(|it: char| !it.is_alphanumeric() && it != '_').next().unwrap();
                let count = asked.entry(word).or_default();
                *count += 1;
                if *count > 4 {
                    continue;
                }
                let before_it = &text[..offset];
                let line_start = before_it.rfind('\n').map_or(0, |it| it + 1);
                let position = json!({ "line": before_it.matches('\n').count(), "character": offset - line_start });
                let params = json!({ "textDocument": client.document(path), "position": position, "newName": "Zq1" });
                let Ok(edit) = client.try_ask("textDocument/rename", params) else { continue };
                // Not of a file that is checked.
                if edit.is_null() {
                    continue;
                }
                // All places of a name ask for the same.
                if !seen.insert(edit.to_string()) {
                    continue;
                }
                renamed += 1;
                let texts: Vec<(&str, String)> =
                    files.iter().map(|(path, text)| (path.as_str(), edited(&client, &edit, path, text))).collect();
                let texts: Vec<(&str, &str)> = texts.iter().map(|it| (it.0, it.1.as_str())).collect();
                let other = Client::start(able.clone(), &texts);
                assert_eq!(lines(&other.check()), before, "{edit}");
                other.stop();
            }
        }
        occurrences += seen.iter().map(|it| it.matches("newText").count()).sum::<usize>();
        client.stop();
    }
    assert!(renamed > 50 && occurrences > 2 * renamed, "{renamed} names in {occurrences} places");
}

/// Files, codes and lines of findings.
fn lines(findings: &[String]) -> Vec<String> {
    let line = |it: &String| {
        let mut parts = it.split(' ');
        let (code, place) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        format!("{code} {}", place.split(':').next().unwrap_or_default())
    };
    let mut found: Vec<String> = findings.iter().map(line).collect();
    found.sort();
    found
}

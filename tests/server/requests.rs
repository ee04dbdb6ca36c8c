//! What a user asks of the program: each request, on programs of both vendors.

use serde_json::{Value, json};

use crate::client::{Client, able};

const VARIABLES: &str = "[HEADER]
    STANDARD = 'IEC 1131-3'
[DATA_UNIT]
VAR_GLOBAL
    Pump AT %Q2.0 : EBOOL (*main pump*);
    Start AT %I1.0 : EBOOL;
    Level AT %MW10 : WORD;
END_VAR
[EOF]
";

const MAIN: &str = "ST : MAST - MAIN
! Pump := Start;
! %M1 := %Q2.0 AND %MW10:X3;
! IF RE Start THEN
    JUMP %L20;
  END_IF;
! SR3;
! %L20:
  SET %M2;
ST : MAST - SR3
! Level := 5;
";

const CHART: &str = "[SOURCE_UNIT]
NAME = 'Fill' ADDRESS = MAST Fill PROG_LANGAGE = GR7
PROGRAM MAST 'Fill'
NB_PAGES = 1
PAGE 0
INITIAL_STEP 0 AT (C 0,L 0) :
END_STEP
TRANSITION (ST) AT (C 0,L 1) : (*PHRASE*) %X0.T > 5 (*END_PHRASE*) END_TRANSITION
STEP 1 AT (C 0,L 2) :
ACTION (N1,ST) : (*PHRASE*) %M7 := %X0; (*END_PHRASE*) END_ACTION
END_STEP
TRANSITION (ST) AT (C 0,L 3) : (*PHRASE*) %I1.1 (*END_PHRASE*) END_TRANSITION
END_PAGE
END_PROGRAM
[EOF]
";

const AWL: &str = "FUNCTION_BLOCK FB 1
VAR_INPUT
  Go : BOOL ;
  Count : INT ;
END_VAR
BEGIN
NETWORK
TITLE = first
      U     #Go;
      SPB   m001;
      L     MW 10;
      T     MB 12;
m001: =     M 11.3;
END_FUNCTION_BLOCK

ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
      CALL  FB 1 , DB 1 (
           Go := E 0.0);
      U     M 11.3;
      =     A 4.0;
END_ORGANIZATION_BLOCK
";

fn pl7() -> Client {
    Client::start(able(), &[("main.st", MAIN), ("variables.scy", VARIABLES)])
}

/// A request about the place where `needle` stands in a file, `within` characters into it.
pub fn at(client: &Client, path: &str, text: &str, needle: &str, within: usize) -> Value {
    let offset = text.find(needle).unwrap_or_else(|| panic!("{needle}")) + within;
    let before = &text[..offset];
    let line = before.matches('\n').count();
    let character = before.len() - before.rfind('\n').map_or(0, |it| it + 1);
    json!({ "textDocument": client.document(path), "position": { "line": line, "character": character } })
}

/// `main.st:3:8-3:12`, counted from 1.
fn range(it: &Value) -> String {
    let place =
        |end: &str| format!("{}:{}", it[end]["line"].as_u64().unwrap() + 1, it[end]["character"].as_u64().unwrap() + 1);
    format!("{}-{}", place("start"), place("end"))
}

pub fn locations(client: &Client, answer: &Value) -> Vec<String> {
    let one = |it: &Value| format!("{}:{}", client.name(it["uri"].as_str().unwrap()), range(&it["range"]));
    let mut found: Vec<String> = answer.as_array().into_iter().flatten().map(one).collect();
    found.sort();
    found
}

/// The text that edits of a `WorkspaceEdit` make of a file.
pub fn edited(client: &Client, edit: &Value, path: &str, text: &str) -> String {
    let uri = client.uri(path);
    let changes = edit["documentChanges"].as_array().unwrap();
    let own = changes.iter().filter(|it| it["textDocument"]["uri"] == uri.as_str());
    let mut edits: Vec<(usize, usize, String)> = own
        .flat_map(|it| it["edits"].as_array().unwrap())
        .map(|it| {
            let offset = |end: &str| {
                let (line, character) = (&it["range"][end]["line"], &it["range"][end]["character"]);
                let start: usize = text.split_inclusive('\n').take(line.as_u64().unwrap() as usize).map(str::len).sum();
                start + character.as_u64().unwrap() as usize
            };
            (offset("start"), offset("end"), it["newText"].as_str().unwrap().to_owned())
        })
        .collect();
    edits.sort();
    let mut text = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        text.replace_range(start..end, &new);
    }
    text
}

fn hover(client: &mut Client, path: &str, text: &str, needle: &str, within: usize) -> String {
    let params = at(client, path, text, needle, within);
    let answer = client.ask("textDocument/hover", params);
    answer["contents"]["value"].as_str().unwrap_or_default().to_owned()
}

#[test]
fn hover_tells_what_an_address_is() {
    let mut client = pl7();
    let text = hover(&mut client, "main.st", MAIN, "%Q2.0", 2);
    for expected in [
        "**%Q2.0**: output, 1 bit",
        "symbol `Pump`: main pump",
        "rack 0, module 2, channel 0",
        "- MAST: 1 read, 1 write, 0 edge tests",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    let text = hover(&mut client, "main.st", MAIN, "Start THEN", 0);
    assert!(text.contains("address `%I1.0`") && text.contains("1 read, 0 writes, 1 edge test"), "{text}");
    assert!(text.contains("may not write it"), "{text}");
    let text = hover(&mut client, "main.st", MAIN, "%MW10:X3", 2);
    assert!(text.contains("1 bit") && text.contains("shares memory with `Level`"), "{text}");
    assert!(hover(&mut client, "main.st", MAIN, "%L20", 2).contains("label, with 1 jump"));
    assert!(hover(&mut client, "main.st", MAIN, "SR3", 1).contains("`MAST - SR3`, called in 1 place"));
    assert!(hover(&mut client, "main.st", MAIN, "SET", 1).contains("line 3570"));
    assert!(hover(&mut client, "variables.scy", VARIABLES, "Level", 1).contains("address `%MW10`"));
    assert_eq!(hover(&mut client, "main.st", MAIN, "! IF", 1), "", "between two words");
    client.stop();
}

#[test]
fn hover_tells_the_rule_of_a_finding() {
    let text = "ST : MAST - MAIN\n! %KW3 := 5;\n";
    let mut client = Client::start(able(), &[("a.st", text)]);
    let shown = hover(&mut client, "a.st", text, "%KW3", 1);
    assert!(
        shown.contains("**Why**") && shown.contains("**Instead**") && shown.contains("constant, 16 bits"),
        "{shown}"
    );
    client.stop();
}

#[test]
fn hover_knows_step_7() {
    let mut client = Client::start(able(), &[("a.awl", AWL)]);
    let text = hover(&mut client, "a.awl", AWL, "M 11.3", 1);
    for expected in ["internal memory, 1 bit", "byte 11, bit 3", "1 read, 1 write", "shares memory with `MW10`"] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    assert!(hover(&mut client, "a.awl", AWL, "#Go", 1).contains("input of type `BOOL`"));
    assert!(hover(&mut client, "a.awl", AWL, "SPB", 1).contains("jumps to the label when the RLO is 1"));
    let text = hover(&mut client, "a.awl", AWL, "FB 1 ,", 1);
    assert!(text.contains("called in 1 place") && text.contains("input `go : BOOL`"), "{text}");
    client.stop();
    // Names of fields are mnemonics, too.
    let data = "DATA_BLOCK DB 2\nSTRUCT\n  on : BOOL;\nEND_STRUCT\nBEGIN\n  on := TRUE;\nEND_DATA_BLOCK\n";
    let mut client = Client::start(able(), &[("a.awl", data)]);
    assert_eq!(hover(&mut client, "a.awl", data, "on :=", 1), "**on**: field of type `BOOL` of `DB2`");
    client.stop();
}

#[test]
fn definitions_are_found() {
    let mut client = pl7();
    let mut find = |needle: &str, within: usize| {
        let params = at(&client, "main.st", MAIN, needle, within);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("Pump", 1), ["variables.scy:5:5-5:9"]);
    assert_eq!(find("%Q2.0", 1), ["variables.scy:5:5-5:9"]);
    assert_eq!(find("%L20", 1), ["main.st:8:3-8:7"]);
    assert_eq!(find("SR3", 1), ["main.st:10:1-10:16"]);
    assert_eq!(find("%M1", 1), [] as [&str; 0]);
    client.stop();
    let mut client = Client::start(able(), &[("a.awl", AWL), ("fill.gr7", CHART)]);
    let mut find = |path: &str, text: &str, needle: &str, within: usize| {
        let params = at(&client, path, text, needle, within);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("a.awl", AWL, "m001;", 1), ["a.awl:13:1-13:5"]);
    assert_eq!(find("a.awl", AWL, "FB 1 ,", 1), ["a.awl:1:1-1:20"]);
    assert_eq!(find("a.awl", AWL, "#Go", 2), ["a.awl:3:3-3:5"]);
    assert_eq!(find("fill.gr7", CHART, "%X0;", 1), ["fill.gr7:6:14-6:15"]);
    assert_eq!(find("fill.gr7", CHART, "%X0.T", 1), ["fill.gr7:6:14-6:15"]);
    client.stop();
}

#[test]
fn references_are_those_that_share_memory() {
    let mut client = pl7();
    let mut find = |needle: &str, declarations: bool| {
        let mut params = at(&client, "main.st", MAIN, needle, 1);
        params["context"] = json!({ "includeDeclaration": declarations });
        let answer = client.ask("textDocument/references", params);
        locations(&client, &answer)
    };
    assert_eq!(find("Level", true), ["main.st:11:3-11:8", "main.st:3:20-3:28", "variables.scy:7:5-7:10"]);
    assert_eq!(find("%MW10:X3", false), ["main.st:11:3-11:8", "main.st:3:20-3:28"]);
    assert_eq!(find("%L20", true), ["main.st:5:10-5:14", "main.st:8:3-8:7"]);
    assert_eq!(find("SR3", false), ["main.st:7:3-7:6"]);
    let params = at(&client, "main.st", MAIN, "Pump", 1);
    let answer = client.ask("textDocument/documentHighlight", params);
    let mut kinds: Vec<(String, u64)> =
        answer.as_array().unwrap().iter().map(|it| (range(&it["range"]), it["kind"].as_u64().unwrap())).collect();
    kinds.sort();
    assert_eq!(kinds, [("2:3-2:7".to_owned(), 3), ("3:10-3:15".to_owned(), 2)]);
    client.stop();
    let mut client = Client::start(able(), &[("a.awl", AWL)]);
    let mut params = at(&client, "a.awl", AWL, "MW 10", 1);
    params["context"] = json!({ "includeDeclaration": false });
    let answer = client.ask("textDocument/references", params);
    // MW 10 holds M 11.3, MB 12 lies behind it.
    assert_eq!(locations(&client, &answer), ["a.awl:11:13-11:18", "a.awl:13:13-13:19", "a.awl:21:13-21:19"]);
    client.stop();
}

#[test]
fn symbols_and_labels_are_renamed_everywhere() {
    let mut client = pl7();
    let prepared = client.ask("textDocument/prepareRename", at(&client, "main.st", MAIN, "Pump", 1));
    assert_eq!(prepared["placeholder"], "Pump");
    assert_eq!(client.ask("textDocument/prepareRename", at(&client, "main.st", MAIN, "%M1", 1)), Value::Null);
    let rename = |client: &mut Client, path: &str, text: &str, needle: &str, name: &str| {
        let mut params = at(client, path, text, needle, 1);
        params["newName"] = json!(name);
        client.try_ask("textDocument/rename", params)
    };
    let edit = rename(&mut client, "main.st", MAIN, "Start", "Marche").unwrap();
    assert_eq!(edited(&client, &edit, "main.st", MAIN), MAIN.replace("Start", "Marche"));
    assert_eq!(edited(&client, &edit, "variables.scy", VARIABLES), VARIABLES.replace("Start", "Marche"));
    let edit = rename(&mut client, "variables.scy", VARIABLES, "Level", "Niveau").unwrap();
    assert_eq!(edited(&client, &edit, "main.st", MAIN), MAIN.replace("Level", "Niveau"));
    for wrong in ["Pump", "pump", "5up", "a b", "", "a.b", "Symbole_qui_a_plus_de_32_caracteres"] {
        assert_eq!(rename(&mut client, "main.st", MAIN, "Start", wrong), Err(-32803), "{wrong}");
    }
    assert!(rename(&mut client, "main.st", MAIN, "Start", "START").is_ok(), "its own name in other letters");
    let edit = rename(&mut client, "main.st", MAIN, "%L20", "30").unwrap();
    assert_eq!(edited(&client, &edit, "main.st", MAIN), MAIN.replace("%L20", "%L30"));
    for wrong in ["1000", "loop", ""] {
        assert_eq!(rename(&mut client, "main.st", MAIN, "%L20", wrong), Err(-32803), "{wrong}");
    }
    assert_eq!(rename(&mut client, "main.st", MAIN, "%M1", "%M3"), Err(-32803));
    client.stop();
    let mut client = Client::start(able(), &[("a.awl", AWL)]);
    let edit = rename(&mut client, "a.awl", AWL, "m001:", "next").unwrap();
    assert_eq!(edited(&client, &edit, "a.awl", AWL), AWL.replace("m001", "next"));
    for wrong in ["1abc", "abcde", "a-b"] {
        assert_eq!(rename(&mut client, "a.awl", AWL, "m001:", wrong), Err(-32803), "{wrong}");
    }
    client.stop();
}

const SYMBOLS: &str = "\"Motor\",\"FB      1\",\"FB      1\",\"starts and stops\"
\"Data\",\"DB     10\",\"DB     10\",\"\"
\"Lamp\",\"A       4.0\",\"BOOL\",\"red\"
";

const BLOCKS: &str = "TYPE UDT 1
STRUCT
  on : BOOL ;
  hours : INT ;
END_STRUCT
END_TYPE
DATA_BLOCK DB 10
STRUCT
  Speed : INT ;
  Left : UDT 1 ;
END_STRUCT
BEGIN
END_DATA_BLOCK
DATA_BLOCK DB 1
  FB 1
BEGIN
END_DATA_BLOCK
FUNCTION_BLOCK FB 1
VAR_INPUT
  Go : BOOL ;
END_VAR
VAR
  state : UDT 1 ;
END_VAR
BEGIN
NETWORK
      U     #Go;
      =     #state.on;
      L     #state.hours;
      T     \"Data\".Speed;
END_FUNCTION_BLOCK
ORGANIZATION_BLOCK OB 100
BEGIN
NETWORK
      L     DB10.DBW 4;
      T     DB10.DBW 0;
END_ORGANIZATION_BLOCK
ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
      CALL  \"Motor\" , DB 1 (
           Go := E 0.0);
      U     A 4.0;
      =     \"Lamp\";
END_ORGANIZATION_BLOCK
FUNCTION FC 1 : VOID
VAR_TEMP
  scratch : UDT 1 ;
END_VAR
BEGIN
NETWORK
      L     MW 10;
      T     #scratch.hours;
      L     #scratch.hours;
      T     MW 12;
END_FUNCTION
";

#[test]
fn symbols_of_blocks_and_fields_lead_to_what_they_name() {
    let mut client = Client::start(able(), &[("a.awl", BLOCKS), ("a.sdf", SYMBOLS)]);
    let mut find = |needle: &str, within: usize| {
        let params = at(&client, "a.awl", BLOCKS, needle, within);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("\"Motor\"", 2), ["a.awl:18:1-18:20"], "the block behind a symbol");
    assert_eq!(find("\"Data\".Speed", 8), ["a.awl:9:3-9:8"]);
    assert_eq!(find("DB10.DBW 0", 1), ["a.awl:9:3-9:8"], "a field by its address");
    assert_eq!(find("DB10.DBW 4", 1), ["a.awl:4:3-4:8"], "a field of the type of a field");
    assert_eq!(find("\"Lamp\"", 1), ["a.sdf:3:2-3:6"]);
    let mut find = |needle: &str, within: usize| {
        let mut params = at(&client, "a.awl", BLOCKS, needle, within);
        params["context"] = json!({ "includeDeclaration": false });
        let answer = client.ask("textDocument/references", params);
        locations(&client, &answer)
    };
    assert_eq!(find("FUNCTION_BLOCK FB 1", 16), ["a.awl:41:13-41:20"], "the calls of the block of a heading");
    assert_eq!(find("state : UDT", 1), ["a.awl:28:13-28:22", "a.awl:29:13-29:25"], "parts of a structure");
    assert_eq!(find("Speed : INT", 1), ["a.awl:30:13-30:25", "a.awl:36:13-36:23"]);
    assert_eq!(find("Go : BOOL", 1), ["a.awl:27:13-27:16", "a.awl:42:12-42:14"], "a parameter, in the call too");
    assert_eq!(find("Go := E 0.0", 1), ["a.awl:27:14-27:16", "a.awl:42:12-42:14"], "from the call");
    let mut shown = |needle: &str, within: usize| hover(&mut client, "a.awl", BLOCKS, needle, within);
    let text = shown("\"Motor\"", 2);
    assert!(text.contains("`FB1`, called in 1 place, runs in OB1") && text.contains("input `go : BOOL`"), "{text}");
    let text = shown("FUNCTION_BLOCK FB 1", 17);
    assert!(text.contains("called in 1 place"), "{text}");
    let text = shown("\"Data\".Speed", 8);
    assert!(text.contains("field `speed : INT`") && text.contains("- OB100: 0 reads, 1 write"), "{text}");
    let text = shown("#state.on", 2);
    assert!(text.contains("component `on` of type `BOOL` of `state`, static of type `UDT1`"), "{text}");
    let text = shown("#scratch.hours", 2);
    assert!(text.contains("component `hours` of type `INT` of `scratch`, temporary of type `UDT1`"), "{text}");
    let text = shown("state : UDT", 1);
    assert!(text.contains("static of type `UDT1`") && !text.contains("not used"), "{text}");
    let text = shown("A 4.0", 1);
    assert!(text.contains("symbol `\"Lamp\"`: red"), "{text}");
    assert_eq!(shown("Go := E 0.0", 1), "**Go**: input of type `BOOL` of `FB1`");
    let open =
        BLOCKS.replace("      L     #state.hours;", "      L     #state.\n      L     \"Data\".\n      =     \"La");
    let open = open.replace("      L     #scratch.hours;", "      L     #scratch.");
    client.open("a.awl", &open);
    let mut offered = |needle: &str| {
        let params = at(&client, "a.awl", &open, needle, needle.len());
        client.ask("textDocument/completion", params)
    };
    assert_eq!(labels(&offered("L     #state.")), ["on", "hours"]);
    assert_eq!(labels(&offered("L     \"Data\".")), ["speed", "left"]);
    assert_eq!(labels(&offered("L     #scratch.")), ["on", "hours"]);
    let answer = offered("=     \"La");
    let item = answer["items"].as_array().unwrap().iter().find(|it| it["label"] == "\"Lamp\"").unwrap();
    assert_eq!(range(&item["textEdit"]["range"]), "31:13-31:16", "the quote is part of the symbol");
    client.stop();
}

#[test]
fn members_tables_and_steps_are_found() {
    let variables = VARIABLES.replace("END_VAR\n", "    Table AT %MW20 : WORD (*recipe*);\nEND_VAR\n");
    let main = MAIN.replace("! SR3;", "! SR3;\n! %MW1 := Table[%MW2];");
    let old = "GR7 : PL7-2 - SEQ
PAGE 0
INITIAL_STEP 0 AT (C 0,L 0) : END_STEP
END_PAGE
LD : PL7-2 - POST
RUNG L1:
OPEN_CONTACT(X0),H_LINK(8),COIL(B20);
END_RUNG
";
    let mut client = Client::start(able(), &[("main.st", &main), ("variables.scy", &variables), ("old/a.ld", old)]);
    let mut find = |path: &str, text: &str, needle: &str| {
        let params = at(&client, path, text, needle, 1);
        let answer = client.ask("textDocument/definition", params);
        locations(&client, &answer)
    };
    assert_eq!(find("main.st", &main, "Table["), ["variables.scy:8:5-8:10"]);
    assert_eq!(find("old/a.ld", old, "X0)"), ["old/a.ld:3:14-3:15"], "a step of PL7-2");
    let answer = client.ask("textDocument/codeLens", json!({ "textDocument": client.document("old/a.ld") }));
    assert_eq!(answer[0]["command"]["title"], "X0: 1 read, 0 writes", "as PL7-2 writes it");
    let text = hover(&mut client, "main.st", &main, "Table[", 1);
    assert!(text.contains("address `%MW20`") && text.contains("recipe"), "{text}");
    client.stop();
}

fn outline(symbols: &Value, depth: usize, out: &mut Vec<String>) {
    for it in symbols.as_array().into_iter().flatten() {
        out.push(format!("{}{}", " ".repeat(depth), it["name"].as_str().unwrap()));
        outline(&it["children"], depth + 1, out);
    }
}

#[test]
fn documents_have_an_outline() {
    let mut client =
        Client::start(able(), &[("a.awl", AWL), ("b/main.st", MAIN), ("b/v.scy", VARIABLES), ("fill.gr7", CHART)]);
    let mut shown = |path: &str| {
        let answer = client.ask("textDocument/documentSymbol", json!({ "textDocument": client.document(path) }));
        let mut out = Vec::new();
        outline(&answer, 0, &mut out);
        out
    };
    assert_eq!(shown("a.awl"), ["FB1", " Go", " Count", " network 1", " m001", "OB1", " network 1"]);
    assert_eq!(shown("b/main.st"), ["MAST - MAIN", " %L20", "MAST - SR3"]);
    assert_eq!(shown("b/v.scy"), ["Pump", "Start", "Level"]);
    let chart = shown("fill.gr7");
    assert!(chart.contains(&" step 0".to_owned()) && chart.contains(&" step 1".to_owned()), "{chart:?}");
    let answer = client.ask("workspace/symbol", json!({ "query": "pmp" }));
    let names: Vec<&str> = answer.as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["Pump %Q2.0"]);
    let answer = client.ask("workspace/symbol", json!({ "query": "" }));
    let names: Vec<&str> = answer.as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap()).collect();
    assert!(["FB1", "OB1", "MAST - SR3", "step %X1"].iter().all(|it| names.contains(it)), "{names:?}");
    client.stop();
}

#[test]
fn what_has_several_lines_folds() {
    let mut client = Client::start(able(), &[("a.awl", AWL), ("main.st", MAIN)]);
    let mut folds = |path: &str| -> Vec<(u64, u64)> {
        let answer = client.ask("textDocument/foldingRange", json!({ "textDocument": client.document(path) }));
        let one = |it: &Value| (it["startLine"].as_u64().unwrap() + 1, it["endLine"].as_u64().unwrap() + 1);
        answer.as_array().unwrap().iter().map(one).collect()
    };
    let awl = folds("a.awl");
    assert!([(1, 14), (2, 5), (7, 13), (16, 23)].iter().all(|it| awl.contains(it)), "{awl:?}");
    assert_eq!(folds("main.st"), [(1, 9), (4, 6), (10, 11)]);
    let commented = format!("// one\n// two\n{AWL}");
    client.open("a.awl", &commented);
    let answer = client.ask("textDocument/foldingRange", json!({ "textDocument": client.document("a.awl") }));
    let lines = |it: &Value| (it["startLine"].as_u64().unwrap() + 1, it["endLine"].as_u64().unwrap() + 1);
    let awl: Vec<(u64, u64)> = answer.as_array().unwrap().iter().map(lines).collect();
    assert_eq!(awl[..2], [(1, 2), (3, 16)], "the heading stays in view");
    client.stop();
}

#[test]
fn words_have_kinds() {
    let text = "ST : MAST - MAIN\n! (* a\n  b *)\n  %M1 := NOT %M2;\n! %MW4 := INC_X + 16#FF;\n";
    let mut client = Client::start(able(), &[("a.st", text)]);
    let legend = client.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"].clone();
    let answer = client.ask("textDocument/semanticTokens/full", json!({ "textDocument": client.document("a.st") }));
    let data: Vec<usize> = answer["data"].as_array().unwrap().iter().map(|it| it.as_u64().unwrap() as usize).collect();
    let lines: Vec<&str> = text.lines().collect();
    let (mut line, mut start, mut shown) = (0, 0, Vec::new());
    for token in data.chunks(5) {
        start = if token[0] == 0 { start + token[1] } else { token[1] };
        line += token[0];
        shown.push(format!("{} {}", &lines[line][start..start + token[2]], legend[token[3]].as_str().unwrap()));
    }
    let expected = [
        "(* a comment",
        "  b *) comment",
        "%M1 variable",
        ":= operator",
        "NOT keyword",
        "%M2 variable",
        "%MW4 variable",
        ":= operator",
        "INC_X variable",
        "+ operator",
        "16#FF number",
    ];
    assert_eq!(shown, expected);
    client.stop();
}

fn labels(answer: &Value) -> Vec<String> {
    answer["items"].as_array().into_iter().flatten().map(|it| it["label"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn words_are_completed() {
    let mut client = Client::start(able(), &[("main.st", MAIN), ("variables.scy", VARIABLES), ("awl/a.awl", AWL)]);
    let open = MAIN.replace("! SR3;", "! SR3;\n! %Q");
    client.open("main.st", &open);
    let params = at(&client, "main.st", &open, "! %Q\n", 4);
    let answer = client.ask("textDocument/completion", params);
    let found = labels(&answer);
    assert!(found.contains(&"%Q2.0".to_owned()) && found.contains(&"Pump".to_owned()), "{found:?}");
    assert!(!found.contains(&"IF".to_owned()), "no word begins with `%`");
    let item = answer["items"].as_array().unwrap().iter().find(|it| it["label"] == "%Q2.0").unwrap();
    assert_eq!(range(&item["textEdit"]["range"]), "8:3-8:5");
    let open = MAIN.replace("! SR3;", "! SR3;\n! S");
    client.replace("main.st", &open);
    let params = at(&client, "main.st", &open, "! S\n", 3);
    let found = labels(&client.ask("textDocument/completion", params));
    for expected in ["Start", "SET", "SR3", "END_IF", "%L20"] {
        assert!(found.contains(&expected.to_owned()), "{expected} in {found:?}");
    }
    let open = AWL.replace("           Go := E 0.0);", "           Go := E 0.0,\n           );");
    client.open("awl/a.awl", &open);
    let params = at(&client, "awl/a.awl", &open, "           );", 11);
    let answer = client.ask("textDocument/completion", params);
    let found = labels(&answer);
    assert!(found.contains(&"count".to_owned()) && !found.contains(&"go".to_owned()), "{found:?}");
    let params = at(&client, "awl/a.awl", &open, "#Go", 1);
    let found = labels(&client.ask("textDocument/completion", params));
    assert_eq!(found, ["m001", "#Go", "#Count"]);
    let params = at(&client, "awl/a.awl", &open, "SPB ", 2);
    let found = labels(&client.ask("textDocument/completion", params));
    assert!(["SPBN", "UN"].iter().all(|it| found.contains(&(*it).to_owned())), "{found:?}");
    assert!(!found.contains(&"JC".to_owned()), "the other set of mnemonics");
    assert!(!found.contains(&"FB 1".to_owned()), "an operand needs its instruction");
    let params = at(&client, "awl/a.awl", &open, "FB 1 ,", 1);
    let found = labels(&client.ask("textDocument/completion", params));
    assert!(found.contains(&"FB 1".to_owned()) && !found.contains(&"SPBN".to_owned()), "{found:?}");
    let params = at(&client, "awl/a.awl", &open, "M 11.3", 4);
    let answer = client.ask("textDocument/completion", params);
    let item = answer["items"].as_array().unwrap().iter().find(|it| it["label"] == "M 11.3").unwrap();
    assert_eq!(range(&item["textEdit"]["range"]), "13:13-13:17", "the operand with the blank in it");
    client.stop();
}

#[test]
fn hints_show_the_other_name() {
    let mut client = pl7();
    let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
    let mut hints = |range: &Value| -> Vec<String> {
        let params = json!({ "textDocument": client.document("main.st"), "range": range });
        let answer = client.ask("textDocument/inlayHint", params);
        let one = |it: &Value| {
            let (line, at) =
                (it["position"]["line"].as_u64().unwrap() + 1, it["position"]["character"].as_u64().unwrap() + 1);
            format!("{line}:{at} {}", it["label"].as_str().unwrap())
        };
        answer.as_array().unwrap().iter().map(one).collect()
    };
    let expected = ["2:7 %Q2.0", "2:16 %I1.0", "3:15 Pump", "3:28 Level:X3", "4:14 %I1.0", "11:8 %MW10"];
    assert_eq!(hints(&all), expected);
    let first = json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 2, "character": 0 } });
    assert_eq!(hints(&first), expected[..2]);
    client.stop();
    // Code of Siemens has blanks in its addresses.
    let files = [
        (
            "a.awl",
            "FUNCTION FC 1 : VOID\nBEGIN\n      U     E 1.0;\n      =     \"Lamp\";\n      =     A 4.1;\nEND_FUNCTION\n",
        ),
        ("a.sdf", "\"Lamp\",\"A 4.0\",\"BOOL\",\"\"\n\"Horn\",\"A       4.1\",\"BOOL\",\"\"\n"),
        ("b.s5", "PB 1\n:U E 1.0\n:= -LAMPE\n:= A 4.1\n:BE\n"),
        ("BZ0.SEQ", "\tE 1.0\tTASTER\t\n\tA 4.0\tLAMPE\t\n"),
    ];
    let mut client = Client::start(able(), &files);
    let mut hints = |path: &str| -> Vec<String> {
        let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        let answer =
            client.ask("textDocument/inlayHint", json!({ "textDocument": client.document(path), "range": all }));
        let one =
            |it: &Value| format!("{} {}", it["position"]["line"].as_u64().unwrap() + 1, it["label"].as_str().unwrap());
        answer.as_array().unwrap().iter().map(one).collect()
    };
    assert_eq!(hints("a.awl"), ["4 A4.0", "5 \"Horn\""]);
    assert_eq!(hints("b.s5"), ["2 TASTER", "3 A4.0"]);
    client.stop();
}

#[test]
fn lenses_count_calls_and_uses() {
    let mut client = Client::start(able(), &[("main.st", MAIN), ("fill.gr7", CHART), ("a.awl", AWL)]);
    let mut lenses = |path: &str| -> Vec<String> {
        let answer = client.ask("textDocument/codeLens", json!({ "textDocument": client.document(path) }));
        let one = |it: &Value| {
            format!(
                "{} {}",
                it["range"]["start"]["line"].as_u64().unwrap() + 1,
                it["command"]["title"].as_str().unwrap()
            )
        };
        answer.as_array().unwrap().iter().map(one).collect()
    };
    assert_eq!(lenses("main.st"), ["10 1 call in the program"]);
    assert_eq!(lenses("a.awl"), ["1 1 call in the program"]);
    assert_eq!(lenses("fill.gr7"), ["6 %X0: 1 read, 0 writes", "9 %X1: 0 reads, 0 writes"]);
    client.stop();
}

fn actions(client: &mut Client, path: &str, line: u64, only: Option<Value>) -> Vec<Value> {
    let place = json!({ "line": line - 1, "character": 6 });
    let mut context = json!({ "diagnostics": [] });
    if let Some(only) = only {
        context["only"] = only;
    }
    let range = json!({ "start": place, "end": place });
    let params = json!({ "textDocument": client.document(path), "range": range, "context": context });
    let answer = client.ask("textDocument/codeAction", params);
    answer.as_array().cloned().unwrap_or_default()
}

#[test]
fn findings_can_be_fixed_and_suppressed() {
    let text = "ST : MAST - MAIN\n! %M1 = %I1.0;\n! %M2 = %I1.1;\n! %M3 := %M1 AND %M2;\n";
    let mut client = Client::start(able(), &[("a.st", text)]);
    client.wait(|it| it.pushed("a.st").len() >= 2);
    let found = actions(&mut client, "a.st", 2, None);
    let titles: Vec<&str> = found.iter().map(|it| it["title"].as_str().unwrap()).collect();
    let fix = found.iter().find(|it| it["title"] == "Write `:=`").unwrap_or_else(|| panic!("{titles:?}"));
    assert_eq!((&fix["kind"], fix["diagnostics"].as_array().unwrap().len()), (&json!("quickfix"), 1));
    assert_eq!(edited(&client, &fix["edit"], "a.st", text), text.replace("%M1 =", "%M1 :="));

    let of = |wanted: &str| found.iter().find(|it| it["title"].as_str().unwrap().contains(wanted)).unwrap().clone();
    let code = fix["diagnostics"][0]["code"].as_str().unwrap().to_owned();
    let here = edited(&client, &of("here with a comment")["edit"], "a.st", text);
    let whole = edited(&client, &of("in this file with a comment")["edit"], "a.st", text);
    let disabled = of("plclint.toml");
    client.open("a.st", &here);
    client.wait(|it| it.pushed("a.st").iter().filter(|it| it.starts_with(&code)).count() == 1);
    client.replace("a.st", &whole);
    client.wait(|it| !it.pushed("a.st").iter().any(|it| it.starts_with(&code)));
    client.replace("a.st", text);
    client.wait(|it| it.pushed("a.st").iter().filter(|it| it.starts_with(&code)).count() == 2);
    assert_eq!(disabled["edit"]["documentChanges"][0]["kind"], "create");
    let config = edited(&client, &disabled["edit"], "plclint.toml", "");
    client.open("plclint.toml", &config);
    client.wait(|it| !it.pushed("a.st").iter().any(|it| it.starts_with(&code)));
    client.close("plclint.toml");

    let all = actions(&mut client, "a.st", 1, Some(json!(["source.fixAll"])));
    assert_eq!(all.len(), 1, "{all:#?}");
    assert_eq!(
        edited(&client, &all[0]["edit"], "a.st", text),
        text.replace("%M1 =", "%M1 :=").replace("%M2 =", "%M2 :=")
    );
    client.stop();
}

#[test]
fn a_comment_that_suppresses_stands_above_the_line() {
    let text = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      L     MW 4;\n      L     MW 6;\n      L     MW 8;\n      T     MW 10;\nEND_FUNCTION\n";
    let mut client = Client::start(able(), &[("a.awl", text)]);
    client.wait(|it| it.pushed("a.awl").iter().any(|it| it.starts_with("R004 5:")));
    let found = actions(&mut client, "a.awl", 5, Some(json!(["quickfix"])));
    let action = found.iter().find(|it| it["title"].as_str().unwrap().starts_with("Suppress R004")).unwrap();
    let edit = &action["edit"]["documentChanges"][0]["edits"][0];
    assert!(edit["newText"].as_str().unwrap().starts_with("      // plclint: allow("), "{edit}");
    assert_eq!(range(&edit["range"]), "5:1-5:1");
    let new = edited(&client, &action["edit"], "a.awl", text);
    client.open("a.awl", &new);
    client.wait(|it| it.pushed("a.awl").is_empty());
    client.stop();
    // A client that can lets the user write why.
    let mut able = able();
    able["workspace"]["workspaceEdit"]["snippetEditSupport"] = json!(true);
    let mut client = Client::start(able, &[("a.awl", text)]);
    client.wait(|it| it.pushed("a.awl").iter().any(|it| it.starts_with("R004 5:")));
    let found = actions(&mut client, "a.awl", 5, Some(json!(["quickfix"])));
    let action = found.iter().find(|it| it["title"].as_str().unwrap().starts_with("Suppress R004")).unwrap();
    let edit = &action["edit"]["documentChanges"][0]["edits"][0];
    let snippet = edit["snippet"]["value"].as_str().unwrap();
    assert_eq!(snippet, "      // plclint: allow(dead-load: ${1:reason})\n");
    assert_eq!((&edit["snippet"]["kind"], range(&edit["range"]).as_str()), (&json!("snippet"), "5:1-5:1"));
    let comment = snippet.replace("${1:reason}", "seen by the panel");
    client.open("a.awl", &text.replacen("      L     MW 6;", &format!("{comment}      L     MW 6;"), 1));
    client.wait(|it| it.pushed("a.awl").is_empty());
    client.stop();
}

/// Every request at many places of every program of the corpus: none fails.
#[test]
fn every_question_has_an_answer() {
    let corpus = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut client = Client::new(&[]);
    let uri = lsp_types::Uri::from_file_path(&corpus).unwrap();
    client.initialize(able(), json!([{ "uri": uri, "name": "corpus" }]));
    let names = client.ask("workspace/symbol", json!({ "query": "" }));
    let mut files: Vec<String> =
        names.as_array().unwrap().iter().map(|it| it["location"]["uri"].as_str().unwrap().to_owned()).collect();
    files.dedup();
    assert!(files.len() > 30, "{}", files.len());
    let mut answered = 0;
    for uri in files {
        let document = json!({ "uri": uri });
        let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 100_000, "character": 0 } });
        for method in ["documentSymbol", "foldingRange", "semanticTokens/full", "codeLens", "inlayHint", "codeAction"] {
            let params = json!({ "textDocument": document, "range": all, "context": { "diagnostics": [] } });
            client.ask(&format!("textDocument/{method}"), params);
        }
        let tokens = client.ask("textDocument/semanticTokens/full", json!({ "textDocument": document }));
        let data: Vec<u64> = tokens["data"].as_array().into_iter().flatten().map(|it| it.as_u64().unwrap()).collect();
        let (mut line, mut start) = (0, 0);
        let step = (data.len() / 5 / 12).max(1);
        for (n, token) in data.chunks(5).enumerate() {
            start = if token[0] == 0 { start + token[1] } else { token[1] };
            line += token[0];
            if n % step != 0 {
                continue;
            }
            let position = json!({ "line": line, "character": start + 1 });
            for method in ["hover", "definition", "references", "documentHighlight", "completion", "prepareRename"] {
                let context = json!({ "includeDeclaration": true, "triggerKind": 1 });
                let params = json!({ "textDocument": document, "position": position, "context": context });
                let answer = client.ask(&format!("textDocument/{method}"), params);
                answered += usize::from(!answer.is_null());
            }
        }
    }
    assert!(answered > 500, "{answered}");
    client.stop();
}

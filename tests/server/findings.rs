//! Findings: pushed to clients that do not ask, told to those that do.

use plclint::server::Ended;
use serde_json::{Value, json};

use crate::client::{Client, able, line, pulling};

/// Two blocks drive one output: what another file holds decides.
const MAIN: &str = "ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
      U     E 0.0;
      =     A 4.0;
      CALL  FC 1;
END_ORGANIZATION_BLOCK
";
const BLOCK: &str = "FUNCTION FC 1 : VOID
BEGIN
NETWORK
      U     E 0.1;
      =     A 4.0;
END_FUNCTION
";

fn codes(findings: &[String]) -> Vec<&str> {
    findings.iter().map(|it| it.split(' ').next().unwrap()).collect()
}

#[test]
fn findings_are_pushed_while_typing() {
    let mut client = Client::start(able(), &[("main.awl", MAIN), ("block.awl", BLOCK)]);
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    assert_eq!(client.check().len(), 1, "{:#?}", client.check());
    let all: Vec<String> =
        client.pushed.iter().flat_map(|(path, it)| it.iter().map(move |it| format!("{path}:{}", line(it)))).collect();
    assert_eq!(all, client.check());
    let (at, other) =
        if client.pushed("main.awl").is_empty() { ("block.awl", "main.awl") } else { ("main.awl", "block.awl") };
    let finding = client.pushed[at][0].clone();
    assert_eq!((&finding["code"], &finding["source"]), (&json!("W001"), &json!("plclint")));
    assert_eq!(finding["severity"], 2);
    assert_eq!(finding["data"]["rule"], "single-write");
    let related = finding["relatedInformation"].as_array().unwrap();
    assert_eq!(related[0]["location"]["uri"], client.uri(other));
    let page = finding["codeDescription"]["href"].as_str().unwrap().to_owned();
    let text = client.ask("workspace/textDocumentContent", json!({ "uri": page }));
    assert!(text["text"].as_str().unwrap().contains("(W001)"));

    // What is typed in one file takes back the finding in the other.
    client.open_from_disk("block.awl");
    let line_4 = json!({ "start": { "line": 4, "character": 14 }, "end": { "line": 4, "character": 17 } });
    client.change("block.awl", json!([{ "range": line_4, "text": "4.1" }]));
    client.wait(|it| it.pushed.values().all(Vec::is_empty));
    // The file on the disk is as it was.
    client.close("block.awl");
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    client.stop();
}

#[test]
fn dead_code_is_unnecessary() {
    let text = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      SPA   m001;\n      U     E 0.1;\n      =     A 4.0;\nm001: NOP   0;\nEND_FUNCTION\n";
    let mut client = Client::start(able(), &[("a.awl", text)]);
    client.wait(|it| !it.pushed("a.awl").is_empty());
    let dead = client.pushed["a.awl"].iter().find(|it| it["code"] == "D001").unwrap();
    assert_eq!(dead["tags"], json!([1]));
    client.stop();
}

#[test]
fn findings_are_told_to_those_who_ask() {
    let mut client = Client::start(pulling(), &[("main.awl", MAIN), ("block.awl", BLOCK)]);
    assert_eq!(client.capabilities["diagnosticProvider"]["workspaceDiagnostics"], true);
    assert_eq!(client.pull_all(), client.check());
    client.open_from_disk("main.awl");
    client.open_from_disk("block.awl");
    let ask = |client: &mut Client, path: &str, previous: &Value| {
        let params = json!({ "textDocument": client.document(path), "previousResultId": previous });
        client.ask("textDocument/diagnostic", params)
    };
    let first = ask(&mut client, "block.awl", &Value::Null);
    assert_eq!(first["kind"], "full");
    let again = ask(&mut client, "block.awl", &first["resultId"]);
    assert_eq!(again, json!({ "kind": "unchanged", "resultId": first["resultId"] }));
    // An edit below the findings changes none of them.
    client.replace("block.awl", &format!("{BLOCK}\n\n"));
    assert_eq!(ask(&mut client, "block.awl", &first["resultId"])["kind"], "unchanged");
    client.replace("main.awl", &MAIN.replace("A 4.0", "A 4.1"));
    let report = ask(&mut client, "main.awl", &Value::Null);
    assert!(report["items"].as_array().unwrap().is_empty(), "{report:#}");
    assert_eq!(codes(&client.pull("block.awl")), [] as [&str; 0]);
    assert!(client.pushed.is_empty(), "nothing is pushed to a client that asks");
    // A document that is no program has no findings.
    client.open("notes.txt", "Dear reader,\n");
    assert_eq!(client.pull("notes.txt"), [] as [&str; 0]);
    client.stop();
}

#[test]
fn a_question_about_all_files_waits_for_news() {
    let mut client = Client::start(pulling(), &[("main.awl", MAIN), ("block.awl", BLOCK)]);
    let report = client.ask("workspace/diagnostic", json!({ "previousResultIds": [] }));
    let known: Vec<Value> = report["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| json!({ "uri": it["uri"], "value": it["resultId"] }))
        .collect();
    assert_eq!(known.len(), 2);
    let id = client.post("workspace/diagnostic", json!({ "previousResultIds": known }));
    // Other requests are answered meanwhile.
    client.open_from_disk("main.awl");
    client.pull("main.awl");
    client.replace("main.awl", &MAIN.replace("A 4.0", "A 4.1"));
    let news = client.answer(&id).unwrap();
    let kinds: Vec<&Value> = news["items"].as_array().unwrap().iter().map(|it| &it["kind"]).collect();
    assert_eq!(kinds.iter().filter(|it| **it == "full").count(), 1, "only what changed is told: {news:#}");
    // One that is never answered ends with the session.
    let known: Vec<Value> = news["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| json!({ "uri": it["uri"], "value": it["resultId"] }))
        .collect();
    client.post("workspace/diagnostic", json!({ "previousResultIds": known }));
    client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    assert_eq!(client.ended(), Ended::Properly);
}

#[test]
fn a_configuration_decides_and_tells_its_mistakes() {
    let mut client = Client::start(able(), &[("main.awl", MAIN), ("block.awl", BLOCK)]);
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    let watched = |client: &mut Client, path: &str, kind: u32| {
        let params = json!({ "changes": [{ "uri": client.uri(path), "type": kind }] });
        client.notify("workspace/didChangeWatchedFiles", params);
    };
    client.write("plclint.toml", b"[rules]\nignore = ['single-write']\n");
    watched(&mut client, "plclint.toml", 1);
    client.wait(|it| it.pushed.values().all(Vec::is_empty));
    // A mistake is told in the file, and what was right before still counts.
    client.open("plclint.toml", "[rules]\nignore = ['single-writ']\n");
    client.wait(|it| !it.pushed("plclint.toml").is_empty());
    assert_eq!(
        client.pushed("plclint.toml"),
        ["configuration 2:11-2:25 no rule or group is called `single-writ`; did you mean `single-write`?"]
    );
    assert!(client.pushed("main.awl").is_empty() && client.pushed("block.awl").is_empty());
    client.replace("plclint.toml", "[rules]\nignore = []\n");
    client.wait(|it| it.pushed("plclint.toml").is_empty());
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    client.close("plclint.toml");
    client.wait(|it| it.pushed.values().all(Vec::is_empty));
    client.remove("plclint.toml");
    watched(&mut client, "plclint.toml", 3);
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    client.stop();
}

#[test]
fn files_come_and_go() {
    let mut client = Client::start(able(), &[("main.awl", MAIN)]);
    let watched = |client: &mut Client, path: &str, kind: u32| {
        let params = json!({ "changes": [{ "uri": client.uri(path), "type": kind }] });
        client.notify("workspace/didChangeWatchedFiles", params);
    };
    client.write("block.awl", BLOCK.as_bytes());
    watched(&mut client, "block.awl", 1);
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    client.write("block.awl", BLOCK.replace("A 4.0", "A 4.1").as_bytes());
    watched(&mut client, "block.awl", 2);
    client.wait(|it| it.pushed.values().all(Vec::is_empty));
    client.write("block.awl", BLOCK.as_bytes());
    watched(&mut client, "block.awl", 2);
    client.wait(|it| it.pushed.values().any(|it| !it.is_empty()));
    client.remove("block.awl");
    watched(&mut client, "block.awl", 3);
    client.wait(|it| it.pushed.values().all(Vec::is_empty));
    assert!(client.requests.iter().any(|it| it.method == "client/registerCapability"));
    client.stop();
}

#[test]
fn a_file_on_disk_may_have_another_encoding_than_the_editor() {
    let disk = b"FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      U     E 0.1; // d\xe9marr\xe9\n      =     A 4.0; // \xb0\nEND_FUNCTION\n";
    let files: [(&str, &[u8]); 2] = [("main.awl", MAIN.as_bytes()), ("block.awl", disk)];
    let mut client = Client::start_with_bytes(pulling(), &files);
    let before = client.pull_all();
    assert_eq!(before, client.check());
    let text =
        "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      U     E 0.1; // démarré\n      =     A 4.0; // °\nEND_FUNCTION\n";
    client.open("block.awl", text);
    assert_eq!(client.pull_all(), before);
    client.stop();
}

#[test]
fn columns_are_counted_as_agreed() {
    // A column behind characters of several bytes, and of two units of UTF-16.
    let text = "! %M1 := %I1.0;\n! (* é😀 *) %S0 := TRUE; (* é😀 *) %KW3 := 5;\n";
    let mut columns = Vec::new();
    for encoding in ["utf-8", "utf-16", "utf-32"] {
        let mut capabilities = pulling();
        capabilities["general"]["positionEncodings"] = json!([encoding]);
        let mut client = Client::start(capabilities, &[("a.st", text)]);
        assert_eq!(client.capabilities["positionEncoding"], encoding);
        let report = client.ask("textDocument/diagnostic", json!({ "textDocument": client.document("a.st") }));
        let items = report["items"].as_array().unwrap();
        let at = items.iter().find(|it| it["message"].as_str().unwrap().contains("%KW3")).unwrap();
        columns.push(at["range"]["start"]["character"].as_u64().unwrap());
        client.stop();
    }
    let line = text.lines().nth(1).unwrap().split("%KW3").next().unwrap();
    let utf_16: usize = line.chars().map(char::len_utf16).sum();
    assert_eq!(columns, [line.len() as u64, utf_16 as u64, line.chars().count() as u64]);
}

#[test]
fn several_folders_have_configurations_of_their_own() {
    let files: [(&str, &[u8]); 5] = [
        ("a/main.awl", MAIN.as_bytes()),
        ("a/block.awl", BLOCK.as_bytes()),
        ("b/main.awl", MAIN.as_bytes()),
        ("b/block.awl", BLOCK.as_bytes()),
        ("b/plclint.toml", b"[rules]\nignore = ['W001']\n"),
    ];
    let mut client = Client::new(&files);
    let folder = |client: &Client, name: &str| json!({ "uri": client.uri(name), "name": name });
    let folders = json!([folder(&client, "a"), folder(&client, "b")]);
    client.initialize(pulling(), folders);
    let found = client.pull_all();
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(found[0].starts_with("a/"));
    let removed = json!({ "event": { "added": [], "removed": [folder(&client, "a")] } });
    client.notify("workspace/didChangeWorkspaceFolders", removed);
    assert_eq!(client.pull_all(), [] as [&str; 0]);
    let added = json!({ "event": { "added": [folder(&client, "a")], "removed": [folder(&client, "b")] } });
    client.notify("workspace/didChangeWorkspaceFolders", added);
    assert_eq!(client.pull_all(), found);
    client.stop();
}

#[test]
fn a_document_outside_of_all_folders_is_checked_by_itself() {
    let mut client = Client::new(&[("block.awl", BLOCK.as_bytes()), ("plclint.toml", b"[rules]\nselect = ['all']\n")]);
    client.initialize(pulling(), Value::Null);
    let text = format!("{BLOCK}{MAIN}");
    client.open("block.awl", &text);
    let with_all = client.pull("block.awl");
    assert!(codes(&with_all).contains(&"W001"));
    client.remove("plclint.toml");
    let params = json!({ "changes": [{ "uri": client.uri("plclint.toml"), "type": 3 }] });
    client.notify("workspace/didChangeWatchedFiles", params);
    assert!(client.pull("block.awl").len() < with_all.len(), "the configuration was used, and is gone");
    let untitled = json!({ "uri": "untitled:Untitled-1", "languageId": "plc", "version": 1, "text": text });
    client.notify("textDocument/didOpen", json!({ "textDocument": untitled }));
    let report = client.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": "untitled:Untitled-1" } }));
    assert!(report["items"].as_array().unwrap().iter().any(|it| it["code"] == "W001"), "{report:#}");
    client.close("block.awl");
    assert_eq!(client.pull("block.awl"), [] as [&str; 0]);
    client.stop();
}

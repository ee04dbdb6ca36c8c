//! What a client should not do, and does.

use lsp_server::{Message, Request, RequestId};
use plclint::server::{Ended, serve};
use serde_json::{Value, json};

use crate::client::{Client, able, pulling};

const TEXT: &str = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n      U     E 0.1;\n      =     A 4.0;\nEND_FUNCTION\n";

#[test]
fn a_session_is_initialized_first_and_once() {
    let mut client = Client::new(&[]);
    assert_eq!(client.try_ask("textDocument/hover", json!({})), Err(-32002));
    client.notify("textDocument/didOpen", json!({ "nonsense": 1 }));
    assert_eq!(client.try_ask("initialize", json!({ "capabilities": 3 })), Err(-32602));
    client.initialize(able(), Value::Null);
    assert_eq!(client.try_ask("initialize", json!({ "capabilities": {} })), Err(-32600));
    client.ask("shutdown", Value::Null);
    assert_eq!(client.try_ask("textDocument/hover", json!({})), Err(-32600));
    client.notify("exit", Value::Null);
    assert_eq!(client.ended(), Ended::Properly);
}

#[test]
fn a_client_that_leaves_without_a_word_is_not_waited_for() {
    let client = Client::start(able(), &[("a.awl", TEXT)]);
    assert_eq!(client.die(), Ended::Abruptly);
    let mut client = Client::start(able(), &[("a.awl", TEXT)]);
    client.notify("exit", Value::Null);
    assert_eq!(client.ended(), Ended::Abruptly);
    assert_eq!(Client::new(&[]).die(), Ended::Abruptly);
}

#[test]
fn nonsense_is_refused_and_the_session_goes_on() {
    let mut client = Client::start(pulling(), &[("a.awl", TEXT)]);
    assert_eq!(client.try_ask("no/such", json!({})), Err(-32601));
    assert_eq!(client.try_ask("textDocument/diagnostic", json!({ "textDocument": 5 })), Err(-32602));
    assert_eq!(client.try_ask("textDocument/diagnostic", Value::Null), Err(-32602));
    client.notify("textDocument/didChange", json!([1, 2]));
    client.notify("textDocument/didChange", json!({}));
    client.notify("no/such", json!({}));
    client.notify("$/setTrace", json!({ "value": "off" }));
    // A document that nobody opened.
    client.change("other.awl", json!([{ "text": "x" }]));
    client.close("other.awl");
    // A version that was there, a place that is not.
    client.open("a.awl", TEXT);
    let document = json!({ "uri": client.uri("a.awl"), "version": -4 });
    let far = json!({ "line": 4_000_000_000_u32, "character": 4_000_000_000_u32 });
    let changes = json!([{ "range": { "start": far, "end": { "line": 0, "character": 0 } }, "text": "// end\n" }]);
    client.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    client.pull("a.awl");
    client.open("a.awl", TEXT);
    assert!(client.pull("a.awl").iter().all(|it| !it.starts_with("X001")));
    client.notify("$/cancelRequest", json!({ "id": 12345 }));
    client.notify("$/cancelRequest", json!({ "id": null }));
    // An answer to nothing.
    client.send(Message::Response(lsp_server::Response { id: RequestId::from(77), response_result: Ok(Value::Null) }));
    client.stop();
}

#[test]
fn a_cancelled_request_is_answered_once() {
    let mut client = Client::start(pulling(), &[("a.awl", TEXT)]);
    let known = client.ask("workspace/diagnostic", json!({ "previousResultIds": [] }));
    let known = json!([{ "uri": known["items"][0]["uri"], "value": known["items"][0]["resultId"] }]);
    let id = client.post("workspace/diagnostic", json!({ "previousResultIds": known }));
    client.notify("$/cancelRequest", json!({ "id": id }));
    assert_eq!(client.answer(&id), Err(-32800));
    let mut ids = Vec::new();
    for n in 0..50 {
        let id = RequestId::from(format!("text {n}"));
        let params = json!({ "textDocument": client.document("a.awl") });
        client.send(Message::Request(Request { id: id.clone(), method: "textDocument/diagnostic".into(), params }));
        client.notify("$/cancelRequest", json!({ "id": id }));
        ids.push(id);
    }
    for id in &ids {
        let answer = client.answer(id);
        assert!(answer == Err(-32800) || answer.is_ok());
    }
    client.stop();
}

#[test]
fn edits_and_questions_may_cross() {
    let mut client = Client::start(pulling(), &[("a.awl", TEXT)]);
    client.open("a.awl", TEXT);
    let mut ids = Vec::new();
    for n in 0..200 {
        client.replace("a.awl", &TEXT.replace("E 0.1", &format!("E 0.{}", n % 8)));
        let params = json!({ "textDocument": client.document("a.awl") });
        ids.push(client.post("textDocument/diagnostic", params));
    }
    for id in ids {
        client.answer(&id).expect("findings are asked anew when a write comes between");
    }
    client.stop();
}

#[test]
fn bytes_that_are_no_message_do_not_end_a_session() {
    let frame = |it: Value| format!("Content-Length: {}\r\n\r\n{it}", it.to_string().len());
    let mut input =
        frame(json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": { "capabilities": {} } }));
    input.push_str("Content-Length: 9\r\n\r\n{nonsense");
    input.push_str(&frame(json!({ "jsonrpc": "2.0", "id": 2 })));
    input.push_str("what is this\r\n");
    input.push_str(&frame(json!({ "jsonrpc": "2.0", "id": 3, "method": "shutdown" })));
    input.push_str(&frame(json!({ "jsonrpc": "2.0", "method": "exit" })));
    let output = Shared::default();
    let ended = serve(std::io::Cursor::new(input.into_bytes()), output.clone()).unwrap();
    assert_eq!(ended, Ended::Properly);
    let output = String::from_utf8(output.0.lock().unwrap().clone()).unwrap();
    for expected in ["\"id\":1,\"result\":{\"capabilities\"", "\"id\":3,\"result\":null", "\"code\":-32600"] {
        assert!(output.contains(expected), "{expected} in {output}");
    }
}

/// Addresses of nothing that is open, of nothing that is there, and of nothing at all.
const STRANGE: [&str; 9] = [
    "file:///no/such/folder/a.awl",
    "file:///",
    "file://host/share/a.awl",
    "untitled:Untitled-1",
    "https://example.com/a.awl",
    "plclint-rule:///W001/single-write.md",
    "data:,a",
    "no address",
    "",
];

#[test]
fn files_that_nobody_knows_do_no_harm() {
    let mut client = Client::start(pulling(), &[("a.awl", TEXT)]);
    let place = json!({ "line": 3, "character": 14 });
    let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 9, "character": 0 } });
    let methods = [
        "hover",
        "definition",
        "references",
        "documentHighlight",
        "completion",
        "prepareRename",
        "rename",
        "documentSymbol",
        "foldingRange",
        "semanticTokens/full",
        "codeLens",
        "inlayHint",
        "codeAction",
        "diagnostic",
    ];
    for uri in STRANGE {
        for method in methods {
            let params = json!({
                "textDocument": { "uri": uri }, "position": place, "range": all, "newName": "b",
                "context": { "diagnostics": [], "includeDeclaration": true, "triggerKind": 1 },
            });
            match client.try_ask(&format!("textDocument/{method}"), params) {
                Ok(Value::Null) => {}
                Ok(Value::Array(items)) => assert!(items.is_empty(), "{method} of {uri}: {items:?}"),
                Ok(answer) => assert_eq!(answer["items"], json!([]), "{method} of {uri}"),
                // Not an address, or nothing that could be renamed.
                Err(code) => assert!([-32602, -32803].contains(&code), "{method} of {uri}: {code}"),
            }
        }
        let document = json!({ "uri": uri, "version": 3 });
        client.notify("textDocument/didClose", json!({ "textDocument": document }));
        client.notify(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [{ "text": TEXT }] }),
        );
        client.notify("textDocument/didSave", json!({ "textDocument": document }));
        client.notify("workspace/didChangeWatchedFiles", json!({ "changes": [{ "uri": uri, "type": 1 }] }));
        client.notify("workspace/didChangeWatchedFiles", json!({ "changes": [{ "uri": uri, "type": 3 }] }));
        let folder = json!({ "uri": uri, "name": "strange" });
        let event = json!({ "added": [], "removed": [folder] });
        client.notify("workspace/didChangeWorkspaceFolders", json!({ "event": event }));
        if uri.is_empty() || uri.contains("a.awl") {
            let event = json!({ "added": [folder], "removed": [folder, folder] });
            client.notify("workspace/didChangeWorkspaceFolders", json!({ "event": event }));
        }
        assert_eq!(client.pull("a.awl"), [] as [&str; 0]);
    }
    client.stop();
}

#[test]
fn the_last_text_counts_whatever_its_version() {
    let mut client = Client::start(able(), &[("a.awl", TEXT)]);
    let uri = client.uri("a.awl");
    client.open("a.awl", TEXT);
    let wrong = TEXT.replace("U     E", "U     (((");
    for (version, text) in [(9, wrong.as_str()), (3, TEXT), (3, &wrong), (-1, TEXT), (i32::MAX, &wrong)] {
        let document = json!({ "uri": uri, "version": version });
        client.notify(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [{ "text": text }] }),
        );
        let has_findings = text != TEXT;
        client.wait(|it| it.pushed.get("a.awl").is_some_and(|it| it.is_empty() != has_findings));
    }
    // One that is no number changes nothing.
    for version in [json!("7"), json!(1.5), json!(1_u64 << 40), Value::Null] {
        let document = json!({ "uri": uri, "version": version });
        client
            .notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [{ "text": "" }] }));
    }
    let symbols = client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri } }));
    assert!(symbols.as_array().is_some_and(|it| !it.is_empty()), "the text is there");
    // Opened again without having been closed, closed twice.
    client.open("a.awl", TEXT);
    client.wait(|it| it.pushed("a.awl").is_empty());
    client.close("a.awl");
    client.close("a.awl");
    client.stop();
}

#[test]
fn a_client_that_dies_while_all_work_is_not_waited_for() {
    for n in 0..10 {
        let mut client = Client::start(pulling(), &[("a.awl", TEXT)]);
        client.open("a.awl", TEXT);
        for edit in 0..n * 5 {
            client.replace("a.awl", &TEXT.replace("FC 1", &format!("FC {edit}")));
            client.post("workspace/diagnostic", json!({ "previousResultIds": [] }));
            let params = json!({ "textDocument": client.document("a.awl") });
            client.post("textDocument/semanticTokens/full", params);
        }
        assert_eq!(client.die(), Ended::Abruptly);
    }
}

/// What becomes of the process when its client has sent this and gone.
fn left_with(input: &str, cuts_output: bool) -> Option<i32> {
    use std::io::Write as _;
    use std::process::{Command, Stdio};
    let mut command = Command::new(env!("CARGO_BIN_EXE_plclint"));
    command.arg("server").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut server = command.spawn().unwrap();
    if cuts_output {
        drop(server.stdout.take());
    }
    let mut to = server.stdin.take().unwrap();
    to.write_all(input.as_bytes()).unwrap();
    drop(to);
    let output = server.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(said, "", "nobody is there to read it");
    output.status.code()
}

#[test]
fn the_process_ends_with_its_client() {
    let frame = |it: Value| format!("Content-Length: {}\r\n\r\n{it}", it.to_string().len());
    let start = frame(json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": { "capabilities": {} } }));
    let item = json!({ "uri": "file:///a.awl", "languageId": "plc", "version": 1, "text": TEXT.repeat(2000) });
    let open = frame(json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": { "textDocument": item } }));
    let whole = format!("{start}{open}");
    for cuts_output in [false, true] {
        assert_eq!(left_with("", cuts_output), Some(1));
        assert_eq!(left_with(&start, cuts_output), Some(1));
        assert_eq!(left_with(&whole, cuts_output), Some(1));
        assert_eq!(left_with(&whole[..whole.len() - 7], cuts_output), Some(1));
    }
}

#[derive(Clone, Default)]
struct Shared(std::sync::Arc<std::sync::Mutex<Vec<u8>>>);

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

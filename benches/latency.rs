//! What a person waits for in an editor: from opening a folder, and from typing one character, to findings.
//!
//! `cargo bench --bench latency`. A client in this process speaks to the server as an editor does. The folder holds 200
//! files of one program, 100,000 lines in all; one of them has 5,000 lines and is typed in: 500 times, at random places,
//! every other time the character that was typed is taken back; at once, and with pauses as a person makes them.

#[expect(dead_code, unused_imports, reason = "the other bench uses the rest of it")]
mod generator;

use std::path::Path;
use std::time::{Duration, Instant};

use generator::Random;
use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use plclint::server::run;
use serde_json::{Value, json};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const FILES: usize = 200;
const LINES: usize = 100_000;
const LINES_TYPED_IN: usize = 5_000;
const EDITS: usize = 500;

/// Between two characters: a key that is held down comes again as soon.
const PAUSE: Duration = Duration::from_millis(30);

/// A program in files, the first of them that which is typed in. `starts` tells the lines with which a file may begin.
fn files(text: &str, starts: impl Fn(&str) -> bool) -> Vec<String> {
    let mut files = vec![String::new()];
    let mut lines = 0;
    for line in text.lines() {
        let wanted = if files.len() == 1 { LINES_TYPED_IN } else { (LINES - LINES_TYPED_IN) / (FILES - 1) };
        if lines >= wanted && starts(line) && files.len() < FILES {
            files.push(String::new());
            lines = 0;
        }
        if let Some(file) = files.last_mut() {
            file.push_str(line);
            file.push('\n');
        }
        lines += 1;
    }
    files
}

/// As much of a generated program as has so many lines.
fn program(make: fn(usize, u64) -> String) -> String {
    let sample = make(200_000, 1);
    make(200_000 * LINES / sample.lines().count(), 1)
}

struct Client {
    connection: Connection,
    next: i32,
    /// Of the document that is open.
    version: i32,
    /// When the first findings came.
    first_findings: Option<Instant>,
}

impl Client {
    fn send(&self, message: Message) {
        self.connection.sender.send(message).expect("the server listens");
    }

    fn notify(&self, method: &str, params: Value) {
        self.send(Message::Notification(Notification { method: method.to_owned(), params }));
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let id = RequestId::from(self.next);
        self.send(Message::Request(Request { id: id.clone(), method: method.to_owned(), params }));
        loop {
            if let Message::Response(it) = self.receive()
                && it.id == id
            {
                return it.response_result.unwrap_or_else(|error| panic!("{method}: {}", error.message));
            }
        }
    }

    fn receive(&mut self) -> Message {
        let message = self.connection.receiver.recv().expect("the server speaks");
        match &message {
            Message::Request(it) => {
                self.send(Message::Response(Response { id: it.id.clone(), response_result: Ok(Value::Null) }));
            }
            Message::Notification(it) if it.method == "textDocument/publishDiagnostics" => {
                self.first_findings.get_or_insert_with(Instant::now);
            }
            _ => {}
        }
        message
    }
}

/// A server that has a folder open.
fn open(folder: &Path, capabilities: &Value) -> (Client, std::thread::JoinHandle<plclint::server::Ended>) {
    let (server, connection) = Connection::memory();
    let server = std::thread::spawn(move || run(server));
    let mut client = Client { connection, next: 0, version: 1, first_findings: None };
    let uri = lsp_types::Uri::from_file_path(folder).expect("an absolute path");
    let folders = json!([{ "uri": uri, "name": "bench" }]);
    client.ask(
        "initialize",
        json!({ "processId": null, "rootUri": null, "capabilities": capabilities, "workspaceFolders": folders }),
    );
    client.notify("initialized", json!({}));
    (client, server)
}

fn close(mut client: Client, server: std::thread::JoinHandle<plclint::server::Ended>) {
    client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    server.join().expect("the server does not panic");
}

fn milliseconds(it: Duration) -> f64 {
    it.as_secs_f64() * 1000.0
}

/// Its name, the extension of its files, itself, and the lines with which a file may begin.
type Text = (&'static str, &'static str, String, fn(&str) -> bool);

fn main() {
    // `cargo bench` hands every bench its own options.
    let wanted: Vec<String> = std::env::args().skip(1).filter(|it| !it.starts_with("--")).collect();
    let texts: [Text; 2] = [
        ("STEP 7", "awl", program(generator::step7), |it| {
            it.starts_with("FUNCTION ") || it.starts_with("ORGANIZATION")
        }),
        ("PL7", "txt", program(generator::pl7), |it| it.starts_with("ST : ") || it.starts_with("IL : ")),
    ];
    for (name, extension, text, starts) in texts {
        if !wanted.is_empty() && !wanted.iter().any(|it| name.contains(it.as_str())) {
            continue;
        }
        let folder = tempfile::tempdir().expect("there is room");
        let root = folder.path().canonicalize().expect("the folder is there");
        let files = files(&text, starts);
        for (at, text) in files.iter().enumerate() {
            std::fs::write(root.join(format!("{at:03}.{extension}")), text).expect("there is room");
        }
        measure(name, &root, &format!("000.{extension}"), &files);
    }
}

fn measure(name: &str, root: &Path, typed_in: &str, files: &[String]) {
    let lines = |it: &String| it.lines().count();
    println!(
        "{name}: {} files, {} lines, {} of them in the file that is typed in",
        files.len(),
        files.iter().map(lines).sum::<usize>(),
        lines(&files[0])
    );
    let uri = lsp_types::Uri::from_file_path(root.join(typed_in)).expect("an absolute path").to_string();
    let item = json!({ "uri": uri, "languageId": "plc", "version": 1, "text": files[0] });

    // A client that is told of findings, with one document open.
    let pushed = json!({ "textDocument": { "publishDiagnostics": { "versionSupport": true } } });
    let start = Instant::now();
    let (mut client, server) = open(root, &pushed);
    client.notify("textDocument/didOpen", json!({ "textDocument": item }));
    while client.first_findings.is_none() {
        client.receive();
    }
    println!("  opened, to the first findings: {:.0} ms", milliseconds(start.elapsed()));
    close(client, server);

    // A client that asks for findings.
    let pulled = json!({ "textDocument": { "diagnostic": {} } });
    let start = Instant::now();
    let (mut client, server) = open(root, &pulled);
    client.notify("textDocument/didOpen", json!({ "textDocument": item }));
    let pull = json!({ "textDocument": { "uri": uri } });
    let report = client.ask("textDocument/diagnostic", pull.clone());
    let found = report["items"].as_array().map_or(0, Vec::len);
    println!("  opened, to the {found} findings of the file: {:.0} ms", milliseconds(start.elapsed()));

    for (pause, name) in [(Duration::ZERO, "one after the other"), (PAUSE, "30 ms after one another")] {
        let mut took = type_in(&mut client, &uri, &files[0], pause);
        took.sort_unstable();
        let at = |hundredth: usize| milliseconds(took[(took.len() * hundredth / 100).min(took.len() - 1)]);
        println!(
            "  typed, {name}, to findings: p50 {:.1} ms, p90 {:.1} ms, p99 {:.1} ms, worst {:.1} ms",
            at(50),
            at(90),
            at(99),
            at(100)
        );
    }
    close(client, server);
}

/// Types a character at a random place, takes it back, and so on. How long the findings take after each.
fn type_in(client: &mut Client, uri: &str, text: &str, pause: Duration) -> Vec<Duration> {
    let mut random = Random::new(11);
    let text: Vec<&str> = text.lines().collect();
    let pull = json!({ "textDocument": { "uri": uri } });
    let mut took = Vec::new();
    let mut typed = None;
    for _ in 0..EDITS {
        let (line, from, to, inserted) = match typed.take() {
            Some((line, column)) => (line, column, column + 1, ""),
            None => {
                let line = random.below(text.len() as u64) as usize;
                let column = random.below(text[line].chars().count() as u64 + 1) as usize;
                typed = Some((line, column));
                (line, column, column, random.pick(&["1", "0", "M", "E", " ", ";", "(", "=", ".", "N", "A"]))
            }
        };
        client.version += 1;
        let range = json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
        let change = json!({
            "textDocument": { "uri": uri, "version": client.version },
            "contentChanges": [{ "range": range, "text": inserted }],
        });
        let start = Instant::now();
        client.notify("textDocument/didChange", change);
        client.ask("textDocument/diagnostic", pull.clone());
        took.push(start.elapsed());
        std::thread::sleep(pause);
    }
    took
}

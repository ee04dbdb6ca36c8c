//! A client for tests: it speaks JSON, as any editor does.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::Duration;

use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use plclint::server::{Ended, run};
use serde_json::{Value, json};

/// Long enough for a debug build on a loaded machine; a test that waits so long has failed.
const PATIENCE: Duration = Duration::from_secs(120);

pub struct Client {
    connection: Option<Connection>,
    server: Option<JoinHandle<Ended>>,
    folder: tempfile::TempDir,
    root: PathBuf,
    next: i32,
    versions: BTreeMap<String, i32>,
    /// What the server said of its own accord and no test has looked at.
    pub notifications: VecDeque<Notification>,
    pub requests: VecDeque<Request>,
    /// Answers that were not asked for yet: they come in any order.
    responses: Vec<Response>,
    /// Findings by file name, as they were pushed last.
    pub pushed: BTreeMap<String, Vec<Value>>,
    pub capabilities: Value,
}

/// What a client with all that matters here says of itself.
pub fn able() -> Value {
    json!({
        "general": { "positionEncodings": ["utf-16"] },
        "workspace": {
            "didChangeWatchedFiles": { "dynamicRegistration": true },
            "workspaceEdit": { "documentChanges": true, "resourceOperations": ["create"] },
            "diagnostics": { "refreshSupport": true },
            "textDocumentContent": {},
        },
        "textDocument": {
            "publishDiagnostics": {
                "relatedInformation": true, "versionSupport": true, "codeDescriptionSupport": true,
                "dataSupport": true, "tagSupport": { "valueSet": [1] },
            },
        },
        "window": { "workDoneProgress": true },
    })
}

/// As [`able`], and asks for findings itself.
pub fn pulling() -> Value {
    let mut it = able();
    it["textDocument"]["diagnostic"] = json!({ "relatedInformation": true, "codeDescriptionSupport": true });
    it
}

impl Client {
    /// A session in a folder with these files.
    pub fn start(capabilities: Value, files: &[(&str, &str)]) -> Self {
        let files: Vec<(&str, &[u8])> = files.iter().map(|it| (it.0, it.1.as_bytes())).collect();
        Self::start_with_bytes(capabilities, &files)
    }

    pub fn start_with_bytes(capabilities: Value, files: &[(&str, &[u8])]) -> Self {
        let mut client = Self::new(files);
        let uri = client.uri("");
        let folders = json!([{ "uri": uri, "name": "test" }]);
        client.initialize(capabilities, folders);
        client
    }

    /// A server that nobody has spoken to.
    pub fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let (server, client) = Connection::memory();
        let this = Self {
            connection: Some(client),
            server: Some(std::thread::spawn(move || run(server))),
            folder,
            root,
            next: 0,
            versions: BTreeMap::new(),
            notifications: VecDeque::new(),
            requests: VecDeque::new(),
            responses: Vec::new(),
            pushed: BTreeMap::new(),
            capabilities: Value::Null,
        };
        for (path, bytes) in files {
            this.write(path, bytes);
        }
        this
    }

    pub fn initialize(&mut self, capabilities: Value, folders: Value) {
        let params =
            json!({ "processId": null, "rootUri": null, "capabilities": capabilities, "workspaceFolders": folders });
        let result = self.ask("initialize", params);
        self.capabilities = result["capabilities"].clone();
        self.notify("initialized", json!({}));
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    pub fn write(&self, path: &str, bytes: &[u8]) {
        let path = self.root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub fn remove(&self, path: &str) {
        std::fs::remove_file(self.root.join(path)).unwrap();
    }

    pub fn uri(&self, path: &str) -> String {
        lsp_types::Uri::from_file_path(self.root.join(path)).unwrap().to_string()
    }

    pub fn name(&self, uri: &str) -> String {
        let path = lsp_types::Uri::parse(uri).unwrap().to_file_path().unwrap();
        path.strip_prefix(&self.root).unwrap_or(&path).to_string_lossy().into_owned()
    }

    pub fn send(&self, message: Message) {
        self.connection.as_ref().unwrap().sender.send(message).unwrap();
    }

    pub fn notify(&self, method: &str, params: Value) {
        self.send(Message::Notification(Notification { method: method.to_owned(), params }));
    }

    /// Sends a request and goes on.
    pub fn post(&mut self, method: &str, params: Value) -> RequestId {
        self.next += 1;
        let id = RequestId::from(self.next);
        self.send(Message::Request(Request { id: id.clone(), method: method.to_owned(), params }));
        id
    }

    /// The answer to a request; an error as `Err` of its code.
    pub fn try_ask(&mut self, method: &str, params: Value) -> Result<Value, i32> {
        let id = self.post(method, params);
        self.answer(&id)
    }

    #[track_caller]
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.try_ask(method, params).unwrap_or_else(|code| panic!("{method} was refused: {code}"))
    }

    pub fn answer(&mut self, id: &RequestId) -> Result<Value, i32> {
        loop {
            if let Some(at) = self.responses.iter().position(|it| it.id == *id) {
                return self.responses.remove(at).response_result.map_err(|it| it.code);
            }
            self.receive();
        }
    }

    /// The next message; what the server says of its own accord is kept as well.
    pub fn receive(&mut self) -> Message {
        let message = self.connection.as_ref().unwrap().receiver.recv_timeout(PATIENCE).expect("the server speaks");
        match &message {
            Message::Notification(it) if it.method == "textDocument/publishDiagnostics" => {
                let name = self.name(it.params["uri"].as_str().unwrap());
                self.pushed.insert(name, it.params["diagnostics"].as_array().unwrap().clone());
            }
            Message::Notification(it) => self.notifications.push_back(it.clone()),
            Message::Request(it) => {
                self.requests.push_back(it.clone());
                let id = it.id.clone();
                self.send(Message::Response(Response { id, response_result: Ok(Value::Null) }));
            }
            Message::Response(it) => self.responses.push(it.clone()),
        }
        message
    }

    /// Receives until something is so.
    pub fn wait(&mut self, is_so: impl Fn(&Self) -> bool) {
        while !is_so(self) {
            self.receive();
        }
    }

    pub fn open(&mut self, path: &str, text: &str) {
        self.versions.insert(path.to_owned(), 1);
        let item = json!({ "uri": self.uri(path), "languageId": "plc", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": item }));
    }

    pub fn open_from_disk(&mut self, path: &str) -> String {
        let text = std::fs::read_to_string(self.root.join(path)).unwrap();
        self.open(path, &text);
        text
    }

    pub fn close(&mut self, path: &str) {
        self.notify("textDocument/didClose", json!({ "textDocument": self.document(path) }));
    }

    pub fn change(&mut self, path: &str, changes: Value) {
        let version = self.versions.entry(path.to_owned()).or_default();
        *version += 1;
        let document =
            json!({ "uri": lsp_types::Uri::from_file_path(self.root.join(path)).unwrap(), "version": version });
        self.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    pub fn replace(&mut self, path: &str, text: &str) {
        self.change(path, json!([{ "text": text }]));
    }

    pub fn document(&self, path: &str) -> Value {
        json!({ "uri": self.uri(path) })
    }

    /// Codes, places and messages that a pull of one document brings.
    pub fn pull(&mut self, path: &str) -> Vec<String> {
        let report = self.ask("textDocument/diagnostic", json!({ "textDocument": self.document(path) }));
        assert_eq!(report["kind"], "full");
        report["items"].as_array().unwrap().iter().map(line).collect()
    }

    /// Codes, places and messages of all files, each with its path.
    pub fn pull_all(&mut self) -> Vec<String> {
        let report = self.ask("workspace/diagnostic", json!({ "previousResultIds": [] }));
        let mut lines = Vec::new();
        for file in report["items"].as_array().unwrap() {
            let name = self.name(file["uri"].as_str().unwrap());
            lines.extend(file["items"].as_array().unwrap().iter().map(|it| format!("{name}:{}", line(it))));
        }
        lines
    }

    pub fn pushed(&self, path: &str) -> Vec<String> {
        self.pushed.get(path).into_iter().flatten().map(line).collect()
    }

    /// Ends the session as the protocol wants it.
    pub fn stop(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        assert_eq!(self.ended(), Ended::Properly);
    }

    /// Goes away without a word.
    pub fn die(mut self) -> Ended {
        self.connection = None;
        self.ended()
    }

    pub fn ended(&mut self) -> Ended {
        self.server.take().unwrap().join().expect("the server does not panic")
    }

    /// Everything that `plclint check` finds in the folder, in the form of [`Self::pull_all`].
    pub fn check(&self) -> Vec<String> {
        check(&self.root, self.folder.path())
    }
}

/// `W001 3:7-3:12 message`, lines and columns counted from 1.
pub fn line(diagnostic: &Value) -> String {
    let place = |end: &str| {
        let it = &diagnostic["range"][end];
        format!("{}:{}", it["line"].as_u64().unwrap() + 1, it["character"].as_u64().unwrap() + 1)
    };
    let code = diagnostic["code"].as_str().unwrap();
    format!("{code} {}-{} {}", place("start"), place("end"), diagnostic["message"].as_str().unwrap())
}

fn check(root: &Path, _: &Path) -> Vec<String> {
    use plclint::lint::settings::Overrides;
    use plclint::load::{Loader, Source, read};
    use plclint::source::detect::Dialect;

    let settings = Loader::new(Source::Discover, Overrides::default()).unwrap().settings(root).unwrap();
    let files = read(&[root.to_owned()], &settings, Dialect::Auto);
    let outcome = plclint::db::check(files.inputs, settings);
    let mut lines = Vec::new();
    for it in outcome.diagnostics.iter().filter(|it| it.suppressed.is_none()) {
        let file = &outcome.files[it.finding.place.file as usize];
        let index = plclint::report::position::LineIndex::new(&file.text);
        let place = |at| {
            let it = index.line_col_utf16(at);
            format!("{}:{}", it.line, it.column)
        };
        let (range, code) = (it.finding.place.range, it.finding.rule.code);
        let name = Path::new(&file.path).strip_prefix(root).unwrap().display().to_string();
        let notes: String = it.finding.notes.iter().map(|it| format!("\nnote: {it}")).collect();
        lines.push(format!(
            "{name}:{code} {}-{} {}{notes}",
            place(range.start()),
            place(range.end()),
            it.finding.message
        ));
    }
    lines
}

impl Drop for Client {
    fn drop(&mut self) {
        self.connection = None;
        if let Some(server) = self.server.take() {
            let ended = server.join();
            assert!(ended.is_ok() || std::thread::panicking(), "the server does not panic");
        }
    }
}

//! The main thread: takes messages in their order, writes to databases, hands reads to the workers.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::thread;
use std::time::Duration;

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::{
    self as lsp, Diagnostic, DidChangeTextDocumentParams, DidChangeWatchedFilesParams, DidChangeWorkspaceFoldersParams,
    DidCloseTextDocumentParams, DidOpenTextDocumentParams, DidSaveTextDocumentParams, FileChangeType, InitializeParams,
    PublishDiagnosticsParams, Uri, WorkDoneProgressBegin, WorkDoneProgressEnd, WorkDoneProgressReport,
    WorkspaceFolders,
};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::capabilities;
use super::client::{Abilities, Client};
use super::convert;
use super::diagnostics::{self, FileDiagnostics, Known};
use super::document::{Document, Documents};
use super::requests::{self, Fault};
use super::snapshot::{RootSnapshot, Snapshot};
use super::state::{Loaded, Root};
use super::transport;
use super::workers::Workers;
use crate::db::{self, RootDatabase, SourceFile};
use crate::lint::settings::FILE_NAME;
use crate::source::detect::has_plc_extension;
use crate::source::walk;

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// As the protocol wants it.
    Properly,
    /// The client went away, or left without having asked to.
    Abruptly,
}

/// A client that asks for findings does so as soon as something was typed. What it does not ask for waits so long, to be out
/// of the way.
const PAUSE: Duration = Duration::from_millis(10);

enum Event {
    Message(Message),
    /// There will be no further messages.
    Gone,
    Loaded(Box<Loaded>),
    Answer {
        response: Response,
        told: Vec<(String, Arc<FileDiagnostics>)>,
        revision: u64,
    },
    /// A write came between.
    Stale(Request),
    /// Nothing to tell before something is other than in that revision.
    Suspended(Request, u64),
    /// Findings of a file that are others than those told before.
    Found {
        revision: u64,
        path: String,
        found: Arc<FileDiagnostics>,
    },
    /// Findings in the configuration of a root.
    Configured {
        revision: u64,
        root: u32,
        items: Vec<Diagnostic>,
    },
    Progress {
        token: String,
        percentage: u32,
    },
    Done {
        token: String,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    New,
    Running,
    /// The client has asked to shut down: only `exit` may follow.
    Down,
}

/// Serves the client at the other end until it ends the session or goes away.
pub fn run(connection: Connection) -> Ended {
    let Connection { sender, receiver } = connection;
    let (events, queue) = channel();
    let forward = events.clone();
    let forwarder = thread::Builder::new().name("forwarder".to_owned()).spawn(move || {
        for message in receiver {
            if forward.send(Event::Message(message)).is_err() {
                return;
            }
        }
        let _ = forward.send(Event::Gone);
    });
    if forwarder.is_err() {
        return Ended::Abruptly;
    }
    // A client that has gone is noticed by the forwarder.
    let client = Client::new(move |message| drop(sender.send(message)));
    Server::new(client, events).run(&queue)
}

struct Server {
    client: Client,
    abilities: Arc<Abilities>,
    events: Sender<Event>,
    workers: Workers,
    stage: Stage,
    roots: Vec<Root>,
    /// A snapshot shares them: a change copies the map, not the texts.
    documents: Arc<Documents>,
    known: Arc<Known>,
    /// Diagnostics told in configurations.
    configs: FxHashMap<PathBuf, Vec<Diagnostic>>,
    /// Findings in the configurations of roots.
    configured: FxHashMap<u32, Vec<Diagnostic>>,
    /// Configurations that cannot be used, as the user was told.
    wrong: FxHashSet<PathBuf>,
    /// Requests without answer. What is set to true needs none.
    pending: FxHashMap<RequestId, Arc<AtomicBool>>,
    /// Requests that wait until the folders are read.
    deferred: Vec<Request>,
    /// Requests that wait until something changes.
    suspended: Vec<Request>,
    /// Rises with each write.
    revision: u64,
    /// The revision whose findings were last asked for.
    flushed: u64,
    /// Documents as they were changed, the last one last.
    recent: Vec<String>,
    /// Roots whose files were never checked, with the token of the progress that tells of it.
    cold: Vec<(u32, Option<String>)>,
    numbers: u32,
}

impl Server {
    fn new(client: Client, events: Sender<Event>) -> Self {
        Self {
            client,
            abilities: Arc::default(),
            events,
            workers: Workers::new(),
            stage: Stage::New,
            roots: Vec::new(),
            documents: Arc::default(),
            known: Arc::default(),
            configs: FxHashMap::default(),
            configured: FxHashMap::default(),
            wrong: FxHashSet::default(),
            pending: FxHashMap::default(),
            deferred: Vec::new(),
            suspended: Vec::new(),
            revision: 0,
            flushed: 0,
            recent: Vec::new(),
            cold: Vec::new(),
            numbers: 0,
        }
    }

    fn run(mut self, queue: &Receiver<Event>) -> Ended {
        loop {
            let event = match queue.try_recv() {
                // Findings are asked for when all that was typed meanwhile is in.
                Err(TryRecvError::Empty) => match self.wait() {
                    Some(pause) => queue.recv_timeout(pause),
                    None => queue.recv().map_err(|_| RecvTimeoutError::Disconnected),
                },
                Err(TryRecvError::Disconnected) => Err(RecvTimeoutError::Disconnected),
                Ok(event) => Ok(event),
            };
            let ended = match event {
                Ok(event) => self.event(event),
                Err(RecvTimeoutError::Timeout) => {
                    self.flush();
                    None
                }
                Err(RecvTimeoutError::Disconnected) => Some(Ended::Abruptly),
            };
            if let Some(ended) = ended {
                return ended;
            }
        }
    }

    /// Before the server waits for messages: asks for findings, or says how long it waits before it does.
    fn wait(&mut self) -> Option<Duration> {
        let is_loading = self.roots.iter().any(|it| it.loading.is_some());
        if !is_loading {
            std::mem::take(&mut self.deferred).into_iter().for_each(|it| self.dispatch(it));
        }
        if self.stage != Stage::Running || is_loading || self.flushed == self.revision {
            return None;
        }
        if !self.abilities.pulls || !self.cold.is_empty() {
            self.flush();
            return None;
        }
        // Its answer comes as a message.
        let is_asked = self.pending.len() > self.suspended.len();
        (!is_asked).then_some(PAUSE)
    }

    fn number(&mut self) -> u32 {
        self.numbers = self.numbers.wrapping_add(1);
        self.numbers
    }

    fn event(&mut self, event: Event) -> Option<Ended> {
        match event {
            Event::Gone => return Some(Ended::Abruptly),
            Event::Message(Message::Request(request)) => self.request(request),
            Event::Message(Message::Notification(it)) if it.method == "exit" => {
                return Some(if self.stage == Stage::Down { Ended::Properly } else { Ended::Abruptly });
            }
            Event::Message(Message::Notification(it)) => self.notification(it),
            // Nothing is asked of the client whose answer matters.
            Event::Message(Message::Response(_)) => {}
            Event::Loaded(loaded) => self.loaded(*loaded),
            Event::Answer { response, told, revision } => {
                if revision == self.revision && !told.is_empty() {
                    Arc::make_mut(&mut self.known).extend(told);
                }
                self.answer(response);
            }
            Event::Stale(request) => self.stale(request),
            Event::Suspended(request, revision) => {
                if revision != self.revision {
                    self.dispatch(request);
                } else if self.pending.contains_key(&request.id) {
                    self.suspended.push(request);
                }
            }
            Event::Found { revision, path, found } => {
                if revision == self.revision {
                    self.publish(path, found);
                }
            }
            Event::Configured { revision, root, items } => {
                if revision == self.revision {
                    self.configured.insert(root, items);
                    self.tell_configs();
                }
            }
            Event::Progress { token, percentage } => {
                let report = WorkDoneProgressReport { percentage: Some(percentage), ..Default::default() };
                self.client.progress(&token, &report);
            }
            Event::Done { token } => self.client.progress(&token, &WorkDoneProgressEnd { message: None }),
        }
        None
    }

    // Requests.

    fn request(&mut self, request: Request) {
        let refusal = match (self.stage, request.method.as_str()) {
            (Stage::New, "initialize") => return self.initialize(request),
            (Stage::New, _) => Some((ErrorCode::ServerNotInitialized, "`initialize` comes first")),
            (Stage::Running, "initialize") => Some((ErrorCode::InvalidRequest, "the session is already initialized")),
            (Stage::Running, "shutdown") => {
                self.stage = Stage::Down;
                for request in std::mem::take(&mut self.suspended) {
                    self.refuse(request.id, ErrorCode::RequestCanceled, "the session ends");
                }
                return self.client.respond(Response { id: request.id, response_result: Ok(Value::Null) });
            }
            (Stage::Running, method) if requests::find(method).is_none() => {
                Some((ErrorCode::MethodNotFound, "there is no such request"))
            }
            (Stage::Running, _) => None,
            (Stage::Down, _) => Some((ErrorCode::InvalidRequest, "the session is shut down")),
        };
        if let Some((code, message)) = refusal {
            return self.refuse(request.id, code, message);
        }
        self.pending.insert(request.id.clone(), Arc::default());
        self.dispatch(request);
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, message: &str) {
        self.client.respond(Response::new_err(id, code as i32, message.to_owned()));
    }

    /// Hands a request to the workers.
    fn dispatch(&mut self, request: Request) {
        if self.roots.iter().any(|it| it.loading.is_some()) {
            self.deferred.push(request);
            return;
        }
        let Some(cancelled) = self.pending.get(&request.id).cloned() else { return };
        let Some(handler) = requests::find(&request.method) else { return };
        let (snapshot, events, revision) = (self.snapshot(), self.events.clone(), self.revision);
        self.workers.run(move || {
            if cancelled.load(Ordering::Relaxed) {
                return;
            }
            let params = request.params.clone();
            let ask = || db::unless_cancelled(|| (handler.run)(&snapshot, params));
            let answer = catch_unwind(AssertUnwindSafe(ask));
            let told = snapshot.told.take();
            // A write waits for it.
            drop(snapshot);
            let respond = |response_result| Event::Answer {
                response: Response { id: request.id.clone(), response_result },
                told,
                revision,
            };
            let error = |code: ErrorCode, message: String| {
                Err(lsp_server::ResponseError { code: code as i32, message, data: None })
            };
            let event = match answer {
                Ok(Some(Ok(value))) => respond(Ok(value)),
                Ok(Some(Err(Fault::Unchanged))) => Event::Suspended(request, revision),
                Ok(Some(Err(Fault::Refused(message)))) => respond(error(ErrorCode::RequestFailed, message)),
                Ok(Some(Err(Fault::Params(message)))) => respond(error(ErrorCode::InvalidParams, message)),
                Ok(None) => Event::Stale(request),
                Err(_) => respond(error(ErrorCode::InternalError, "internal error: please report it".to_owned())),
            };
            // Fails when the session is over.
            let _ = events.send(event);
        });
    }

    fn answer(&mut self, response: Response) {
        // One that was cancelled has its answer.
        if self.pending.remove(&response.id).is_some() {
            self.client.respond(response);
        }
    }

    fn stale(&mut self, request: Request) {
        if requests::find(&request.method).is_some_and(|it| it.retry) {
            return self.dispatch(request);
        }
        if self.pending.remove(&request.id).is_some() {
            self.refuse(request.id, ErrorCode::ContentModified, "the text has changed");
        }
    }

    fn cancel(&mut self, id: RequestId) {
        if let Some(cancelled) = self.pending.remove(&id) {
            cancelled.store(true, Ordering::Relaxed);
            self.deferred.retain(|it| it.id != id);
            self.suspended.retain(|it| it.id != id);
            self.refuse(id, ErrorCode::RequestCanceled, "cancelled by the client");
        }
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            roots: self.roots.iter().map(Root::snapshot).collect(),
            documents: self.documents.clone(),
            abilities: self.abilities.clone(),
            known: self.known.clone(),
            told: Default::default(),
        }
    }

    fn initialize(&mut self, request: Request) {
        let params: InitializeParams = match serde_json::from_value(request.params) {
            Ok(params) => params,
            Err(error) => return self.refuse(request.id, ErrorCode::InvalidParams, &error.to_string()),
        };
        self.stage = Stage::Running;
        self.abilities = Arc::new(Abilities::new(&params.capabilities));
        let result = serde_json::to_value(capabilities::server(&self.abilities)).unwrap_or_default();
        self.client.respond(Response { id: request.id, response_result: Ok(result) });
        let folders: Vec<Uri> = match params.workspace_folders_initialize_params.workspace_folders {
            Some(WorkspaceFolders::WorkspaceFolderList(folders)) => folders.into_iter().map(|it| it.uri).collect(),
            #[expect(deprecated, reason = "clients that know no folders have one root")]
            _ => params.root_uri.into_iter().collect(),
        };
        self.add_folders(folders);
    }

    // Notifications.

    fn notification(&mut self, it: Notification) {
        if it.method == transport::MALFORMED {
            let (id, error) = transport::told(&it.params);
            return match id {
                Some(id) => self.client.respond(Response { id, response_result: Err(error) }),
                None => self.client.log(error.message),
            };
        }
        if self.stage != Stage::Running {
            return;
        }
        let Notification { method, params } = it;
        match method.as_str() {
            "initialized" if self.abilities.watches_files => {
                self.client.request::<lsp::RegistrationRequest>(capabilities::watched_files());
            }
            "$/cancelRequest" => {
                let id = params.get("id").cloned().and_then(|it| serde_json::from_value(it).ok());
                if let Some(id) = id {
                    self.cancel(id);
                }
            }
            "textDocument/didOpen" => self.with_params(&method, params, Self::did_open),
            "textDocument/didChange" => self.with_params(&method, params, Self::did_change),
            "textDocument/didClose" => self.with_params(&method, params, Self::did_close),
            "textDocument/didSave" => self.with_params(&method, params, Self::did_save),
            "workspace/didChangeWatchedFiles" => self.with_params(&method, params, Self::did_change_files),
            "workspace/didChangeWorkspaceFolders" => self.with_params(&method, params, Self::did_change_folders),
            _ => {}
        }
    }

    fn with_params<P: DeserializeOwned>(&mut self, method: &str, params: Value, handle: impl FnOnce(&mut Self, P)) {
        match serde_json::from_value(params) {
            Ok(params) => handle(self, params),
            Err(error) => self.client.log(format!("{method}: {error}")),
        }
    }

    fn did_open(&mut self, params: DidOpenTextDocumentParams) {
        let it = params.text_document;
        let path = convert::path_of(&it.uri);
        Arc::make_mut(&mut self.documents).insert(path.clone(), Document::new(it.uri, it.version, it.text));
        self.shown(&path);
    }

    fn did_change(&mut self, params: DidChangeTextDocumentParams) {
        let it = params.text_document;
        let path = convert::path_of(&it.text_document_identifier.uri);
        let Some(document) = Arc::make_mut(&mut self.documents).get_mut(&path) else {
            self.client.log(format!("{path}: a change of a document that is not open"));
            return;
        };
        document.version = it.version;
        document.change(params.content_changes, self.abilities.encoding);
        self.shown(&path);
    }

    /// A document has the text that the client shows now.
    fn shown(&mut self, path: &str) {
        self.revision += 1;
        if is_config(path) {
            return self.reload_configs(path);
        }
        let Some(text) = self.documents.get(path).map(|it| it.text.clone()) else { return };
        self.recent.retain(|it| it != path);
        self.recent.push(path.to_owned());
        let root = self.root_of(path);
        if let Some(root) = self.roots.get_mut(root) {
            root.show(path, &text);
            root.list();
        }
        self.tell_configs();
    }

    fn did_close(&mut self, params: DidCloseTextDocumentParams) {
        let path = convert::path_of(&params.text_document.uri);
        if Arc::make_mut(&mut self.documents).remove(&path).is_none() {
            return;
        }
        self.revision += 1;
        self.recent.retain(|it| *it != path);
        if is_config(&path) {
            return self.reload_configs(&path);
        }
        let root = self.root_of(&path);
        if let Some(root) = self.roots.get_mut(root) {
            root.hide(&path);
            root.list();
        }
        self.roots.retain(|it| it.folder.is_some() || it.has_files());
        self.tell_configs();
    }

    fn did_save(&mut self, params: DidSaveTextDocumentParams) {
        let path = convert::path_of(&params.text_document.uri);
        // A client that watches files tells of it as well.
        if is_config(&path) && !self.documents.contains_key(&path) {
            self.revision += 1;
            self.reload_configs(&path);
        }
    }

    fn did_change_files(&mut self, params: DidChangeWatchedFilesParams) {
        // By their ids: a configuration changes the places of roots.
        let mut reload: FxHashSet<u32> = FxHashSet::default();
        for event in params.changes {
            let path = convert::path_of(&event.uri);
            self.revision += 1;
            let name = Path::new(&path).file_name().unwrap_or_default();
            if is_config(&path) {
                self.reload_configs(&path);
                continue;
            }
            let Some(root) = self.folder_of(&path) else { continue };
            if name == ".gitignore" || name == ".ignore" {
                reload.insert(self.roots[root].id);
            } else if !has_plc_extension(Path::new(&path)) && Path::new(&path).extension().is_some() {
                continue;
            } else if event.kind != FileChangeType::Changed || !self.roots[root].found(&path) {
                reload.insert(self.roots[root].id);
            } else if !self.documents.contains_key(&path)
                && let Some(root) = self.roots.get_mut(root)
            {
                root.read(&path);
                root.list();
            }
        }
        let places: Vec<usize> = (0..self.roots.len()).filter(|&at| reload.contains(&self.roots[at].id)).collect();
        places.into_iter().for_each(|at| self.start_load(at));
        self.client.refresh(&self.abilities);
    }

    fn did_change_folders(&mut self, params: DidChangeWorkspaceFoldersParams) {
        let removed: Vec<PathBuf> = params.event.removed.iter().filter_map(|it| it.uri.to_file_path().ok()).collect();
        self.roots.retain(|it| it.folder.as_ref().is_none_or(|it| !removed.contains(it)));
        self.revision += 1;
        self.add_folders(params.event.added.into_iter().map(|it| it.uri).collect());
        // What was outside may be inside of a folder now, and the other way round.
        self.place_outsiders();
        let folders: Vec<usize> = (0..self.roots.len()).filter(|&at| self.roots[at].folder.is_some()).collect();
        folders.into_iter().for_each(|at| self.start_load(at));
        self.tell_configs();
    }

    // Folders and configurations.

    fn add_folders(&mut self, folders: Vec<Uri>) {
        for folder in folders {
            let Ok(folder) = folder.to_file_path() else { continue };
            if self.roots.iter().any(|it| it.folder.as_ref() == Some(&folder)) {
                continue;
            }
            let id = self.number();
            self.roots.push(Root::folder(id, folder));
            self.start_load(self.roots.len() - 1);
        }
    }

    /// The folder of the workspace that a path lies in, the deepest of them.
    fn folder_of(&self, path: &str) -> Option<usize> {
        let depths = self.roots.iter().enumerate().filter_map(|(at, it)| Some((it.depth_around(path)?, at)));
        depths.max().map(|it| it.1)
    }

    /// Finds the configurations of documents outside of all folders anew.
    fn place_outsiders(&mut self) {
        self.roots.retain(|it| it.folder.is_some());
        let open: Vec<(String, Arc<str>)> =
            self.documents.iter().map(|(path, it)| (path.clone(), it.text.clone())).collect();
        for (path, text) in open {
            if !is_config(&path) && self.folder_of(&path).is_none() {
                let at = self.root_of(&path);
                if let Some(root) = self.roots.get_mut(at) {
                    root.show(&path, &text);
                    root.list();
                }
            }
        }
    }

    /// The root of a document; made for one outside of all folders.
    fn root_of(&mut self, path: &str) -> usize {
        if let Some(at) = self.folder_of(path) {
            return at;
        }
        if let Some(at) = self.roots.iter().position(|it| it.folder.is_none() && it.knows(path)) {
            return at;
        }
        let id = self.number();
        let new = Root::outside(id, path, self.open_configs());
        let same = self.roots.iter().position(|it| it.folder.is_none() && it.config == new.config);
        same.unwrap_or_else(|| {
            self.roots.push(new);
            self.roots.len() - 1
        })
    }

    /// Configurations that are open in the client.
    fn open_configs(&self) -> Vec<(PathBuf, String)> {
        let configs = self.documents.iter().filter(|it| is_config(it.0));
        configs.map(|(path, it)| (PathBuf::from(path), it.text.to_string())).collect()
    }

    /// A configuration has changed, come or gone.
    fn reload_configs(&mut self, path: &str) {
        let folder = Path::new(path).parent().unwrap_or(Path::new("")).to_owned();
        for at in 0..self.roots.len() {
            // It may lie above the folder; what lies deeper in the folder is none of its business.
            if self.roots[at].folder.as_ref().is_some_and(|own| own.starts_with(&folder)) {
                self.start_load(at);
            }
        }
        self.place_outsiders();
        self.tell_configs();
    }

    /// Reads a folder in the background.
    fn start_load(&mut self, at: usize) {
        let number = self.number();
        let configs = self.open_configs();
        let Some(root) = self.roots.get_mut(at) else { return };
        let Some(folder) = root.folder.clone() else { return };
        root.loading = Some(number);
        let (id, settings, events) = (root.id, root.settings(), self.events.clone());
        if self.abilities.progress {
            let token = token(number);
            self.client.request::<lsp::WorkDoneProgressCreateRequest>(lsp::WorkDoneProgressCreateParams {
                token: lsp::ProgressToken::String(token.clone()),
            });
            let begin = WorkDoneProgressBegin {
                title: "plclint".to_owned(),
                message: Some("reading programs".to_owned()),
                percentage: Some(0),
                cancellable: None,
            };
            self.client.progress(&token, &begin);
        }
        self.workers.run(move || {
            let load = || Loaded::read(id, number, &folder, configs, &settings);
            let event = match catch_unwind(load) {
                Ok(loaded) => Event::Loaded(Box::new(loaded)),
                Err(_) => Event::Loaded(Box::new(Loaded::nothing(id, number, settings))),
            };
            let _ = events.send(event);
        });
    }

    fn loaded(&mut self, loaded: Loaded) {
        let token = token(loaded.number);
        let is_wanted = |it: &Root| it.id == loaded.root && it.loading == Some(loaded.number);
        let Some(at) = self.roots.iter().position(is_wanted) else {
            // Another load has overtaken it.
            return self.end_progress(&token);
        };
        self.revision += 1;
        let depths: Vec<PathBuf> = self.roots.iter().filter_map(|it| it.folder.clone()).collect();
        let folder = self.roots[at].folder.clone().unwrap_or_default();
        let is_own = |path: &str| {
            let around = depths.iter().filter(|it| Path::new(path).starts_with(it));
            around.max_by_key(|it| it.components().count()) == Some(&folder)
        };
        loaded.report(&folder).into_iter().for_each(|line| self.client.log(line));
        let root = &mut self.roots[at];
        root.loading = None;
        root.load(loaded, &self.documents, is_own);
        self.cold.push((self.roots[at].id, self.abilities.progress.then_some(token)));
        self.tell_configs();
        self.client.refresh(&self.abilities);
    }

    fn end_progress(&self, token: &str) {
        if self.abilities.progress {
            self.client.progress(token, &WorkDoneProgressEnd { message: None });
        }
    }

    /// Says what is wrong with configurations, and what is no longer.
    fn tell_configs(&mut self) {
        let mut wrong: FxHashMap<PathBuf, Vec<Diagnostic>> = FxHashMap::default();
        for it in self.roots.iter().filter_map(|it| it.wrong.as_ref()) {
            let Some(file) = it.file.clone() else { continue };
            let text = match self.documents.get(&*file.to_string_lossy()) {
                Some(document) => document.text.to_string(),
                None => String::from_utf8_lossy(&walk::read(&file).unwrap_or_default()).into_owned(),
            };
            wrong.entry(file).or_insert_with(|| vec![diagnostics::of_config(it, &text, self.abilities.encoding)]);
        }
        for file in wrong.keys().filter(|it| !self.wrong.contains(*it)) {
            self.client.show_error(format!("{}: the configuration is wrong and not used", file.display()));
        }
        self.wrong = wrong.keys().cloned().collect();
        for root in &self.roots {
            if let (Some(file), Some(found)) = (&root.config, self.configured.get(&root.id))
                && !found.is_empty()
            {
                wrong.entry(file.clone()).or_insert_with(|| found.clone());
            }
        }
        for (file, found) in &wrong {
            if self.configs.get(file) != Some(found) {
                self.publish_config(file, found.clone());
            }
        }
        for file in self.configs.keys().filter(|it| !wrong.contains_key(*it)) {
            self.publish_config(file, Vec::new());
        }
        self.configs = wrong;
    }

    fn publish_config(&self, file: &Path, diagnostics: Vec<Diagnostic>) {
        let path = crate::load::shown(file);
        let open = self.documents.get(&path);
        let Some(uri) = open.map(|it| it.uri.clone()).or_else(|| convert::uri_of(&path)) else { return };
        let version = open.map(|it| it.version).filter(|_| self.abilities.versions);
        self.client.notify::<lsp::PublishDiagnosticsNotification>(PublishDiagnosticsParams {
            uri,
            version,
            diagnostics,
        });
    }

    // Findings.

    /// All messages are in: asks for the findings of what they made.
    fn flush(&mut self) {
        self.flushed = self.revision;
        self.forget_vanished();
        std::mem::take(&mut self.suspended).into_iter().for_each(|it| self.dispatch(it));
        let cold = std::mem::take(&mut self.cold);
        let (pushes, revision) = (!self.abilities.pulls, self.revision);
        let (snapshot, events) = (self.snapshot(), self.events.clone());
        let first: Vec<String> = self.recent.iter().rev().cloned().collect();
        self.workers.run(move || {
            let work = || {
                for root in &snapshot.roots {
                    if let Some((_, token)) = cold.iter().find(|it| it.0 == root.id) {
                        warm(root, token.as_deref(), &events);
                    }
                }
                for root in snapshot.roots.iter().filter(|it| it.config.is_some()) {
                    let found = db::configuration_findings(&root.db);
                    let items = found.iter().map(|it| diagnostics::diagnostic(&snapshot, root, None, it)).collect();
                    let _ = events.send(Event::Configured { revision, root: root.id, items });
                }
                if pushes {
                    push(&snapshot, &first, |path, found| {
                        let _ = events.send(Event::Found { revision, path, found });
                    });
                }
                snapshot.roots.iter().for_each(|it| it.db.get_ready());
            };
            // A write ends it, and asks for the findings of what it made.
            let _ = catch_unwind(AssertUnwindSafe(|| db::unless_cancelled(work)));
            for token in cold.into_iter().filter_map(|it| it.1) {
                let _ = events.send(Event::Done { token });
            }
        });
    }

    /// Takes back findings of files that are checked no longer.
    fn forget_vanished(&mut self) {
        let snapshot = self.snapshot();
        let is_there = |path: &String| snapshot.roots.iter().any(|it| it.files.contains_key(path));
        let vanished: Vec<String> = self.known.keys().filter(|it| !is_there(it)).cloned().collect();
        for path in vanished {
            let known = Arc::make_mut(&mut self.known).remove(&path);
            if !self.abilities.pulls && known.is_some_and(|it| !it.items.is_empty()) {
                self.publish_items(&path, Vec::new());
            }
        }
    }

    fn publish(&mut self, path: String, found: Arc<FileDiagnostics>) {
        let known = Arc::make_mut(&mut self.known).insert(path.clone(), found.clone());
        // Of a file that never had findings, there is nothing to take back; of an open one, the client wants to know that it
        // was looked at.
        let is_same = match &known {
            Some(known) => known.items == found.items,
            None => found.items.is_empty() && !self.documents.contains_key(&path),
        };
        if !is_same {
            self.publish_items(&path, found.items.clone());
        }
    }

    fn publish_items(&self, path: &str, diagnostics: Vec<Diagnostic>) {
        let open = self.documents.get(path);
        let Some(uri) = open.map(|it| it.uri.clone()).or_else(|| convert::uri_of(path)) else { return };
        let version = open.map(|it| it.version).filter(|_| self.abilities.versions);
        self.client.notify::<lsp::PublishDiagnosticsNotification>(PublishDiagnosticsParams {
            uri,
            version,
            diagnostics,
        });
    }
}

fn token(number: u32) -> String {
    format!("plclint/load/{number}")
}

fn is_config(path: &str) -> bool {
    Path::new(path).file_name().is_some_and(|it| it == FILE_NAME)
}

/// Analyses all units of a folder on all processors, so that what is asked next finds them done.
fn warm(root: &RootSnapshot, token: Option<&str>, events: &Sender<Event>) {
    let files: Vec<SourceFile> = root.files.values().copied().collect();
    let (count, done) = (files.len().max(1), AtomicUsize::new(0));
    files.par_iter().for_each_with((root.db.clone(), events.clone()), |(db, events), &file| {
        analyse(db, file);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        let percentage = |it: usize| u32::try_from(it * 100 / count).unwrap_or(100);
        if let Some(token) = token.filter(|_| percentage(done) != percentage(done - 1)) {
            let _ = events.send(Event::Progress { token: token.to_owned(), percentage: percentage(done) });
        }
    });
}

fn analyse(db: &RootDatabase, file: SourceFile) {
    for &unit in db::units(db, file) {
        db::facts(db, unit);
    }
}

/// Finds what is new: first in what the user looks at.
fn push(snapshot: &Snapshot, first: &[String], mut tell: impl FnMut(String, Arc<FileDiagnostics>)) {
    let mut done: FxHashSet<&str> = FxHashSet::default();
    let mut files: Vec<(&RootSnapshot, SourceFile)> = Vec::new();
    for path in first {
        for root in &snapshot.roots {
            if let Some(&file) = root.files.get(path)
                && done.insert(path)
            {
                files.push((root, file));
            }
        }
    }
    for root in &snapshot.roots {
        let mut rest: Vec<(&String, &SourceFile)> =
            root.files.iter().filter(|it| !done.contains(it.0.as_str())).collect();
        rest.sort_unstable_by_key(|it| it.0);
        files.extend(rest.into_iter().map(|it| (root, *it.1)));
    }
    for (root, file) in files {
        let found = diagnostics::of_file(snapshot, root, file);
        let path = file.path(&root.db);
        if !snapshot.known.get(path).is_some_and(|it| Arc::ptr_eq(it, &found)) {
            tell(path.to_owned(), found);
        }
    }
}

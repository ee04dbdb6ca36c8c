//! What the server can do, as it tells the client.

use lsp_types::{
    ChangeNotifications, DiagnosticOptions, DiagnosticProvider, DidChangeWatchedFilesRegistrationOptions,
    FileSystemWatcher, GlobPattern, InitializeResult, Registration, RegistrationParams, Save, ServerCapabilities,
    ServerInfo, TextDocumentContent, TextDocumentContentOptions, TextDocumentSync, TextDocumentSyncKind,
    TextDocumentSyncOptions, WorkspaceFoldersServerCapabilities, WorkspaceOptions,
};

use super::client::Abilities;
use super::diagnostics::{PAGES, SOURCE};

pub(super) fn server(client: &Abilities) -> InitializeResult {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::Incremental),
        save: Some(Save::Bool(true)),
        ..Default::default()
    };
    let workspace = WorkspaceOptions {
        workspace_folders: Some(WorkspaceFoldersServerCapabilities {
            supported: Some(true),
            change_notifications: Some(ChangeNotifications::Bool(true)),
        }),
        text_document_content: Some(TextDocumentContent::Options(TextDocumentContentOptions {
            schemes: vec![PAGES.to_owned()],
        })),
        ..Default::default()
    };
    let diagnostics = DiagnosticOptions {
        identifier: Some(SOURCE.to_owned()),
        inter_file_dependencies: true,
        workspace_diagnostics: true,
        ..Default::default()
    };
    let capabilities = ServerCapabilities {
        position_encoding: Some(client.encoding.kind()),
        text_document_sync: Some(TextDocumentSync::Options(sync)),
        diagnostic_provider: client.pulls.then(|| DiagnosticProvider::DiagnosticOptions(diagnostics)),
        workspace: Some(workspace),
        ..Default::default()
    };
    let info = ServerInfo { name: "plclint".to_owned(), version: Some(env!("CARGO_PKG_VERSION").to_owned()) };
    InitializeResult { capabilities, server_info: Some(info) }
}

/// Everything that may be a program or say how to read one: which extensions are programs, the walk decides.
pub(super) fn watched_files() -> RegistrationParams {
    let watcher = FileSystemWatcher { glob_pattern: GlobPattern::Pattern("**/*".to_owned()), kind: None };
    let options = DidChangeWatchedFilesRegistrationOptions { watchers: vec![watcher] };
    let registration = Registration {
        id: "plclint-files".to_owned(),
        method: "workspace/didChangeWatchedFiles".to_owned(),
        register_options: serde_json::to_value(options).ok(),
    };
    RegistrationParams { registrations: vec![registration] }
}

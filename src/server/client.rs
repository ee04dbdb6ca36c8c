//! The client: what it can do, and what it is told.

use std::cell::Cell;

use lsp_server::{Message, Notification, Request, RequestId, Response};
use lsp_types::{
    ClientCapabilities, MessageType, Notification as _, Request as _, ResourceOperationKind, ShowMessageParams,
};
use serde::Serialize;
use serde_json::{Value, json};

use super::convert::Encoding;

/// What of the client's capabilities decides something here.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a capability of the protocol")]
pub(super) struct Abilities {
    pub(super) encoding: Encoding,
    /// Asks for the findings of documents itself.
    pub(super) pulls: bool,
    pub(super) related_information: bool,
    pub(super) tags: bool,
    /// Follows the link of a code, and asks for the text behind it.
    pub(super) rule_pages: bool,
    pub(super) versions: bool,
    pub(super) progress: bool,
    pub(super) watches_files: bool,
    pub(super) document_changes: bool,
    pub(super) creates_files: bool,
    /// Lets the user fill in what an edit leaves open.
    pub(super) snippets: bool,
    pub(super) refreshes_diagnostics: bool,
    pub(super) refreshes_lenses: bool,
    pub(super) refreshes_hints: bool,
    pub(super) refreshes_tokens: bool,
}

impl Abilities {
    pub(super) fn new(client: &ClientCapabilities) -> Self {
        let workspace = client.workspace.as_ref();
        let documents = client.text_document.as_ref();
        let edit = workspace.and_then(|it| it.workspace_edit.as_ref());
        let pull = documents.and_then(|it| it.diagnostic.as_ref());
        let push = documents.and_then(|it| it.publish_diagnostics.as_ref());
        let diagnostics = match (pull, push) {
            (Some(it), _) => Some(&it.diagnostics_capabilities),
            (None, Some(it)) => Some(&it.diagnostics_capabilities),
            (None, None) => None,
        };
        // A client that pulls says of both ways what it can show.
        let has = |of: fn(&lsp_types::DiagnosticsCapabilities) -> bool| {
            diagnostics.is_some_and(of) || push.is_some_and(|it| of(&it.diagnostics_capabilities))
        };
        let known = client.general.as_ref().and_then(|it| it.position_encodings.as_deref()).unwrap_or_default();
        Self {
            encoding: Encoding::negotiate(known),
            pulls: pull.is_some(),
            related_information: has(|it| it.related_information == Some(true)),
            tags: has(|it| it.tag_support.is_some()),
            rule_pages: has(|it| it.code_description_support == Some(true))
                && workspace.is_some_and(|it| it.text_document_content.is_some()),
            versions: push.is_some_and(|it| it.version_support == Some(true)),
            progress: client.window.as_ref().is_some_and(|it| it.work_done_progress == Some(true)),
            watches_files: workspace
                .and_then(|it| it.did_change_watched_files.as_ref())
                .is_some_and(|it| it.dynamic_registration == Some(true)),
            document_changes: edit.is_some_and(|it| it.document_changes == Some(true)),
            creates_files: edit
                .and_then(|it| it.resource_operations.as_ref())
                .is_some_and(|it| it.contains(&ResourceOperationKind::Create)),
            snippets: edit.is_some_and(|it| it.snippet_edit_support == Some(true) && it.document_changes == Some(true)),
            refreshes_diagnostics: workspace
                .and_then(|it| it.diagnostics.as_ref())
                .is_some_and(|it| it.refresh_support == Some(true)),
            refreshes_lenses: workspace
                .and_then(|it| it.code_lens.as_ref())
                .is_some_and(|it| it.refresh_support == Some(true)),
            refreshes_hints: workspace
                .and_then(|it| it.inlay_hint.as_ref())
                .is_some_and(|it| it.refresh_support == Some(true)),
            refreshes_tokens: workspace
                .and_then(|it| it.semantic_tokens.as_ref())
                .is_some_and(|it| it.refresh_support == Some(true)),
        }
    }
}

/// Sends to the client. One that has gone is noticed where messages are received.
#[derive(Debug, Clone)]
pub(super) struct Client {
    send: Sender,
    next: Cell<i32>,
}

#[derive(Clone)]
struct Sender(std::sync::Arc<dyn Fn(Message) + Send + Sync>);

impl std::fmt::Debug for Sender {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Sender")
    }
}

impl Client {
    pub(super) fn new(send: impl Fn(Message) + Send + Sync + 'static) -> Self {
        Self { send: Sender(std::sync::Arc::new(send)), next: Cell::new(0) }
    }

    pub(super) fn respond(&self, response: Response) {
        (self.send.0)(Message::Response(response));
    }

    pub(super) fn notify<N: lsp_types::Notification>(&self, params: N::Params) {
        self.notify_raw(N::METHOD.as_str(), params);
    }

    fn notify_raw(&self, method: &str, params: impl Serialize) {
        let params = serde_json::to_value(params).unwrap_or_default();
        (self.send.0)(Message::Notification(Notification { method: method.to_owned(), params }));
    }

    /// Asks for something whose answer does not matter.
    pub(super) fn request<R: lsp_types::Request>(&self, params: R::Params) {
        let params = serde_json::to_value(params).unwrap_or_default();
        let id = RequestId::from(self.next.replace(self.next.get().wrapping_add(1)));
        (self.send.0)(Message::Request(Request { id, method: R::METHOD.as_str().to_owned(), params }));
    }

    /// A line in the client's log.
    pub(super) fn log(&self, message: impl Into<String>) {
        self.notify::<lsp_types::LogMessageNotification>(lsp_types::LogMessageParams {
            kind: MessageType::Info,
            message: message.into(),
        });
    }

    /// Something that the user must know.
    pub(super) fn show_error(&self, message: impl Into<String>) {
        self.notify::<lsp_types::ShowMessageNotification>(ShowMessageParams {
            kind: MessageType::Error,
            message: message.into(),
        });
    }

    pub(super) fn progress(&self, token: &str, value: &impl Serialize) {
        let value = serde_json::to_value(value).unwrap_or_default();
        self.notify_raw(lsp_types::ProgressNotification::METHOD.as_str(), json!({ "token": token, "value": value }));
    }

    /// Says that what the client has of the kinds that it asks for itself is stale.
    pub(super) fn refresh(&self, abilities: &Abilities) {
        let asked = [
            (abilities.pulls && abilities.refreshes_diagnostics, lsp_types::DiagnosticRefreshRequest::METHOD),
            (abilities.refreshes_lenses, lsp_types::CodeLensRefreshRequest::METHOD),
            (abilities.refreshes_hints, lsp_types::InlayHintRefreshRequest::METHOD),
            (abilities.refreshes_tokens, lsp_types::SemanticTokensRefreshRequest::METHOD),
        ];
        for (_, method) in asked.into_iter().filter(|it| it.0) {
            let id = RequestId::from(self.next.replace(self.next.get().wrapping_add(1)));
            let params = Value::Null;
            (self.send.0)(Message::Request(Request { id, method: method.as_str().to_owned(), params }));
        }
    }
}

//! One file a request. Each reads a [`Snapshot`]: none writes, none keeps anything.

use lsp_types::Request;
use serde_json::Value;

use super::snapshot::Snapshot;

mod code_action;
mod code_lens;
mod completion;
mod definition;
mod document_diagnostic;
mod document_highlight;
mod document_symbol;
mod folding_range;
mod hover;
mod inlay_hint;
mod prepare_rename;
mod references;
mod rename;
mod semantic_tokens;
mod text_document_content;
mod workspace_diagnostic;
mod workspace_symbol;

pub(super) use semantic_tokens::legend;

/// Why a request has no answer.
#[derive(Debug)]
pub(super) enum Fault {
    /// The parameters are not those of the request.
    Params(String),
    /// What is asked cannot be done: a sentence for the user.
    Refused(String),
    /// Nothing new: asked again when something changes.
    Unchanged,
}

type Answer<R> = Result<<R as Request>::Result, Fault>;

/// How a request is answered.
pub(super) struct Handler {
    method: &'static str,
    pub(super) run: fn(&Snapshot, Value) -> Result<Value, Fault>,
    /// Whether the question means the same after an edit: it speaks of no position.
    pub(super) retry: bool,
}

/// A request, in a file of its own.
trait Handle {
    type Request: Request;
    /// See [`Handler::retry`].
    const RETRY: bool = false;

    fn handle(snapshot: &Snapshot, params: <Self::Request as Request>::Params) -> Answer<Self::Request>;
}

const fn handler<H: Handle>() -> Handler {
    Handler { method: H::Request::METHOD.as_str(), run: run::<H>, retry: H::RETRY }
}

fn run<H: Handle>(snapshot: &Snapshot, params: Value) -> Result<Value, Fault> {
    let params = serde_json::from_value(params).map_err(|it| Fault::Params(it.to_string()))?;
    Ok(serde_json::to_value(H::handle(snapshot, params)?).unwrap_or_default())
}

static HANDLERS: &[Handler] = &[
    handler::<code_action::Handler>(),
    handler::<code_lens::Handler>(),
    handler::<completion::Handler>(),
    handler::<definition::Handler>(),
    handler::<document_diagnostic::Handler>(),
    handler::<document_highlight::Handler>(),
    handler::<document_symbol::Handler>(),
    handler::<folding_range::Handler>(),
    handler::<hover::Handler>(),
    handler::<inlay_hint::Handler>(),
    handler::<prepare_rename::Handler>(),
    handler::<references::Handler>(),
    handler::<rename::Handler>(),
    handler::<semantic_tokens::Handler>(),
    handler::<text_document_content::Handler>(),
    handler::<workspace_diagnostic::Handler>(),
    handler::<workspace_symbol::Handler>(),
];

pub(super) fn find(method: &str) -> Option<&'static Handler> {
    HANDLERS.iter().find(|it| it.method == method)
}

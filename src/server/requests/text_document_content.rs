//! `workspace/textDocumentContent`: the page of a rule, which the code of a finding leads to.

use lsp_types::{TextDocumentContentParams, TextDocumentContentRequest, TextDocumentContentResult};

use super::{Answer, Fault, Handle};
use crate::lint;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = TextDocumentContentRequest;
    const RETRY: bool = true;

    fn handle(_: &Snapshot, params: TextDocumentContentParams) -> Answer<Self::Request> {
        let code = params.uri.path().trim_start_matches('/').split('/').next().unwrap_or_default();
        match lint::find(code) {
            Some(rule) => Ok(TextDocumentContentResult { text: rule.page.to_owned() }),
            None => Err(Fault::Refused(format!("there is no rule `{code}`"))),
        }
    }
}

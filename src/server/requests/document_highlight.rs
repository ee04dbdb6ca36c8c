//! `textDocument/documentHighlight`: the uses of what stands at a position, in its document.

use lsp_types::{DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams, DocumentHighlightRequest};

use super::references::found;
use super::{Answer, Handle};
use crate::server::cursor::{InUnit, writes};
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = DocumentHighlightRequest;

    fn handle(snapshot: &Snapshot, params: DocumentHighlightParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let found = found(InUnit::at(it, it.offset(position.position)), true);
        let here = found.into_iter().filter(|found| found.place.file == it.file);
        let highlights = here.map(|found| DocumentHighlight {
            range: it.range(found.place.range),
            kind: Some(match found.mode {
                Some(mode) if writes(mode) => DocumentHighlightKind::Write,
                Some(_) => DocumentHighlightKind::Read,
                None => DocumentHighlightKind::Text,
            }),
        });
        Ok(Some(highlights.collect()))
    }
}

//! `textDocument/prepareRename`: whether what stands at a position can be renamed.

use lsp_types::{PrepareRenameParams, PrepareRenamePlaceholder, PrepareRenameRequest, PrepareRenameResult};

use super::rename::renamed;
use super::{Answer, Handle};
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = PrepareRenameRequest;

    fn handle(snapshot: &Snapshot, params: PrepareRenameParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let found = renamed(it, it.offset(position.position)).map(|renamed| {
            let (range, placeholder) = (it.range(renamed.range), renamed.text);
            PrepareRenameResult::PrepareRenamePlaceholder(PrepareRenamePlaceholder { range, placeholder })
        });
        Ok(found)
    }
}

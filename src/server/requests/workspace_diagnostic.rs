//! `workspace/diagnostic`: the findings of all files. One that has nothing new to say waits until it has.

use lsp_types::{
    FullDocumentDiagnosticReport, UnchangedDocumentDiagnosticReport, WorkspaceDiagnosticParams,
    WorkspaceDiagnosticReport, WorkspaceDiagnosticRequest, WorkspaceDocumentDiagnosticReport,
    WorkspaceFullDocumentDiagnosticReport, WorkspaceUnchangedDocumentDiagnosticReport,
};
use rustc_hash::FxHashMap;

use super::{Answer, Fault, Handle};
use crate::server::convert;
use crate::server::diagnostics;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = WorkspaceDiagnosticRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: WorkspaceDiagnosticParams) -> Answer<Self::Request> {
        let is_first = params.previous_result_ids.is_empty();
        let mut previous: FxHashMap<String, String> =
            params.previous_result_ids.into_iter().map(|it| (convert::path_of(&it.uri), it.value)).collect();
        let mut items = Vec::new();
        let mut is_new = is_first;
        for root in &snapshot.roots {
            let mut files: Vec<_> = root.files.iter().collect();
            files.sort_unstable_by_key(|it| it.0);
            for (path, &file) in files {
                let found = diagnostics::of_file(snapshot, root, file);
                snapshot.told.borrow_mut().push((path.clone(), found.clone()));
                let (Some(uri), version) = (snapshot.uri(path), snapshot.version(path)) else { continue };
                let result_id = found.id.clone();
                items.push(if previous.remove(path).as_ref() == Some(&result_id) {
                    WorkspaceDocumentDiagnosticReport::from(WorkspaceUnchangedDocumentDiagnosticReport {
                        uri,
                        version,
                        unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id },
                    })
                } else {
                    is_new = true;
                    full(uri, version, Some(result_id), found.items.clone())
                });
            }
        }
        // What the client had of files that are checked no longer.
        for path in previous.into_keys() {
            if let Some(uri) = snapshot.uri(&path) {
                is_new = true;
                items.push(full(uri, None, None, Vec::new()));
            }
        }
        if is_new { Ok(WorkspaceDiagnosticReport { items }) } else { Err(Fault::Unchanged) }
    }
}

fn full(
    uri: lsp_types::Uri,
    version: Option<i32>,
    result_id: Option<String>,
    items: Vec<lsp_types::Diagnostic>,
) -> WorkspaceDocumentDiagnosticReport {
    WorkspaceDocumentDiagnosticReport::from(WorkspaceFullDocumentDiagnosticReport {
        uri,
        version,
        full_document_diagnostic_report: FullDocumentDiagnosticReport { result_id, items },
    })
}

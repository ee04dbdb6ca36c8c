//! `textDocument/diagnostic`: the findings of a document.

use lsp_types::{
    DocumentDiagnosticParams, DocumentDiagnosticReport, DocumentDiagnosticRequest, FullDocumentDiagnosticReport,
    RelatedFullDocumentDiagnosticReport, RelatedUnchangedDocumentDiagnosticReport, UnchangedDocumentDiagnosticReport,
};

use super::{Answer, Handle};
use crate::server::diagnostics;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = DocumentDiagnosticRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: DocumentDiagnosticParams) -> Answer<Self::Request> {
        // A document that is not checked has no findings.
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(full(None, Vec::new())) };
        let found = diagnostics::of_file(snapshot, it.root, it.file);
        snapshot.told.borrow_mut().push((it.path().to_owned(), found.clone()));
        if params.previous_result_id.as_ref() == Some(&found.id) {
            let result_id = found.id.clone();
            return Ok(DocumentDiagnosticReport::from(RelatedUnchangedDocumentDiagnosticReport {
                unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id },
                ..Default::default()
            }));
        }
        Ok(full(Some(found.id.clone()), found.items.clone()))
    }
}

fn full(result_id: Option<String>, items: Vec<lsp_types::Diagnostic>) -> DocumentDiagnosticReport {
    DocumentDiagnosticReport::from(RelatedFullDocumentDiagnosticReport {
        full_document_diagnostic_report: FullDocumentDiagnosticReport { result_id, items },
        ..Default::default()
    })
}

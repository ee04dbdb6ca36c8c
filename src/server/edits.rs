//! Changes that the client is asked to make.

use std::collections::HashMap;

use lsp_types::{
    CreateFile, DocumentChange, Edit, OptionalVersionedTextDocumentIdentifier, TextDocumentEdit,
    TextDocumentIdentifier, TextEdit, Uri, WorkspaceEdit,
};

use super::snapshot::{RootSnapshot, Snapshot};
use crate::db::FilePlace;
use crate::lint::Fix;

/// Edits by path, in the form that the client knows: with versions, so that it does not apply what is stale, else without.
#[derive(Default)]
pub(super) struct Edits {
    files: Vec<(String, Vec<Edit>)>,
    create: Vec<Uri>,
}

impl Edits {
    pub(super) fn add(&mut self, path: &str, edit: impl Into<Edit>) {
        let edit = edit.into();
        match self.files.iter_mut().find(|it| it.0 == path) {
            Some(file) => file.1.push(edit),
            None => self.files.push((path.to_owned(), vec![edit])),
        }
    }

    pub(super) fn replace(&mut self, snapshot: &Snapshot, root: &RootSnapshot, place: FilePlace, by: &str) {
        let range = root.range(place, snapshot.encoding());
        self.add(place.file.path(&root.db), TextEdit { range, new_text: by.to_owned() });
    }

    pub(super) fn fix(&mut self, snapshot: &Snapshot, root: &RootSnapshot, fix: &Fix<FilePlace>) {
        fix.edits.iter().for_each(|it| self.replace(snapshot, root, it.place, &it.replacement));
    }

    /// Only for a client that can.
    pub(super) fn create(&mut self, uri: Uri) {
        self.create.push(uri);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    pub(super) fn finish(self, snapshot: &Snapshot) -> WorkspaceEdit {
        let files = self.files.into_iter().filter_map(|(path, edits)| Some((snapshot.uri(&path)?, path, edits)));
        if !snapshot.abilities.document_changes {
            let plain = |it: Edit| match it {
                Edit::TextEdit(it) => Some(it),
                Edit::AnnotatedTextEdit(_) | Edit::SnippetTextEdit(_) => None,
            };
            let changes: HashMap<Uri, Vec<TextEdit>> =
                files.map(|it| (it.0, it.2.into_iter().filter_map(plain).collect())).collect();
            return WorkspaceEdit { changes: Some(changes), ..Default::default() };
        }
        let create = self
            .create
            .into_iter()
            .map(|uri| DocumentChange::CreateFile(CreateFile { uri, options: None, annotation_id: None }));
        let edits = files.map(|(uri, path, edits)| {
            DocumentChange::TextDocumentEdit(TextDocumentEdit {
                text_document: OptionalVersionedTextDocumentIdentifier {
                    version: snapshot.version(&path),
                    text_document_identifier: TextDocumentIdentifier { uri },
                },
                edits,
            })
        });
        WorkspaceEdit { document_changes: Some(create.chain(edits).collect()), ..Default::default() }
    }
}

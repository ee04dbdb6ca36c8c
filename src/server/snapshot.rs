//! What requests read: the databases and documents of one moment.

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;

use lsp_types::{Location, Position, Range, Uri};
use rowan::{TextRange, TextSize};
use rustc_hash::FxHashMap;

use super::client::Abilities;
use super::convert::{self, Encoding};
use super::diagnostics::{FileDiagnostics, Known};
use super::document::Documents;
use crate::db::{self, Db as _, FilePlace, RootDatabase, SourceFile};
use crate::load;

pub(super) struct Snapshot {
    pub(super) roots: Vec<RootSnapshot>,
    /// Of open documents.
    pub(super) documents: Arc<Documents>,
    pub(super) abilities: Arc<Abilities>,
    /// Findings as the client has them.
    pub(super) known: Arc<Known>,
    /// Findings that the request told.
    pub(super) told: RefCell<Vec<(String, Arc<FileDiagnostics>)>>,
}

/// A folder of the workspace.
pub(super) struct RootSnapshot {
    pub(super) id: u32,
    pub(super) db: RootDatabase,
    /// The files that are checked, by path.
    pub(super) files: Arc<FxHashMap<String, SourceFile>>,
    /// Programs that are not read, by path.
    pub(super) unread: Arc<[String]>,
    /// Its `plclint.toml`, or where one would be.
    pub(super) config: Option<PathBuf>,
}

impl Snapshot {
    pub(super) fn encoding(&self) -> Encoding {
        self.abilities.encoding
    }

    /// A document that is checked.
    pub(super) fn file(&self, uri: &Uri) -> Option<InFile<'_>> {
        let path = convert::path_of(uri);
        self.roots.iter().find_map(|root| {
            let file = *root.files.get(&path)?;
            Some(InFile { snapshot: self, root, db: &root.db, file })
        })
    }

    /// The address of a path, as the client writes it where it has opened it.
    pub(super) fn uri(&self, path: &str) -> Option<Uri> {
        match self.documents.get(path) {
            Some(open) => Some(open.uri.clone()),
            None => convert::uri_of(path),
        }
    }

    pub(super) fn version(&self, path: &str) -> Option<i32> {
        self.documents.get(path).map(|it| it.version)
    }
}

impl RootSnapshot {
    pub(super) fn range(&self, place: FilePlace, encoding: Encoding) -> Range {
        encoding.range(db::lines(&self.db, place.file), place.range)
    }

    pub(super) fn location(&self, snapshot: &Snapshot, place: FilePlace) -> Option<Location> {
        let is_config = place.file == self.db.project().configuration(&self.db);
        let uri = match &self.config {
            // Its path is as messages show it.
            Some(config) if is_config => snapshot.uri(&load::shown(config))?,
            _ => snapshot.uri(place.file.path(&self.db))?,
        };
        Some(Location { uri, range: self.range(place, snapshot.encoding()) })
    }
}

/// A file that a request asks about.
#[derive(Clone, Copy)]
pub(super) struct InFile<'s> {
    pub(super) snapshot: &'s Snapshot,
    pub(super) root: &'s RootSnapshot,
    pub(super) db: &'s RootDatabase,
    pub(super) file: SourceFile,
}

impl InFile<'_> {
    pub(super) fn offset(&self, position: Position) -> TextSize {
        let lines = db::lines(self.db, self.file);
        self.snapshot.encoding().offset(lines, self.file.text(self.db), position)
    }

    pub(super) fn text_range(&self, range: Range) -> TextRange {
        let lines = db::lines(self.db, self.file);
        self.snapshot.encoding().text_range(lines, self.file.text(self.db), range)
    }

    pub(super) fn range(&self, range: TextRange) -> Range {
        self.snapshot.encoding().range(db::lines(self.db, self.file), range)
    }

    pub(super) fn path(&self) -> &str {
        self.file.path(self.db)
    }
}

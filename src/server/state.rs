//! Folders of the workspace and their files, as the main thread keeps them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::document::Documents;
use super::snapshot::RootSnapshot;
use crate::db::{Db as _, Input, RootDatabase, SourceFile};
use crate::lint::settings::Overrides;
use crate::lint::{Settings, Unread, UnreadReason};
use crate::load::{self, Files, Loader, Source, WrongConfig};
use crate::source::detect::{Detected, Dialect, Sample};
use crate::source::walk::Candidate;

/// A folder of the workspace, with one configuration and one database; or the files that were opened from outside of any
/// folder and share a configuration.
pub(super) struct Root {
    pub(super) id: u32,
    pub(super) folder: Option<PathBuf>,
    pub(super) config: Option<PathBuf>,
    pub(super) wrong: Option<WrongConfig>,
    db: RootDatabase,
    /// Every file that was ever seen: the database never forgets one.
    files: FxHashMap<String, File>,
    listed: Arc<FxHashMap<String, SourceFile>>,
    /// Programs that the folder's walk found and that are not read.
    unread: Arc<[String]>,
    /// The load that the files wait for. One that comes later has another number.
    pub(super) loading: Option<u32>,
    /// Whether which files are listed may have changed since the database was told.
    relist: bool,
}

#[derive(Debug, Default)]
struct File {
    source: Option<SourceFile>,
    /// Whether it is part of the project.
    listed: bool,
    /// Whether the folder's walk found it. Others are there while they are open.
    found: bool,
    /// Whether it was ever open, and the database knows.
    edited: bool,
    /// By which an open document is recognised.
    sample: Sample,
}

/// What a load brought.
pub(super) struct Loaded {
    pub(super) root: u32,
    pub(super) number: u32,
    config: Option<PathBuf>,
    settings: Result<Settings, WrongConfig>,
    files: Files,
}

impl Loaded {
    /// Finds and reads what lies in a folder. `configs` are configurations that are open in the client.
    pub(super) fn read(root: u32, number: u32, folder: &Path, configs: Vec<(PathBuf, String)>, old: &Settings) -> Self {
        let (config, settings) = settings(folder, configs);
        let used = settings.as_ref().unwrap_or(old);
        let files = load::read(&[folder.to_owned()], used, Dialect::Auto);
        Self { root, number, config, settings, files }
    }

    /// A load that failed in a way that nobody foresaw: no files.
    pub(super) fn nothing(root: u32, number: u32, settings: Settings) -> Self {
        Self { root, number, config: None, settings: Ok(settings), files: Files::default() }
    }

    /// What a person wants to know of it.
    pub(super) fn report(&self, folder: &Path) -> Vec<String> {
        let mut lines = vec![format!("{}: {} files are checked", folder.display(), self.files.inputs.len())];
        lines.extend(self.files.unread.iter().filter_map(|it| match &it.reason {
            UnreadReason::Io(error) => Some(format!("{}: not read: {error}", it.path)),
            UnreadReason::Unsupported(kind) => Some(format!("{}: not read: {kind} is not supported", it.path)),
            UnreadReason::NotPlc => None,
        }));
        lines
    }
}

fn settings(path: &Path, configs: Vec<(PathBuf, String)>) -> (Option<PathBuf>, Result<Settings, WrongConfig>) {
    match Loader::new(Source::Discover, Overrides::default()) {
        Ok(mut loader) => {
            configs.into_iter().for_each(|(file, text)| loader.open(file, text));
            (loader.file(path), loader.settings(path))
        }
        Err(wrong) => (None, Err(wrong)),
    }
}

impl Root {
    pub(super) fn folder(id: u32, folder: PathBuf) -> Self {
        Self { folder: Some(folder), ..Self::new(id, Settings::default()) }
    }

    /// For a file from outside of any folder; also says which configuration it has.
    pub(super) fn outside(id: u32, path: &str, configs: Vec<(PathBuf, String)>) -> Self {
        let (config, settings) = settings(Path::new(path), configs);
        let (settings, wrong) = match settings {
            Ok(settings) => (settings, None),
            Err(wrong) => (Settings::default(), Some(wrong)),
        };
        Self { config, wrong, ..Self::new(id, settings) }
    }

    fn new(id: u32, settings: Settings) -> Self {
        Self {
            id,
            folder: None,
            config: None,
            wrong: None,
            db: RootDatabase::new(settings, None),
            files: FxHashMap::default(),
            listed: Arc::default(),
            unread: Arc::default(),
            loading: None,
            relist: false,
        }
    }

    pub(super) fn snapshot(&self) -> RootSnapshot {
        RootSnapshot {
            id: self.id,
            db: self.db.clone(),
            files: self.listed.clone(),
            unread: self.unread.clone(),
            config: self.config.clone().or_else(|| Some(self.folder.as_ref()?.join(crate::lint::settings::FILE_NAME))),
        }
    }

    pub(super) fn settings(&self) -> Settings {
        self.db.project().settings(&self.db).clone()
    }

    /// Whether a path lies in the folder, and how deep the folder is.
    pub(super) fn depth_around(&self, path: &str) -> Option<usize> {
        let folder = self.folder.as_deref()?;
        Path::new(path).starts_with(folder).then(|| folder.components().count())
    }

    pub(super) fn has_files(&self) -> bool {
        self.files.values().any(|it| it.listed)
    }

    pub(super) fn knows(&self, path: &str) -> bool {
        self.files.contains_key(path)
    }

    /// Whether the file is one that the folder's walk found.
    pub(super) fn found(&self, path: &str) -> bool {
        self.files.get(path).is_some_and(|it| it.found)
    }

    fn take_settings(&mut self, settings: Result<Settings, WrongConfig>) {
        match settings {
            Ok(settings) => {
                self.wrong = None;
                self.db.set_settings(settings);
            }
            // What was right before is still the best guess.
            Err(wrong) => self.wrong = Some(wrong),
        }
    }

    /// Takes what a load brought, but for what `is_own` says belongs to another root. Of open documents, the client's text
    /// counts.
    pub(super) fn load(&mut self, loaded: Loaded, documents: &Documents, is_own: impl Fn(&str) -> bool) {
        self.config = loaded.config;
        self.take_settings(loaded.settings);
        for file in self.files.values_mut() {
            (file.found, file.listed) = (false, false);
        }
        self.relist = true;
        self.db.set_unread(&loaded.files.unread);
        let is_program = |it: &&Unread| matches!(it.reason, UnreadReason::Unsupported(_));
        self.unread = loaded.files.unread.iter().filter(is_program).map(|it| it.path.clone()).collect();
        for Unread { path, .. } in loaded.files.unread {
            self.files.entry(path).or_default().found = true;
        }
        for input in loaded.files.inputs.into_iter().filter(|it| is_own(&it.path)) {
            self.files.entry(input.path.clone()).or_default().found = true;
            match documents.get(&input.path) {
                Some(_) if input.detected != Detected::Stx => {}
                _ => self.take(input),
            }
        }
        for (path, document) in documents.iter().filter(|it| is_own(it.0)) {
            self.show(path, &document.text);
        }
        self.list();
    }

    /// Takes the text of an open document. A project is a file that is no text, so that what a client shows of it is
    /// nothing that could be checked.
    pub(super) fn show(&mut self, path: &str, text: &Arc<str>) {
        let file = self.files.entry(path.to_owned()).or_default();
        if file.listed && file.source.is_some_and(|it| it.detected(&self.db) == Detected::Stx) {
            return;
        }
        let explicit = !file.found;
        let settings = self.db.project().settings(&self.db);
        let input = load::from_text(path, text, explicit, settings, Dialect::Auto, &mut file.sample);
        match input {
            Ok(input) => self.take(input),
            Err(_) => self.drop(path),
        }
        if let Some(file) = self.files.get_mut(path)
            && let Some(source) = file.source
            && !std::mem::replace(&mut file.edited, true)
        {
            self.db.set_edited(source);
        }
    }

    /// A document is closed: what lies on the disk counts again, if anything does.
    pub(super) fn hide(&mut self, path: &str) {
        if let Some(file) = self.files.get_mut(path) {
            file.sample = Sample::default();
        }
        if self.found(path) { self.read(path) } else { self.drop(path) }
    }

    /// Reads a file that the walk found from the disk.
    pub(super) fn read(&mut self, path: &str) {
        let candidate = Candidate { path: PathBuf::from(path), explicit: false };
        match load::read_file(&candidate, &self.settings(), Dialect::Auto) {
            Ok(input) => self.take(input),
            Err(_) => self.drop(path),
        }
    }

    fn take(&mut self, input: Input) {
        let file = self.files.entry(input.path.clone()).or_default();
        self.relist |= !std::mem::replace(&mut file.listed, true) || file.source.is_none();
        match file.source {
            Some(source) => {
                self.db.set_detected(source, input.detected);
                self.db.set_text(source, input.source.text);
            }
            None => file.source = Some(self.db.add_file(input)),
        }
    }

    fn drop(&mut self, path: &str) {
        if let Some(file) = self.files.get_mut(path) {
            self.relist |= std::mem::replace(&mut file.listed, false);
        }
    }

    /// Tells the database which files there are, if they are others than before.
    pub(super) fn list(&mut self) {
        if !std::mem::take(&mut self.relist) {
            return;
        }
        let listed = self.files.iter().filter(|it| it.1.listed);
        let listed: FxHashMap<String, SourceFile> =
            listed.filter_map(|(path, it)| Some((path.clone(), it.source?))).collect();
        if listed != *self.listed {
            self.db.set_project(listed.values().copied().collect());
            self.listed = Arc::new(listed);
        }
    }
}

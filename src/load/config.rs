//! Finding and reading `plclint.toml`.

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::lint::Settings;
use crate::lint::settings::{ConfigError, FILE_NAME, Folders, Overrides};

/// Where settings come from.
pub enum Source {
    /// The nearest file upwards from each path.
    Discover,
    /// This file.
    File(PathBuf),
    /// No file.
    Isolated,
}

/// A configuration that cannot be used.
#[derive(Debug)]
pub struct WrongConfig {
    /// The file, when it is one.
    pub file: Option<PathBuf>,
    pub what: Wrong,
}

#[derive(Debug)]
pub enum Wrong {
    /// Its words are.
    Words(ConfigError),
    /// The file cannot be read: the system's message.
    File(io::Error),
    /// The working folder of the process is gone.
    Folder(io::Error),
}

impl fmt::Display for WrongConfig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.what, &self.file) {
            (Wrong::Words(error), _) => error.fmt(f),
            (Wrong::File(error), Some(file)) => {
                write!(f, "{}: the configuration cannot be read: {error}", file.display())
            }
            (Wrong::File(error), None) => write!(f, "the configuration cannot be read: {error}"),
            (Wrong::Folder(error), _) => write!(f, "the working folder cannot be found: {error}"),
        }
    }
}

impl std::error::Error for WrongConfig {}

/// Reads the settings for paths; a file is read once.
pub struct Loader {
    source: Source,
    overrides: Overrides,
    current: PathBuf,
    /// Texts that take the place of files: what an editor shows and has not saved.
    open: Vec<(PathBuf, String)>,
    loaded: Vec<(Option<PathBuf>, Settings)>,
}

impl Loader {
    pub fn new(source: Source, overrides: Overrides) -> Result<Self, WrongConfig> {
        let current = std::env::current_dir().map_err(|it| WrongConfig { file: None, what: Wrong::Folder(it) })?;
        Ok(Self { source, overrides, current, open: Vec::new(), loaded: Vec::new() })
    }

    /// Takes a text in place of that of a file.
    pub fn open(&mut self, file: PathBuf, text: String) {
        self.open.push((file, text));
    }

    pub fn current(&self) -> &Path {
        &self.current
    }

    /// The settings for a file or folder.
    pub fn settings(&mut self, path: &Path) -> Result<Settings, WrongConfig> {
        let file = self.file(path);
        if let Some((_, settings)) = self.loaded.iter().find(|it| it.0 == file) {
            return Ok(settings.clone());
        }
        let wrong = |what: Wrong| WrongConfig { file: file.clone(), what };
        let overrides = self.overrides.clone();
        let settings = match &file {
            Some(file) => {
                let text = match self.open.iter().find(|it| it.0 == *file) {
                    Some((_, text)) => text.clone(),
                    None => self::text(file).map_err(|it| wrong(Wrong::File(it)))?,
                };
                let root = self.current.join(file).parent().map(Path::to_owned).unwrap_or_default();
                let shown = file.strip_prefix(&self.current).unwrap_or(file);
                Settings::parse(&text, shown, Folders { root, current: self.current.clone() }, overrides)
            }
            None => {
                let folders = Folders { root: self.current.clone(), current: self.current.clone() };
                Settings::without_file(folders, overrides)
            }
        };
        let settings = settings.map_err(|it| wrong(Wrong::Words(it)))?;
        self.loaded.push((file, settings.clone()));
        Ok(settings)
    }

    /// The configuration file for a file or folder.
    pub fn file(&self, path: &Path) -> Option<PathBuf> {
        match &self.source {
            Source::Isolated => None,
            Source::File(file) => Some(file.clone()),
            Source::Discover => self.discover(path),
        }
    }

    /// The nearest configuration at or above a path, which need not exist.
    fn discover(&self, path: &Path) -> Option<PathBuf> {
        let path = self.current.join(path);
        // `..` is resolved by the file system, which knows of links.
        let path = fs::canonicalize(&path).unwrap_or(path);
        let is_there = |it: &PathBuf| it.is_file() || self.open.iter().any(|open| open.0 == *it);
        path.ancestors().map(|it| it.join(FILE_NAME)).find(is_there)
    }
}

/// The text of a configuration file.
pub fn text(file: &Path) -> io::Result<String> {
    String::from_utf8(fs::read(file)?).map_err(|_| io::Error::other("it is not UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loader(source: Source, current: &Path) -> Loader {
        Loader {
            source,
            overrides: Overrides::default(),
            current: current.to_owned(),
            open: Vec::new(),
            loaded: Vec::new(),
        }
    }

    #[test]
    fn the_nearest_file_upwards_counts() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::create_dir_all(root.join("a/b")).unwrap();
        fs::write(root.join(FILE_NAME), "[target]\ncontroller = 'CPU 314'").unwrap();
        fs::write(root.join("a").join(FILE_NAME), "[target]\ncontroller = 'TSX 37-22'").unwrap();
        fs::write(root.join("a/b/x.awl"), "").unwrap();
        let mut it = loader(Source::Discover, &root);
        assert_eq!(it.settings(Path::new("a/b/x.awl")).unwrap().controller(), Some("TSX 37-22"));
        assert_eq!(it.settings(Path::new("a/b")).unwrap().controller(), Some("TSX 37-22"));
        assert_eq!(it.settings(Path::new(".")).unwrap().controller(), Some("CPU 314"));
        assert_eq!(it.loaded.len(), 2, "each file is read once");
        assert_eq!(loader(Source::Isolated, &root).settings(Path::new("a")).unwrap().controller(), None);
        let mut given = loader(Source::File("a/plclint.toml".into()), &root);
        // Read from the working folder of the process, which is not the test's: an absolute path is needed.
        given.source = Source::File(root.join("a").join(FILE_NAME));
        assert_eq!(given.settings(Path::new(".")).unwrap().controller(), Some("TSX 37-22"));
    }

    #[test]
    fn a_wrong_file_is_wrong_usage() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::write(root.join(FILE_NAME), "[rules]\nselekt = []").unwrap();
        let message = loader(Source::Discover, &root).settings(Path::new(".")).unwrap_err().to_string();
        assert!(message.starts_with("plclint.toml:2:1: unknown field"), "{message}");
    }
}

//! Finding and reading `plclint.toml`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::Failure;
use crate::lint::Settings;
use crate::lint::settings::{FILE_NAME, Folders, Overrides};

/// What says where settings come from.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Configuration")]
pub(super) struct Configured {
    /// Configuration file, instead of the nearest `plclint.toml` upwards from each path
    #[arg(long, value_name = "FILE", conflicts_with = "isolated")]
    config: Option<PathBuf>,
    /// Read no configuration file
    #[arg(long)]
    isolated: bool,
}

impl Configured {
    pub(super) fn source(&self) -> Source {
        match (&self.config, self.isolated) {
            (Some(file), _) => Source::File(file.clone()),
            (None, true) => Source::Isolated,
            (None, false) => Source::Discover,
        }
    }
}

/// Where settings come from.
pub(super) enum Source {
    /// The nearest file upwards from each path.
    Discover,
    /// This file.
    File(PathBuf),
    /// No file.
    Isolated,
}

/// Reads the settings for paths; a file is read once.
pub(super) struct Loader {
    source: Source,
    overrides: Overrides,
    current: PathBuf,
    loaded: Vec<(Option<PathBuf>, Settings)>,
}

impl Loader {
    pub(super) fn new(source: Source, overrides: Overrides) -> Result<Self, Failure> {
        let current = std::env::current_dir()
            .map_err(|it| Failure::Usage(format!("the working folder cannot be found: {it}")))?;
        Ok(Self { source, overrides, current, loaded: Vec::new() })
    }

    pub(super) fn current(&self) -> &Path {
        &self.current
    }

    /// The settings for a file or folder.
    pub(super) fn settings(&mut self, path: &Path) -> Result<Settings, Failure> {
        let file = match &self.source {
            Source::Isolated => None,
            Source::File(file) => Some(file.clone()),
            Source::Discover => self.discover(path),
        };
        if let Some((_, settings)) = self.loaded.iter().find(|it| it.0 == file) {
            return Ok(settings.clone());
        }
        let overrides = self.overrides.clone();
        let settings = match &file {
            Some(file) => {
                let text = read(file).map_err(|it| {
                    Failure::Usage(format!("{}: the configuration cannot be read: {it}", file.display()))
                })?;
                let root = self.current.join(file).parent().map(Path::to_owned).unwrap_or_default();
                let shown = file.strip_prefix(&self.current).unwrap_or(file);
                Settings::parse(&text, shown, Folders { root, current: self.current.clone() }, overrides)
            }
            None => {
                let folders = Folders { root: self.current.clone(), current: self.current.clone() };
                Settings::without_file(folders, overrides)
            }
        };
        let settings = settings.map_err(|it| Failure::Usage(it.to_string()))?;
        self.loaded.push((file, settings.clone()));
        Ok(settings)
    }

    /// The nearest configuration at or above a path, which need not exist.
    fn discover(&self, path: &Path) -> Option<PathBuf> {
        let path = self.current.join(path);
        // `..` is resolved by the file system, which knows of links.
        let path = fs::canonicalize(&path).unwrap_or(path);
        path.ancestors().map(|it| it.join(FILE_NAME)).find(|it| it.is_file())
    }
}

fn read(file: &Path) -> io::Result<String> {
    String::from_utf8(fs::read(file)?).map_err(|_| io::Error::other("it is not UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loader(source: Source, current: &Path) -> Loader {
        Loader { source, overrides: Overrides::default(), current: current.to_owned(), loaded: Vec::new() }
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
        let Err(Failure::Usage(message)) = loader(Source::Discover, &root).settings(Path::new(".")) else {
            panic!("a failure is expected")
        };
        assert!(message.starts_with("plclint.toml:2:1: unknown field"), "{message}");
    }
}

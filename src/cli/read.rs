//! What the command line names, and how it is read.

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::{Failure, dialect};
use crate::lint::Settings;
use crate::load::{self, Files, Loader};
use crate::source::detect::Dialect;

/// How files are read.
#[derive(Debug, clap::Args)]
pub(super) struct Reading {
    /// Name of what standard input holds, for messages and for its extension
    #[arg(long, value_name = "FILE")]
    pub(super) stdin_filename: Option<String>,
    /// What the files are, whatever they look like
    #[arg(long, value_name = "DIALECT", default_value = "auto", value_parser = dialect())]
    pub(super) dialect: Dialect,
    /// Controller that the programs are for: `TSX 37-22`, `CPU 314`
    #[arg(long, value_name = "CONTROLLER")]
    pub(super) target: Option<String>,
    /// Encoding of files without a byte order mark, whatever they look like: `windows-1252`, `cp850`
    #[arg(long, value_name = "NAME")]
    pub(super) encoding: Option<String>,
}

/// What to read: the paths that share their settings, and standard input.
pub(super) struct Group {
    pub(super) settings: Settings,
    paths: Vec<PathBuf>,
    /// Name and content.
    stdin: Option<(String, Vec<u8>)>,
}

impl Group {
    pub(super) fn read(&self, dialect: Dialect) -> Files {
        let mut files = load::read(&self.paths, &self.settings, dialect);
        if let Some((name, bytes)) = &self.stdin {
            let it = load::from_bytes(name, bytes, &self.settings, dialect);
            files.inputs.extend(it.inputs);
            files.unread.extend(it.unread);
        }
        files
    }
}

/// What was named, by its settings; nothing named is the current folder.
pub(super) fn groups(
    paths: &[PathBuf],
    stdin_filename: Option<&str>,
    loader: &mut Loader,
) -> Result<Vec<Group>, Failure> {
    let is_stdin = |it: &PathBuf| it.as_os_str() == "-";
    if paths.iter().any(is_stdin) {
        if paths.len() > 1 {
            return Err(Failure::Usage("standard input (`-`) is read alone, without other paths".to_owned()));
        }
        let name = stdin_filename.unwrap_or("<stdin>").to_owned();
        let settings = loader.settings(Path::new(&name))?;
        let mut bytes = Vec::new();
        io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .map_err(|it| Failure::Usage(format!("standard input cannot be read: {it}")))?;
        return Ok(vec![Group { settings, paths: Vec::new(), stdin: Some((name, bytes)) }]);
    }
    if stdin_filename.is_some() {
        return Err(Failure::Usage("--stdin-filename names what `-` reads: give `-` as the path".to_owned()));
    }
    let current = [PathBuf::from(".")];
    let paths = if paths.is_empty() { &current[..] } else { paths };
    let mut groups: Vec<Group> = Vec::new();
    for path in paths {
        // A name that is mistyped is wrong usage; a file that cannot be read is a line of the report.
        if let Ok(false) = path.try_exists() {
            return Err(Failure::Usage(format!("{}: there is no such file or folder", path.display())));
        }
        let settings = loader.settings(path)?;
        match groups.iter_mut().find(|it| it.settings == settings) {
            Some(group) => group.paths.push(path.clone()),
            None => groups.push(Group { settings, paths: vec![path.clone()], stdin: None }),
        }
    }
    Ok(groups)
}

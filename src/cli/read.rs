//! Finding and reading the files of a run.

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::config::Loader;
use super::{Failure, dialect};
use crate::db::Input;
use crate::lint::{Settings, Unread, UnreadReason};
use crate::source::detect::{Detected, Dialect, FileHint, load};
use crate::source::walk::{self, Candidate};

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

/// Files of a run: those to check, and those that are left out.
#[derive(Default)]
pub(super) struct Files {
    pub(super) inputs: Vec<Input>,
    pub(super) unread: Vec<Unread>,
}

impl Files {
    fn add(&mut self, read: Result<Input, Unread>) {
        match read {
            Ok(input) => self.inputs.push(input),
            Err(unread) => self.unread.push(unread),
        }
    }
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
        let mut files = read(&self.paths, &self.settings, dialect);
        if let Some((name, bytes)) = &self.stdin {
            files.add(input(name.clone(), bytes, true, &self.settings, dialect));
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

/// Reads what was named: a file whatever its name, of a folder what the settings let through.
fn read(paths: &[PathBuf], settings: &Settings, dialect: Dialect) -> Files {
    let mut files = Files::default();
    let (candidates, errors) = walk::walk(paths, &settings.walk_options());
    for error in errors {
        let path = error.path.as_deref().map_or_else(String::new, shown);
        files.unread.push(Unread { path, reason: UnreadReason::Io(error.message) });
    }
    let read: Vec<_> = candidates.par_iter().map(|it| read_file(it, settings, dialect)).collect();
    read.into_iter().for_each(|it| files.add(it));
    files
}

/// A path as findings show it: forward slashes, no leading `./`.
fn shown(path: &Path) -> String {
    let text = path.to_string_lossy();
    let text = if cfg!(windows) { text.replace('\\', "/") } else { text.into_owned() };
    match text.strip_prefix("./") {
        Some(rest) if !rest.is_empty() => rest.to_owned(),
        _ => text,
    }
}

fn read_file(it: &Candidate, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let path = shown(&it.path);
    match walk::read(&it.path) {
        Ok(bytes) => input(path, &bytes, it.explicit, settings, dialect),
        Err(error) => Err(Unread { path, reason: UnreadReason::Io(error.to_string()) }),
    }
}

fn input(path: String, bytes: &[u8], explicit: bool, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let hint = FileHint { path: Some(Path::new(&path)), explicit, dialect, family: settings.controller_family() };
    let (source, detected) = load(hint, bytes, settings.encoding());
    let reason = match detected {
        Detected::Exchange
        | Detected::Pasted(_)
        | Detected::Pl72
        | Detected::Pl72Exchange
        | Detected::Step5
        | Detected::Step5Symbols
        | Detected::Step7
        | Detected::Step7Symbols
        | Detected::Stx => {
            return Ok(Input { path, source, detected });
        }
        Detected::Unsupported { what, .. } => UnreadReason::Unsupported(what.to_owned()),
        Detected::Unreadable { why } => UnreadReason::Io(why.to_owned()),
        Detected::NotPlc => UnreadReason::NotPlc,
    };
    Err(Unread { path, reason })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::lint::settings::{FILE_NAME, Folders, Overrides};

    const AWL: &str = "FUNCTION FC 1 : VOID\nBEGIN\n      U     E 0.0;\n      =     A 4.0;\nEND_FUNCTION\n";

    #[test]
    fn a_folder_gives_its_programs_and_says_what_it_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let file = |path: &str, bytes: &[u8]| {
            let path = root.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        };
        file("a.awl", AWL.as_bytes());
        file("old/b.awl", AWL.as_bytes());
        file("ignored/c.awl", AWL.as_bytes());
        file(".git/d.awl", AWL.as_bytes());
        file(".gitignore", b"ignored/\n");
        file("letter.txt", b"Dear reader,\nthis is no program.\n");
        let folders = Folders { root: root.clone(), current: root.clone() };
        let text = "[files]\nexclude = ['old/']";
        let settings = Settings::parse(text, Path::new(FILE_NAME), folders, Overrides::default()).unwrap();
        let files = read(std::slice::from_ref(&root), &settings, Dialect::Auto);
        let paths: Vec<&str> = files.inputs.iter().map(|it| it.path.as_str()).collect();
        assert_eq!(paths, [root.join("a.awl").to_string_lossy()]);
        let left: Vec<&UnreadReason> = files.unread.iter().map(|it| &it.reason).collect();
        assert!(!left.is_empty() && left.iter().all(|it| **it == UnreadReason::NotPlc), "{left:?}");
        let named = read(&[root.join("old/b.awl")], &settings, Dialect::Auto);
        assert_eq!(named.inputs.len(), 1, "a file that is named is read although it is excluded");
        let missing = read(&[root.join("missing.awl")], &settings, Dialect::Auto);
        assert!(matches!(missing.unread[0].reason, UnreadReason::Io(_)));
    }

    #[test]
    fn paths_are_shown_as_they_were_given() {
        assert_eq!(shown(Path::new("./a/b.awl")), "a/b.awl");
        assert_eq!(shown(Path::new("../b.awl")), "../b.awl");
        assert_eq!(shown(Path::new("/x/b.awl")), "/x/b.awl");
    }
}

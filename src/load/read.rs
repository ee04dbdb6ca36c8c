//! Finding and reading the files of programs.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;

use crate::db::Input;
use crate::lint::{Settings, Unread, UnreadReason};
use crate::source::decode::{Encoding, SourceText};
use crate::source::detect::{Detected, Dialect, FileHint, Sample, detect_edited, load};
use crate::source::walk::{self, Candidate};

/// Files of a run: those to check, and those that are left out.
#[derive(Default)]
pub struct Files {
    pub inputs: Vec<Input>,
    pub unread: Vec<Unread>,
}

impl Files {
    fn add(&mut self, read: Result<Input, Unread>) {
        match read {
            Ok(input) => self.inputs.push(input),
            Err(unread) => self.unread.push(unread),
        }
    }
}

/// Reads what was named: a file whatever its name, of a folder what the settings let through.
pub fn read(paths: &[PathBuf], settings: &Settings, dialect: Dialect) -> Files {
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

/// A file that came through standard input.
pub fn from_bytes(name: &str, bytes: &[u8], settings: &Settings, dialect: Dialect) -> Files {
    let mut files = Files::default();
    files.add(input(name.to_owned(), bytes, true, settings, dialect));
    files
}

/// A file whose text is already decoded: what an editor shows. `sample`: that of the same text before it was edited.
pub fn from_text(
    name: &str,
    text: &Arc<str>,
    explicit: bool,
    settings: &Settings,
    dialect: Dialect,
    sample: &mut Sample,
) -> Result<Input, Unread> {
    let hint = hint(name, explicit, settings, dialect);
    let detected = detect_edited(hint, text, sample);
    let source =
        SourceText { text: text.clone(), encoding: Encoding::Utf8, bom: false, malformed: false, mixed: false };
    recognised(Input { path: name.to_owned(), source, detected })
}

/// A path as findings show it: forward slashes, no leading `./`.
pub fn shown(path: &Path) -> String {
    let text = path.to_string_lossy();
    let text = if cfg!(windows) { text.replace('\\', "/") } else { text.into_owned() };
    match text.strip_prefix("./") {
        Some(rest) if !rest.is_empty() => rest.to_owned(),
        _ => text,
    }
}

/// One file of a walk.
pub fn read_file(it: &Candidate, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let path = shown(&it.path);
    match walk::read(&it.path) {
        Ok(bytes) => input(path, &bytes, it.explicit, settings, dialect),
        Err(error) => Err(Unread { path, reason: UnreadReason::Io(error.to_string()) }),
    }
}

fn hint<'p>(path: &'p str, explicit: bool, settings: &Settings, dialect: Dialect) -> FileHint<'p> {
    FileHint { path: Some(Path::new(path)), explicit, dialect, family: settings.controller_family() }
}

fn input(path: String, bytes: &[u8], explicit: bool, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let (source, detected) = load(hint(&path, explicit, settings, dialect), bytes, settings.encoding());
    recognised(Input { path, source, detected })
}

/// The file, if it is one of a kind that is checked.
fn recognised(input: Input) -> Result<Input, Unread> {
    let reason = match input.detected {
        Detected::Exchange
        | Detected::Pasted(_)
        | Detected::Pl72
        | Detected::Pl72Exchange
        | Detected::Step5
        | Detected::Step5Symbols
        | Detected::Step7
        | Detected::Step7Symbols
        | Detected::Stx => {
            return Ok(input);
        }
        Detected::Unsupported { what, .. } => UnreadReason::Unsupported(what.to_owned()),
        Detected::Unreadable { why } => UnreadReason::Io(why.to_owned()),
        Detected::NotPlc => UnreadReason::NotPlc,
    };
    Err(Unread { path: input.path, reason })
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

//! Finding and reading the files of a run.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use ignore::WalkBuilder;
use rayon::prelude::*;

use crate::db::Input;
use crate::lint::{Settings, Unread, UnreadReason};
use crate::source::detect::{Detected, Dialect, FileHint, detect_binary, load};

/// Files of a run: those to check, and those that are left out.
#[derive(Default)]
pub(super) struct Files {
    pub(super) inputs: Vec<Input>,
    pub(super) unread: Vec<Unread>,
}

/// A file that was found.
struct Found {
    path: PathBuf,
    /// Named by the user rather than found in a folder.
    explicit: bool,
}

/// How much of a file is read to tell a program from a picture.
const HEAD: u64 = 64 * 1024;
/// Offsets in a text are 32 bits wide.
const SIZE_LIMIT: u64 = u32::MAX as u64 / 2;

/// Reads what was named: a file whatever its name, of a folder every file that looks like a program. What version
/// control ignores is left alone, as is what the configuration excludes; a file that was named itself is read anyway.
pub(super) fn read(paths: &[PathBuf], settings: &Settings, dialect: Dialect) -> Files {
    let mut files = Files::default();
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            walk(path, settings, &mut found, &mut files.unread);
        } else {
            found.push(Found { path: path.clone(), explicit: true });
        }
    }
    let read: Vec<Result<Input, Unread>> = found.par_iter().map(|it| read_file(it, settings, dialect)).collect();
    for it in read {
        match it {
            Ok(input) => files.inputs.push(input),
            Err(unread) => files.unread.push(unread),
        }
    }
    files
}

/// A file that came through standard input.
pub(super) fn from_bytes(name: &str, bytes: &[u8], settings: &Settings, dialect: Dialect) -> Files {
    let mut files = Files::default();
    match input(name.to_owned(), bytes, true, settings, dialect) {
        Ok(input) => files.inputs.push(input),
        Err(unread) => files.unread.push(unread),
    }
    files
}

fn walk(root: &Path, settings: &Settings, found: &mut Vec<Found>, unread: &mut Vec<Unread>) {
    let prune = settings.clone();
    let walk = WalkBuilder::new(root)
        .hidden(false)
        .require_git(false)
        .filter_entry(move |entry| {
            let is_folder = entry.file_type().is_some_and(|it| it.is_dir());
            !(is_folder && (entry.file_name() == ".git" || prune.excludes_folder(&shown(entry.path()))))
        })
        .build();
    for entry in walk {
        match entry {
            Ok(entry) => {
                let is_file = entry.file_type().is_some_and(|it| it.is_file());
                if is_file && settings.includes(&shown(entry.path())) {
                    found.push(Found { path: entry.into_path(), explicit: false });
                }
            }
            Err(error) => unread.push(Unread { path: shown(root), reason: UnreadReason::Io(error.to_string()) }),
        }
    }
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

fn read_file(found: &Found, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let path = shown(&found.path);
    let fail = |error: io::Error| Unread { path: path.clone(), reason: UnreadReason::Io(error.to_string()) };
    let mut file = File::open(&found.path).map_err(fail)?;
    let mut bytes = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut bytes).map_err(fail)?;
    let hint = FileHint { path: Some(&found.path), explicit: found.explicit, dialect };
    // A picture of a gigabyte is recognised by its first bytes.
    if let Some(detected) = detect_binary(hint, &bytes, settings.encoding()) {
        return Err(Unread { path, reason: reason(detected).unwrap_or(UnreadReason::NotPlc) });
    }
    let size = fs::metadata(&found.path).map_err(fail)?.len();
    if size > SIZE_LIMIT {
        return Err(fail(io::Error::other("the file is larger than 2 GiB")));
    }
    file.take(SIZE_LIMIT).read_to_end(&mut bytes).map_err(fail)?;
    input(path, &bytes, found.explicit, settings, dialect)
}

fn input(path: String, bytes: &[u8], explicit: bool, settings: &Settings, dialect: Dialect) -> Result<Input, Unread> {
    let hint = FileHint { path: Some(Path::new(&path)), explicit, dialect };
    let (source, detected) = load(hint, bytes, settings.encoding());
    match reason(detected) {
        Some(reason) => Err(Unread { path, reason }),
        None => Ok(Input { path, source, detected }),
    }
}

/// Why a file of this kind is not checked; `None` when it is.
fn reason(detected: Detected) -> Option<UnreadReason> {
    match detected {
        Detected::Exchange | Detected::Pasted(_) | Detected::Step7 => None,
        Detected::Unsupported { what, .. } => Some(UnreadReason::Unsupported(what.to_owned())),
        Detected::Unreadable { why } => Some(UnreadReason::Io(why.to_owned())),
        Detected::NotPlc => Some(UnreadReason::NotPlc),
    }
}

#[cfg(test)]
mod tests {
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
        file("picture.png", b"\x89PNG\r\n\x1a\n\0\0\0\0\0\0\0\0\0\0\0\0");
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

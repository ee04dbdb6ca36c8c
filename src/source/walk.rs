//! Files on disk: which ones a run reads, and their bytes.

use std::fmt;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use ignore::gitignore::{Gitignore, GitignoreBuilder};
use ignore::{DirEntry, WalkBuilder};
use rustc_hash::FxHashMap;

use super::detect::has_plc_extension;

/// Which files a walk of folders finds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkOptions {
    /// The folder that the patterns speak of: that of the configuration file.
    pub root: PathBuf,
    /// Patterns as in `.gitignore`. If there are any, a file must match one, or lie in a folder that does.
    pub include: Vec<String>,
    /// Patterns as in `.gitignore` of files and folders that are left out.
    pub exclude: Vec<String>,
    /// Whether `.gitignore` and `.ignore` files are obeyed, in a git repository or not.
    pub gitignore: bool,
}

/// A file to read.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// As the user wrote it, or below the folder that the user wrote.
    pub path: PathBuf,
    /// Named by the user rather than found in a folder: to be read whatever it is called.
    pub explicit: bool,
}

/// A path that cannot be walked, or a pattern that is none.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct WalkError {
    pub path: Option<PathBuf>,
    pub message: String,
}

impl fmt::Display for WalkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.path {
            Some(path) => write!(f, "{}: {}", path.display(), self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for WalkError {}

/// Finds the files under some paths: those that are files themselves, whatever the options say, and those with the
/// extension of a controller program in those that are folders. Hidden files and folders are skipped unless named.
///
/// Symbolic links to files are followed, those to folders only if named, so that loops do not matter. A file is found
/// once, however many ways lead to it. Sorted by path.
pub fn walk(paths: &[PathBuf], options: &WalkOptions) -> (Vec<Candidate>, Vec<WalkError>) {
    let mut errors = Vec::new();
    let include = patterns(&options.root, &options.include, &mut errors);
    let exclude = patterns(&options.root, &options.exclude, &mut errors);

    let mut found = Vec::new();
    for path in paths {
        match path.metadata() {
            Ok(metadata) if metadata.is_dir() => {
                walk_folder(path, options, include.as_ref(), exclude.as_ref(), &mut found, &mut errors);
            }
            Ok(_) => found.push(Candidate { path: path.clone(), explicit: true }),
            Err(error) => errors.push(WalkError { path: Some(path.clone()), message: error.to_string() }),
        }
    }
    errors.sort();
    errors.dedup();
    (without_repeats(found), errors)
}

fn walk_folder(
    folder: &Path,
    options: &WalkOptions,
    include: Option<&Patterns>,
    exclude: Option<&Patterns>,
    found: &mut Vec<Candidate>,
    errors: &mut Vec<WalkError>,
) {
    let mut builder = WalkBuilder::new(folder);
    builder
        .standard_filters(options.gitignore)
        .hidden(true)
        // What a run reads must not hang on the settings of the user who runs it.
        .git_global(false)
        .require_git(false);
    if let Some(exclude) = exclude.cloned() {
        builder.filter_entry(move |entry| entry.depth() == 0 || !exclude.matches(entry.path(), is_folder(entry)));
    }
    for entry in builder.build() {
        match entry {
            Ok(entry) => {
                if let Some(error) = entry.error() {
                    errors.push(walk_error(error));
                }
                let path = entry.path();
                if has_plc_extension(path)
                    && is_file(&entry)
                    && include.is_none_or(|include| include.matches_with_parents(path))
                {
                    let path = path.strip_prefix(".").unwrap_or(path).to_owned();
                    found.push(Candidate { path, explicit: false });
                }
            }
            Err(error) => errors.push(walk_error(&error)),
        }
    }
}

fn is_folder(entry: &DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| kind.is_dir())
}

/// Whether an entry is a file or a link to one.
fn is_file(entry: &DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| {
        kind.is_file() || kind.is_symlink() && entry.path().metadata().is_ok_and(|target| target.is_file())
    })
}

fn walk_error(error: &ignore::Error) -> WalkError {
    let mut path = None;
    let mut inner = error;
    loop {
        inner = match inner {
            ignore::Error::WithPath { path: at, err } => {
                path = Some(at.clone());
                err
            }
            ignore::Error::WithDepth { err, .. } | ignore::Error::WithLineNumber { err, .. } => err,
            _ => return WalkError { path, message: inner.to_string() },
        };
    }
}

/// Removes files that several paths lead to; a named one counts as named. Sorted.
fn without_repeats(mut found: Vec<Candidate>) -> Vec<Candidate> {
    found.sort();
    let mut seen: FxHashMap<PathBuf, usize> = FxHashMap::default();
    let mut unique: Vec<Candidate> = Vec::with_capacity(found.len());
    for candidate in found {
        let real = candidate.path.canonicalize().unwrap_or_else(|_| candidate.path.clone());
        match seen.get(&real).and_then(|&index| unique.get_mut(index)) {
            Some(first) => first.explicit |= candidate.explicit,
            None => {
                seen.insert(real, unique.len());
                unique.push(candidate);
            }
        }
    }
    unique
}

/// Patterns relative to a folder.
#[derive(Debug, Clone)]
struct Patterns {
    globs: Gitignore,
    /// Absolute, as are the paths that are matched: the user may write them any way.
    root: PathBuf,
}

/// `None` if there are no patterns.
fn patterns(root: &Path, lines: &[String], errors: &mut Vec<WalkError>) -> Option<Patterns> {
    if lines.is_empty() {
        return None;
    }
    let root = std::path::absolute(root).unwrap_or_else(|_| root.to_owned());
    let mut builder = GitignoreBuilder::new(&root);
    for line in lines {
        if let Err(error) = builder.add_line(None, line) {
            errors.push(WalkError { path: None, message: format!("pattern `{line}`: {error}") });
        }
    }
    match builder.build() {
        Ok(globs) => Some(Patterns { globs, root }),
        Err(error) => {
            errors.push(WalkError { path: None, message: error.to_string() });
            None
        }
    }
}

impl Patterns {
    fn matches(&self, path: &Path, is_folder: bool) -> bool {
        std::path::absolute(path).is_ok_and(|path| self.globs.matched(path, is_folder).is_ignore())
    }

    /// Whether the file or a folder around it matches, the nearest that any pattern speaks of deciding.
    fn matches_with_parents(&self, path: &Path) -> bool {
        let Ok(path) = std::path::absolute(path) else { return false };
        let within = path.ancestors().take_while(|ancestor| *ancestor != self.root);
        let mut decisions = within.enumerate().map(|(depth, ancestor)| self.globs.matched(ancestor, depth > 0));
        decisions.find(|decision| !decision.is_none()).is_some_and(|decision| decision.is_ignore())
    }
}

/// The largest file that is read: decoded, it may be three times as long, and offsets are 32 bits wide.
pub const MAX_BYTES: u64 = 1 << 30;

/// Reads a file.
///
/// # Errors
/// The system's, and a file larger than [`MAX_BYTES`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let file = std::fs::File::open(path)?;
    let expected = file.metadata().map_or(0, |metadata| metadata.len());
    read_limited(file, expected)
}

/// Reads to the end, which a device or a file that grows may never reach.
fn read_limited(source: impl Read, expected: u64) -> io::Result<Vec<u8>> {
    let too_large = || io::Error::new(io::ErrorKind::FileTooLarge, "larger than 1 GiB");
    if expected > MAX_BYTES {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(expected as usize);
    source.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES { Err(too_large()) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::TempDir;

    use super::*;

    /// A folder with files that each hold their own name.
    fn folder(files: &[&str]) -> TempDir {
        let folder = TempDir::new().unwrap();
        for file in files {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, file).unwrap();
        }
        folder
    }

    fn options(root: &TempDir) -> WalkOptions {
        WalkOptions { root: root.path().to_owned(), include: Vec::new(), exclude: Vec::new(), gitignore: true }
    }

    /// Paths relative to the folder, `!` before named ones.
    #[track_caller]
    fn check(root: &TempDir, paths: &[&str], options: &WalkOptions, expected: &[&str]) {
        let paths: Vec<_> = paths.iter().map(|path| root.path().join(path)).collect();
        let (found, errors) = walk(&paths, options);
        let found: Vec<_> = found
            .iter()
            .map(|candidate| {
                let path = candidate.path.strip_prefix(root.path()).unwrap_or(&candidate.path);
                let path = path.to_string_lossy().replace('\\', "/");
                if candidate.explicit { format!("!{path}") } else { path }
            })
            .collect();
        assert_eq!(found, expected);
        assert_eq!(errors, []);
    }

    #[test]
    fn folders_hold_programs() {
        let root = folder(&["b.awl", "a/z.ST", "a/b/c.txt", "readme.md", "main.c", ".hidden.awl", ".git/x.awl"]);
        check(&root, &[""], &options(&root), &["a/b/c.txt", "a/z.ST", "b.awl"]);
        check(&root, &["a", "b.awl"], &options(&root), &["a/b/c.txt", "a/z.ST", "!b.awl"]);
    }

    #[test]
    fn named_files_are_always_read() {
        let root = folder(&["main.c", ".hidden.awl", "old/x.awl", ".gitignore"]);
        fs::write(root.path().join(".gitignore"), "*.awl\n").unwrap();
        let options = WalkOptions { exclude: vec!["old".into()], include: vec!["src".into()], ..options(&root) };
        check(&root, &["main.c", ".hidden.awl", "old/x.awl"], &options, &["!.hidden.awl", "!main.c", "!old/x.awl"]);
        check(&root, &[""], &options, &[]);
    }

    #[test]
    fn files_are_found_once() {
        let root = folder(&["a/x.awl", "b.awl"]);
        check(&root, &["", "a", "a/../a/x.awl", "b.awl", "b.awl"], &options(&root), &["!a/../a/x.awl", "!b.awl"]);
    }

    #[test]
    fn ignore_files_outside_a_repository() {
        let root = folder(&["a.awl", "out/b.awl", "c.il", ".gitignore"]);
        fs::write(root.path().join(".gitignore"), "out/\n*.il\n").unwrap();
        check(&root, &[""], &options(&root), &["a.awl"]);
        let all = WalkOptions { gitignore: false, ..options(&root) };
        check(&root, &[""], &all, &["a.awl", "c.il", "out/b.awl"]);
    }

    #[test]
    fn patterns_of_the_configuration() {
        let root = folder(&["src/a.awl", "src/old/b.awl", "old/c.awl", "d.awl", "src/e.il"]);
        let with = |include: &[&str], exclude: &[&str]| WalkOptions {
            include: include.iter().map(|&pattern| pattern.into()).collect(),
            exclude: exclude.iter().map(|&pattern| pattern.into()).collect(),
            ..options(&root)
        };
        check(&root, &[""], &with(&["src/**"], &[]), &["src/a.awl", "src/e.il", "src/old/b.awl"]);
        check(&root, &[""], &with(&["src/"], &["*.il"]), &["src/a.awl", "src/old/b.awl"]);
        check(&root, &[""], &with(&[], &["old/**"]), &["d.awl", "src/a.awl", "src/e.il", "src/old/b.awl"]);
        check(&root, &[""], &with(&[], &["old/"]), &["d.awl", "src/a.awl", "src/e.il"]);
        check(&root, &[""], &with(&["*.awl", "!src/old"], &[]), &["d.awl", "old/c.awl", "src/a.awl", "src/old/b.awl"]);
        check(&root, &["src"], &with(&["/src/*.awl"], &[]), &["src/a.awl"]);
        // A folder that is named is walked even if it is excluded.
        check(&root, &["old"], &with(&[], &["old/"]), &["old/c.awl"]);
    }

    #[test]
    fn what_cannot_be_walked_is_said() {
        let root = folder(&["a.awl"]);
        let missing = root.path().join("missing");
        let (found, errors) = walk(&[missing.clone(), root.path().join("a.awl")], &options(&root));
        assert_eq!(found.len(), 1);
        assert_eq!(errors.iter().map(|error| error.path.as_deref()).collect::<Vec<_>>(), [Some(missing.as_path())]);
        assert!(errors[0].to_string().contains("missing: "));

        let bad = WalkOptions { exclude: vec!["a{".into()], ..options(&root) };
        let (found, errors) = walk(&[root.path().to_owned()], &bad);
        assert_eq!((found.len(), errors.len()), (1, 1));
        assert!(errors[0].to_string().starts_with("pattern `a{`: "));
    }

    #[cfg(unix)]
    #[test]
    fn links() {
        use std::os::unix::fs::symlink;

        let root = folder(&["a/x.awl", "b/keep.txt"]);
        symlink("..", root.path().join("a/loop")).unwrap();
        symlink("x.awl", root.path().join("a/y.awl")).unwrap();
        symlink("missing.awl", root.path().join("a/z.awl")).unwrap();
        symlink("../a/x.awl", root.path().join("b/linked.il")).unwrap();
        check(&root, &[""], &options(&root), &["a/x.awl", "b/keep.txt"]);
        check(&root, &["b"], &options(&root), &["b/keep.txt", "b/linked.il"]);
        check(&root, &["a/loop"], &options(&root), &["a/loop/a/x.awl", "a/loop/b/keep.txt"]);
    }

    #[test]
    fn reading() {
        let root = folder(&["a.awl"]);
        assert_eq!(read(&root.path().join("a.awl")).unwrap(), b"a.awl");
        assert_eq!(read(&root.path().join("b.awl")).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert!(read(root.path()).is_err());
        assert_eq!(read_limited(io::empty(), MAX_BYTES + 1).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
    }
}

//! After any edits, the findings are those of a fresh check of the final text.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::client::{Client, pulling};
use crate::numbers::Numbers;

fn one_of<'a, T>(numbers: &mut Numbers, list: &'a [T]) -> &'a T {
    &list[numbers.below(list.len())]
}

/// Pieces that change what a text means: heads of units, labels, ends of comments, line breaks of all kinds.
const PIECES: [&str; 24] = [
    "\n",
    "\r\n",
    "\r",
    " ",
    ";",
    "(*",
    "*)",
    "//",
    "é",
    "😀",
    "! ",
    "%M1",
    " := ",
    "U     E 0.0;\n",
    "=     A 4.0;\n",
    "NETWORK\n",
    "END_FUNCTION\n",
    "FUNCTION FC 9 : VOID\nBEGIN\n",
    "ST : MAST - SR3\n",
    "%L20: ",
    "BEB\n",
    "SET %M1;\n",
    "// plclint: allow(W001)\n",
    "\"",
];

/// Texts of a corpus program, by the path of its folder. A configuration stays as it is.
pub fn program(folder: &str) -> Vec<(String, String)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corpus").join(folder);
    let mut files: Vec<(String, String)> = fs::read_dir(folder)
        .unwrap()
        .map(|it| it.unwrap().path())
        .filter_map(|it| Some((it.file_name()?.to_str()?.to_owned(), fs::read_to_string(&it).ok()?)))
        .collect();
    files.sort();
    files
}

fn position(text: &str, at: usize) -> Value {
    let before = &text[..at];
    // CRLF is one break, as are CR and LF.
    let breaks: Vec<usize> = before
        .char_indices()
        .filter(|&(at, it)| it == '\n' || it == '\r' && text.as_bytes().get(at + 1) != Some(&b'\n'))
        .map(|it| it.0 + 1)
        .collect();
    let start = breaks.last().copied().unwrap_or(0);
    json!({ "line": breaks.len(), "character": before[start..].encode_utf16().count() })
}

fn boundary(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) || text[..at].ends_with('\r') && text[at..].starts_with('\n') {
        at -= 1;
    }
    at
}

fn range(text: &str, start: usize, end: usize) -> Value {
    json!({ "start": position(text, start), "end": position(text, end) })
}

/// A piece of text in place of another, at a byte of a file.
struct Edit {
    file: usize,
    at: usize,
    old: String,
    new: String,
}

impl Edit {
    fn at_random(numbers: &mut Numbers, file: usize, text: &str) -> Self {
        let start = boundary(text, numbers.below(text.len() + 1));
        let length = if numbers.below(3) == 0 { numbers.below(60) } else { 0 };
        let end = boundary(text, (start + length).min(text.len())).max(start);
        let new = if length > 0 && numbers.below(2) == 0 { "" } else { *one_of(numbers, &PIECES) };
        Self { file, at: start, old: text[start..end].to_owned(), new: new.to_owned() }
    }

    fn undone(self) -> Self {
        Self { old: self.new, new: self.old, ..self }
    }

    /// Applies the edit; what a client says of it. A place inside of a CR LF has no position: then it sends all of the text,
    /// as it does now and then in any case.
    fn apply(&self, text: &mut String, whole: bool) -> Value {
        let end = self.at + self.old.len();
        assert_eq!(text[self.at..end], self.old);
        let is_place = |at: usize| boundary(text, at) == at;
        let range = (!whole && is_place(self.at) && is_place(end)).then(|| range(text, self.at, end));
        text.replace_range(self.at..end, &self.new);
        match range {
            Some(range) => json!({ "range": range, "text": self.new }),
            None => json!({ "text": *text }),
        }
    }
}

/// Random inserts, deletes and undoes in the files of a program, several in one message at times, with questions that
/// cross them.
fn edit_at_random(folder: &str, seed: u64, edits: usize) {
    let files = program(folder);
    let pairs: Vec<(&str, &str)> = files.iter().map(|it| (it.0.as_str(), it.1.as_str())).collect();
    let mut client = Client::start(pulling(), &pairs);
    let mut numbers = Numbers(seed);
    let mut texts: Vec<(String, String)> = files.into_iter().filter(|it| it.0 != "plclint.toml").collect();
    let mut undo: Vec<Edit> = Vec::new();
    for (path, text) in &texts {
        client.open(path, text);
    }
    let (mut done, mut compared) = (0, 0);
    while done < edits {
        let file = numbers.below(texts.len());
        // The last edit of all files is undone, or the edited file gets some more.
        let undoes = numbers.below(4) == 0 && !undo.is_empty();
        let count = if undoes || numbers.below(8) > 0 { 1 } else { 1 + numbers.below(4) };
        let (mut changes, mut changed) = (Vec::new(), file);
        for _ in 0..count {
            let edit = match undo.pop_if(|_| undoes) {
                Some(edit) => edit.undone(),
                None => Edit::at_random(&mut numbers, file, &texts[file].1),
            };
            changed = edit.file;
            changes.push(edit.apply(&mut texts[changed].1, numbers.below(8) == 0));
            if !undoes {
                undo.push(edit);
            }
        }
        done += count;
        let (path, text) = &texts[changed];
        client.change(path, json!(changes));
        match numbers.below(20) {
            0 => {
                client.pull(path);
            }
            1 | 2 => {
                let place = position(text, boundary(text, numbers.below(text.len() + 1)));
                let params = json!({ "textDocument": client.document(path), "position": place });
                let id = client.post("textDocument/hover", params);
                if numbers.below(2) == 0 {
                    client.notify("$/cancelRequest", json!({ "id": id }));
                }
            }
            _ => {}
        }
        if done >= edits || done - compared >= INTERVAL {
            compared = done;
            compare(&mut client, &texts, done);
        }
    }
    // Everything is undone: the findings are those of the start.
    while let Some(edit) = undo.pop().map(Edit::undone) {
        let change = edit.apply(&mut texts[edit.file].1, false);
        client.change(&texts[edit.file].0, json!([change]));
    }
    assert!(texts.iter().all(|it| program(folder).contains(it)));
    compare(&mut client, &texts, done);
    client.stop();
}

/// Edits between two comparisons with a fresh check.
const INTERVAL: usize = 100;

fn compare(client: &mut Client, texts: &[(String, String)], n: usize) {
    let found = client.pull_all();
    for (path, text) in texts {
        fs::write(client.root().join(Path::new(path)), text).unwrap();
    }
    let expected = client.check();
    assert_eq!(found, expected, "after {n} edits");
}

#[test]
fn statement_list_may_be_edited_at_random() {
    edit_at_random("programs/convoyeur-tri", 0x9e37_79b9_7f4a_7c15, 2000);
}

#[test]
fn pl7_may_be_edited_at_random() {
    edit_at_random("programs/palettiseur", 0xd1b5_4a32_d192_ed03, 2000);
}

#[test]
fn charts_and_rungs_may_be_edited_at_random() {
    edit_at_random("programs/portique-lavage", 0x2545_f491_4f6c_dd1d, 1500);
    edit_at_random("programs/table-tournante", 0x853c_49e6_748f_ea9b, 1000);
}

#[test]
fn symbols_may_be_edited_at_random() {
    edit_at_random("programs/convoyeur-s7", 0xc2b2_ae3d_27d4_eb4f, 1500);
}

#[test]
fn types_and_variables_may_be_edited_at_random() {
    edit_at_random("programs/traitement-surface", 0x1656_67b1_9e37_79f9, 1000);
}

#[test]
fn step_5_may_be_edited_at_random() {
    edit_at_random("documents/grafcet-step5/maitre-a-danser", 0x27d4_eb2f_1656_67c5, 1000);
}

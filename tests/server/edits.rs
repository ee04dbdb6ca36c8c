//! After any edits, the findings are those of a fresh check of the final text.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use crate::client::{Client, pulling};

/// A sequence of numbers that is the same on every machine (Marsaglia's xorshift).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % end.max(1) as u64).unwrap()
    }

    fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
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

/// Files of a corpus program, by name.
fn program(name: &str) -> Vec<(String, String)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corpus/programs").join(name);
    let mut files: Vec<(String, String)> = fs::read_dir(folder)
        .unwrap()
        .map(|it| it.unwrap().path())
        .filter_map(|it| Some((it.file_name()?.to_str()?.to_owned(), fs::read_to_string(&it).ok()?)))
        .collect();
    files.sort();
    files
}

fn position(text: &str, at: usize) -> serde_json::Value {
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

/// Random inserts, deletes and undoes in the files of a program.
fn edit_at_random(name: &str, seed: u64, edits: usize) {
    let files = program(name);
    assert!(!files.is_empty());
    let pairs: Vec<(&str, &str)> = files.iter().map(|it| (it.0.as_str(), it.1.as_str())).collect();
    let mut client = Client::start(pulling(), &pairs);
    let mut numbers = Numbers(seed);
    let mut texts = files.clone();
    let mut undo: Vec<(usize, String)> = Vec::new();
    for (path, text) in &files {
        client.open(path, text);
    }
    for n in 0..edits {
        let file = numbers.below(texts.len());
        let path = texts[file].0.clone();
        let before = texts[file].1.clone();
        if numbers.below(4) == 0
            && let Some((file, text)) = undo.pop()
        {
            let path = texts[file].0.clone();
            client.replace(&path, &text);
            texts[file].1 = text;
        } else {
            let start = boundary(&before, numbers.below(before.len() + 1));
            let length = if numbers.below(3) == 0 { numbers.below(60) } else { 0 };
            let end = boundary(&before, (start + length).min(before.len())).max(start);
            let text = if length > 0 && numbers.below(2) == 0 { "" } else { *numbers.of(&PIECES) };
            let range = json!({ "start": position(&before, start), "end": position(&before, end) });
            client.change(&path, json!([{ "range": range, "text": text }]));
            texts[file].1 = format!("{}{text}{}", &before[..start], &before[end..]);
            undo.push((file, before));
        }
        if n % 5 == 0 {
            client.pull(&path);
        }
        if n % 50 == 49 || n + 1 == edits {
            compare(&mut client, &texts, n);
        }
    }
    client.stop();
}

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
    edit_at_random("convoyeur-tri", 0x9e37_79b9_7f4a_7c15, 500);
}

#[test]
fn pl7_may_be_edited_at_random() {
    edit_at_random("palettiseur", 0xd1b5_4a32_d192_ed03, 500);
}

#[test]
fn charts_and_rungs_may_be_edited_at_random() {
    edit_at_random("portique-lavage", 0x2545_f491_4f6c_dd1d, 300);
    edit_at_random("table-tournante", 0x853c_49e6_748f_ea9b, 200);
}

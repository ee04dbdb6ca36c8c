//! Any bytes: the whole pipeline ends, loses nothing, nests safely, and takes linear time.

use std::path::Path;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use plclint::db::{self, Input};
use plclint::draw::Theme;
use plclint::lint::settings::{FILE_NAME, Folders, Overrides, Settings};
use plclint::lint::{Outcome, rules};
use plclint::source::decode::Encoding;
use plclint::source::detect::{self, Dialect, FileHint};
use plclint::source::split::{self, SplitHint};
use plclint::syntax::{self, Language, MAX_DEPTH, Mnemonics, WalkEvent};
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// All that can be parsed.
const LANGUAGES: [Language; 16] = [
    Language::Awl(Mnemonics::German),
    Language::Awl(Mnemonics::English),
    Language::Step5(Mnemonics::German),
    Language::Step5(Mnemonics::English),
    Language::Step5Symbols,
    Language::Pl7Il,
    Language::Pl7St,
    Language::Pl7Ld,
    Language::Pl7Gr7,
    Language::Sfc,
    Language::Pl72Ld,
    Language::Pl72Gr7,
    Language::Pl72Sfc,
    Language::Exchange,
    Language::SymbolTable,
    Language::Pl7Xref,
];

/// Text as a file holds it.
struct File<'b> {
    extension: &'b str,
    bytes: &'b [u8],
    dialect: Dialect,
    encoding: Option<Encoding>,
}

impl File<'_> {
    /// Reads the file, and each of its units.
    fn read(&self) -> Input {
        let path = format!("hostile.{}", self.extension);
        let hint = FileHint { path: Some(Path::new(&path)), explicit: true, dialect: self.dialect, family: None };
        let (source, detected) = detect::load(hint, self.bytes, self.encoding);
        let mut at = 0;
        for span in split::split(&source.text, detected, &SplitHint::default()) {
            let range = std::ops::Range::<usize>::from(span.range);
            assert_eq!(range.start, at, "units tile the text");
            at = range.end;
            parse(span.language, &source.text[range]);
        }
        assert_eq!(at, source.text.len());
        Input { path, source, detected }
    }
}

/// The tree is the text, no higher than the stack of a walker bears, and errors lie between characters.
fn parse(language: Language, text: &str) {
    let parse = syntax::parse(language, text);
    assert!(parse.syntax().text() == text, "no byte is lost");
    let (mut depth, mut deepest) = (0, 0);
    for event in parse.syntax().walk() {
        match event {
            WalkEvent::Enter(_) => depth += 1,
            WalkEvent::Leave(_) => depth -= 1,
            WalkEvent::Token(_) => {}
        }
        deepest = deepest.max(depth);
    }
    assert!(deepest < 6 * MAX_DEPTH, "{language:?}: {deepest} levels");
    for error in parse.errors() {
        assert!(text.get(std::ops::Range::<usize>::from(error.range)).is_some());
    }
}

/// All rules, with what a `plclint.toml` says.
fn settings(configuration: &str) -> Settings {
    let overrides = Overrides { select: Some(vec!["all".to_owned()]), ..Overrides::default() };
    Settings::parse(configuration, Path::new(FILE_NAME), Folders::default(), overrides).expect("a configuration")
}

fn check_with(input: Input, settings: Settings) -> Outcome {
    let outcome = db::check(vec![input], settings);
    assert_eq!(outcome.internal_errors, [""; 0]);
    for it in &outcome.diagnostics {
        let text = &outcome.files[it.finding.place.file as usize].text;
        let range = std::ops::Range::<usize>::from(it.finding.place.range);
        assert!(text.get(range).is_some(), "a finding lies in its file, between characters");
    }
    outcome
}

fn check(bytes: &[u8], dialect: Dialect) -> Outcome {
    check_with(File { extension: "awl", bytes, dialect, encoding: None }.read(), settings(""))
}

const GR7: &str = "GR7 : MAST - P - CHART\nNB_PAGES = 8\nPAGE 0\nINITIAL_STEP 0 AT (C 4,L 3) :\nACTION (N1,ST) : (*PHRASE*) %L1: \
                   IF %X0.T > 5 THEN JUMP %L1; END_IF; (*END_PHRASE*) END_ACTION\nACTION (P0,IL) : ! LD %I1.0 S %M5 END_ACTION\n\
                   END_STEP\nTRANSITION (*go*) (ST) AT (C 4,L 4) : %M0 := %M1 END_TRANSITION\nT_S_OR_LINK FROM (C 4,L 4) TO \
                   (C 4,L 3) := [H_LINK FROM (C 4,L 4) TO (C 5,L 4)]\nDEST_CONNECTOR 1 AT (C 4,L 5)\nEND_PAGE\nPAGE 1\n\
                   SOURCE_CONNECTOR 0 AT (C 0,L 0)\nSTEP 1 AT (C 0,L 1) :\nACTION (P1,LD) : RUNG\nH_LINK(10),COIL(%M0);\nEND_RUNG \
                   END_ACTION\nEND_STEP\nEND_PAGE\n";
const PL7_2: &str = "LD : PL7-2 - PRL\nRUNG (*x*) L3:\nOPEN_CONTACT(I0,05),SHORT_CIRCUIT,BLOCK(T0),H_LINK(5),COIL(O1,3);\n\
                     CLOSED_CONTACT(%B1),H_LINK,EMPTY_CELL(8);\nCOMPARE W0 > = H'5' END_BLOCK,H_LINK(5),OPERATE W5(W10) -> B0[8] \
                     END_BLOCK;\nH_LINK(7),OPERATE SLC 3 W1 -> W2 END_BLOCK;\nEND_RUNG\nRUNG L4:\nOPEN_CONTACT(W5,A),\
                     BLOCK(WEEK(W1,CW2)),H_LINK(6),JUMP_COIL(L3);\nEND_RUNG\nGR7 : PL7-2 - SEQ\nPAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) :\n\
                     ACTION (N1,LD) : RUNG L1:\nOPEN_CONTACT(X0),H_LINK(8),SAVE_COIL(B2);\nEND_RUNG END_ACTION\nEND_STEP\n\
                     TRANSITION (LD) AT (C 0,L 2) : RUNG\nOPEN_CONTACT(I1,B),H_LINK(8);\nEND_RUNG END_TRANSITION\nEND_PAGE\n";

/// What files are called, and the words of the fences in rule pages that hold the same. Each is read as its language and
/// as what it looks like.
const KINDS: [(&str, Dialect); 15] = [
    ("awl", Dialect::Step7),
    ("s5", Dialect::Step5),
    ("seq", Dialect::Auto),
    ("il", Dialect::Pl7Il),
    ("st", Dialect::Pl7St),
    ("ld", Dialect::Pl7Ld),
    ("gr7", Dialect::Pl7Gr7),
    ("sfc", Dialect::Sfc),
    ("pl72", Dialect::Pl72),
    ("pl7", Dialect::Pl7),
    ("dfb", Dialect::Pl7),
    ("fef", Dialect::Auto),
    ("scy", Dialect::Auto),
    ("sdf", Dialect::Auto),
    ("asc", Dialect::Auto),
];

/// The fences of rule pages that begin with a word, with what follows it in their first lines.
fn fences(word: &str) -> impl Iterator<Item = &'static str> {
    let fences = rules().iter().flat_map(|it| it.page.split("```").skip(1).step_by(2));
    fences.filter_map(|it| it.split_once('\n')).filter(move |it| it.0.split(',').next() == Some(word)).map(|it| it.1)
}

/// Real text of each kind: the corpus, the examples of the rule pages, and what neither has.
static SEEDS: LazyLock<Vec<Vec<&'static str>>> = LazyLock::new(|| {
    let mut files: Vec<(String, &'static str)> = vec![("gr7".to_owned(), GR7), ("pl72".to_owned(), PL7_2)];
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let Some(extension) = path.extension().and_then(|it| it.to_str()) else {
                folders.push(path);
                continue;
            };
            let text = plclint::source::decode::decode(&std::fs::read(&path).expect("a file"), None).text;
            files.push((extension.to_ascii_lowercase(), String::leak(text.to_string())));
        }
    }
    files.sort();
    let of = |kind| files.iter().filter(move |it| it.0 == kind).map(|it| it.1).chain(fences(kind)).collect();
    KINDS.iter().map(|it| of(it.0)).collect()
});

/// Words, stretches of blanks, and single characters.
fn tokens(text: &str) -> Vec<&str> {
    let class = |it: char| match it {
        '\n' => 0,
        it if it.is_whitespace() => 1,
        '_' | '%' | '.' => 2,
        it if it.is_alphanumeric() => 2,
        _ => 3,
    };
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next().map(class) {
        let whole = rest.find(|it| class(it) != first).unwrap_or(rest.len());
        let len = if matches!(first, 0 | 3) { rest.chars().next().map_or(0, char::len_utf8) } else { whole };
        let (token, after) = rest.split_at(len);
        tokens.push(token);
        rest = after;
    }
    tokens
}

/// Some lines of a text, from its beginning or from anywhere.
fn lines(text: &'static str, from: Option<Index>, count: usize) -> Vec<&'static str> {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let start = from.map_or(0, |it| it.index(lines.len() + 1));
    lines.into_iter().skip(start).take(count).flat_map(tokens).collect()
}

const ODD: [&str; 14] =
    ["\0", "\r", "é", "\u{2028}", "(", ")", "[", "(*", "'", "\"", "%", "9999999999999999999999", "-32768", "\n"];

type Edit = (u8, Index, Index);

/// Text as it is when somebody types, pastes, or a transfer breaks off: of two real texts of a kind.
fn mutated(kind: usize) -> impl Strategy<Value = String> {
    let seed = || select(SEEDS[kind].as_slice());
    let edits = prop::collection::vec(any::<Edit>(), 0..10);
    (seed(), seed(), any::<Option<Index>>(), any::<Index>(), edits).prop_map(
        |(text, other, from, other_from, edits)| {
            let other = lines(other, Some(other_from), 8);
            let mut text = lines(text, from, 40);
            for (what, at, second) in edits {
                let at = at.index(text.len() + 1);
                let line = text[at..].iter().position(|it| *it == "\n").map_or(text.len(), |it| at + it + 1);
                let odd = *second.get(&ODD);
                match what % 12 {
                    0 => drop(text.drain(at..text.len().min(at + 1))),
                    1 => text.extend_from_within(at..line),
                    2 if at < text.len() => text.insert(at, text[at]),
                    3 if at < text.len() => {
                        let second = second.index(text.len());
                        text.swap(at, second);
                    }
                    4 if !other.is_empty() => text.insert(at, *second.get(&other)),
                    // What is cut off, of a line or of the file.
                    5 => drop(text.drain(at..line)),
                    6 if second.index(3) == 0 => text.truncate(at),
                    7 => drop(text.splice(at..at, std::iter::repeat_n(odd, 300))),
                    // What is pasted: lines of the other text between two lines.
                    8 | 9 => drop(text.splice(line..line, other.iter().copied())),
                    _ => text.insert(at, odd),
                }
            }
            text.concat()
        },
    )
}

/// What rule pages configure, and nothing.
static CONFIGURATIONS: LazyLock<Vec<&'static str>> = LazyLock::new(|| fences("toml").chain([""]).collect());

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400), dialect in select(&Dialect::ALL[..])) {
        check(&bytes, dialect);
    }

    #[test]
    fn any_text(text in "\\PC{0,200}", dialect in select(&Dialect::ALL[..])) {
        LANGUAGES.iter().for_each(|language| parse(*language, &text));
        check(text.as_bytes(), dialect);
    }
}

/// One text of each kind in turn, in both encodings, as all languages, with and without a configuration. `PROPTEST_CASES`
/// asks for more of them.
fn mutated_text(kinds: std::ops::Range<usize>) {
    let cases = ProptestConfig::default().cases.div_ceil(10);
    for kind in kinds {
        let (extension, own) = KINDS[kind];
        let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
        let strategy = (mutated(kind), select(CONFIGURATIONS.as_slice()), any::<[bool; 2]>());
        let test = |(text, configuration, [is_auto, is_utf8]): (String, &str, [bool; 2])| {
            LANGUAGES.iter().for_each(|language| parse(*language, &text));
            let dialect = if is_auto { Dialect::Auto } else { own };
            let single_byte = encoding_rs::WINDOWS_1252.encode(&text).0;
            let bytes = if is_utf8 { text.as_bytes() } else { &single_byte };
            let input = File { extension, bytes, dialect, encoding: None }.read();
            check_with(input.clone(), settings(""));
            check_with(input.clone(), settings(configuration));
            let drawings = db::open(vec![input], Vec::new(), settings("")).drawings(true);
            drawings.iter().for_each(|it| assert!(it.drawing.svg(Theme::Auto).ends_with("</svg>\n")));
            Ok(())
        };
        proptest::test_runner::TestRunner::new(config).run(&strategy, test).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn mutated_statement_lists() {
    mutated_text(0..3);
}

#[test]
fn mutated_pl7_text() {
    mutated_text(3..5);
}

#[test]
fn mutated_ladder_and_charts() {
    mutated_text(5..8);
}

#[test]
fn mutated_pl7_2_and_types() {
    mutated_text(8..11);
}

#[test]
fn mutated_declarations() {
    mutated_text(11..15);
}

#[test]
fn deep_nesting_is_reported_and_survived() {
    for text in [
        "U(\n".repeat(100_000),
        format!("! %M0 := {}1{};", "(".repeat(100_000), ")".repeat(100_000)),
        format!("! LD %I1.0\n{}ST %Q2.0", "AND( %M1\n".repeat(100_000)),
        format!("! {}", "IF %M0 THEN ".repeat(100_000)),
        format!("! %MW0 := {}1;", "NOT ".repeat(100_000)),
        format!("! %MW0 := {}1;", "1+".repeat(100_000)),
        format!("! %MW0{}", "[%MW0".repeat(100_000)),
        "(*".repeat(100_000),
        format!("RUNG\nCOMPARE {}", "(".repeat(100_000)),
        format!("RUNG\n{}", "OPERATE ".repeat(100_000)),
        format!("RUNG\nOPERATE {}", "SLC 3 - -> ".repeat(100_000)),
        format!("RUNG\nBLOCK({}", "WEEK(".repeat(100_000)),
        format!("RUNG\n{}", "X(".repeat(100_000)),
        format!("RUNG\n{}COIL(%M0);END_RUNG", "OPEN_CONTACT(%M1),".repeat(20_000)),
        format!("DATA_BLOCK DB 1\n{}", "a : STRUCT\n".repeat(100_000)),
        format!("L MW {}", "[".repeat(100_000)),
        format!("STEP 1 : ACTION (N1,ST) : {}", "IF %M0 THEN ".repeat(50_000)),
        "STEP 1 : ACTION (N1,ST) : ".repeat(20_000),
        "T_S_OR_LINK FROM (C 1,L 1) TO (C 1,L 1) := [".repeat(20_000),
    ] {
        for dialect in [Dialect::Step7, Dialect::Pl7Il, Dialect::Pl7St, Dialect::Pl7Ld, Dialect::Pl7Gr7, Dialect::Pl72]
        {
            check(text.as_bytes(), dialect);
        }
    }
}

#[test]
fn odd_files() {
    for bytes in [
        vec![0_u8; 100_000],
        b"\xff\xfeU\0 \0E\0".to_vec(),
        b"\xef\xbb\xbfU E0.0\n= A4.0".to_vec(),
        b"\r".repeat(1000),
        "U E0.0 // \u{e9}\u{2028}\u{85}\n= A4.0".as_bytes().to_vec(),
        b"U E0.0 // \xe9t\xe9\n= A4.0".to_vec(),
        b"U".repeat(10_000_000),
        b"U E 0.0; ".repeat(100_000),
        b"%M0 := %M1; ".repeat(50_000),
    ] {
        for dialect in [Dialect::Auto, Dialect::Step7, Dialect::Step5, Dialect::Pl7St] {
            check(&bytes, dialect);
        }
    }
}

#[test]
fn lines_of_ten_megabytes() {
    let mnemonics = syntax::Mnemonics::German;
    for (line, language) in [
        ("U E 0.0; ", syntax::Language::Awl(mnemonics)),
        ("%M0 := %M1; ", syntax::Language::Pl7St),
        ("LD %M0 ST %M1 ", syntax::Language::Pl7Il),
        ("%MW0 = = ( ", syntax::Language::Pl7St),
        ("RUNG COIL(%M0); ", syntax::Language::Pl7Ld),
        ("COMPARE ( ,; ", syntax::Language::Pl7Ld),
        ("RUNG COIL(W5(W1)); ", syntax::Language::Pl72Ld),
        ("U E 0.0 = ( ", syntax::Language::Step5(mnemonics)),
        ("OPERATE W1 + -> ", syntax::Language::Pl72Ld),
    ] {
        let text = line.repeat(10_000_000 / line.len());
        assert!(syntax::parse(language, &text).syntax().text() == text.as_str());
    }
}

/// Twice the text takes about twice the time. The factor is wide, for machines that do other things besides: what it
/// catches is quadratic growth, which shows as a factor of 16 and more.
#[test]
fn time_is_linear() {
    let shapes: [(&str, Dialect); 26] = [
        ("U(\nU E 0.0\n)\n= A 4.0\n", Dialect::Step7),
        ("U E 0.0\nO M 1.0\n", Dialect::Step7),
        ("L MW 2\nL 5\n+I\nT MW 4\n", Dialect::Step7),
        ("U E 0.0\nSPB M1\nM2: NOP 0\n", Dialect::Step7),
        ("U E 0.0\n= M 0.0\nU M 0.0\n= A 4.0\n", Dialect::Step7),
        ("PB #\n:U E 0.0\n:= A 4.0\n:***\n:BE\n", Dialect::Step5),
        (":SPA FB 5\nNAME :X\nEIN :E 0.0\n", Dialect::Step5),
        ("M# :U( :O t# O X3 ) = M 1.0 ***\n", Dialect::Step5),
        ("! %M0 := %M1 OR %M2;\n", Dialect::Pl7St),
        ("! IF %M0 THEN %MW1 := %MW2 + 1; END_IF;\n", Dialect::Pl7St),
        ("! LD %M0\nOR %M1\nST %M2\n", Dialect::Pl7Il),
        ("STEP # AT (C #,L 1) : ACTION (N1,ST) : %L1: %M0 := %M1; JUMP %L1; END_ACTION END_STEP\n", Dialect::Pl7Gr7),
        ("STEP # AT (C #,L 1) : END_STEP TRANSITION (ST) AT (C #,L 2) : %M# END_TRANSITION\n", Dialect::Pl7Gr7),
        ("S_T_AND_LINK FROM (C #,L 1) TO (C 0,L 2)\nSTEP # AT (C #,L 1) : END_STEP\n", Dialect::Pl7Gr7),
        ("SOURCE_CONNECTOR # AT (C #,L 0)\nDEST_CONNECTOR # AT (C #,L 3)\n", Dialect::Pl7Gr7),
        ("STEP X# : A#(N); Fill(N); %M#(N); END_STEP\nACTION A# : %M0 := %M1; END_ACTION\n", Dialect::Sfc),
        ("TRANSITION FROM X# TO (X1,X#) := %M0; END_TRANSITION\n", Dialect::Sfc),
        ("RUNG\nOPEN_CONTACT(%M0),H_LINK(9),COIL(%M1);\nEND_RUNG\n", Dialect::Pl7Ld),
        // All in one rung: networks apart, branches, one row.
        ("RUNG\n|OPEN_CONTACT(%M0),H_LINK(9),COIL(%M1);\n", Dialect::Pl7Ld),
        ("RUNG\n|OPEN_CONTACT(%M0),SHORT_CIRCUIT,CLOSED_CONTACT(%M1),H_LINK(7),COIL(%M2);\n", Dialect::Pl7Ld),
        ("RUNG\n|OPEN_CONTACT(%M0),SHORT_CIRCUIT,V_LINK,", Dialect::Pl7Ld),
        ("RUNG L1:\nOPEN_CONTACT(I0,05),H_LINK(6),OPERATE W5(W1) -> W#(W1) END_BLOCK;\nEND_RUNG\n", Dialect::Pl72),
        ("RUNG\n|OPEN_CONTACT(B0),SHORT_CIRCUIT,CLOSED_CONTACT(B1),H_LINK(6),COIL(B2);\n", Dialect::Pl72),
        ("RUNG\n|OPEN_CONTACT(B0),SHORT_CIRCUIT,V_LINK,", Dialect::Pl72),
        // In one receptivity.
        ("TRANSITION (LD) AT (C 0,L 2) : RUNG\n|OPEN_CONTACT(B0);\n", Dialect::Pl72),
        ("TRANSITION (LD) AT (C 0,L 2) : RUNG\n|OPEN_CONTACT(B0),H_LINK(8);\n", Dialect::Pl72),
    ];
    for (shape, dialect) in shapes {
        let time = |count: usize| {
            // `#` is the number of the repetition; what stands before `|` is not repeated.
            let (first, repeated) = shape.split_once('|').unwrap_or(("", shape));
            let repeated: String = (0..count).map(|it| repeated.replace('#', &it.to_string())).collect();
            let text = format!("{first}{repeated}");
            let mut best = Duration::MAX;
            for _ in 0..2 {
                let start = Instant::now();
                check(text.as_bytes(), dialect);
                best = best.min(start.elapsed());
            }
            best
        };
        let small = time(250);
        let large = time(4000);
        assert!(large < small * 100 + Duration::from_millis(50), "{shape:?}: {small:?} for 250, {large:?} for 4000");
    }
}

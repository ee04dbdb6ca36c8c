//! The program as a user runs it: arguments, exit codes, streams.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plclint"));
    command.current_dir(folder).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").env("TERM", "dumb");
    command
}

struct Ran {
    code: Option<i32>,
    out: String,
    err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("output is UTF-8");
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

fn run(folder: &Path, arguments: &[&str]) -> Ran {
    command(folder).args(arguments).stdin(Stdio::null()).output().expect("the program starts").into()
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    for (path, text) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    folder
}

/// Wrong usage: code 2, nothing on standard output, and a message that says `what`.
#[track_caller]
fn assert_usage(ran: &Ran, what: &str) {
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert_eq!(ran.out, "");
    assert!(ran.err.contains(what), "{}", ran.err);
    assert!(!ran.err.contains("panicked"), "{}", ran.err);
}

#[test]
fn help_is_no_mistake() {
    let folder = folder(&[]);
    for arguments in [&["--help"][..], &["check", "--help"], &["help", "rule"]] {
        let ran = run(folder.path(), arguments);
        assert_eq!(ran.code, Some(0), "{arguments:?}: {}", ran.err);
        assert!(ran.out.contains("Usage: plclint"), "{}", ran.out);
    }
    let version = run(folder.path(), &["--version"]);
    assert_eq!(version.out, format!("plclint {}\n", env!("CARGO_PKG_VERSION")));
}

/// A file of which nothing is read is named with its form, whether the form is the file's or that of all its units.
#[test]
fn what_is_not_read_is_named() {
    let rung = "RUNG L1:\nOPEN_CONTACT(I0,05),H_LINK(8),COIL(O0,03);\nEND_RUNG\n";
    let folder = folder(&[
        ("press.txt", "IL : PL7-2 - PRL\nLD I0,05\nIL : PL7-2 - POST\nLD I0,06\n"),
        ("mixed.txt", &format!("LD : PL7-2 - PRL\n{rung}ST : MAST - MAIN\n! %Q2.0 := %I1.0;\n")),
        ("plclint.toml", "[target]\ncontroller = 'TSX 17-20'"),
    ]);
    let ran = run(folder.path(), &["check", "--format", "concise"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let all = ran.out + &ran.err;
    let form = "PL7-2 language other than ladder and Grafcet";
    assert!(all.contains(&format!("press.txt: not read: {form} is not supported")), "{all}");
    assert!(!all.contains("mixed.txt: not read"), "{all}");
}

/// The configured controller says whose the ladder is, where nothing else does.
#[test]
fn ladder_of_a_configured_controller() {
    let rung = |label: u32| format!("RUNG L{label}:\nOPEN_CONTACT(B1),H_LINK(8),COIL(B2);\nEND_RUNG\n");
    let text = rung(1) + &rung(2);
    let check = |controller: &str| {
        let config = format!("[target]\ncontroller = '{controller}'");
        let folder = folder(&[("press.txt", text.as_str()), ("plclint.toml", &config)]);
        run(folder.path(), &["check", "--format", "concise"]).out
    };
    let out = check("TSX 17-20");
    assert!(out.contains("W001") && !out.contains("L002"), "{out}");
    let out = check("TSX 37-22");
    assert!(out.contains("L002"), "ten columns are one too few in PL7: {out}");
}

/// `[[entity]]` says what a file without a heading is.
#[test]
fn a_module_of_pl7_2_by_the_configuration() {
    let rung = "RUNG L1:\nOPEN_CONTACT(I0,05),H_LINK(8),SET_COIL(O0,03);\nEND_RUNG\n";
    let config = "[[entity]]\npath = 'press.txt'\naddress = 'PL7-2 MAST'";
    let folder = folder(&[("press.txt", rung), ("plclint.toml", config)]);
    let out = run(folder.path(), &["check", "--format", "concise"]).out;
    assert!(out.contains("W003"), "the program is complete: {out}");
}

#[test]
fn wrong_arguments_are_wrong_usage() {
    let folder = folder(&[]);
    let usage = |arguments: &[&str], what: &str| assert_usage(&run(folder.path(), arguments), what);
    usage(&["chek"], "unrecognized subcommand");
    usage(&["check", "--format", "xml"], "invalid value 'xml'");
    usage(&["check", "--dialect", "cobol"], "invalid value 'cobol'");
    usage(&["check", "--threads", "0"], "invalid value '0'");
    usage(&["check", "--severity", "all"], "RULE=LEVEL");
    usage(&["check", "--severity", "all=fatal"], "`fatal` is no severity");
    usage(&["check", "--quiet", "--verbose"], "cannot be used with");
    usage(&["check", "--config", "x", "--isolated"], "cannot be used with");
    usage(&["check", "--select", "no-such-rule"], "--select: no rule or group is called `no-such-rule`");
    usage(&["check", "--ignore", "all,no-such-rule"], "--ignore: no rule or group is called `no-such-rule`");
    usage(&["check", "--encoding", "ebcdic"], "--encoding: unknown encoding `ebcdic`");
    usage(&["check", "nowhere.awl"], "nowhere.awl: there is no such file or folder");
    usage(&["check", "-", "a.awl"], "standard input (`-`) is read alone");
    usage(&["check", "--stdin-filename", "a.awl"], "give `-` as the path");
    usage(&["check", "--config", "nowhere.toml"], "nowhere.toml: the configuration cannot be read");
    usage(&["tree", "nowhere.awl"], "nowhere.awl: the file cannot be read");
}

#[test]
fn a_wrong_configuration_is_wrong_usage_with_its_place() {
    let folder = folder(&[
        ("plclint.toml", "[rules]\nignore = ['all', 'no-such-rule']\n"),
        ("sub/plclint.toml", "[rule]\n"),
        ("sub/a.awl", ""),
    ]);
    assert_usage(&run(folder.path(), &["check"]), "plclint.toml:2:18: no rule or group is called `no-such-rule`");
    assert_usage(&run(folder.path(), &["check", "sub/a.awl"]), "plclint.toml:1:2: unknown field `rule`");
    assert_eq!(run(folder.path(), &["check", "--isolated"]).code, Some(0));
}

#[test]
fn an_empty_folder_is_clean_and_the_last_line_says_so() {
    let folder = folder(&[]);
    let ran = run(folder.path(), &["check"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert!(ran.out.starts_with("0 files, 0 programs and blocks, 0 lines read in "), "{}", ran.out);
    assert!(ran.out.ends_with("; no findings\n"), "{}", ran.out);
    let quiet = run(folder.path(), &["check", "--quiet", "--statistics"]);
    assert_eq!((quiet.code, quiet.out.as_str(), quiet.err.as_str()), (Some(0), "", ""));
}

#[test]
fn documents_for_programs_are_alone_on_standard_output() {
    let folder = folder(&[]);
    for format in ["json", "sarif"] {
        let ran = run(folder.path(), &["check", "--format", format]);
        let document: serde_json::Value = serde_json::from_str(&ran.out).expect("one document");
        assert!(document.is_object());
        assert!(ran.err.starts_with("0 files"), "the last line goes to the other stream: {}", ran.err);
    }
}

#[test]
fn reports_go_to_files() {
    let folder = folder(&[]);
    let ran = run(folder.path(), &["check", "--output", "sarif=a.sarif", "-o", "json=b.json"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.contains("0 files"), "the main report stays where it was: {}", ran.out);
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(folder.path().join(name)).expect("the file is there")).expect("JSON")
    };
    assert_eq!(read("a.sarif")["version"], "2.1.0");
    assert_eq!(read("b.json")["version"], 1);
    let ran = run(folder.path(), &["check", "--format", "json", "--output", "c.json"]);
    assert_eq!(read("c.json")["tool"]["name"], "plclint");
    assert!(ran.out.starts_with("0 files") && ran.out.lines().count() == 1, "{}", ran.out);
    let ran = run(folder.path(), &["check", "--output", "no/such/folder/a.txt"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("the report cannot be written"), "{}", ran.err);
}

#[test]
fn the_list_of_rules_is_the_registry() {
    let folder = folder(&[]);
    let ran = run(folder.path(), &["rules", "--format", "json"]);
    let listed: Vec<serde_json::Value> = serde_json::from_str(&ran.out).expect("an array");
    let codes: Vec<&str> = listed.iter().filter_map(|it| it["code"].as_str()).collect();
    let registry: Vec<&str> = plclint::lint::rules().iter().map(|it| it.code).collect();
    assert_eq!(codes, registry);
    assert_eq!(run(folder.path(), &["rules"]).out.lines().count(), registry.len());
    assert!(run(folder.path(), &["rules", "--format", "markdown"]).out.starts_with("# Rules\n"));
}

#[test]
fn a_rule_is_explained_by_code_and_by_name() {
    let folder = folder(&[]);
    for rule in plclint::lint::rules() {
        let ran = run(folder.path(), &["rule", &rule.code.to_lowercase()]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.starts_with(&format!("{} {}\n", rule.code, rule.name)), "{}", ran.out);
        assert!(ran.out.contains("What to do instead"), "{}", ran.out);
        assert_eq!(run(folder.path(), &["rule", rule.name]).out, ran.out);
    }
    assert_usage(&run(folder.path(), &["rule", "no-such-rule"]), "no rule is called `no-such-rule`");
}

#[test]
fn colour_is_for_terminals_and_for_those_who_ask() {
    let folder = folder(&[]);
    if let Some(rule) = plclint::lint::rules().first() {
        assert!(!run(folder.path(), &["rule", rule.code]).out.contains('\u{1b}'));
        assert!(run(folder.path(), &["rule", rule.code, "--color", "always"]).out.contains('\u{1b}'));
    }
    assert!(!run(folder.path(), &["check", "--color", "never"]).out.contains('\u{1b}'));
}

#[test]
fn completions_are_written_for_every_shell() {
    let folder = folder(&[]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = run(folder.path(), &["completions", shell]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.contains("extend-select"), "{shell}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = folder(&[]);
    let mut child = command(folder.path())
        .args(["completions", "zsh"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let ran = Ran::from(child.wait_with_output().expect("the program ends"));
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
}

#[test]
fn standard_input_is_read() {
    let folder = folder(&[]);
    let mut child = command(folder.path())
        .args(["check", "-", "--stdin-filename", "a.awl", "--dialect", "step7"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin.write_all(b"      U     E 0.0\n      =     A 4.0\n").expect("the program reads");
    drop(stdin);
    let ran = Ran::from(child.wait_with_output().expect("the program ends"));
    assert_eq!(ran.err, "");
    assert!(ran.code.is_some_and(|it| it <= 1), "{:?}", ran.code);
}

#[test]
fn the_syntax_tree_holds_the_whole_text() {
    let folder = folder(&[("a.awl", "FUNCTION FC 1 : VOID\nBEGIN\n      U     E 0.0;\nEND_FUNCTION\n")]);
    let ran = run(folder.path(), &["tree", "a.awl"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.starts_with("FC1 @0..59: Awl("), "{}", ran.out);
}

const CHART: &str = "GR7 : MAST - Cycle - CHART - PAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) : END_STEP\n\
                     TRANSITION (LD) AT (C 0,L 2) :\nRUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),HASH_COIL;\nEND_RUNG\nEND_TRANSITION\n\
                     DEST_CONNECTOR 0 AT (C 0,L 3)\n";
const MACRO: &str = "GR7 : MAST - Cycle - MACRO1 - PAGE 0\nIN_STEP AT (C 0,L 1) : END_STEP\n\
                     TRANSITION (ST) AT (C 0,L 2) : (*PHRASE*) %M1 (*END_PHRASE*) END_TRANSITION\nOUT_STEP AT (C 0,L 3) : END_STEP\n";

#[test]
fn one_drawing_goes_to_standard_output_or_into_a_file() {
    let chart = CHART.replace(
        "(LD) AT (C 0,L 2) :\nRUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),HASH_COIL;\nEND_RUNG",
        "(ST) AT (C 0,L 2) :\n(*PHRASE*) %I1.0 (*END_PHRASE*)",
    );
    let folder = folder(&[("a.txt", &chart)]);
    let ran = run(folder.path(), &["draw", "a.txt"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "findings do not matter");
    assert!(ran.out.starts_with("<?xml") && ran.out.ends_with("</svg>\n"), "{}", ran.out);
    assert!(ran.out.contains("prefers-color-scheme"));
    let dark = run(folder.path(), &["draw", "a.txt", "--theme", "dark", "-o", "sub.svg"]);
    assert_eq!((dark.code, dark.out.as_str()), (Some(0), ""), "{}", dark.err);
    let dark = fs::read_to_string(folder.path().join("sub.svg")).expect("the file is there");
    assert!(!dark.contains("prefers-color-scheme") && dark != ran.out);
    let mut child = command(folder.path());
    child.args(["draw", "-", "--stdin-filename", "a.txt", "--format", "dot"]);
    let mut child = child.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the program starts");
    child.stdin.take().expect("standard input").write_all(chart.as_bytes()).expect("it reads");
    let ran: Ran = child.wait_with_output().expect("it ends").into();
    assert!(ran.code == Some(0) && ran.out.starts_with("digraph "), "{}", ran.out);
    let ran = run(folder.path(), &["draw", "a.txt", "--format", "mermaid"]);
    assert!(ran.out.contains("\nflowchart TB\n"), "{}", ran.out);
}

#[test]
fn several_drawings_go_into_a_folder() {
    let folder = folder(&[("a.txt", &format!("{CHART}{MACRO}"))]);
    assert_usage(
        &run(folder.path(), &["draw", "."]),
        "there are 3 drawings: `MAST - Cycle - CHART`, `MAST - Cycle - MACRO1`",
    );
    assert_usage(&run(folder.path(), &["draw", ".", "-o", "a.svg"]), "they do not go into a.svg");
    let ran = run(folder.path(), &["draw", ".", "-o", "out/pictures"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    let names: Vec<&str> = ran.out.lines().filter_map(|it| it.split(": ").next()).collect();
    let names: Vec<String> = names.iter().map(|it| it.replace('\\', "/")).collect();
    let file = |name: &str| format!("out/pictures/{name}.svg");
    let expected = ["chart-MAST-Cycle-CHART", "chart-MAST-Cycle-MACRO1", "ladder-MAST-Cycle-CHART-PAGE-0"].map(file);
    assert_eq!(names, expected);
    assert!(expected.iter().all(|it| folder.path().join(it).is_file()));
    let again = run(folder.path(), &["draw", ".", "--only", "charts", "--unit", "macro1"]);
    assert_eq!(again.out, fs::read_to_string(folder.path().join(&expected[1])).expect("the file is there"));
    let ran = run(folder.path(), &["draw", "a.txt", "--format", "dot", "-o", "dots/"]);
    assert_eq!(ran.out.lines().count(), 2, "{}", ran.out);
    assert!(ran.err.contains("1 drawings of rungs are left out: dot cannot show them"), "{}", ran.err);
}

#[test]
fn what_cannot_be_drawn_is_wrong_usage() {
    let folder = folder(&[("a.txt", CHART), ("b/b.txt", "ST : MAST - SR1\n! %M1 := %M2;\n"), ("c/c.md", "Nothing.\n")]);
    let usage = |arguments: &[&str], what: &str| assert_usage(&run(folder.path(), arguments), what);
    usage(&["draw"], "required arguments were not provided");
    usage(&["draw", "nowhere"], "nowhere: there is no such file or folder");
    usage(&["draw", "b"], "b: nothing to draw: there is no chart, no sequence, no rung and no call in it");
    usage(&["draw", "c"], "c: nothing to draw: no PLC program is recognised in it");
    usage(&["draw", "a.txt", "--only", "calls"], "a.txt: nothing to draw: there is no call in it");
    usage(&["draw", "a.txt", "--unit", "SR7"], "no drawing has `SR7` in its title; there are: `MAST - Cycle - CHART`");
    usage(&["draw", "a.txt", "--only", "ladder", "--format", "dot"], "dot cannot show them, use --format svg");
    usage(&["draw", "a.txt", "--format", "png"], "invalid value 'png'");
    usage(&["draw", "a.txt", "--only", "charts", "-o", "no/such/a.svg"], "the drawing cannot be written");
    let help = run(folder.path(), &["draw", "--help"]);
    assert!(help.out.contains("Exit codes: 0 drawn, 2 nothing to draw"), "{}", help.out);
}

/// The pictures of the documentation are what the commands that it names draw.
#[test]
fn pictures_of_the_documentation_are_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/drawings.md")).expect("the page");
    let commands: Vec<&str> = text.lines().filter_map(|it| it.trim().strip_prefix("plclint ")).collect();
    let mut count = 0;
    for line in commands.iter().filter(|it| it.contains("-o docs/")) {
        let (arguments, file) = line.split_once(" -o ").expect("a file");
        let ran = run(root, &arguments.split(' ').collect::<Vec<_>>());
        let picture = fs::read_to_string(root.join(file)).expect("the picture").replace("\r\n", "\n");
        assert_eq!(ran.code, Some(0), "{line}: {}", ran.err);
        assert!(ran.out == picture, "run `plclint {line}` again");
        count += 1;
    }
    assert_eq!(count, 3);
}

/// A value of the configuration is found in its file, by every format; files and lines of programs are counted without it.
#[test]
fn findings_stand_in_the_configuration() {
    let config = "[target]\ncontroller = 'TSX 57-353'\n[[task]]\nname = 'MAST'\nperiod = '300ms'\nwatchdog = '700ms'\n";
    let code = "(* heat *)\nST : MAST - MAIN\n! %M1 := %I1.0;\n! %Q2.0 := %M1;\n";
    let files = [("a.st", code), ("plclint.toml", config), ("z/b.st", code), ("z/plclint.toml", config)];
    let folder = folder(&files);
    let arguments = |format| ["check", "--select", "P006", "--format", format, "a.st"];
    let concise = run(folder.path(), &arguments("concise"));
    assert_eq!(concise.code, Some(1));
    let lines: Vec<&str> = concise.out.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "plclint.toml:5:10: P006[task-period] error: the period of MAST is 300 ms, and may be 1 to 255 ms \
             [configuration]",
            "plclint.toml:6:12: P006[task-period] error: the watchdog of MAST is 700 ms, and may be 500 ms at most \
             [configuration]",
        ]
    );
    assert!(lines[2].starts_with("1 file, 1 program or block, 4 lines read"), "{}", concise.out);
    let human = run(folder.path(), &arguments("human")).out;
    for part in ["plclint.toml:5:10", "period = '300ms'", "a.st:2:1", "the task"] {
        assert!(human.contains(part), "{part}: {human}");
    }
    let json: serde_json::Value = serde_json::from_str(&run(folder.path(), &arguments("json")).out).expect("JSON");
    let finding = &json["findings"][0];
    assert_eq!((finding["path"].as_str(), finding["start"]["line"].as_u64()), (Some("plclint.toml"), Some(5)));
    assert_eq!((finding["end"]["column"].as_u64(), finding["related"][0]["path"].as_str()), (Some(17), Some("a.st")));
    assert_eq!(
        (json["files"][1]["dialect"].as_str(), json["summary"]["files"].as_u64()),
        (Some("configuration"), Some(1))
    );
    let sarif: serde_json::Value = serde_json::from_str(&run(folder.path(), &arguments("sarif")).out).expect("JSON");
    let place = &sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "plclint.toml");
    assert_eq!(place["region"]["startLine"], 5);

    // Each configuration of a run has its own findings, between those of the files in the order of paths.
    let both = run(folder.path(), &["check", "--select", "P006", "--format", "concise", "a.st", "z"]).out;
    let places: Vec<&str> = both.lines().filter_map(|it| it.split_once(": P006").map(|it| it.0)).collect();
    assert_eq!(places, ["plclint.toml:5:10", "plclint.toml:6:12", "z/plclint.toml:5:10", "z/plclint.toml:6:12"]);
    // What nobody has wrong is no file of the report.
    let clean: serde_json::Value =
        serde_json::from_str(&run(folder.path(), &["check", "--select", "W001", "--format", "json", "a.st"]).out)
            .expect("JSON");
    assert_eq!(clean["files"].as_array().map(Vec::len), Some(1));
}

/// What a file that is not read does is not known, so that no absence is reported beside it.
#[test]
fn unread_code_makes_a_program_incomplete() {
    let main =
        "ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n      U     M 50.0\n      =     A 4.0\nEND_ORGANIZATION_BLOCK\n";
    let scl = "FUNCTION FC 7 : VOID\nBEGIN\nIF \"x\" THEN\n M50.0 := TRUE;\nEND_IF;\nFOR i := 1 TO 3 DO\n y := i;\nEND_FOR;\nEND_FUNCTION\n";
    let files = |second: &str| folder(&[("p/a.awl", main), (second, scl)]);
    let found =
        |second: &str| run(files(second).path(), &["check", "--select", "O007", "--format", "concise", "."]).out;
    assert!(!found("p/b.scl").contains("O007["), "{}", found("p/b.scl"));
    assert!(found("q/b.scl").contains("O007["), "{}", found("q/b.scl"));
}

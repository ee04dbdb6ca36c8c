//! SARIF as other programs read it. Its validity against the schema and the rules of code scanning is checked by
//! `.ci/run`, with validators that are not written in Rust.

use std::fs;
use std::process::{Command, Stdio};

use serde_json::Value;
use serde_sarif::sarif::Sarif;
use tempfile::TempDir;

const PROGRAM: &str = "FUNCTION FC 1 : VOID\nBEGIN\n      U     E 0.0; // Größe\n      =     A 4.0;\n      \
                       U     E 0.1;\n      =     A 4.0;\nEND_FUNCTION\n";

fn check(folder: &TempDir) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_plclint"))
        .current_dir(folder.path())
        .args(["check", "--format", "sarif", "--select", "all", "."])
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    String::from_utf8(output.stdout).expect("SARIF is UTF-8")
}

fn project() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    fs::write(folder.path().join("a b.awl"), PROGRAM).expect("a file");
    folder
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn the_log_is_read_back() {
    let text = check(&project());
    let log: Sarif = serde_json::from_str(&text).expect("the log follows the types of the schema");
    assert_eq!(log.version, serde_json::json!("2.1.0"));
    assert_eq!(log.runs.len(), 1);
}

#[test]
fn the_driver_describes_every_rule_that_ran() {
    let log: Value = serde_json::from_str(&check(&project())).expect("JSON");
    let driver = &log["runs"][0]["tool"]["driver"];
    assert_eq!(driver["name"], "plclint");
    assert_eq!(driver["semanticVersion"], env!("CARGO_PKG_VERSION"));
    let described: Vec<&str> = array(&driver["rules"]).iter().filter_map(|it| it["id"].as_str()).collect();
    let registry: Vec<&str> = plclint::lint::rules().iter().map(|it| it.code).collect();
    assert_eq!(described, registry, "`--select all` runs them all");
    for rule in array(&driver["rules"]) {
        for key in ["shortDescription", "fullDescription", "help"] {
            let text = rule[key]["text"].as_str().unwrap_or_default();
            assert!(!text.trim().is_empty(), "{}: {key}", rule["id"]);
            assert!(key == "help" || text.chars().count() <= 1024, "{}: {key} is too long", rule["id"]);
        }
        assert!(rule["help"]["markdown"].as_str().is_some_and(|it| it.contains("## What it does")), "{}", rule["id"]);
    }
}

#[test]
fn the_same_program_gives_the_same_bytes() {
    let folder = project();
    assert_eq!(check(&folder), check(&folder));
}

#[test]
fn results_point_at_their_rule_and_file() {
    let log: Value = serde_json::from_str(&check(&project())).expect("JSON");
    let run = &log["runs"][0];
    let artifacts = array(&run["artifacts"]);
    assert_eq!(artifacts[0]["location"]["uri"], "a%20b.awl");
    assert_eq!(artifacts[0]["length"], PROGRAM.len());
    let results = array(&run["results"]);
    assert!(results.iter().any(|it| it["ruleId"] == "W001"), "{results:?}");
    for result in results {
        let at = |value: &Value| value.as_u64().and_then(|it| usize::try_from(it).ok()).expect("an index");
        let rule = &run["tool"]["driver"]["rules"][at(&result["ruleIndex"])];
        assert_eq!(rule["id"], result["ruleId"]);
        let place = &result["locations"][0]["physicalLocation"];
        assert!(at(&place["artifactLocation"]["index"]) < artifacts.len());
        let region = &place["region"];
        let start = (at(&region["startLine"]), at(&region["startColumn"]));
        let end = (at(&region["endLine"]), at(&region["endColumn"]));
        assert!(start >= (1, 1) && start <= end, "{region}");
        assert!(result["partialFingerprints"]["primaryLocationLineHash"].as_str().is_some_and(|it| it.contains(':')));
    }
}

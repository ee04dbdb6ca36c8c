//! What an edit runs again, and what it does not: proven with the database's own events.

use plclint::db::{self, Db as _, EventLog, Input, RootDatabase, SourceFile};
use plclint::lint::settings::Settings;
use plclint::source::detect::Dialect;

const BLOCKS: &str = "\
FUNCTION FC 1 : VOID
BEGIN
NETWORK
TITLE = first
      U     E 0.0
      =     A 4.0
END_FUNCTION

FUNCTION FC 2 : VOID
BEGIN
NETWORK
      U     E 0.1
      =     A 4.1
NETWORK
      U     E 0.2
      =     A 4.2
END_FUNCTION

ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
      CALL  FC 1
      CALL  FC 2
END_ORGANIZATION_BLOCK
";

const SENTENCES: &str = "\
ST : MAST - MAIN
! %Q2.0 := %I1.0;
! SR3;
ST : MAST - SR3
! (* counting *)
  INC %MW4;
! %MW5 := %MW4 + 1;
IL : MAST - SR4
!     LD    %I1.3
      ST    %Q2.3
";

const CHART: &str = "\
[SOURCE_UNIT]
NAME = 'Peinture_Chart' ADDRESS = MAST Chart PROG_LANGAGE = GR7
PROGRAM MAST 'Chart'
NB_PAGES = 8
PAGE 0
INITIAL_STEP 0 AT (C 0,L 1) :
ACTION (N1,ST) : (*PHRASE*) %Q2.0 := %I1.0; (*END_PHRASE*) END_ACTION
END_STEP
TRANSITION (ST) AT (C 0,L 2) : (*PHRASE*) %I1.1 (*END_PHRASE*) END_TRANSITION
DEST_CONNECTOR 1 AT (C 0,L 3)
END_PAGE
PAGE 1
SOURCE_CONNECTOR 0 AT (C 0,L 0)
(* fill *)
STEP 1 AT (C 0,L 1) :
END_STEP
END_PAGE
END_PROGRAM
[EOF]
";

const NETWORKS: &str = "\
LD : PL7-2 - MAST
RUNG L1:
(* pump *)
OPEN_CONTACT(I0,05),H_LINK(8),COIL(O0,03);
END_RUNG
LD : PL7-2 - FAST
RUNG L1:
OPEN_CONTACT(I0,24),H_LINK(8),COIL(O0,04);
END_RUNG
";

struct Setup {
    db: RootDatabase,
    events: EventLog,
    files: Vec<SourceFile>,
}

fn setup(inputs: &[(&str, &str, Dialect)]) -> Setup {
    let events = EventLog::default();
    let mut db = RootDatabase::new(Settings::default(), Some(events.clone()));
    let files = db.set_files(inputs.iter().map(|(path, text, dialect)| Input::from_text(path, text, *dialect)));
    let mut setup = Setup { db, events, files };
    setup.check();
    setup.executed();
    setup
}

impl Setup {
    /// Asks for the findings of every file, as an editor or a run does.
    fn check(&mut self) -> Vec<String> {
        let mut messages = Vec::new();
        for &file in &self.files {
            let findings = db::file_findings(&self.db, file);
            messages.extend(findings.iter().map(|it| format!("{} {}", it.finding.rule.code, it.finding.message)));
        }
        messages
    }

    fn edit(&mut self, file: usize, from: &str, to: &str) {
        let file = self.files[file];
        let text = file.text(&self.db).replacen(from, to, 1);
        assert_ne!(text, **file.text(&self.db), "the edit changes something");
        self.db.set_text(file, text);
    }

    /// Names of the queries that ran, without their arguments, sorted.
    fn executed(&mut self) -> Vec<String> {
        let executed = db::take_executed(&self.db, &self.events);
        let mut names: Vec<String> =
            executed.iter().map(|it| it.split('(').next().unwrap_or_default().to_owned()).collect();
        names.sort_unstable();
        names
    }

    fn count(executed: &[String], name: &str) -> usize {
        executed.iter().filter(|it| *it == name).count()
    }
}

#[test]
fn an_edit_in_one_network_runs_that_unit_alone() {
    let mut setup = setup(&[("plant.awl", BLOCKS, Dialect::Step7)]);
    setup.edit(0, "U     E 0.2", "U     E 0.7");
    setup.check();
    let executed = setup.executed();
    for query in ["analysis", "facts"] {
        assert_eq!(Setup::count(&executed, query), 1, "{query}: {executed:?}");
    }
    // The block reads another input: the program is looked at again, and nothing else.
    assert_eq!(Setup::count(&executed, "program_findings"), 1);
}

#[test]
fn an_edit_that_changes_no_access_stops_before_other_units() {
    let mut setup = setup(&[("plant.awl", BLOCKS, Dialect::Step7)]);
    setup.edit(0, "TITLE = first\n", "TITLE = first network\n// moved\n\n");
    setup.check();
    let executed = setup.executed();
    for query in ["analysis", "facts"] {
        assert_eq!(Setup::count(&executed, query), 1, "{query}: {executed:?}");
    }
    assert_eq!(Setup::count(&executed, "program_findings"), 0, "{executed:?}");
    assert_eq!(Setup::count(&executed, "program_units"), 0, "{executed:?}");
}

#[test]
fn an_edit_in_one_sentence_runs_that_entity_alone() {
    let mut setup = setup(&[("poste.txt", SENTENCES, Dialect::Pl7)]);
    setup.edit(0, "INC %MW4", "INC %MW4; INC %MW4");
    setup.check();
    let executed = setup.executed();
    for query in ["analysis", "facts"] {
        assert_eq!(Setup::count(&executed, query), 1, "{query}: {executed:?}");
    }
    setup.edit(0, "(* counting *)", "(* counting up *)");
    setup.check();
    let executed = setup.executed();
    assert_eq!(Setup::count(&executed, "analysis"), 1, "{executed:?}");
    assert_eq!(Setup::count(&executed, "program_findings"), 0, "{executed:?}");
}

#[test]
fn an_edit_in_a_page_runs_that_page_alone() {
    let mut setup = setup(&[("peinture.gr7", CHART, Dialect::Auto)]);
    let count = |messages: &[String], code: &str| messages.iter().filter(|it| it.starts_with(code)).count();
    assert_eq!(count(&setup.check(), "G005"), 0);
    setup.edit(0, "(* fill *)", "(* fill\nslowly *)");
    setup.check();
    let executed = setup.executed();
    assert_eq!(Setup::count(&executed, "analysis"), 1, "{executed:?}");
    assert_eq!(Setup::count(&executed, "program_findings"), 0, "{executed:?}");
    // A connector that comes from elsewhere is a matter of the whole chart.
    setup.edit(0, "SOURCE_CONNECTOR 0", "SOURCE_CONNECTOR 5");
    let messages = setup.check();
    let executed = setup.executed();
    assert_eq!(Setup::count(&executed, "analysis"), 1, "{executed:?}");
    assert_eq!(count(&messages, "G005"), 1, "{messages:?}");
    setup.edit(0, "DEST_CONNECTOR 1", "DEST_CONNECTOR 0");
    let messages = setup.check();
    assert_eq!(Setup::count(&setup.executed(), "analysis"), 1);
    assert_eq!(count(&messages, "G005"), 2, "{messages:?}");
}

#[test]
fn another_file_of_the_program_is_not_read_again() {
    let caller = "ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n CALL FC 1\n U E 5.0\n = A 9.0\nEND_ORGANIZATION_BLOCK\n";
    let called = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n U E 5.1\n = A 9.1\nEND_FUNCTION\n";
    let inputs = [("line/ob1.awl", caller, Dialect::Step7), ("line/fc1.awl", called, Dialect::Step7)];
    let mut setup = setup(&inputs);
    let count = |messages: &[String]| messages.iter().filter(|it| it.starts_with("W001")).count();
    assert_eq!(count(&setup.check()), 0);
    setup.executed();
    setup.edit(1, "= A 9.1", "= A 9.0");
    let messages = setup.check();
    let executed = setup.executed();
    for query in ["analysis", "facts"] {
        assert_eq!(Setup::count(&executed, query), 1, "{query}: {executed:?}");
    }
    // A new fact does reach the other file.
    assert_eq!(count(&messages), 1, "{messages:?}");
}

#[test]
fn the_same_text_is_no_edit() {
    let mut setup = setup(&[("plant.awl", BLOCKS, Dialect::Step7)]);
    let file = setup.files[0];
    setup.db.set_text(file, BLOCKS);
    setup.check();
    assert_eq!(setup.executed(), [""; 0]);
}

#[test]
fn what_an_edit_leaves_is_what_a_fresh_run_finds() {
    let mut setup = setup(&[("plant.awl", BLOCKS, Dialect::Step7)]);
    for (from, to) in [
        ("=     A 4.1", "=     A 4.0"),
        ("U     E 0.2", "FOO   E 0.2"),
        ("FUNCTION FC 2 : VOID", "FUNCTION FC 3 : VOID"),
        ("END_FUNCTION\n\nFUNCTION FC 3", "END_FUNCTION\n// between\nFUNCTION FC 3"),
        ("ORGANIZATION_BLOCK OB 1", "ORGANIZATION_BLOCK OB 35"),
    ] {
        setup.edit(0, from, to);
        let edited = setup.check();
        let text = setup.files[0].text(&setup.db).to_string();
        let mut fresh = RootDatabase::new(Settings::default(), None);
        let file = fresh.set_files([Input::from_text("plant.awl", &text, Dialect::Step7)])[0];
        let findings = db::file_findings(&fresh, file);
        let messages: Vec<String> =
            findings.iter().map(|it| format!("{} {}", it.finding.rule.code, it.finding.message)).collect();
        assert_eq!(edited, messages);
        assert_eq!(fresh.project().files(&fresh).len(), 1);
    }
}

const VARIABLES: &str = "[DATA_UNIT]\nVAR_GLOBAL\nPump AT %Q2.0 : EBOOL (*left*);\nEND_VAR\n[EOF]\n";
const USERS: &str = "ST : MAST - MAIN\n! Pump := %I1.0;\n! (* first *) SR1;\nST : MAST - SR1\n! %Q2.0 := %I1.1;\n";

#[test]
fn symbols_cross_files_without_their_places() {
    let mut setup = setup(&[("plant.scy", VARIABLES, Dialect::Auto), ("plant.st", USERS, Dialect::Auto)]);
    let clash = "W001 `Pump` (`%Q2.0`) is assigned in more than one place".to_owned();
    assert!(setup.check().contains(&clash));
    for (file, from, to) in [(1, "(* first *)", "(* the first *)"), (0, "(*left*)", "\n(*right*)")] {
        setup.edit(file, from, to);
        assert!(setup.check().contains(&clash));
        let executed = setup.executed();
        for query in ["program_findings", "symbol_table", "program_units", "programs"] {
            assert_eq!(Setup::count(&executed, query), 0, "{query}: {executed:?}");
        }
    }
    setup.edit(0, "%Q2.0", "%Q2.7");
    assert!(!setup.check().contains(&clash));
    let executed = setup.executed();
    assert_eq!(Setup::count(&executed, "program_findings"), 1, "{executed:?}");
    assert_eq!(Setup::count(&executed, "analysis"), 1, "the code is not looked at: {executed:?}");
}

/// What networks cost is a fact, and has no places: one that only moves, or whose comment has other letters, costs the same.
#[test]
fn costs_that_stay_wake_no_rule_of_the_program() {
    let mut it = setup(&[("prog.ld", NETWORKS, Dialect::Pl72)]);
    let woken = |it: &mut Setup| it.executed().iter().filter(|it| *it == "program_findings").count();
    for (from, to) in [("LD : PL7-2 - FAST\n", "LD : PL7-2 - FAST\n\n"), ("(* pump *)", "(* mill *)")] {
        it.edit(0, from, to);
        it.check();
        assert_eq!(woken(&mut it), 0, "{from}");
    }
    it.edit(0, "H_LINK(8),COIL(O0,04)", "SHORT_CIRCUIT,H_LINK(7),COIL(O0,04)");
    it.check();
    assert_eq!(woken(&mut it), 1);
}

//! What the grammar of charts makes of text: trees, errors, and the laws that hold for every text.

use proptest::prelude::*;

use super::ast::{
    ActionKind, ChartAction, ChartLink, ChartStep, CodeLanguage, Connector, ConnectorKind, LinkKind, Page, StepKind,
    Transition,
};
use crate::syntax::{AstNode, Parse, SyntaxKind, pl7};

fn parse(text: &str) -> Parse {
    let parse = pl7::parse_chart(text);
    assert_eq!(parse.syntax().text(), text, "no byte is lost");
    parse
}

fn errors(text: &str) -> Vec<String> {
    parse(text).errors().iter().map(|it| it.message.clone()).collect()
}

fn all<'t, N: AstNode<'t>>(parse: &'t Parse) -> Vec<N> {
    parse.syntax().descendants().filter_map(N::cast).collect()
}

/// The published example of the exchange form, with what it leaves out.
const PAGE: &str = "\
PROGRAM MAST 'Chart'
NB_PAGES = 8
PAGE 0
INITIAL_STEP 0 AT (C 4,L 3) :
ACTION (N1,ST) :
(*PHRASE*) %Q2.0 := %I1.0; (*END_PHRASE*)
(*PHRASE*) (*two*) INC %MW4; (*END_PHRASE*)
END_ACTION
ACTION (P0,IL) : (*PHRASE*) LD %I1.2 R %Q2.1 (*END_PHRASE*) END_ACTION
END_STEP
TRANSITION (*start*) (ST) AT (C 4,L 4) : (*PHRASE*) %I1.0 (*END_PHRASE*) END_TRANSITION
T_S_OR_LINK FROM (C 4,L 4) TO (C 4,L 3) := [H_LINK FROM (C 4,L 4) TO (C 5,L 4),
V_LINK FROM (C 5,L 4) TO (C 5,L 2)]
DEST_CONNECTOR 10 AT (C 1,L 13)
SOURCE_CONNECTOR 9 AT (C1,L0)
COMMENT (*Remplissage*) AT (C 6,L 3)
END_PAGE
END_PROGRAM
";

#[test]
fn a_page_is_read() {
    let parse = parse(PAGE);
    assert_eq!(parse.errors(), []);
    let pages = all::<Page>(&parse);
    assert_eq!(pages.iter().map(|it| it.number()).collect::<Vec<_>>(), [Some(0)]);
    let [step] = all::<ChartStep>(&parse)[..] else { panic!("one step") };
    assert_eq!((step.kind(), step.name().map(|it| it.text())), (Some(StepKind::Initial), Some("0".to_owned())));
    assert_eq!(step.cell().and_then(|it| it.place()), Some((4, 3)));
    let actions: Vec<_> =
        step.actions().map(|it| (it.kind(), it.language(), it.sentences().count(), it.name().is_some())).collect();
    assert_eq!(
        actions,
        [
            (Some(ActionKind::Continuous), Some(CodeLanguage::St), 2, false),
            (Some(ActionKind::Deactivation), Some(CodeLanguage::Il), 1, false)
        ]
    );
    let [transition] = all::<Transition>(&parse)[..] else { panic!("one transition") };
    assert_eq!(transition.cell().and_then(|it| it.place()), Some((4, 4)));
    assert_eq!((transition.language(), transition.sentences().count()), (Some(CodeLanguage::St), 1));
    let [link] = all::<ChartLink>(&parse)[..] else { panic!("one link") };
    assert_eq!(link.kind(), Some(LinkKind::OrConvergence));
    let places = |cells: Vec<super::ast::PageCell<'_>>| cells.iter().filter_map(|it| it.place()).collect::<Vec<_>>();
    assert_eq!((places(link.from().collect()), places(link.to().collect())), (vec![(4, 4)], vec![(4, 3)]));
    let segments: Vec<_> = link
        .segments()
        .map(|it| (it.is_horizontal(), it.from().and_then(|it| it.place()), it.to().and_then(|it| it.place())))
        .collect();
    assert_eq!(segments, [(true, Some((4, 4)), Some((5, 4))), (false, Some((5, 4)), Some((5, 2)))]);
    let connectors: Vec<_> = all::<Connector>(&parse)
        .iter()
        .map(|it| (it.kind(), it.name().map(|it| it.text()), it.cell().and_then(|it| it.place())))
        .collect();
    assert_eq!(
        connectors,
        [
            (Some(ConnectorKind::Destination), Some("10".to_owned()), Some((1, 13))),
            (Some(ConnectorKind::Origin), Some("9".to_owned()), Some((1, 0)))
        ]
    );
}

const TEXTUAL: &str = "\
INITIAL_STEP X0 : END_STEP
STEP X1 : Fill(N); %Q2.1(P1); Beep; END_STEP
TRANSITION FROM X0 TO X1 := %I1.0 AND NOT %M3; END_TRANSITION
TRANSITION t2 FROM (X1,X2) TO (X3,X4) := %MW1 = 5; END_TRANSITION
TRANSITION FROM X3 TO X0 : LD %I1.0 AND %I1.1 END_TRANSITION
ACTION Fill : %Q2.0 := TRUE; IF %M0 THEN %M1 := FALSE; END_IF; END_ACTION
ACTION Beep : LD %I1.0 ST %Q2.5 END_ACTION
";

#[test]
fn a_textual_chart_is_read() {
    let parse = parse(TEXTUAL);
    assert_eq!(parse.errors(), []);
    let steps = all::<ChartStep>(&parse);
    let associations: Vec<_> =
        steps[1].associations().map(|it| (it.target().map(|it| it.text().to_owned()), it.kind())).collect();
    assert_eq!(
        associations,
        [
            (Some("Fill".to_owned()), Some(ActionKind::Continuous)),
            (Some("%Q2.1".to_owned()), Some(ActionKind::Activation)),
            (Some("Beep".to_owned()), Some(ActionKind::Continuous)),
        ]
    );
    let transitions = all::<Transition>(&parse);
    let ends: Vec<_> = transitions[1]
        .ends()
        .map(|it| (it.is_source(), it.names().map(|it| it.text()).collect::<Vec<_>>().join(" ")))
        .collect();
    assert_eq!(ends, [(true, "X1 X2".to_owned()), (false, "X3 X4".to_owned())]);
    // In a receptivity `=` compares.
    assert!(transitions.iter().all(|it| it.sentences().count() == 1));
    assert!(!parse.syntax().descendants().any(|it| it.kind() == SyntaxKind::AssignStmt && it.text().contains('5')));
    let names: Vec<_> =
        all::<ChartAction>(&parse).iter().filter_map(|it| it.name()).map(|it| it.text().to_owned()).collect();
    assert_eq!(names, ["Fill", "Beep"]);
}

#[test]
fn an_unknown_word_is_one_error_and_the_rest_is_read() {
    let text = "PAGE 0\nMAGIC 3 AT (C 1,L 1) : x y z END_MAGIC\nMAGIC 4 AT (C 2,L 1)\nSTEP 1 AT (C 4,L 1) :\nEND_STEP\nEND_PAGE\n";
    assert_eq!(errors(text), ["`MAGIC` is no word of a chart that plclint knows"]);
    assert_eq!(all::<ChartStep>(&parse(text)).len(), 1);
}

#[test]
fn symbols_may_be_called_like_words_of_charts() {
    let text =
        "STEP 1 : ACTION (N1,ST) : Step := Action OR Page; Comment := Transition(%M0) AND Step; END_ACTION END_STEP";
    assert_eq!(errors(text), [""; 0]);
}

#[test]
fn what_is_not_closed_ends_where_the_next_element_starts() {
    for (text, expected) in [
        (
            "STEP 1 AT (C 0,L 1) :\nACTION (N1,ST) : %M0 := %M1;\nSTEP 2 AT (C 1,L 1) : END_STEP",
            vec!["expected `END_ACTION` after this", "expected `END_STEP` after this"],
        ),
        (
            "TRANSITION (ST) AT (C 0,L 2) : %M0\nSTEP 2 AT (C 1,L 1) : END_STEP",
            vec!["expected `END_TRANSITION` after this"],
        ),
        ("PAGE 0\nSTEP 2 AT (C 1,L 1) : END_STEP\n", vec!["expected `END_PAGE` after this"]),
        ("END_STEP", vec!["`END_STEP` belongs to nothing that is open"]),
        ("T_S_OR_LINK FROM (C 4,L 4) TO", vec!["expected a cell, such as `(C 4,L 3)` after this"]),
        ("MACRO_STEP 2 AT (C 0,L 1)\nIN_STEP AT (C 1,L 1)\nOUT_STEP AT (C 1,L 3) : END_STEP\n", vec![]),
    ] {
        assert_eq!(errors(text), expected, "{text}");
    }
}

#[test]
fn code_without_its_language_is_told_apart() {
    for (text, sentences, rungs) in [
        ("TRANSITION AT (C 0,L 2) : ! LD %M0 AND %M1 END_TRANSITION", 1, 0),
        ("TRANSITION AT (C 0,L 2) : %M0 AND %M1 END_TRANSITION", 1, 0),
        ("TRANSITION AT (C 0,L 2) : END_TRANSITION", 0, 0),
        ("TRANSITION (LD) AT (C 0,L 2) : END_TRANSITION", 0, 0),
        ("TRANSITION (LD) AT (C 0,L 2) : RUNG OPEN_CONTACT(%M0),H_LINK(9),HASH_COIL; END_RUNG END_TRANSITION", 0, 1),
        ("TRANSITION AT (C 0,L 2) : RUNG OPEN_CONTACT(%M0),H_LINK(9),HASH_COIL; END_RUNG END_TRANSITION", 0, 1),
    ] {
        let parse = parse(text);
        assert_eq!(parse.errors(), [], "{text}");
        let [transition] = all::<Transition>(&parse)[..] else { panic!("{text}") };
        assert_eq!((transition.sentences().count(), transition.rungs().count()), (sentences, rungs), "{text}");
    }
}

#[test]
fn depth_and_length_are_survived() {
    for text in [
        format!("TRANSITION (ST) : {}%M0 END_TRANSITION", "(".repeat(100_000)),
        format!("STEP 1 : ACTION (N1,ST) : {} END_ACTION END_STEP", "IF %M0 THEN ".repeat(50_000)),
        "STEP ".repeat(100_000),
        "ACTION (N1,ST) : ".repeat(50_000),
        "PAGE 0\n".repeat(50_000),
        "T_S_OR_LINK FROM (C 1,L 1) TO (C 1,L 1) := [".repeat(20_000),
        "H_LINK ".repeat(50_000),
        "TRANSITION FROM (".repeat(50_000),
        "FOO ".repeat(100_000),
        "END_FOO ".repeat(100_000),
        "(C 1,".repeat(50_000),
        "TRANSITION (ST) : (*PHRASE*) ".repeat(20_000),
    ] {
        parse(&text);
    }
}

/// Each mistake is said once, and what stands behind it is read.
#[test]
fn mistakes_around_places() {
    for (text, expected) in [
        ("TRANSITION (ST) AT (C 1,L 2) %M0 END_TRANSITION", "expected `:`, found `%M0`"),
        ("TRANSITION (SFC) AT (C 1,L 2) : %M0 END_TRANSITION", "expected `LD`, `IL` or `ST`, found `SFC`"),
        ("T_S_OR_LINK (C 1,L 2) TO (C 1,L 3)", "expected `FROM`, found `(`"),
        ("T_S_OR_LINK FROM (C 1,L 2) (C 1,L 3)", "expected `TO`, found `(`"),
        ("ACTION (N1,LD) : OPEN_CONTACT(%M0) END_ACTION", "expected `RUNG`, found `OPEN_CONTACT`"),
    ] {
        assert_eq!(errors(text), [expected], "{text}");
    }
    let parse = parse("TRANSITION (ST) AT (C 1,L 2) %M0 END_TRANSITION");
    assert!(all::<Transition>(&parse)[0].syntax().descendants().any(|it| it.kind() == SyntaxKind::ObjectRef));
}

const PIECES: &str = "\\PC{0,6}|[ \n]|STEP |INITIAL_STEP 0 |END_STEP|ACTION |\\(N1,ST\\) : |\\(P0,LD\\) :|END_ACTION|TRANSITION |FROM |TO |\
    AT \\(C 4,L 3\\)|\\(ST\\)|:=|:|;|,|END_TRANSITION|T_S_OR_LINK |\\[|\\]|H_LINK |PAGE 0\n|END_PAGE|DEST_CONNECTOR |COMMENT |\
    \\(\\*PHRASE\\*\\)|\\(\\*END_PHRASE\\*\\)|%M0|%Q2\\.0 := %I1\\.0;|LD %M0 |X1|3|NB_PAGES = 8|FOO |RUNG|END_RUNG|IF |\\(|\\)";

proptest! {
    #[test]
    fn no_text_is_lost(pieces in prop::collection::vec(PIECES, 0..40)) {
        let text = pieces.concat();
        let parse = pl7::parse_chart(&text);
        prop_assert_eq!(parse.syntax().text(), text.as_str());
        for error in parse.errors() {
            prop_assert!(text.get(std::ops::Range::<usize>::from(error.range)).is_some());
        }
    }

    /// Errors in one element leave the elements behind it whole.
    #[test]
    fn elements_are_found_again(pieces in prop::collection::vec("[ a-z0-9:;=%\\(\\),]{0,6}", 0..12)) {
        let text = format!("PAGE 0\nSTEP 1 AT (C 0,L 1) : {} \nTRANSITION (ST) AT (C 0,L 2) : END_TRANSITION\n", pieces.concat());
        let parse = pl7::parse_chart(&text);
        prop_assert_eq!(all::<Transition>(&parse).len(), 1);
    }
}

//! What holds for all drawings: shapes do not overlap, lines begin and end at their shapes and run through no other, the
//! text is well-formed, and the same program gives the same bytes.

use std::path::Path;

use proptest::prelude::*;
use rustc_hash::FxHashSet;

use super::route::{Metrics, Node, Routed, route};
use super::scene::{Point, Rect};
use super::{Drawing, Kind, Theme, layers};
use crate::db::{self, Input};
use crate::lint::Settings;
use crate::lint::settings::{Folders, Overrides};
use crate::source::detect::Dialect;

fn drawings_of(files: &[(&str, &str)]) -> Vec<Drawing> {
    let folders = Folders { root: "/".into(), current: "/".into() };
    let settings = Settings::without_file(folders, Overrides::default()).expect("settings");
    let inputs = files.iter().map(|(path, text)| Input::from_text(path, text, Dialect::Auto)).collect();
    db::open(inputs, Vec::new(), settings).drawings(true).into_iter().map(|it| it.drawing).collect()
}

fn only(files: &[(&str, &str)], kind: Kind) -> Drawing {
    let mut all: Vec<Drawing> = drawings_of(files).into_iter().filter(|it| it.kind() == kind).collect();
    assert_eq!(all.len(), 1, "{:?}", all.iter().map(Drawing::title).collect::<Vec<_>>());
    all.remove(0)
}

const METRICS: Metrics = Metrics { gap: 18, track: 12, lane: 12, gutter: 22, pitch: 60, overhang: 12 };

fn area(node: &Node, place: Point) -> Rect {
    Rect::new(place.x - node.left, place.y, node.left + node.right, node.height)
}

/// Overlap of two stretches, more than a point.
fn shared(a: (i32, i32), b: (i32, i32)) -> bool {
    a.0.min(a.1).max(b.0.min(b.1)) < a.0.max(a.1).min(b.0.max(b.1))
}

/// What must hold of every layout. Compares all with all: for small graphs.
fn check(nodes: &[Node], arcs: &[(u32, u32)], routed: &Routed) {
    let areas: Vec<Rect> = nodes.iter().zip(&routed.places).map(|(node, at)| area(node, *at)).collect();
    let overlap = |a: Rect, b: Rect| a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
    for (at, a) in areas.iter().enumerate() {
        assert!(a.x >= 0 && a.y >= 0 && a.right() <= routed.width && a.bottom() <= routed.height, "{a:?}");
        assert!(areas[at + 1..].iter().all(|b| !overlap(*a, *b)), "two nodes overlap");
    }
    assert_eq!(routed.lines.len(), arcs.len());
    // Every straight part of every line, with the nodes that it belongs to.
    let mut parts: Vec<(usize, usize, Point, Point)> = Vec::new();
    for (line, &(from, to)) in routed.lines.iter().zip(arcs) {
        assert_eq!((line.from, line.to), (from as usize, to as usize));
        let start = routed.places[line.from].moved(0, nodes[line.from].port);
        assert_eq!(line.points.first(), Some(&start), "a line begins at its node");
        assert_eq!(line.points.last(), Some(&routed.places[line.to]), "a line ends at its node");
        for pair in line.points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            assert!(a.x == b.x || a.y == b.y, "lines run along the axes");
            assert!(a.x.min(b.x) >= 0 && a.x.max(b.x) <= routed.width && a.y.max(b.y) <= routed.height);
            for (at, it) in areas.iter().enumerate().filter(|it| it.0 != line.from) {
                let inside = |it: &Rect| {
                    it.x < a.x.max(b.x)
                        && a.x.min(b.x) < it.right()
                        && it.y < a.y.max(b.y)
                        && a.y.min(b.y) < it.bottom()
                        || a.x == b.x && it.x < a.x && a.x < it.right() && shared((it.y, it.bottom()), (a.y, b.y))
                        || a.y == b.y && it.y < a.y && a.y < it.bottom() && shared((it.x, it.right()), (a.x, b.x))
                };
                assert!(!inside(it), "line {from}-{to} runs through node {at}");
            }
            parts.push((line.from, line.to, a, b));
        }
    }
    for (at, a) in parts.iter().enumerate() {
        for b in &parts[at + 1..] {
            let vertical = a.2.x == a.3.x && b.2.x == b.3.x && a.2.x == b.2.x && shared((a.2.y, a.3.y), (b.2.y, b.3.y));
            let level = a.2.y == a.3.y && b.2.y == b.3.y && a.2.y == b.2.y && shared((a.2.x, a.3.x), (b.2.x, b.3.x));
            let belong = a.0 == b.0 || a.1 == b.1;
            assert!(!(vertical || level) || belong, "lines {}-{} and {}-{} share a stretch", a.0, a.1, b.0, b.1);
        }
    }
    for bar in &routed.bars {
        let lines = routed.lines.iter().filter(|it| if bar.is_below { it.from } else { it.to } == bar.node);
        assert!(lines.clone().count() > 1);
        assert!(lines.clone().all(|it| it.points.iter().any(|it| it.y == bar.y && bar.from <= it.x && it.x <= bar.to)));
    }
}

fn sized(cells: impl IntoIterator<Item = (u32, u32)>, sizes: &[(i32, i32, i32)]) -> Vec<Node> {
    let sizes = sizes.iter().cycle();
    cells
        .into_iter()
        .zip(sizes)
        .map(|((column, row), &(left, right, height))| Node { column, row, left, right, height, port: height.min(40) })
        .collect()
}

fn arcs(count: u32, most: usize) -> impl Strategy<Value = Vec<(u32, u32)>> {
    let arc = (0..count, 0..count).prop_filter("an arc between two nodes", |it| it.0 != it.1);
    prop::collection::vec(arc, 0..most).prop_map(|all| {
        let mut seen = FxHashSet::default();
        all.into_iter().filter(|it| seen.insert(*it)).collect()
    })
}

fn sizes() -> impl Strategy<Value = Vec<(i32, i32, i32)>> {
    prop::collection::vec((4..60_i32, 4..300_i32, 8..120_i32), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Nodes in any cells, as a page of a chart may hold them.
    #[test]
    fn lines_on_any_grid(
        cells in prop::collection::hash_set((0..6_u32, 0..8_u32), 1..20),
        all in arcs(20, 30),
        sizes in sizes(),
    ) {
        let mut cells: Vec<(u32, u32)> = cells.into_iter().collect();
        cells.sort_unstable();
        let nodes = sized(cells, &sizes);
        let count = nodes.len() as u32;
        let all: Vec<(u32, u32)> = all.into_iter().filter(|it| it.0 < count && it.1 < count).collect();
        check(&nodes, &all, &route(&nodes, &all, &METRICS));
    }

    /// Any graph, put into cells.
    #[test]
    fn any_graph_is_laid_out(all in arcs(24, 50), sizes in sizes(), starts in prop::collection::vec(0..24_u32, 0..3)) {
        let floor: Vec<u32> = (0..24).map(|it| it % 2).collect();
        let layers = layers::assign(24, &all, &starts, &floor);
        let cells: FxHashSet<(u32, u32)> = layers.cells.iter().copied().collect();
        prop_assert_eq!(cells.len(), 24, "a cell of its own for each");
        for (arc, back) in all.iter().zip(&layers.back) {
            let (from, to) = (layers.cells[arc.0 as usize], layers.cells[arc.1 as usize]);
            prop_assert!(*back || from.1 < to.1, "what closes no cycle leads down");
        }
        let nodes = sized(layers.cells.iter().copied(), &sizes);
        check(&nodes, &all, &route(&nodes, &all, &METRICS));
    }

    /// Any text in the places of names and code.
    #[test]
    fn any_text_gives_documents(name in "[a-z<>&\"'\\]\\[;#%`|{}\\\\]{0,12}", code in "\\PC{0,40}", comment in "\\PC{0,40}") {
        let comment = comment.replace("*)", "");
        let text = format!(
            "INITIAL_STEP {name} : (*{comment}*)\nACTION (N1,ST) : {code}\nEND_ACTION\nEND_STEP\nSTEP b : END_STEP\n\
             TRANSITION FROM b TO ({name}, x) := {code};\nEND_TRANSITION\n"
        );
        let rung = format!("LD : MAST - SR1\nRUNG (*{comment}*)\nOPEN_CONTACT({name}),OPERATE {code} END_BLOCK;\nEND_RUNG\n");
        for it in drawings_of(&[("a.sfc", &text), ("b/b.ld", &rung)]) {
            assert_sound(&it);
        }
    }
}

/// A drawing is a document of XML in both colours, and the graph of one names the nodes that its arcs join.
fn assert_sound(it: &Drawing) {
    for theme in [Theme::Auto, Theme::Light, Theme::Dark] {
        let svg = it.svg(theme);
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{error}: {svg}"));
        let root = document.root_element();
        assert_eq!(root.tag_name().name(), "svg");
        assert_eq!(root.attribute("aria-label").map(str::is_empty), Some(false));
        assert_eq!(svg, it.svg(theme));
    }
    for text in it.dot().into_iter().chain(it.mermaid()) {
        assert!(text.ends_with('\n') && !text.contains('\0'));
        // Quotes pair up on every line, but for those that a backslash escapes.
        for line in text.lines() {
            let bare = line.replace("\\\\", "").replace("\\\"", "");
            assert_eq!(bare.matches('"').count() % 2, 0, "{line}");
        }
    }
}

/// Texts of a drawing.
fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("XML");
    let texts = document.descendants().filter(|it| it.has_tag_name("text"));
    texts.filter_map(|it| it.text().map(str::to_owned)).collect()
}

fn titles(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("XML");
    let titles = document.descendants().filter(|it| it.has_tag_name("title"));
    titles.filter_map(|it| it.text().map(str::to_owned)).collect()
}

/// A page with a divergence of each kind, a comment, connectors, a receptivity in ladder, and one that is missing.
const PAGE: &str = "\
GR7 : MAST - Cycle - CHART - PAGE 0
SOURCE_CONNECTOR 3 AT (C 0,L 0)
INITIAL_STEP 0 (*Repos*) AT (C 0,L 1) : END_STEP
TRANSITION (LD) AT (C 0,L 2) : RUNG
OPEN_CONTACT(%I1.0),CLOSED_CONTACT(%I1.1),H_LINK(8),HASH_COIL;
END_RUNG END_TRANSITION
TRANSITION (ST) AT (C 2,L 2) : END_TRANSITION
S_T_OR_LINK FROM (C 0,L 1) TO (C 2,L 2) := [H_LINK FROM (C 0,L 1) TO (C 2,L 1)]
STEP 1 AT (C 0,L 3) :
ACTION (P1,ST) : (*PHRASE*) SET %M20; (*END_PHRASE*) END_ACTION
ACTION (N1,LD) : RUNG
OPEN_CONTACT(%M20),H_LINK(9),COIL(%Q2.0);
END_RUNG END_ACTION
END_STEP
STEP 2 AT (C 2,L 3) : END_STEP
TRANSITION (ST) AT (C 0,L 4) : (*PHRASE*) %X1.T>20 AND %M20 (*END_PHRASE*) END_TRANSITION
S_T_AND_LINK FROM (C 2,L 3) TO (C 0,L 4)
MACRO_STEP 1 AT (C 0,L 5) : END_STEP
TRANSITION (ST) AT (C 0,L 6) : (*PHRASE*) TRUE (*END_PHRASE*) END_TRANSITION
DEST_CONNECTOR 3 AT (C 0,L 7)
COMMENT (*Page de départ*) AT (C 4,L 1)
";

const RUNGS: &str = "\
LD : MAST - SR1
RUNG (*Marche*) %L10:
OPEN_CONTACT(%I1.0),SHORT_CIRCUIT,CLOSED_CONTACT(%I1.1),P_CONTACT(%I1.2),COMPARE %MW6>0 END_BLOCK,H_LINK(4),COIL(%M2);
N_CONTACT(%M2),H_LINK(1),EMPTY_CELL(9);
END_RUNG
RUNG
OPEN_CONTACT(%M2),BLOCK(%TM5),H_LINK(7),SET_COIL(%M3);
END_RUNG
RUNG
OPEN_CONTACT(%M3),H_LINK(6),OPERATE %MW1:=%MW2+1 END_BLOCK;
OPEN_CONTACT(%M4),H_LINK(9),NOT_COIL(%M5);
OPEN_CONTACT(%M4),H_LINK(9),RESET_COIL(%M3);
OPEN_CONTACT(%M4),H_LINK(9),CALL_COIL(SR2);
OPEN_CONTACT(%M5),H_LINK(9),JUMP_COIL(%L10);
OPEN_CONTACT(%M6),H_LINK(9),RETURN_COIL();
OPEN_CONTACT(%M7),H_LINK(9),HALT_COIL();
END_RUNG
";

const BLOCKS: &str = "\
ORGANIZATION_BLOCK OB 1
BEGIN
      CALL FC 1;
      CALL FC 2;
      CALL SFC 64;
END_ORGANIZATION_BLOCK
FUNCTION FC 1 : VOID
BEGIN
      CALL FB 10, DB 1;
      CALL FB 10, DB 2;
END_FUNCTION
FUNCTION FC 2 : VOID
BEGIN
      CALL FC 1;
      CALL FC 2;
END_FUNCTION
FUNCTION_BLOCK FB 10
BEGIN
      NOP 0;
END_FUNCTION_BLOCK
";

#[test]
fn a_chart_is_drawn() {
    let it = only(&[("a.txt", PAGE)], Kind::Chart);
    assert_sound(&it);
    insta::assert_snapshot!("chart.svg", it.svg(Theme::Auto));
    insta::assert_snapshot!("chart.dot", it.dot().expect("a graph"));
    insta::assert_snapshot!("chart.mmd", it.mermaid().expect("a graph"));
}

#[test]
fn rungs_are_drawn() {
    let it = only(&[("a.txt", RUNGS)], Kind::Ladder);
    assert_sound(&it);
    assert_eq!((it.dot(), it.mermaid()), (None, None));
    insta::assert_snapshot!("ladder.svg", it.svg(Theme::Light));
    // The rungs of actions and receptivities are drawn too.
    let of_chart = only(&[("a.txt", PAGE)], Kind::Ladder).svg(Theme::Light);
    let texts = texts(&of_chart);
    for wanted in ["Receptivity 0→1", "Action of step 1", "#", "%Q2.0"] {
        assert!(texts.iter().any(|it| it == wanted), "{wanted}: {texts:?}");
    }
}

#[test]
fn calls_are_drawn() {
    let it = only(&[("a.awl", BLOCKS)], Kind::Calls);
    assert_sound(&it);
    insta::assert_snapshot!("calls.svg", it.svg(Theme::Dark));
    insta::assert_snapshot!("calls.dot", it.dot().expect("a graph"));
    insta::assert_snapshot!("calls.mmd", it.mermaid().expect("a graph"));
}

#[test]
fn what_calls_nothing_has_no_graph_of_calls() {
    assert_eq!(drawings_of(&[("a.txt", "IL : MAST - SR1\n! LD %M1\nST %M2\n")]), []);
    assert_eq!(drawings_of(&[]), []);
}

#[test]
fn findings_are_marked_where_they_are() {
    let it = only(&[("a.txt", PAGE)], Kind::Chart);
    let svg = it.svg(Theme::Light);
    let titles = titles(&svg);
    let transition = titles.iter().find(|it| it.starts_with("Transition 0→2")).expect("the transition");
    assert!(transition.contains("G008: "), "{transition}");
    assert!(texts(&svg).iter().any(|it| it == "G008"));
    let without = Settings::without_file(
        Folders { root: "/".into(), current: "/".into() },
        Overrides { ignore: vec!["all".to_owned()], ..Overrides::default() },
    );
    let input = Input::from_text("a.txt", PAGE, Dialect::Auto);
    let opened = db::open(vec![input.clone()], Vec::new(), without.expect("settings"));
    let quiet = opened.drawings(true).remove(0).drawing.svg(Theme::Light);
    assert!(!quiet.contains("G008"));
    let opened = db::open(
        vec![input],
        Vec::new(),
        Settings::without_file(Folders { root: "/".into(), current: "/".into() }, Overrides::default())
            .expect("settings"),
    );
    assert_eq!(opened.drawings(false).remove(0).drawing.svg(Theme::Light), quiet);
}

#[test]
fn pages_and_pieces_of_one_graph_are_one_drawing() {
    let other = "GR7 : MAST - Cycle - CHART - PAGE 1\nSOURCE_CONNECTOR M1 AT (C 0,L 0)\nSTEP 3 AT (C 0,L 1) : END_STEP\n\
                 TRANSITION (ST) AT (C 0,L 2) : END_TRANSITION\nDEST_CONNECTOR 0 AT (C 0,L 3)\n";
    let action = "ST : MAST - Cycle - CHART - PAGE 1 %X3 P0\n! RESET %M77;\n";
    let receptivity = "ST : MAST - Cycle - CHART - PAGE 1 %X(3) --> %X(0)\n! %M78\n";
    let expansion = "GR7 : MAST - Cycle - MACRO1 - PAGE 0\nIN_STEP AT (C 0,L 1) : END_STEP\n\
                     TRANSITION (ST) AT (C 0,L 2) : (*PHRASE*) %M3 (*END_PHRASE*) END_TRANSITION\nOUT_STEP AT (C 0,L 3) : END_STEP\n";
    let files = [PAGE, other, action, receptivity, expansion].concat();
    let charts: Vec<Drawing> =
        drawings_of(&[("a.txt", &files)]).into_iter().filter(|it| it.kind() == Kind::Chart).collect();
    assert_eq!(
        charts.iter().map(Drawing::title).collect::<Vec<_>>(),
        ["MAST - Cycle - CHART", "MAST - Cycle - MACRO1"]
    );
    let all = texts(&charts[0].svg(Theme::Light));
    for wanted in ["Page 0", "Page 1", "3 (page 1)", "0 (page 0)", "RESET %M77;", "%M78", "P0"] {
        assert!(all.iter().any(|it| it == wanted), "{wanted}: {all:?}");
    }
    let dot = charts[0].dot().expect("a graph");
    assert!(!dot.contains("plaintext"), "every connector has its step: {dot}");
}

/// A sequence that begins again: the way back is told at both ends.
#[test]
fn long_ways_back_are_references() {
    let chart = |steps: u32| {
        let mut text = String::from("INITIAL_STEP s0 : END_STEP\n");
        for it in 1..steps {
            text.push_str(&format!("STEP s{it} : END_STEP\n"));
        }
        for it in 0..steps {
            let next = (it + 1) % steps;
            text.push_str(&format!("TRANSITION FROM s{it} TO s{next} := %M{it};\nEND_TRANSITION\n"));
        }
        only(&[("a.sfc", &text)], Kind::Chart)
    };
    let long = titles(&chart(40).svg(Theme::Light));
    assert!(long.iter().any(|it| it == "To step s0"), "{long:?}");
    let short = titles(&chart(3).svg(Theme::Light));
    assert!(!short.iter().any(|it| it == "To step s0"), "{short:?}");
    let dot = chart(40).dot().expect("a graph");
    assert_eq!(dot.matches(" -> ").count(), 80, "the graph has it as an arc");
}

#[test]
fn large_charts_keep_their_shapes_apart() {
    // 1000 steps: sequences of 20 between divergences of 3.
    let mut arcs = Vec::new();
    let mut count = 1_u32;
    let mut last = 0;
    while count < 2000 {
        let join = count + 3 * 41;
        for branch in 0..3 {
            let first = count + branch * 41;
            arcs.push((last, first));
            arcs.extend((first..first + 40).map(|it| (it, it + 1)));
            arcs.push((first + 40, join));
        }
        (last, count) = (join, join + 1);
    }
    arcs.push((last, 0));
    let layers = layers::assign(count as usize, &arcs, &[0], &vec![0; count as usize]);
    assert!(layers.cells.iter().all(|it| it.0 < 3), "three branches take three columns");
    let nodes = sized(layers.cells.iter().copied(), &[(20, 60, 40)]);
    let routed = route(&nodes, &arcs, &METRICS);
    assert_eq!(routed.lines.iter().filter(|it| it.is_back).count(), 1);
    let mut places = routed.places.clone();
    places.sort_unstable_by_key(|it| (it.y, it.x));
    assert!(places.windows(2).all(|it| it[0].y + 40 <= it[1].y || it[0].y == it[1].y && it[0].x + 80 <= it[1].x));
}

#[test]
fn branches_stand_side_by_side_under_what_they_leave() {
    // 0 parts into 1, 2, 3, which meet at 4; 2 goes on over 5; 6 follows.
    let arcs = [(0, 1), (0, 2), (0, 3), (1, 4), (2, 5), (5, 4), (3, 4), (4, 6)];
    let layers = layers::assign(7, &arcs, &[0], &[0; 7]);
    assert_eq!(layers.cells, [(0, 0), (0, 1), (1, 1), (2, 1), (0, 3), (1, 2), (0, 4)]);
    assert_eq!(layers.back, [false; 8]);
}

const SEQUENCE: &str = "\
ORGANIZATION_BLOCK OB 100
BEGIN
      S     M 0.0
END_ORGANIZATION_BLOCK
ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
      U     E 0.0
      =     M 9.0
NETWORK
      U     M 0.0
      U     M 9.0
      S     M 0.1
      R     M 0.0
NETWORK
      U     M 0.1
      UN    E 0.1
      S     M 0.0
      R     M 0.1
NETWORK
      O     M 0.0
      O(
      U     M 0.1
      U     E 0.2
      )
      =     A 4.0
END_ORGANIZATION_BLOCK
";

#[test]
fn a_sequence_coded_with_bits_is_drawn() {
    let symbols = "126,Attente                 M       0.0   BOOL      Pas de pi\u{e8}ce                    \n";
    let it = only(&[("a.awl", SEQUENCE), ("a.asc", symbols)], Kind::Chart);
    assert_sound(&it);
    assert_eq!(it.title(), "OB1 - M0.0");
    let svg = it.svg(Theme::Light);
    let all = texts(&svg);
    for wanted in ["M0.0", "M0.1", "M9.0", "NOT E0.1", "A4.0", "A4.0 when E0.2"] {
        assert!(all.iter().any(|it| it == wanted), "{wanted}: {all:?}");
    }
    assert!(svg.contains("Attente"), "{svg}");
    let dot = it.dot().expect("a graph");
    assert_eq!((dot.matches(" -> ").count(), dot.matches("peripheries=2").count()), (4, 1), "{dot}");
    assert!(it.mermaid().expect("a graph").contains("M9.0"));
}

#[test]
fn findings_are_marked_in_sequences() {
    // Both steps are left as soon as they are reached, for nothing else is asked.
    let skipped = SEQUENCE.replace("UN    E 0.1", "U     M 9.0");
    let it = only(&[("a.awl", &skipped)], Kind::Chart);
    let titles = titles(&it.svg(Theme::Light));
    assert!(titles.iter().any(|it| it.contains("Q001") || it.contains("Q002")), "{titles:?}");
}

/// Every program of the corpus.
#[test]
fn the_corpus_is_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut folders = vec![root];
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        let mut files = Vec::new();
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(bytes) = std::fs::read(&path) {
                files.push((path.display().to_string(), String::from_utf8_lossy(&bytes).into_owned()));
            }
        }
        files.sort();
        let files: Vec<(&str, &str)> = files.iter().map(|it| (it.0.as_str(), it.1.as_str())).collect();
        for it in drawings_of(&files) {
            assert_sound(&it);
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
}

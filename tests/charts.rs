//! One structure, drawn and written in every form that charts have: the same findings, none on a correct chart, and each
//! mistake found.

#[path = "common/structure.rs"]
mod structure;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;
use structure::{Block, block};

use plclint::db::{self, Input};
use plclint::lint::Severity;
use plclint::lint::settings::{FILE_NAME, Folders, Overrides, Settings};
use plclint::source::detect::Dialect;
use proptest::prelude::*;

type Cell = (u32, u32);

/// Bits, each with the value that is asked of it. Nothing at all: not programmed.
type Asked = Vec<(u32, bool)>;

#[derive(Debug, Clone)]
struct Transition {
    from: Vec<usize>,
    to: Vec<usize>,
    asked: Asked,
    cell: Cell,
}

#[derive(Debug, Clone, Default)]
struct Chart {
    /// Cells of the steps, which are numbered in this order.
    steps: Vec<Cell>,
    initial: Option<usize>,
    transitions: Vec<Transition>,
    /// Last step of the cycle.
    last: usize,
    bits: u32,
    wrong: Option<Wrong>,
    /// What is wrong was done.
    done: bool,
}

/// A mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wrong {
    NoInitialStep,
    /// The n-th receptivity, of as many as there are.
    NotProgrammed(usize),
    NeverTrue(usize),
    /// The first alternatives.
    NotExclusive,
    /// The first parallel branches end as alternatives do.
    NotWaitedFor,
    /// The first alternatives end as parallel branches do.
    WaitedFor,
    /// A step that nothing leads to.
    LeftOver,
}

impl Chart {
    fn new(block: &Block, wrong: Option<Wrong>) -> Self {
        let mut chart = Self { wrong, initial: Some(0), ..Self::default() };
        let (first, last, width) = chart.write(block, (0, 1));
        assert_eq!(first, 0);
        chart.last = last;
        let (column, line) = chart.steps[last];
        chart.transition(&[last], &[0], (column, line + 1));
        match wrong {
            Some(Wrong::NoInitialStep) => chart.initial = None,
            Some(Wrong::NotProgrammed(at)) => {
                let count = chart.transitions.len();
                chart.transitions[at % count].asked.clear();
            }
            Some(Wrong::NeverTrue(at)) => {
                let count = chart.transitions.len();
                let asked = &mut chart.transitions[at % count].asked;
                *asked = vec![asked[0], (asked[0].0, !asked[0].1)];
            }
            Some(Wrong::LeftOver) => {
                let step = chart.step((width, 1));
                chart.transition(&[step], &[0], (width, 2));
            }
            _ => return chart,
        }
        chart.done = true;
        chart
    }

    fn step(&mut self, cell: Cell) -> usize {
        self.steps.push(cell);
        self.steps.len() - 1
    }

    fn bit(&mut self) -> u32 {
        self.bits += 1;
        self.bits - 1
    }

    fn transition(&mut self, from: &[usize], to: &[usize], cell: Cell) {
        let bit = self.bit();
        self.transitions.push(Transition { from: from.to_vec(), to: to.to_vec(), asked: vec![(bit, true)], cell });
    }

    /// First and last step, which stand in the first column, and the number of columns.
    fn write(&mut self, block: &Block, at: Cell) -> (usize, usize, u32) {
        let (column, line) = at;
        match block {
            Block::Step => {
                let step = self.step(at);
                (step, step, 1)
            }
            Block::Sequence(blocks) => {
                let mut line = line;
                let (mut first, mut before, mut width) = (None, None, 1);
                for it in blocks {
                    let (start, end, columns) = self.write(it, (column, line));
                    width = width.max(columns);
                    if let Some(before) = before.replace(end) {
                        self.transition(&[before], &[start], (column, line - 1));
                    }
                    first.get_or_insert(start);
                    line = self.steps[end].1 + 2;
                }
                (first.unwrap_or_default(), before.unwrap_or_default(), width)
            }
            Block::Alternatives(blocks) | Block::Parallel(blocks) => {
                let is_parallel = matches!(block, Block::Parallel(_));
                let first = self.step(at);
                let mut branches = Vec::new();
                let mut next = column;
                for it in blocks {
                    let (start, end, columns) = self.write(it, (next, line + 2));
                    branches.push((start, end, next));
                    next += columns;
                }
                let deepest = branches.iter().map(|it| self.steps[it.1].1).max().unwrap_or(line);
                let last = self.step((column, deepest + 2));
                self.open(is_parallel, first, &branches, line + 1);
                self.close(is_parallel, last, &branches, deepest + 1);
                (first, last, next - column)
            }
        }
    }

    fn open(&mut self, is_parallel: bool, first: usize, branches: &[(usize, usize, u32)], line: u32) {
        let starts: Vec<usize> = branches.iter().map(|it| it.0).collect();
        if is_parallel {
            return self.transition(&[first], &starts, (branches[0].2, line));
        }
        let code = [self.bit(), self.bit()];
        let is_wrong = self.wrong == Some(Wrong::NotExclusive) && !std::mem::replace(&mut self.done, true);
        for (value, &(start, _, column)) in (1_u32..).zip(branches) {
            let mut asked: Asked = (0..).zip(code).map(|(at, bit)| (bit, value >> at & 1 == 1)).collect();
            if is_wrong && value == 2 {
                asked = vec![(self.bit(), true)];
            }
            self.transitions.push(Transition { from: vec![first], to: vec![start], asked, cell: (column, line) });
        }
    }

    fn close(&mut self, is_parallel: bool, last: usize, branches: &[(usize, usize, u32)], line: u32) {
        let wrong = if is_parallel { Wrong::NotWaitedFor } else { Wrong::WaitedFor };
        let is_wrong = self.wrong == Some(wrong) && !std::mem::replace(&mut self.done, true);
        let stops: Vec<usize> = branches.iter().map(|it| it.1).collect();
        if is_parallel != is_wrong {
            return self.transition(&stops, &[last], (branches[0].2, line));
        }
        for &(_, end, column) in branches {
            let below = self.steps[end].1 + 1;
            self.transition(&[end], &[last], (column, below));
        }
    }

    /// Whether a page has room for it, and the connectors before and behind it.
    fn fits(&self) -> bool {
        self.steps.iter().all(|it| it.0 < 8 && it.1 < 11) && self.bits < 100
    }

    fn is_initial(&self, step: usize) -> bool {
        self.initial == Some(step)
    }
}

/// A text, and where each element stands in it: steps, then transitions.
struct Text {
    path: &'static str,
    text: String,
    places: Vec<(String, Range<usize>)>,
}

impl Text {
    fn new(path: &'static str, heading: &str) -> Self {
        Self { path, text: heading.to_owned(), places: Vec::new() }
    }

    fn add(&mut self, name: String, text: &str) {
        let start = self.text.len();
        self.text.push_str(text);
        self.places.push((name, start..self.text.len()));
        self.text.push('\n');
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Words {
    Pl7,
    Pl72,
}

impl Words {
    fn bit(self, bit: u32) -> String {
        match self {
            Self::Pl7 => format!("%M{bit}"),
            Self::Pl72 => format!("B{bit}"),
        }
    }

    fn expression(self, asked: &Asked) -> String {
        let one = |it: &(u32, bool)| format!("{}{}", if it.1 { "" } else { "NOT " }, self.bit(it.0));
        asked.iter().map(one).collect::<Vec<_>>().join(" AND ")
    }

    /// The rung of a receptivity: with or without the coil that ends it.
    fn rung(self, asked: &Asked) -> String {
        if asked.is_empty() {
            return String::new();
        }
        let (cells, end) = if self == Self::Pl7 { (10, ",HASH_COIL") } else { (9, "") };
        let mut text = String::from("RUNG\n");
        for it in asked {
            let word = if it.1 { "OPEN_CONTACT" } else { "CLOSED_CONTACT" };
            let _ = write!(text, "{word}({}),", self.bit(it.0));
        }
        let _ = write!(text, "H_LINK({}){end};\nEND_RUNG\n", cells - asked.len());
        text
    }
}

fn transition_name(it: &Transition) -> String {
    format!("{:?} -> {:?} at {:?}", it.from, it.to, it.cell)
}

/// As text that names the steps before and behind each transition.
fn written(chart: &Chart, words: Words) -> Text {
    let mut text = Text::new(if words == Words::Pl7 { "a.sfc" } else { "b.sfc" }, "");
    for at in 0..chart.steps.len() {
        let word = if chart.is_initial(at) { "INITIAL_STEP" } else { "STEP" };
        text.add(format!("step {at}"), &format!("{word} X{at} : END_STEP"));
    }
    for it in &chart.transitions {
        let list = |all: &[usize]| format!("({})", all.iter().map(|it| format!("X{it}")).collect::<Vec<_>>().join(","));
        let asked = if it.asked.is_empty() { ": ".to_owned() } else { format!(":= {};", words.expression(&it.asked)) };
        let line = format!("TRANSITION FROM {} TO {} {asked} END_TRANSITION", list(&it.from), list(&it.to));
        text.add(transition_name(it), &line);
    }
    text
}

/// As a page, whose cells and links join steps and transitions.
fn drawn(chart: &Chart, words: Words, in_ladder: bool) -> Text {
    let heading =
        if words == Words::Pl7 { "GR7 : MAST - Essai - CHART\nPAGE 0\n" } else { "GR7 : PL7-2 - SEQ\nPAGE 0\n" };
    let mut text = Text::new(if words == Words::Pl7 { "a.gr7" } else { "b.gr7" }, heading);
    let _ = writeln!(text.text, "SOURCE_CONNECTOR {} AT (C 0,L 0)", chart.last);
    for (at, (column, line)) in chart.steps.iter().enumerate() {
        let word = if chart.is_initial(at) { "INITIAL_STEP" } else { "STEP" };
        text.add(format!("step {at}"), &format!("{word} {at} AT (C {column},L {line}) : END_STEP"));
    }
    for it in &chart.transitions {
        let (language, asked) = match in_ladder {
            true => ("LD", words.rung(&it.asked)),
            false => ("ST", words.expression(&it.asked)),
        };
        let line = format!("TRANSITION ({language}) AT (C {},L {}) : {asked} END_TRANSITION", it.cell.0, it.cell.1);
        text.add(transition_name(it), &line);
    }
    for it in &chart.transitions {
        let (cell, is_loop) = (it.cell, it.to == [0]);
        let link = |text: &mut Text, word: &str, from: Cell, to: Cell| {
            // Neighbours need no link.
            if (from.0, from.1 + 1) != to {
                let _ = writeln!(text.text, "{word} FROM (C {},L {}) TO (C {},L {})", from.0, from.1, to.0, to.1);
            }
        };
        let word = if it.from.len() > 1 { "S_T_AND_LINK" } else { "S_T_OR_LINK" };
        it.from.iter().for_each(|from| link(&mut text, word, chart.steps[*from], cell));
        if is_loop {
            let _ = writeln!(text.text, "DEST_CONNECTOR 0 AT (C {},L {})", cell.0, cell.1 + 1);
            if it.from != [chart.last] {
                let from = it.from[0];
                let _ = writeln!(text.text, "SOURCE_CONNECTOR {from} AT (C {},L 0)", cell.0);
                let _ = writeln!(text.text, "T_S_OR_LINK FROM (C {},L 0) TO (C 0,L 1)", cell.0);
            }
            continue;
        }
        let word = if it.to.len() > 1 { "T_S_AND_LINK" } else { "T_S_OR_LINK" };
        it.to.iter().for_each(|to| link(&mut text, word, cell, chart.steps[*to]));
    }
    text.text.push_str("END_PAGE\n");
    text
}

/// Every finding about charts, with the element that it is about: but for advice, which is about style.
fn findings(it: &Text) -> BTreeSet<(String, String)> {
    let overrides = Overrides { select: Some(vec!["grafcet".to_owned()]), ..Overrides::default() };
    let settings = Settings::parse("", Path::new(FILE_NAME), Folders::default(), overrides).expect("no configuration");
    let outcome = db::check(vec![Input::from_text(it.path, &it.text, Dialect::Auto)], settings);
    assert!(outcome.unread.is_empty() && outcome.files[0].not_understood == 0, "{}", it.text);
    let all = outcome.diagnostics.iter().filter(|it| it.finding.severity != Severity::Advice);
    let named = all.map(|finding| {
        let at = usize::from(finding.finding.place.range.start());
        let element = it.places.iter().find(|it| it.1.contains(&at)).map_or("the chart", |it| &it.0);
        (finding.finding.rule.code.to_owned(), element.to_owned())
    });
    named.collect()
}

fn forms(chart: &Chart) -> [Text; 5] {
    [
        written(chart, Words::Pl7),
        drawn(chart, Words::Pl7, false),
        drawn(chart, Words::Pl7, true),
        written(chart, Words::Pl72),
        drawn(chart, Words::Pl72, true),
    ]
}

fn wrong() -> impl Strategy<Value = Wrong> {
    prop_oneof![
        Just(Wrong::NoInitialStep),
        (0..100_usize).prop_map(Wrong::NotProgrammed),
        (0..100_usize).prop_map(Wrong::NeverTrue),
        Just(Wrong::NotExclusive),
        Just(Wrong::NotWaitedFor),
        Just(Wrong::WaitedFor),
        Just(Wrong::LeftOver),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_correct_chart_has_no_finding(block in block(3)) {
        let chart = Chart::new(&block, None);
        prop_assume!(chart.fits());
        for it in forms(&chart) {
            prop_assert_eq!(findings(&it), BTreeSet::new(), "{}", it.text);
        }
    }

    #[test]
    fn every_form_has_the_same_findings(block in block(3), wrong in wrong()) {
        let chart = Chart::new(&block, Some(wrong));
        prop_assume!(chart.fits() && chart.done);
        let texts = forms(&chart);
        let found = findings(&texts[0]);
        let codes: &[&str] = match wrong {
            Wrong::NoInitialStep => &["G007"],
            Wrong::NotProgrammed(_) => &["G008"],
            Wrong::NeverTrue(_) => &["G009"],
            Wrong::NotExclusive => &["G001"],
            // The first step behind them is activated while it is active, or the branches come together too early.
            Wrong::NotWaitedFor => &["G015", "G018"],
            Wrong::WaitedFor => &["G015", "G016", "G017"],
            Wrong::LeftOver => &["G016"],
        };
        prop_assert!(found.iter().any(|it| codes.contains(&it.0.as_str())), "{wrong:?} {found:?}\n{}", texts[0].text);
        for it in &texts[1..] {
            prop_assert_eq!(&findings(it), &found, "{}\n{}", texts[0].text, it.text);
        }
    }
}

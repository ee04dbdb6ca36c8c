//! Ladder and Grafcet: rungs and pages of programs that controllers can hold.

use std::fmt::Write as _;

use super::{DEVICES, Random, STATES};

/// What a program is written with: PL7's operands, or PL7-2's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Dialect {
    Pl7,
    Pl72,
}

impl Dialect {
    /// Columns of a rung.
    fn columns(self) -> usize {
        if self == Self::Pl7 { 11 } else { 10 }
    }

    fn input(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("%I{}.{}", number / 16 % 8 + 1, number % 16),
            Self::Pl72 => format!("I{},{:02}", number / 16 % 2, number % 16),
        }
    }

    fn any_input(self, random: &mut Random) -> String {
        self.input(random.below(128))
    }

    fn output(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("%Q{}.{}", number / 16 + 9, number % 16),
            Self::Pl72 => format!("O{},{:02}", number / 16, number % 16),
        }
    }

    /// How many there are.
    fn outputs(self) -> u64 {
        if self == Self::Pl7 { 96 } else { 32 }
    }

    fn bit(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("%M{}", number % 30_000),
            Self::Pl72 => format!("B{}", number % 256),
        }
    }

    /// An operation block.
    fn sum(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("OPERATE %MW{0}:=%MW{0}+1 END_BLOCK", number % 30_000),
            Self::Pl72 => format!("OPERATE W{0} + 1 -> W{0} END_BLOCK", number % 120),
        }
    }

    fn comparison(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("COMPARE %MW{}>100 END_BLOCK", number % 30_000),
            Self::Pl72 => format!("COMPARE W{} > 100 END_BLOCK", number % 120),
        }
    }
}

/// A line of a rung: its first cells, filled up to the last column.
fn line(dialect: Dialect, cells: &[String], end: &str, width: usize) -> String {
    let taken = cells.len() + width - 1;
    format!("{},H_LINK({}),{end}", cells.join(","), dialect.columns() - taken - 1)
}

/// What the rungs of a program have written so far.
#[derive(Default)]
struct Written {
    rungs: u64,
    outputs: u64,
    /// A bit, and a bit that nothing reads yet.
    bit: Option<String>,
    unread: Option<String>,
    /// The number of a word that is counted.
    word: Option<u64>,
}

impl Written {
    /// An output that nothing drives yet, as long as there is one.
    fn output(&mut self, dialect: Dialect) -> Option<String> {
        let output = (self.outputs < dialect.outputs()).then(|| dialect.output(self.outputs))?;
        self.outputs += 1;
        Some(output)
    }
}

/// A rung that drives a bit of its own, and reads one that another drives.
fn rung(text: &mut String, random: &mut Random, dialect: Dialect, written: &mut Written) {
    written.rungs += 1;
    let number = written.rungs;
    let kind = random.below(6);
    let (first, second, third) = (dialect.any_input(random), dialect.any_input(random), dialect.any_input(random));
    let (first, second) = (format!("OPEN_CONTACT({first})"), format!("CLOSED_CONTACT({second})"));
    let third = || format!("OPEN_CONTACT({})", written.unread.take().unwrap_or(third));
    let bit = match &written.bit {
        Some(other) if random.one_in(400) => other.clone(),
        _ => dialect.bit(number),
    };
    let word = written.word.filter(|_| kind == 4);
    let lines = match (kind, word) {
        (0, _) => vec![line(dialect, &[third(), second], &format!("COIL({bit})"), 1)],
        (1, _) => {
            let held = format!("OPEN_CONTACT({bit}),H_LINK,EMPTY_CELL({})", dialect.columns() - 2);
            let cells = [first, "SHORT_CIRCUIT".to_owned(), second, third()];
            vec![line(dialect, &cells, &format!("COIL({bit})"), 1), held]
        }
        (2, _) => vec![
            line(dialect, &[first, second], &format!("SET_COIL({bit})"), 1),
            line(dialect, &[third()], &format!("RESET_COIL({bit})"), 1),
        ],
        (3, _) | (4, None) => {
            let links = dialect.columns() - 5;
            written.word = Some(number);
            vec![format!("{},H_LINK({links}),{}", first.replace("OPEN_CONTACT", "P_CONTACT"), dialect.sum(number))]
        }
        (4, Some(word)) => {
            let links = dialect.columns() - 4;
            vec![format!("{},{},H_LINK({links}),COIL({bit})", dialect.comparison(word), third())]
        }
        _ => {
            let other = third();
            let driven = written.output(dialect).unwrap_or_else(|| bit.clone());
            vec![line(dialect, &[first, second, other], &format!("COIL({driven})"), 1)]
        }
    };
    let lines = lines.join(";\n");
    if lines.contains(&format!("({bit})")) {
        written.bit = Some(bit.clone());
        written.unread = Some(bit);
    }
    // Each network of PL7-2 has a label, and a short comment.
    match dialect {
        Dialect::Pl7 => write!(text, "RUNG (* {} {} *)", random.pick(DEVICES), random.pick(STATES)),
        Dialect::Pl72 => write!(text, "RUNG (* {} *) L{}:", random.pick(STATES), number % 999 + 1),
    }
    .expect("a string");
    writeln!(text, "\n{lines};\nEND_RUNG").expect("a string");
}

/// A program of PL7 in ladder.
pub fn ladder(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 4096);
    let mut written = Written::default();
    sections(&mut text, &mut random, &mut written, bytes);
    text
}

/// Ladder of PL7, until the text is that long.
fn sections(text: &mut String, random: &mut Random, written: &mut Written, bytes: usize) {
    let mut section = 0;
    while text.len() < bytes {
        section += 1;
        writeln!(text, "LD : MAST - Poste{section}").expect("a string");
        for _ in 0..20 + random.below(40) {
            rung(text, random, Dialect::Pl7, written);
        }
    }
}

/// A program of PL7: a chart with its preliminary and posterior processing, and some ladder.
pub fn grafcet(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 16_384);
    text.push_str("ST : MAST - Cycle - PRL\n! IF %S0 OR %S1 THEN SET %S21; END_IF;\n\nGR7 : MAST - Cycle - CHART\n");
    pages(&mut text, &mut random, Dialect::Pl7, 8);
    text.push_str("ST : MAST - Cycle - POST\n");
    let mut written = Written::default();
    for step in 1..80 {
        let (output, input) = (written.output(Dialect::Pl7), Dialect::Pl7.any_input(&mut random));
        let output = output.expect("more outputs than steps");
        writeln!(text, "! {output} := %X{step} AND NOT {input};").expect("a string");
    }
    sections(&mut text, &mut random, &mut written, bytes);
    text
}

/// A program of PL7-2: rungs, a chart, rungs. It fills the controller, and is as long as that makes it.
pub fn pl7_2(_: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(32_768);
    let mut written = Written::default();
    for (heading, rungs) in [("LD : PL7-2 - PRL", 20), ("GR7 : PL7-2 - SEQ", 0), ("LD : PL7-2 - POST", 80)] {
        writeln!(text, "{heading}").expect("a string");
        if rungs == 0 {
            pages(&mut text, &mut random, Dialect::Pl72, 8);
        }
        (0..rungs).for_each(|_| rung(&mut text, &mut random, Dialect::Pl72, &mut written));
    }
    text
}

/// A cycle over some pages: on each a divergence, of alternatives or of parallel branches.
fn pages(text: &mut String, random: &mut Random, dialect: Dialect, count: u64) {
    let steps = 10 * count;
    for page in 0..count {
        let first = 10 * page;
        let before = if page == 0 { steps - 1 } else { first - 1 };
        writeln!(text, "PAGE {page}\nSOURCE_CONNECTOR {before} AT (C 0,L 0)").expect("a string");
        let mut step = |text: &mut String, number: u64, column: u64, line: u64| {
            let word = if number == 0 { "INITIAL_STEP" } else { "STEP" };
            let comment = random.pick(STATES);
            let comment = if dialect == Dialect::Pl7 { format!("(*{comment}*) ") } else { String::new() };
            writeln!(text, "{word} {number} {comment}AT (C {column},L {line}) : END_STEP").expect("a string");
        };
        // Two columns of four steps, between one above and one below.
        step(text, first, 0, 1);
        (0..2).for_each(|column| (0..4).for_each(|at| step(text, first + 1 + 4 * column + at, column, 3 + 2 * at)));
        step(text, first + 9, 0, 11);
        let transition = |text: &mut String, column: u64, line: u64, contacts: &[(&str, &str)]| {
            let at = format!("AT (C {column},L {line})");
            match dialect {
                Dialect::Pl7 => {
                    let one = |it: &(&str, &str)| {
                        let not = if it.0 == "CLOSED_CONTACT" { "NOT " } else { "" };
                        format!("{not}{}", it.1)
                    };
                    let all: Vec<String> = contacts.iter().map(one).collect();
                    writeln!(text, "TRANSITION (ST) {at} :\n(*PHRASE*) {} (*END_PHRASE*)", all.join(" AND "))
                }
                Dialect::Pl72 => {
                    let all: Vec<String> = contacts.iter().map(|it| format!("{}({})", it.0, it.1)).collect();
                    let links = 9 - all.len();
                    writeln!(text, "TRANSITION (LD) {at} :\nRUNG\n{},H_LINK({links});\nEND_RUNG", all.join(","))
                }
            }
            .expect("a string");
            text.push_str("END_TRANSITION\n");
        };
        let is_parallel = page % 2 == 1;
        // Each transition waits for an input.
        let inputs: Vec<String> = (first..first + 9).map(|number| dialect.input(number)).collect();
        if is_parallel {
            transition(text, 0, 2, &[("OPEN_CONTACT", &inputs[0])]);
            text.push_str("T_S_AND_LINK FROM (C 0,L 2) TO (C 1,L 3)\n");
        } else {
            transition(text, 0, 2, &[("OPEN_CONTACT", &inputs[0])]);
            transition(text, 1, 2, &[("CLOSED_CONTACT", &inputs[0]), ("OPEN_CONTACT", &inputs[1])]);
            text.push_str("S_T_OR_LINK FROM (C 0,L 1) TO (C 1,L 2)\n");
        }
        for column in 0..2 {
            for at in 0..3 {
                transition(
                    text,
                    column,
                    4 + 2 * at,
                    &[("OPEN_CONTACT", &inputs[2 + usize::try_from(at).unwrap_or(0)])],
                );
            }
        }
        if is_parallel {
            transition(text, 0, 10, &[("OPEN_CONTACT", &inputs[6])]);
            text.push_str("S_T_AND_LINK FROM (C 1,L 9) TO (C 0,L 10)\n");
        } else {
            transition(text, 0, 10, &[("OPEN_CONTACT", &inputs[6])]);
            transition(text, 1, 10, &[("OPEN_CONTACT", &inputs[7])]);
            text.push_str("T_S_OR_LINK FROM (C 1,L 10) TO (C 0,L 11)\n");
        }
        transition(text, 0, 12, &[("OPEN_CONTACT", &inputs[8])]);
        writeln!(text, "DEST_CONNECTOR {} AT (C 0,L 13)\nEND_PAGE", (first + 10) % steps).expect("a string");
    }
}

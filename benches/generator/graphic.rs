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

    fn input(self, random: &mut Random) -> String {
        match self {
            Self::Pl7 => format!("%I{}.{}", random.below(8) + 1, random.below(16)),
            Self::Pl72 => format!("I{},{:02}", random.below(2), random.below(16)),
        }
    }

    fn output(self, number: u64) -> String {
        match self {
            Self::Pl7 => format!("%Q{}.{}", number / 16 + 9, number % 16),
            Self::Pl72 => format!("O{},{:02}", number / 16 % 2, number % 16),
        }
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

/// `number`: of the rung, which drives bits of its own.
fn rung(text: &mut String, random: &mut Random, dialect: Dialect, number: u64) {
    let (device, state) = (random.pick(DEVICES), random.pick(STATES));
    let mut open = |word: &str| format!("{word}({})", dialect.input(random));
    let (first, second, third) = (open("OPEN_CONTACT"), open("CLOSED_CONTACT"), open("OPEN_CONTACT"));
    let bit = dialect.bit(number);
    let lines = match random.below(6) {
        0 => vec![line(dialect, &[first, second], &format!("COIL({bit})"), 1)],
        1 => {
            let held = format!("OPEN_CONTACT({bit}),H_LINK,EMPTY_CELL({})", dialect.columns() - 2);
            let cells = [first, "SHORT_CIRCUIT".to_owned(), second, third];
            vec![line(dialect, &cells, &format!("COIL({bit})"), 1), held]
        }
        2 => vec![
            line(dialect, &[first, second], &format!("SET_COIL({bit})"), 1),
            line(dialect, &[third], &format!("RESET_COIL({bit})"), 1),
        ],
        3 => {
            let links = dialect.columns() - 5;
            vec![format!("{},H_LINK({links}),{}", first.replace("OPEN_CONTACT", "P_CONTACT"), dialect.sum(number))]
        }
        4 => {
            let links = dialect.columns() - 3;
            vec![format!("{},H_LINK({links}),COIL({bit})", dialect.comparison(number))]
        }
        _ => {
            let other = format!("OPEN_CONTACT({})", dialect.bit(number / 2));
            vec![line(dialect, &[first, other, third], &format!("COIL({})", dialect.output(number % 90)), 1)]
        }
    };
    // Each network of PL7-2 has a label.
    let label = if dialect == Dialect::Pl72 { format!(" L{}:", number % 999 + 1) } else { String::new() };
    writeln!(text, "RUNG (* {device} {state} *){label}\n{};\nEND_RUNG", lines.join(";\n")).expect("a string");
}

/// Sections of PL7 in ladder.
pub fn ladder(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 4096);
    let mut number = 0;
    let mut section = 0;
    while text.len() < bytes {
        section += 1;
        writeln!(text, "LD : MAST - Poste{section}").expect("a string");
        for _ in 0..20 + random.below(40) {
            number += 1;
            rung(&mut text, &mut random, Dialect::Pl7, number);
        }
    }
    text
}

/// Charts of PL7 with their preliminary and posterior processing.
pub fn grafcet(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 16_384);
    let mut section = 0;
    while text.len() < bytes {
        section += 1;
        writeln!(text, "ST : MAST - Cycle{section} - PRL\n! IF %S0 OR %S1 THEN SET %S21; END_IF;\n").expect("a string");
        writeln!(text, "GR7 : MAST - Cycle{section} - CHART").expect("a string");
        pages(&mut text, &mut random, Dialect::Pl7, 8);
        writeln!(text, "ST : MAST - Cycle{section} - POST").expect("a string");
        for step in 1..80 {
            let input = Dialect::Pl7.input(&mut random);
            writeln!(text, "! %Q{}.{} := %X{step} AND NOT {input};", 9 + step / 16, step % 16).expect("a string");
        }
    }
    text
}

/// Programs of PL7-2: rungs, a chart, rungs.
pub fn pl7_2(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 16_384);
    let mut number = 0;
    while text.len() < bytes {
        for (heading, rungs) in [("LD : PL7-2 - PRL", 20), ("GR7 : PL7-2 - SEQ", 0), ("LD : PL7-2 - POST", 80)] {
            writeln!(text, "{heading}").expect("a string");
            if rungs == 0 {
                pages(&mut text, &mut random, Dialect::Pl72, 8);
            }
            for _ in 0..rungs {
                number += 1;
                rung(&mut text, &mut random, Dialect::Pl72, number);
            }
        }
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
        let transition = |text: &mut String, column: u64, line: u64, contacts: &[(&str, u64)]| {
            let at = format!("AT (C {column},L {line})");
            match dialect {
                Dialect::Pl7 => {
                    let one = |it: &(&str, u64)| {
                        let not = if it.0 == "CLOSED_CONTACT" { "NOT " } else { "" };
                        format!("{not}{}", dialect.bit(it.1))
                    };
                    let all: Vec<String> = contacts.iter().map(one).collect();
                    writeln!(text, "TRANSITION (ST) {at} :\n(*PHRASE*) {} (*END_PHRASE*)", all.join(" AND "))
                }
                Dialect::Pl72 => {
                    let all: Vec<String> =
                        contacts.iter().map(|it| format!("{}({})", it.0, dialect.bit(it.1))).collect();
                    let links = 9 - all.len();
                    writeln!(text, "TRANSITION (LD) {at} :\nRUNG\n{},H_LINK({links});\nEND_RUNG", all.join(","))
                }
            }
            .expect("a string");
            text.push_str("END_TRANSITION\n");
        };
        let is_parallel = page % 2 == 1;
        let bit = |at: u64| first + at;
        if is_parallel {
            transition(text, 0, 2, &[("OPEN_CONTACT", bit(0))]);
            text.push_str("T_S_AND_LINK FROM (C 0,L 2) TO (C 1,L 3)\n");
        } else {
            transition(text, 0, 2, &[("OPEN_CONTACT", bit(0))]);
            transition(text, 1, 2, &[("CLOSED_CONTACT", bit(0)), ("OPEN_CONTACT", bit(1))]);
            text.push_str("S_T_OR_LINK FROM (C 0,L 1) TO (C 1,L 2)\n");
        }
        for column in 0..2 {
            for at in 0..3 {
                transition(text, column, 4 + 2 * at, &[("OPEN_CONTACT", bit(2 + at))]);
            }
        }
        if is_parallel {
            transition(text, 0, 10, &[("OPEN_CONTACT", bit(6))]);
            text.push_str("S_T_AND_LINK FROM (C 1,L 9) TO (C 0,L 10)\n");
        } else {
            transition(text, 0, 10, &[("OPEN_CONTACT", bit(6))]);
            transition(text, 1, 10, &[("OPEN_CONTACT", bit(7))]);
            text.push_str("T_S_OR_LINK FROM (C 1,L 10) TO (C 0,L 11)\n");
        }
        transition(text, 0, 12, &[("OPEN_CONTACT", bit(8))]);
        writeln!(text, "DEST_CONNECTOR {} AT (C 0,L 13)\nEND_PAGE", (first + 10) % steps).expect("a string");
    }
}

//! The machine of statement lists against one that executes the status bits: RLO, /FC, OR, BR, the nesting stack, the stack
//! of the master control relay and the accumulators, as the vendor's operation list says which instruction changes which.
//!
//! Programs made at random are lowered, and run. What was executed must have a path that holds, what was passed by one that
//! does not; what was written must be the value of the statement. A value that the lowering does not know passes; the tests
//! below say how many of those there may be.

use std::collections::HashMap;
use std::fmt::Write as _;

use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{Expr, ExprId};
use crate::model::unit::StatementKind;
use crate::syntax::{Language, Mnemonics};

/// A generator of numbers that need not be good, but the same in each run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap_or(0) % end
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    fn bit(&mut self) -> bool {
        self.below(2) == 1
    }
}

#[derive(Debug, Clone, PartialEq)]
struct Line {
    label: Option<String>,
    mnemonic: &'static str,
    operand: String,
}

/// What a program is made of.
struct Mix {
    checks: &'static [&'static str],
    others: &'static [&'static str],
    jumps: &'static [&'static str],
    most: usize,
}

const CHECKS: &[&str] = &["U", "UN", "O", "ON", "X", "XN"];
const BITS: &[&str] = &["M0.0", "M0.1", "M0.2", "M0.3", "M0.4"];
const WORDS: &[&str] = &["MW10", "MW12"];

fn program(numbers: &mut Numbers, mix: &Mix) -> Vec<Line> {
    let length = 2 + numbers.below(mix.most);
    let mut lines = Vec::new();
    let mut depth = 0_usize;
    let mut targets: Vec<usize> = Vec::new();
    while lines.len() < length {
        let mut line = |mnemonic: &'static str, operand: &str| {
            lines.push(Line { label: None, mnemonic, operand: operand.to_owned() });
            lines.len() - 1
        };
        match numbers.below(10) {
            0..=3 => {
                let bit = numbers.of(&["M0.0", "M0.1", "M0.2", "M0.3", "M0.4", "BIE"]);
                line(numbers.of(mix.checks), bit);
            }
            4 => {
                line(numbers.of(&["=", "=", "S", "R"]), numbers.of(BITS));
            }
            5 if !mix.jumps.is_empty() => {
                let jump = numbers.of(mix.jumps);
                let at = line(jump, "");
                if !jump.starts_with("BE") {
                    targets.push(at);
                }
            }
            5 | 6 if depth > 0 => {
                line(")", "");
                depth -= 1;
            }
            _ if mix.others.is_empty() => {}
            _ => match numbers.of(mix.others) {
                it if it.ends_with('(') && it != "MCR(" => {
                    if depth < 7 {
                        line(it, "");
                        depth += 1;
                    }
                }
                it @ ("FP" | "FN") => {
                    line(it, numbers.of(&["M1.0", "M1.1"]));
                }
                "L" => {
                    line("L", numbers.of(&["0", "1", "2", "MW10", "MW12"]));
                }
                "T" => {
                    line("T", numbers.of(WORDS));
                }
                "SPL" => {
                    for it in ["SPL", "SPA", "SPA"] {
                        let at = line(it, "");
                        targets.push(at);
                    }
                }
                it => {
                    line(it, "");
                }
            },
        }
    }
    lines.push(Line { label: None, mnemonic: "NOP", operand: "0".to_owned() });
    for at in targets {
        // Not into a jump list, which ends where a label stands.
        let to = (at + 1 + numbers.below(lines.len() - at - 1)..lines.len())
            .find(|&it| lines[it].mnemonic != "SPA")
            .unwrap_or(lines.len() - 1);
        lines[at].operand = format!("M{to:03}");
        lines[to].label = Some(format!("M{to:03}"));
    }
    lines
}

fn text(lines: &[Line]) -> String {
    let mut text = String::from(HEAD);
    for line in lines {
        let label = line.label.as_ref().map(|it| format!("{it}: ")).unwrap_or_default();
        let _ = writeln!(text, "{label}{} {}", line.mnemonic, line.operand);
    }
    text.push_str("END_FUNCTION\n");
    text
}

const HEAD: &str = "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n";

#[derive(Debug, Clone, Copy, PartialEq)]
enum Value {
    Bit(bool),
    Word(i64),
}

type Memory = HashMap<String, Value>;

/// What a run did at a line.
#[derive(Debug, Clone)]
struct Visit {
    /// The memory before it.
    memory: Memory,
    /// What it wrote, or whether it jumped or left.
    wrote: Option<Value>,
    left: bool,
}

#[derive(Debug, Clone, Copy)]
struct Open {
    mnemonic: &'static str,
    rlo: bool,
    or: bool,
    nfc: bool,
}

/// Runs a program from some state; `None` for each line that is passed by. Ends early where the controller would stop, with
/// the line.
fn run(lines: &[Line], numbers: &mut Numbers) -> (Vec<Option<Visit>>, Option<usize>) {
    let mut memory: Memory =
        BITS.iter().chain(&["M1.0", "M1.1"]).map(|&it| (it.to_owned(), Value::Bit(numbers.bit()))).collect();
    for &it in WORDS {
        memory.insert(it.to_owned(), Value::Word(numbers.of(&[0, 1, 2])));
    }
    let (mut rlo, mut nfc, mut or, mut br) = (numbers.bit(), false, false, numbers.bit());
    let mut accumulators = [numbers.of(&[0_i64, 1, 7]), numbers.of(&[0, 1, 7])];
    let mut nesting: Vec<Open> = Vec::new();
    let (mut active, mut relay) = (false, Vec::new());
    let mut visits: Vec<Option<Visit>> = vec![None; lines.len()];
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let mut visit = Visit { memory: memory.clone(), wrote: None, left: false };
        let mut next = at + 1;
        let target = || lines.iter().position(|it| it.label.as_ref() == Some(&line.operand));
        let power = !active || relay.iter().all(|it| *it);
        let bit = |memory: &Memory| match memory.get(&line.operand) {
            Some(Value::Bit(it)) => *it,
            _ => br,
        };
        let check = |mnemonic: &str, status: bool, rlo: &mut bool, nfc: &mut bool, or: &mut bool| {
            let status = status ^ mnemonic.trim_end_matches('(').ends_with('N');
            match &mnemonic[..1] {
                "U" => {
                    *or &= *nfc;
                    *rlo = (*rlo || !*nfc) && status || *or;
                }
                "O" => (*rlo, *or) = (*rlo && *nfc || status, false),
                _ => (*rlo, *or) = ((*rlo && *nfc) ^ status, false),
            }
            *nfc = true;
        };
        match line.mnemonic {
            "O" if line.operand.is_empty() => (or, nfc) = ((rlo || or) && nfc, rlo && nfc),
            it @ ("U" | "UN" | "O" | "ON" | "X" | "XN") => check(it, bit(&memory), &mut rlo, &mut nfc, &mut or),
            it @ ("U(" | "UN(" | "O(" | "ON(" | "X(" | "XN(") => {
                nesting.push(Open { mnemonic: it, rlo, or, nfc });
                (or, nfc) = (false, false);
            }
            ")" => {
                let Some(open) = nesting.pop() else { return (visits, Some(at)) };
                let status = rlo;
                (rlo, or, nfc) = (open.rlo, open.or, open.nfc);
                check(open.mnemonic, status, &mut rlo, &mut nfc, &mut or);
            }
            "=" => {
                let value = Value::Bit(rlo && power);
                memory.insert(line.operand.clone(), value);
                visit.wrote = Some(value);
                (or, nfc) = (false, false);
            }
            it @ ("S" | "R") => {
                if rlo && power {
                    let value = Value::Bit(it == "S");
                    memory.insert(line.operand.clone(), value);
                    visit.wrote = Some(value);
                }
                (or, nfc) = (false, false);
            }
            "NOT" => rlo = !rlo,
            "SET" => (rlo, or, nfc) = (true, false, false),
            "CLR" => (rlo, or, nfc) = (false, false, false),
            "SAVE" => br = rlo,
            it @ ("FP" | "FN") => {
                let before = bit(&memory);
                memory.insert(line.operand.clone(), Value::Bit(rlo));
                rlo = if it == "FP" { rlo && !before } else { !rlo && before };
                (or, nfc) = (false, true);
            }
            "L" => {
                let value = match memory.get(&line.operand) {
                    Some(Value::Word(it)) => *it,
                    _ => line.operand.parse().unwrap(),
                };
                accumulators = [value, accumulators[0]];
            }
            "T" => {
                let value = Value::Word(if power { accumulators[0] } else { 0 });
                memory.insert(line.operand.clone(), value);
                visit.wrote = Some(value);
            }
            "TAK" => accumulators.swap(0, 1),
            ">I" => (rlo, or, nfc) = (accumulators[1] > accumulators[0], false, true),
            "==I" => (rlo, or, nfc) = (accumulators[1] == accumulators[0], false, true),
            "MCRA" => active = true,
            "MCRD" => active = false,
            "MCR(" => {
                relay.push(rlo);
                (or, nfc) = (false, false);
            }
            ")MCR" => {
                if relay.pop().is_none() {
                    return (visits, Some(at));
                }
                (or, nfc) = (false, false);
            }
            "SPA" => (visit.left, next) = (true, target().unwrap()),
            "SPL" => {
                let list = lines[at + 1..].iter().take_while(|it| it.mnemonic == "SPA" && it.label.is_none()).count();
                let chosen = usize::try_from(accumulators[0] & 0xFF).unwrap();
                visit.left = chosen >= list;
                next = if chosen < list { at + 1 + chosen } else { target().unwrap() };
            }
            it @ ("SPB" | "SPBN" | "SPBB" | "SPBNB") => {
                visit.left = rlo ^ it.contains('N');
                if it.ends_with('B') && it.len() > 3 {
                    br = rlo;
                }
                (rlo, or, nfc) = (true, false, false);
                if visit.left {
                    next = target().unwrap();
                }
            }
            it @ ("SPBI" | "SPBIN") => {
                visit.left = br ^ it.ends_with('N');
                (or, nfc) = (false, false);
                if visit.left {
                    next = target().unwrap();
                }
            }
            "BEB" => {
                visit.left = rlo;
                (rlo, or, nfc) = (true, false, false);
                if visit.left {
                    next = lines.len();
                }
            }
            "BEA" => (visit.left, next) = (true, lines.len()),
            "NOP" => {}
            other => unreachable!("{other}"),
        }
        visits[at] = Some(visit);
        at = next;
    }
    (visits, None)
}

/// The guarded statements of the same program, in the light of what the run found in memory.
struct Guarded<'a> {
    model: &'a UnitModel,
    reads: HashMap<(u32, u32), Value>,
}

impl Guarded<'_> {
    fn value(&self, id: ExprId) -> Option<Value> {
        Some(match *self.model.exprs.get(id) {
            Expr::Bool(it) => Value::Bit(it),
            Expr::Int(it) => Value::Word(it),
            Expr::Read { object, version } => *self.reads.get(&(object.0, version))?,
            Expr::Not(a) => Value::Bit(!self.bit(a)?),
            Expr::And(a, b) => match (self.bit(a), self.bit(b)) {
                (Some(false), _) | (_, Some(false)) => Value::Bit(false),
                (a, b) => Value::Bit(a? && b?),
            },
            Expr::Or(a, b) => match (self.bit(a), self.bit(b)) {
                (Some(true), _) | (_, Some(true)) => Value::Bit(true),
                (a, b) => Value::Bit(a? || b?),
            },
            Expr::Xor(a, b) => Value::Bit(self.bit(a)? ^ self.bit(b)?),
            Expr::Compare(op, a, b) => match (self.value(a)?, self.value(b)?) {
                (Value::Word(a), Value::Word(b)) => Value::Bit(op.holds(a.cmp(&b))),
                _ => return None,
            },
            _ => return None,
        })
    }

    fn bit(&self, id: ExprId) -> Option<bool> {
        match self.value(id)? {
            Value::Bit(it) => Some(it),
            Value::Word(_) => None,
        }
    }
}

/// How many paths and values were compared, and how many of them were known.
#[derive(Default, Debug)]
struct Tally {
    known: u32,
    all: u32,
}

impl Tally {
    fn compare<T: PartialEq + std::fmt::Debug>(&mut self, known: Option<T>, real: &T, what: impl Fn() -> String) {
        self.all += 1;
        if let Some(known) = known {
            self.known += 1;
            assert_eq!(known, *real, "{}", what());
        }
    }
}

fn compare(lines: &[Line], numbers: &mut Numbers, tally: &mut Tally) {
    let text = text(lines);
    let parse = crate::syntax::awl::parse(&text, Mnemonics::German);
    assert_eq!(parse.errors(), [], "{text}");
    let model = super::lower(parse.syntax(), Entity::Listing, Language::Awl(Mnemonics::German));
    let line_of = |range: rowan::TextRange| text[HEAD.len()..usize::from(range.start())].matches('\n').count();
    for _ in 0..4 {
        let (visits, stopped) = run(lines, numbers);
        let end = stopped.unwrap_or(lines.len());
        let mut guarded = Guarded { model: &model, reads: HashMap::new() };
        for access in model.accesses.iter().filter(|it| it.mode.reads()) {
            let object = &model.object(access.object).text;
            let Some(visit) = &visits[line_of(model.place(access.anchor))] else { continue };
            let value = visit.memory[object.as_str()];
            let before = guarded.reads.insert((access.object.0, access.version), value);
            assert!(before.is_none_or(|it| it == value), "two values of one version of {object}\n{text}");
        }
        for statement in &model.statements {
            let at = line_of(statement.range);
            if at >= end {
                continue;
            }
            let told = || format!("line {at} ({:?})\n{text}", lines[at]);
            tally.compare(guarded.bit(statement.path), &visits[at].is_some(), || format!("path of {}", told()));
            let Some(visit) = &visits[at] else { continue };
            match statement.kind {
                StatementKind::Assign { value, .. } | StatementKind::Store { value, .. } => {
                    tally.compare(guarded.value(value).map(Some), &visit.wrote, || format!("value of {}", told()));
                }
                StatementKind::Set { when, .. } | StatementKind::Reset { when, .. } => {
                    tally.compare(guarded.bit(when), &visit.wrote.is_some(), || format!("condition of {}", told()));
                }
                StatementKind::Jump(jump) => {
                    let when = model.jumps[jump as usize].when;
                    tally.compare(guarded.bit(when), &visit.left, || format!("condition of {}", told()));
                }
                StatementKind::Return { when, .. } => {
                    tally.compare(guarded.bit(when), &visit.left, || format!("condition of {}", told()));
                }
                _ => {}
            }
        }
    }
}

/// At least `percent` of what is compared is known.
fn agree(mix: &Mix, programs: u64, percent: u32) {
    let mut tally = Tally::default();
    for seed in 0..programs {
        let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66);
        let lines = program(&mut numbers, mix);
        compare(&lines, &mut numbers, &mut tally);
    }
    assert!(tally.known * 100 >= tally.all * percent, "{tally:?}");
}

#[test]
fn logic_strings() {
    // `O` twice: also without operand.
    let others = &["U(", "UN(", "O(", "ON(", "X(", "XN(", "NOT", "SET", "CLR", "SAVE", "O", "FP", "FN"];
    agree(&Mix { checks: CHECKS, others, jumps: &[], most: 24 }, 400, 75);
}

#[test]
fn jumps_and_block_ends() {
    let jumps = &["SPA", "SPB", "SPBN", "SPBB", "SPBNB", "SPBI", "SPBIN", "BEB"];
    agree(&Mix { checks: &["U", "UN", "O"], others: &["SET", "CLR", "NOT", "SAVE"], jumps, most: 24 }, 400, 50);
}

#[test]
fn jumps_into_and_out_of_parentheses() {
    let others = &["U(", "UN(", "O(", "ON(", "X(", "O", "NOT", "SAVE", "SET"];
    agree(&Mix { checks: CHECKS, others, jumps: &["SPA", "SPB", "SPBN", "SPBNB", "SPBI"], most: 30 }, 600, 40);
}

#[test]
fn master_control_relay() {
    let others = &["MCRA", "MCRA", "MCRD", "MCR(", ")MCR", "SET", "L", "T", "T"];
    agree(&Mix { checks: &["U", "UN", "O"], others, jumps: &[], most: 24 }, 400, 60);
    agree(&Mix { checks: &["U", "UN", "O"], others, jumps: &["SPB", "SPBN"], most: 24 }, 400, 40);
}

#[test]
fn accumulators_and_jump_lists() {
    let others = &["L", "L", "L", "T", "TAK", ">I", "==I", "SPL", "SET"];
    agree(&Mix { checks: &["U", "O"], others, jumps: &["SPA", "SPB", "SPBN"], most: 30 }, 400, 40);
}

#[test]
fn everything_at_once() {
    let others = &[
        "U(", "O(", "X(", "O", "NOT", "SET", "CLR", "SAVE", "FP", "L", "T", "==I", "MCRA", "MCRD", "MCR(", ")MCR",
        "SPL",
    ];
    let jumps = &["SPA", "SPB", "SPBN", "SPBB", "SPBNB", "SPBI", "SPBIN", "BEB", "BEA"];
    agree(&Mix { checks: CHECKS, others, jumps, most: 40 }, 600, 30);
}

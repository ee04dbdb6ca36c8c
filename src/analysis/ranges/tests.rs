use std::collections::BTreeMap;
use std::fmt::Write as _;

use proptest::prelude::*;

use super::*;
use crate::model::entity::{Entity, Part, Task};
use crate::model::lower;
use crate::syntax::{self, Language};

fn model(text: &str) -> UnitModel {
    let parse = syntax::parse(Language::Pl7St, text);
    assert_eq!(parse.errors(), [], "{text}");
    let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
    lower::lower(parse.syntax(), text, entity, Language::Pl7St)
}

/// The range of the last index or divisor: `0..9`, with a `?` at the ends that only the width gives.
fn range(text: &str) -> String {
    let model = model(text);
    let demand = model.demands.last().expect("an index or a divisor");
    let Some(number) = Ranges::new(&model).of(demand.value, demand.statement, demand.path) else {
        return "none".to_owned();
    };
    let Span { first, last, tells_first, tells_last, not_zero, .. } = number.span;
    let mark = |tells: bool| if tells { "" } else { "?" };
    let hole = if not_zero { " but 0" } else { "" };
    format!("{first}{}..{last}{}{hole}", mark(tells_first), mark(tells_last))
}

/// The range of `%MW0` behind some statements.
fn behind(code: &str) -> String {
    range(&format!("! {code} %MW99 := 1 / %MW0;"))
}

#[test]
fn constants_and_stores() {
    assert_eq!(behind(""), "-32768?..32767?");
    assert_eq!(behind("%MW0 := 5;"), "5..5");
    assert_eq!(behind("%MW0 := 16#FFFF;"), "-1..-1");
    assert_eq!(behind("%MW0 := 70000;"), "4464..4464");
    assert_eq!(behind("%MW0 := 5; INC %MW0;"), "6..6");
    assert_eq!(behind("%MW1 := 5; %MW0 := %MW1 * 3 - 20;"), "-5..-5");
    assert_eq!(behind("%MW1 := 5; %MW2 := 6; %MW0 := %MW1 * 3;"), "15..15");
    // Another word, its bits, a call, an index.
    assert_eq!(behind("%MW0 := 5; %MW0:X3 := TRUE;"), "-32768?..32767?");
    assert_eq!(behind("%MW0 := 5; SR1;"), "-32768?..32767?");
    assert_eq!(behind("%MW0 := 5; %MW1[%MW3] := 0;"), "-32768?..32767?");
    // 16 bits wrap around.
    assert_eq!(behind("%MW0 := 32767; INC %MW0;"), "-32768?..32767?");
}

#[test]
fn conditions_on_the_way() {
    assert_eq!(range("! IF %MW0 >= 0 AND %MW0 < 10 THEN %MW1 := 1 / %MW0; END_IF;"), "0..9");
    assert_eq!(range("! IF 10 > %MW0 THEN %MW1 := 1 / %MW0; END_IF;"), "-32768?..9");
    assert_eq!(range("! IF %MW0 < 0 OR %MW0 > 9 THEN ; ELSE %MW1 := 1 / %MW0; END_IF;"), "0..9");
    assert_eq!(range("! IF %MW0 < 3 AND %MW0 > 0 OR %MW0 = 9 THEN %MW1 := 1 / %MW0; END_IF;"), "1..9");
    assert_eq!(range("! IF %MW0 <> 0 THEN %MW1 := 1 / %MW0; END_IF;"), "-32768?..32767? but 0");
    assert_eq!(range("! IF %MW0 <> 0 AND %MW0 >= 0 THEN %MW1 := 1 / %MW0; END_IF;"), "1..32767?");
    assert_eq!(range("! IF %MW0 > 5 AND %MW0 < 5 THEN %MW1 := 1 / %MW0; END_IF;"), "none");
    assert_eq!(range("! IF %MW0 > 5 THEN RETURN; END_IF; %MW1 := 1 / %MW0;"), "-32768?..5");
    // Of the value before, and of another condition.
    assert_eq!(range("! IF %MW0 > 5 THEN %MW0 := %MW2; %MW1 := 1 / %MW0; END_IF;"), "-32768?..32767?");
    assert_eq!(range("! IF %MW0 > 5 THEN %MW2 := %MW0 - 6; %MW1 := 1 / %MW2; END_IF;"), "0..32761?");
    assert_eq!(range("! IF %MW0 + %MW2 < 5 THEN %MW1 := 1 / (%MW0 + %MW2); END_IF;"), "-32768?..4");
    // Compared with another number whose range is known.
    assert_eq!(range("! %MW2 := 7; IF %MW0 < %MW2 AND %MW0 > 0 THEN %MW1 := 1 / %MW0; END_IF;"), "1..6");
}

#[test]
fn values_that_are_cut_off() {
    assert_eq!(behind("IF %MW0 > 9 THEN %MW0 := 9; END_IF;"), "-32768?..9");
    assert_eq!(behind("IF %MW0 > 9 THEN %MW0 := 9; END_IF; IF %MW0 < 2 THEN %MW0 := 2; END_IF;"), "2..9");
    assert_eq!(behind("IF %M0 THEN %MW0 := 3; ELSE %MW0 := 8; END_IF;"), "3..8");
    assert_eq!(behind("IF %M0 THEN %MW0 := 3; ELSIF %M1 THEN %MW0 := 8; END_IF;"), "-32768?..32767?");
    assert_eq!(behind("%MW0 := 1; IF %M0 THEN %MW0 := 3; ELSIF %M1 THEN %MW0 := 8; END_IF;"), "1..8");
    assert_eq!(range("! %MW0 := 1; IF %M0 THEN %MW0 := 3; END_IF; IF %M0 THEN %MW1 := 1 / %MW0; END_IF;"), "3..3");
    assert_eq!(range("! %MW0 := 1; IF %M0 THEN %MW0 := 3; END_IF; IF NOT %M0 THEN %MW1 := 1 / %MW0; END_IF;"), "1..1");
}

#[test]
fn operations() {
    assert_eq!(behind("%MW0 := %MW1 AND 16#00FF;"), "0?..255");
    assert_eq!(behind("%MW0 := %MW1 REM 10;"), "-9?..9");
    assert_eq!(behind("%MW0 := ABS(%MW1 REM 10);"), "0?..9");
    assert_eq!(behind("%MW0 := SHR(%MW1, 12);"), "0?..15");
    assert_eq!(behind("%MW0 := %MW1 / 100;"), "-327?..327?");
    assert_eq!(behind("%MW0 := NOT (%MW1 AND 7);"), "-8..-1?");
    assert_eq!(behind("%MW0 := -(%MW1 AND 7);"), "-7..0?");
    assert_eq!(behind("%MW0 := (%MW1 AND 7) OR (%MW2 AND 9);"), "0?..15");
    assert_eq!(behind("%MD2 := %MW1; %MD2 := %MD2 * 2; %MD4 := %MD2 / 3; %MW0 := %MD4;"), "-21845?..21844?");
}

#[test]
fn loops_that_count() {
    assert_eq!(range("! FOR %MW0 := 0 TO 9 DO %MW1 := 1 / %MW0; END_FOR;"), "0..9");
    assert_eq!(range("! FOR %MW0 := 1 TO 3 DO FOR %MW1 := 0 TO %MW0 DO %MW2 := 1 / %MW1; END_FOR; END_FOR;"), "0..3");
    assert_eq!(range("! FOR %MW0 := 1 TO 3 DO FOR %MW1 := 0 TO 5 DO %MW2 := 1 / %MW0; END_FOR; END_FOR;"), "1..3");
    assert_eq!(range("! FOR %MW0 := %MW0 TO 9 DO %MW1 := 1 / %MW0; END_FOR;"), "-32768?..9");
    assert_eq!(range("! FOR %MW0 := 0 TO %MW5 DO %MW1 := 1 / %MW0; END_FOR;"), "0..32767?");
    // The manual's loop over a table writes by the index itself (PL7:3434-3450).
    assert_eq!(range("! FOR %MW9 := 0 TO 31 DO %MW100[%MW9] := 0; %MW1 := 1 / %MW9; END_FOR;"), "0..31");
    assert_eq!(range("! FOR %MW9 := 0 TO 31 DO %MW0[%MW9] := 0; %MW1 := 1 / %MW9; END_FOR;"), "-32768?..32767?");
    assert_eq!(range("! FOR %MW9 := 0 TO 31 DO %MW100[%MW8] := 0; %MW1 := 1 / %MW9; END_FOR;"), "-32768?..32767?");
    // What changes the index, or the end.
    for change in ["INC %MW9;", "SR1;", "%MD8 := 0;", "%MW5 := 3;"] {
        let text = format!("! FOR %MW9 := 0 TO %MW5 AND 7 DO {change} %MW1 := 1 / %MW9; END_FOR;");
        assert_eq!(range(&text), "-32768?..32767?", "{change}");
    }
    assert_eq!(range("! WHILE %MW0 < 9 AND %MW0 >= 0 DO %MW1 := 1 / %MW0; INC %MW0; END_WHILE;"), "0..8");
    assert_eq!(range("! FOR %MW0 := 0 TO 9 DO ; END_FOR; %MW1 := 1 / %MW0;"), "-32768?..32767?");
}

/// What is run: words by number, and a `/` that is the place of interest.
#[derive(Debug, Clone)]
enum Code {
    Store(u8, Sum),
    If(Test, Vec<Code>, Vec<Code>),
    For(u8, i16, i16, Vec<Code>),
    Use(u8),
}

#[derive(Debug, Clone)]
enum Sum {
    Constant(i16),
    Word(u8),
    Binary(&'static str, u8, i16),
    Words(&'static str, u8, u8),
    Shift(u8, u8),
    Absolute(u8),
}

#[derive(Debug, Clone)]
enum Test {
    Compare(u8, &'static str, i16),
    Words(u8, &'static str, u8),
    And(Box<Test>, Box<Test>),
    Or(Box<Test>, Box<Test>),
    Not(Box<Test>),
}

fn word() -> impl Strategy<Value = u8> {
    0..4_u8
}

fn constant() -> impl Strategy<Value = i16> {
    prop_oneof![-12..12_i16, Just(i16::MAX), Just(i16::MIN), Just(255), Just(1000)]
}

fn sum() -> impl Strategy<Value = Sum> {
    let operator = || prop::sample::select(vec!["+", "-", "*", "/", "REM", "AND", "OR", "XOR"]);
    prop_oneof![
        constant().prop_map(Sum::Constant),
        word().prop_map(Sum::Word),
        (operator(), word(), constant()).prop_map(|it| Sum::Binary(it.0, it.1, it.2)),
        (operator(), word(), word()).prop_map(|it| Sum::Words(it.0, it.1, it.2)),
        (word(), 0..16_u8).prop_map(|it| Sum::Shift(it.0, it.1)),
        word().prop_map(Sum::Absolute),
    ]
}

fn test() -> impl Strategy<Value = Test> {
    let operator = || prop::sample::select(vec!["=", "<>", "<", "<=", ">", ">="]);
    let leaf = prop_oneof![
        (word(), operator(), constant()).prop_map(|it| Test::Compare(it.0, it.1, it.2)),
        (word(), operator(), word()).prop_map(|it| Test::Words(it.0, it.1, it.2)),
    ];
    leaf.prop_recursive(2, 4, 2, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| Test::And(a.into(), b.into())),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| Test::Or(a.into(), b.into())),
            inner.prop_map(|it| Test::Not(it.into())),
        ]
    })
}

fn code() -> impl Strategy<Value = Vec<Code>> {
    let leaf = prop_oneof![
        3 => (word(), sum()).prop_map(|it| Code::Store(it.0, it.1)),
        2 => word().prop_map(Code::Use),
    ];
    let statement = leaf.prop_recursive(3, 16, 4, |inner| {
        let list = || prop::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            (test(), list(), list()).prop_map(|it| Code::If(it.0, it.1, it.2)),
            (word(), -4..4_i16, -4..4_i16, list()).prop_map(|it| Code::For(it.0, it.1, it.2, it.3)),
        ]
    });
    prop::collection::vec(statement, 1..6)
}

impl Sum {
    fn text(&self) -> String {
        match self {
            Self::Constant(it) => it.to_string(),
            Self::Word(a) => format!("%MW{a}"),
            Self::Binary(op, a, b) if *b < 0 => format!("%MW{a} {op} ({b})"),
            Self::Binary(op, a, b) => format!("%MW{a} {op} {b}"),
            Self::Words(op, a, b) => format!("%MW{a} {op} %MW{b}"),
            Self::Shift(a, by) => format!("SHR(%MW{a}, {by})"),
            Self::Absolute(a) => format!("ABS(%MW{a})"),
        }
    }

    fn value(&self, words: &[i16; 4]) -> i16 {
        let of = |it: u8| words[usize::from(it)];
        let binary = |op: &str, a: i16, b: i16| match op {
            "+" => a.wrapping_add(b),
            "-" => a.wrapping_sub(b),
            "*" => a.wrapping_mul(b),
            // The result of a division by 0 is any number.
            "/" if b == 0 => 77,
            "REM" if b == 0 => -77,
            "/" => a.wrapping_div(b),
            "REM" => a.wrapping_rem(b),
            "AND" => a & b,
            "OR" => a | b,
            _ => a ^ b,
        };
        match *self {
            Self::Constant(it) => it,
            Self::Word(a) => of(a),
            Self::Binary(op, a, b) => binary(op, of(a), b),
            Self::Words(op, a, b) => binary(op, of(a), of(b)),
            Self::Shift(a, by) => (of(a).cast_unsigned() >> by).cast_signed(),
            Self::Absolute(a) => of(a).wrapping_abs(),
        }
    }
}

impl Test {
    fn text(&self) -> String {
        match self {
            Self::Compare(a, op, b) => format!("%MW{a} {op} ({b})"),
            Self::Words(a, op, b) => format!("%MW{a} {op} %MW{b}"),
            Self::And(a, b) => format!("({}) AND ({})", a.text(), b.text()),
            Self::Or(a, b) => format!("({}) OR ({})", a.text(), b.text()),
            Self::Not(a) => format!("NOT ({})", a.text()),
        }
    }

    fn holds(&self, words: &[i16; 4]) -> bool {
        let compare = |a: i16, op: &str, b: i16| match op {
            "=" => a == b,
            "<>" => a != b,
            "<" => a < b,
            "<=" => a <= b,
            ">" => a > b,
            _ => a >= b,
        };
        match *self {
            Self::Compare(a, op, b) => compare(words[usize::from(a)], op, b),
            Self::Words(a, op, b) => compare(words[usize::from(a)], op, words[usize::from(b)]),
            Self::And(ref a, ref b) => a.holds(words) && b.holds(words),
            Self::Or(ref a, ref b) => a.holds(words) || b.holds(words),
            Self::Not(ref a) => !a.holds(words),
        }
    }
}

/// The text of some code, whose places of interest are numbered in the order of the text.
fn text(code: &[Code], uses: &mut usize, out: &mut String) {
    for it in code {
        match it {
            Code::Store(to, value) => write!(out, "%MW{to} := {};", value.text()),
            Code::If(test, yes, no) => {
                write!(out, "IF {} THEN ", test.text()).expect("a string");
                text(yes, uses, out);
                out.push_str(" ELSE ");
                text(no, uses, out);
                write!(out, " END_IF;")
            }
            Code::For(index, first, last, body) => {
                write!(out, "FOR %MW{index} := {first} TO {last} DO ").expect("a string");
                text(body, uses, out);
                write!(out, " END_FOR;")
            }
            Code::Use(of) => {
                *uses += 1;
                write!(out, "%M{uses}[%MW{of}] := TRUE;")
            }
        }
        .expect("a string");
    }
}

struct Run {
    words: [i16; 4],
    left: u32,
    /// Values at each place, by its number in the text.
    seen: BTreeMap<usize, Vec<i16>>,
}

impl Run {
    /// `uses`: places before this code in the text. Gives those up to its end.
    fn run(&mut self, code: &[Code], mut uses: usize) -> usize {
        let count = |list: &[Code]| {
            let mut count = 0;
            text(list, &mut count, &mut String::new());
            count
        };
        for it in code {
            self.left = self.left.saturating_sub(1);
            let runs = self.left > 0;
            match it {
                Code::Store(to, value) if runs => self.words[usize::from(*to)] = value.value(&self.words),
                Code::Store(..) => {}
                Code::If(test, yes, no) => {
                    let holds = test.holds(&self.words);
                    let (first, second) = (uses, uses + count(yes));
                    if runs && holds {
                        self.run(yes, first);
                    } else if runs {
                        self.run(no, second);
                    }
                    uses = second + count(no);
                }
                Code::For(index, first, last, body) => {
                    let at = usize::from(*index);
                    self.words[at] = *first;
                    while self.left > 0 && self.words[at] <= *last {
                        self.left -= 1;
                        self.run(body, uses);
                        self.words[at] = self.words[at].wrapping_add(1);
                    }
                    uses += count(body);
                }
                Code::Use(of) => {
                    uses += 1;
                    if runs {
                        self.seen.entry(uses).or_default().push(self.words[usize::from(*of)]);
                    }
                }
            }
        }
        uses
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// No run has a value outside of the range that is computed for its place.
    #[test]
    fn every_value_that_occurs_is_in_its_range(
        code in code(),
        starts in prop::collection::vec([constant(), constant(), constant(), constant()], 1..40),
    ) {
        let mut source = "! ".to_owned();
        text(&code, &mut 0, &mut source);
        source.push_str(" %M0 := TRUE;");
        let model = model(&source);
        let ranges = Ranges::new(&model);
        for words in starts {
            let mut run = Run { words, left: 500, seen: BTreeMap::new() };
            run.run(&code, 0);
            for (place, values) in run.seen {
                let name = format!("%M{place}[");
                let demand = model.demands.iter().find(|it| match it.what {
                    DemandKind::Index(object) => model.object(object).text.starts_with(&name),
                    DemandKind::Divisor => false,
                });
                let demand = demand.expect("each place has an index");
                let span = ranges.of(demand.value, demand.statement, demand.path).map(|it| it.span);
                for value in values {
                    prop_assert!(
                        span.is_some_and(|it| it.contains(value.into())),
                        "{source}\n{words:?}: {value} at place {place}, and not in {span:?}",
                    );
                }
            }
        }
    }
}

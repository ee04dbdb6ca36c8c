use proptest::prelude::*;

use super::*;
use crate::model::object::pl7;

const BITS: [&str; 4] = ["%M0", "%M1", "%I1.0", "%I1.1"];
const WORDS: [&str; 2] = ["%MW0", "%MW9"];
const PARTS: [&str; 2] = ["%MW0:X0", "%MW0:X1"];

fn objects() -> Vec<Object> {
    BITS.iter().chain(&WORDS).chain(&PARTS).map(|it| pl7::parse(it).unwrap()).collect()
}

#[derive(Debug, Clone)]
enum Formula {
    Bit(usize),
    Part(usize),
    Edge(usize, bool),
    Compare(usize, Comparison, i64),
    Not(Box<Self>),
    Both(Box<Self>, Box<Self>, u8),
}

/// A state of the machine: bits now and before, words.
struct State {
    now: u8,
    before: u8,
    words: [i64; 2],
}

impl Formula {
    fn build(&self, exprs: &mut Exprs) -> ExprId {
        let id = |it: usize| ObjectId(u32::try_from(it).unwrap());
        match self {
            Self::Bit(n) => exprs.read(id(*n), 0),
            Self::Part(n) => exprs.read(id(6 + n), 0),
            Self::Edge(n, rising) => exprs.edge(id(*n), 0, *rising),
            Self::Compare(n, op, value) => {
                let (a, b) = (exprs.read(id(4 + n), 0), exprs.int(*value));
                if value % 2 == 0 { exprs.compare(*op, a, b) } else { exprs.compare(op.mirrored(), b, a) }
            }
            Self::Not(it) => {
                let it = it.build(exprs);
                exprs.not(it)
            }
            Self::Both(a, b, op) => {
                let (a, b) = (a.build(exprs), b.build(exprs));
                match op {
                    0 => exprs.and(a, b),
                    1 => exprs.or(a, b),
                    _ => exprs.xor(a, b),
                }
            }
        }
    }

    fn holds(&self, state: &State) -> bool {
        let bit = |bits: u8, n: usize| bits >> n & 1 == 1;
        match self {
            Self::Bit(n) => bit(state.now, *n),
            Self::Part(n) => state.words[0] >> n & 1 == 1,
            Self::Edge(n, rising) => bit(state.now, *n) == *rising && bit(state.before, *n) != *rising,
            Self::Compare(n, op, value) => op.holds(state.words[*n].cmp(value)),
            Self::Not(it) => !it.holds(state),
            Self::Both(a, b, op) => match op {
                0 => a.holds(state) && b.holds(state),
                1 => a.holds(state) || b.holds(state),
                _ => a.holds(state) != b.holds(state),
            },
        }
    }
}

impl State {
    fn all() -> impl Iterator<Item = Self> {
        let words = (-4..=7).flat_map(|a| (-1..=4).map(move |b| [a, b]));
        words.flat_map(|words| (0..16).flat_map(move |now| (0..16).map(move |before| Self { now, before, words })))
    }

    fn agrees(&self, given: &Given) -> bool {
        let bit = |bits: u8, n: u32| bits >> n & 1 == 1;
        match *given {
            Given::Bit(ObjectId(n @ 0..4), value) => bit(self.now, n) == value,
            Given::Bit(ObjectId(n), value) => (self.words[0] >> (n - 6) & 1 == 1) == value,
            Given::Edge { object: ObjectId(n), rising, value } => {
                (bit(self.now, n) == rising && bit(self.before, n) != rising) == value
            }
            _ => true,
        }
    }
}

fn formula() -> impl Strategy<Value = Formula> {
    use Comparison::*;
    let op = prop_oneof![Just(Eq), Just(Ne), Just(Lt), Just(Le), Just(Gt), Just(Ge)];
    let leaf = prop_oneof![
        (0..4_usize).prop_map(Formula::Bit),
        (0..2_usize).prop_map(Formula::Part),
        (0..2_usize, any::<bool>()).prop_map(|(n, rising)| Formula::Edge(n, rising)),
        (0..2_usize, op, 0..4_i64).prop_map(|(n, op, value)| Formula::Compare(n, op, value)),
    ];
    leaf.prop_recursive(4, 12, 2, |inner| {
        prop_oneof![
            inner.clone().prop_map(|it| Formula::Not(Box::new(it))),
            (inner.clone(), inner, 0..3_u8).prop_map(|(a, b, op)| Formula::Both(Box::new(a), Box::new(b), op)),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// What a table answers, the solver answers as well.
    #[test]
    fn table_and_solver_agree(a in formula(), b in formula(), c in formula()) {
        let objects = objects();
        let objects: Vec<&Object> = objects.iter().collect();
        let mut exprs = Exprs::default();
        let [a, b, c] = [a, b, c].map(|it| it.build(&mut exprs));
        let space = Space::new(&exprs, Objects::Units(&objects), Family::Pl7);
        for never in [vec![], vec![[b, c]], vec![[a, b], [b, c]]] {
            for wanted in [vec![(a, true)], vec![(a, false), (c, true)]] {
                let question = Question { wanted: &wanted, never: &never };
                let problem = Problem::new(&space, &question).unwrap();
                let Some(table) = Table::new(&problem) else { continue };
                let by_solver = problem.solve(&question, false, &mut Told::default()).0;
                prop_assert_ne!(&by_solver, &Answer::NotDecided);
                prop_assert_eq!(table.decide(&question) == Verdict::Never, by_solver.is_never());
                prop_assert_eq!(table.answer(&question).is_never(), by_solver.is_never());
            }
        }
    }

    /// Decided as by trying all states; and every state that agrees with the witness makes the conditions hold.
    #[test]
    fn agrees_with_brute_force(a in formula(), b in formula()) {
        let objects = objects();
        let objects: Vec<&Object> = objects.iter().collect();
        let mut exprs = Exprs::default();
        let wanted = [(a.build(&mut exprs), true), (b.build(&mut exprs), true)];
        let space = Space::new(&exprs, Objects::Units(&objects), Family::Pl7);
        let possible = State::all().any(|it| a.holds(&it) && b.holds(&it));
        let verdict = if possible { Verdict::Possible } else { Verdict::Never };
        prop_assert_eq!(space.together(&wanted.map(|it| it.0)), verdict, "with what the form tells");
        match space.solve(&wanted) {
            Answer::Never => prop_assert!(!possible),
            Answer::NotDecided => prop_assert!(false, "small conditions are decided"),
            Answer::Possible(witness) => {
                prop_assert!(possible && !witness.assumed);
                let in_range = |state: &State| witness.given.iter().all(|it| match *it {
                    Given::Whole(term, first, last) => {
                        let Expr::Read { object: ObjectId(n), .. } = *exprs.get(term) else { return false };
                        (first..=last).contains(&state.words[n as usize - 4])
                    }
                    ref other => state.agrees(other),
                });
                let agreeing: Vec<State> = State::all().filter(in_range).collect();
                prop_assert!(!agreeing.is_empty(), "{witness:?}");
                prop_assert!(agreeing.iter().all(|it| a.holds(it) && b.holds(it)), "{witness:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// What questions teach changes no answer: each is as by trying all states, whatever was asked before.
    #[test]
    fn what_was_learnt_is_true(formulas in prop::collection::vec(formula(), 3..7), order in any::<u32>()) {
        let objects = objects();
        let objects: Vec<&Object> = objects.iter().collect();
        let mut exprs = Exprs::default();
        let ids: Vec<ExprId> = formulas.iter().map(|it| it.build(&mut exprs)).collect();
        let lessons = Lessons::default();
        let space = Space::new(&exprs, Objects::Units(&objects), Family::Pl7).learning(&lessons);
        let truths: Vec<Vec<bool>> = formulas.iter().map(|it| State::all().map(|state| it.holds(&state)).collect()).collect();
        let count = ids.len();
        for at in 0..count * count {
            let (a, b) = (at / count, (at + order as usize) % count);
            let (x, y) = (order >> (at % 32) & 1 == 1, order >> (at % 31) & 1 == 0);
            let third = (a + 1) % count;
            let wanted = [(ids[a], x), (ids[b], y)];
            let never = [[ids[third], ids[b]]];
            for never in [&never[..], &[]] {
                let question = Question { wanted: &wanted, never };
                let of = |at: usize| truths[at].iter().copied();
                let mut moments = of(a).zip(of(b)).zip(of(third));
                let is_possible = moments.any(|((first, second), third)| {
                    first == x && second == y && (never.is_empty() || !(third && second))
                });
                prop_assert!(is_possible || !lessons.cases.borrow().answer(&question), "no such case");
                let problem = Problem::new(&space, &question).unwrap();
                let answer = lessons.solve(&problem, &question);
                prop_assert_eq!(matches!(answer, Answer::Possible(_)), is_possible, "{:?}", answer);
                prop_assert_eq!(answer.is_never(), !is_possible);
                let has_case = lessons.cases.borrow().answer(&question);
                prop_assert!(!is_possible || has_case || !problem.is_tight(), "the case that was just found");
            }
        }
    }
}

fn answer(first: &str, second: &str) -> (Answer, Vec<String>) {
    use crate::model::chart::Receptivity;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower;
    use crate::syntax::{self, Language};
    let text = format!(
        "PAGE 0\nTRANSITION (ST) AT (C 0,L 2) : {first} END_TRANSITION\nTRANSITION (ST) AT (C 1,L 2) : {second} END_TRANSITION\nEND_PAGE\n"
    );
    let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Chart("".into()) };
    let parse = syntax::parse(Language::Pl7Gr7, &text);
    assert_eq!(parse.errors(), [], "{text}");
    let model = lower::lower(parse.syntax(), &text, entity, Language::Pl7Gr7);
    let mut exprs = Exprs::default();
    let transitions = &model.chart.as_ref().unwrap().transitions;
    let wanted: Vec<(ExprId, bool)> = transitions
        .iter()
        .map(|it| {
            let Receptivity::Value(value) = it.receptivity else { panic!("{first} {second}") };
            (exprs.import(&model.exprs.cut(value, 100).unwrap(), |it| it), true)
        })
        .collect();
    let objects: Vec<&Object> = model.objects.iter().collect();
    let space = Space::new(&exprs, Objects::Units(&objects), Family::Pl7);
    let answer = space.solve(&wanted);
    let given = match &answer {
        Answer::Possible(witness) => witness.given.iter().map(|it| space.describe(it)).collect(),
        _ => Vec::new(),
    };
    (answer, given)
}

#[test]
fn receptivities() {
    let never = |a: &str, b: &str| assert!(answer(a, b).0.is_never(), "{a} / {b}");
    never("%I1.0 AND NOT %M3", "%M3");
    never("RE %I1.0", "FE %I1.0");
    never("RE %I1.0", "NOT %I1.0");
    never("%MW5 > 10", "%MW5 <= 10");
    never("%MW0:X3", "%MW0 = 0");
    never("%X3.T >= 10000", "%I1.0");
    never("%MF2 > 1.5", "%MF2 <= 1.5");
    never("%MW1 > %MW2", "%MW2 > %MW1");
    never("1 = 2", "%I1.0");
    never("%MW1 <> %MW1", "%I1.0");
    never("%MW0 = 16#FFFF", "%MW0 >= 0");
    never("%MW0 > 32767", "%I1.0");
    let possible = |a: &str, b: &str, assumed: bool, expected: &[&str]| {
        let (answer, given) = answer(a, b);
        let Answer::Possible(witness) = answer else { panic!("{a} / {b}") };
        assert_eq!(
            (witness.assumed, given),
            (assumed, expected.iter().map(|it| (*it).to_owned()).collect()),
            "{a} / {b}"
        );
    };
    possible("%I1.0", "%I1.1", false, &["`%I1.0` = 1", "`%I1.1` = 1"]);
    possible("%I1.0 OR %I1.1", "%I1.1 AND NOT %I1.0", false, &["`%I1.0` = 0", "`%I1.1` = 1"]);
    possible("%MW0 = 16#FFFF", "%M1", false, &["`%MW0` = -1", "`%M1` = 1"]);
    possible("%MW0 > 16#8000", "%M1", true, &["`%MW0` > 32768", "`%M1` = 1"]);
    possible("%MW5 >= 15", "%MW5 <= 20", false, &["`%MW5` in 15..20"]);
    possible("%MW5 > 15", "%M1", false, &["`%MW5` >= 16", "`%M1` = 1"]);
    possible("%X3.T > 50", "%M1", false, &["`%X3.T` >= 51", "`%M1` = 1"]);
    possible("%MW0:X3", "%MW0 > 3", false, &["`%MW0` = 8"]);
    possible("%MW1 > %MW2", "%MW1 <> %MW2", true, &["`%MW1` > `%MW2`"]);
    possible("%MW1 + 1 > 5", "%M1", true, &["a computed value >= 6", "`%M1` = 1"]);
    possible("%MD0 > 5", "%MW0 < 0", true, &["`%MD0` >= 6", "`%MW0` <= -1"]);
}

/// Expressions about objects of which nothing is known.
fn space(exprs: &Exprs) -> Space<'_> {
    Space::new(exprs, Objects::Unit(&[]), Family::Step7)
}

fn bit(exprs: &mut Exprs, n: u32) -> ExprId {
    exprs.read(ObjectId(n), 0)
}

#[test]
fn arms_of_one_if_exclude_each_other() {
    let mut exprs = Exprs::default();
    let (a, b) = (bit(&mut exprs, 0), bit(&mut exprs, 1));
    let both = exprs.and(a, b);
    let neither = exprs.not(both);
    assert!(space(&exprs).exclusive(both, neither));
    assert!(!space(&exprs).exclusive(a, neither));
    // a AND NOT b, against b OR NOT a: complementary by value, not by form.
    let not_a = exprs.not(a);
    let not_b = exprs.not(b);
    let left = exprs.and(a, not_b);
    let right = exprs.or(b, not_a);
    assert!(space(&exprs).exclusive(left, right));
}

#[test]
fn conditions_leave_nothing_out_when_they_cover_all() {
    let mut exprs = Exprs::default();
    let (a, b) = (bit(&mut exprs, 0), bit(&mut exprs, 1));
    let not_a = exprs.not(a);
    let (both, other) = (exprs.and(a, b), exprs.and(not_a, b));
    let all = Exprs::TRUE;
    assert_eq!(space(&exprs).without(&[all], &[[a, all], [not_a, all]]), Verdict::Never);
    assert_eq!(space(&exprs).without(&[all], &[[both, all], [other, all]]), Verdict::Possible);
    assert_eq!(space(&exprs).without(&[b], &[[both, all], [other, all]]), Verdict::Never);
    assert_eq!(space(&exprs).without(&[b], &[[a, b], [not_a, a]]), Verdict::Possible);
}

#[test]
fn another_version_is_another_value() {
    let mut exprs = Exprs::default();
    let before = exprs.read(ObjectId(0), 0);
    let after = exprs.read(ObjectId(0), 1);
    let not_after = exprs.not(after);
    assert!(!space(&exprs).exclusive(before, not_after));
}

#[test]
fn comparisons_of_one_term_share_its_value() {
    let mut exprs = Exprs::default();
    let term = bit(&mut exprs, 0);
    let (five, six, nine) = (exprs.int(5), exprs.int(6), exprs.int(9));
    let below = exprs.compare(Comparison::Lt, term, five);
    let above = exprs.compare(Comparison::Gt, term, nine);
    let equal = exprs.compare(Comparison::Eq, term, six);
    let between = exprs.compare(Comparison::Gt, six, term);
    assert!(space(&exprs).exclusive(below, above));
    assert!(space(&exprs).exclusive(below, equal));
    assert!(!space(&exprs).exclusive(below, between));
    // Nothing whole lies strictly between 5 and 6.
    let over_five = exprs.compare(Comparison::Gt, term, five);
    assert!(space(&exprs).exclusive(over_five, between));
}

#[test]
fn edges_exclude_each_other_and_imply_the_level() {
    let mut exprs = Exprs::default();
    let rising = exprs.edge(ObjectId(0), 0, true);
    let falling = exprs.edge(ObjectId(0), 0, false);
    let level = bit(&mut exprs, 0);
    let low = exprs.not(level);
    assert!(space(&exprs).exclusive(rising, falling));
    assert!(space(&exprs).exclusive(rising, low));
    assert!(space(&exprs).exclusive(falling, level));
    assert!(!space(&exprs).exclusive(rising, level));
}

#[test]
fn large_conditions_are_decided_by_the_solver() {
    let mut exprs = Exprs::default();
    let some = |exprs: &mut Exprs, count: u32| {
        (1..count).fold(bit(exprs, 0), |any, n| {
            let next = bit(exprs, n);
            exprs.or(any, next)
        })
    };
    let any = some(&mut exprs, 40);
    let other = exprs.xor(any, Exprs::TRUE);
    assert_eq!(space(&exprs).together(&[any]), Verdict::Possible);
    assert_eq!(space(&exprs).together(&[any, other]), Verdict::Never, "by form");
    let mut all = vec![any];
    for n in 0..40 {
        let absent = bit(&mut exprs, n);
        all.push(exprs.not(absent));
    }
    assert_eq!(space(&exprs).together(&all), Verdict::Never, "by what they say");
    let too_many = some(&mut exprs, 5000);
    assert_eq!(space(&exprs).together(&[too_many]), Verdict::NotDecided);
}

#[test]
fn constants_are_recognised() {
    let mut exprs = Exprs::default();
    let a = bit(&mut exprs, 0);
    let b = bit(&mut exprs, 1);
    let not_a = exprs.not(a);
    let inner = exprs.or(b, not_a);
    let always = exprs.or(a, inner);
    assert_eq!(space(&exprs).constant(Exprs::TRUE, always), Some(true));
    assert_eq!(space(&exprs).constant(Exprs::TRUE, inner), None);
}

/// A word and its bit are one memory as long as nothing wrote one of them without the other.
#[test]
fn versions_of_words_and_their_bits() {
    let objects = objects();
    let mut exprs = Exprs::default();
    let (zero, word) = (exprs.int(0), exprs.read(ObjectId(4), 3));
    let is_zero = exprs.compare(Comparison::Eq, word, zero);
    let (same, later) = (exprs.read(ObjectId(6), 3), exprs.read(ObjectId(6), 5));
    let space = Space::new(&exprs, Objects::Unit(&objects), Family::Pl7);
    assert!(space.exclusive(is_zero, same));
    assert!(!space.exclusive(is_zero, later));
    let known = [(word, 4)];
    let space = space.knowing(&known);
    assert_eq!(space.constant(Exprs::TRUE, is_zero), Some(false));
    assert_eq!(space.constant(Exprs::TRUE, same), None, "bits of a word that no condition compares");
}

#[test]
fn implied_and_equivalent_conditions() {
    let mut exprs = Exprs::default();
    let (a, b, term) = (bit(&mut exprs, 0), bit(&mut exprs, 1), bit(&mut exprs, 2));
    let (five, nine) = (exprs.int(5), exprs.int(9));
    let (over_five, over_nine) = (exprs.compare(Comparison::Gt, term, five), exprs.compare(Comparison::Gt, term, nine));
    let (both, swapped) = (exprs.and(a, b), exprs.and(b, a));
    let space = space(&exprs);
    assert!(space.implies(over_nine, over_five) && !space.implies(over_five, over_nine));
    assert!(space.equivalent(both, swapped) && !space.equivalent(both, a));
    assert_eq!(space.constant(over_nine, over_five), Some(true));
    assert_eq!(space.constant(Exprs::FALSE, a), Some(false));
}

/// Eleven things in ten places, no two in one: a solver that goes by clauses takes longer for each than for all before it.
#[test]
fn what_takes_for_ever_is_not_decided() {
    const PLACES: usize = 10;
    let objects: Vec<Object> = (0..PLACES * (PLACES + 1)).map(|it| pl7::parse(&format!("%M{it}")).unwrap()).collect();
    let mut exprs = Exprs::default();
    let read = |exprs: &mut Exprs, thing: usize, place: usize| {
        exprs.read(ObjectId(u32::try_from(thing * PLACES + place).unwrap()), 0)
    };
    let mut wanted: Vec<ExprId> = Vec::new();
    for thing in 0..=PLACES {
        let places: Vec<ExprId> = (0..PLACES).map(|place| read(&mut exprs, thing, place)).collect();
        wanted.push(places.into_iter().reduce(|a, b| exprs.or(a, b)).unwrap());
        for (other, place) in (0..thing).flat_map(|other| (0..PLACES).map(move |place| (other, place))) {
            let (a, b) = (read(&mut exprs, thing, place), read(&mut exprs, other, place));
            let both = exprs.and(a, b);
            wanted.push(exprs.not(both));
        }
    }
    let space = Space::new(&exprs, Objects::Unit(&objects), Family::Pl7);
    assert_eq!(space.together(&wanted), Verdict::NotDecided);
}

//! Places that never run in one scan, for they ask for steps that are never active together.
//!
//! A chart evolves once in a scan, between its preliminary and its posterior processing (PL7:4895-4901): two places on one side
//! of it see one situation, and actions see that of the posterior processing.

use rustc_hash::FxHashMap;

use super::chart;
use super::conditions::{Lessons, Objects, Space, Verdict};
use super::facts::{self, UnitFacts};
use super::processing::InAction;
use super::program::{Context, GlobalUse, ProgramIndex};
use super::reach::{Net, Node, Part, Study};
use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Places, Pool};
use crate::model::object::{Class, Object, Type};
use crate::model::unit::Mode;

/// The conditions of a unit that ask for steps, by the places that they lead to.
///
/// **Invariant:** no position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Asking {
    pool: Pool,
    /// By anchor, in order: the path to a write or a call, and the condition of the instruction itself.
    places: Box<[(u32, [u32; 2])]>,
}

impl Asking {
    pub fn new(model: &UnitModel) -> Option<Box<Self>> {
        /// Longer conditions are not looked into.
        const LONGEST: usize = 128;
        let is_step: Vec<bool> = model.objects.iter().map(is_step).collect();
        if !is_step.contains(&true) {
            return None;
        }
        let mut known: FxHashMap<ExprId, bool> = FxHashMap::default();
        let exprs = &model.exprs;
        let is_asked =
            |it: &Expr| matches!(it, Expr::Read { object, .. } if is_step.get(object.0 as usize) == Some(&true));
        let mut asked = |condition: ExprId| {
            let asks = known
                .entry(condition)
                .or_insert_with(|| exprs.is_within(condition, LONGEST) && exprs.has_part(condition, is_asked));
            if *asks { condition } else { Exprs::TRUE }
        };
        let path = |statement: u32| model.statements.get(statement as usize).map_or(Exprs::TRUE, |it| it.path);
        let writes = model.accesses.iter().filter(|it| it.mode.writes()).map(|it| {
            let (path, when) = facts::effective(model, it, path(it.statement));
            (it.anchor, path, when)
        });
        let calls = model.calls.iter().map(|it| (it.anchor, path(it.statement), it.when));
        let mut places: Vec<(u32, [ExprId; 2])> =
            writes.chain(calls).map(|(anchor, path, when)| (anchor, [asked(path), asked(when)])).collect();
        places.sort_unstable();
        places.dedup();
        // What happens at one place under several conditions is not told apart.
        let places: Vec<&(u32, [ExprId; 2])> = places
            .chunk_by(|a, b| a.0 == b.0)
            .filter_map(|it| if let [one] = it { Some(one) } else { None })
            .filter(|it| it.1 != [Exprs::TRUE; 2])
            .collect();
        if places.is_empty() {
            return None;
        }
        let (pool, of): (Pool, Places) = exprs.cut_all(places.iter().flat_map(|it| it.1));
        let places = places.iter().map(|(anchor, all)| (*anchor, all.map(|it| of.of(it)))).collect();
        Some(Box::new(Self { pool, places }))
    }

    fn at(&self, anchor: u32) -> Option<[u32; 2]> {
        let at = self.places.binary_search_by_key(&anchor, |it| it.0).ok()?;
        self.places.get(at).map(|it| it.1)
    }
}

fn is_step(object: &Object) -> bool {
    object.class == Class::Step && object.ty == Type::Bool && object.is_fixed()
}

/// How the program sets and resets steps, and commands charts: what of a unit every study hangs on besides the chart.
pub fn commands(unit: &UnitFacts) -> Vec<(&Object, bool)> {
    let is_command = |it: &Object| matches!(it.class, Class::Step | Class::System);
    let object = |at: u32| unit.objects.get(at as usize).map(|it| &it.object);
    if !unit.objects.iter().any(|it| is_command(&it.object)) {
        return Vec::new();
    }
    let writes = unit.uses.iter().filter(|it| it.mode.writes());
    let mut found: Vec<(&Object, bool)> = writes
        .filter_map(|it| Some((object(it.object).filter(|it| is_command(it))?, it.mode == Mode::Reset)))
        .collect();
    found.sort_unstable_by(|a, b| (&a.0.footprint, a.1).cmp(&(&b.0.footprint, b.1)));
    found.dedup_by(|a, b| (&a.0.footprint, a.1) == (&b.0.footprint, b.1));
    found
}

/// One way by which control comes to a place, from the part of the program that it starts in.
#[derive(Clone)]
struct Way<'a> {
    entry: u32,
    links: Vec<Link<'a>>,
}

/// What has to be so for control to go on along a way.
#[derive(Clone, Copy)]
enum Link<'a> {
    /// Places in the pool of a unit.
    Conditions { unit: u32, asking: &'a Asking, places: [u32; 2] },
    /// One of the steps of an action is active.
    Action { unit: u32, action: InAction<'a> },
}

/// Places that are reached in more ways, or by longer chains of calls, are not told apart.
const MOST_WAYS: usize = 16;
const LONGEST_CHAIN: usize = 8;

/// All ways to a place; `None` where not all of them are known.
fn ways<'a>(program: &ProgramIndex<'a>, unit: u32, anchor: u32, chain: usize) -> Option<Vec<Way<'a>>> {
    let facts: &'a UnitFacts = program.units.get(unit as usize)?;
    let mut links = Vec::new();
    if let Some((asking, places)) = facts.asking.as_deref().and_then(|it| Some((it, it.at(anchor)?))) {
        links.push(Link::Conditions { unit, asking, places });
    }
    if let Some(action) = InAction::at(facts, anchor).filter(InAction::is_while_active) {
        links.push(Link::Action { unit, action });
    }
    if program.is_entry(unit) {
        return Some(vec![Way { entry: unit, links }]);
    }
    let calls = program.callers.get(unit as usize).filter(|it| !it.is_empty() && chain < LONGEST_CHAIN)?;
    let mut found = Vec::new();
    for call in calls.iter().map(|it| program.calls.get(*it as usize)) {
        let call = call?;
        for mut way in ways(program, call.unit, call.it.anchor, chain + 1)? {
            way.links.extend(&links);
            found.push(way);
        }
        if found.len() > MOST_WAYS {
            return None;
        }
    }
    Some(found)
}

/// Whether two places surely never run in one scan, as they ask for steps of which the charts of the program have no two
/// active. Branches of one step that can be taken together are a finding of their own, and are not followed both.
pub fn never_together<'a, 's, 'p: 's>(
    program: &ProgramIndex<'a>,
    studies: impl FnOnce() -> &'s [Study<'p, 'p>],
    a: &GlobalUse<'_>,
    b: &GlobalUse<'_>,
) -> bool {
    let ways = |it: &GlobalUse<'_>| {
        let ways = ways(program, it.unit, it.it.anchor, 0)?;
        ways.iter().all(|it| !it.links.is_empty()).then_some(ways)
    };
    let Some((a, b)) = ways(a).and_then(|a| Some((a, ways(b)?))) else { return false };
    let studies = studies();
    let are_apart = |x: &Way<'a>, y: &Way<'a>| studies.iter().any(|it| Pair::new(program, it, [x, y]).is_never());
    a.iter().all(|x| b.iter().all(|y| are_apart(x, y)))
}

/// Whether a part of the program sees one situation of a section's charts, and which: that before they evolve, or that after.
fn sees_after(program: &ProgramIndex<'_>, net: &Net<'_, '_>, entry: u32) -> Option<bool> {
    let of = net.charts.first()?;
    let rank = |unit: u32| program.order.get(unit as usize);
    let is_chart = |it: &u32| {
        let facts = program.units[*it as usize];
        facts.chart.is_some() && chart::section(&facts.entity) == Some((of.task, of.section))
    };
    let contexts = |unit: u32| program.contexts.get(unit as usize).map(|it| &it[..]);
    let charts: Vec<u32> = (0..).take(program.units.len()).filter(is_chart).collect();
    let own: &[Context] = contexts(entry).filter(|it| it.len() == 1)?;
    if charts.iter().any(|it| contexts(*it) != Some(own)) {
        return None;
    }
    if charts.contains(&entry) {
        return Some(true);
    }
    let (first, last) = (charts.iter().map(|it| rank(*it)).min()?, charts.iter().map(|it| rank(*it)).max()?);
    if rank(entry) > last { Some(true) } else { (rank(entry) < first).then_some(false) }
}

/// Two ways, as the charts of a section see them.
struct Pair<'w, 'p, 'a> {
    study: &'w Study<'p, 'p>,
    exprs: Exprs,
    objects: Vec<&'a Object>,
    /// What both ways ask for.
    conditions: Vec<(ExprId, bool)>,
    /// Steps that they ask for, with their bits.
    asked: Vec<(Node, ObjectId)>,
    /// Of each action on the ways, its steps.
    active: Vec<Vec<Node>>,
    sees_one: bool,
}

impl<'w, 'p, 'a> Pair<'w, 'p, 'a> {
    fn new(program: &ProgramIndex<'a>, study: &'w Study<'p, 'p>, ways: [&Way<'a>; 2]) -> Self {
        let [x, y] = ways.map(|it| sees_after(program, &study.net, it.entry));
        let mut pair = Self {
            study,
            exprs: Exprs::default(),
            objects: Vec::new(),
            conditions: Vec::new(),
            asked: Vec::new(),
            active: Vec::new(),
            sees_one: x.is_some() && x == y,
        };
        if pair.sees_one {
            ways.iter().for_each(|it| pair.add(program, it));
        }
        pair
    }

    fn add(&mut self, program: &ProgramIndex<'a>, way: &Way<'a>) {
        for link in &way.links {
            match *link {
                Link::Action { unit, action } => self.active.push(action.nodes(program, unit, &self.study.net)),
                Link::Conditions { unit, asking, places } => {
                    let Some(facts) = program.units.get(unit as usize) else { continue };
                    let (mut known, mut own) = (vec![None; asking.pool.len()], FxHashMap::default());
                    for at in places {
                        let Self { exprs, objects, asked, study, .. } = self;
                        let mut id = |it: ObjectId, version: u32| {
                            let object = facts.objects.get(it.0 as usize).map(|it| &it.object)?;
                            // What is called may reset a step. Where nothing does, all of its values in a scan are one.
                            let is_stable = |it: &Node| version == 0 || !study.net.is_reset(*it);
                            let node = study.net.node_at(object).filter(|_| is_step(object)).filter(is_stable);
                            // Other objects may change from unit to unit, and are others on the other way.
                            let id = match node {
                                Some(node) => asked.iter().find(|it| it.0 == node).map(|it| it.1),
                                None => own.get(&it).copied(),
                            };
                            let next = ObjectId(u32::try_from(objects.len()).unwrap_or(u32::MAX));
                            if id.is_none() {
                                objects.push(object);
                                match node {
                                    Some(node) => asked.push((node, next)),
                                    None => _ = own.insert(it, next),
                                }
                            }
                            Some((id.unwrap_or(next), if node.is_some() { 0 } else { version }))
                        };
                        let condition = exprs.import_from(&asking.pool, at, &mut known, |exprs, leaf| {
                            let made = match *leaf {
                                Expr::Read { object, version } => {
                                    id(object, version).map(|(it, version)| exprs.read(it, version))
                                }
                                Expr::Edge { object, version, rising } => {
                                    id(object, version).map(|(it, version)| exprs.edge(it, version, rising))
                                }
                                _ => None,
                            };
                            made.unwrap_or_else(|| exprs.opaque())
                        });
                        self.conditions.push((condition, true));
                    }
                }
            }
        }
    }

    fn is_never(&self) -> bool {
        let nodes = || self.asked.iter().map(|it| it.0).chain(self.active.iter().flatten().copied());
        self.sees_one && self.study.knows_all() && self.study.parts_of(nodes()).any(|it| self.is_never_in(it))
    }

    fn is_never_in(&self, part: &Part) -> bool {
        let is_of = |it: &Node| part.component.nodes.binary_search(it).is_ok();
        let reads = self.asked.iter().filter(|it| is_of(&it.0));
        // The bit of which only an edge is asked for is read nowhere.
        let (nodes, reads): (Vec<Node>, Vec<ExprId>) =
            reads.filter_map(|it| Some((it.0, self.exprs.find_read(it.1, 0)?))).unzip();
        let active: Vec<&[Node]> = self.active.iter().map(|it| &it[..]).collect();
        let active: Vec<&[Node]> = active.into_iter().filter(|it| !it.is_empty() && it.iter().all(is_of)).collect();
        if nodes.is_empty() && active.is_empty() {
            return false;
        }
        let Some(states) = self.study.states(part, &part.own, &nodes, &active) else { return false };
        let (objects, family) = (Objects::Units(&self.objects), self.study.net.family());
        let lessons = Lessons::default();
        let space = Space::new(&self.exprs, objects, family).learning(&lessons);
        states.iter().all(|state| {
            let steps = reads.iter().copied().zip(state.iter().copied());
            let all: Vec<(ExprId, bool)> = self.conditions.iter().copied().chain(steps).collect();
            space.possible(&all) == Verdict::Never
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::Family;
    use crate::model::lower;
    use crate::syntax::{self, Language};

    const LOOP: &str = "INITIAL_STEP X0 : END_STEP STEP X1 : END_STEP STEP X2 : END_STEP\n\
        TRANSITION FROM X0 TO X1 := %I1.0; END_TRANSITION TRANSITION FROM X1 TO X2 := %I1.1; END_TRANSITION\n\
        TRANSITION FROM X2 TO X0 := %I1.2; END_TRANSITION\n";
    const PARALLEL: &str = "INITIAL_STEP X0 : END_STEP STEP X1 : END_STEP STEP X2 : END_STEP\n\
        TRANSITION FROM X0 TO (X1, X2) := %I1.0; END_TRANSITION TRANSITION FROM (X1, X2) TO X0 := %I1.1; END_TRANSITION\n";
    const ACTIONS: &str = "INITIAL_STEP X0 : END_STEP\n\
        STEP X1 : ACTION (N1,ST) : (*PHRASE*) SR1; (*END_PHRASE*) END_ACTION END_STEP\n\
        STEP X2 : ACTION (P0,ST) : (*PHRASE*) SR2; (*END_PHRASE*) END_ACTION END_STEP\n\
        TRANSITION FROM X0 TO X1 := %I1.0; END_TRANSITION TRANSITION FROM X1 TO X2 := %I1.1; END_TRANSITION\n\
        TRANSITION FROM X2 TO X1 := %I1.2; END_TRANSITION\n";
    const SR: [(&str, &str); 2] = [("MAST - SR1", "! %Q2.0 := %I1.4;\n"), ("MAST - SR2", "! %Q2.0 := %I1.5;\n")];

    /// Whether the first two writes of `%Q2.0` are told apart.
    fn apart(chart: &str, parts: &[(&str, &str)]) -> bool {
        let unit = |(address, text): (&str, &str), language| {
            let parse = syntax::parse(language, text);
            assert_eq!(parse.errors(), [], "{text}");
            let entity = crate::source::entity_from_address(address).unwrap();
            UnitFacts::new(&lower::lower(parse.syntax(), text, entity, language))
        };
        let chart = unit(("MAST - CHART", chart), Language::Sfc);
        let parts: Vec<UnitFacts> = parts.iter().map(|it| unit(*it, Language::Pl7St)).collect();
        let program = ProgramIndex::new(Family::Pl7, [&chart].into_iter().chain(&parts).collect());
        let studies = Study::all(&program);
        let mut writes: Vec<GlobalUse<'_>> = Vec::new();
        for uses in program.objects.iter().filter(|it| it.object.text == "%Q2.0") {
            writes.extend(uses.with_mode(Mode::writes));
        }
        let found = never_together(&program, || &studies, &writes[0], &writes[1]);
        assert_eq!(found, never_together(&program, || &studies, &writes[1], &writes[0]));
        found
    }

    #[test]
    fn steps_of_one_situation_tell_places_apart() {
        let post = |a: &str, b: &str| {
            format!("! IF {a} THEN %Q2.0 := %I1.4; END_IF;\n! IF {b} THEN %Q2.0 := %I1.5; END_IF;\n")
        };
        let unstarted = LOOP.replace("INITIAL_STEP", "STEP");
        let cases = [
            ("%X1", "%X2", LOOP, true),
            ("%X1", "%X2", PARALLEL, false),
            ("%X1", "%X0 AND %I1.6", PARALLEL, true),
            ("%X0 OR %X1", "%X2 AND NOT %X1", LOOP, true),
            ("%X0 OR %X1", "%X2 OR %M1", LOOP, false),
            ("NOT %X0", "NOT (%X1 OR %X2)", LOOP, true),
            ("%X1", "NOT %X2", LOOP, false),
            ("%X1 AND %I1.6", "%I1.7", LOOP, false),
            // A chart that nothing starts.
            ("NOT %X1", "NOT %X2", unstarted.as_str(), false),
            // No step of this chart.
            ("%X1", "%X7", LOOP, false),
        ];
        for (a, b, chart, expected) in cases {
            assert_eq!(apart(chart, &[("MAST - POST", &post(a, b))]), expected, "{a}, {b}");
            assert_eq!(apart(chart, &[("MAST - PRL", &post(a, b))]), expected, "{a}, {b}, before the chart");
        }
    }

    #[test]
    fn steps_that_the_program_moves_tell_nothing() {
        let both = "! IF %X1 THEN %Q2.0 := %I1.4; END_IF;\n! IF %X2 THEN %Q2.0 := %I1.5; END_IF;\n";
        let neither =
            "! IF %X0 THEN %Q2.0 := %I1.4; END_IF;\n! IF NOT (%X0 OR %X1) AND NOT %X2 THEN %Q2.0 := %I1.5; END_IF;\n";
        let none = "! IF NOT (%X0 OR %X1) THEN %Q2.0 := %I1.4; END_IF;\n! IF NOT %X2 THEN %Q2.0 := %I1.5; END_IF;\n";
        for (post, moves, expected) in [
            (both, "! IF %M0 THEN SET %X2; END_IF;\n", false),
            (both, "! IF %M0 THEN RESET %X2; END_IF;\n", true),
            (both, "! IF %M0 THEN SET %S21; END_IF;\n", true),
            (neither, "! IF %M0 THEN SET %S22; END_IF;\n", true),
            (none, "", true),
            (none, "! IF %M0 THEN SET %S22; END_IF;\n", false),
            (none, "! IF %M0 THEN RESET %X2; END_IF;\n", false),
        ] {
            assert_eq!(apart(LOOP, &[("MAST - PRL", moves), ("MAST - POST", post)]), expected, "{post}{moves}");
        }
    }

    #[test]
    fn the_chart_evolves_between_its_processings() {
        let of = |step: &str| format!("! IF {step} THEN %Q2.0 := %I1.4; END_IF;\n");
        let (one, two) = (of("%X1"), of("%X2"));
        assert!(!apart(LOOP, &[("MAST - PRL", &one), ("MAST - POST", &two)]));
        assert!(!apart(LOOP, &[("FAST MAIN", &one), ("MAST - POST", &two)]));
        assert!(!apart(
            LOOP,
            &[("MAST - PRL", "! SR1;\n"), ("MAST - POST", "! SR1;\n"), ("MAST - SR1", &(one + &two))]
        ));
    }

    #[test]
    fn calls_ask_too() {
        let calls = "! IF %X1 THEN SR1; END_IF;\n! IF %X2 THEN SR2; END_IF;\n";
        assert!(apart(LOOP, &[("MAST - POST", calls), SR[0], SR[1]]));
        // One of them is called elsewhere too.
        assert!(!apart(LOOP, &[("MAST - POST", &format!("{calls}! SR2;\n")), SR[0], SR[1]]));
        assert!(!apart(LOOP, &[("MAST - PRL", "! IF %X1 THEN SR1; END_IF;\n"), ("MAST - POST", calls), SR[0], SR[1]]));
        // While a step goes off, the next one is active.
        assert!(!apart(ACTIONS, &[SR[0], SR[1]]));
        assert!(apart(&ACTIONS.replace("P0", "P1"), &[SR[0], SR[1]]));
        let post = "! IF %X2 THEN %Q2.0 := %I1.5; END_IF;\n";
        assert!(apart(&ACTIONS.replace("P0", "P1"), &[SR[0], ("MAST - SR2", "! INC %MW1;\n"), ("MAST - POST", post)]));
        // A subroutine that calls itself ends.
        assert!(!apart(LOOP, &[("MAST - POST", calls), ("MAST - SR1", "! SR1;\n! %Q2.0 := %I1.4;\n"), SR[1]]));
    }
}

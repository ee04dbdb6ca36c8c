//! What code of PL7-2 costs: the time of a scan, and memory (PL72:1894-1976).
//!
//! All times are estimates. What the run decides counts at its longest: blocks are active, operations are fed, of a range the
//! end. What the configuration decides and no text of the program tells counts at its shortest. Code that a jump is sure to
//! pass by costs nothing; a jump back is not followed.

use rustc_hash::FxHashMap;

use super::program::ProgramIndex;
use crate::model::UnitModel;
use crate::model::chart::StepKind;
use crate::model::entity::{Entity, Part, Task};
use crate::model::expr::Exprs;
use crate::model::object::{Area, Class};
use crate::model::work::{CodeKind, Network};
use crate::target::pl72::{ACTIVE_STEPS, Element, NETWORK_COMMENT_BYTES, Series, SystemTask, VALID_TRANSITIONS};

/// What a unit costs. It has no places.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct UnitCost {
    /// The section, or each action and each receptivity.
    pub pieces: Vec<PieceCost>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PieceCost {
    pub kind: CodeKind,
    pub networks: u32,
    /// In the memory of the program.
    pub bytes: u64,
    /// The longest way through, in nanoseconds, by series. An element that a series does not have takes no time.
    pub time_ns: [u64; 3],
    /// Elements that the tables do not have, which cost nothing here.
    pub unlisted: u32,
    /// A jump leads back.
    pub turns_back: bool,
}

impl UnitCost {
    /// `None` of a unit that is none of PL7-2.
    pub fn new(model: &UnitModel) -> Option<Box<Self>> {
        if !model.language.is_pl7_2() {
            return None;
        }
        let texts = model.networks.iter().flat_map(|it| &it.elements).filter(|it| is_text(it.0)).count();
        let texts = u32::try_from(texts).unwrap_or(u32::MAX);
        let pieces = model.networks.chunk_by(|a, b| a.piece == b.piece);
        Some(Box::new(Self { pieces: pieces.map(|it| PieceCost::new(it, model, texts)).collect() }))
    }

    pub fn bytes(&self) -> u64 {
        self.pieces.iter().map(|it| it.bytes).sum()
    }
}

fn is_text(element: Element) -> bool {
    matches!(element, Element::SimpleText | Element::CompleteText)
}

impl PieceCost {
    /// `texts`: text blocks of the unit, each of which takes longer the more are active.
    fn new(networks: &[Network], model: &UnitModel, texts: u32) -> Self {
        let ways = Ways::new(networks, model);
        let times: Vec<[u64; 3]> = networks.iter().map(|it| times_ns(it, texts)).collect();
        let time_ns = Series::ALL.map(|series| ways.longest(times.iter().map(|it| it[series.index()])));
        Self {
            kind: networks.first().map_or(CodeKind::Section, |it| it.kind),
            networks: u32::try_from(networks.len()).unwrap_or(u32::MAX),
            bytes: networks.iter().map(bytes).sum(),
            time_ns,
            unlisted: networks.iter().fold(0, |sum, it| it.unlisted.saturating_add(sum)),
            turns_back: ways.turns_back,
        }
    }
}

/// The elements of a network, itself among them.
fn elements(network: &Network) -> impl Iterator<Item = (Element, u32)> {
    network.elements.iter().copied().chain([(Element::Network, 0)])
}

/// By series.
fn times_ns(network: &Network, texts: u32) -> [u64; 3] {
    elements(network).fold([0; 3], |sum, (element, quantity)| {
        let Some(row) = element.row() else { return sum };
        let quantity = if is_text(element) { texts } else { quantity };
        Series::ALL.map(|it| sum[it.index()].saturating_add(row.longest_ns(it, quantity).unwrap_or(0)))
    })
}

fn bytes(network: &Network) -> u64 {
    let elements = elements(network).filter_map(|it| it.0.row()).map(|it| u64::from(it.bytes));
    elements.sum::<u64>() + u64::from(network.comment) * u64::from(NETWORK_COMMENT_BYTES)
}

/// Where control goes from each network of a piece.
struct Ways {
    /// Networks further down that jumps lead to, and whether control may also pass to the next one.
    onwards: Vec<(Vec<usize>, bool)>,
    turns_back: bool,
}

impl Ways {
    fn new(networks: &[Network], model: &UnitModel) -> Self {
        let mut labelled: FxHashMap<u32, usize> = FxHashMap::default();
        for (at, network) in networks.iter().enumerate() {
            labelled.extend(network.labels.clone().map(|it| (it, at)));
        }
        let mut turns_back = false;
        let onwards = networks.iter().enumerate().map(|(at, network)| {
            let jumps = || network.jumps.clone().filter_map(|it| model.jumps.get(it as usize));
            let targets = jumps().filter_map(|it| labelled.get(&it.target?).copied());
            let (back, targets): (Vec<usize>, Vec<usize>) = targets.partition(|it| *it <= at);
            turns_back |= !back.is_empty();
            (targets, jumps().all(|it| it.when != Exprs::TRUE))
        });
        let onwards = onwards.collect();
        Self { onwards, turns_back }
    }

    /// The longest way from the first network on.
    fn longest(&self, times: impl ExactSizeIterator<Item = u64> + DoubleEndedIterator) -> u64 {
        let mut rest = vec![0_u64; times.len() + 1];
        for (at, (time, (targets, passes))) in times.zip(&self.onwards).enumerate().rev() {
            let next = targets.iter().copied().chain(passes.then_some(at + 1));
            rest[at] = next.map(|it| rest[it]).max().unwrap_or(0).saturating_add(time);
        }
        rest[0]
    }
}

/// What a task takes, and what of it each unit.
#[derive(Debug, Default)]
pub struct TaskCost {
    /// Networks of its sections.
    pub networks: u32,
    /// Of its code, in nanoseconds.
    pub code_ns: u64,
    /// What the system does in each scan of the master task; 0 of the fast task.
    pub system_ns: u64,
    /// Units with their part, in the order of execution.
    pub units: Vec<(u32, u64)>,
    /// See [`PieceCost::unlisted`] and [`PieceCost::turns_back`].
    pub unlisted: u32,
    pub turns_back: bool,
    pub has_chart: bool,
}

/// The code of a task of a PL7-2 program; `None` when there is none. Of a chart, as many of the longest actions and receptivities
/// count as there may be active steps and valid transitions at once, see [`situation`].
pub fn task(program: &ProgramIndex<'_>, task: Task, series: Series) -> Option<TaskCost> {
    let mut sum = TaskCost::default();
    let mut parts: FxHashMap<u32, u64> = FxHashMap::default();
    let mut pieces: [Vec<(u64, u32)>; 2] = [Vec::new(), Vec::new()];
    for (unit, piece) in pieces_of(program, task) {
        let time = piece.time_ns[series.index()];
        sum.unlisted = sum.unlisted.saturating_add(piece.unlisted);
        sum.turns_back |= piece.turns_back;
        match piece.kind {
            CodeKind::Section => {
                sum.networks = sum.networks.saturating_add(piece.networks);
                *parts.entry(unit).or_default() += time;
            }
            CodeKind::Action => pieces[0].push((time, unit)),
            CodeKind::Receptivity => pieces[1].push((time, unit)),
        }
    }
    for (mut pieces, most) in pieces.into_iter().zip(situation(program)) {
        sum.has_chart |= !pieces.is_empty();
        pieces.sort_unstable_by(|a, b| b.cmp(a));
        for (time, unit) in pieces.into_iter().take(most) {
            *parts.entry(unit).or_default() += time;
        }
    }
    sum.units = parts.into_iter().collect();
    sum.units.sort_unstable_by_key(|it| (program.order[it.0 as usize], it.0));
    sum.code_ns = sum.units.iter().fold(0, |sum, it| it.1.saturating_add(sum));
    if task == Task::Mast {
        sum.system_ns = system_ns(program, series);
    }
    (!sum.units.is_empty()).then_some(sum)
}

fn pieces_of<'p>(program: &'p ProgramIndex<'_>, task: Task) -> impl Iterator<Item = (u32, &'p PieceCost)> {
    let units = (0..).zip(&program.units).filter(move |it| it.1.entity.task() == Some(task));
    units.flat_map(|(unit, facts)| facts.cost.iter().flat_map(move |it| it.pieces.iter().map(move |it| (unit, it))))
}

/// How many steps can be active at once, and how many transitions valid behind them: the initial steps, and those by which
/// simultaneous activations go beyond what they end; never more than the controller manages (PL72:1413, PL72:1471). One of a
/// chart that was not read. Steps that the program sets itself are not thought of.
fn situation(program: &ProgramIndex<'_>) -> [usize; 2] {
    let mut sum = [0, 0];
    for chart in program.charts().iter().filter(|it| it.task == Task::Mast) {
        let initial = chart.steps.iter().filter(|it| it.it.kind == StepKind::Initial).count();
        let gains = chart.transitions.iter().map(|it| it.it.targets.len().saturating_sub(it.it.sources.len()));
        let steps = initial.max(1) + gains.sum::<usize>();
        let mut behind: FxHashMap<u32, usize> = FxHashMap::default();
        for step in chart.transitions.iter().flat_map(|it| &it.sources) {
            *behind.entry(*step).or_default() += 1;
        }
        sum[0] += steps;
        sum[1] += steps * behind.into_values().max().unwrap_or(1);
    }
    [(sum[0], ACTIVE_STEPS), (sum[1], VALID_TRANSITIONS)].map(|(count, most)| count.clamp(1, most.value as usize))
}

/// Whether the program has code of the fast task.
pub fn has_fast_task(program: &ProgramIndex<'_>) -> bool {
    pieces_of(program, Task::Fast).next().is_some()
}

/// Bytes that the code of a PL7-2 program takes; `None` when it has none.
pub fn program_bytes(program: &ProgramIndex<'_>) -> Option<u64> {
    let mut costs = program.units.iter().filter_map(|it| it.cost.as_deref()).peekable();
    costs.peek()?;
    Some(costs.map(UnitCost::bytes).sum())
}

/// What the system does in each scan, at its shortest: the modules that the program uses, each the quickest that has the channels.
/// Where there is a fast task, it may own two of them, the slowest (PL72:559-561).
fn system_ns(program: &ProgramIndex<'_>, series: Series) -> u64 {
    let tasks = [SystemTask::Terminal, SystemTask::Controller, SystemTask::ReadInputs, SystemTask::WriteOutputs];
    let own: u64 = tasks.into_iter().filter_map(|it| it.shortest_ns(series)).sum();
    let mut modules: FxHashMap<&str, (u32, u32)> = FxHashMap::default();
    for it in program.places(|it| matches!(it, Class::Input | Class::Output)) {
        let channels = it.footprint.end();
        match &it.footprint.area {
            Area::InputChannels(module) => {
                let module = modules.entry(module).or_default();
                module.0 = module.0.max(channels);
            }
            Area::OutputChannels(module) => {
                let module = modules.entry(module).or_default();
                module.1 = module.1.max(channels);
            }
            _ => {}
        }
    }
    let mut times: Vec<u64> =
        modules.into_values().filter_map(|(inputs, outputs)| SystemTask::module_ns(series, inputs, outputs)).collect();
    times.sort_unstable_by(|a, b| b.cmp(a));
    let passed = if has_fast_task(program) { 2 } else { 0 };
    own + times.into_iter().skip(passed).sum::<u64>()
}

/// What a unit is called in a message: `PRL`, `the sequential processing`.
pub fn name_of(entity: &Entity) -> String {
    match entity {
        Entity::Pl7 { part: Part::Preliminary, .. } => "the preliminary processing".to_owned(),
        Entity::Pl7 { part: Part::Posterior, .. } => "the posterior processing".to_owned(),
        Entity::Pl7 { part: Part::Chart(_), .. } => "the chart".to_owned(),
        _ => "this code".to_owned(),
    }
}

/// `157.4 ms`, rounded up.
pub fn milliseconds(nanoseconds: u64) -> String {
    let tenths = nanoseconds.div_ceil(100_000);
    format!("{}.{} ms", tenths / 10, tenths % 10)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::lower;
    use crate::syntax::{self, Language};

    fn cost(rungs: &[&str]) -> PieceCost {
        let text: String = (1..).zip(rungs).map(|(at, rung)| format!("RUNG L{at}:\n{rung}\nEND_RUNG\n")).collect();
        let parse = syntax::parse(Language::Pl72Ld, &text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let model = lower::lower(parse.syntax(), &text, entity, Language::Pl72Ld);
        let cost = UnitCost::new(&model).expect("a unit of PL7-2");
        let [piece] = cost.pieces.as_slice() else { panic!("{cost:?}") };
        piece.clone()
    }

    const COIL: &str = "OPEN_CONTACT(B0),H_LINK(8),COIL(B1);";

    /// 4 + 12 + 16 microseconds on a TSX 17-20, 4.5 + 12 + 16 on the others; 5 + 9 + 22 bytes.
    #[test]
    fn a_network_is_its_elements_and_itself() {
        let piece = cost(&[COIL]);
        assert_eq!((piece.time_ns, piece.bytes, piece.networks), ([32_000, 32_500, 32_500], 36, 1));
        assert_eq!(cost(&["(* pump *)\nOPEN_CONTACT(B0),H_LINK(8),COIL(B1);"]).bytes, 40);
        assert_eq!((piece.unlisted, piece.turns_back), (0, false));
        // A fast counter is of the TSX 17-20 alone.
        let piece = cost(&["OPEN_CONTACT(B0),BLOCK(FC),EMPTY_CELL(7);"]);
        assert_eq!(piece.time_ns, [152_000, 20_500, 20_500]);
        assert_eq!(cost(&["H_LINK(7),OPERATE W1 REM W2 -> W3 END_BLOCK;"]).unlisted, 1);
    }

    /// 270 + 8 microseconds for each active text block of two; 400 for a drum that steps.
    #[test]
    fn blocks_count_when_they_do_something() {
        let text = |number| format!("OPEN_CONTACT(B0),BLOCK(TXT{number}),EMPTY_CELL(7);");
        assert_eq!(cost(&[&text(0), &text(1)]).time_ns, [612_000, 613_000, 613_000]);
        assert_eq!(cost(&["OPEN_CONTACT(B0),BLOCK(D1),EMPTY_CELL(7);"]).time_ns, [420_000, 420_500, 420_500]);
    }

    #[test]
    fn jumps_pass_by_what_they_are_sure_to() {
        let sure = "H_LINK(9),JUMP_COIL(L4);";
        let open = "OPEN_CONTACT(B0),H_LINK(8),JUMP_COIL(L4);";
        // 24 + 16, then one network.
        assert_eq!(cost(&[sure, COIL, COIL, COIL]).time_ns[0], 40_000 + 32_000);
        assert_eq!(cost(&[open, COIL, COIL, COIL]).time_ns[0], 44_000 + 3 * 32_000);
        // Of two ways, the longer: a jump may lead past another that is sure.
        let far = "OPEN_CONTACT(B0),H_LINK(8),JUMP_COIL(L3);";
        assert_eq!(cost(&[far, "H_LINK(9),JUMP_COIL(L5);", COIL, COIL, COIL]).time_ns[0], 44_000 + 3 * 32_000);
        let back = cost(&[COIL, "OPEN_CONTACT(B0),H_LINK(8),JUMP_COIL(L1);"]);
        assert_eq!((back.time_ns[0], back.turns_back), (32_000 + 44_000, true));
        // A label that is not there.
        assert_eq!(cost(&["H_LINK(9),JUMP_COIL(L77);", COIL]).time_ns[0], 40_000);
    }

    #[test]
    fn times_are_written_in_tenths() {
        assert_eq!([0, 149_999, 157_300_000].map(milliseconds), ["0.0 ms", "0.2 ms", "157.3 ms"]);
    }
}

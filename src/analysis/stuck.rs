//! Transitions whose steps come to be active, and that no values make true: what is a cause, and what follows from it.
//!
//! A receptivity that asks for a step is never true when the step is never active. That may be because of another such
//! receptivity, which is the cause then; because of something else that keeps the step from being active; or because the two
//! wait for each other.

use rustc_hash::FxHashSet;

use super::reach::{Guarded, Net, Node, Part, Study};

/// What is stuck in a part of a chart.
#[derive(Debug, Default)]
pub struct Stuck {
    /// Transitions that are never crossed whatever other steps do.
    pub causes: Vec<usize>,
    /// Transitions that wait for steps behind one another, those of one circle together.
    pub circles: Vec<Vec<usize>>,
    /// Steps that are never active because of these transitions.
    pub behind: FxHashSet<Node>,
}

/// Of more transitions that wait for steps, each is taken for a cause.
const MOST: usize = 256;

impl Stuck {
    /// See [`Study::stuck`], which asks once.
    pub(super) fn of(study: &Study<'_, '_>, part: &Part) -> Self {
        let net = &study.net;
        let is_true = |it: usize, never: &FxHashSet<Node>| {
            let is_free = |it: Node| never.contains(&it) || study.is_dead_beside(part, it);
            !study.is_never(part, &[(it, true)], is_free)
        };
        let none = FxHashSet::default();
        let stuck: Vec<usize> = part
            .component
            .crossings
            .iter()
            .copied()
            .filter(|&it| match net.crossings[it].guard {
                Guarded::By(_) => net.is_ever_valid(&part.all, it),
                // Never looked at, for it leads nowhere.
                Guarded::Never => net.has_all_active(part, &net.crossings[it].from),
                Guarded::Unknown => false,
            })
            .filter(|&it| !is_true(it, &none))
            .collect();
        if stuck.is_empty() {
            return Self::default();
        }
        let never: FxHashSet<Node> = part.never_active.iter().copied().collect();
        let (mut waiting, mut causes): (Vec<usize>, Vec<usize>) =
            stuck.into_iter().partition(|it| is_true(*it, &never));
        causes.extend(waiting.drain(MOST.min(waiting.len())..));
        let targets = |all: &[usize]| -> Vec<Node> {
            all.iter().flat_map(|it| &net.crossings[*it].to).copied().filter(|it| never.contains(it)).collect()
        };
        let behind = |all: &[usize]| closure(net, targets(all), &never);
        // Steps that something else keeps from being active, and what comes behind them.
        let explained = behind(&[causes.as_slice(), waiting.as_slice()].concat());
        let elsewhere: Vec<Node> = never.iter().copied().filter(|it| !explained.contains(it)).collect();
        let mut known = behind(&causes);
        if study.knows_all() {
            known.extend(closure(net, elsewhere, &never));
        }
        // What waits for such a step is no cause of its own, nor is what waits for a step behind that.
        let mut open: Vec<(usize, FxHashSet<Node>)> = waiting.iter().map(|&it| (it, behind(&[it]))).collect();
        loop {
            let waits = |it: &(usize, FxHashSet<Node>)| {
                net.asked_of(&part.component, it.0).any(|it| known.contains(&it) && never.contains(&it))
            };
            let (follows, left): (Vec<_>, Vec<_>) = open.into_iter().partition(waits);
            open = left;
            if follows.is_empty() {
                break;
            }
            known.extend(follows.into_iter().flat_map(|it| it.1));
        }
        let mut circles: Vec<(Vec<usize>, FxHashSet<Node>)> = Vec::new();
        for (it, steps) in open {
            let asked: Vec<Node> = net.asked_of(&part.component, it).collect();
            // It may join circles that nothing joined before.
            let (of, apart): (Vec<_>, Vec<_>) = circles.into_iter().partition(|circle| {
                let asks = |other: &usize| net.asked_of(&part.component, *other).any(|it| steps.contains(&it));
                asked.iter().any(|it| circle.1.contains(it)) || circle.0.iter().any(asks)
            });
            circles = apart;
            let (mut waiting, mut behind) = (Vec::new(), FxHashSet::default());
            for circle in of {
                waiting.extend(circle.0);
                behind.extend(circle.1);
            }
            waiting.push(it);
            behind.extend(steps);
            circles.push((waiting, behind));
        }
        Self { causes, circles: circles.into_iter().map(|it| it.0).collect(), behind: explained }
    }
}

/// Steps and what comes behind them, among some.
fn closure(net: &Net<'_, '_>, starts: Vec<Node>, among: &FxHashSet<Node>) -> FxHashSet<Node> {
    let mut seen: FxHashSet<Node> = starts.iter().copied().collect();
    let mut open = starts;
    while let Some(node) = open.pop() {
        let next = net.leaving(node).iter().flat_map(|it| &net.crossings[*it].to).copied();
        open.extend(next.filter(|it| among.contains(it) && seen.insert(*it)));
    }
    seen
}

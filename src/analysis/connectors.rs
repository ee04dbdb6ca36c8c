//! Connectors that do not stand where a divergence or convergence wants them (PL7:4411-4413, 4420-4421).

use rustc_hash::{FxHashMap, FxHashSet};

use super::chart::{Chart, Connector, Transition};
use super::program::ProgramIndex;
use crate::model::chart::ConnectorKind;

/// Of more ends of a connector, or branches behind a step, than this only the first are looked at: no page has so many.
const MOST: usize = 64;

/// What is wrong. Steps, transitions and connectors are indices into the chart's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// A branch of an OR divergence leaves its step by a connector, on another page than another branch.
    Branch { other: usize },
    /// A transition has an origin connector before it, in place of its step.
    Before,
    /// A step takes part in an AND convergence by a connector, from another page.
    Convergence,
    /// The step before an AND divergence that has destination connectors stands on another page.
    Divergence,
    /// An origin connector on another page than the step where its branch goes on.
    Origin { target: u32 },
    /// A destination connector on another page than the transition whose branch it ends.
    Destination { transition: usize },
    /// Branches that meet before a destination connector, and too few origin connectors behind it.
    Missing { target: u32 },
}

/// A flaw with the connector that it is one of, and the step that the branch comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Misplaced {
    pub flaw: Flaw,
    pub connector: usize,
    pub step: u32,
}

/// Pages of a chart, where the text numbers them.
struct Pages<'p, 'a> {
    program: &'p ProgramIndex<'a>,
}

impl Pages<'_, '_> {
    fn differ(&self, a: u32, b: u32) -> bool {
        let page = |unit: u32| self.program.units.get(unit as usize)?.chart.as_ref()?.page;
        page(a).zip(page(b)).is_some_and(|(a, b)| a != b)
    }
}

/// The misplaced connectors of a chart, in no particular order.
pub fn misplaced(program: &ProgramIndex<'_>, chart: &Chart<'_>) -> Vec<Misplaced> {
    let pages = Pages { program };
    let mut found = sources_by_connector(chart, &pages);
    // Origin connectors that stand before a transition lead to no step, and need not.
    let used: FxHashSet<usize> =
        chart.transitions.iter().flat_map(|it| chart.connectors_at(it, &it.it.sources)).collect();
    // Pairs of steps that connectors of a kind join, and the connectors that are joined with nothing.
    let mut joined: FxHashMap<(u32, u32), usize> = FxHashMap::default();
    let mut loose_origins: FxHashMap<u32, usize> = FxHashMap::default();
    let mut loose_destinations = Vec::new();
    for (at, it) in chart.connectors.iter().enumerate() {
        match it.it.kind {
            ConnectorKind::Origin => {
                joined.extend(pairs(it).map(|pair| (pair, at)));
                if it.to.is_empty() && !used.contains(&at) {
                    loose_origins.extend(it.from.iter().map(|&from| (from, at)));
                }
            }
            ConnectorKind::Destination if it.from.is_empty() => loose_destinations.push(at),
            ConnectorKind::Destination => {}
        }
    }
    // Whether one of the branches before a destination connector has its origin connector.
    let met: Vec<bool> = chart
        .connectors
        .iter()
        .map(|it| it.to.iter().any(|to| it.from.iter().any(|from| joined.contains_key(&(*from, *to)))))
        .collect();
    // What destination connectors ask for.
    let mut asked: FxHashSet<(u32, u32)> = FxHashSet::default();
    for transition in &chart.transitions {
        for at in chart.connectors_at(transition, &transition.it.targets) {
            let it = &chart.connectors[at];
            for &target in &it.to {
                asked.extend(transition.sources.iter().map(|&from| (from, target)));
                let is_met = |from: &u32| joined.contains_key(&(*from, target));
                let Some(&step) = transition.sources.first() else { continue };
                if transition.sources.iter().any(is_met) {
                    continue;
                }
                let loose = transition.sources.iter().find_map(|from| Some((*from, *loose_origins.get(from)?)));
                if let Some((step, connector)) = loose {
                    if pages.differ(chart.connectors[connector].unit, chart.steps[target as usize].unit) {
                        found.push(Misplaced { flaw: Flaw::Origin { target }, connector, step });
                    }
                } else if met[at] {
                    // Without any origin connector, it is not paired at all: G005's affair.
                    found.push(Misplaced { flaw: Flaw::Missing { target }, connector: at, step });
                }
            }
        }
    }
    // Steps where a branch arrives that no destination connector asks for, with the first step that one comes from.
    let mut wanting: FxHashMap<u32, u32> = FxHashMap::default();
    for &(from, target) in joined.keys().filter(|it| !asked.contains(it)) {
        wanting.entry(target).and_modify(|it| *it = from.min(*it)).or_insert(from);
    }
    let leaving = leaving(chart);
    for connector in loose_destinations {
        let it = &chart.connectors[connector];
        let Some(&step) = it.to.iter().find_map(|it| wanting.get(it)) else { continue };
        let transitions = leaving.get(&step).map_or(&[][..], |it| &it[..it.len().min(MOST)]);
        let Some(&transition) = transitions.first() else { continue };
        if transitions.iter().all(|&at| pages.differ(it.unit, chart.transitions[at].unit)) {
            found.push(Misplaced { flaw: Flaw::Destination { transition }, connector, step });
        }
    }
    found
}

/// Pairs of steps that an origin connector joins; of one with many on both sides, which is none, the first.
fn pairs(it: &Connector<'_>) -> impl Iterator<Item = (u32, u32)> {
    let to: Vec<u32> = it.to.iter().take(MOST).copied().collect();
    it.from.iter().take(MOST).flat_map(move |&from| to.clone().into_iter().map(move |to| (from, to)))
}

/// The transitions behind each step.
fn leaving(chart: &Chart<'_>) -> FxHashMap<u32, Vec<usize>> {
    let mut leaving: FxHashMap<u32, Vec<usize>> = FxHashMap::default();
    for (at, it) in chart.transitions.iter().enumerate() {
        for &from in &it.sources {
            leaving.entry(from).or_default().push(at);
        }
    }
    leaving
}

/// Transitions behind an origin connector that stands for a step.
fn sources_by_connector(chart: &Chart<'_>, pages: &Pages<'_, '_>) -> Vec<Misplaced> {
    let leaving = leaving(chart);
    let mut found = Vec::new();
    for transition in &chart.transitions {
        for connector in chart.connectors_at(transition, &transition.it.sources) {
            let Some(&step) = chart.connectors[connector].from.first() else { continue };
            let elsewhere = |at: &usize| pages.differ(chart.transitions[*at].unit, transition.unit);
            let behind = leaving.get(&step).map_or(&[][..], Vec::as_slice);
            let ends_here = |it: &Transition<'_>| !chart.connectors_at(it, &it.it.targets).is_empty();
            let flaw = if !pages.differ(transition.unit, chart.steps[step as usize].unit) {
                Flaw::Before
            } else if transition.it.sources.len() > 1 {
                Flaw::Convergence
            } else if transition.it.targets.len() > 1 && ends_here(transition) {
                Flaw::Divergence
            } else if let Some(&other) = behind.iter().take(MOST).find(|it| elsewhere(it)) {
                Flaw::Branch { other }
            } else {
                Flaw::Before
            };
            found.push(Misplaced { flaw, connector, step });
        }
    }
    found
}

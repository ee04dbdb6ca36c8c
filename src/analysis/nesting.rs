//! Which graph each macro-step stands in: it has one place, and no expansion contains itself.

use rustc_hash::{FxHashMap, FxHashSet};

use super::Site;
use super::chart::{Chart, Step};
use crate::model::chart::{Graph, StepName};

/// What is wrong with the macro-steps of a section.
#[derive(Debug, Default)]
pub struct Nesting {
    /// Macro-steps that stand in a further place: the number, that place, and the first one.
    pub repeated: Vec<(u32, Site, Site)>,
    /// Expansions that contain themselves: each macro-step on the way stands in the expansion of the next, the last in that
    /// of the first.
    pub cycles: Vec<Vec<(u32, Site)>>,
}

/// The macro-steps that stand in a chart.
pub fn macros<'c, 'a>(chart: &'c Chart<'a>) -> impl Iterator<Item = (u32, &'c Step<'a>)> {
    chart.steps.iter().filter_map(|it| match it.it.name {
        Some(StepName::Macro(number)) => Some((number, it)),
        _ => None,
    })
}

/// What is wrong with the macro-steps of each section that has some.
pub fn by_section(charts: &[Chart<'_>]) -> Vec<Nesting> {
    let mut sections: Vec<Vec<&Chart<'_>>> = Vec::new();
    let mut known = FxHashMap::default();
    for chart in charts {
        let at = *known.entry((chart.task, chart.section)).or_insert(sections.len());
        if at == sections.len() {
            sections.push(Vec::new());
        }
        sections[at].push(chart);
    }
    sections.iter().map(|it| Nesting::new(it)).collect()
}

impl Nesting {
    fn new(section: &[&Chart<'_>]) -> Self {
        let mut nesting = Self::default();
        let mut first: FxHashMap<u32, (Graph, Site)> = FxHashMap::default();
        for chart in section {
            for (number, step) in macros(chart) {
                match first.get(&number) {
                    Some((_, before)) => nesting.repeated.push((number, step.site(), *before)),
                    None => {
                        first.insert(number, (chart.graph, step.site()));
                    }
                }
            }
        }
        // Each expansion is contained in one graph at most: what leads back to it is a cycle.
        let outer = |number: u32| match first.get(&number) {
            Some((Graph::Macro(outer), _)) => Some(*outer),
            _ => None,
        };
        let mut seen: FxHashSet<u32> = FxHashSet::default();
        let mut starts: Vec<u32> = first.keys().copied().collect();
        starts.sort_unstable();
        for start in starts {
            let mut way = Vec::new();
            let mut at = Some(start);
            while let Some(number) = at.filter(|it| seen.insert(*it)) {
                way.push(number);
                at = outer(number);
            }
            if let Some(from) = at.and_then(|at| way.iter().position(|it| *it == at)) {
                nesting.cycles.push(way[from..].iter().filter_map(|it| Some((*it, first.get(it)?.1))).collect());
            }
        }
        nesting
    }
}

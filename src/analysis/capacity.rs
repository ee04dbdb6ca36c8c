//! What charts have: elements drawn, and elements that are active or valid at one time.

use super::Site;
use super::chart::{Chart, Connector};
use super::reach::{Node, Part, Study};
use crate::model::chart::{ConnectorKind, StepKind};

/// The elements of the charts of a program, as controllers count them, in the order of the drawing.
#[derive(Debug, Default)]
pub struct Drawn {
    /// Of one name once, those of expansions too, but for `IN` and `OUT`.
    pub steps: Vec<Site>,
    pub initial_steps: Vec<Site>,
    pub transitions: Vec<Site>,
    /// Transitions that several steps lead to together.
    pub and_convergences: Vec<Site>,
    pub origins: Vec<Site>,
    pub destinations: Vec<Site>,
}

impl Drawn {
    pub fn new(charts: &[Chart<'_>]) -> Self {
        let mut drawn = Self::default();
        for chart in charts {
            for (at, step) in (0..).zip(&chart.steps) {
                let is_counted = !matches!(step.it.kind, StepKind::In | StepKind::Out | StepKind::Macro);
                if is_counted && step.it.name.as_ref().is_none_or(|name| chart.step_named(name) == Some(at)) {
                    drawn.steps.push(step.site());
                    if step.it.kind == StepKind::Initial {
                        drawn.initial_steps.push(step.site());
                    }
                }
            }
            for transition in &chart.transitions {
                drawn.transitions.push(transition.site());
                if transition.it.sources.len() > 1 {
                    drawn.and_convergences.push(transition.site());
                }
            }
            let of = |kind| chart.connectors.iter().filter(move |it| it.it.kind == kind).map(Connector::site);
            drawn.origins.extend(of(ConnectorKind::Origin));
            drawn.destinations.extend(of(ConnectorKind::Destination));
        }
        drawn
    }
}

/// The most of something that the charts of a program have at one time.
#[derive(Debug, Default)]
pub struct AtOnce {
    /// Of all charts that nothing connects, each at its most.
    pub sum: u32,
    /// Steps that are active then, in the chart that has most.
    pub steps: Vec<Site>,
    /// The way that leads there.
    pub trace: String,
    /// Charts that have some.
    pub parts: u32,
}

impl AtOnce {
    /// Macro-steps stand for their expansions.
    pub fn active_steps(studies: &[Study<'_, '_>]) -> Self {
        Self::new(studies, |study, part, situation| {
            let active = study.net.active(&part.component, &part.all.situations[situation as usize]);
            active.filter(|it| study.net.step(*it).it.kind != StepKind::Macro).count()
        })
    }

    pub fn valid_transitions(studies: &[Study<'_, '_>]) -> Self {
        Self::new(studies, |study, part, situation| {
            // In the order of the component's nodes, which are sorted.
            let active: Vec<Node> =
                study.net.active(&part.component, &part.all.situations[situation as usize]).collect();
            let crossings = part.component.crossings.iter().filter_map(|&it| study.net.crossings.get(it));
            crossings.filter(|it| it.from.iter().all(|it| active.binary_search(it).is_ok())).count()
        })
    }

    fn new(studies: &[Study<'_, '_>], of: impl Fn(&Study<'_, '_>, &Part, u32) -> usize) -> Self {
        let mut count = Self::default();
        let mut largest = 0;
        for study in studies {
            for part in &study.parts {
                let situations = (0..).take(part.all.situations.len());
                // Of situations with as many, the first has the shortest way.
                let most = situations.map(|it| (of(study, part, it), std::cmp::Reverse(it))).max();
                let Some((number, std::cmp::Reverse(situation))) = most.filter(|it| it.0 > 0) else { continue };
                count.sum = count.sum.saturating_add(u32::try_from(number).unwrap_or(u32::MAX));
                count.parts += 1;
                if number > largest {
                    largest = number;
                    let active = study.net.active(&part.component, &part.all.situations[situation as usize]);
                    count.steps = active.map(|it| study.net.step(it).site()).collect();
                    let trace = study.net.trace(&part.component, &part.all, situation);
                    count.trace = format!("{number} of them are reached by {trace}");
                }
            }
        }
        count
    }
}

//! G004: an element where the page of a chart does not allow it.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::lint::{Sink, UnitCx};
use crate::model::chart::{Cell, Chart, ConnectorKind, Node, place};
use crate::target::Limit;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let (Some(chart), Some((pages, lines, columns))) = (&cx.model.chart, cx.target.chart_pages()) else { return };
    let page = place(&cx.model.entity).and_then(|it| it.page).filter(|&it| it >= pages.value);
    if let Some(page) = page {
        let message = format!("page {page} is out of range: pages are 0 to {}", pages.value.saturating_sub(1));
        sink.report(cx.model.heading(), message).note(format!("the number is given in {}", pages.source));
    }
    if let Some(count) = chart.page_count.filter(|&it| it > pages.value) {
        sink.report(cx.model.heading(), format!("the chart has {count} pages, and {} are allowed", pages.value))
            .note(format!("the number is given in {}", pages.source));
    }
    // In place of a step, before a transition, a connector is on a wrong page rather than on a wrong line.
    let before: FxHashSet<TextRange> = if cx.model.language.is_pl7_2() { FxHashSet::default() } else { sources(chart) };
    let mut taken: FxHashMap<Cell, TextRange> = FxHashMap::default();
    for (element, cell, range) in elements(chart) {
        if let Some(before) = taken.get(&cell) {
            let message = format!("{} stands in the cell of another element", element.name());
            sink.report(range, message).related(*before, "this one stands there first");
            continue;
        }
        taken.insert(cell, range);
        let beyond = |number: u32, limit: Limit, what: &str| {
            let last = limit.value.saturating_sub(1);
            format!("{what} {number} is out of range: {what}s of a page are 0 to {last}")
        };
        if cell.column >= columns.value {
            sink.report(range, beyond(cell.column, columns, "column"))
                .note(format!("the size of a page is given in {}", columns.source));
        } else if cell.line >= lines.value {
            sink.report(range, beyond(cell.line, lines, "line"))
                .note(format!("the size of a page is given in {}", lines.source));
        } else if !before.contains(&range) && !element.fits(cell.line, lines.value.saturating_sub(1)) {
            sink.report(range, format!("{} stands on line {}, {}", element.name(), cell.line, element.lines()))
                .note("lines are counted from 0, as the exchange form does");
        }
    }
}

#[derive(Clone, Copy)]
enum Element {
    Step,
    Transition,
    Connector(ConnectorKind),
}

impl Element {
    fn name(self) -> &'static str {
        match self {
            Self::Step => "a step",
            Self::Transition => "a transition",
            Self::Connector(ConnectorKind::Origin) => "an origin connector",
            Self::Connector(ConnectorKind::Destination) => "a destination connector",
        }
    }

    /// Whether a line is for such an element. The manual counts lines from 1: steps on even ones, transitions on odd ones,
    /// origin connectors on the first and where transitions stand, destination connectors on the last and where steps do.
    fn fits(self, line: u32, last: u32) -> bool {
        let is_inner = line > 0 && line < last;
        match self {
            Self::Step => is_inner && !line.is_multiple_of(2),
            Self::Transition => is_inner && line.is_multiple_of(2),
            Self::Connector(ConnectorKind::Origin) => line.is_multiple_of(2) && line < last,
            Self::Connector(ConnectorKind::Destination) => line > 0 && !line.is_multiple_of(2),
        }
    }

    fn lines(self) -> &'static str {
        match self {
            Self::Step => "and steps stand on odd lines but the last",
            Self::Transition => "and transitions stand on even lines but the first",
            Self::Connector(ConnectorKind::Origin) => "and origin connectors stand on even lines",
            Self::Connector(ConnectorKind::Destination) => "and destination connectors stand on odd lines",
        }
    }
}

/// Origin connectors that transitions come behind.
fn sources(chart: &Chart) -> FxHashSet<TextRange> {
    let nodes = chart.transitions.iter().flat_map(|it| &it.sources);
    let connectors = nodes.filter_map(|it| match it {
        Node::Connector(at) => chart.connectors.get(*at as usize),
        Node::Step(_) | Node::Named(_) => None,
    });
    connectors.map(|it| it.range).collect()
}

/// The elements with a place, in the order of the text.
fn elements(chart: &Chart) -> Vec<(Element, Cell, TextRange)> {
    let steps = chart.steps.iter().map(|it| (Element::Step, it.cell, it.range));
    let transitions = chart.transitions.iter().map(|it| (Element::Transition, it.cell, it.range));
    let connectors = chart.connectors.iter().map(|it| (Element::Connector(it.kind), it.cell, it.range));
    let all = steps.chain(transitions).chain(connectors);
    let mut all: Vec<_> = all.filter_map(|(element, cell, range)| Some((element, cell?, range))).collect();
    all.sort_by_key(|it| it.2.start());
    all
}

//! G028: a link that crosses the bar of steps that are activated or deactivated together.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::lint::{Sink, UnitCx};
use crate::model::chart::{Cell, Chart, LinkKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    /// A page has room for fewer bars than this.
    const MOST: usize = 256;
    let Some(chart) = &cx.model.chart else { return };
    let bars = bars(chart);
    if bars.is_empty() {
        return;
    }
    let neighbours = chart.vertical_joins();
    for bar in bars.iter().take(MOST) {
        let mut crossing: Vec<TextRange> = Vec::new();
        for link in &chart.links {
            // The lines of one junction are one drawing.
            let is_own = is_bar(link.kind) && link.from.iter().chain(&link.to).any(|it| bar.ends.contains(it));
            let vertical = link.segments.iter().filter(|it| !it.is_horizontal);
            if !is_own && vertical.clone().any(|it| bar.is_between(it.from, it.to, 1)) {
                crossing.push(link.range);
            }
        }
        for &(above, below, range) in &neighbours {
            let is_own = bar.ends.contains(&above) || bar.ends.contains(&below);
            if !is_own && bar.is_between(above, below, 0) {
                crossing.push(range);
            }
        }
        for link in crossing {
            let what = if bar.opens { "activates" } else { "deactivates" };
            sink.report(link, format!("a link crosses the bar that {what} steps together"))
                .related(bar.range, "the bar")
                .note("the lines of links are taken to lie at the lower edge of the cells that they name");
        }
    }
}

const fn is_bar(kind: LinkKind) -> bool {
    matches!(kind, LinkKind::AndDivergence | LinkKind::AndConvergence)
}

/// The double line of an AND divergence or convergence.
struct Bar {
    page: Option<u32>,
    /// The bar lies between this line and the next.
    line: u32,
    first: u32,
    last: u32,
    /// Cells of the elements that it joins.
    ends: FxHashSet<Cell>,
    opens: bool,
    range: TextRange,
}

impl Bar {
    /// Whether a vertical line from the lower edge of one cell to that of another meets the inner part of the bar. `beyond`:
    /// how many lines it must go on behind the bar; a line that ends at the bar's height turns there.
    fn is_between(&self, from: Cell, to: Cell, beyond: u32) -> bool {
        let (first, last) = (from.line.min(to.line), from.line.max(to.line));
        let above = first.saturating_add(beyond) <= self.line;
        from.page == self.page
            && from.column == to.column
            && (self.first < from.column && from.column < self.last)
            && above
            && self.line < last
    }
}

fn bars(chart: &Chart) -> Vec<Bar> {
    let mut bars: Vec<Bar> = Vec::new();
    let mut index: FxHashMap<(bool, Cell), usize> = FxHashMap::default();
    for link in chart.links.iter().filter(|it| is_bar(it.kind)) {
        let opens = link.kind == LinkKind::AndDivergence;
        let (transitions, steps) = if opens { (&link.from, &link.to) } else { (&link.to, &link.from) };
        let &[transition] = &transitions[..] else { continue };
        let line = if opens { Some(transition.line) } else { transition.line.checked_sub(1) };
        let Some(line) = line else { continue };
        let at = *index.entry((opens, transition)).or_insert_with(|| {
            let column = transition.column;
            let ends = FxHashSet::from_iter([transition]);
            bars.push(Bar { page: transition.page, line, first: column, last: column, ends, opens, range: link.range });
            bars.len() - 1
        });
        let bar = &mut bars[at];
        for step in steps.iter().filter(|it| it.page == bar.page) {
            bar.first = bar.first.min(step.column);
            bar.last = bar.last.max(step.column);
            bar.ends.insert(*step);
        }
    }
    bars
}

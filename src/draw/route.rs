//! Where the nodes of a grid lie, and how lines run between them.
//!
//! A node stands in a column and a row of cells, on the axis of its column. Lines leave at its bottom and arrive at its
//! top. Between rows lie *gaps*, in which lines run sideways on tracks: those that leave the row above on upper tracks,
//! those that arrive at the row below on lower ones. Between columns lie *gutters*, in which lines run on lanes past the
//! rows that they do not concern. Where the axis of a column is free, a line takes that.
//!
//! A node with several lines at one side has a *bar* there, from which they part or at which they meet.
//!
//! **Invariant:** nodes do not overlap, lines pass through no node, and two lines share no stretch but on the bar or the
//! axis of a node that they both belong to. Time is linear but for sorting.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use super::scene::Point;

/// A node to be placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Node {
    pub column: u32,
    pub row: u32,
    /// How far it reaches to the left and to the right of the axis.
    pub left: i32,
    pub right: i32,
    pub height: i32,
    /// How far below its top a line leaves: less than the height where something hangs beside the axis.
    pub port: i32,
}

/// Distances.
#[derive(Debug, Clone, Copy)]
pub(super) struct Metrics {
    /// Least height of a gap.
    pub gap: i32,
    /// Between tracks, and between a track and a node.
    pub track: i32,
    pub lane: i32,
    /// Least distance of nodes in one row.
    pub gutter: i32,
    /// Least distance of columns.
    pub pitch: i32,
    /// How far a bar reaches beyond its lines.
    pub overhang: i32,
}

/// A bar where lines part or meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Bar {
    pub node: usize,
    /// Below the node: lines part here.
    pub is_below: bool,
    pub y: i32,
    pub from: i32,
    pub to: i32,
}

/// A line between two nodes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Line {
    pub from: usize,
    pub to: usize,
    /// From the port of the first node to the top of the second.
    pub points: Vec<Point>,
    /// It runs against the order of the rows.
    pub is_back: bool,
    /// Which part of `points` belongs to the line alone, and not to a bar: indices of the first and the last one.
    pub own: (usize, usize),
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Routed {
    /// Axis and top of each node.
    pub places: Vec<Point>,
    pub bars: Vec<Bar>,
    pub lines: Vec<Line>,
    pub width: i32,
    pub height: i32,
}

/// What a line runs along between the gap below its first node and the gap above its second one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Axis(u32),
    /// Gutter and lane.
    Gutter(u32, u32),
}

/// Intervals that are taken along one axis or in one lane.
#[derive(Debug, Default)]
struct Taken(BTreeMap<u32, u32>);

impl Taken {
    fn take(&mut self, first: u32, last: u32) -> bool {
        let before = self.0.range(..=last).next_back();
        if before.is_some_and(|it| *it.1 >= first) {
            return false;
        }
        self.0.insert(first, last);
        true
    }
}

/// Puts each interval on the first of the free tracks; of the result, the second says how many there are.
fn tracks(intervals: &[(i32, i32)], space: i32) -> (Vec<u32>, u32) {
    let mut order: Vec<usize> = (0..intervals.len()).collect();
    order.sort_by_key(|&it| (intervals[it], it));
    let mut track_of = vec![0; intervals.len()];
    let mut ends: BinaryHeap<Reverse<(i32, u32)>> = BinaryHeap::new();
    let mut free: BTreeSet<u32> = BTreeSet::new();
    let mut count = 0;
    for it in order {
        let (from, to) = intervals[it];
        while let Some(&Reverse((end, track))) = ends.peek() {
            if end.saturating_add(space) > from {
                break;
            }
            ends.pop();
            free.insert(track);
        }
        let track = free.pop_first().unwrap_or_else(|| {
            count += 1;
            count - 1
        });
        track_of[it] = track;
        ends.push(Reverse((to, track)));
    }
    (track_of, count)
}

/// Places the nodes and draws the lines. No two nodes share a cell; arcs are between different nodes, each once.
pub(super) fn route(nodes: &[Node], arcs: &[(u32, u32)], metrics: &Metrics) -> Routed {
    let columns = nodes.iter().map(|it| it.column as usize + 1).max().unwrap_or(0);
    let rows = nodes.iter().map(|it| it.row as usize + 1).max().unwrap_or(0);
    if columns == 0 {
        return Routed::default();
    }
    let mut leaving = vec![0_u32; nodes.len()];
    let mut arriving = vec![0_u32; nodes.len()];
    for &(from, to) in arcs {
        leaving[from as usize] += 1;
        arriving[to as usize] += 1;
    }
    let (ways, lanes) = ways(nodes, arcs, columns);

    let mut tall = vec![0; rows];
    for it in nodes {
        let row = it.row as usize;
        tall[row] = it.height.max(tall[row]);
    }
    let Columns { axis, gutters, width } = columns_of(nodes, arcs, &ways, &lanes, metrics);

    let x_of = |way: Way| match way {
        Way::Axis(column) => axis[column as usize],
        Way::Gutter(at, lane) => gutters[at as usize] + (pixels(lane) + 1) * metrics.lane,
    };
    let vertical: Vec<i32> = ways.iter().map(|it| x_of(*it)).collect();
    let ends: Vec<End> = (0..)
        .zip(arcs)
        .flat_map(|(line, &(from, to))| {
            let [leave, arrive] = [(from, leaving[from as usize]), (to, arriving[to as usize])].map(|(node, count)| {
                let side = if count > 1 { Side::Bar(node) } else { Side::Line(line) };
                let home = axis[nodes[node as usize].column as usize];
                End { gap: nodes[node as usize].row, side, is_below: false, home, x: vertical[line as usize] }
            });
            [End { gap: leave.gap + 1, is_below: true, ..leave }, arrive]
        })
        .collect();
    let tracks = Tracks::new(&ends, rows, metrics);

    let mut tops = Vec::with_capacity(rows);
    let mut gaps = Vec::with_capacity(rows + 1);
    let mut y = 0;
    for (gap, count) in tracks.counts.iter().enumerate() {
        let least = if gap == 0 || gap == rows { 0 } else { metrics.gap };
        let height = least.max((pixels(*count) + 1) * metrics.track * i32::from(*count > 0));
        gaps.push((y, y + height));
        y += height;
        if let Some(tall) = tall.get(gap) {
            tops.push(y);
            y += tall;
        }
    }
    let track_y = |gap: u32, is_below: bool, track: u32| {
        let (top, bottom) = gaps[gap as usize];
        let distance = (pixels(track) + 1) * metrics.track;
        if is_below { top + distance } else { bottom - distance }
    };
    let places: Vec<Point> =
        nodes.iter().map(|it| Point { x: axis[it.column as usize], y: tops[it.row as usize] }).collect();
    let mut bars: Vec<Bar> = Vec::new();
    for (&(gap, is_below, side), it) in &tracks.taken {
        if let Side::Bar(node) = side {
            let y = track_y(gap, is_below, it.track);
            bars.push(Bar { node: node as usize, is_below, y, from: it.from, to: it.to });
        }
    }
    bars.sort_by_key(|it| (it.node, it.is_below));
    let mut lines = Vec::with_capacity(arcs.len());
    for (&(from, to), ends) in arcs.iter().zip(ends.chunks_exact(2)) {
        let (from, to) = (from as usize, to as usize);
        let level = |it: &End| Some(track_y(it.gap, it.is_below, tracks.taken.get(&it.key())?.track));
        let [leave, arrive] = ends else { continue };
        let (start, end) = (places[from].moved(0, nodes[from].port), places[to]);
        let mut points = vec![start];
        let mut own = (0, 0);
        if let Some(y) = level(leave) {
            points.extend([Point { x: leave.home, y }, Point { x: leave.x, y }]);
            own.0 = if matches!(leave.side, Side::Bar(_)) { 2 } else { 0 };
        }
        if let Some(y) = level(arrive) {
            points.extend([Point { x: arrive.x, y }, Point { x: arrive.home, y }]);
        }
        points.push(end);
        own.1 = points.len() - if matches!(arrive.side, Side::Bar(_)) { 3 } else { 1 };
        lines.push(Line { from, to, points, is_back: nodes[to].row <= nodes[from].row, own });
    }
    Routed { places, bars, lines, width, height: y }
}

/// A count as a factor of distances.
fn pixels(count: u32) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX).min(i32::MAX / 1024)
}

/// What takes a track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    /// The bar of a node.
    Bar(u32),
    /// A line alone, by its arc.
    Line(u32),
}

/// One end of a line: it goes sideways in a gap, from the axis of its node to where it runs downwards.
#[derive(Debug, Clone, Copy)]
struct End {
    /// Gaps are numbered by the row below them.
    gap: u32,
    side: Side,
    /// It leaves the row above the gap; else it arrives at the one below.
    is_below: bool,
    home: i32,
    x: i32,
}

impl End {
    fn key(&self) -> (u32, bool, Side) {
        (self.gap, self.is_below, self.side)
    }
}

/// What a bar or line takes on its track.
#[derive(Debug, Clone, Copy)]
struct Taking {
    from: i32,
    to: i32,
    track: u32,
}

/// The tracks of all gaps.
struct Tracks {
    /// By gap, side of the gap, and who takes it. A line that goes straight takes none.
    taken: BTreeMap<(u32, bool, Side), Taking>,
    /// Tracks of each gap.
    counts: Vec<u32>,
}

impl Tracks {
    fn new(ends: &[End], rows: usize, metrics: &Metrics) -> Self {
        let mut taken: BTreeMap<(u32, bool, Side), Taking> = BTreeMap::new();
        for it in ends {
            let is_bar = matches!(it.side, Side::Bar(_));
            if !is_bar && it.x == it.home {
                continue;
            }
            let overhang = if is_bar { metrics.overhang } else { 0 };
            let own = taken.entry(it.key()).or_insert(Taking { from: i32::MAX, to: i32::MIN, track: 0 });
            own.from = own.from.min(it.x.min(it.home) - overhang);
            own.to = own.to.max(it.x.max(it.home) + overhang);
        }
        let mut counts = vec![0; rows + 1];
        let mut all: Vec<_> = taken.iter_mut().collect();
        for of_side in all.chunk_by_mut(|a, b| (a.0.0, a.0.1) == (b.0.0, b.0.1)) {
            let intervals: Vec<(i32, i32)> = of_side.iter().map(|it| (it.1.from, it.1.to)).collect();
            let (tracks, count) = tracks(&intervals, metrics.track);
            for (it, track) in of_side.iter_mut().zip(tracks) {
                it.1.track = track;
            }
            if let Some(first) = of_side.first() {
                counts[first.0.0 as usize] += count;
            }
        }
        Self { taken, counts }
    }
}

/// Where columns and gutters lie.
struct Columns {
    axis: Vec<i32>,
    /// Left edge of each gutter.
    gutters: Vec<i32>,
    width: i32,
}

/// Puts the columns as close as what stands in their rows lets them: a node may reach over columns that are empty in its
/// row. Where lines run through a gutter, nothing reaches over it.
fn columns_of(nodes: &[Node], arcs: &[(u32, u32)], ways: &[Way], lanes: &[u32], metrics: &Metrics) -> Columns {
    let count = lanes.len() - 1;
    // Of each column, what stands there: row, and how far it reaches to both sides.
    let mut standing: Vec<Vec<(u32, i32, i32)>> = vec![Vec::new(); count];
    for it in nodes {
        standing[it.column as usize].push((it.row, it.left, it.right));
    }
    for (&way, &(from, to)) in ways.iter().zip(arcs) {
        if let Way::Axis(column) = way {
            let (from, to) = (nodes[from as usize].row, nodes[to as usize].row);
            standing[column as usize].extend((from + 1..to).map(|row| (row, 0, 0)));
        }
    }
    let lane_width = |at: usize| (pixels(lanes[at]) + 1) * metrics.lane * i32::from(lanes[at] > 0);
    let rows = nodes.iter().map(|it| it.row as usize + 1).max().unwrap_or(0);
    // How far to the right each row is taken, and all of them.
    let mut taken = vec![i32::MIN; rows];
    let mut right = 0;
    let (mut axis, mut gutters) = (Vec::with_capacity(count), Vec::with_capacity(count + 1));
    for (column, standing) in standing.iter().enumerate() {
        let mut x = axis.last().map_or(0, |it| it + metrics.pitch);
        gutters.push(right);
        if lanes[column] > 0 {
            let left = standing.iter().map(|it| it.1).max().unwrap_or(0);
            x = x.max(right + lane_width(column) + left);
        }
        for &(row, left, _) in standing {
            let end = taken[row as usize];
            x = x.max(if end == i32::MIN { left } else { end + metrics.gutter + left });
        }
        for &(row, _, reach) in standing {
            taken[row as usize] = taken[row as usize].max(x + reach);
            right = right.max(x + reach);
        }
        axis.push(x);
    }
    gutters.push(right);
    Columns { axis, gutters, width: right + lane_width(count) }
}

/// A line over more rows than this takes a gutter: what stands in each row of an axis is kept.
const LONGEST_ON_AXIS: u32 = 256;

/// Where each line runs downwards, and how many lanes each gutter has.
fn ways(nodes: &[Node], arcs: &[(u32, u32)], columns: usize) -> (Vec<Way>, Vec<u32>) {
    let mut full: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); columns];
    for it in nodes {
        full[it.column as usize].insert(it.row);
    }
    let mut taken: Vec<Taken> = Vec::new();
    taken.resize_with(columns, Taken::default);
    let mut ways = vec![Way::Axis(0); arcs.len()];
    // Gutter, first and last gap, index of the arc.
    let mut wanted: Vec<Vec<(u32, u32, usize)>> = vec![Vec::new(); columns + 1];
    // The shortest first: who goes far finds another way.
    let mut order: Vec<usize> = (0..arcs.len()).collect();
    order.sort_by_key(|&it| {
        let (from, to) = (&nodes[arcs[it].0 as usize], &nodes[arcs[it].1 as usize]);
        (from.column != to.column, from.row.abs_diff(to.row), it)
    });
    for at in order {
        let (from, to) = (&nodes[arcs[at].0 as usize], &nodes[arcs[at].1 as usize]);
        if to.row > from.row {
            // Gaps are numbered by the row below them.
            let (first, last) = (from.row + 1, to.row);
            let is_free = |column: u32, rows: std::ops::Range<u32>| {
                rows.is_empty() || full[column as usize].range(rows).next().is_none()
            };
            let down_to = if from.column == to.column { from.row + 1 } else { from.row };
            let is_short = last - first < LONGEST_ON_AXIS;
            if is_short && is_free(to.column, down_to..to.row) && taken[to.column as usize].take(first, last) {
                ways[at] = Way::Axis(to.column);
                continue;
            }
            let is_other = from.column != to.column;
            if is_short
                && is_other
                && is_free(from.column, from.row + 1..to.row + 1)
                && taken[from.column as usize].take(first, last)
            {
                ways[at] = Way::Axis(from.column);
                continue;
            }
            let gutter = from.column.max(to.column);
            wanted[gutter as usize].push((first, last, at));
        } else {
            let gutter = from.column.min(to.column);
            wanted[gutter as usize].push((to.row, from.row + 1, at));
        }
    }
    let mut lanes = vec![0; columns + 1];
    for (gutter, list) in (0..).zip(&wanted) {
        let as_interval = |it: u32| i32::try_from(it).unwrap_or(i32::MAX);
        let intervals: Vec<(i32, i32)> = list.iter().map(|it| (as_interval(it.0), as_interval(it.1))).collect();
        let (tracks, count) = tracks(&intervals, 1);
        lanes[gutter as usize] = count;
        for (it, lane) in list.iter().zip(tracks) {
            ways[it.2] = Way::Gutter(gutter, lane);
        }
    }
    (ways, lanes)
}

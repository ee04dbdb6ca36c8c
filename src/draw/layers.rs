//! Which cell of a grid each node of a graph stands in, when nothing else says it: sequences run along the rows from the
//! first to the last, branches stand beside one another, and what branches meet at stands under the first of them. That
//! is how the manuals draw charts; callers and what they call are put in order the same way.
//!
//! The columns come from the tree of dominators: all ways to a node lead through its parent there. What belongs to one
//! branch is a block of cells, and the blocks below a node do not share cells.
//!
//! **Invariant:** no two nodes share a cell, and every arc that is not [`Layers::back`] leads to a later row.

use std::collections::VecDeque;

/// Where nodes stand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layers {
    /// Column and row of each node.
    pub cells: Vec<(u32, u32)>,
    /// Of each arc, whether it closes a cycle. The others make none.
    pub back: Vec<bool>,
}

/// Parts of a graph that nothing joins stand side by side up to so many columns.
const BAND: usize = 16;

/// Puts nodes into cells. `starts` are begun with, in their order; `floor` gives the first row that a node may take.
pub(super) fn assign(count: usize, arcs: &[(u32, u32)], starts: &[u32], floor: &[u32]) -> Layers {
    let mut after: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (at, &(from, _)) in (0..).zip(arcs) {
        after[from as usize].push(at);
    }
    let Walked { order, rank, back } = walk(count, arcs, &after, starts);
    let mut before: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (&(from, to), _) in arcs.iter().zip(&back).filter(|it| !it.1) {
        before[to as usize].push(from);
    }
    let rows = rows(arcs, &after, &before, &back, &order, floor);
    let parts = parts(count, arcs, &order);
    let mut cells = vec![(0, 0); count];
    // Parts fill a band from left to right; the next band begins below the longest of them.
    let (mut column, mut row, mut next_row) = (0_usize, 0_u32, 0_u32);
    for nodes in parts {
        let first = nodes.iter().map(|&it| rows[it as usize]).min().unwrap_or(0);
        let last = nodes.iter().map(|&it| rows[it as usize]).max().unwrap_or(0);
        let (columns, width) = columns(&nodes, &before, &rows, &rank);
        if column > 0 && column + width > BAND {
            (column, row) = (0, next_row);
        }
        // Parts begin at rows of one parity, for steps and transitions take turns.
        let (start, base) = (row + (row & 1), first & !1);
        for (&node, &at) in nodes.iter().zip(&columns) {
            cells[node as usize] = (index(column + at), start + (rows[node as usize] - base));
        }
        next_row = next_row.max(start + (last - base) + 1);
        column += width;
    }
    Layers { cells, back }
}

fn index(it: usize) -> u32 {
    u32::try_from(it).unwrap_or(u32::MAX)
}

struct Walked {
    /// Nodes in an order in which every arc leads forward but those that close a cycle.
    order: Vec<u32>,
    /// When each node was first met.
    rank: Vec<u32>,
    back: Vec<bool>,
}

/// Depth-first from the starts, then from what nothing leads to, then from what is left.
fn walk(count: usize, arcs: &[(u32, u32)], after: &[Vec<u32>], starts: &[u32]) -> Walked {
    #[derive(Clone, Copy, PartialEq, Eq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut entered = vec![false; count];
    arcs.iter().for_each(|it| entered[it.1 as usize] = true);
    let free = (0..index(count)).filter(|it| !entered[*it as usize]);
    let roots: Vec<u32> = starts.iter().copied().chain(free).chain(0..index(count)).collect();
    let mut state = vec![State::New; count];
    let mut walked = Walked { order: Vec::with_capacity(count), rank: vec![0; count], back: vec![false; arcs.len()] };
    let mut met = 0;
    for root in roots {
        if state[root as usize] != State::New {
            continue;
        }
        let mut stack = vec![(root, 0)];
        while let Some((node, next)) = stack.last_mut() {
            let node = *node;
            if state[node as usize] == State::New {
                state[node as usize] = State::Open;
                walked.rank[node as usize] = met;
                met += 1;
            }
            let Some(&arc) = after[node as usize].get(*next) else {
                state[node as usize] = State::Done;
                walked.order.push(node);
                stack.pop();
                continue;
            };
            *next += 1;
            let to = arcs[arc as usize].1;
            match state[to as usize] {
                State::New => stack.push((to, 0)),
                State::Open => walked.back[arc as usize] = true,
                State::Done => {}
            }
        }
    }
    walked.order.reverse();
    walked
}

/// The longest way to each node.
fn rows(
    arcs: &[(u32, u32)],
    after: &[Vec<u32>],
    before: &[Vec<u32>],
    back: &[bool],
    order: &[u32],
    floor: &[u32],
) -> Vec<u32> {
    let mut rows = floor.to_vec();
    for &node in order {
        for &arc in after[node as usize].iter().filter(|it| !back[**it as usize]) {
            let to = arcs[arc as usize].1 as usize;
            rows[to] = rows[to].max(rows[node as usize] + 1);
        }
    }
    // What nothing leads to stands just above what it leads to.
    for &node in order.iter().filter(|it| before[**it as usize].is_empty()) {
        let next = after[node as usize].iter().filter(|it| !back[**it as usize]);
        let nearest = next.map(|it| rows[arcs[*it as usize].1 as usize]).min();
        rows[node as usize] = nearest.map_or(rows[node as usize], |it| it.saturating_sub(1).max(rows[node as usize]));
    }
    rows
}

/// Nodes that arcs join, each part in topological order; the parts by their first node.
fn parts(count: usize, arcs: &[(u32, u32)], order: &[u32]) -> Vec<Vec<u32>> {
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); count];
    for &(from, to) in arcs {
        beside[from as usize].push(to);
        beside[to as usize].push(from);
    }
    let mut part_of: Vec<Option<usize>> = vec![None; count];
    let mut parts: Vec<Vec<u32>> = Vec::new();
    for node in 0..index(count) {
        if part_of[node as usize].is_some() {
            continue;
        }
        part_of[node as usize] = Some(parts.len());
        let mut open = VecDeque::from([node]);
        while let Some(at) = open.pop_front() {
            for &next in &beside[at as usize] {
                if part_of[next as usize].is_none() {
                    part_of[next as usize] = Some(parts.len());
                    open.push_back(next);
                }
            }
        }
        parts.push(Vec::new());
    }
    for &node in order {
        if let Some(part) = part_of[node as usize].and_then(|it| parts.get_mut(it)) {
            part.push(node);
        }
    }
    parts
}

/// The cells of a node with all that it dominates.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    /// Column of the node in the block of its parent.
    offset: usize,
    width: usize,
    /// Last row.
    last: u32,
}

/// Columns of the nodes of one part, which are in topological order, and how many there are.
fn columns(nodes: &[u32], before: &[Vec<u32>], rows: &[u32], rank: &[u32]) -> (Vec<usize>, usize) {
    // Positions in `nodes`, counted from 1: 0 is above all.
    let position: rustc_hash::FxHashMap<u32, usize> = nodes.iter().copied().zip(1..).collect();
    let preds: Vec<Vec<usize>> = std::iter::once(Vec::new())
        .chain(nodes.iter().map(|it| before[*it as usize].iter().filter_map(|it| position.get(it).copied()).collect()))
        .collect();
    let (parent, mut children) = dominators(&preds);
    // Branches from left to right as they were met.
    let rank_of = |it: usize| it.checked_sub(1).map(|it| rank[nodes[it] as usize]);
    children.iter_mut().for_each(|it| it.sort_by_key(|it| rank_of(*it)));
    // Numbers in the order in which the tree is entered, with the last one below each node.
    let mut entered = vec![(0, 0); preds.len()];
    let mut count = 0;
    let mut stack = vec![(0, false)];
    while let Some((node, done)) = stack.pop() {
        if done {
            entered[node].1 = count - 1;
            continue;
        }
        entered[node].0 = count;
        count += 1;
        stack.push((node, true));
        stack.extend(children[node].iter().rev().map(|it| (*it, false)));
    }
    let row_of = |it: usize| it.checked_sub(1).map_or(0, |it| rows[nodes[it] as usize]);
    let mut blocks = vec![Block::default(); preds.len()];
    // Parents come before their children.
    for node in (0..preds.len()).rev() {
        let (mut width, mut last) = (0, row_of(node));
        // Last row that is taken in each column.
        let mut taken: Vec<Option<u32>> = Vec::new();
        let (branches, mut joins): (Vec<usize>, Vec<usize>) =
            children[node].iter().partition(|it| preds[**it].len() < 2);
        let has_joins = !joins.is_empty();
        for &it in &branches {
            blocks[it].offset = width;
            width += blocks[it].width;
            last = last.max(blocks[it].last);
            if has_joins {
                taken.resize(width, Some(blocks[it].last));
            }
        }
        joins.sort_by_key(|&it| (row_of(it), it));
        for it in joins {
            // The branches that lead here begin with children of the same node.
            let from = preds[it].iter().filter(|it| **it != node).filter_map(|&pred| {
                let at = children[node].partition_point(|it| entered[*it].0 <= entered[pred].0);
                let child = *children[node].get(at.checked_sub(1)?)?;
                (entered[pred].0 <= entered[child].1).then_some(blocks[child].offset)
            });
            let mut at = from.min().unwrap_or(0);
            let size = blocks[it].width;
            let is_free = |column: usize| taken.get(column).copied().flatten().is_none_or(|last| last < row_of(it));
            while let Some(wrong) = (at..at + size).rev().find(|it| !is_free(*it)) {
                at = wrong + 1;
            }
            blocks[it].offset = at;
            width = width.max(at + size);
            last = last.max(blocks[it].last);
            taken.resize(width, None);
            taken[at..at + size].fill(Some(blocks[it].last));
        }
        blocks[node].width = width.max(1);
        blocks[node].last = last;
    }
    let mut columns = vec![0; preds.len()];
    for node in 1..preds.len() {
        columns[node] = columns[parent[node]] + blocks[node].offset;
    }
    columns.remove(0);
    (columns, blocks[0].width)
}

/// The node through which all ways to each node lead, and the other way round. Nodes come in topological order; those
/// without predecessors hang under node 0.
fn dominators(preds: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut parent = vec![0; preds.len()];
    let mut depth = vec![0_u32; preds.len()];
    let mut children = vec![Vec::new(); preds.len()];
    for node in 1..preds.len() {
        let mut common: Option<usize> = None;
        for &pred in &preds[node] {
            common = Some(match common {
                None => pred,
                Some(mut a) => {
                    let mut b = pred;
                    while a != b {
                        if depth[a] >= depth[b] {
                            a = parent[a];
                        } else {
                            b = parent[b];
                        }
                    }
                    a
                }
            });
        }
        parent[node] = common.unwrap_or(0);
        depth[node] = depth[parent[node]] + 1;
        children[parent[node]].push(node);
    }
    (parent, children)
}

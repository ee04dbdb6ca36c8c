//! The shape of the call graph: cycles and depth. Calls are named by their index in [`ProgramIndex::calls`].

use rustc_hash::FxHashSet;

use super::program::ProgramIndex;
use crate::model::unit::Callee;

/// The calls that lead out of each unit to another unit of the program, in the order of the code, one for each callee.
fn callees(program: &ProgramIndex<'_>) -> Vec<Vec<u32>> {
    let mut callees: Vec<Vec<u32>> = vec![Vec::new(); program.units.len()];
    // Of each unit, the last one that was seen to call it: calls of one unit stand together.
    let mut caller = vec![None; program.units.len()];
    for (index, call) in (0..).zip(&program.calls) {
        let Some(target) = call.target.filter(|_| call.it.reachable) else { continue };
        if caller[target as usize].replace(call.unit) != Some(call.unit) {
            callees[call.unit as usize].push(index);
        }
    }
    callees
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    /// On the way from the root to here.
    Open,
    Done,
}

/// Walks the graph depth-first from every unit, in the order of execution. `close` is given each call that leads back
/// into the way, with the calls of the way from its target on. Returns the units in the order in which they were done:
/// callees first, cycles cut where they close.
fn walk(program: &ProgramIndex<'_>, callees: &[Vec<u32>], mut close: impl FnMut(&[u32], u32)) -> Vec<u32> {
    let mut roots: Vec<u32> = (0..).zip(&program.units).map(|it| it.0).collect();
    roots.sort_by_key(|&it| program.order[it as usize]);
    let mut state = vec![State::New; program.units.len()];
    let mut done = Vec::with_capacity(roots.len());
    for root in roots {
        if state[root as usize] != State::New {
            continue;
        }
        state[root as usize] = State::Open;
        // The way: units with the number of their calls already followed, and the calls between them.
        let mut way = vec![(root, 0_usize)];
        let mut steps: Vec<u32> = Vec::new();
        while let Some((unit, next)) = way.last_mut() {
            let unit = *unit;
            let Some(&call) = callees[unit as usize].get(*next) else {
                state[unit as usize] = State::Done;
                done.push(unit);
                way.pop();
                steps.pop();
                continue;
            };
            *next += 1;
            let Some(target) = program.calls[call as usize].target else { continue };
            match state[target as usize] {
                State::New => {
                    state[target as usize] = State::Open;
                    way.push((target, 0));
                    steps.push(call);
                }
                State::Open => {
                    let from = way.iter().position(|it| it.0 == target).unwrap_or_default();
                    close(&steps[from..], call);
                }
                State::Done => {}
            }
        }
    }
    done
}

/// Cycles of calls, each as its calls in order; the last leads back to the unit of the first. Every unit that can come
/// back to itself is on a reported cycle or calls into one.
pub fn cycles(program: &ProgramIndex<'_>) -> Vec<Vec<u32>> {
    /// No program that anybody wrote has so many.
    const MOST: usize = 256;
    let mut cycles = Vec::new();
    walk(program, &callees(program), |steps, call| {
        if cycles.len() < MOST {
            let mut cycle = steps.to_vec();
            cycle.push(call);
            cycles.push(cycle);
        }
    });
    cycles
}

/// Chains of calls that start in a unit that the system runs and have `limit` + 1 calls: the shortest part of a longest
/// chain that is too deep, one for each call that goes beyond the limit.
pub fn too_deep(program: &ProgramIndex<'_>, limit: u32) -> Vec<Vec<u32>> {
    // A DFB calls nothing (PL7:5480-5487), and its call is no level of subroutines (PL7:1964).
    let mut callees = callees(program);
    let is_instance = |call: u32| matches!(program.calls[call as usize].it.callee, Callee::Instance(_));
    callees.iter_mut().for_each(|it| it.retain(|&call| !is_instance(call)));
    let mut back = FxHashSet::default();
    let done = walk(program, &callees, |_, call| {
        back.insert(call);
    });
    // Longest chain into each unit; callers come before their callees.
    let mut deepest: Vec<Option<(u32, Option<u32>)>> = vec![None; program.units.len()];
    for &unit in done.iter().rev() {
        if deepest[unit as usize].is_none() && program.is_entry(unit) {
            deepest[unit as usize] = Some((0, None));
        }
        let Some((depth, _)) = deepest[unit as usize] else { continue };
        for &call in &callees[unit as usize] {
            let Some(target) = program.calls[call as usize].target.filter(|_| !back.contains(&call)) else { continue };
            let known = &mut deepest[target as usize];
            if known.is_none_or(|it| it.0 < depth + 1) {
                *known = Some((depth + 1, Some(call)));
            }
        }
    }
    let mut chains = Vec::new();
    for (unit, known) in (0_u32..).zip(&deepest) {
        if known.is_none_or(|it| it.0 != limit) {
            continue;
        }
        for &call in callees[unit as usize].iter().filter(|it| !back.contains(it)) {
            let mut chain = vec![call];
            let mut at = unit;
            while let Some((_, Some(up))) = deepest[at as usize] {
                chain.push(up);
                at = program.calls[up as usize].unit;
            }
            chain.reverse();
            chains.push(chain);
        }
    }
    chains
}

//! Streams of initial conditions, sorted into blocks, each of which is computed as soon as it is full.

use super::block::{Block, StepCounts};
use super::block_key::{BlockKey, BlockKeys};
use super::{InitialCondition, Method, OutputSet};
use crate::numerics::{Unit, WIDTH};

/// Integrates the trajectories of `conditions` on this thread. Calls `take` with the index and the outputs of each, in any order. Only
/// trajectories with equal keys share a block, so that each output is as if computed alone.
pub fn shoot<'a, O: OutputSet>(
    unit: Unit,
    method: Method,
    conditions: impl Iterator<Item = InitialCondition<'a>>,
    mut take: impl FnMut(usize, &O),
) {
    let mut compute = |key: BlockKey, members: &mut Vec<(usize, InitialCondition<'a>)>| {
        let block = Block::new(method, members.len(), |i| &members[i].1);
        let outputs = O::shoot(unit.for_count(members.len()), key, &block);
        for ((i, _), output) in members.iter().zip(&outputs) {
            take(*i, output);
        }
        members.clear();
    };
    let mut keys = BlockKeys::default();
    let mut open: Vec<Vec<(usize, InitialCondition)>> = Vec::new();
    let mut next: Vec<InitialCondition> = Vec::with_capacity(WIDTH);
    let mut conditions = conditions.fuse();
    let mut from = 0;
    loop {
        next.extend(conditions.by_ref().take(WIDTH));
        if next.is_empty() {
            break;
        }
        let block = &Block::new(method, next.len(), |i| &next[i]);
        let steps = unit.run(StepCounts(block));
        for (i, (condition, steps)) in (from..).zip(next.drain(..).zip(steps)) {
            let key = BlockKey::new(method, &condition, steps);
            let index = keys.index(key);
            if index == open.len() {
                open.push(Vec::with_capacity(WIDTH));
            }
            let members = &mut open[index];
            members.push((i, condition));
            if members.len() == WIDTH {
                compute(key, members);
            }
        }
        from += WIDTH;
    }
    for (key, members) in keys.all.iter().zip(&mut open) {
        if !members.is_empty() {
            compute(*key, members);
        }
    }
}

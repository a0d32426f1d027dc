//! Conditions as they come, sorted into blocks that are computed as soon as they are full.

use super::block_key::{BlockKey, BlockKeys};
use super::kernel::{Block, Steps};
use super::{InitialCondition, Method, OutputSet};
use crate::numerics::{Unit, WIDTH};

/// Shoots `conditions` on this thread, and hands the outputs of each on with its index, in no order. Only trajectories with one
/// key share a block, so that each is as if computed alone.
pub fn shoot<'a, O: OutputSet>(
    unit: Unit,
    method: Method,
    conditions: impl Iterator<Item = InitialCondition<'a>>,
    mut take: impl FnMut(usize, &O),
) {
    let mut compute = |key: BlockKey, members: &mut Vec<(usize, InitialCondition<'a>)>| {
        let block = Block::new(method, members.len(), |i| &members[i].1);
        let outputs = O::shoot(unit, key, &block);
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
        let steps = unit.run(Steps(block));
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

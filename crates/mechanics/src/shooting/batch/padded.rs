//! Padded batches: small batches whose trajectories have many different numbers of steps.
//!
//! All trajectories of a block take the steps of its most demanding one. Outputs depend on the whole batch, but not on the number
//! of threads.

use super::block::{Block, StepCounts};
use super::block_key::BlockKey;
use super::{InitialCondition, Method, OutputSet, SMALLEST_CHUNK};
use crate::numerics::{Unit, WIDTH};
use rayon::prelude::*;

/// Computes the `outputs` of `conditions`, `[condition]`, each in at least the number of steps that it takes alone.
pub fn shoot<O: OutputSet>(
    unit: Unit,
    method: Method,
    conditions: &[InitialCondition],
    outputs: &mut [O],
) {
    let mut members: Vec<(BlockKey, usize)> = Vec::with_capacity(conditions.len());
    for conditions in conditions.chunks(WIDTH) {
        let block = &Block::new(method, conditions.len(), |i| &conditions[i]);
        let steps = unit.run(StepCounts(block));
        for (condition, steps) in conditions.iter().zip(steps) {
            members.push((BlockKey::new(method, condition, steps), members.len()));
        }
    }
    members.sort_unstable();
    let blocks: Vec<&[(BlockKey, usize)]> = members
        .chunk_by(|(a, _), (b, _)| a.may_pad(b))
        .flat_map(|group| group.chunks(WIDTH))
        .collect();
    let compute = |members: &&[(BlockKey, usize)]| {
        let (most_steps, _) = members[members.len() - 1];
        let block = Block::new(method, members.len(), |i| &conditions[members[i].1]);
        O::shoot(unit.for_count(members.len()), most_steps, &block)
    };
    let mut keep = |members: &[(BlockKey, usize)], computed: [O; WIDTH]| {
        for ((_, i), output) in members.iter().zip(computed) {
            outputs[*i] = output;
        }
    };
    if conditions.len() <= SMALLEST_CHUNK {
        for members in &blocks {
            keep(members, compute(members));
        }
    } else {
        let computed: Vec<_> = blocks.par_iter().map(compute).collect();
        for (members, computed) in blocks.iter().zip(computed) {
            keep(members, computed);
        }
    }
}

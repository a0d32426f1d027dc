//! Padded batches: small batches whose trajectories have many different numbers of steps.
//!
//! All trajectories of a block take the steps of its most demanding one. Outputs depend on the whole batch, but not on the number
//! of threads.

use super::block::{Block, StepCounts};
use super::block_key::{BlockKey, BlockKeys};
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
    let mut keys = BlockKeys::default();
    let mut members: Vec<(usize, usize)> = Vec::with_capacity(conditions.len());
    for conditions in conditions.chunks(WIDTH) {
        let block = &Block::new(method, conditions.len(), |i| &conditions[i]);
        let steps = unit.run(StepCounts(block));
        for (condition, steps) in conditions.iter().zip(steps) {
            let key = keys.index(BlockKey::new(method, condition, steps));
            members.push((key, members.len()));
        }
    }
    // Members are sorted by the rank of their keys: keys are few, and slow to compare.
    let mut sorted = keys.all.clone();
    sorted.sort_unstable();
    let ranks: Vec<usize> =
        (keys.all.iter()).map(|key| sorted.partition_point(|other| other < key)).collect();
    for (key, _) in &mut members {
        *key = ranks[*key];
    }
    members.sort_unstable();
    let blocks: Vec<&[(usize, usize)]> = members
        .chunk_by(|(a, _), (b, _)| a == b || sorted[*a].may_pad(&sorted[*b]))
        .flat_map(|group| group.chunks(WIDTH))
        .collect();
    let compute = |members: &&[(usize, usize)]| {
        let (most_steps, _) = members[members.len() - 1];
        let block = Block::new(method, members.len(), |i| &conditions[members[i].1]);
        O::shoot(unit.for_count(members.len()), sorted[most_steps], &block)
    };
    let mut keep = |members: &[(usize, usize)], computed: [O; WIDTH]| {
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

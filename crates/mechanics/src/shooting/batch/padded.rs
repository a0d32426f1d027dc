//! Small batches that are always the same: what a sheet is made of.
//!
//! A few dozen trajectories of many numbers of steps would leave most lanes of their blocks empty. Here a block takes the
//! steps of its most demanding member, so that an answer depends, by less than its error, on the whole batch; not on
//! the number of threads.

use super::dispatch::Steps;
use super::{BlockKind, FEWEST_TOGETHER, InitialCondition, Kernel, Kinds, Method};
use crate::numerics::Unit;
use crate::numerics::WIDTH;
use crate::shooting::Integrator;
use rayon::prelude::*;

/// Computes `K` for every condition with the integrator `M`, on all threads of the current pool, each in at least the steps that
/// [`shoot`](super::shoot) would take.
#[must_use]
pub fn shoot_padded<M: Integrator, K: Kernel<M>>(
    method: Method,
    conditions: &[InitialCondition],
) -> Vec<K::Answer> {
    let unit = Unit::detect();
    let mut kinds = Kinds::default();
    let mut places = Vec::with_capacity(conditions.len());
    for conditions in conditions.chunks(WIDTH) {
        let lane = |lane: usize| &conditions[lane.min(conditions.len() - 1)];
        let steps = unit.run(Steps {
            method,
            conditions: &std::array::from_fn(lane),
        });
        for (condition, steps) in conditions.iter().zip(steps) {
            places.push(kinds.place(BlockKind::new(method, condition, steps)));
        }
    }
    let mut kinds: Vec<(BlockKind, usize)> = kinds.all.into_iter().zip(0..).collect();
    kinds.sort_unstable();
    let mut members = Vec::with_capacity(conditions.len());
    for (kind, place) in kinds {
        let of_kind = places.iter().zip(0..).filter(|(other, _)| **other == place);
        members.extend(of_kind.map(|(_, i)| (kind, i)));
    }
    let blocks: Vec<&[(BlockKind, usize)]> = members
        .chunk_by(|(a, _), (b, _)| a.may_join(b))
        .flat_map(|group| group.chunks(WIDTH))
        .collect();
    let compute = |block: &&[(BlockKind, usize)]| {
        let (kind, _) = block[block.len() - 1];
        let lane = |lane: usize| &conditions[block[lane.min(block.len() - 1)].1];
        let lanes = std::array::from_fn(lane);
        K::block(unit, kind.effects, kind.steps, &lanes, block.len())
    };
    let mut answers = vec![K::Answer::default(); conditions.len()];
    let mut keep = |block: &[(BlockKind, usize)], computed: [K::Answer; WIDTH]| {
        for ((_, i), answer) in block.iter().zip(computed) {
            answers[*i] = answer;
        }
    };
    if conditions.len() <= FEWEST_TOGETHER {
        for block in &blocks {
            keep(block, compute(block));
        }
    } else {
        let computed: Vec<_> = blocks.par_iter().map(compute).collect();
        for (block, computed) in blocks.iter().zip(computed) {
            keep(block, computed);
        }
    }
    answers
}

//! Small batches that are always the same: what a sheet is made of.
//!
//! A few dozen trajectories of many numbers of steps would leave most lanes of their blocks empty. Here a block takes the
//! steps of its most demanding member, so that an answer depends, by less than its error, on the whole batch; not on
//! the number of threads.

use super::{BlockKind, FEWEST_TOGETHER, Kernel, Kinds, Launch, Method, Unit};
use crate::model::Integrator;
use crate::model::simd::WIDTH;
use rayon::prelude::*;

/// Computes `K` for every launch with the integrator `M`, on all threads of the current pool, each in at least the steps that
/// [`land`](super::land) would take.
#[must_use]
pub fn land_in_company<M: Integrator, K: Kernel<M>>(
    method: Method,
    launches: &[Launch],
) -> Vec<K::Answer> {
    let unit = Unit::detect();
    let mut kinds = Kinds::default();
    let mut of_kind: Vec<Vec<usize>> = Vec::new();
    for (block, launches) in launches.chunks(WIDTH).enumerate() {
        let lane = |lane: usize| &launches[lane.min(launches.len() - 1)];
        let steps = unit.steps(method, &std::array::from_fn(lane));
        for (i, (launch, steps)) in (block * WIDTH..).zip(launches.iter().zip(steps)) {
            let place = kinds.place(BlockKind::new(method, launch, steps));
            if place == of_kind.len() {
                of_kind.push(Vec::new());
            }
            of_kind[place].push(i);
        }
    }
    let mut kinds: Vec<(BlockKind, Vec<usize>)> = kinds.all.into_iter().zip(of_kind).collect();
    kinds.sort_unstable_by_key(|(kind, _)| *kind);
    let members = kinds
        .iter()
        .flat_map(|(kind, all)| all.iter().map(move |i| (*kind, *i)));
    let members: Vec<(BlockKind, usize)> = members.collect();
    let blocks: Vec<&[(BlockKind, usize)]> = members
        .chunk_by(|(a, _), (b, _)| a.may_join(b))
        .flat_map(|group| group.chunks(WIDTH))
        .collect();
    let compute = |block: &&[(BlockKind, usize)]| {
        let (kind, _) = block[block.len() - 1];
        let lane = |lane: usize| &launches[block[lane.min(block.len() - 1)].1];
        let lanes = std::array::from_fn(lane);
        K::block(unit, kind.effects, kind.steps, &lanes, block.len())
    };
    let mut answers = vec![K::Answer::default(); launches.len()];
    let mut keep = |block: &[(BlockKind, usize)], computed: [K::Answer; WIDTH]| {
        for ((_, i), answer) in block.iter().zip(computed) {
            answers[*i] = answer;
        }
    };
    if launches.len() <= FEWEST_TOGETHER {
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

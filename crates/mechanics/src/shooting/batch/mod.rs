//! Thousands of trajectories in `f64`: lanes of the widest SIMD unit that the machine has, on all cores.
//!
//! The integrator is generic and inlined whole into three functions compiled for AVX-512, for AVX2 with FMA,
//! and for the target's baseline (`unit`); which one runs is decided once per call from the processor's features.
//! Results do not depend on the number of threads: every trajectory is computed by itself, or in company that does not (`company`).

mod dispatch;
mod flops;
mod gather;
mod kernel;
mod output;
mod padded;
mod pole;

pub use dispatch::Kernel;
pub use flops::flops;
pub use output::{Derived, First, FirstAndEnergy, Kind, Second};
pub use padded::shoot_padded;

use super::{Integrator, Resolution};
use crate::numerics::{Unit, WIDTH};
use crate::rod::{Effects, Rod};
use dispatch::Steps;
use rayon::prelude::*;
use std::borrow::Borrow;

/// One trajectory: from the contact at `tau` under `load = f/radius^2` to the base.
#[derive(Clone, Copy, Debug)]
pub struct InitialCondition {
    /// The rod.
    pub rod: Rod,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// How a batch integrates.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The effects of every rod in the batch.
    pub effects: Effects,
    /// How finely.
    pub resolution: Resolution,
}

impl Method {
    /// At [`Resolution::FINE`].
    #[must_use]
    pub const fn fine(effects: Effects) -> Self {
        Self {
            effects,
            resolution: Resolution::FINE,
        }
    }

    /// The same at [`Resolution::COARSE`].
    #[must_use]
    pub const fn coarsely(self) -> Self {
        Self {
            resolution: Resolution::COARSE,
            ..self
        }
    }
}

/// The fewest conditions for a thread, so that most of its blocks are full.
const FEWEST_TOGETHER: usize = 1024;

/// Parts of a batch for each thread, so that threads end together.
const PARTS: usize = 4;

/// How many of `count` a thread of the current pool best works on together.
#[must_use]
pub fn together(count: usize) -> usize {
    let threads = rayon::current_num_threads();
    let parts = if threads == 1 { 1 } else { PARTS * threads };
    count.div_ceil(parts).max(FEWEST_TOGETHER)
}

/// Computes `K` for every condition with the integrator `M`, on all threads of the current pool.
#[must_use]
pub fn shoot<M: Integrator, K: Kernel<M>>(
    method: Method,
    conditions: &[InitialCondition],
) -> Vec<K::Answer> {
    shoot_on::<M, K>(Unit::detect(), method, conditions)
}

/// The same on a given unit.
#[must_use]
pub fn shoot_on<M: Integrator, K: Kernel<M>>(
    unit: Unit,
    method: Method,
    conditions: &[InitialCondition],
) -> Vec<K::Answer> {
    let mut answers = vec![K::Answer::default(); conditions.len()];
    let together = together(conditions.len());
    if conditions.len() <= together {
        part::<M, K>(unit, method, conditions, &mut answers);
    } else {
        answers
            .par_chunks_mut(together)
            .zip(conditions.par_chunks(together))
            .for_each(|(answers, conditions)| part::<M, K>(unit, method, conditions, answers));
    }
    answers
}

/// The same on this thread.
fn part<M: Integrator, K: Kernel<M>>(
    unit: Unit,
    method: Method,
    conditions: &[InitialCondition],
    answers: &mut [K::Answer],
) {
    stream::<M, K, _>(unit, method, conditions.iter(), |i, answer| {
        answers[i] = *answer
    });
}

/// Computes `K` for conditions as they come, on this thread, and hands each answer on with the place of its condition, in no order.
pub fn shoot_each<M: Integrator, K: Kernel<M>>(
    method: Method,
    conditions: impl Iterator<Item = InitialCondition>,
    take: impl FnMut(usize, &K::Answer),
) {
    stream::<M, K, _>(Unit::detect(), method, conditions, take);
}

fn stream<M: Integrator, K: Kernel<M>, L: Borrow<InitialCondition>>(
    unit: Unit,
    method: Method,
    conditions: impl Iterator<Item = L>,
    mut take: impl FnMut(usize, &K::Answer),
) {
    let mut compute = |kind: BlockKind, block: &mut Vec<(usize, L)>| {
        let lane = |lane: usize| block[lane.min(block.len() - 1)].1.borrow();
        let lanes = std::array::from_fn(lane);
        let answers = K::block(unit, kind.effects, kind.steps, &lanes, block.len());
        for ((i, _), answer) in block.iter().zip(&answers) {
            take(*i, answer);
        }
        block.clear();
    };
    // Lanes step together, so only trajectories of one kind share a block: company changes nothing.
    let mut kinds = Kinds::default();
    let mut open: Vec<Vec<(usize, L)>> = Vec::new();
    let mut next: Vec<L> = Vec::with_capacity(WIDTH);
    let mut conditions = conditions.fuse();
    let mut from = 0;
    loop {
        next.extend(conditions.by_ref().take(WIDTH));
        let Some(last) = next.len().checked_sub(1) else {
            break;
        };
        let conditions = &std::array::from_fn(|lane| next[lane.min(last)].borrow());
        let steps = unit.run(Steps { method, conditions });
        for (i, (condition, steps)) in (from..).zip(next.drain(..).zip(steps)) {
            let kind = BlockKind::new(method, condition.borrow(), steps);
            let place = kinds.place(kind);
            if place == open.len() {
                open.push(Vec::with_capacity(WIDTH));
            }
            let block = &mut open[place];
            block.push((i, condition));
            if block.len() == WIDTH {
                compute(kind, block);
            }
        }
        from += WIDTH;
    }
    for (kind, block) in kinds.all.iter().zip(&mut open) {
        if !block.is_empty() {
            compute(*kind, block);
        }
    }
}

/// What trajectories of a block have in common.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct BlockKind {
    effects: Effects,
    /// Of a profile.
    piece: usize,
    steps: u32,
}

impl BlockKind {
    /// That of a condition from arclength `s` that takes so many `steps`.
    #[inline]
    fn new(
        method: Method,
        InitialCondition { rod, tau, .. }: &InitialCondition,
        (s, steps): (f64, u32),
    ) -> Self {
        Self {
            effects: method.effects.reaching(rod.taper * tau),
            piece: rod.piece(s),
            steps,
        }
    }

    /// Whether the two can share a block that takes the steps of the one that needs more.
    fn may_join(&self, other: &Self) -> bool {
        (self.effects, self.piece) == (other.effects, other.piece)
    }
}

/// The kinds of a batch.
struct Kinds {
    all: Vec<BlockKind>,
    /// Where the last one with as many steps on such a piece is, give or take multiples of 64.
    likely: [usize; 64],
}

impl Default for Kinds {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            likely: [0; 64],
        }
    }
}

impl Kinds {
    /// Where `kind` is among all; it is the last one if it is new.
    #[inline]
    fn place(&mut self, kind: BlockKind) -> usize {
        let likely = &mut self.likely[(kind.steps as usize + 7 * kind.piece) % 64];
        if self.all.get(*likely) != Some(&kind) {
            let place = self.all.iter().position(|other| *other == kind);
            *likely = place.unwrap_or_else(|| {
                self.all.push(kind);
                self.all.len() - 1
            });
        }
        *likely
    }
}

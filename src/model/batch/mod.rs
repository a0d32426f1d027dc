//! Thousands of trajectories in `f64`: lanes of the widest SIMD unit that the machine has, on all cores.
//!
//! The integrator is generic and inlined whole into three functions compiled for AVX-512, for AVX2 with FMA,
//! and for the target's baseline (`unit`); which one runs is decided once per call from the processor's features.
//! Results do not depend on the number of threads: every trajectory is computed by itself.

mod flops;
mod gather;
mod kernel;
mod peak;
mod unit;

pub use flops::flops;
pub use unit::{Kernel, Unit};

use super::integrator::{Integrator, Resolution};
use super::landing::{Curved, Full, Landing};
use super::order::{First, FirstAndEnergy, Order, Second};
use super::rhs::Planar;
use super::simd::WIDTH;
use super::{Effects, Rod, Start};
use rayon::prelude::*;

/// One trajectory: from the contact at `tau` under `load = f/radius^2` to the base.
#[derive(Clone, Copy, Debug)]
pub struct Launch {
    /// The rod.
    pub rod: Rod,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// What a batch computes per trajectory, and the derivatives it carries for that.
pub trait Kind<const N: usize>: Order<N> + 'static {
    /// The answer.
    type Answer: Copy + Send;

    /// The answer from the final state.
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; N]) -> Self::Answer;
}

impl Kind<6> for First {
    type Answer = Landing;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 6]) -> Landing {
        Landing::new(rod, start, state, sens)
    }
}

impl Kind<7> for FirstAndEnergy {
    type Answer = Full;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 7]) -> Full {
        Full::new(rod, start, state, sens)
    }
}

impl Kind<15> for Second {
    type Answer = Curved;
    fn answer(rod: &Rod, start: &Start, state: &Planar<f64>, sens: &[f64; 15]) -> Curved {
        Curved::new(rod, start, state, sens)
    }
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

/// Blocks per piece of work that one thread takes: long enough to hide the hand-over, short enough to share. A batch
/// that is one piece stays on the thread that asks for it.
const BLOCKS_PER_TASK: usize = 16;

/// Computes `K` for every launch with the integrator `M`, on all threads of the current pool.
#[must_use]
pub fn land<M: Integrator, K: Kernel<M, N>, const N: usize>(
    method: Method,
    launches: &[Launch],
) -> Vec<K::Answer> {
    land_on::<M, K, N>(Unit::detect(), method, launches)
}

/// The same on a given unit.
#[must_use]
pub fn land_on<M: Integrator, K: Kernel<M, N>, const N: usize>(
    unit: Unit,
    method: Method,
    launches: &[Launch],
) -> Vec<K::Answer> {
    // Lanes step together, so only trajectories of equally many steps share a block: company changes nothing.
    let work: Vec<(u32, usize)> = launches
        .iter()
        .map(|Launch { rod, tau, .. }| (method.resolution.steps(rod, *tau), rod.piece(*tau)))
        .collect();
    let mut order: Vec<usize> = (0..launches.len()).collect();
    order.sort_by_key(|&i| work[i]);
    let blocks: Vec<&[usize]> = order
        .chunk_by(|&i, &j| work[i] == work[j])
        .flat_map(|equal| equal.chunks(WIDTH))
        .collect();
    let run = |block: &&[usize]| {
        let lane = |i: usize| launches[block[i.min(block.len() - 1)]];
        let lanes: [Launch; WIDTH] = std::array::from_fn(lane);
        K::block(unit, method.effects, work[block[0]].0, &lanes)
    };
    let landed: Vec<[K::Answer; WIDTH]> = if blocks.len() <= BLOCKS_PER_TASK {
        blocks.iter().map(run).collect()
    } else {
        let tasks = blocks.par_iter().with_min_len(BLOCKS_PER_TASK);
        tasks.map(run).collect()
    };
    let mut places = vec![(0, 0); launches.len()];
    for (b, block) in blocks.iter().enumerate() {
        for (lane, &i) in block.iter().enumerate() {
            places[i] = (b, lane);
        }
    }
    places
        .into_iter()
        .map(|(b, lane)| landed[b][lane])
        .collect()
}

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
use super::landing::{Curved, Full, Landing, Pressed};
use super::order::{First, FirstAndEnergy, Order, Second};
use super::rhs::Planar;
use super::simd::WIDTH;
use super::{Effects, Rod};
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
    fn answer(rod: &Rod, pressed: Pressed, state: &Planar<f64>, sens: &[f64; N]) -> Self::Answer;
}

impl Kind<6> for First {
    type Answer = Landing;
    fn answer(rod: &Rod, pressed: Pressed, state: &Planar<f64>, sens: &[f64; 6]) -> Landing {
        Landing::new(rod, pressed, state, sens)
    }
}

impl Kind<7> for FirstAndEnergy {
    type Answer = Full;
    fn answer(rod: &Rod, pressed: Pressed, state: &Planar<f64>, sens: &[f64; 7]) -> Full {
        Full::new(rod, pressed, state, sens)
    }
}

impl Kind<15> for Second {
    type Answer = Curved;
    fn answer(rod: &Rod, pressed: Pressed, state: &Planar<f64>, sens: &[f64; 15]) -> Curved {
        Curved::new(rod, pressed, state, sens)
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

/// Launches that are sorted into blocks together: enough for full blocks, few enough to stay in the cache.
const FEWEST_TOGETHER: usize = 512;
const MOST_TOGETHER: usize = 4096;

/// Parts of a batch for each thread, so that threads end together.
const PARTS: usize = 4;

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
    let parts = PARTS * rayon::current_num_threads();
    let together = (launches.len() / parts).clamp(FEWEST_TOGETHER, MOST_TOGETHER);
    if launches.len() <= together {
        return part::<M, K, N>(unit, method, launches);
    }
    launches
        .par_chunks(together)
        .flat_map_iter(|launches| part::<M, K, N>(unit, method, launches))
        .collect()
}

/// The same on this thread.
fn part<M: Integrator, K: Kernel<M, N>, const N: usize>(
    unit: Unit,
    method: Method,
    launches: &[Launch],
) -> Vec<K::Answer> {
    // Lanes step together, so only trajectories of equally many steps share a block: company changes nothing.
    let mut order: Vec<(u64, u32)> = (0..)
        .zip(launches)
        .map(|(i, Launch { rod, tau, load })| {
            let steps = method.resolution.steps(rod, *tau, *load);
            (u64::from(steps) << 32 | rod.piece(*tau) as u64, i)
        })
        .collect();
    order.sort_unstable();
    let mut landed = Vec::with_capacity(launches.len() / WIDTH + 16);
    let mut slots = vec![0; launches.len()];
    let equal = order.chunk_by(|a, b| a.0 == b.0);
    for block in equal.flat_map(|equal| equal.chunks(WIDTH)) {
        for (lane, &(_, i)) in block.iter().enumerate() {
            slots[i as usize] = WIDTH * landed.len() + lane;
        }
        let launch = |lane: usize| launches[block[lane.min(block.len() - 1)].1 as usize];
        let lanes: [Launch; WIDTH] = std::array::from_fn(launch);
        let steps = (block[0].0 >> 32) as u32;
        landed.push(K::block(unit, method.effects, steps, &lanes));
    }
    let landed = landed.as_flattened();
    slots.into_iter().map(|slot| landed[slot]).collect()
}

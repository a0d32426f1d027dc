//! Thousands of trajectories in `f64`: lanes of the widest SIMD unit that the machine has, on all cores.
//!
//! The integrator is generic and inlined whole into functions compiled for every [`Unit`]; which of them run is decided by
//! the processor. Results do not depend on the number of threads: every trajectory is computed by itself, or in a block whose
//! conditions do not.

mod block_key;
mod flops;
mod gather;
mod kernel;
mod measured;
mod output_set;
mod padded;
mod pole;
mod steps;
mod stream;

pub use flops::flops_of_nystrom8;
pub use output_set::OutputSet;
pub use steps::{StepStart, step_starts};

use super::Resolution;
use crate::numerics::Unit;
use crate::rod::{Effects, Rod};
use rayon::prelude::*;

/// One trajectory: from the contact at `tau` under `load = f/radius^2` to the base.
#[derive(Clone, Copy, Debug)]
pub struct InitialCondition<'a> {
    /// The rod.
    pub rod: &'a Rod,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// How trajectories are integrated: how finely, and with which effects beside each rod's own.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// How finely.
    pub resolution: Resolution,
    /// The effects that every kernel has.
    pub effects: Effects,
}

impl Method {
    /// Every rod with the kernel for its own effects.
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        let effects = Effects::default();
        Self {
            resolution,
            effects,
        }
    }

    /// At [`Resolution::FINE`].
    #[must_use]
    pub fn fine() -> Self {
        Self::new(Resolution::FINE)
    }

    /// Kernels have at least these `effects`: with those of all rods of a scene, its rods share kernels, and round alike.
    #[must_use]
    pub const fn with_effects(self, effects: Effects) -> Self {
        Self { effects, ..self }
    }

    /// The same in twice the steps.
    #[must_use]
    pub const fn doubled(self) -> Self {
        let resolution = self.resolution.doubled();
        Self { resolution, ..self }
    }

    /// The same at [`Resolution::COARSE`].
    #[must_use]
    pub const fn coarsely(self) -> Self {
        let resolution = Resolution::COARSE;
        Self { resolution, ..self }
    }
}

/// Shoots many initial conditions at once.
///
/// ```
/// use whiskmap_mechanics::rod::Rod;
/// use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
/// use whiskmap_mechanics::shooting::ShootingMap;
///
/// let rod = Rod { taper: 0.9, ..Rod::default() };
/// let conditions = [0.5, 0.7].map(|s| InitialCondition { rod: &rod, tau: rod.tau(s), load: 6.0 });
/// let maps: Vec<ShootingMap> = Batch::new(Method::fine()).shoot(&conditions);
/// assert!(maps.iter().all(|map| map.det() > 0.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    method: Method,
    unit: Unit,
    is_padded: bool,
}

/// The fewest conditions for a thread, so that most of its blocks are full.
const SMALLEST_CHUNK: usize = 1024;

/// Chunks of a batch for each thread, so that threads end together.
const CHUNKS_OF_A_THREAD: usize = 4;

/// Into chunks of how many a batch of `count` is best divided among the threads of the current pool.
#[must_use]
pub fn chunk_size(count: usize) -> usize {
    let threads = rayon::current_num_threads();
    let chunks = if threads == 1 {
        1
    } else {
        CHUNKS_OF_A_THREAD * threads
    };
    count.div_ceil(chunks).max(SMALLEST_CHUNK)
}

impl Batch {
    /// By `method`, on the widest unit of this processor; every answer is independent of the rest of the batch.
    #[must_use]
    pub fn new(method: Method) -> Self {
        Self {
            method,
            unit: Unit::detect(),
            is_padded: false,
        }
    }

    /// On a given unit.
    #[must_use]
    pub const fn on(self, unit: Unit) -> Self {
        Self { unit, ..self }
    }

    /// Blocks are filled with trajectories that want different numbers of steps; all take the most. For small batches that are
    /// always the same, like those of a sheet: an answer depends, by less than its error, on the whole batch.
    #[must_use]
    pub const fn padded(self) -> Self {
        Self {
            is_padded: true,
            ..self
        }
    }

    /// The outputs of every condition, in the same order, on all threads of the current pool.
    #[must_use]
    pub fn shoot<O: OutputSet>(&self, conditions: &[InitialCondition]) -> Vec<O> {
        let mut outputs = vec![O::default(); conditions.len()];
        let size = chunk_size(conditions.len());
        if self.is_padded {
            padded::shoot(self.unit, self.method, conditions, &mut outputs);
        } else if conditions.len() <= size {
            self.chunk(conditions, &mut outputs);
        } else {
            outputs
                .par_chunks_mut(size)
                .zip(conditions.par_chunks(size))
                .for_each(|(outputs, conditions)| {
                    self.chunk(conditions, outputs);
                });
        }
        outputs
    }

    /// The same on this thread.
    fn chunk<O: OutputSet>(&self, conditions: &[InitialCondition], outputs: &mut [O]) {
        self.for_each(conditions.iter().copied(), |i, output| outputs[i] = *output);
    }

    /// Shoots conditions as they come, on this thread, and hands the outputs of each on with its index, in no order. They are
    /// never padded, for which all of them would have to be known first.
    pub fn for_each<'a, O: OutputSet>(
        &self,
        conditions: impl Iterator<Item = InitialCondition<'a>>,
        take: impl FnMut(usize, &O),
    ) {
        stream::shoot(self.unit, self.method, conditions, take);
    }
}

//! Batches of thousands of trajectories in `f64`, in lanes of the widest SIMD unit of the machine, on all cores.
//!
//! The generic integrator is inlined into functions compiled for every [`Unit`]; the processor decides which functions run.
//! Results do not depend on the number of threads: the conditions of a block do not depend on it.

mod block;
mod block_key;
mod gather;
mod kernel;
mod measured;
mod output_set;
mod padded;
mod pole;
mod stream;

pub use output_set::OutputSet;
pub(super) use pole::{Complex, PoleCentre};

use super::Resolution;
use crate::numerics::Unit;
use crate::rod::{Effects, Rod};
use rayon::prelude::*;

/// True where kernels are a part of a page, so that their size matters more than the speed of rare rods. There, a rod may get a kernel
/// with more effects than its own, which its numbers turn off. A spiral is a polynomial of degree 1.
pub(super) const FEW_KERNELS: bool = cfg!(target_family = "wasm");

/// Initial condition of a trajectory: a rod, its contact at `tau`, and the `load = f/radius^2` there.
#[derive(Clone, Copy, Debug)]
pub struct InitialCondition<'a> {
    /// Whisker and pole of the trajectory.
    pub rod: &'a Rod,
    /// Contact coordinate `tau` at which the trajectory starts, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` at the contact of the trajectory, dimensionless.
    pub load: f64,
}

impl<'a> InitialCondition<'a> {
    /// Creates the initial condition of a trajectory of `rod` from a point `(tau, load)`.
    #[must_use]
    pub fn new(rod: &'a Rod, point: impl Into<(f64, f64)>) -> Self {
        let (tau, load) = point.into();
        Self { rod, tau, load }
    }
}

/// Integration method of trajectories: the resolution, and effects that every kernel has.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Resolution of the method: it determines the integration steps.
    pub resolution: Resolution,
    /// Effects that every kernel has beside the effects of the rod.
    pub effects: Effects,
}

impl Method {
    /// Creates the method at `resolution`, in which every rod has the kernel for its own effects.
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        let effects = Effects::default();
        Self { resolution, effects }
    }

    /// Returns the method at [`Resolution::FINE`].
    #[must_use]
    pub fn fine() -> Self {
        Self::new(Resolution::FINE)
    }

    /// Returns the method whose kernels have at least these `effects`. With the effects of all rods of a scene, its rods share kernels,
    /// and their rounding.
    #[must_use]
    pub const fn with_effects(self, effects: Effects) -> Self {
        Self { effects, ..self }
    }

    /// Returns the method with twice as many integration steps.
    #[must_use]
    pub const fn doubled(self) -> Self {
        let resolution = self.resolution.doubled();
        Self { resolution, ..self }
    }

    /// Returns the method at [`Resolution::COARSE`].
    #[must_use]
    pub const fn coarsely(self) -> Self {
        let resolution = Resolution::COARSE;
        Self { resolution, ..self }
    }
}

/// Batch integrator: integrates many trajectories at once.
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

/// Fewest conditions of a chunk, so that most of its blocks are full.
const SMALLEST_CHUNK: usize = 1024;

/// Chunks of a batch per thread, so that threads finish together.
const CHUNKS_OF_A_THREAD: usize = 4;

/// Returns the number of conditions in each chunk into which a batch of `count` is divided for the threads of the current pool.
#[must_use]
pub fn chunk_size(count: usize) -> usize {
    let threads = rayon::current_num_threads();
    let chunks = if threads == 1 { 1 } else { CHUNKS_OF_A_THREAD * threads };
    count.div_ceil(chunks).max(SMALLEST_CHUNK)
}

impl Batch {
    /// Creates a batch integrator with `method` on the widest unit of this processor. Each output is independent of the rest of the
    /// batch.
    #[must_use]
    pub fn new(method: Method) -> Self {
        Self { method, unit: Unit::detect(), is_padded: false }
    }

    /// Returns the batch integrator for another SIMD unit.
    #[must_use]
    pub const fn on(self, unit: Unit) -> Self {
        Self { unit, ..self }
    }

    /// Returns the batch integrator with padded blocks: trajectories with different numbers of steps share a block, and all take the
    /// largest number. An output depends on the whole batch by less than its error. Padding pays for small batches, such as the batches of a
    /// sheet.
    #[must_use]
    pub const fn padded(self) -> Self {
        Self { is_padded: true, ..self }
    }

    /// Integrates the trajectories of all `conditions` on all threads of the current pool. Returns their outputs in the same order,
    /// `[condition]`.
    #[must_use]
    pub fn shoot<O: OutputSet>(&self, conditions: &[InitialCondition]) -> Vec<O> {
        let mut outputs = vec![O::default(); conditions.len()];
        let size = chunk_size(conditions.len());
        if self.is_padded {
            padded::shoot(self.unit, self.method, conditions, &mut outputs);
        } else if conditions.len() <= size {
            self.chunk(conditions, &mut outputs);
        } else {
            outputs.par_chunks_mut(size).zip(conditions.par_chunks(size)).for_each(
                |(outputs, conditions)| {
                    self.chunk(conditions, outputs);
                },
            );
        }
        outputs
    }

    /// Integrates trajectories of one rod from `points` `(tau, load)`. Returns their outputs in the same order, `[point]`.
    #[must_use]
    pub fn shoot_at<O: OutputSet>(
        &self,
        rod: &Rod,
        points: impl IntoIterator<Item = impl Into<(f64, f64)>>,
    ) -> Vec<O> {
        let conditions = points.into_iter().map(|point| InitialCondition::new(rod, point));
        self.shoot(&conditions.collect::<Vec<_>>())
    }

    /// Computes the outputs of a chunk on this thread.
    fn chunk<O: OutputSet>(&self, conditions: &[InitialCondition], outputs: &mut [O]) {
        self.for_each(conditions.iter().copied(), |i, output| outputs[i] = *output);
    }

    /// Integrates the trajectories of `conditions` on this thread. Calls `take` with the index and the outputs of each, in any order.
    /// Blocks are never padded.
    pub fn for_each<'a, O: OutputSet>(
        &self,
        conditions: impl Iterator<Item = InitialCondition<'a>>,
        take: impl FnMut(usize, &O),
    ) {
        stream::shoot(self.unit, self.method, conditions, take);
    }
}

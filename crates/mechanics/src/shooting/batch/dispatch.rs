//! The kernels, one for each integrator and output set, compiled here for every SIMD unit and not where they are called: there are
//! many of them, and each is long.

use super::kernel::{Block, by_effects, steps};
use super::{First, FirstAndEnergy, Kind, Method, Second};
use crate::numerics::{Lanes, Task, Unit, WIDTH};
use crate::rod::Effects;
use crate::shooting::{Integrator, Nystrom8, Rk4};
use std::marker::PhantomData;

/// What can be computed in batches with the integrator `M`.
pub trait Kernel<M: Integrator>: Kind {
    /// Computes the first `count` trajectories of a block on `unit`, in `steps` steps per trajectory, or per piece of a profile.
    fn block(
        unit: Unit,
        effects: Effects,
        steps: u32,
        conditions: &Block,
        count: usize,
    ) -> [Self::Answer; WIDTH];
}

/// The trajectories of a block.
struct Trajectories<'a, M, K> {
    effects: Effects,
    steps: u32,
    conditions: &'a Block<'a>,
    count: usize,
    of: PhantomData<(M, K)>,
}

macro_rules! kernel {
    ($integrator:ty, $kind:ty) => {
        impl Task for Trajectories<'_, $integrator, $kind> {
            type Output = [<$kind as Kind>::Answer; WIDTH];

            #[inline(always)]
            fn run<T: Lanes>(self) -> Self::Output {
                parts(T::LANES, self.conditions, self.count, |part| {
                    by_effects::<$integrator, $kind, T>(self.effects, self.steps, part)
                })
            }
        }

        impl Kernel<$integrator> for $kind {
            fn block(
                unit: Unit,
                effects: Effects,
                steps: u32,
                conditions: &Block,
                count: usize,
            ) -> [Self::Answer; WIDTH] {
                unit.run(Trajectories::<$integrator, $kind> {
                    effects,
                    steps,
                    conditions,
                    count,
                    of: PhantomData,
                })
            }
        }
    };
}

kernel!(Nystrom8, First);
kernel!(Nystrom8, FirstAndEnergy);
kernel!(Nystrom8, Second);
kernel!(Rk4, First);

/// Arclengths of the contacts of a block, and the steps that its trajectories take.
pub struct Steps<'a> {
    /// How they are integrated.
    pub method: Method,
    /// The block.
    pub conditions: &'a Block<'a>,
}

impl Task for Steps<'_> {
    type Output = [(f64, u32); WIDTH];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        parts(T::LANES, self.conditions, WIDTH, |part| {
            steps::<T>(self.method, part)
        })
    }
}

/// A block in parts of `lanes` conditions, as far as there are `count` of them.
#[inline(always)]
fn parts<A: Copy + Default>(
    lanes: usize,
    conditions: &Block,
    count: usize,
    compute: impl Fn(&Block) -> [A; WIDTH],
) -> [A; WIDTH] {
    if lanes == WIDTH {
        return compute(conditions);
    }
    let mut answers = [A::default(); WIDTH];
    for (conditions, answers) in conditions[..count]
        .chunks(lanes)
        .zip(answers.chunks_mut(lanes))
    {
        let part = compute(&std::array::from_fn(|lane| {
            conditions[lane.min(conditions.len() - 1)]
        }));
        answers.copy_from_slice(&part[..answers.len()]);
    }
    answers
}

//! The SIMD units, and the kernels compiled for each.
//!
//! Kernels are compiled here, once, and not where they are called: there are many of them, and each is long.

use super::Method;
use super::answer::{Derived, First, FirstAndEnergy, Kind, Second};
use super::kernel::{Block, by_effects, steps};
use super::peak::multiply_and_add;
use crate::model::integrator::Integrator;
#[cfg(not(target_arch = "x86_64"))]
use crate::model::simd::plain::Plain as Baseline;
#[cfg(target_arch = "x86_64")]
use crate::model::simd::x86::{Avx2, Avx512, Sse2 as Baseline};
use crate::model::simd::{Lanes, WIDTH};
use crate::model::{Effects, Nystrom8, Rk4};
use std::fmt;

/// A SIMD unit that this processor has.
#[derive(Clone, Copy, Debug)]
pub struct Unit(Instructions);

#[derive(Clone, Copy, Debug)]
enum Instructions {
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512,
    /// AVX2 with FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// What every processor of this architecture has.
    Baseline,
    /// One trajectory at a time.
    Scalar,
}

impl Instructions {
    /// Whether this processor has them.
    fn is_here(&self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("fma")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            Self::Baseline | Self::Scalar => true,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => "AVX2",
            Instructions::Baseline => "baseline SIMD",
            Instructions::Scalar => "scalar",
        })
    }
}

impl Unit {
    /// The units of this processor, the widest first, the scalar one last.
    pub fn all() -> impl Iterator<Item = Self> {
        let units = [
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512,
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2,
            Instructions::Baseline,
            Instructions::Scalar,
        ];
        units.into_iter().filter(Instructions::is_here).map(Self)
    }

    /// The widest unit of this processor.
    #[must_use]
    pub fn detect() -> Self {
        Self::all().next().unwrap_or(Self::scalar())
    }

    /// No unit at all, as the compiler's default target does arithmetic: what vectors are compared with.
    #[must_use]
    pub const fn scalar() -> Self {
        Self(Instructions::Scalar)
    }

    /// Arclengths of the contacts of a block, and the steps that its trajectories take.
    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `all` has found that unit"
    )]
    pub(super) fn steps(self, method: Method, launches: &Block) -> [(f64, u32); WIDTH] {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => parts(Avx512::LANES, launches, WIDTH, |part| {
                // SAFETY: only `all` makes such a unit, and it has seen every feature that the function enables.
                unsafe { steps_avx512(method, part) }
            }),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => parts(Avx2::LANES, launches, WIDTH, |part| {
                // SAFETY: as above.
                unsafe { steps_avx2(method, part) }
            }),
            Instructions::Baseline | Instructions::Scalar => {
                parts(Baseline::LANES, launches, WIDTH, |part| {
                    steps::<Baseline>(method, part)
                })
            }
        }
    }

    /// Does `task` in this unit's lanes.
    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `all` has found that unit"
    )]
    pub(crate) fn run<K: Task>(self, task: K) -> K::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: only `all` makes such a unit, and it has seen every feature that the function enables.
            Instructions::Avx512 => unsafe { run_avx512(task) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Instructions::Avx2 => unsafe { run_avx2(task) },
            Instructions::Baseline => task.run::<Baseline>(),
            Instructions::Scalar => task.run::<f64>(),
        }
    }

    /// Does nothing but multiply and add for `rounds` rounds, and tells how many operations that were: with a clock, the
    /// peak of one thread.
    #[must_use]
    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `all` has found that unit"
    )]
    pub fn exhaust(self, rounds: u32) -> u64 {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: only `all` makes such a unit, and it has seen every feature that the function enables.
            Instructions::Avx512 => unsafe { exhaust_avx512(rounds) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Instructions::Avx2 => unsafe { exhaust_avx2(rounds) },
            Instructions::Baseline => multiply_and_add::<Baseline, 6>(rounds),
            Instructions::Scalar => multiply_and_add::<f64, 16>(rounds),
        }
    }
}

/// Arithmetic in lanes.
pub(crate) trait Task {
    /// What comes of it.
    type Output;

    /// Does it with bundles of one unit; to be inlined into a function that is compiled for that unit.
    fn run<T: Lanes>(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn run_avx512<K: Task>(task: K) -> K::Output {
    task.run::<Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_avx2<K: Task>(task: K) -> K::Output {
    task.run::<Avx2>()
}

/// What can be computed in batches with the integrator `M`.
pub trait Kernel<M: Integrator>: Kind {
    /// Computes the first `count` trajectories of a block on `unit`, in `steps` steps per trajectory, or per piece of a profile.
    fn block(
        unit: Unit,
        effects: Effects,
        steps: u32,
        launches: &Block,
        count: usize,
    ) -> [Self::Answer; WIDTH];
}

macro_rules! kernel {
    ($integrator:ty, $kind:ty) => {
        impl Kernel<$integrator> for $kind {
            #[allow(
                unsafe_code,
                reason = "a function compiled for a SIMD unit may be called where `all` has found that unit"
            )]
            fn block(
                unit: Unit,
                effects: Effects,
                steps: u32,
                launches: &Block,
                count: usize,
            ) -> [Self::Answer; WIDTH] {
                match unit.0 {
                    #[cfg(target_arch = "x86_64")]
                    Instructions::Avx512 => parts(Avx512::LANES, launches, count, |part| {
                        // SAFETY: only `all` makes such a unit, and it has seen every feature that the function enables.
                        unsafe { avx512::<$integrator, $kind>(effects, steps, part) }
                    }),
                    #[cfg(target_arch = "x86_64")]
                    Instructions::Avx2 => parts(Avx2::LANES, launches, count, |part| {
                        // SAFETY: as above.
                        unsafe { avx2::<$integrator, $kind>(effects, steps, part) }
                    }),
                    Instructions::Baseline => parts(Baseline::LANES, launches, count, |part| {
                        by_effects::<$integrator, $kind, Baseline>(effects, steps, part)
                    }),
                    Instructions::Scalar => parts(f64::LANES, launches, count, |part| {
                        by_effects::<$integrator, $kind, f64>(effects, steps, part)
                    }),
                }
            }
        }
    };
}

/// A block in parts of `lanes` launches, as far as there are `count` of them.
#[inline(always)]
fn parts<A: Copy + Default>(
    lanes: usize,
    launches: &Block,
    count: usize,
    compute: impl Fn(&Block) -> [A; WIDTH],
) -> [A; WIDTH] {
    if lanes == WIDTH {
        return compute(launches);
    }
    let mut answers = [A::default(); WIDTH];
    for (launches, answers) in launches[..count]
        .chunks(lanes)
        .zip(answers.chunks_mut(lanes))
    {
        let part = compute(&std::array::from_fn(|lane| {
            launches[lane.min(launches.len() - 1)]
        }));
        answers.copy_from_slice(&part[..answers.len()]);
    }
    answers
}

kernel!(Nystrom8, First);
kernel!(Nystrom8, FirstAndEnergy);
kernel!(Nystrom8, Second);
kernel!(Rk4, First);

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn steps_avx512(method: Method, launches: &Block) -> [(f64, u32); WIDTH] {
    steps::<Avx512>(method, launches)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn steps_avx2(method: Method, launches: &Block) -> [(f64, u32); WIDTH] {
    steps::<Avx2>(method, launches)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn exhaust_avx512(rounds: u32) -> u64 {
    multiply_and_add::<Avx512, 8>(rounds)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn exhaust_avx2(rounds: u32) -> u64 {
    multiply_and_add::<Avx2, 6>(rounds)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn avx512<M: Integrator, K: Derived<Avx512>>(
    effects: Effects,
    steps: u32,
    launches: &Block,
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx512>(effects, steps, launches)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<M: Integrator, K: Derived<Avx2>>(
    effects: Effects,
    steps: u32,
    launches: &Block,
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx2>(effects, steps, launches)
}

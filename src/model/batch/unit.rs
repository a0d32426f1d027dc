//! The SIMD units, and the kernels compiled for each.
//!
//! Kernels are compiled here, once, and not where they are called: there are many of them, and each is long.

use super::kernel::by_effects;
use super::peak::multiply_and_add;
use super::{Kind, Launch};
use crate::model::integrator::Integrator;
use crate::model::order::{First, FirstAndEnergy, Second};
use crate::model::simd::WIDTH;
#[cfg(not(target_arch = "x86_64"))]
use crate::model::simd::plain::Plain as Baseline;
#[cfg(target_arch = "x86_64")]
use crate::model::simd::x86::{Avx2, Avx512, Sse2 as Baseline};
use crate::model::{Dopri8, Effects};
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
    /// The widest unit of this processor.
    #[must_use]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
            {
                return Self(Instructions::Avx512);
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self(Instructions::Avx2);
            }
        }
        Self(Instructions::Baseline)
    }

    /// No unit at all, as the compiler's default target does arithmetic: what vectors are compared with.
    #[must_use]
    pub const fn scalar() -> Self {
        Self(Instructions::Scalar)
    }

    /// Does nothing but multiply and add for `rounds` rounds, and tells how many operations that were: with a clock, the
    /// peak of one thread.
    #[must_use]
    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `detect` has found that unit"
    )]
    pub fn exhaust(self, rounds: u32) -> u64 {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: only `detect` makes such a unit, and it has seen every feature that the function enables.
            Instructions::Avx512 => unsafe { exhaust_avx512(rounds) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: as above.
            Instructions::Avx2 => unsafe { exhaust_avx2(rounds) },
            Instructions::Baseline => multiply_and_add::<Baseline, 3>(rounds),
            Instructions::Scalar => multiply_and_add::<f64, 16>(rounds),
        }
    }
}

/// What can be computed in batches with the integrator `M`.
pub trait Kernel<M: Integrator, const N: usize>: Kind<N> {
    /// Computes one block on `unit`, in `steps` steps per trajectory, or per piece of a profile.
    fn block(
        unit: Unit,
        effects: Effects,
        steps: u32,
        launches: &[Launch; WIDTH],
    ) -> [Self::Answer; WIDTH];
}

macro_rules! kernel {
    ($integrator:ty, $kind:ty, $n:literal) => {
        impl Kernel<$integrator, $n> for $kind {
            #[allow(
                unsafe_code,
                reason = "a function compiled for a SIMD unit may be called where `detect` has found that unit"
            )]
            fn block(
                unit: Unit,
                effects: Effects,
                steps: u32,
                launches: &[Launch; WIDTH],
            ) -> [Self::Answer; WIDTH] {
                match unit.0 {
                    #[cfg(target_arch = "x86_64")]
                    // SAFETY: only `detect` makes such a unit, and it has seen every feature that the function enables.
                    Instructions::Avx512 => unsafe {
                        avx512::<$integrator, $kind, $n>(effects, steps, launches)
                    },
                    #[cfg(target_arch = "x86_64")]
                    // SAFETY: as above.
                    Instructions::Avx2 => unsafe {
                        avx2::<$integrator, $kind, $n>(effects, steps, launches)
                    },
                    Instructions::Baseline => {
                        by_effects::<$integrator, $kind, Baseline, $n>(effects, steps, launches)
                    }
                    Instructions::Scalar => launches.map(|launch| {
                        by_effects::<$integrator, $kind, f64, $n>(effects, steps, &[launch; WIDTH])
                            [0]
                    }),
                }
            }
        }
    };
}

kernel!(Dopri8, First, 6);
kernel!(Dopri8, FirstAndEnergy, 7);
kernel!(Dopri8, Second, 15);

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn exhaust_avx512(rounds: u32) -> u64 {
    multiply_and_add::<Avx512, 16>(rounds)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn exhaust_avx2(rounds: u32) -> u64 {
    multiply_and_add::<Avx2, 6>(rounds)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn avx512<M: Integrator, K: Kind<N>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx512, N>(effects, steps, launches)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<M: Integrator, K: Kind<N>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    by_effects::<M, K, Avx2, N>(effects, steps, launches)
}

//! The SIMD unit of this processor, and arithmetic compiled for each.

use super::Lanes;
#[cfg(not(target_arch = "x86_64"))]
use super::simd::plain::Plain as Baseline;
#[cfg(target_arch = "x86_64")]
use super::simd::x86::{Avx2, Avx512, Sse2 as Baseline};
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

    /// Does `task` in this unit's lanes.
    #[allow(
        unsafe_code,
        reason = "a function compiled for a SIMD unit may be called where `all` has found that unit"
    )]
    #[must_use]
    pub fn run<K: Task>(self, task: K) -> K::Output {
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
}

/// Arithmetic in lanes.
pub trait Task {
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

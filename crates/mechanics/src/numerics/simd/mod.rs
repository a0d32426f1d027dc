//! SIMD lanes as a scalar: numbers worked on in step, and arithmetic compiled for every SIMD unit.
//!
//! Each bundle waits for itself most of the time, so that two registers of each kind take hardly longer than one.

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
#[macro_use]
mod registers;

#[cfg(target_arch = "aarch64")]
mod aarch64;
#[cfg(target_arch = "x86_64")]
mod x86;

use super::Real;
#[cfg(target_arch = "aarch64")]
use aarch64::Neon;
use std::fmt;
#[cfg(target_arch = "x86_64")]
use x86::{Avx2, Avx512};

/// Most lanes of a bundle.
pub const WIDTH: usize = 16;

/// Numbers worked on in step, or one for comparison.
pub trait Lanes: Real {
    /// Half as many of the same unit, in one register of each kind: faster where two do not fit into the processor.
    type Narrow: Lanes;

    /// How many.
    const LANES: usize;

    /// From the first numbers of an array.
    fn pack(lanes: [f64; WIDTH]) -> Self;
    /// To the first numbers of an array.
    fn unpack(self) -> [f64; WIDTH];

    /// Does `task` in a function of its own: a compiler takes longer for one large function than for many small ones.
    #[inline(never)]
    fn outlined<K: LanesTask<Self>>(task: K) -> K::Output {
        task.run()
    }
}

/// Arithmetic in the lanes `T`.
pub trait LanesTask<T: Lanes> {
    /// What comes of it.
    type Output;

    /// Does it; to be inlined into a function that is compiled for the unit of these lanes.
    fn run(self) -> Self::Output;
}

impl Lanes for f64 {
    type Narrow = Self;

    const LANES: usize = 1;

    #[inline(always)]
    fn pack(lanes: [f64; WIDTH]) -> Self {
        lanes[0]
    }

    #[inline(always)]
    fn unpack(self) -> [f64; WIDTH] {
        [self; WIDTH]
    }
}

/// Arithmetic in lanes.
pub trait SimdTask {
    /// What comes of it.
    type Output;

    /// Does it with the lanes of one unit; to be inlined into a function that is compiled for that unit.
    fn run<T: Lanes>(self) -> Self::Output;
}

/// How `a * b + c` is rounded: all results of one class have the same bits, whatever the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticClass {
    /// Fused: one rounding, of the sum.
    Fma,
    /// Not fused: the product is rounded, then the sum.
    NoFma,
}

impl ArithmeticClass {
    /// The class of the widest unit of this processor: [`Unit::detect`] chooses it wherever numbers are computed.
    #[must_use]
    pub fn detect() -> Self {
        Unit::detect().arithmetic()
    }

    /// The name in a store and in messages: `fma` or `no-fma`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fma => "fma",
            Self::NoFma => "no-fma",
        }
    }
}

impl fmt::Display for ArithmeticClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A SIMD unit that this processor has.
#[derive(Clone, Copy, Debug)]
pub struct Unit(Instructions);

/// The vector units hold their proof that the processor has them.
#[derive(Clone, Copy, Debug)]
enum Instructions {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
    /// One number at a time, products rounded before they are added.
    Scalar,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_) => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(_) => "AVX2",
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(_) => "NEON",
            Instructions::Scalar => "scalar",
        })
    }
}

impl Unit {
    /// The units of this processor, the widest first, the scalar one last.
    pub fn all() -> impl Iterator<Item = Self> {
        let units = [
            #[cfg(target_arch = "x86_64")]
            Avx512::detect().map(Instructions::Avx512),
            #[cfg(target_arch = "x86_64")]
            Avx2::detect().map(Instructions::Avx2),
            #[cfg(target_arch = "aarch64")]
            Neon::detect().map(Instructions::Neon),
            Some(Instructions::Scalar),
        ];
        units.into_iter().flatten().map(Self)
    }

    /// The widest unit of this processor.
    #[must_use]
    pub fn detect() -> Self {
        Self::all().next().unwrap_or(Self::scalar())
    }

    /// Plain numbers, not fused: what vectors are compared with, and the unit of processors without AVX2 and NEON.
    #[must_use]
    pub const fn scalar() -> Self {
        Self(Instructions::Scalar)
    }

    /// The rounding of `mul_add` in this unit's lanes.
    #[must_use]
    pub const fn arithmetic(self) -> ArithmeticClass {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_) | Instructions::Avx2(_) => ArithmeticClass::Fma,
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(_) => ArithmeticClass::Fma,
            Instructions::Scalar => ArithmeticClass::NoFma,
        }
    }

    /// Does `task` in this unit's lanes.
    #[must_use]
    pub fn run<K: SimdTask>(self, task: K) -> K::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(unit) => unit.run(task),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(unit) => unit.run(task),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(unit) => unit.run(task),
            Instructions::Scalar => task.run::<f64>(),
        }
    }
}

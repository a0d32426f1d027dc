//! SIMD lanes as a scalar type, and arithmetic compiled for every SIMD unit.
//!
//! Lanes fill two registers: operations wait for their operands most of the time, so two registers take hardly longer than one.

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

/// Largest number of lanes of any unit.
pub const WIDTH: usize = 16;

/// Several numbers on which each operation acts at once, or a single number.
pub trait Lanes: Real {
    /// Half as many lanes of the unit, in one register: faster where the values in flight do not fit into all registers.
    type Narrow: Lanes;

    /// Number of lanes.
    const LANES: usize;

    /// The first numbers of an array, as lanes.
    fn pack(lanes: [f64; WIDTH]) -> Self;
    /// An array that begins with the lanes.
    fn unpack(self) -> [f64; WIDTH];

    /// Runs `task` in a function of its own: one large function takes a compiler longer than many small ones.
    #[inline(never)]
    fn outlined<K: LanesTask<Self>>(task: K) -> K::Output {
        task.run()
    }
}

/// Arithmetic in lanes of type `T`.
pub trait LanesTask<T: Lanes> {
    /// The result.
    type Output;

    /// Runs the task. It is to be inlined into a function that is compiled for the unit of these lanes.
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

/// Arithmetic in lanes of any type.
pub trait SimdTask {
    /// The result.
    type Output;

    /// Runs the task in the lanes of one unit. It is to be inlined into a function that is compiled for that unit.
    fn run<T: Lanes>(self) -> Self::Output;
}

/// The rounding of `a * b + c`. All units of one class give results with equal bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticClass {
    /// Fused: one rounding, of the sum.
    Fma,
    /// Not fused: the product is rounded, then the sum.
    NoFma,
}

impl ArithmeticClass {
    /// The class of the widest unit of this processor, which [`Unit::detect`] returns.
    #[must_use]
    pub fn detect() -> Self {
        Unit::detect().arithmetic()
    }

    /// The name in stores and messages: `fma` or `no-fma`.
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

/// The vector units with their tokens, which prove that the processor has them.
#[derive(Clone, Copy, Debug)]
enum Instructions {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
    /// One number at a time. Products are rounded before they are added.
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
    /// The units of this processor, from the widest to the scalar one.
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

    /// Plain numbers without fused products: the unit of processors without AVX2 and NEON, and the reference of tests.
    #[must_use]
    pub const fn scalar() -> Self {
        Self(Instructions::Scalar)
    }

    /// The rounding of `mul_add` in lanes of this unit.
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

    /// Runs `task` in lanes of this unit.
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

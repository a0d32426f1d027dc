//! SIMD lanes as a scalar type, and arithmetic compiled for every SIMD unit.
//!
//! Lanes fill two registers: operations wait for their operands most of the time, so two registers take hardly longer than one.

#[cfg(any(target_arch = "aarch64", target_arch = "wasm32", target_arch = "x86_64"))]
#[macro_use]
mod registers;

#[cfg(target_arch = "aarch64")]
mod aarch64;
#[cfg(all(windows, target_env = "gnu"))]
mod mingw;
#[cfg(target_arch = "wasm32")]
mod wasm32;
#[cfg(target_arch = "x86_64")]
mod x86;

use super::Real;
#[cfg(target_arch = "aarch64")]
use aarch64::Neon;
use std::fmt;
#[cfg(target_arch = "wasm32")]
use wasm32::Simd128;
#[cfg(target_arch = "x86_64")]
use x86::{Avx2, Avx512};

/// Largest number of SIMD lanes of any unit.
pub const WIDTH: usize = 16;

/// Largest count of numbers that take less time one after the other than in the lanes of SIMD128: there, eight take as long as three.
const FEW: usize = 3;

/// Several numbers on which each operation acts at once, or a single number.
pub trait Lanes: Real {
    /// Half as many lanes of the same unit, in one register: faster where the values in flight do not fit into all registers.
    type Narrow: Lanes;

    /// Number of lanes of the SIMD type.
    const LANES: usize;

    /// Loads the first numbers of an array into the lanes.
    fn pack(lanes: [f64; WIDTH]) -> Self;
    /// Returns an array that begins with the numbers of the lanes.
    fn unpack(self) -> [f64; WIDTH];

    /// Runs `task` in a separate function: a compiler is faster with many small functions than with one large function.
    #[inline(never)]
    fn outlined<K: LanesTask<Self>>(task: K) -> K::Output {
        task.run()
    }
}

/// Numbers of all SIMD lanes: `[lane]`.
pub type LaneNumbers = [f64; WIDTH];

/// Returns lanes with the numbers of an array from the index `from` on.
#[inline(always)]
pub fn pack<T: Lanes>(numbers: &LaneNumbers, from: usize) -> T {
    let mut lanes = [0.0; WIDTH];
    // A constant length makes one load of the copy.
    lanes[..T::LANES].copy_from_slice(&numbers[from..from + T::LANES]);
    T::pack(lanes)
}

/// Stores lanes in an array of numbers, from index `from` on.
#[inline(always)]
pub fn keep<T: Lanes>(numbers: &mut LaneNumbers, from: usize, lanes: T) {
    numbers[from..from + T::LANES].copy_from_slice(&lanes.unpack()[..T::LANES]);
}

/// Function object that computes in lanes of type `T`: its fields are the arguments, and [`LanesTask::run`] is the body. It is compiled
/// once for each instruction set.
pub trait LanesTask<T: Lanes> {
    /// Result of the computation in lanes.
    type Output;

    /// Runs the computation. It is inlined into a function that is compiled for the unit of these lanes.
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

/// A computation in lanes of any type.
pub trait SimdTask {
    /// Result of the computation.
    type Output;

    /// Runs the computation in the lanes of one unit. It is inlined into a function that is compiled for that unit.
    fn run<T: Lanes>(self) -> Self::Output;
}

/// The rounding of `a * b + c` on a processor. All units of one class give results with equal bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticClass {
    /// Fused multiply-add: only the sum is rounded.
    Fma,
    /// Separate multiplication and addition: the product is rounded, then the sum.
    NoFma,
}

impl ArithmeticClass {
    /// Returns the arithmetic class of the widest unit of this processor, which [`Unit::detect`] returns.
    #[must_use]
    pub fn detect() -> Self {
        Unit::detect().arithmetic()
    }

    /// Returns the name of the arithmetic class in stores and messages: `fma` or `no-fma`.
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
    #[cfg(target_arch = "wasm32")]
    Simd128(Simd128),
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
            #[cfg(target_arch = "wasm32")]
            Instructions::Simd128(_) => "SIMD128",
            Instructions::Scalar => "scalar",
        })
    }
}

impl Unit {
    /// Returns the SIMD units of this processor, from the widest to the scalar one.
    pub fn all() -> impl Iterator<Item = Self> {
        let units = [
            #[cfg(target_arch = "x86_64")]
            Avx512::detect().map(Instructions::Avx512),
            #[cfg(target_arch = "x86_64")]
            Avx2::detect().map(Instructions::Avx2),
            #[cfg(target_arch = "aarch64")]
            Neon::detect().map(Instructions::Neon),
            #[cfg(target_arch = "wasm32")]
            Simd128::detect().map(Instructions::Simd128),
            Some(Instructions::Scalar),
        ];
        units.into_iter().flatten().map(Self)
    }

    /// Returns the widest SIMD unit of this processor.
    #[must_use]
    pub fn detect() -> Self {
        Self::all().next().unwrap_or(Self::scalar())
    }

    /// Returns the unit of plain numbers without fused products: for processors without AVX2 and NEON, and for comparison in tests.
    #[must_use]
    pub const fn scalar() -> Self {
        Self(Instructions::Scalar)
    }

    /// Returns the unit that computes `count` numbers with the same bits in the least time: one at a time if few lanes would be filled.
    #[must_use]
    pub fn for_count(self, count: usize) -> Self {
        let scalar = Self::scalar();
        match self.arithmetic() == scalar.arithmetic() && count <= FEW {
            true => scalar,
            false => self,
        }
    }

    /// Returns the rounding of `mul_add` in lanes of this unit.
    #[must_use]
    pub const fn arithmetic(self) -> ArithmeticClass {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_) | Instructions::Avx2(_) => ArithmeticClass::Fma,
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(_) => ArithmeticClass::Fma,
            #[cfg(target_arch = "wasm32")]
            Instructions::Simd128(_) => ArithmeticClass::NoFma,
            Instructions::Scalar => ArithmeticClass::NoFma,
        }
    }

    /// Runs a computation in lanes of this unit.
    #[must_use]
    pub fn run<K: SimdTask>(self, task: K) -> K::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(unit) => unit.run(task),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(unit) => unit.run(task),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(unit) => unit.run(task),
            #[cfg(target_arch = "wasm32")]
            Instructions::Simd128(unit) => unit.run(task),
            Instructions::Scalar => task.run::<f64>(),
        }
    }
}

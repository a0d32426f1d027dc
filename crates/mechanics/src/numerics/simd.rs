//! SIMD lanes as a scalar: trajectories integrated in step.
//!
//! Each of them waits for itself most of the time, so that two registers of each kind take hardly longer than one.
//!
//! The vector types hold registers of one SIMD unit. Their operators are inlined into functions compiled for
//! that unit (the wrappers of [`super::batch`]), the only place where such values are made.
#![allow(
    unsafe_code,
    reason = "vector instructions may run only where the unit exists; `Unit::detect` stands before every use"
)]

use crate::numerics::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Most lanes of a bundle.
pub const WIDTH: usize = 16;

/// Numbers worked on in step, or one for comparison.
pub trait Lanes: Real {
    /// How many.
    const LANES: usize;

    /// From the first numbers of an array.
    fn pack(lanes: [f64; WIDTH]) -> Self;
    /// To the first numbers of an array.
    fn unpack(self) -> [f64; WIDTH];
}

impl Lanes for f64 {
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

/// Implements the arithmetic of `Lanes` for a tuple struct of registers, register by register.
macro_rules! arithmetic {
    (@op $name:ident, $trait:ident, $method:ident, $f:expr, [$($i:tt)+]) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the module.
                unsafe { Self($($f(self.$i, other.$i)),+) }
            }
        }
    };
    ($name:ident, [$($i:tt)+]; $add:expr, $sub:expr, $mul:expr, $div:expr, $fma:expr, $splat:expr, $sqrt:expr) => {
        arithmetic!(@op $name, Add, add, $add, [$($i)+]);
        arithmetic!(@op $name, Sub, sub, $sub, [$($i)+]);
        arithmetic!(@op $name, Mul, mul, $mul, [$($i)+]);
        arithmetic!(@op $name, Div, div, $div, [$($i)+]);

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::of(-0.0) - self
            }
        }

        impl Real for $name {
            #[inline(always)]
            fn of(x: f64) -> Self {
                // SAFETY: see the module.
                unsafe { Self($({ let _ = $i; $splat(x) }),+) }
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: see the module.
                unsafe { Self($($fma(self.$i, a.$i, b.$i)),+) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: see the module.
                unsafe { Self($($sqrt(self.$i)),+) }
            }
        }
    };
}

/// Implements `Lanes` for the same, whose registers hold `$each` numbers.
#[cfg(target_arch = "x86_64")]
macro_rules! lanes {
    ($name:ident, $each:literal, [$($i:tt)+]; $load:expr, $store:expr) => {
        impl Lanes for $name {
            const LANES: usize = {
                let lanes = $each * [$($i),+].len();
                assert!(lanes <= WIDTH);
                lanes
            };

            #[inline(always)]
            fn pack(lanes: [f64; WIDTH]) -> Self {
                // SAFETY: the registers are no longer than the array; see the module for the instruction.
                unsafe { Self($($load(lanes.as_ptr().add($each * $i))),+) }
            }

            #[inline(always)]
            fn unpack(self) -> [f64; WIDTH] {
                let mut lanes = [0.0; WIDTH];
                // SAFETY: the registers are no longer than the array; see the module for the instruction.
                unsafe { $($store(lanes.as_mut_ptr().add($each * $i), self.$i);)+ }
                lanes
            }
        }
    };
}

/// The vector units of x86-64.
#[cfg(target_arch = "x86_64")]
pub mod x86 {
    use super::*;
    use std::arch::x86_64::*;

    /// Two registers of SSE2, which every processor of this architecture has; it has no fused multiply-add.
    #[derive(Clone, Copy, Debug)]
    pub struct Sse2(__m128d, __m128d);

    #[inline(always)]
    unsafe fn multiply_then_add(a: __m128d, b: __m128d, c: __m128d) -> __m128d {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_add_pd(_mm_mul_pd(a, b), c) }
    }

    arithmetic!(Sse2, [0 1]; _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd, multiply_then_add, _mm_set1_pd, _mm_sqrt_pd);

    lanes!(Sse2, 2, [0 1]; _mm_loadu_pd, _mm_storeu_pd);

    /// Two registers of AVX-512.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx512(__m512d, __m512d);

    arithmetic!(Avx512, [0 1]; _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_set1_pd, _mm512_sqrt_pd);
    lanes!(Avx512, 8, [0 1]; _mm512_loadu_pd, _mm512_storeu_pd);

    /// Two registers of AVX2 with FMA.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(__m256d, __m256d);

    arithmetic!(Avx2, [0 1]; _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_sqrt_pd);
    lanes!(Avx2, 4, [0 1]; _mm256_loadu_pd, _mm256_storeu_pd);
}

/// Plain numbers, for architectures without a unit named here.
#[cfg(not(target_arch = "x86_64"))]
pub mod plain {
    use super::*;

    #[derive(Clone, Copy, Debug)]
    pub struct Plain([f64; WIDTH]);

    macro_rules! plain {
        ($trait:ident, $method:ident, $assign:tt) => {
            impl $trait for Plain {
                type Output = Self;
                #[inline(always)]
                fn $method(mut self, other: Self) -> Self {
                    for (a, b) in self.0.iter_mut().zip(other.0) {
                        *a $assign b;
                    }
                    self
                }
            }
        };
    }

    plain!(Add, add, +=);
    plain!(Sub, sub, -=);
    plain!(Mul, mul, *=);
    plain!(Div, div, /=);

    impl Neg for Plain {
        type Output = Self;
        #[inline(always)]
        fn neg(mut self) -> Self {
            for a in &mut self.0 {
                *a = -*a;
            }
            self
        }
    }

    impl Real for Plain {
        #[inline(always)]
        fn of(x: f64) -> Self {
            Self([x; WIDTH])
        }

        #[inline(always)]
        fn mul_add(self, a: Self, b: Self) -> Self {
            self * a + b
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(self.0.map(f64::sqrt))
        }
    }

    impl Lanes for Plain {
        const LANES: usize = WIDTH;

        #[inline(always)]
        fn pack(lanes: [f64; WIDTH]) -> Self {
            Self(lanes)
        }

        #[inline(always)]
        fn unpack(self) -> [f64; WIDTH] {
            self.0
        }
    }
}

//! SIMD lanes as a scalar: eight trajectories integrated in step.
//!
//! The vector types hold registers of one SIMD unit. Their operators are inlined into functions compiled for
//! that unit (the wrappers of [`super::batch`]), the only place where such values are made.
#![allow(
    unsafe_code,
    reason = "vector instructions may run only where the unit exists; `Unit::detect` stands before every use"
)]

use super::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes of every bundle.
pub const WIDTH: usize = 8;

/// Eight numbers worked on in step, or one for comparison.
pub trait Lanes: Real {
    /// How many.
    const LANES: usize = WIDTH;

    /// From an array.
    fn pack(lanes: [f64; WIDTH]) -> Self;
    /// To an array.
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

/// The vector units of x86-64.
#[cfg(target_arch = "x86_64")]
pub mod x86 {
    use super::*;
    use std::arch::x86_64::*;

    /// Four registers of SSE2, which every processor of this architecture has; it has no fused multiply-add.
    #[derive(Clone, Copy, Debug)]
    pub struct Sse2(__m128d, __m128d, __m128d, __m128d);

    #[inline(always)]
    unsafe fn multiply_then_add(a: __m128d, b: __m128d, c: __m128d) -> __m128d {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_add_pd(_mm_mul_pd(a, b), c) }
    }

    arithmetic!(Sse2, [0 1 2 3]; _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd, multiply_then_add, _mm_set1_pd, _mm_sqrt_pd);

    impl Lanes for Sse2 {
        #[inline(always)]
        fn pack(lanes: [f64; WIDTH]) -> Self {
            let pair = |i: usize| {
                // SAFETY: two of eight numbers, `i` is at most 6; SSE2 is part of x86-64.
                unsafe { _mm_loadu_pd(lanes.as_ptr().add(i)) }
            };
            Self(pair(0), pair(2), pair(4), pair(6))
        }

        #[inline(always)]
        fn unpack(self) -> [f64; WIDTH] {
            let mut lanes = [0.0; WIDTH];
            for (i, pair) in [self.0, self.1, self.2, self.3].into_iter().enumerate() {
                // SAFETY: two of eight numbers, `i` is at most 3; SSE2 is part of x86-64.
                unsafe { _mm_storeu_pd(lanes.as_mut_ptr().add(2 * i), pair) };
            }
            lanes
        }
    }

    /// One register of AVX-512.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx512(__m512d);

    arithmetic!(Avx512, [0]; _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_set1_pd, _mm512_sqrt_pd);

    impl Lanes for Avx512 {
        #[inline(always)]
        fn pack(lanes: [f64; WIDTH]) -> Self {
            // SAFETY: eight numbers are read; see the module for the instruction.
            unsafe { Self(_mm512_loadu_pd(lanes.as_ptr())) }
        }

        #[inline(always)]
        fn unpack(self) -> [f64; WIDTH] {
            let mut lanes = [0.0; WIDTH];
            // SAFETY: eight numbers are written; see the module for the instruction.
            unsafe { _mm512_storeu_pd(lanes.as_mut_ptr(), self.0) };
            lanes
        }
    }

    /// Two registers of AVX2 with FMA.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(__m256d, __m256d);

    arithmetic!(Avx2, [0 1]; _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_sqrt_pd);

    impl Lanes for Avx2 {
        #[inline(always)]
        fn pack(lanes: [f64; WIDTH]) -> Self {
            // SAFETY: the first and the last four of eight numbers; see the module for the instruction.
            unsafe {
                Self(
                    _mm256_loadu_pd(lanes.as_ptr()),
                    _mm256_loadu_pd(lanes.as_ptr().add(WIDTH / 2)),
                )
            }
        }

        #[inline(always)]
        fn unpack(self) -> [f64; WIDTH] {
            let mut lanes = [0.0; WIDTH];
            // SAFETY: the first and the last four of eight numbers; see the module for the instruction.
            unsafe {
                _mm256_storeu_pd(lanes.as_mut_ptr(), self.0);
                _mm256_storeu_pd(lanes.as_mut_ptr().add(WIDTH / 2), self.1);
            }
            lanes
        }
    }
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

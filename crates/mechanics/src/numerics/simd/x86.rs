//! The vector units of x86-64.
//!
//! Why the instructions below are safe: vectors of a unit are of a type private to this file, so that only generic code makes
//! them, and only where [`SimdTask::run`] is called with that type: in a function that enables the unit's features. The
//! function is called by the unit's token alone, and a token comes from `detect` alone, after a look at the processor. Vectors
//! cannot outlive the call: neither the task nor its output can name their type, and nothing says that it is `'static`.
#![allow(
    unsafe_code,
    reason = "vector instructions may run only where the unit exists, which a token proves"
)]

use super::{Lanes, LanesTask, SimdTask, WIDTH};
use crate::numerics::Real;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Implements `$trait` for two registers, one after the other.
macro_rules! operator {
    ($vectors:ident, $trait:ident, $method:ident, $f:ident) => {
        impl $trait for $vectors {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($f(self.0, other.0), $f(self.1, other.1)) }
            }
        }
    };
}

/// A token that only `detect` makes, and two registers of `$each` numbers as lanes.
macro_rules! unit {
    (
        $(#[$doc:meta])* $token:ident, $enabled:literal, [$($feature:tt)+], $vectors:ident, $register:ty, $each:literal,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $fma:ident, $splat:ident, $sqrt:ident, $load:ident, $store:ident
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $token(());

        impl $token {
            /// The token, where the processor has all features of the unit.
            pub fn detect() -> Option<Self> {
                ($(is_x86_feature_detected!($feature))&&+).then_some(Self(()))
            }

            /// Does `task` in this unit's lanes.
            pub fn run<K: SimdTask>(self, task: K) -> K::Output {
                #[target_feature(enable = $enabled)]
                fn run<K: SimdTask>(task: K) -> K::Output {
                    task.run::<$vectors>()
                }
                // SAFETY: `detect` has seen every feature that the function enables.
                unsafe { run(task) }
            }
        }

        #[derive(Clone, Copy)]
        struct $vectors($register, $register);

        operator!($vectors, Add, add, $add);
        operator!($vectors, Sub, sub, $sub);
        operator!($vectors, Mul, mul, $mul);
        operator!($vectors, Div, div, $div);

        impl Neg for $vectors {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::of(-0.0) - self
            }
        }

        impl Real for $vectors {
            #[inline(always)]
            fn of(x: f64) -> Self {
                // SAFETY: this is called only where the unit exists; see the module.
                unsafe { Self($splat(x), $splat(x)) }
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($fma(self.0, a.0, b.0), $fma(self.1, a.1, b.1)) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($sqrt(self.0), $sqrt(self.1)) }
            }
        }

        impl Lanes for $vectors {
            const LANES: usize = {
                assert!(2 * $each <= WIDTH);
                2 * $each
            };

            #[inline(always)]
            fn pack(lanes: [f64; WIDTH]) -> Self {
                let from = lanes.as_ptr();
                // SAFETY: two registers are no longer than the array; see the module for the instructions.
                unsafe { Self($load(from), $load(from.add($each))) }
            }

            #[inline(always)]
            fn unpack(self) -> [f64; WIDTH] {
                let mut lanes = [0.0; WIDTH];
                let to = lanes.as_mut_ptr();
                // SAFETY: two registers are no longer than the array; see the module for the instructions.
                unsafe {
                    $store(to, self.0);
                    $store(to.add($each), self.1);
                }
                lanes
            }

            #[inline(always)]
            fn outlined<K: LanesTask<Self>>(task: K) -> K::Output {
                #[target_feature(enable = $enabled)]
                #[inline(never)]
                fn run<K: LanesTask<$vectors>>(task: K) -> K::Output {
                    task.run()
                }
                // SAFETY: this is called only where the unit exists; see the module.
                unsafe { run(task) }
            }
        }
    };
}

unit!(
    /// The processor has AVX-512.
    Avx512, "avx512f,avx512dq,avx512vl,fma", ["avx512f" "avx512dq" "avx512vl" "fma"], Vectors512, __m512d, 8,
    _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_set1_pd, _mm512_sqrt_pd,
    _mm512_loadu_pd, _mm512_storeu_pd
);
unit!(
    /// The processor has AVX2 with FMA.
    Avx2, "avx2,fma", ["avx2" "fma"], Vectors256, __m256d, 4,
    _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_sqrt_pd,
    _mm256_loadu_pd, _mm256_storeu_pd
);

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

/// Implements `$trait` for registers, one after the other.
macro_rules! operator {
    ($vectors:ident [$($i:tt)+], $trait:ident, $method:ident, $f:ident) => {
        impl $trait for $vectors {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($($f(self.$i, other.$i)),+) }
            }
        }
    };
}

/// Registers of `$each` numbers as lanes.
macro_rules! vectors {
    (
        $vectors:ident [$($i:tt $register:ty),+], $narrow:ident, $enabled:literal, $each:literal,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $fma:ident, $splat:ident, $sqrt:ident, $load:ident, $store:ident
    ) => {
        #[derive(Clone, Copy)]
        struct $vectors($($register),+);

        operator!($vectors [$($i)+], Add, add, $add);
        operator!($vectors [$($i)+], Sub, sub, $sub);
        operator!($vectors [$($i)+], Mul, mul, $mul);
        operator!($vectors [$($i)+], Div, div, $div);

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
                unsafe { Self { $($i: $splat(x)),+ } }
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($($fma(self.$i, a.$i, b.$i)),+) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: such values exist only where the unit does; see the module.
                unsafe { Self($($sqrt(self.$i)),+) }
            }
        }

        impl Lanes for $vectors {
            type Narrow = $narrow;

            const LANES: usize = {
                let lanes = $each * [$($i),+].len();
                assert!(lanes <= WIDTH);
                lanes
            };

            #[inline(always)]
            fn pack(lanes: [f64; WIDTH]) -> Self {
                let from = lanes.as_ptr();
                // SAFETY: the registers are no longer than the array; see the module for the instructions.
                unsafe { Self($($load(from.add($i * $each))),+) }
            }

            #[inline(always)]
            fn unpack(self) -> [f64; WIDTH] {
                let mut lanes = [0.0; WIDTH];
                let to = lanes.as_mut_ptr();
                // SAFETY: the registers are no longer than the array; see the module for the instructions.
                unsafe { $($store(to.add($i * $each), self.$i));+ }
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

/// A token that only `detect` makes, and one or two registers of `$each` numbers as lanes.
macro_rules! unit {
    (
        $(#[$doc:meta])* $token:ident, $enabled:literal, [$($feature:tt)+], $one:ident, $two:ident, $register:ty, $each:literal,
        $($instruction:ident),+
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
                    task.run::<$two>()
                }
                // SAFETY: `detect` has seen every feature that the function enables.
                unsafe { run(task) }
            }
        }

        vectors!($one [0 $register], $one, $enabled, $each, $($instruction),+);
        vectors!($two [0 $register, 1 $register], $one, $enabled, $each, $($instruction),+);
    };
}

unit!(
    /// The processor has AVX-512.
    Avx512, "avx512f,avx512dq,avx512vl,fma", ["avx512f" "avx512dq" "avx512vl" "fma"], Vector512, Vectors512, __m512d, 8,
    _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_set1_pd, _mm512_sqrt_pd,
    _mm512_loadu_pd, _mm512_storeu_pd
);
unit!(
    /// The processor has AVX2 with FMA.
    Avx2, "avx2,fma", ["avx2" "fma"], Vector256, Vectors256, __m256d, 4,
    _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_sqrt_pd,
    _mm256_loadu_pd, _mm256_storeu_pd
);

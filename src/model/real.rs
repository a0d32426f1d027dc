//! The scalar that the model is generic over.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or a bundle of them that is worked on in step.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The constant `x` in every lane.
    fn of(x: f64) -> Self;

    /// `self * a + b`, fused where the machine fuses it at no cost.
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// The square root.
    fn sqrt(self) -> Self;
}

macro_rules! scalar {
    ($t:ty) => {
        impl Real for $t {
            #[inline(always)]
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_lossless,
                trivial_numeric_casts,
                reason = "rounding to the scalar's own precision is what this function is for"
            )]
            fn of(x: f64) -> Self {
                x as $t
            }

            // `mul_add` of the standard library is a slow call where the target has no FMA.
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self * a + b
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
        }
    };
}

scalar!(f32);
scalar!(f64);

/// `(exp(x) - 1)/x` for `|x| <= 0.4`, by its Taylor polynomial of degree 12: truncation below 1e-16.
#[inline(always)]
pub(super) fn expm1_over_small<T: Real>(x: T) -> T {
    const FACTORIALS: [f64; 13] = [
        1.0,
        2.0,
        6.0,
        24.0,
        120.0,
        720.0,
        5040.0,
        40320.0,
        362_880.0,
        3_628_800.0,
        39_916_800.0,
        479_001_600.0,
        6_227_020_800.0,
    ];
    let mut sum = T::of(1.0 / FACTORIALS[12]);
    let mut i = 12;
    while i > 0 {
        i -= 1;
        sum = sum.mul_add(x, T::of(1.0 / FACTORIALS[i]));
    }
    sum
}

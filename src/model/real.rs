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

/// `1/(2k + 1)!` and `1/(2k + 2)!`: at 0.4 the first term left out is below 1e-17.
const HYPERBOLIC: [[f64; 2]; 7] = {
    let mut terms = [[1.0, 0.5]; 7];
    let mut k = 1;
    while k < terms.len() {
        let n = (2 * k) as f64;
        let [odd, even] = terms[k - 1];
        terms[k] = [odd / (n * (n + 1.0)), even / ((n + 1.0) * (n + 2.0))];
        k += 1;
    }
    terms
};

/// `sinh(x)/x` and `(cosh(x) - 1)/x^2` for `|x| <= 0.4`, by their Taylor polynomials: with them
/// `exp(x) = 1 + x (odd + x even)` and `exp(-x) = 1 - x (odd - x even)`.
#[inline(always)]
pub(super) fn hyperbolic_small<T: Real>(x: T) -> [T; 2] {
    let square = x * x;
    let mut sums = [T::of(0.0); 2];
    for [odd, even] in HYPERBOLIC.into_iter().rev() {
        sums[0] = sums[0].mul_add(square, T::of(odd));
        sums[1] = sums[1].mul_add(square, T::of(even));
    }
    sums
}

/// `(exp(x) - 1)/x` for `|x| <= 0.4`.
#[inline(always)]
pub(super) fn expm1_over_small<T: Real>(x: T) -> T {
    let [odd, even] = hyperbolic_small(x);
    x.mul_add(even, odd)
}

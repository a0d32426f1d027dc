//! The scalar type of generic code, and polynomials for elementary functions of small arguments.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or several in SIMD lanes.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Returns the constant `x`, in every lane.
    fn of(x: f64) -> Self;

    /// Returns `self * a + b`, rounded once where the processor does so at no cost.
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// Returns the square root of a number, or of each lane.
    fn sqrt(self) -> Self;
}

macro_rules! scalar {
    ($t:ty) => {
        impl Real for $t {
            #[inline(always)]
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

/// The polynomial in `$x` with these coefficients, the highest one first, by Horner's rule: written out, because a compiler
/// takes long to unroll many thousands of loops.
macro_rules! horner {
    ($x:expr; $highest:expr $(, $next:expr)*) => {{
        let sum = $highest;
        $(let sum = sum.mul_add($x, $next);)*
        sum
    }};
}
pub(crate) use horner;

/// Taylor coefficients `1/(2k + 1)!` and `1/(2k + 2)!`. At 0.4 the first term left out is below 1e-17.
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

/// The coefficients of the series `series` of `terms`.
const fn column<const N: usize>(terms: &[[f64; 2]; N], series: usize) -> [f64; N] {
    let mut column = [0.0; N];
    let mut k = 0;
    while k < N {
        column[k] = terms[k][series];
        k += 1;
    }
    column
}

/// Returns `odd = sinh(x)/x` and `even = (cosh(x) - 1)/x^2` for `|x| <= 0.4`, by their Taylor polynomials: `exp(x) = 1 + x (odd + x
/// even)` and `exp(-x) = 1 - x (odd - x even)`.
#[inline(always)]
pub fn hyperbolic_small<T: Real>(x: T) -> [T; 2] {
    let square = x * x;
    macro_rules! sum {
        ($i:literal) => {{
            let [a, b, c, d, e, f, g] = const { column(&HYPERBOLIC, $i) };
            horner!(square; T::of(g), T::of(f), T::of(e), T::of(d), T::of(c), T::of(b), T::of(a))
        }};
    }
    [sum!(0), sum!(1)]
}

/// Returns `(exp(x) - 1)/x` for `|x| <= 0.4`.
#[inline(always)]
pub fn expm1_over_small<T: Real>(x: T) -> T {
    let [odd, even] = hyperbolic_small(x);
    x.mul_add(even, odd)
}

/// Taylor coefficients of `sin(x)/x` and `(cos(x) - 1)/x^2` in `x^2`. The first terms left out are below 3e-14 at 0.25 and
/// below 3e-11 at 0.5.
const CIRCULAR: [[f64; 2]; 5] = {
    let mut terms = [[0.0; 2]; 5];
    let mut k = 0;
    while k < terms.len() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        terms[k] = [sign * HYPERBOLIC[k][0], -sign * HYPERBOLIC[k][1]];
        k += 1;
    }
    terms
};

/// Returns the unit vector rotated by a small `angle` (radians), by the Taylor polynomials of sine and cosine.
#[inline(always)]
pub fn rotated_by_small<T: Real>([x, y]: [T; 2], angle: T) -> [T; 2] {
    let square = angle * angle;
    let fourth = square * square;
    macro_rules! sum {
        ($i:literal) => {{
            let [a, b, c, d, e] = const { column(&CIRCULAR, $i) };
            let low = square.mul_add(T::of(b), T::of(a));
            let high = square.mul_add(T::of(d), T::of(c));
            fourth.mul_add(fourth.mul_add(T::of(e), high), low)
        }};
    }
    let (sin, versed) = (angle * sum!(0), square * sum!(1));
    [(-sin).mul_add(y, versed.mul_add(x, x)), sin.mul_add(x, versed.mul_add(y, y))]
}

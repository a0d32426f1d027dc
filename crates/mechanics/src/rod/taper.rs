//! Radius and arclength of a linear taper, in SIMD lanes: the exponential function is computed by algebra.

use crate::numerics::{Real, expm1_over_small};

/// Halvings of the exponent: `expm1_over_small` is valid up to 0.4, and `beta tau` of every whisker is at most 25.6.
const HALVINGS: u32 = 6;

/// Returns the radius over the base radius, `exp(-beta tau)`, and the arclength in whisker lengths, `(1 - exp(-beta tau))/beta`, at
/// `tau`. Both are accurate to 32 times the rounding.
#[inline(always)]
pub fn radius_and_arclength<T: Real>(taper: T, tau: T) -> [T; 2] {
    let (one, half) = (T::of(1.0), T::of(0.5));
    let mut part = T::of(-1.0 / f64::from(1 << HALVINGS)) * taper * tau;
    // (exp(part) - 1)/part, for twice the part in each turn.
    let mut growth = expm1_over_small(part);
    let mut radius = part.mul_add(growth, one);
    for _ in 0..HALVINGS {
        growth = growth * (half * part).mul_add(growth, one);
        part = part + part;
        radius = radius * radius;
    }
    [radius, tau * growth]
}

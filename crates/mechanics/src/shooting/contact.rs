//! Contacts, at which trajectories start, in SIMD lanes. Exponential and inverse functions are computed by algebra, so that a block of
//! contacts costs about as much as one contact with library functions.

use crate::numerics::{Real, rotated_by_small};
use crate::rod::radius_and_arclength;

/// Start of a trajectory: radius, force, tangent, stiffness and curvature at the contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T> {
    /// Radius at the contact over the base radius.
    pub radius: T,
    /// Signed force at the contact, `F L_w^2/(E I_base)`, with friction. Without friction it is the normal force.
    pub force: T,
    /// Unit tangent `[x, y]` of the whisker at the contact, see [`Rod::contact_tangent`](crate::rod::Rod::contact_tangent).
    pub tangent: [T; 2],
    /// Bending stiffness at the contact over the bending stiffness at the base.
    pub stiffness: T,
    /// Curvature at rest at the contact, in radians per whisker length.
    pub curvature: T,
    /// Derivative of the curvature at rest at the contact by the arclength, in radians per squared whisker length.
    pub curvature_slope: T,
}

/// Returns the exponential of a number of magnitude 25.6 at most, to within 32 times the rounding.
#[inline(always)]
pub fn exp<T: Real>(x: T) -> T {
    let [exp, _] = radius_and_arclength(T::of(-1.0), x);
    exp
}

/// Doublings of an angle: [`rotated_by_small`] is accurate to 1e-18 at 0.1 radians.
const DOUBLINGS: u32 = 8;

/// Returns the unit vector `[cos, sin]` in the direction of an `angle` of at most 25 radians, to within 256 times the rounding.
#[inline(always)]
pub fn direction<T: Real>(angle: T) -> [T; 2] {
    let part = T::of(1.0 / f64::from(1 << DOUBLINGS)) * angle;
    let [mut cos, mut sin] = rotated_by_small([T::of(1.0), T::of(0.0)], part);
    for _ in 0..DOUBLINGS {
        let twice = cos + cos;
        (cos, sin) = (cos * cos - sin * sin, twice * sin);
    }
    [cos, sin]
}

/// Returns the unit tangent of the parabola `y = bend x^2 + slope x` at arclength `s`; `at_base` is the [`arc`] of `slope`.
#[inline(always)]
pub fn parabola_tangent<T: Real>(bend: T, at_base: T, s: T) -> [T; 2] {
    let (one, half) = (T::of(1.0), T::of(0.5));
    let z = T::of(4.0) * bend * s + at_base;
    // As in `Parabola::slope_at`.
    let square = z * z;
    let power = square
        .mul_add(T::of(0.253) + T::of(0.0437) * square.sqrt() + T::of(1.0 / 256.0) * square, one);
    let t = half * z / power.sqrt().sqrt().sqrt();
    let square = t * t;
    let root_square = one + square;
    let d = half * (z - arc(t)) / root_square.sqrt();
    let e = d / root_square;
    let [c2, c3, c4, c5, c6] = [
        -half * t,
        half.mul_add(square, T::of(-1.0 / 6.0)),
        t * T::of(-15.0 / 24.0).mul_add(square, T::of(13.0 / 24.0)),
        square.mul_add(
            T::of(105.0 / 120.0).mul_add(square, T::of(-162.0 / 120.0)),
            T::of(13.0 / 120.0),
        ),
        t * square.mul_add(
            T::of(-945.0 / 720.0).mul_add(square, T::of(2202.0 / 720.0)),
            T::of(-493.0 / 720.0),
        ),
    ];
    let tail = e.mul_add(e.mul_add(e.mul_add(e.mul_add(c6, c5), c4), c3), c2);
    let t = t + d * e.mul_add(tail, one);
    let cos = one / t.mul_add(t, one).sqrt();
    [cos, t * cos]
}

/// Number of terms of the series of `atanh(w)/w` in `w^2`, even. Up to `w = 0.47`, an eighth of `asinh(30)`, the remainder is
/// below 1e-16.
pub const ARC_TERMS: u32 = 24;

/// Returns `t sqrt(1 + t^2) + asinh(t)`, by halving the argument of `asinh` three times.
#[inline(always)]
pub fn arc<T: Real>(t: T) -> T {
    let (one, half) = (T::of(1.0), T::of(0.5));
    let root = t.mul_add(t, one).sqrt();
    let first = (half * (one + root)).sqrt();
    let second = (half * (one + first)).sqrt();
    let third = (half * (one + second)).sqrt();
    let w = t / (T::of(8.0) * first * second * third * third);
    let square = w * w;
    // Even and odd powers of the square: two short chains of multiplications in place of a long one.
    let fourth = square * square;
    let (mut even, mut odd) = (T::of(0.0), T::of(0.0));
    for k in (0..ARC_TERMS / 2).rev() {
        even = even.mul_add(fourth, T::of(1.0 / f64::from(4 * k + 1)));
        odd = odd.mul_add(fourth, T::of(1.0 / f64::from(4 * k + 3)));
    }
    t.mul_add(root, T::of(8.0) * w * odd.mul_add(square, even))
}

//! Numerics that is independent of whiskers: scalars and SIMD lanes, vectors, polynomials, roots.

mod bracket;
pub mod chebyshev;
mod dual;
pub mod expansion;
pub mod gauss;
mod golden;
pub mod inverse;
pub mod newton_form;
mod real;
mod simd;
pub mod tensor;
mod vector;

pub use bracket::{Bracket, Root, illinois};
pub use dual::{Dual, Scalar};
pub use golden::least_between;
pub(crate) use real::horner;
pub use real::{Real, expm1_over_small, hyperbolic_small, rotated_by_small};
pub use simd::{ArithmeticClass, LaneNumbers, Lanes, LanesTask, SimdTask, Unit, WIDTH, keep, pack};
pub use vector::Vector;

use std::f64::consts::TAU;

/// Returns `angle` plus the number of full turns that brings it nearest to `near`, all in radians.
#[must_use]
pub fn nearest_turn(angle: f64, near: f64) -> f64 {
    angle + TAU * ((near - angle) / TAU).round()
}

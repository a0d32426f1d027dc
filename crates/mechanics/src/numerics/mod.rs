//! Numerics without a whisker: scalars and SIMD lanes, vectors, polynomials, roots.

mod bracket;
pub mod chebyshev;
mod complex;
pub mod divided_differences;
pub mod gauss;
pub mod lobatto;
pub mod newton_form;
pub mod newton_form_simd;
mod real;
mod simd;
pub mod taylor;
mod turn;
mod vector;

pub use bracket::{Bracket, Root, illinois};
pub use complex::Complex;
pub(crate) use real::horner;
pub use real::{Real, expm1_over_small, hyperbolic_small, rotated_by_small};
pub use simd::{ArithmeticClass, Lanes, LanesTask, SimdTask, Unit, WIDTH};
pub use turn::nearest_turn;
pub use vector::Vector;

//! Properties of a whisker: radius, shape at rest, stiffness, contact, effects, units. Plain `f64`, lengths in whisker lengths.

mod curvature_polynomial;
mod demands;
mod derivative;
mod effects;
mod piece_weights;
mod radius;
mod rest;
#[allow(clippy::module_inception, reason = "the module is named after its main type")]
mod rod;
mod taper;
mod units;

pub use curvature_polynomial::{CURVATURE_TERMS, CurvaturePolynomial};
pub use demands::{Demand, Demands};
pub use derivative::RodDerivative;
pub use effects::Effects;
pub use radius::{Piece, RadiusProfile};
pub use rest::Rest;
pub(crate) use rod::arclength_at;
pub use rod::{PERFECT_CONE_CUT, Rod, Side, arclength};
pub use taper::radius_and_arclength;
pub use units::Units;

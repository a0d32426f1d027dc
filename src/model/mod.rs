//! The physics: an elastic rod seen from its contact with the pole.
//!
//! Lengths are in whisker lengths `L_w`, loads in `E I_base / L_w^2`. The rod is integrated backward, from
//! the contact (origin, tangent along `e1`, no moment) to the base, so that `(contact, load) -> base pose` is
//! explicit and no boundary-value problem is left. A trajectory yields the position of the pole in the frame
//! of the base together with its derivatives; everything else in the crate is built from those.
//!
//! All code here is generic over the scalar ([`Real`]): one text serves `f64`, the SIMD lanes of [`batch`],
//! and `f32`, in which it is the twin of `shaders/`.

pub mod batch;
mod complex;
mod contact;
mod effects;
mod integrator;
mod intrinsic;
mod landing;
mod material;
mod nystrom8;
pub mod order;
pub mod profile;
mod radius;
mod real;
mod resolution;
mod rest;
mod rhs;
mod rk4;
mod rod;
mod simd;
mod start;
mod turn;
mod units;
mod vector;

pub use batch::{First, FirstAndEnergy, Second};
pub(crate) use contact::exp;
pub use effects::Effects;
pub use integrator::{Integrator, Scales, Stage, integrate};
pub use intrinsic::{Bent, Intrinsic, Spiral, Straight};
pub use landing::{Base, Change, Curved, Full, LONGEST_STEP, Landing, Moving, limited};
pub use material::{Even, Graded, Material, Measured, Swing};
pub use nystrom8::Nystrom8;
pub use radius::{Piece, RadiusProfile};
pub use real::Real;
pub use resolution::Resolution;
pub use rest::Rest;
pub use rhs::{Carried, Planar, RodSystem, Section, Sensitivity, Shape, State};
pub use rk4::Rk4;
pub use rod::{PERFECT_CONE_CUT, Rod, Side};
pub use start::{Start, arclength};
pub use turn::nearest_turn;
pub use units::{Reader, Reading, Units};
pub use vector::Vector;

//! Shooting: the rod integrated from its contact with the pole to its base.
//!
//! Lengths are in whisker lengths `L_w`, loads in `E I_base / L_w^2`. The rod is integrated backward, from
//! the contact (origin, tangent along `e1`, no moment) to the base, so that `(contact, load) -> base pose` is
//! explicit and no boundary-value problem is left. A trajectory yields the position of the pole in the frame
//! of the base together with its derivatives; everything else in the crate is built from those.
//!
//! All code here is generic over the scalar ([`Real`](crate::numerics::Real)): one text serves `f64` and the SIMD lanes of [`batch`].
//! `shaders/nystrom8.wgsl` is its twin, for two trajectories side by side.

pub mod batch;
pub mod contact;
mod integrator;
mod intrinsic;
mod map;
mod material;
mod reading;
mod resolution;
mod rhs;
pub mod sensitivity;
pub mod shape;

pub use integrator::{
    Backward, Integrator, Nystrom8, Rk4, STAGES, Scales, Stage, collocate, integrate,
};
pub use intrinsic::{
    Bent, Intrinsic, Spiral, Straight, TANGENT as REST_TANGENT, TERMS as REST_TERMS,
};
pub use map::{
    FirstVariation, FullState, LONGEST_STEP, SecondVariation, ShootingMap, StateDerivative, limited,
};
pub use material::{Graded, Liouville, Material, Measured, Uniform};
pub use reading::{Reader, Reading};
pub use resolution::{PieceSteps, Resolution};
pub use rhs::{Carried, Planar, RodSystem, Section, Sensitivity, Shape, State};

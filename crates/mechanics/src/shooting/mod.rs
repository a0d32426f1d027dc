//! Shooting: integration of the rod from its contact with the pole to its base.
//!
//! Lengths are in whisker lengths `L_w`, loads in `E I_base / L_w^2`. The rod is integrated backward, from the contact (origin,
//! tangent along `e1`, no moment) to the base. The map `(contact, load) -> base pose` is then explicit, and no boundary-value
//! problem is left. A trajectory yields the pole's position in the frame of the base with its derivatives.
//!
//! The code is generic over the scalar ([`Real`](crate::numerics::Real)): it serves `f64` and the SIMD lanes of [`batch`]. Its
//! twin `shaders/shoot.wgsl` integrates trajectories without derivatives on a GPU, one per invocation.

pub mod batch;
pub mod contact;
mod derivative;
mod integrator;
mod intrinsic;
mod map;
mod material;
mod mount;
mod parabola;
mod reading;
mod resolution;
pub mod sensitivity;
pub mod shape;
mod strain;
mod system;

pub use derivative::{TrajectoryVariable, VariationDerivative, differentiate};
pub use integrator::{
    BackwardCompliance, Nystrom8, STAGES, Scales, StepObserver, StepStage, collocate, integrate,
};
pub use intrinsic::{Intrinsic, Polynomial, Spiral, Straight};
pub use map::{
    FirstVariation, FullState, LONGEST_STEP, PlainState, SecondVariation, ShootingMap,
    StateDerivative, limited,
};
pub use material::{Graded, Liouville, Material, Measured, Uniform};
pub use parabola::{Bent, TANGENT as REST_TANGENT, TERMS as REST_TERMS};
pub use reading::{Dimension, Reader, Reading, StateNumbers};
pub use resolution::{PieceSteps, Resolution, StepRule};
pub use strain::{PeakStrain, StepNodes, bending_strain};
pub use system::{
    Carried, NoSensitivity, Planar, RodSystem, Section, Sensitivity, TrajectoryState,
};

//! Equations of the rod in `sigma = tau_contact - tau`, from the contact (0) backward to the base.
//!
//! With the radius `rho`, the stiffness `S` and `w = rho/S`, `d/dsigma = -rho d/da` turns `dtheta/da = kappa_i - f X/S` into
//! `dtheta/dsigma = -(rho kappa_i - f X w)`. The unit tangent `(c, s)` replaces `theta`, so that no step needs trigonometry.

use crate::numerics::{Real, Vector};
use crate::shooting::Intrinsic;

/// A cross-section of the rod: radius and arclength.
#[derive(Clone, Copy, Debug)]
pub struct Section<T> {
    /// Radius `rho` of the cross-section over the base radius.
    pub rho: T,
    /// Inverse cube `1/rho^3` of the cross-section's radius over the base radius.
    pub inverse_cube: T,
    /// Arclength of the cross-section from the base, in whisker lengths.
    pub arclength: T,
}

/// State of the rod at a cross-section, `[c, s, X, Y, bent]`: unit tangent, position in whisker lengths, and rotation by bending since
/// the contact in radians.
pub type Planar<T> = [T; 5];

/// Derivatives that a trajectory carries beside the rod: of angles, of the levers that turn them, and of integrals.
pub trait Sensitivity<T: Real>: 'static {
    /// Derivatives of angles that a trajectory carries, in radians; it carries as many derivatives of levers.
    type Pairs: Vector<T>;

    /// Integrals that a trajectory carries, on which no other equation depends.
    type Sums: Vector<T>;

    /// Returns `dangles/dsigma` over the compliance under the force `f`: the derivatives of the moment `f X`.
    fn moments(f: T, x: T, levers: Self::Pairs) -> Self::Pairs;

    /// Returns `dlevers/dsigma` and `dsums/dsigma` over the radius: derivatives of `-cos theta` and `-sin theta` for the tangent `(c,
    /// s)`, which bending has turned by `bent`.
    fn pull(c: T, s: T, bent: T, angles: Self::Pairs) -> (Self::Pairs, Self::Sums);
}

/// Empty set of derivatives: a trajectory computes the shape alone.
#[derive(Clone, Copy, Debug)]
pub struct NoSensitivity;

impl<T: Real> Sensitivity<T> for NoSensitivity {
    type Pairs = ();
    type Sums = ();

    #[inline(always)]
    fn moments(_: T, _: T, (): ()) {}

    #[inline(always)]
    fn pull(_: T, _: T, _: T, (): ()) -> ((), ()) {
        ((), ())
    }
}

/// Derivatives that a trajectory carries: of angles, of levers, and sums.
pub type Carried<T, S> =
    (<S as Sensitivity<T>>::Pairs, (<S as Sensitivity<T>>::Pairs, <S as Sensitivity<T>>::Sums));

/// State of a trajectory: rest shape, rod and carried derivatives.
pub type TrajectoryState<T, I, S> = (<I as Intrinsic<T>>::State, (Planar<T>, Carried<T, S>));

/// Equations of the rod, its rest shape and the carried derivatives.
#[derive(Clone, Copy, Debug)]
pub struct RodSystem<T, I, C> {
    /// Signed force `f` at the contact, in `E I_base/L_w^2`.
    pub force: T,
    /// Rest shape of the rod, as its curvature.
    pub intrinsic: I,
    /// Material of the rod: its bending stiffness.
    pub material: C,
}

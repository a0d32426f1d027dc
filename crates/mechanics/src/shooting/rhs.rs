//! The right-hand sides of the rod's equations in `sigma = tau_contact - tau`, from the contact (0) backward to the base.
//!
//! With the radius `rho`, the stiffness `S` and `w = rho/S`, `d/dsigma = -rho d/da` turns `dtheta/da = kappa_i - f X/S` into
//! `dtheta/dsigma = -(rho kappa_i - f X w)`. The unit tangent `(c, s)` replaces `theta`, so that no step needs trigonometry.

use crate::numerics::{Real, Vector};
use crate::shooting::{Intrinsic, Material};

/// A cross-section of the rod.
#[derive(Clone, Copy, Debug)]
pub struct Section<T> {
    /// Radius over the base radius, `rho`.
    pub rho: T,
    /// Inverse cube of the radius, `1/rho^3`.
    pub inverse_cube: T,
    /// Arclength from the base, in whisker lengths.
    pub arclength: T,
}

/// State of the rod: `c, s, X, Y`, and the angle by which bending has turned it since the contact, in radians.
pub type Planar<T> = [T; 5];

/// Derivatives that a trajectory carries beside the rod: of angles, of the levers that turn them, and of integrals.
pub trait Sensitivity<T: Real>: 'static {
    /// Derivatives of angles; as many derivatives of levers.
    type Pairs: Vector<T>;

    /// Integrals, on which no other equation depends.
    type Sums: Vector<T>;

    /// `dangles/dsigma` over the compliance under the force `f`: the derivatives of the moment `f X`.
    fn moments(f: T, x: T, levers: Self::Pairs) -> Self::Pairs;

    /// `dlevers/dsigma` and `dsums/dsigma` over the radius: derivatives of `-cos theta` and `-sin theta` for the tangent `(c, s)`,
    /// which bending has turned by `bent`.
    fn pull(c: T, s: T, bent: T, angles: Self::Pairs) -> (Self::Pairs, Self::Sums);
}

/// The empty set of derivatives: the shape alone.
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

/// Carried derivatives: angles, levers and sums.
pub type Carried<T, S> = (
    <S as Sensitivity<T>>::Pairs,
    (<S as Sensitivity<T>>::Pairs, <S as Sensitivity<T>>::Sums),
);

/// State of a trajectory: rest shape, rod, derivatives.
pub type TrajectoryState<T, I, S> = (<I as Intrinsic<T>>::State, (Planar<T>, Carried<T, S>));

/// Equations of the rod, its rest shape and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct RodSystem<T, I, C> {
    /// Signed force `f` at the contact, in `E I_base/L_w^2`.
    pub force: T,
    /// Curvature at rest.
    pub intrinsic: I,
    /// Stiffness along the rod.
    pub material: C,
}

impl<T: Real, I: Intrinsic<T>, C: Material<T>> RodSystem<T, I, C> {
    /// Right-hand side `dstate/dsigma`.
    #[inline(always)]
    pub fn rhs<S: Sensitivity<T>>(
        &self,
        section: Section<T>,
        (rest, (rod, (angles, (levers, _)))): TrajectoryState<T, I, S>,
    ) -> TrajectoryState<T, I, S> {
        let [c, s, x, _, bent] = rod;
        let rho = section.rho;
        let w = self.material.compliance(&section);
        let (turn_at_rest, rest_rhs) = self.intrinsic.rhs(&section, rest);
        let bend = self.force * x * w;
        let turn = turn_at_rest - bend;
        let (pull, climb) = S::pull(c, s, bent, angles);
        let rod_rhs = [turn * s, -turn * c, -rho * c, -rho * s, bend];
        let turns = S::moments(self.force, x, levers).times(w);
        (
            rest_rhs,
            (rod_rhs, (turns, (pull.times(rho), climb.times(rho)))),
        )
    }
}

//! The right-hand sides, in `sigma = tau_contact - tau`: from the contact (0) backward to the base.
//!
//! With `rho` the radius, `S` the stiffness and `w = rho/S`, `d/dsigma = -rho d/da` turns
//! `dtheta/da = kappa_i - f X/S` into `dtheta/dsigma = -(rho kappa_i - f X w)`. The unit tangent `(c, s)` stands for `theta`: no
//! trigonometry in the loop.

use crate::numerics::{Real, Vector};
use crate::shooting::{Intrinsic, Material};

/// The rod at a place.
#[derive(Clone, Copy, Debug)]
pub struct Section<T> {
    /// Radius over the base radius, `rho`.
    pub rho: T,
    /// `1/rho^3`.
    pub inverse_cube: T,
    /// Arclength from the base; only kernels that need it carry it.
    pub arclength: T,
}

/// The rod itself: `c, s, X, Y`, and how far bending has turned it since the contact.
pub type Planar<T> = [T; 5];

/// Derivatives carried beside the rod: of angles, of the levers that turn them, and of what only adds up.
pub trait Sensitivity<T: Real>: 'static {
    /// The angles, and as many levers.
    type Pairs: Vector<T>;

    /// What nothing depends on.
    type Sums: Vector<T>;

    /// `dangles/dsigma` over the compliance, under the force `f`: derivatives of the moment `f X`.
    fn moments(f: T, x: T, levers: Self::Pairs) -> Self::Pairs;

    /// `dlevers/dsigma` and `dsums/dsigma` over the radius: derivatives of `-cos theta` and of `-sin theta`, where the tangent is
    /// `(c, s)` and bending has turned it by `bent`.
    fn pull(c: T, s: T, bent: T, angles: Self::Pairs) -> (Self::Pairs, Self::Sums);
}

/// No derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Shape;

impl<T: Real> Sensitivity<T> for Shape {
    type Pairs = ();
    type Sums = ();

    #[inline(always)]
    fn moments(_: T, _: T, (): ()) {}

    #[inline(always)]
    fn pull(_: T, _: T, _: T, (): ()) -> ((), ()) {
        ((), ())
    }
}

/// Angles, levers and sums.
pub type Carried<T, S> = (
    <S as Sensitivity<T>>::Pairs,
    (<S as Sensitivity<T>>::Pairs, <S as Sensitivity<T>>::Sums),
);

/// A trajectory's whole state: rest shape, rod, sensitivities.
pub type State<T, I, S> = (<I as Intrinsic<T>>::State, (Planar<T>, Carried<T, S>));

/// Rod, rest shape and sensitivities as one system of equations.
#[derive(Clone, Copy, Debug)]
pub struct RodSystem<T, I, C> {
    /// Load `f`.
    pub force: T,
    /// Curvature at rest.
    pub intrinsic: I,
    /// Stiffness of the material.
    pub material: C,
}

impl<T: Real, I: Intrinsic<T>, C: Material<T>> RodSystem<T, I, C> {
    /// `dstate/dsigma`.
    #[inline(always)]
    pub fn rhs<S: Sensitivity<T>>(
        &self,
        section: Section<T>,
        (rest, (rod, (angles, (levers, _)))): State<T, I, S>,
    ) -> State<T, I, S> {
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

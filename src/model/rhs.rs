//! The right-hand sides, in `sigma = tau_contact - tau`: from the contact (0) backward to the base.
//!
//! With `rho` the radius and `w = 1/rho^3`, `d/dsigma = -rho d/da` turns `dtheta/da = kappa_i - f X/rho^4`
//! into `dtheta/dsigma = -(rho kappa_i - f X w)`. The unit tangent `(c, s)` stands for `theta`: no
//! trigonometry in the loop.

use super::{Real, Vector};

/// Radius of the rod at a stage.
#[derive(Clone, Copy, Debug)]
pub struct Radius<T> {
    /// `rho`.
    pub rho: T,
    /// `1/rho^3`.
    pub inverse_cube: T,
}

/// Curvature at rest.
pub trait Intrinsic<T: Real>: Copy {
    /// What has to be carried along to know it.
    type State: Vector<T>;

    /// `(rho kappa_i, dstate/dsigma)`.
    fn rhs(self, rho: T, state: Self::State) -> (T, Self::State);
}

/// Straight at rest: nothing to carry.
#[derive(Clone, Copy, Debug)]
pub struct Straight;

impl<T: Real> Intrinsic<T> for Straight {
    type State = ();

    #[inline(always)]
    fn rhs(self, _: T, (): ()) -> (T, ()) {
        (T::of(0.0), ())
    }
}

/// Parabola at rest: carries cos and sin of the rest tangent, `kappa_i = 2 A cos^3` (paper, Eq. 10).
#[derive(Clone, Copy, Debug)]
pub struct Bent<T> {
    /// `2 A*`.
    pub twice_bend: T,
}

impl<T: Real> Intrinsic<T> for Bent<T> {
    type State = [T; 2];

    #[inline(always)]
    fn rhs(self, rho: T, [cos, sin]: [T; 2]) -> (T, [T; 2]) {
        let turn = rho * self.twice_bend * cos * cos * cos;
        (turn, [turn * sin, -turn * cos])
    }
}

/// The rod itself: `c, s, X, Y`.
pub type Planar<T> = [T; 4];

/// Derivatives carried beside the rod: `N` states.
pub trait Sensitivity<const N: usize> {
    /// Their right-hand sides at `rod` under the force `f`.
    fn rhs<T: Real>(f: T, radius: Radius<T>, rod: &Planar<T>, state: &[T; N]) -> [T; N];
}

/// No derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Shape;

impl Sensitivity<0> for Shape {
    #[inline(always)]
    fn rhs<T: Real>(_: T, _: Radius<T>, _: &Planar<T>, _: &[T; 0]) -> [T; 0] {
        []
    }
}

/// A trajectory's whole state: rest shape, rod, sensitivities.
pub type State<T, I, const N: usize> = (<I as Intrinsic<T>>::State, (Planar<T>, [T; N]));

/// Rod, rest shape and sensitivities as one system of equations.
#[derive(Clone, Copy, Debug)]
pub struct RodSystem<T, I> {
    /// Load `f`.
    pub force: T,
    /// Curvature at rest.
    pub intrinsic: I,
}

impl<T: Real, I: Intrinsic<T>> RodSystem<T, I> {
    /// `dstate/dsigma`.
    #[inline(always)]
    pub fn rhs<S: Sensitivity<N>, const N: usize>(
        &self,
        radius: Radius<T>,
        (rest, (rod, sens)): State<T, I, N>,
    ) -> State<T, I, N> {
        let [c, s, x, _] = rod;
        let (turn_at_rest, rest_rhs) = self.intrinsic.rhs(radius.rho, rest);
        let turn = turn_at_rest - self.force * x * radius.inverse_cube;
        let rod_rhs = [turn * s, -turn * c, -radius.rho * c, -radius.rho * s];
        (rest_rhs, (rod_rhs, S::rhs(self.force, radius, &rod, &sens)))
    }
}

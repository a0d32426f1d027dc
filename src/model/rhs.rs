//! The right-hand sides, in `sigma = tau_contact - tau`: from the contact (0) backward to the base.
//!
//! With `rho` the radius, `S` the stiffness and `w = rho/S`, `d/dsigma = -rho d/da` turns
//! `dtheta/da = kappa_i - f X/S` into `dtheta/dsigma = -(rho kappa_i - f X w)`. The unit tangent `(c, s)` stands for `theta`: no
//! trigonometry in the loop.

use super::{Real, Vector};

/// The rod at a stage.
#[derive(Clone, Copy, Debug)]
pub struct Section<T> {
    /// Radius over the base radius, `rho`.
    pub rho: T,
    /// `1/rho^3`.
    pub inverse_cube: T,
    /// Arclength from the base; only kernels that need it carry it.
    pub arclength: T,
}

/// How the material stiffens along the rod.
pub trait Material<T: Real>: Copy {
    /// `rho/S` at a section: what turns a moment into `dtheta/dtau`.
    fn compliance(self, section: &Section<T>) -> T;
}

/// The same modulus everywhere: `S = rho^4`.
#[derive(Clone, Copy, Debug)]
pub struct Even;

impl<T: Real> Material<T> for Even {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        section.inverse_cube
    }
}

/// A modulus that is linear in the arclength: `S = rho^4 (1 + g s)`.
#[derive(Clone, Copy, Debug)]
pub struct Graded<T> {
    /// `g`.
    pub gradient: T,
}

impl<T: Real> Material<T> for Graded<T> {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        section.inverse_cube / self.gradient.mul_add(section.arclength, T::of(1.0))
    }
}

/// Measured radii, and a modulus that is linear in the arclength: `S = r(s)^4 (1 + g s)` on one cubic piece of `r`.
#[derive(Clone, Copy, Debug)]
pub struct Measured<T> {
    /// Arclength where the piece begins.
    pub from: T,
    /// Coefficients of the radius there.
    pub cubic: [T; 4],
    /// `g`.
    pub gradient: T,
}

impl<T: Real> Material<T> for Measured<T> {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        let x = section.arclength - self.from;
        let [c0, c1, c2, c3] = self.cubic;
        let radius = x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0);
        let square = radius * radius;
        section.rho / (square * square * self.gradient.mul_add(section.arclength, T::of(1.0)))
    }
}

/// Curvature at rest.
pub trait Intrinsic<T: Real>: Copy {
    /// What has to be carried along to know it.
    type State: Vector<T>;

    /// `(rho kappa_i, dstate/dsigma)`.
    fn rhs(self, section: &Section<T>, state: Self::State) -> (T, Self::State);
}

/// Straight at rest: nothing to carry.
#[derive(Clone, Copy, Debug)]
pub struct Straight;

impl<T: Real> Intrinsic<T> for Straight {
    type State = ();

    #[inline(always)]
    fn rhs(self, _: &Section<T>, (): ()) -> (T, ()) {
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
    fn rhs(self, section: &Section<T>, [cos, sin]: [T; 2]) -> (T, [T; 2]) {
        let turn = section.rho * self.twice_bend * cos * cos * cos;
        (turn, [turn * sin, -turn * cos])
    }
}

/// Euler spiral at rest, `kappa_i = k0 + k1 s` (E. L. Starostin et al., Science Advances 6, eaax5145, 2020): nothing to
/// carry.
#[derive(Clone, Copy, Debug)]
pub struct Spiral<T> {
    /// `k0`.
    pub at_base: T,
    /// `k1`.
    pub slope: T,
}

impl<T: Real> Intrinsic<T> for Spiral<T> {
    type State = ();

    #[inline(always)]
    fn rhs(self, section: &Section<T>, (): ()) -> (T, ()) {
        let curvature = self.slope.mul_add(section.arclength, self.at_base);
        (section.rho * curvature, ())
    }
}

/// The rod itself: `c, s, X, Y`.
pub type Planar<T> = [T; 4];

/// Derivatives carried beside the rod.
pub trait Sensitivity<T: Real>: 'static {
    /// Their values.
    type State: Vector<T>;

    /// Their right-hand sides at `rod` under the force `f`, where the radius is `rho` and the compliance `w`.
    fn rhs(f: T, rho: T, w: T, rod: &Planar<T>, state: Self::State) -> Self::State;
}

/// No derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Shape;

impl<T: Real> Sensitivity<T> for Shape {
    type State = ();

    #[inline(always)]
    fn rhs(_: T, _: T, _: T, _: &Planar<T>, (): ()) {}
}

/// A trajectory's whole state: rest shape, rod, sensitivities.
pub type State<T, I, S> = (
    <I as Intrinsic<T>>::State,
    (Planar<T>, <S as Sensitivity<T>>::State),
);

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
        (rest, (rod, sens)): State<T, I, S>,
    ) -> State<T, I, S> {
        let [c, s, x, _] = rod;
        let rho = section.rho;
        let w = self.material.compliance(&section);
        let (turn_at_rest, rest_rhs) = self.intrinsic.rhs(&section, rest);
        let turn = turn_at_rest - self.force * x * w;
        let rod_rhs = [turn * s, -turn * c, -rho * c, -rho * s];
        (rest_rhs, (rod_rhs, S::rhs(self.force, rho, w, &rod, sens)))
    }
}

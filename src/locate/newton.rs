//! Numbers at the base of a state, their derivatives, and Newton's method to the state with given numbers.
//!
//! In the frame of the contact, where the force `f` is along the second axis, the base has the position `(x, y)` and the tangent `t`.
//! The numbers at the base are `M = -f x`, `Fx = f t.y` and `Fy = f t.x`: the force times its [`lever`]. Their derivatives are by the
//! logarithms of the contact's arclength and of the load, so that a step has one meaning at all contacts and loads.

use crate::newton::{NewtonProblem, NewtonStep};
use glam::{DVec2, DVec3};
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::{FirstVariation, FullState, StateDerivative};

/// Longest Newton step in the logarithms of contact and load.
const LONGEST: f64 = 0.5;

/// Newton step in the logarithms of contact and load whose end is extrapolated. The remaining error is its square.
const LAST: f64 = 1e-7;

/// Moment, force along the base's tangent and force to its left of a state, `[M, Fx, Fy]`, over the signed force at its contact.
pub fn lever(full: &FullState) -> DVec3 {
    DVec3::new(-full.position.x, full.tangent.y, full.tangent.x)
}

/// Derivative of the [`lever`] of a state by a variable.
pub fn lever_by(full: &FullState, by: &StateDerivative) -> DVec3 {
    let turned = by.angle * full.tangent;
    DVec3::new(-by.position.x, turned.x, -turned.y)
}

/// Moment in `E I_base/L_w` and forces in `E I_base/L_w^2` at the base, `[M, Fx, Fy]`.
pub fn base_numbers(full: &FullState) -> DVec3 {
    full.force * lever(full)
}

/// Derivatives of [`base_numbers`] by the logarithms of the contact's arclength and of the load, at `(tau, load)`.
pub fn base_derivatives(rod: &Rod, at: DVec2, here: &FirstVariation) -> [DVec3; 2] {
    let full = &here.full;
    let by = |by: &StateDerivative| by.force * lever(full) + full.force * lever_by(full, by);
    let [tau, load] = by_logarithms(rod, at);
    [tau * by(&here.by_tau), load * by(&here.by_load)]
}

/// Derivatives of `tau` and load by the logarithms of the contact's arclength and of the load.
pub fn by_logarithms(rod: &Rod, at: DVec2) -> [f64; 2] {
    [arclength(rod, at.x) / rod.radius(at.x), at.y]
}

/// Columns of a Jacobian of three rows as an orthonormal pair times a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pair: [DVec3; 2],
    first: f64,
    mixed: f64,
    second: f64,
}

impl Triangle {
    pub fn new([one, other]: [DVec3; 2]) -> Self {
        let first = one.length();
        let along = one / first;
        let mixed = along.dot(other);
        let rest = other - mixed * along;
        let second = rest.length();
        Self {
            pair: [along, rest / second],
            first,
            mixed,
            second,
        }
    }

    /// Returns the step whose image is nearest to `residual`.
    fn solve(&self, residual: DVec3) -> DVec2 {
        let [along, across] = self.pair.map(|axis| axis.dot(residual));
        let y = across / self.second;
        DVec2::new((along - self.mixed * y) / self.first, y)
    }

    /// Returns the ratio of the largest to the smallest singular value; infinite for a singular Jacobian.
    pub fn condition(&self) -> f64 {
        let product = self.first * self.second;
        let squares = self.first.powi(2) + self.mixed.powi(2) + self.second.powi(2);
        let difference = (squares * squares - 4.0 * product * product)
            .max(0.0)
            .sqrt();
        0.5 * (squares + difference) / product
    }

    /// Returns the standard deviation of a quantity with this `gradient`, if each row of the Jacobian has the deviation 1.
    pub fn deviation(&self, gradient: DVec2) -> f64 {
        let x = gradient.x / self.first;
        let y = (gradient.y - self.mixed * x) / self.second;
        libm::hypot(x, y)
    }
}

/// Search for the state whose numbers at the base are `wanted`, or nearest to them by `weights`; a number of weight 0 does not enter.
pub struct BaseProblem<'a> {
    pub rod: &'a Rod,
    pub wanted: DVec3,
    pub weights: DVec3,
    /// The last trajectory.
    pub last: FirstVariation,
}

impl<'a> NewtonProblem<'a> for BaseProblem<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        self.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        self.last = *here;
        let columns = base_derivatives(self.rod, at, here).map(|column| self.weights * column);
        let residual = self.weights * (self.wanted - base_numbers(&here.full));
        let step = Triangle::new(columns).solve(residual);
        let length = step.abs().max_element();
        let [tau, load] = by_logarithms(self.rod, at);
        let in_plane = step * (LONGEST / length).min(1.0) * DVec2::new(tau, load);
        if length < LAST {
            NewtonStep::Extrapolate(in_plane)
        } else if in_plane.is_finite() {
            NewtonStep::Shoot(at + in_plane)
        } else {
            NewtonStep::Fail
        }
    }
}

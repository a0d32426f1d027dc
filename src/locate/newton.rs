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

/// Condition from which on a search goes along a valley.
const NARROW: f64 = 1e3;

/// Part of the weak step that the strong one may change before a search goes along a valley.
const INTO_VALLEY: f64 = 0.1;

/// Longest step along a valley in the logarithms of contact and load.
const LONGEST_IN_VALLEY: f64 = 0.1;

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
        Self { pair: [along, rest / second], first, mixed, second }
    }

    /// Returns the step whose image is nearest to `residual`, as a sum of its parts in the directions of the largest and of the smallest
    /// change of the image.
    fn solve(&self, residual: DVec3) -> [DVec2; 2] {
        let residual = DVec2::from(self.pair.map(|axis| axis.dot(residual)));
        let image = |step: DVec2| {
            DVec2::new(self.first * step.x + self.mixed * step.y, self.second * step.y)
        };
        // Half the angle of the ellipse of the steps with an image of length 1.
        let squares = self.first.powi(2) - self.mixed.powi(2) - self.second.powi(2);
        let strong = DVec2::from_angle(0.5 * libm::atan2(2.0 * self.first * self.mixed, squares));
        [strong, strong.perp()].map(|direction| {
            let image = image(direction);
            direction * (image.dot(residual) / image.length_squared())
        })
    }

    /// Returns the ratio of the largest to the smallest singular value; infinite for a singular Jacobian.
    pub fn condition(&self) -> f64 {
        let product = self.first * self.second;
        let squares = self.first.powi(2) + self.mixed.powi(2) + self.second.powi(2);
        let difference = (squares * squares - 4.0 * product * product).max(0.0).sqrt();
        0.5 * (squares + difference) / product
    }

    /// Returns the standard deviation of a quantity with this `gradient`, if each row of the Jacobian has the deviation 1.
    pub fn deviation(&self, gradient: DVec2) -> f64 {
        let x = gradient.x / self.first;
        let y = (gradient.y - self.mixed * x) / self.second;
        libm::hypot(x, y)
    }
}

/// Returns the step of Newton's method from its `strong` and `weak` part, in the logarithms of contact and load.
///
/// Nearly dependent numbers have a curved valley of states that almost have them. The curvature of the valley changes the residual by the
/// square of the strong part, and the weak part by that times the condition. So a search first goes into the valley, and then along it.
fn step_in_valley([strong, weak]: [DVec2; 2], condition: f64) -> DVec2 {
    let limited = |step: DVec2, longest: f64| step * (longest / step.abs().max_element()).min(1.0);
    if condition < NARROW {
        return limited(strong + weak, LONGEST);
    }
    let is_in_valley = condition * strong.length_squared() < INTO_VALLEY * weak.length();
    let weak = match is_in_valley {
        true => limited(weak, LONGEST_IN_VALLEY),
        false => DVec2::ZERO,
    };
    limited(strong, LONGEST) + weak
}

/// Search for the state whose numbers at the base are `wanted`, or nearest to them by `weights`; a number of weight 0 does not enter.
pub struct BaseProblem<'a> {
    pub rod: &'a Rod,
    pub wanted: DVec3,
    pub weights: DVec3,
    /// Direction of the base's tangent in the frame of the wanted forces, a unit vector.
    pub tangent: DVec2,
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
        let turned = |numbers: DVec3| {
            let force = self.tangent.rotate(DVec2::new(numbers.y, numbers.z));
            DVec3::new(numbers.x, force.x, force.y)
        };
        let columns =
            base_derivatives(self.rod, at, here).map(|column| self.weights * turned(column));
        let residual = self.weights * (self.wanted - turned(base_numbers(&here.full)));
        let triangle = Triangle::new(columns);
        let step = step_in_valley(triangle.solve(residual), triangle.condition());
        let length = step.abs().max_element();
        let [tau, load] = by_logarithms(self.rod, at);
        let in_plane = step * DVec2::new(tau, load);
        if length < LAST {
            NewtonStep::Extrapolate(in_plane)
        } else if in_plane.is_finite() {
            NewtonStep::Shoot(at + in_plane)
        } else {
            NewtonStep::Fail
        }
    }
}

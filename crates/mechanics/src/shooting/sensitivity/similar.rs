//! Derivatives on rods whose parts toward the base are similar except for their size. They are straight at rest, with a constant modulus
//! and a radius that falls linearly or is constant.
//!
//! On such a rod, the trajectory in units of the radius at the contact depends on the load alone; only its length depends on the
//! contact. Derivatives by `tau` are therefore right-hand sides at the base: `theta_tau = f X`, `X_tau = -beta X - c`,
//! `Y_tau = -beta Y - s`. Only derivatives by the load are integrated.

use crate::numerics::{Real, Vector};
use crate::shooting::contact::Contact;
use crate::shooting::sensitivity::{
    Arrival, BaseDerivatives, SecondBaseDerivatives, SensitivitySet, Triple, twice,
};
use crate::shooting::{Carried, Sensitivity};

/// Set of the first derivatives on straight cones and cylinders. A trajectory carries only derivatives by the force.
#[derive(Clone, Copy, Debug)]
pub struct SimilarFirst;

/// Set of the first and second derivatives on straight cones and cylinders. A trajectory carries only derivatives by the force.
#[derive(Clone, Copy, Debug)]
pub struct SimilarSecond;

impl<T: Real> Sensitivity<T> for SimilarFirst {
    type Pairs = [T; 1];
    type Sums = [T; 1];

    #[inline(always)]
    fn moments(f: T, x: T, [x_f]: [T; 1]) -> [T; 1] {
        [f.mul_add(x_f, x)]
    }

    #[inline(always)]
    fn pull(c: T, s: T, _: T, [theta_f]: [T; 1]) -> ([T; 1], [T; 1]) {
        ([s * theta_f], [-c * theta_f])
    }
}

impl<T: Real> SensitivitySet<T> for SimilarFirst {
    type AtBase = BaseDerivatives<T>;

    #[inline(always)]
    fn start(_: &Contact<T>) -> Carried<T, Self> {
        let zero = [T::of(0.0)];
        (zero, (zero, zero))
    }

    #[inline(always)]
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> BaseDerivatives<T> {
        let ([theta], ([x_f], [y_f])) = carried;
        let Arrival { contact, taper, rod: [c, s, x, y, _] } = *arrival;
        let by_load = contact.radius * contact.radius;
        BaseDerivatives {
            by_tau: [contact.force * x, -taper.mul_add(x, c), -taper.mul_add(y, s)],
            by_load: [theta, x_f, y_f].times(by_load),
        }
    }
}

/// Derivative by `tau` of a derivative of `theta, X, Y`, at a fixed force.
#[inline(always)]
fn by_tau<T: Real>(f: T, taper: T, [c, s]: [T; 2], [theta, x, y]: Triple<T>) -> Triple<T> {
    [f * x, s.mul_add(theta, -taper * x), -taper.mul_add(y, c * theta)]
}

impl<T: Real> Sensitivity<T> for SimilarSecond {
    type Pairs = [T; 2];
    type Sums = [T; 2];

    #[inline(always)]
    fn moments(f: T, x: T, [x_f, x_ff]: [T; 2]) -> [T; 2] {
        [f.mul_add(x_f, x), f.mul_add(x_ff, x_f + x_f)]
    }

    #[inline(always)]
    fn pull(c: T, s: T, _: T, [theta_f, theta_ff]: [T; 2]) -> ([T; 2], [T; 2]) {
        let (x_ff, y_ff) = twice(c, s, theta_f * theta_f, theta_ff);
        ([s * theta_f, x_ff], [-c * theta_f, y_ff])
    }
}

impl<T: Real> SensitivitySet<T> for SimilarSecond {
    type AtBase = SecondBaseDerivatives<T>;

    #[inline(always)]
    fn start(_: &Contact<T>) -> Carried<T, Self> {
        let zeros = [T::of(0.0); 2];
        (zeros, (zeros, zeros))
    }

    #[inline(always)]
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> SecondBaseDerivatives<T> {
        let ([theta_f, theta_ff], ([x_f, x_ff], [y_f, y_ff])) = carried;
        let first = SimilarFirst::at_base(arrival, ([theta_f], ([x_f], [y_f])));
        let Arrival { contact, taper, rod: [c, s, x, ..] } = *arrival;
        let (f, by_load) = (contact.force, contact.radius * contact.radius);
        let [theta_tau_tau, x_tau_tau, y_tau_tau] = by_tau(f, taper, [c, s], first.by_tau);
        let [theta_tau_load, x_tau_load, y_tau_load] = by_tau(f, taper, [c, s], first.by_load);
        let two = T::of(2.0);
        SecondBaseDerivatives {
            first,
            // The force is the load times the square of the radius at the contact.
            by_tau_tau: [theta_tau_tau - two * taper * f * x, x_tau_tau, y_tau_tau],
            by_tau_load: [by_load.mul_add(x, theta_tau_load), x_tau_load, y_tau_load],
            by_load_load: [theta_ff, x_ff, y_ff].times(by_load * by_load),
        }
    }
}

//! Derivatives on rods that look the same from each of their points, but for their size: straight at rest, a radius that
//! falls linearly or not at all, one modulus.
//!
//! On such a rod the trajectory, in units of the radius at the contact, depends on the load alone and not on where the
//! contact is; only its end does. So derivatives by `tau` are right-hand sides at the base:
//! `theta_tau = f X`, `X_tau = -beta X - c`, `Y_tau = -beta Y - s`, and only those by the load have to be integrated.

use super::{Arrival, Curvatures, Order, Slopes, Triple, by_force, scaled, twice_by_force};
use crate::model::Real;
use crate::model::contact::Contact;
use crate::model::rhs::{Planar, Sensitivity};

/// First derivatives; carries `theta_f, X_f, Y_f`.
#[derive(Clone, Copy, Debug)]
pub struct First;

/// First and second derivatives; carries `theta_ff, X_ff, Y_ff`, too.
#[derive(Clone, Copy, Debug)]
pub struct Second;

impl<T: Real> Sensitivity<T> for First {
    type State = [T; 3];

    #[inline(always)]
    fn rhs(f: T, rho: T, w: T, rod: &Planar<T>, [theta_f, x_f, _]: [T; 3]) -> [T; 3] {
        by_force(f, rho, w, *rod, theta_f, x_f)
    }
}

impl<T: Real> Order<T> for First {
    type Known = Slopes<T>;

    #[inline(always)]
    fn start(_: &Contact<T>) -> [T; 3] {
        [T::of(0.0); 3]
    }

    #[inline(always)]
    fn known(arrival: &Arrival<T>, state: [T; 3]) -> Slopes<T> {
        let Arrival {
            contact,
            taper,
            rod: [c, s, x, y],
        } = *arrival;
        let by_load = contact.radius * contact.radius;
        Slopes {
            by_tau: [
                contact.force * x,
                -taper.mul_add(x, c),
                -taper.mul_add(y, s),
            ],
            by_load: scaled(by_load, state),
        }
    }
}

/// The same for derivatives of `theta, X, Y`, at a fixed force.
#[inline(always)]
fn by_tau<T: Real>(f: T, taper: T, [c, s]: [T; 2], [theta, x, y]: Triple<T>) -> Triple<T> {
    [
        f * x,
        s.mul_add(theta, -taper * x),
        -taper.mul_add(y, c * theta),
    ]
}

impl<T: Real> Sensitivity<T> for Second {
    type State = [T; 6];

    #[inline(always)]
    fn rhs(f: T, rho: T, w: T, rod: &Planar<T>, state: [T; 6]) -> [T; 6] {
        let [theta_f, x_f, _, theta_ff, x_ff, _] = state;
        let [a, b, c] = by_force(f, rho, w, *rod, theta_f, x_f);
        let [d, e, g] = twice_by_force(f, rho, w, *rod, [theta_f, x_f], [theta_ff, x_ff]);
        [a, b, c, d, e, g]
    }
}

impl<T: Real> Order<T> for Second {
    type Known = Curvatures<T>;

    #[inline(always)]
    fn start(_: &Contact<T>) -> [T; 6] {
        [T::of(0.0); 6]
    }

    #[inline(always)]
    fn known(arrival: &Arrival<T>, [a, b, c, twice @ ..]: [T; 6]) -> Curvatures<T> {
        let slopes = First::known(arrival, [a, b, c]);
        let Arrival {
            contact,
            taper,
            rod: [c, s, x, _],
        } = *arrival;
        let (f, by_load) = (contact.force, contact.radius * contact.radius);
        let [theta_tau_tau, x_tau_tau, y_tau_tau] = by_tau(f, taper, [c, s], slopes.by_tau);
        let [theta_tau_load, x_tau_load, y_tau_load] = by_tau(f, taper, [c, s], slopes.by_load);
        let two = T::of(2.0);
        Curvatures {
            slopes,
            // The force is the load times the square of the radius at the contact.
            by_tau_tau: [theta_tau_tau - two * taper * f * x, x_tau_tau, y_tau_tau],
            by_tau_load: [by_load.mul_add(x, theta_tau_load), x_tau_load, y_tau_load],
            by_load_load: scaled(by_load * by_load, twice),
        }
    }
}

//! First and second derivatives that trajectories carry on any rod.
//!
//! The rod is a Hamiltonian system with the pairs `theta`, `f X` and `Y`, `f`. The symplectic product of the derivatives by
//! force and by arclength is therefore equal at base and contact: `Y_s = theta_s (X + f X_f) - f theta_f X_s + const`. A
//! trajectory need not carry `Y_s` and its derivatives.

use crate::numerics::{Real, Vector};
use crate::shooting::contact::Contact;
use crate::shooting::sensitivity::{
    Arrival, BaseDerivatives, SecondBaseDerivatives, SensitivitySet, Triple, twice,
};
use crate::shooting::{Carried, Sensitivity};

/// Set of the first derivatives on any rod. A trajectory carries the derivatives of `theta` and `X` by force and arclength, and of `Y` by force.
#[derive(Clone, Copy, Debug)]
pub struct GeneralFirst;

/// Set of the first and second derivatives on any rod. Beside the derivatives of [`GeneralFirst`], a trajectory carries the second derivatives of
/// `theta` and `X` by force and arclength, and of `Y` by force.
#[derive(Clone, Copy, Debug)]
pub struct GeneralSecond;

impl<T: Real> Sensitivity<T> for GeneralFirst {
    type Pairs = [T; 2];
    type Sums = [T; 1];

    #[inline(always)]
    fn moments(f: T, x: T, [x_f, x_s]: [T; 2]) -> [T; 2] {
        [f.mul_add(x_f, x), f * x_s]
    }

    #[inline(always)]
    fn pull(c: T, s: T, _: T, [theta_f, theta_s]: [T; 2]) -> ([T; 2], [T; 1]) {
        ([s * theta_f, s * theta_s], [-c * theta_f])
    }
}

/// Derivatives by load and `tau`, from the derivatives by force and arclength.
#[inline(always)]
fn base_derivatives<T: Real>(
    arrival: &Arrival<T>,
    by_force: Triple<T>,
    by_arclength: Triple<T>,
) -> BaseDerivatives<T> {
    let (rho, load) = (arrival.contact.radius, load(arrival));
    BaseDerivatives {
        by_tau: sum(by_arclength.times(rho), by_force.times(load)),
        by_load: by_force.times(rho * rho),
    }
}

#[inline(always)]
fn sum<T: Real>([a, b, c]: Triple<T>, [d, e, f]: Triple<T>) -> Triple<T> {
    [a + d, b + e, c + f]
}

/// Derivative of the force by `tau` at fixed load.
#[inline(always)]
fn load<T: Real>(arrival: &Arrival<T>) -> T {
    T::of(-2.0) * arrival.taper * arrival.contact.force
}

impl<T: Real> SensitivitySet<T> for GeneralFirst {
    type AtBase = BaseDerivatives<T>;

    #[inline(always)]
    fn start(contact: &Contact<T>) -> Carried<T, Self> {
        let ([x, _], zero) = (contact.tangent, T::of(0.0));
        ([zero, -contact.curvature], ([zero, -x], [zero]))
    }

    #[inline(always)]
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> BaseDerivatives<T> {
        let ([theta_f, theta_s], ([x_f, x_s], [y_f])) = carried;
        let (f, x) = (arrival.contact.force, arrival.rod[2]);
        let [_, from] = arrival.contact.tangent;
        let y_s = theta_s * f.mul_add(x_f, x) - f * theta_f * x_s - from;
        base_derivatives(arrival, [theta_f, x_f, y_f], [theta_s, x_s, y_s])
    }
}

impl<T: Real> Sensitivity<T> for GeneralSecond {
    type Pairs = ([T; 2], [T; 3]);
    type Sums = [T; 2];

    #[inline(always)]
    fn moments(f: T, x: T, (first, [x_ff, x_fs, x_ss]): Self::Pairs) -> Self::Pairs {
        let [x_f, x_s] = first;
        let twice = [f.mul_add(x_ff, x_f + x_f), f.mul_add(x_fs, x_s), f * x_ss];
        (GeneralFirst::moments(f, x, first), twice)
    }

    #[inline(always)]
    fn pull(c: T, s: T, bent: T, (first, second): Self::Pairs) -> (Self::Pairs, [T; 2]) {
        let [theta_f, theta_s] = first;
        let [theta_ff, theta_fs, theta_ss] = second;
        let (levers, [y_f]) = GeneralFirst::pull(c, s, bent, first);
        let [(x_ff, y_ff), (x_fs, _), (x_ss, _)] = [
            twice(c, s, theta_f * theta_f, theta_ff),
            twice(c, s, theta_f * theta_s, theta_fs),
            twice(c, s, theta_s * theta_s, theta_ss),
        ];
        ((levers, [x_ff, x_fs, x_ss]), [y_f, y_ff])
    }
}

impl<T: Real> SensitivitySet<T> for GeneralSecond {
    type AtBase = SecondBaseDerivatives<T>;

    #[inline(always)]
    fn start(contact: &Contact<T>) -> Carried<T, Self> {
        let [x, y] = contact.tangent;
        let kappa = contact.curvature;
        let theta_ss = -contact.curvature_slope - contact.force * x / contact.stiffness;
        let zero = T::of(0.0);
        let (angles, (levers, _)) = GeneralFirst::start(contact);
        ((angles, [zero, zero, theta_ss]), ((levers, [zero, zero, -kappa * y]), [zero, zero]))
    }

    #[inline(always)]
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> SecondBaseDerivatives<T> {
        let (angles, (levers, [y_f, y_ff])) = carried;
        let ([theta_f, theta_s], [theta_ff, theta_fs, theta_ss]) = angles;
        let ([x_f, x_s], [x_ff, x_fs, x_ss]) = levers;
        let (f, x) = (arrival.contact.force, arrival.rod[2]);
        let [_, from] = arrival.contact.tangent;
        // Derivatives of the moment.
        let (m_f, m_ff) = (f.mul_add(x_f, x), f.mul_add(x_ff, x_f + x_f));
        let m_fs = f.mul_add(x_fs, x_s);
        let y_s = theta_s * m_f - f * theta_f * x_s - from;
        let y_fs =
            theta_fs * m_f + theta_s * m_ff - (theta_f + f * theta_ff) * x_s - f * theta_f * x_fs;
        let y_ss = theta_ss * m_f + theta_s * m_fs - f * (theta_fs * x_s + theta_f * x_ss);
        let by_force = [theta_f, x_f, y_f];
        let by_arclength = [theta_s, x_s, y_s];
        let ff = [theta_ff, x_ff, y_ff];
        let fs = [theta_fs, x_fs, y_fs];
        let ss = [theta_ss, x_ss, y_ss];
        let (rho, load, taper) = (arrival.contact.radius, load(arrival), arrival.taper);
        let two = T::of(2.0);
        let by_tau_tau =
            sum(sum(ff.times(load * load), fs.times(two * load * rho)), ss.times(rho * rho));
        let slanted = sum(by_force.times(two * load), by_arclength.times(rho));
        let by_tau_load = sum(sum(ff.times(load), fs.times(rho)), by_force.times(-two * taper));
        SecondBaseDerivatives {
            first: base_derivatives(arrival, by_force, by_arclength),
            by_tau_tau: sum(by_tau_tau, slanted.times(-taper)),
            by_tau_load: by_tau_load.times(rho * rho),
            by_load_load: ff.times(rho * rho * (rho * rho)),
        }
    }
}

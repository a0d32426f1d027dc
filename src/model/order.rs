//! The derivatives that a trajectory can carry, hand-written (the tests hold them against `num-dual`).
//!
//! `f` and `s` in the names below are the force and the arclength of the contact. The start values follow from the rod
//! being at the origin at the same tilt, whatever the contact: `y_s = -y'` there.

use super::Real;
use super::contact::Contact;
use super::rhs::{Planar, Sensitivity};

/// First derivatives: `theta_f, X_f, Y_f, theta_s, X_s, Y_s`.
#[derive(Clone, Copy, Debug)]
pub struct First;

/// [`First`] and the bending energy.
#[derive(Clone, Copy, Debug)]
pub struct FirstAndEnergy;

/// [`First`], then `ff`, `fs` and `ss` of `theta, X, Y`.
#[derive(Clone, Copy, Debug)]
pub struct Second;

/// The start of a set of derivatives at the contact.
pub trait Order<const N: usize>: Sensitivity<N> {
    /// Values at the contact.
    fn start<T: Real>(contact: &Contact<T>) -> [T; N];
}

impl Sensitivity<6> for First {
    #[inline(always)]
    fn rhs<T: Real>(f: T, rho: T, w: T, rod: &Planar<T>, state: &[T; 6]) -> [T; 6] {
        let [c, s, x, _] = *rod;
        let [theta_f, x_f, _, theta_s, x_s, _] = *state;
        [
            w * f.mul_add(x_f, x),
            rho * s * theta_f,
            -rho * c * theta_f,
            w * f * x_s,
            rho * s * theta_s,
            -rho * c * theta_s,
        ]
    }
}

impl Order<6> for First {
    #[inline(always)]
    fn start<T: Real>(contact: &Contact<T>) -> [T; 6] {
        let ([x, y], zero) = (contact.tangent, T::of(0.0));
        [zero, zero, zero, -contact.curvature, -x, -y]
    }
}

impl Sensitivity<7> for FirstAndEnergy {
    #[inline(always)]
    fn rhs<T: Real>(f: T, rho: T, w: T, rod: &Planar<T>, state: &[T; 7]) -> [T; 7] {
        let [a, b, c, d, e, g, _] = *state;
        let first = First::rhs(f, rho, w, rod, &[a, b, c, d, e, g]);
        let moment = f * rod[2];
        let [a, b, c, d, e, g] = first;
        let energy = T::of(0.5) * moment * moment * w;
        [a, b, c, d, e, g, energy]
    }
}

impl Order<7> for FirstAndEnergy {
    #[inline(always)]
    fn start<T: Real>(contact: &Contact<T>) -> [T; 7] {
        let [a, b, c, d, e, g] = First::start(contact);
        [a, b, c, d, e, g, T::of(0.0)]
    }
}

impl Sensitivity<15> for Second {
    #[inline(always)]
    fn rhs<T: Real>(f: T, rho: T, w: T, rod: &Planar<T>, state: &[T; 15]) -> [T; 15] {
        let [c, s, _, _] = *rod;
        let [theta_f, x_f, y_f, theta_s, x_s, y_s, second @ ..] = *state;
        let [theta_ff, x_ff, _, theta_fs, x_fs, _, theta_ss, x_ss, _] = second;
        let first = [theta_f, x_f, y_f, theta_s, x_s, y_s];
        let [theta_f1, x_f1, y_f1, theta_s1, x_s1, y_s1] = First::rhs(f, rho, w, rod, &first);
        let along = |turns, theta| rho * s.mul_add(theta, c * turns);
        let across = |turns: T, theta: T| rho * (s * turns - c * theta);
        let (ff, fs, ss) = (theta_f * theta_f, theta_f * theta_s, theta_s * theta_s);
        [
            theta_f1,
            x_f1,
            y_f1,
            theta_s1,
            x_s1,
            y_s1,
            w * f.mul_add(x_ff, x_f + x_f),
            along(ff, theta_ff),
            across(ff, theta_ff),
            w * f.mul_add(x_fs, x_s),
            along(fs, theta_fs),
            across(fs, theta_fs),
            w * f * x_ss,
            along(ss, theta_ss),
            across(ss, theta_ss),
        ]
    }
}

impl Order<15> for Second {
    #[inline(always)]
    fn start<T: Real>(contact: &Contact<T>) -> [T; 15] {
        let [a, b, c, d, e, g] = First::start(contact);
        let [x, y] = contact.tangent;
        let kappa = contact.curvature;
        let theta_ss = -contact.curvature_slope - contact.force * x / contact.stiffness;
        let o = T::of(0.0);
        let (x_ss, y_ss) = (-kappa * y, kappa * x);
        [a, b, c, d, e, g, o, o, o, o, o, o, theta_ss, x_ss, y_ss]
    }
}

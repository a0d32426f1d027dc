//! The derivatives that a trajectory carries, hand-written (the tests hold them against `num-dual`), and those that follow
//! from them at the base.
//!
//! `f` and `s` in the names below are the force and the arclength of the contact. The start values follow from the rod
//! being at the origin at the same tilt, whatever the contact: `y_s = -y'` there.

pub mod general;
pub mod similar;

use super::Real;
use super::contact::Contact;
use super::rhs::{Planar, Sensitivity};
use std::marker::PhantomData;

/// Derivatives of `theta, X, Y`.
pub type Triple<T> = [T; 3];

/// A set of derivatives: where it starts, and what the base knows from it.
pub trait Order<T: Real>: Sensitivity<T> {
    /// In the coordinates of the sheet.
    type Known;

    /// Values at the contact.
    fn start(contact: &Contact<T>) -> Self::State;

    /// What follows at the base from the values there.
    fn known(arrival: &Arrival<T>, state: Self::State) -> Self::Known;
}

/// A trajectory that has come to the base.
#[derive(Clone, Copy, Debug)]
pub struct Arrival<T> {
    /// Where it comes from.
    pub contact: Contact<T>,
    /// The rod's `beta`.
    pub taper: T,
    /// The base.
    pub rod: Planar<T>,
}

/// First derivatives of the base by the coordinates of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<T> {
    /// By `tau` of the contact at fixed load.
    pub by_tau: Triple<T>,
    /// By the load.
    pub by_load: Triple<T>,
}

/// First and second derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Curvatures<T> {
    /// First.
    pub slopes: Slopes<T>,
    /// Twice by `tau`.
    pub by_tau_tau: Triple<T>,
    /// By `tau` and load.
    pub by_tau_load: Triple<T>,
    /// Twice by load.
    pub by_load_load: Triple<T>,
}

#[inline(always)]
fn scaled<T: Real>(by: T, [theta, x, y]: Triple<T>) -> Triple<T> {
    [by * theta, by * x, by * y]
}

/// `theta, X, Y` by the force.
#[inline(always)]
fn by_force<T: Real>(f: T, rho: T, w: T, [c, s, x, _]: Planar<T>, theta_f: T, x_f: T) -> Triple<T> {
    [w * f.mul_add(x_f, x), rho * s * theta_f, -rho * c * theta_f]
}

/// The same twice; `turns` is `theta_f^2`.
#[inline(always)]
fn twice_by_force<T: Real>(
    f: T,
    rho: T,
    w: T,
    [c, s, _, _]: Planar<T>,
    [theta_f, x_f]: [T; 2],
    [theta_ff, x_ff]: [T; 2],
) -> Triple<T> {
    let turns = theta_f * theta_f;
    [
        w * f.mul_add(x_ff, x_f + x_f),
        rho * s.mul_add(theta_ff, c * turns),
        rho * (s * turns - c * theta_ff),
    ]
}

/// A set of derivatives, and the bending energy in `E I_base/L_w`.
#[derive(Clone, Copy, Debug)]
pub struct Energetic<O>(PhantomData<O>);

impl<T: Real, O: Sensitivity<T>> Sensitivity<T> for Energetic<O> {
    type State = (O::State, [T; 1]);

    #[inline(always)]
    fn rhs(f: T, rho: T, w: T, rod: &Planar<T>, (inner, _): Self::State) -> Self::State {
        let moment = f * rod[2];
        let energy = T::of(0.5) * moment * moment * w;
        (O::rhs(f, rho, w, rod, inner), [energy])
    }
}

impl<T: Real, O: Order<T>> Order<T> for Energetic<O> {
    type Known = (O::Known, T);

    #[inline(always)]
    fn start(contact: &Contact<T>) -> Self::State {
        (O::start(contact), [T::of(0.0)])
    }

    #[inline(always)]
    fn known(arrival: &Arrival<T>, (inner, [energy]): Self::State) -> Self::Known {
        (O::known(arrival, inner), energy)
    }
}

//! Derivatives of the base: some are carried by a trajectory, the others follow from them at the base. They are written by hand; tests
//! compare them with `num-dual`.
//!
//! In names, `f` and `s` are the force and the arclength of the contact. The rod starts at the origin with a fixed tilt for
//! every contact, so that derivatives start with `y_s = -y'`.

mod general;
mod similar;

pub use general::{GeneralFirst, GeneralSecond};
pub use similar::{SimilarFirst, SimilarSecond};

use crate::numerics::Real;
use crate::shooting::contact::Contact;
use crate::shooting::{Carried, NoSensitivity, Planar, Sensitivity};
use std::marker::PhantomData;

/// Derivatives of `[theta, X, Y]`: the angle of the tangent in radians, and the position in whisker lengths.
pub type Triple<T> = [T; 3];

/// A set of carried derivatives: its start values at the contact, and its results at the base.
pub trait SensitivitySet<T: Real>: Sensitivity<T> + Sized {
    /// Derivatives of the base's angle and position by the sheet's coordinates, `tau` and load.
    type AtBase;

    /// Returns the start values of the carried derivatives at the contact.
    fn start(contact: &Contact<T>) -> Carried<T, Self>;

    /// Returns the derivatives of the base's angle and position from the values that a trajectory carries there.
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> Self::AtBase;
}

/// End of a trajectory at the base.
#[derive(Clone, Copy, Debug)]
pub struct Arrival<T> {
    /// Contact where the trajectory starts.
    pub contact: Contact<T>,
    /// Taper `beta` of the rod, dimensionless.
    pub taper: T,
    /// State of the rod at the base, where the trajectory ends.
    pub rod: Planar<T>,
}

/// First derivatives of the base's angle and position by `tau` and load, in the frame of the contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct BaseDerivatives<T> {
    /// Derivatives of the base's `[theta, X, Y]` by `tau` of the contact at fixed load: radians and whisker lengths.
    pub by_tau: Triple<T>,
    /// Derivatives of the base's `[theta, X, Y]` by the load `f/rho^2` at fixed `tau`: radians and whisker lengths.
    pub by_load: Triple<T>,
}

/// First and second derivatives of the base's angle and position by `tau` and load, in the frame of the contact.
#[derive(Clone, Copy, Debug)]
pub struct SecondBaseDerivatives<T> {
    /// First derivatives of the base's angle and position by `tau` and load.
    pub first: BaseDerivatives<T>,
    /// Second derivatives of the base's `[theta, X, Y]` by `tau`: radians and whisker lengths.
    pub by_tau_tau: Triple<T>,
    /// Mixed second derivatives of the base's `[theta, X, Y]` by `tau` and load: radians and whisker lengths.
    pub by_tau_load: Triple<T>,
    /// Second derivatives of the base's `[theta, X, Y]` by the load: radians and whisker lengths.
    pub by_load_load: Triple<T>,
}

/// Second derivatives of `-cos theta` and `-sin theta`. `angle` is the second derivative of `theta`, `turns` the product of its
/// first derivatives.
#[inline(always)]
fn twice<T: Real>(c: T, s: T, turns: T, angle: T) -> (T, T) {
    (s.mul_add(angle, c * turns), s * turns - c * angle)
}

impl<T: Real> SensitivitySet<T> for NoSensitivity {
    type AtBase = ();

    #[inline(always)]
    fn start(_: &Contact<T>) -> Carried<T, Self> {
        ((), ((), ()))
    }

    #[inline(always)]
    fn at_base(_: &Arrival<T>, _: Carried<T, Self>) {}
}

/// A set of carried derivatives together with the bending energy in `E I_base/L_w`. The energy's relative error grows with the inverse of
/// the radius at the contact over the base radius: it is 2e-8 for a ratio of 1e-6.
#[derive(Clone, Copy, Debug)]
pub struct Energetic<S>(PhantomData<S>);

impl<T: Real, S: Sensitivity<T>> Sensitivity<T> for Energetic<S> {
    type Pairs = S::Pairs;
    /// Sums of the set, and the integral of `psi` along `-X`, where `psi` is the angle by which bending has turned the rod. The
    /// energy is the integral of `f X/2` along `psi`; integration by parts leads to this integral.
    type Sums = (S::Sums, [T; 1]);

    #[inline(always)]
    fn moments(f: T, x: T, levers: S::Pairs) -> S::Pairs {
        S::moments(f, x, levers)
    }

    #[inline(always)]
    fn pull(c: T, s: T, bent: T, angles: S::Pairs) -> (S::Pairs, Self::Sums) {
        let (levers, sums) = S::pull(c, s, bent, angles);
        (levers, (sums, [c * bent]))
    }
}

impl<T: Real, S: SensitivitySet<T>> SensitivitySet<T> for Energetic<S> {
    type AtBase = (S::AtBase, T);

    #[inline(always)]
    fn start(contact: &Contact<T>) -> Carried<T, Self> {
        let (angles, (levers, sums)) = S::start(contact);
        (angles, (levers, (sums, [T::of(0.0)])))
    }

    #[inline(always)]
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> Self::AtBase {
        let (angles, (levers, (sums, [along]))) = carried;
        let [_, _, x, _, bent] = arrival.rod;
        let energy = T::of(0.5) * arrival.contact.force * x.mul_add(bent, along);
        (S::at_base(arrival, (angles, (levers, sums))), energy)
    }
}

//! The derivatives that a trajectory carries, hand-written (the tests hold them against `num-dual`), and those that follow
//! from them at the base.
//!
//! `f` and `s` in the names below are the force and the arclength of the contact. The start values follow from the rod
//! being at the origin at the same tilt, whatever the contact: `y_s = -y'` there.

mod general;
mod similar;

pub use general::{GeneralFirst, GeneralSecond};
pub use similar::{SimilarFirst, SimilarSecond};

use crate::numerics::Real;
use crate::shooting::contact::Contact;
use crate::shooting::{Carried, Planar, Sensitivity};
use std::marker::PhantomData;

/// Derivatives of `theta, X, Y`.
pub type Triple<T> = [T; 3];

/// A set of derivatives: where it starts, and what the base knows from it.
pub trait SensitivitySet<T: Real>: Sensitivity<T> + Sized {
    /// Derivatives of the base by the coordinates of the sheet.
    type AtBase;

    /// Values at the contact.
    fn start(contact: &Contact<T>) -> Carried<T, Self>;

    /// What follows at the base from the values there.
    fn at_base(arrival: &Arrival<T>, carried: Carried<T, Self>) -> Self::AtBase;
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
pub struct BaseDerivatives<T> {
    /// By `tau` of the contact at fixed load.
    pub by_tau: Triple<T>,
    /// By the load.
    pub by_load: Triple<T>,
}

/// First and second derivatives.
#[derive(Clone, Copy, Debug)]
pub struct SecondBaseDerivatives<T> {
    /// First.
    pub first: BaseDerivatives<T>,
    /// Twice by `tau`.
    pub by_tau_tau: Triple<T>,
    /// By `tau` and load.
    pub by_tau_load: Triple<T>,
    /// Twice by load.
    pub by_load_load: Triple<T>,
}

/// Second derivatives of `-cos theta` and `-sin theta`, where those of `theta` are `angle`; `turns` is the product of the first
/// ones.
#[inline(always)]
fn twice<T: Real>(c: T, s: T, turns: T, angle: T) -> (T, T) {
    (s.mul_add(angle, c * turns), s * turns - c * angle)
}

/// A set of derivatives, and the bending energy in `E I_base/L_w`. Its relative error grows with the inverse of the radius at
/// the contact, over that at the base: 2e-8 where that is 1e-6.
#[derive(Clone, Copy, Debug)]
pub struct Energetic<S>(PhantomData<S>);

impl<T: Real, S: Sensitivity<T>> Sensitivity<T> for Energetic<S> {
    type Pairs = S::Pairs;
    /// Those of the set, and the integral of `psi` along `-X`, where `psi` is how far bending has turned the rod: the energy
    /// is the integral of `f X/2` along `psi`, and this is the rest of its integration by parts.
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

//! Kernels of trajectories in dual numbers. They have all effects of their rest shape and material, as a variable may bring in an effect
//! that the rod itself lacks.

use super::TrajectoryVariable;
use super::differentiated::{Differentiated, spread};
use super::dual_rest::DualRest;
use super::varied_condition::VariedCondition;
use crate::numerics::gauss::Integrals;
use crate::numerics::{Dual, Lanes, LanesTask, Real};
use crate::rod::radius_and_arclength;
use crate::rod::{Piece, RadiusProfile};
use crate::shooting::batch::{FEW_KERNELS, InitialCondition, PoleCentre};
use crate::shooting::contact::Contact;
use crate::shooting::mount::in_mount;
use crate::shooting::sensitivity::{Arrival, Energetic, GeneralFirst, SensitivitySet};
use crate::shooting::{
    BackwardCompliance, Bent, Graded, Intrinsic, Measured, Polynomial, Resolution, RodSystem,
    Scales, Section, Spiral, TrajectoryState, collocate, integrate,
};
use std::marker::PhantomData;

/// Derivatives that a trajectory carries, each a dual number.
type Carried = Energetic<GeneralFirst>;

/// Differentiates the trajectory from `condition` by `variables`, at most as many as there are lanes. Returns its state, and the derivatives of the
/// state, `[variable]`.
#[inline(always)]
pub fn compute<T: Lanes>(
    resolution: Resolution,
    condition: &InitialCondition,
    variables: &[TrajectoryVariable],
) -> Differentiated {
    macro_rules! kernel {
        ($rest:ty) => {
            T::outlined(Kernel::<$rest> {
                resolution,
                varied: VariedCondition { condition, variables },
                of: PhantomData,
            })
        };
    }
    if condition.rod.polynomial.is_some() || FEW_KERNELS && condition.rod.spiral.is_some() {
        return kernel!(Polynomial<Dual<T>>);
    }
    match condition.rod.spiral {
        Some(_) => kernel!(Spiral<Dual<T>>),
        None => kernel!(Bent<Dual<T>>),
    }
}

/// Task that integrates one trajectory in dual numbers.
struct Kernel<'a, I> {
    resolution: Resolution,
    varied: VariedCondition<'a>,
    of: PhantomData<I>,
}

impl<I> Kernel<'_, I> {
    /// A number of the piece `k` of the measured profile.
    #[inline(always)]
    fn of_piece<T: Lanes>(
        &self,
        profile: &RadiusProfile,
        k: usize,
        number: impl Fn(&Piece) -> f64,
    ) -> Dual<T> {
        self.varied.number(|_| number(&profile.pieces[k]), |by| number(&by.piece(k)))
    }

    /// The state at the base after `state` at the `contact`, in steps of equal length.
    #[inline(always)]
    fn evenly<T: Lanes, R: Intrinsic<Dual<T>>>(
        &self,
        system: &RodSystem<Dual<T>, R, Graded<Dual<T>>>,
        contact: Section<Dual<T>>,
        [taper, tau]: [Dual<T>; 2],
        state: TrajectoryState<Dual<T>, R, Carried>,
    ) -> TrajectoryState<Dual<T>, R, Carried> {
        let InitialCondition { rod, tau: at, load } = *self.varied.condition;
        let steps = self.resolution.steps(rod, at, load);
        let h = tau * Dual::of(1.0 / f64::from(steps));
        let scales = Scales::tapered(taper, h);
        integrate::<_, R, _, Carried>(system, &scales, contact, steps, state, &mut ())
    }

    /// The state at the base after `state` at the contact, along the pieces of a measured `profile`.
    #[inline(always)]
    fn along<T: Lanes, R: Intrinsic<Dual<T>>>(
        &self,
        profile: &RadiusProfile,
        system: &RodSystem<Dual<T>, R, Graded<Dual<T>>>,
        contact: Section<Dual<T>>,
        [taper, tau]: [Dual<T>; 2],
        mut state: TrajectoryState<Dual<T>, R, Carried>,
    ) -> TrajectoryState<Dual<T>, R, Carried> {
        let InitialCondition { rod, tau: at, load } = *self.varied.condition;
        let needs = self.resolution.of_pieces(rod, at, load);
        let [mut tau, mut from] = [tau, contact.arclength];
        for k in (0..=rod.piece(crate::rod::arclength(rod, at))).rev() {
            let steps = needs.of(profile, k);
            let [end, start] = [
                self.of_piece(profile, k, |piece| piece.tau),
                self.of_piece(profile, k, |piece| piece.from),
            ];
            let mut cubic = [Dual::of(0.0); 4];
            for (power, coefficient) in cubic.iter_mut().enumerate() {
                *coefficient = self.of_piece(profile, k, |piece| piece.cubic[power]);
            }
            let system = RodSystem {
                force: system.force,
                intrinsic: system.intrinsic,
                material: Measured { from: start, cubic, gradient: Some(system.material.gradient) },
            };
            let h = (tau - end) * Dual::of(1.0 / f64::from(steps));
            let scales = Scales::tapered(taper, h);
            let mut section =
                Section { rho: (-taper).mul_add(from, Dual::of(1.0)), arclength: from, ..contact };
            for _ in 0..steps {
                let weights: Integrals<Dual<T>> = BackwardCompliance {
                    material: &system.material,
                    from: section.arclength,
                    length: section.rho * scales.end().along,
                }
                .weights();
                state =
                    collocate::<_, R, Carried>(&system, scales.end(), &section, &weights, state);
                section = section.at(scales.end());
            }
            [tau, from] = [end, start];
        }
        state
    }
}

impl<T: Lanes, R: DualRest<T>> LanesTask<T> for Kernel<'_, R> {
    type Output = Differentiated;

    #[inline(always)]
    fn run(self) -> Differentiated {
        let (zero, one) = (Dual::of(0.0), Dual::of(1.0));
        let InitialCondition { rod, tau, load } = *self.varied.condition;
        let is = |wanted: bool| f64::from(u8::from(wanted));
        let tau: Dual<T> = self.varied.dual(tau, |by| is(matches!(by, TrajectoryVariable::Tau)));
        let load: Dual<T> = self.varied.dual(load, |by| is(matches!(by, TrajectoryVariable::Load)));
        let taper = self.varied.number(|rod| rod.taper, |by| by.taper);
        let [radius, s] = radius_and_arclength(taper, tau);
        let (intrinsic, at_rest, [curvature, curvature_slope]) = R::start(&self.varied, s);
        let friction: Dual<T> = self.varied.number(|rod| rod.friction, |by| by.friction);
        let cos = one / friction.mul_add(friction, one).sqrt();
        let material =
            Graded { gradient: self.varied.number(|rod| rod.gradient, |by| by.gradient) };
        let contact = Contact {
            radius,
            force: load * radius * radius,
            tangent: [cos, friction * cos],
            // Only second derivatives start from the stiffness.
            stiffness: one,
            curvature,
            curvature_slope,
        };
        let [c, sin] = contact.tangent;
        let start = (at_rest, ([c, sin, zero, zero, zero], Carried::start(&contact)));
        let section =
            Section { rho: radius, inverse_cube: one / (radius * radius * radius), arclength: s };
        let system = RodSystem { force: contact.force, intrinsic, material };
        let (_, (at_base, carried)) = match &rod.profile {
            Some(profile) => self.along(profile, &system, section, [taper, tau], start),
            None => self.evenly(&system, section, [taper, tau], start),
        };
        let mount = self.varied.number(|rod| rod.mount, |by| by.mount);
        let (at_base, carried) =
            in_mount::<Dual<T>, Carried>(mount, contact.force, at_base, carried);
        let arrival = Arrival { contact, taper, rod: at_base };
        let pole = self.varied.number(|rod| rod.pole, |by| by.pole);
        let to_pole = [pole * contact.tangent[1], -pole * contact.tangent[0]];
        let (first, energy) = Carried::at_base(&arrival, carried);
        let centre = PoleCentre::new(&arrival, to_pole);
        let maps = [first.by_tau, first.by_load].map(|of| centre.ln_pole_by(of));
        spread(&arrival, [centre.pole, maps[0], maps[1]], energy)
    }
}

//! Derivatives of states by the numbers of the rod: trajectories in [`Dual`] numbers, one variable in each lane.
//!
//! The integrator of the batches runs once, from the contact of a known state, with the steps that this state takes. It differentiates the
//! discrete map exactly. The derivatives that it carries by contact and load are differentiated, too, so that second derivatives of
//! the shooting map follow.

mod differentiated;
mod dual_rest;
mod kernel;
mod varied_condition;

use crate::numerics::{Lanes, SimdTask, Unit};
use crate::rod::RodDerivative;
use crate::shooting::batch::InitialCondition;
use crate::shooting::{FullState, Resolution, StateDerivative};
use glam::DVec2;
use kernel::compute;

/// Variable by which a trajectory is differentiated: contact, load, or numbers of the rod.
#[derive(Clone, Copy, Debug)]
pub enum TrajectoryVariable<'a> {
    /// Contact coordinate `tau` as the variable, at fixed load and rod.
    Tau,
    /// Load `f/rho^2` as the variable, at fixed contact and rod.
    Load,
    /// Variable that changes the numbers of the rod, at fixed `tau` and load.
    Rod(&'a RodDerivative),
}

/// Derivative of a state and of its shooting map by one variable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VariationDerivative {
    /// Derivative of the state by the variable: pose of the base, force and energy.
    pub state: StateDerivative,
    /// Derivative of `(ln D, phi)` of the pole's centre, with `phi` in radians, per unit of the variable.
    pub ln_pole: DVec2,
    /// Derivative of `d(ln D, phi)/dtau` by the variable, with `phi` in radians: of [`ShootingMap::by_tau`](crate::shooting::ShootingMap::by_tau).
    pub by_tau: DVec2,
    /// Derivative of `d(ln D, phi)/dload` by the variable, with `phi` in radians: of [`ShootingMap::by_load`](crate::shooting::ShootingMap::by_load).
    pub by_load: DVec2,
}

impl VariationDerivative {
    /// Returns `self + h other`: the derivative along a sum of two variables.
    #[must_use]
    pub fn plus(&self, h: f64, other: &Self) -> Self {
        Self {
            state: self.state.plus(h, &other.state),
            ln_pole: self.ln_pole + h * other.ln_pole,
            by_tau: self.by_tau + h * other.by_tau,
            by_load: self.by_load + h * other.by_load,
        }
    }
}

/// Integrates the trajectory from `condition` at `resolution`. Returns its state, and the derivatives of the state by each of `variables`,
/// `[variable]`.
///
/// ```
/// use whiskmap_mechanics::rod::{Rod, RodDerivative};
/// use whiskmap_mechanics::shooting::batch::InitialCondition;
/// use whiskmap_mechanics::shooting::{Resolution, TrajectoryVariable, differentiate};
///
/// let rod = Rod { taper: 0.9, ..Rod::default() };
/// let condition = InitialCondition { rod: &rod, tau: rod.tau(0.7), load: 6.0 };
/// let by_taper = RodDerivative { taper: 1.0, ..RodDerivative::default() };
/// let variables = [TrajectoryVariable::Tau, TrajectoryVariable::Rod(&by_taper)];
/// let (state, by) = differentiate(Resolution::FINE, &condition, &variables);
/// assert!((by[0].ln_pole - state.map.by_tau).length() < 1e-12);
/// assert!(by[1].ln_pole.length() > 0.1);
/// ```
#[must_use]
pub fn differentiate(
    resolution: Resolution,
    condition: &InitialCondition,
    variables: &[TrajectoryVariable],
) -> (FullState, Vec<VariationDerivative>) {
    Unit::detect().run(Differentiation { resolution, condition, variables })
}

/// Task that differentiates one trajectory, as many variables at a time as there are lanes.
struct Differentiation<'a> {
    resolution: Resolution,
    condition: &'a InitialCondition<'a>,
    variables: &'a [TrajectoryVariable<'a>],
}

impl SimdTask for Differentiation<'_> {
    type Output = (FullState, Vec<VariationDerivative>);

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut full = FullState::default();
        let mut derivatives = Vec::with_capacity(self.variables.len());
        for variables in self.variables.chunks(<T::Narrow as Lanes>::LANES) {
            let (state, by) = compute::<T::Narrow>(self.resolution, self.condition, variables);
            full = state;
            derivatives.extend_from_slice(&by[..variables.len()]);
        }
        (full, derivatives)
    }
}

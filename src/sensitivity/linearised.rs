//! A state with its derivatives by contact, load and the numbers of its rod, and how it moves with a variable.
//!
//! Equations `F(tau, load, p) = 0` determine the state. By the implicit function theorem, its derivative by `p` is
//! `d(tau, load)/dp = -(dF/d(tau, load))^-1 dF/dp`. At a push angle, `F` is `(ln D, phi)` of the state less `(ln D, phi)` of the pole. At a fold it
//! is `ln D` and `det J`, and at the tip `ln D` and the contact's distance from the tip.

use super::NoDerivative;
use super::whisker::WhiskerDerivative;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod, RodDerivative, arclength};
use whiskmap_mechanics::shooting::batch::InitialCondition;
use whiskmap_mechanics::shooting::{
    FullState, Resolution, StateDerivative, TrajectoryVariable, VariationDerivative, differentiate,
};

/// Sine of the angle between the gradients of two equations, in scaled coordinates, below which they are singular. Errors of states of
/// 1e-12 then change a derivative by at most 1e-6 of itself.
const SINGULAR: f64 = 1e-3;

/// Relative distance from the corner, where the fold meets the tip, below which the kind of detachment is undecided.
const CORNER: f64 = 1e-10;

/// Equations that determine a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equations {
    /// The pole has a given distance and direction: a state at a push angle.
    Push,
    /// The pole has a given distance, and the Jacobian of the shooting map is singular: slip-off.
    Fold,
    /// The pole has a given distance, and the contact is at the tip: pull-off.
    Tip,
}

/// Numbers of a rod by which trajectories are differentiated, one lane for each. Every variable is a sum of these numbers.
pub struct RodAxes {
    axes: Vec<RodDerivative>,
    /// Parts of each variable, `[variable][part]`: the index of an axis and its coefficient.
    parts: Vec<Vec<(usize, f64)>>,
}

/// Numbers of a rod other than its profile.
const NUMBERS: [fn(&mut RodDerivative) -> &mut f64; 9] = [
    |by| &mut by.taper,
    |by| &mut by.bend,
    |by| &mut by.slope,
    |by| &mut by.pole,
    |by| &mut by.gradient,
    |by| &mut by.friction,
    |by| &mut by.mount,
    |by| &mut by.spiral[0],
    |by| &mut by.spiral[1],
];

impl RodAxes {
    /// Finds the axes of `variables`: each number of the rod that at least one of them changes, and each change of the profile.
    pub fn new<'a>(variables: impl Iterator<Item = &'a RodDerivative>) -> Self {
        let mut axes: Vec<RodDerivative> = Vec::new();
        let mut places = [None; NUMBERS.len()];
        let mut parts = Vec::new();
        for variable in variables {
            let mut remaining = variable.clone();
            let mut sum = Vec::new();
            if variable.pieces.is_some() {
                // The pieces belong together with the taper of their coordinates.
                let taper = std::mem::take(&mut remaining.taper);
                sum.push((axes.len(), 1.0));
                axes.push(RodDerivative {
                    taper,
                    pieces: remaining.pieces.take(),
                    ..RodDerivative::default()
                });
            }
            for (number, place) in NUMBERS.iter().zip(&mut places) {
                let coefficient = *number(&mut remaining);
                if coefficient == 0.0 {
                    continue;
                }
                let axis = *place.get_or_insert_with(|| {
                    let mut axis = RodDerivative::default();
                    *number(&mut axis) = 1.0;
                    axes.push(axis);
                    axes.len() - 1
                });
                sum.push((axis, coefficient));
            }
            parts.push(sum);
        }
        Self { axes, parts }
    }
}

/// A state with its derivatives by `tau`, load, and the axes of its rod.
pub struct Linearised<'a> {
    pub rod: &'a Rod,
    pub tau: f64,
    pub load: f64,
    pub full: FullState,
    axes: &'a RodAxes,
    /// Derivatives of the state by `tau`, load and each axis.
    by: Vec<VariationDerivative>,
}

/// Derivative of a state by a variable, with the state kept on its equations.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Derivative of the contact's coordinate `tau`, dimensionless per unit of the variable.
    pub tau: f64,
    /// Derivative of pose, force and energy of the state by the variable.
    pub state: StateDerivative,
    /// Derivative of the pole's direction from the base's tangent, in radians per unit of the variable.
    pub phi: f64,
}

impl<'a> Linearised<'a> {
    /// Integrates the trajectory from `(tau, load)` with its derivatives.
    pub fn new(
        resolution: Resolution,
        rod: &'a Rod,
        axes: &'a RodAxes,
        [tau, load]: [f64; 2],
    ) -> Self {
        let mut variables = vec![TrajectoryVariable::Tau, TrajectoryVariable::Load];
        variables.extend(axes.axes.iter().map(TrajectoryVariable::Rod));
        let condition = InitialCondition { rod, tau, load };
        let (full, by) = differentiate(resolution, &condition, &variables);
        Self { rod, tau, load, full, axes, by }
    }

    /// Derivative of `det J` along a derivative of the state.
    fn det_along(&self, by: &VariationDerivative) -> f64 {
        let map = &self.full.map;
        by.by_tau.perp_dot(map.by_load) + map.by_tau.perp_dot(by.by_load)
    }

    /// Gradients of both equations in `(tau, load)`.
    fn gradients(&self, equations: Equations) -> [DVec2; 2] {
        let [tau, load] = [&self.by[0], &self.by[1]];
        let distance = DVec2::new(tau.ln_pole.x, load.ln_pole.x);
        let other = match equations {
            Equations::Push => DVec2::new(tau.ln_pole.y, load.ln_pole.y),
            Equations::Fold => DVec2::new(self.det_along(tau), self.det_along(load)),
            Equations::Tip => DVec2::X,
        };
        [distance, other]
    }

    /// Checks that the equations determine the state and its derivatives.
    ///
    /// # Errors
    /// If they are singular, or the state is at the corner.
    pub fn check(&self, equations: Equations) -> Result<(), NoDerivative> {
        let s = arclength(self.rod, self.tau);
        let scale = DVec2::new(s, self.load.abs() + 1.0 / (s * s));
        let sine = |[a, b]: [DVec2; 2]| {
            let (a, b) = (a * scale, b * scale);
            (a.perp_dot(b) / (a.length() * b.length())).abs()
        };
        let tip = self.rod.tau_tip();
        let is_corner = match equations {
            Equations::Push => false,
            Equations::Fold => (self.tau / tip - 1.0).abs() < CORNER,
            Equations::Tip => sine(self.gradients(Equations::Push)) < CORNER,
        };
        if is_corner {
            return Err(NoDerivative::Corner);
        }
        // A sine of NaN is not large.
        let is_regular = sine(self.gradients(equations)) >= SINGULAR;
        if is_regular { Ok(()) } else { Err(NoDerivative::Singular) }
    }

    /// Returns the derivative of the state by the variable with this index, and the derivative of `(ln D, phi)` at first touch. The variable changes
    /// the whisker by `by`. `distance` and `by_distance` are the distance of first touch and its derivative, in whisker lengths.
    pub fn moved(
        &self,
        equations: Equations,
        (variable, by): (usize, &WhiskerDerivative),
        rest: &Rest,
        [distance, by_distance]: [f64; 2],
    ) -> (Moved, DVec2) {
        let none = VariationDerivative::default();
        let parts = self.axes.parts[variable].iter();
        let fixed =
            parts.fold(none, |sum, (axis, coefficient)| sum.plus(*coefficient, &self.by[2 + axis]));
        let touch = rest.touch_derivative(distance, by_distance, &by.rod);
        let other = match equations {
            Equations::Push => touch.y + by.push - fixed.ln_pole.y,
            Equations::Fold => -self.det_along(&fixed),
            Equations::Tip => self.rod.tau_tip_derivative(by.rod.taper),
        };
        let [a, b] = self.gradients(equations);
        let [first, second] = [touch.x - fixed.ln_pole.x, other];
        let tau = (first * b.y - second * a.y) / a.perp_dot(b);
        let load = (second * a.x - first * b.x) / a.perp_dot(b);
        let total = fixed.plus(tau, &self.by[0]).plus(load, &self.by[1]);
        let moved = Moved { tau, state: total.state, phi: total.ln_pole.y };
        (moved, touch)
    }
}

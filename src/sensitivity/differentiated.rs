//! Derivatives of the states of one whisker by some variables, by the implicit function theorem.

use super::linearised::{Equations, Linearised, RodAxes};
use super::whisker::WhiskerDerivative;
use super::{Derivatives, NoDerivative, Variable};
use crate::friction::Sliding;
use crate::scene::{Pole, Whisker};
use crate::sheet::{Crossing, Edge};
use crate::trace::StateAtPush;
use whiskmap_mechanics::rod::{Rest, Rod, Side};
use whiskmap_mechanics::shooting::Resolution;

/// A whisker with its derivatives by some variables.
pub struct Differentiated<'a> {
    resolution: Resolution,
    whisker: &'a Whisker,
    side: Side,
    rod: Rod,
    rest: Rest,
    axes: RodAxes,
    /// Derivatives of the whisker by each variable, `[variable]`.
    by: Vec<Result<WhiskerDerivative, NoDerivative>>,
}

impl<'a> Differentiated<'a> {
    /// Differentiates `whisker` by `variables`.
    pub fn new(
        resolution: Resolution,
        whisker: &'a Whisker,
        pole: &Pole,
        side: Side,
        variables: &[Variable],
    ) -> Self {
        let mut rod = whisker.rod(pole, side);
        let of_variable =
            |variable: &Variable| WhiskerDerivative::new(whisker, pole, side, *variable);
        let mut by: Vec<_> = variables.iter().map(of_variable).collect();
        // At a straight whisker, the parabola `y = a x^2` has the curvature `2 a` of a spiral everywhere.
        if by.iter().flatten().any(|by| by.rod.spiral != [0.0; 2]) {
            rod.spiral.get_or_insert([0.0; 2]);
            for by in by.iter_mut().flatten() {
                by.rod.spiral[0] += 2.0 * std::mem::take(&mut by.rod.bend);
            }
        }
        let given = || by.iter().flatten().map(|by| &by.rod);
        Self {
            resolution,
            whisker,
            side,
            rest: Rest::new(&rod),
            axes: RodAxes::new(given()),
            rod,
            by,
        }
    }

    /// Returns one reason for every variable, `[variable]`.
    fn none(&self, why: NoDerivative) -> Vec<Result<Derivatives, NoDerivative>> {
        let each = |by: &Result<_, NoDerivative>| Err(by.as_ref().err().copied().unwrap_or(why));
        self.by.iter().map(each).collect()
    }

    /// Returns the derivatives, `[variable]`, of the detachment at a crossing. First touch is at `distance_mm`.
    pub fn at_crossing(
        &self,
        crossing: Option<&Crossing>,
        distance_mm: f64,
    ) -> Vec<Result<Derivatives, NoDerivative>> {
        match crossing {
            None => self.none(NoDerivative::NoDetachment),
            Some(crossing) if crossing.is_at_touch() => self.none(NoDerivative::AtTouch),
            Some(crossing) => {
                let equations = match crossing.edge {
                    Edge::Fold => Equations::Fold,
                    Edge::Tip => Equations::Tip,
                };
                self.at(equations, [crossing.tau, crossing.load], distance_mm)
            }
        }
    }

    /// Returns the derivatives, `[variable]`, of a state of a branch. First touch is at `distance_mm`.
    pub fn of_state(
        &self,
        state: &StateAtPush,
        distance_mm: f64,
    ) -> Vec<Result<Derivatives, NoDerivative>> {
        match state.sliding {
            Some(Sliding::Base | Sliding::Sticks) if state.stable => {
                self.none(NoDerivative::Course)
            }
            _ => self.at(Equations::Push, state.point.to_array(), distance_mm),
        }
    }

    /// Returns the derivatives, `[variable]`, of the state at `(tau, load)`, which `equations` determine. First touch is at `distance_mm`.
    fn at(
        &self,
        equations: Equations,
        point: [f64; 2],
        distance_mm: f64,
    ) -> Vec<Result<Derivatives, NoDerivative>> {
        if self.by.is_empty() {
            return Vec::new();
        }
        let at = Linearised::new(self.resolution, &self.rod, &self.axes, point);
        if let Err(why) = at.check(equations) {
            return self.none(why);
        }
        let length = self.whisker.length_mm;
        let units = self.whisker.units();
        let mut place = 0..;
        let derivatives = |by: &Result<WhiskerDerivative, NoDerivative>| {
            let by = by.as_ref().map_err(|why| *why)?;
            let variable = (place.next().unwrap_or_default(), by);
            let distance = distance_mm / length;
            let by_distance = (by.distance_mm - by.length_mm * distance) / length;
            let (moved, touch) = at.moved(equations, variable, &self.rest, [distance, by_distance]);
            Ok(Derivatives::new(&at, &moved, (&self.rest, units, self.side), by, touch.y))
        };
        self.by.iter().map(derivatives).collect()
    }
}

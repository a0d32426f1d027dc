//! Tasks of the benchmarks: the states of a scene, with exact solutions.

use super::solver::{Hit, Solver};
use crate::plan::Plan;
use crate::refine::{CellTarget, states};
use crate::scene::{Scene, SweptWhisker};
use crate::sheet::Sheet;
use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashMap;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::rod::{Effects, Rod, Side, arclength};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{Resolution, ShootingMap};

/// Resolution of exact states: four times the steps of [`Resolution::FINE`], so that errors of order 8 are 65,536 times smaller.
pub const EXACT: Resolution = Resolution::FINE.doubled().doubled();

/// Task of a benchmark: the cells of a scene that have a state.
pub struct Task {
    pub effects: Effects,
    pub rods: Vec<Rod>,
    pub targets: Vec<CellTarget>,
    /// Exact `(tau, load)` of each target.
    exact: Vec<(f64, f64)>,
    by_pole: HashMap<(u32, [u64; 2]), usize>,
}

fn key(rod: u32, pole: DVec2) -> (u32, [u64; 2]) {
    (rod, pole.to_array().map(f64::to_bits))
}

/// Returns `(tau, load)` of every hit, dimensionless: `[hit]`.
pub fn places(hits: &[Hit]) -> Vec<(f64, f64)> {
    hits.iter().map(|hit| (hit.tau, hit.load)).collect()
}

/// Returns the whiskers of a scene, each on every side that the push angles need: `[side]`.
pub fn whisker_sides(scene: &Scene) -> Vec<(SweptWhisker, Side)> {
    let sides = Plan::sides(scene);
    let both = |swept: SweptWhisker| sides.iter().map(move |side| (swept.clone(), *side));
    scene.whiskers().flatten().flat_map(both).collect()
}

/// Distribution of the magnitude of an error over all states, in the unit of the field that contains it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    /// Largest error of all states; infinite if one is NaN.
    pub worst: f64,
    /// Largest error of the best 99 % of the states.
    pub p99: f64,
}

impl Spread {
    /// Returns the distribution of the errors `values`; NaN counts as the largest.
    pub fn of(mut values: Vec<f64>) -> Self {
        for value in &mut values {
            if value.is_nan() {
                *value = f64::INFINITY;
            }
        }
        values.sort_by(f64::total_cmp);
        let at = |part: f64| {
            let place = (part * values.len().saturating_sub(1) as f64) as usize;
            values.get(place).copied().unwrap_or(0.0)
        };
        Self { worst: at(1.0), p99: at(0.99) }
    }
}

/// Errors of the states that an engine found: of pole, arclength and force.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Errors {
    /// Number of states with errors.
    pub states: usize,
    /// Angular distance of the state's pole from its target, as seen from the base, in degrees.
    pub angle_deg: Spread,
    /// Error of the contact's arclength, in whisker lengths. Near the fold it is the square root of the angle's.
    pub arc_length: Spread,
    /// Error of the force, dimensionless: over the sum of the force and the force of a load with `q = 1`.
    pub force: Spread,
}

impl Task {
    /// Creates the task of a scene: the states of every cell that has one.
    pub fn new(scene: &Scene) -> Self {
        let sides = whisker_sides(scene);
        let rod = |(swept, side): &(SweptWhisker, Side)| swept.rod(*side);
        let rods: Vec<Rod> = sides.iter().map(rod).collect();
        let effects = Effects::of(&rods);
        let method = Method::fine().with_effects(effects);
        let distances_mm = &scene.grid.distance_mm;
        let (targets, starts): (Vec<CellTarget>, Vec<CellTarget>) =
            (rods.par_iter().zip(&sides).enumerate())
                .flat_map_iter(|(index, (rod, (swept, side)))| {
                    let length = swept.whisker.length_mm;
                    let distances: Vec<f64> = distances_mm.iter().map(|d| d / length).collect();
                    let sheet = Sheet::new(method, rod, *side, &distances);
                    let solved = states(method, &sheet, &scene.grid.push_angle_deg);
                    solved.into_iter().map(move |(target, state)| {
                        let rod = index as u32;
                        let target = CellTarget { rod, ..target };
                        let guess = state.point;
                        (target, CellTarget { guess, ..target })
                    })
                })
                .unzip();
        let solver = Solver { unit: Unit::detect(), resolution: EXACT, tolerance: 1e-13 };
        let exact = solver.solve(effects, &rods, &starts);
        let by_pole = targets.iter().enumerate();
        Self {
            effects,
            exact: places(&exact),
            by_pole: by_pole.map(|(i, target)| (key(target.rod, target.pole), i)).collect(),
            rods,
            targets,
        }
    }

    /// Returns the index of the target of a rod with this pole; `None` without one.
    pub fn target(&self, rod: u32, pole: DVec2) -> Option<usize> {
        self.by_pole.get(&key(rod, pole)).copied()
    }

    /// Returns the task with some of the targets alone.
    pub fn only(&self, targets: &[usize]) -> Self {
        Self {
            effects: self.effects,
            rods: self.rods.clone(),
            targets: targets.iter().map(|i| self.targets[*i]).collect(),
            exact: targets.iter().map(|i| self.exact[*i]).collect(),
            by_pole: HashMap::new(),
        }
    }

    /// Returns the initial conditions at `points`, the `(tau, load)` of every target: `[target]`.
    pub fn conditions(&self, points: &[(f64, f64)]) -> Vec<InitialCondition<'_>> {
        let pairs = self.targets.iter().zip(points);
        pairs.map(|(target, point)| self.condition(target, *point)).collect()
    }

    /// Returns the initial conditions of the exact states: `[target]`.
    pub fn exact_conditions(&self) -> Vec<InitialCondition<'_>> {
        self.conditions(&self.exact)
    }

    fn condition(&self, target: &CellTarget, (tau, load): (f64, f64)) -> InitialCondition<'_> {
        let rod = &self.rods[target.rod as usize];
        InitialCondition { rod, tau, load }
    }

    /// Returns the errors of the states at `points`, the `(tau, load)` of every target.
    pub fn errors(&self, points: &[(f64, f64)]) -> Errors {
        let [found, exact] = [points, &self.exact].map(|points| self.conditions(points));
        let method = Method::new(EXACT).with_effects(self.effects);
        let maps = Batch::new(method).shoot::<ShootingMap>(&found);
        let angle = |i: usize| maps[i].residual(self.targets[i].pole).length().to_degrees();
        let place = |condition: &InitialCondition| arclength(condition.rod, condition.tau);
        let arc = |i: usize| (place(&found[i]) - place(&exact[i])).abs();
        let force = |condition: &InitialCondition| {
            condition.load * condition.rod.radius(condition.tau).powi(2)
        };
        let of_force = |i: usize| {
            let exact = &exact[i];
            let unit = (exact.rod.radius(exact.tau) / place(exact)).powi(2);
            (force(&found[i]) - force(exact)).abs() / (force(exact).abs() + unit)
        };
        let over = |error: &dyn Fn(usize) -> f64| Spread::of((0..found.len()).map(error).collect());
        Errors {
            states: found.len(),
            angle_deg: over(&angle),
            arc_length: over(&arc),
            force: over(&of_force),
        }
    }
}

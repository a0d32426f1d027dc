//! The states of a scene, with exact answers.

use super::solver::{Hit, Solver};
use crate::numerics::Unit;
use crate::plan::Plan;
use crate::refine::{CellTarget, states};
use crate::rod::{Effects, Rod, Side, arclength};
use crate::scene::{Scene, SweptWhisker};
use crate::sheet::Sheet;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{Resolution, ShootingMap};
use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashMap;

/// Four times as many steps as [`Resolution::FINE`]: with order 8, errors that are 65,536 times smaller.
pub const EXACT: Resolution = Resolution::FINE.doubled().doubled();

/// Shots that have an answer.
pub struct Task {
    pub effects: Effects,
    pub rods: Vec<Rod>,
    pub shots: Vec<CellTarget>,
    /// The answers, `(tau, load)`.
    exact: Vec<(f64, f64)>,
    by_pole: HashMap<(u32, [u64; 2]), usize>,
}

fn key(rod: u32, pole: DVec2) -> (u32, [u64; 2]) {
    (rod, pole.to_array().map(f64::to_bits))
}

/// What a row's seconds were spent on.
pub struct Work {
    /// Trajectories that the engine integrated.
    pub trajectories: f64,
    /// Their floating-point operations.
    pub operations: f64,
}

/// `(tau, load)` of every hit.
pub fn places(hits: &[Hit]) -> Vec<(f64, f64)> {
    hits.iter().map(|hit| (hit.tau, hit.load)).collect()
}

/// The whiskers of a scene, each on the sides that its push angles ask for.
pub fn faces(scene: &Scene) -> Vec<(SweptWhisker, Side)> {
    let sides = Plan::sides(scene);
    let both = |own: SweptWhisker| sides.iter().map(move |side| (own.clone(), *side));
    scene.whiskers().flat_map(both).collect()
}

/// A number over all states.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    /// The largest.
    pub worst: f64,
    /// The largest of the best 99 %.
    pub p99: f64,
}

impl Spread {
    /// Returns the spread of `values`; NaN counts as the worst.
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
        Self {
            worst: at(1.0),
            p99: at(0.99),
        }
    }
}

/// How far off states are.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Errors {
    /// Over how many states.
    pub states: usize,
    /// The push angle, and the distance in radians, for which the state would be right, from the wanted one; in degrees.
    pub angle_deg: Spread,
    /// Arclength of the contact, in whisker lengths. Next to the fold it is the square root of the angle's.
    pub arc_length: Spread,
    /// Force, relative to itself plus that of `q = 1`.
    pub force: Spread,
}

impl Task {
    /// The states of every cell of `scene` that has one.
    pub fn new(scene: &Scene) -> Self {
        let faces = faces(scene);
        let rod = |(own, side): &(SweptWhisker, Side)| own.rod(*side);
        let rods: Vec<Rod> = faces.iter().map(rod).collect();
        let effects = Effects::of(&rods);
        let method = Method::fine().with_effects(effects);
        let distances_mm = &scene.grid.distance_mm;
        let (shots, starts): (Vec<CellTarget>, Vec<CellTarget>) =
            (rods.par_iter().zip(&faces).enumerate())
                .flat_map_iter(|(index, (rod, (own, side)))| {
                    let length = own.whisker.length_mm;
                    let distances: Vec<f64> = distances_mm.iter().map(|d| d / length).collect();
                    let sheet = Sheet::new(method, rod, *side, &distances);
                    let solved = states(method, &sheet, &scene.grid.push_angle_deg);
                    solved.into_iter().map(move |(shot, state)| {
                        let rod = index as u32;
                        let shot = CellTarget { rod, ..shot };
                        let (tau, load) = (state.tau, state.load);
                        (shot, CellTarget { tau, load, ..shot })
                    })
                })
                .unzip();
        let solver = Solver {
            unit: Unit::detect(),
            resolution: EXACT,
            tolerance: 1e-13,
        };
        let exact = solver.solve(effects, &rods, &starts);
        let by_pole = shots.iter().enumerate();
        Self {
            effects,
            exact: places(&exact),
            by_pole: by_pole
                .map(|(i, shot)| (key(shot.rod, shot.pole), i))
                .collect(),
            rods,
            shots,
        }
    }

    /// The shot of a rod toward this pole.
    pub fn shot(&self, rod: u32, pole: DVec2) -> Option<usize> {
        self.by_pole.get(&key(rod, pole)).copied()
    }

    /// Some of the shots alone.
    pub fn only(&self, shots: &[usize]) -> Self {
        Self {
            effects: self.effects,
            rods: self.rods.clone(),
            shots: shots.iter().map(|i| self.shots[*i]).collect(),
            exact: shots.iter().map(|i| self.exact[*i]).collect(),
            by_pole: HashMap::new(),
        }
    }

    /// The states `points`, `(tau, load)` of every shot, as conditions.
    pub fn conditions(&self, points: &[(f64, f64)]) -> Vec<InitialCondition<'_>> {
        let pairs = self.shots.iter().zip(points);
        pairs
            .map(|(shot, point)| self.condition(shot, *point))
            .collect()
    }

    fn condition(&self, shot: &CellTarget, (tau, load): (f64, f64)) -> InitialCondition<'_> {
        let rod = &self.rods[shot.rod as usize];
        InitialCondition { rod, tau, load }
    }

    /// The work on these hits; `count` tells the operations of a trajectory, and is asked for every 64th shot.
    pub fn work(&self, hits: &[Hit], count: impl Fn(&InitialCondition) -> u64) -> Work {
        const EVERY: usize = 64;
        let steps = |hit: &Hit| f64::from(hit.steps);
        let pairs = || hits.iter().zip(&self.shots).step_by(EVERY);
        let counted: f64 = pairs()
            .map(|(hit, shot)| {
                count(&self.condition(shot, (shot.tau, shot.load))) as f64 * steps(hit)
            })
            .sum();
        let sampled: f64 = pairs().map(|(hit, _)| steps(hit)).sum();
        let trajectories = hits.iter().map(steps).sum();
        Work {
            trajectories,
            operations: counted / sampled.max(1.0) * trajectories,
        }
    }

    /// How far off the answers `points`, `(tau, load)` of every shot, are.
    pub fn errors(&self, points: &[(f64, f64)]) -> Errors {
        let [found, exact] = [points, &self.exact].map(|points| self.conditions(points));
        let method = Method::new(EXACT).with_effects(self.effects);
        let shot = Batch::new(method).shoot::<ShootingMap>(&found);
        let angle = |i: usize| shot[i].residual(self.shots[i].pole).length().to_degrees();
        let place = |condition: &InitialCondition| arclength(condition.rod, condition.tau);
        let arc = |i: usize| (place(&found[i]) - place(&exact[i])).abs();
        let force = |condition: &InitialCondition| {
            condition.load * condition.rod.radius(condition.tau).powi(2)
        };
        let off = |i: usize| {
            let exact = &exact[i];
            let unit = (exact.rod.radius(exact.tau) / place(exact)).powi(2);
            (force(&found[i]) - force(exact)).abs() / (force(exact).abs() + unit)
        };
        let over = |error: &dyn Fn(usize) -> f64| Spread::of((0..found.len()).map(error).collect());
        Errors {
            states: found.len(),
            angle_deg: over(&angle),
            arc_length: over(&arc),
            force: over(&off),
        }
    }
}

//! Newton's method as the shaders do it (`shaders/shoot.wgsl`), in `f64` on the CPU: on any SIMD unit, at any resolution.

use crate::integrate::{Hit, MOST_STEPS, Outcome, Shot};
use crate::numerics::Unit;
use crate::rod::{Effects, Rod, arclength};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{Resolution, ShootingMap};
use glam::DVec2;
use rayon::prelude::*;

/// Shots that go through all steps as one batch: enough for full lanes, few enough to stay in the inner cache.
const BATCH: usize = 1024;

/// How the CPU solves shots.
#[derive(Clone, Copy, Debug)]
pub struct Solver {
    /// What integrates.
    pub unit: Unit,
    /// How finely.
    pub resolution: Resolution,
    /// Residual, in whisker lengths, after which one more step is the last.
    pub tolerance: f64,
}

impl Solver {
    /// Solves `shots`, each on one of `rods`; answers in the same order.
    #[must_use]
    pub fn solve(self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Vec<Hit> {
        shots
            .par_chunks(BATCH)
            .flat_map_iter(|shots| self.solve_batch(effects, rods, shots))
            .collect()
    }

    fn solve_batch(self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Vec<Hit> {
        let method = Method::new(self.resolution).with_effects(effects);
        let batch = Batch::new(method).on(self.unit);
        let mut hits: Vec<Hit> = shots.iter().map(Hit::untouched).collect();
        let mut open: Vec<usize> = (0..shots.len()).collect();
        for round in 0..=MOST_STEPS {
            let condition = |&i: &usize| InitialCondition {
                rod: &rods[shots[i].rod as usize],
                tau: hits[i].tau,
                load: hits[i].load,
            };
            let conditions: Vec<InitialCondition> = open.iter().map(condition).collect();
            let maps: Vec<ShootingMap> = batch.shoot(&conditions);
            for ((&i, condition), map) in open.iter().zip(&conditions).zip(&maps) {
                let (hit, wanted) = (&mut hits[i], shots[i].pole);
                self.step(condition.rod, hit, map, wanted, round < MOST_STEPS);
            }
            open.retain(|&i| hits[i].outcome == Outcome::Stalled);
        }
        hits
    }

    /// Judges a map and, unless it is the last, takes a Newton step from it.
    fn step(&self, rod: &Rod, hit: &mut Hit, map: &ShootingMap, wanted: DVec2, more: bool) {
        hit.residual = map.pole.distance(wanted);
        if !hit.residual.is_finite() {
            hit.outcome = Outcome::NotFinite;
            return;
        }
        if hit.residual <= self.tolerance {
            hit.outcome = Outcome::Converged;
        }
        if more {
            let step = map.newton_step(wanted, arclength(rod, hit.tau), hit.load);
            hit.tau += step.x;
            hit.load += step.y;
            hit.steps += 1;
        }
    }
}

//! Newton's method on shots alone, in `f64` on the CPU: on any SIMD unit, at any resolution.

use crate::numerics::Unit;
use crate::refine::CellTarget;
use crate::rod::{Effects, Rod, arclength};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{Resolution, ShootingMap};
use rayon::prelude::*;

/// Shots that go through all steps as one batch: enough for full lanes, few enough to stay in the inner cache.
const BATCH: usize = 1024;

/// Newton steps that a shot may take.
const MOST_STEPS: u32 = 4;

/// What was made of a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Distance of the pole from the wanted place at the last trajectory, in whisker lengths.
    pub residual: f64,
    /// Newton steps taken.
    pub steps: u32,
}

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
    pub fn solve(self, effects: Effects, rods: &[Rod], shots: &[CellTarget]) -> Vec<Hit> {
        shots
            .par_chunks(BATCH)
            .flat_map_iter(|shots| self.solve_batch(effects, rods, shots))
            .collect()
    }

    fn solve_batch(self, effects: Effects, rods: &[Rod], shots: &[CellTarget]) -> Vec<Hit> {
        let method = Method::new(self.resolution).with_effects(effects);
        let batch = Batch::new(method).on(self.unit);
        let start = |shot: &CellTarget| Hit {
            tau: shot.tau,
            load: shot.load,
            residual: f64::INFINITY,
            steps: 0,
        };
        let mut hits: Vec<Hit> = shots.iter().map(start).collect();
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
                let (hit, shot) = (&mut hits[i], &shots[i]);
                hit.residual = map.pole.distance(shot.pole);
                if round < MOST_STEPS && hit.residual.is_finite() {
                    let s = arclength(condition.rod, hit.tau);
                    let step = map.newton_step(shot.pole, s, hit.load);
                    hit.tau += step.x;
                    hit.load += step.y;
                    hit.steps += 1;
                }
            }
            // The step after a small residual is the last.
            open.retain(|&i| hits[i].residual > self.tolerance && hits[i].residual.is_finite());
        }
        hits
    }
}

//! Solver of the benchmarks: Newton's method alone, in `f64` on the CPU, on any SIMD unit, at any resolution.

use crate::refine::CellTarget;
use rayon::prelude::*;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::rod::{Effects, Rod, arclength};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{Resolution, ShootingMap};

/// Targets of a batch: enough for full lanes, few enough to stay in the inner cache.
const BATCH: usize = 1024;

/// Maximum number of Newton steps of a target.
const MOST_STEPS: u32 = 4;

/// Last state that the solver computed for a target, converged or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Contact coordinate `tau` of the state, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the state, dimensionless.
    pub load: f64,
    /// Residual of the last trajectory: distance of the pole from its target, in whisker lengths.
    pub residual: f64,
    /// Number of Newton steps taken for the target.
    pub steps: u32,
}

/// Settings with which the CPU solves targets.
#[derive(Clone, Copy, Debug)]
pub struct Solver {
    /// SIMD unit that integrates the solver's trajectories.
    pub unit: Unit,
    /// Resolution of the solver's trajectories.
    pub resolution: Resolution,
    /// Residual, in whisker lengths, below which the solver's next step is the last.
    pub tolerance: f64,
}

impl Solver {
    /// Solves `targets`, each on one of `rods`. Returns the last states in the same order, `[target]`.
    #[must_use]
    pub fn solve(self, effects: Effects, rods: &[Rod], targets: &[CellTarget]) -> Vec<Hit> {
        targets
            .par_chunks(BATCH)
            .flat_map_iter(|targets| self.solve_batch(effects, rods, targets))
            .collect()
    }

    fn solve_batch(self, effects: Effects, rods: &[Rod], targets: &[CellTarget]) -> Vec<Hit> {
        let method = Method::new(self.resolution).with_effects(effects);
        let batch = Batch::new(method).on(self.unit);
        let start = |target: &CellTarget| Hit {
            tau: target.guess.x,
            load: target.guess.y,
            residual: f64::INFINITY,
            steps: 0,
        };
        let mut hits: Vec<Hit> = targets.iter().map(start).collect();
        let mut open: Vec<usize> = (0..targets.len()).collect();
        for round in 0..=MOST_STEPS {
            let condition = |&i: &usize| {
                let rod = &rods[targets[i].rod as usize];
                InitialCondition::new(rod, (hits[i].tau, hits[i].load))
            };
            let conditions: Vec<InitialCondition> = open.iter().map(condition).collect();
            let maps: Vec<ShootingMap> = batch.shoot(&conditions);
            for ((&i, condition), map) in open.iter().zip(&conditions).zip(&maps) {
                let (hit, target) = (&mut hits[i], &targets[i]);
                hit.residual = map.pole.distance(target.pole);
                if round < MOST_STEPS && hit.residual.is_finite() {
                    let s = arclength(condition.rod, hit.tau);
                    let step = map.newton_step(target.pole, s, hit.load);
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

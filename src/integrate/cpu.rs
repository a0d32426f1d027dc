//! The CPU engine: `f64`, SIMD lanes, all threads of the current pool.

use super::{Description, Engine, EngineError, Hit, MOST_STEPS, Outcome, Shot};
use crate::numerics::Unit;
use crate::rod::{Effects, Rod, arclength};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{Resolution, ShootingMap};
use glam::DVec2;
use rayon::prelude::*;

/// Off by less than 5e-8 (`tests/gpu_engine`): the refinement then mostly needs a single trajectory.
const RESOLUTION: Resolution = Resolution::COARSE;

/// Shots that go through all steps together: enough for full lanes, few enough to stay in the inner cache.
const TOGETHER: usize = 1024;

/// Shots for one thread: so many that nearly all blocks are full, and hardly a page is new for them.
const SHOTS_OF_A_THREAD: usize = 8192;

/// Residual at which the refinement takes over, in whisker lengths: one Newton step away from the resolution's error.
const TOLERANCE: f64 = 1e-6;

/// The CPU engine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cpu;

/// Newton's method as the CPU engine does it, on any unit, at any resolution, to any tolerance.
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
            .par_chunks(TOGETHER)
            .flat_map_iter(|shots| self.solve_together(effects, rods, shots))
            .collect()
    }

    fn solve_together(self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Vec<Hit> {
        let method = Method::new(self.resolution).with_effects(effects);
        let mut hits: Vec<Hit> = shots
            .iter()
            .map(|shot| Hit {
                tau: shot.tau,
                load: shot.load,
                residual: f64::INFINITY,
                steps: 0,
                outcome: Outcome::Stalled,
            })
            .collect();
        let mut open: Vec<usize> = (0..shots.len()).collect();
        for round in 0..=MOST_STEPS {
            let conditions: Vec<InitialCondition> = open
                .iter()
                .map(|&i| InitialCondition {
                    rod: &rods[shots[i].rod as usize],
                    tau: hits[i].tau,
                    load: hits[i].load,
                })
                .collect();
            let maps = Batch::new(method)
                .on(self.unit)
                .shoot::<ShootingMap>(&conditions);
            let mut next = Vec::new();
            for ((&i, condition), map) in open.iter().zip(&conditions).zip(&maps) {
                let hit = &mut hits[i];
                self.step(condition.rod, hit, map, shots[i].pole, round < MOST_STEPS);
                if hit.outcome == Outcome::Stalled {
                    next.push(i);
                }
            }
            open = next;
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

impl Engine for Cpu {
    fn describe(&self) -> Description {
        Description {
            engine: "cpu f64".to_owned(),
            adapter: Unit::detect().to_string(),
        }
    }

    /// The refinement takes the same steps on the same processor.
    fn spares_work(&self) -> bool {
        false
    }

    fn shots_at_once(&self) -> usize {
        SHOTS_OF_A_THREAD * rayon::current_num_threads()
    }

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let solver = Solver {
            unit: Unit::detect(),
            resolution: RESOLUTION,
            tolerance: TOLERANCE,
        };
        Ok(solver.solve(effects, rods, shots))
    }
}

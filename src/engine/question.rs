//! What an engine is asked: the cells of some references, with the trajectories of these.

use super::BasePoint;
use crate::rod::{Effects, Rod};
use crate::shooting::Resolution;
use crate::shooting::batch::{InitialCondition, StepStart, step_starts};
use rayon::prelude::*;
use std::sync::Arc;

/// Most steps of a trajectory. Nearly all take dozens; rows with one that asks for more have no references.
pub const MOST_TRAJECTORY_STEPS: u32 = 512;

/// The references of one thread at a time.
const TOGETHER: usize = 64;

/// The cells of some references.
#[derive(Debug, Default)]
pub struct Question {
    /// Some that are [`on_gpu`](super::on_gpu).
    pub effects: Effects,
    /// The rods of the references.
    pub rods: Vec<Rod>,
    /// Signed push angles, in radians.
    pub pushes: Arc<[f64]>,
    /// The references; answers are in the order of their cells.
    pub references: Vec<BasePoint>,
    /// The trajectory of each.
    pub trajectories: Vec<Trajectory>,
    /// Where their steps start, one trajectory after the other.
    pub starts: Vec<StepStart>,
}

/// The trajectory of a reference.
#[derive(Clone, Copy, Debug)]
pub struct Trajectory {
    /// Its steps.
    pub steps: u32,
    /// How far bending has turned the base.
    pub bent: f64,
}

impl Question {
    /// About the cells of `references` on `rods` at some of the `pushes`, with trajectories in the steps of `resolution`.
    #[must_use]
    pub fn new(
        effects: Effects,
        resolution: Resolution,
        rods: Vec<Rod>,
        pushes: Arc<[f64]>,
        references: Vec<BasePoint>,
    ) -> Self {
        let parts = references.par_chunks(TOGETHER);
        let parts = parts.map(|references| {
            let conditions = references.iter().map(|reference| InitialCondition {
                rod: &rods[reference.rod as usize],
                tau: reference.tau,
                load: reference.load,
            });
            let conditions: Vec<InitialCondition> = conditions.collect();
            let steps = conditions.iter().map(|at| {
                let steps = resolution.steps(at.rod, at.tau, at.load);
                // Numbers that are none ask for thousands.
                steps.min(MOST_TRAJECTORY_STEPS)
            });
            let steps: Vec<u32> = steps.collect();
            let (starts, bent) = step_starts(&conditions, &steps);
            let trajectories = steps.into_iter().zip(bent);
            let trajectories = trajectories.map(|(steps, bent)| Trajectory { steps, bent });
            (trajectories.collect(), starts)
        });
        let parts: Vec<(Vec<Trajectory>, Vec<StepStart>)> = parts.collect();
        let (trajectories, starts): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        Self {
            effects,
            pushes,
            trajectories: trajectories.concat(),
            starts: starts.concat(),
            rods,
            references,
        }
    }

    /// How many answers it has.
    #[must_use]
    pub fn cells(&self) -> usize {
        let cells = self
            .references
            .iter()
            .map(|reference| reference.cells.len());
        cells.sum()
    }
}

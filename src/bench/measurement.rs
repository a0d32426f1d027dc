//! Measurement of one engine at one accuracy.

use super::BenchEngine;
use super::task::Errors;
use super::timing::Timing;
use crate::quantile::median;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Wall times of stages, in milliseconds, by the name of the stage.
pub type StageTimes = BTreeMap<String, f64>;

/// Measurement of one engine at one accuracy.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// Name of the measured engine.
    pub engine: String,
    /// Number of threads of the CPU engine; `None` for other engines.
    pub threads: Option<usize>,
    /// Integrator and number of steps of the measurement.
    pub rung: Rung,
    /// Times for all states, in seconds.
    pub seconds: Timing,
    /// Wall milliseconds of the engine's stages, medians of the runs; 0 where the engine has no such stage. `upload`: rows,
    /// packing and submitting; `dispatch`: solving, by the device's clock on a GPU that has one; `waiting`: for the device;
    /// `readback`: unpacking.
    pub stages_ms: StageTimes,
    /// Time for one state, in microseconds.
    pub us_per_state: f64,
    /// Rate of the engine in states per second.
    pub states_per_s: f64,
    /// Rate of the engine in trajectories per second; `None` for expansions.
    pub trajectories_per_s: Option<f64>,
    /// Errors of the states that the engine found.
    pub errors: Errors,
    /// True if no other measurement is both faster and more accurate.
    pub pareto: bool,
}

impl Measurement {
    pub(super) fn new(
        engine: &BenchEngine,
        rung: Rung,
        seconds: Timing,
        stages_ms: [f64; 4],
        trajectories: Option<f64>,
        errors: Errors,
    ) -> Self {
        let states = errors.states as f64;
        Self {
            engine: engine.name.clone(),
            threads: engine.threads,
            rung,
            seconds,
            stages_ms: STAGES.map(str::to_owned).into_iter().zip(stages_ms).collect(),
            us_per_state: 1e6 * seconds.median / states,
            states_per_s: states / seconds.median,
            trajectories_per_s: trajectories.map(|count| count / seconds.median),
            errors,
            pareto: false,
        }
    }
}

/// Stages of a row, in the order of the work.
const STAGES: [&str; 4] = ["upload", "dispatch", "waiting", "readback"];

/// Integrator of a measurement, and its number of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rung {
    /// The integrator of the engine; `chebyshev` for expansions of rows.
    pub integrator: &'static str,
    /// Steps of a trajectory at the fold of a cylinder, fewer under less load; of expansions, loads at each contact of a net.
    pub steps: u32,
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x{}", self.integrator, self.steps)
    }
}

/// Returns the median of each stage in several runs.
pub(super) fn medians(runs: &[StageTimes]) -> StageTimes {
    let stages = runs.first().into_iter().flat_map(BTreeMap::keys);
    let of_runs = |stage: &String| median(runs.iter().map(|run| run[stage]));
    stages.map(|stage| (stage.clone(), of_runs(stage))).collect()
}

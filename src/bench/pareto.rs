//! Which rows are worth choosing.

use super::cpu::Work;
use super::task::Errors;
use super::{Measurement, Rung, Stages, Timing};

impl Measurement {
    pub(super) fn new(
        engine: &str,
        threads: Option<usize>,
        rung: Rung,
        seconds: Timing,
        stages_ms: Stages,
        work: Work,
        errors: Errors,
    ) -> Self {
        let states = errors.states as f64;
        let gflops = 1e-9 * work.operations / seconds.median;
        Self {
            engine: engine.to_owned(),
            threads,
            rung,
            seconds,
            stages_ms,
            us_per_state: 1e6 * seconds.median / states,
            states_per_s: states / seconds.median,
            trajectories_per_s: work.trajectories / seconds.median,
            gflops,
            of_peak: gflops / work.peak_gflops,
            errors,
            pareto: false,
        }
    }
}

/// Marks the rows that no other row beats in both time and worst error of the angle.
pub fn mark(rows: &mut [Measurement]) {
    let places: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.us_per_state, row.errors.angle_deg.worst])
        .collect();
    for (row, here) in rows.iter_mut().zip(&places) {
        let beats = |other: &[f64; 2]| other[0] <= here[0] && other[1] <= here[1] && other != here;
        row.pareto = !places.iter().any(beats);
    }
}

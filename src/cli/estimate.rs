//! What a map would take, measured: samples of it are computed on the CPU engine and thrown away.

use super::failure::Failure;
use std::convert::Infallible;
use std::time::Instant;
use whiskmap::map::{self, Stage};
use whiskmap::plan::{Plan, SAMPLE_LINES, SAMPLE_VALUES};
use whiskmap::scene::Scene;

/// What a map would take.
pub struct Estimate {
    /// Seconds on the threads of the CPU engine, without the files.
    pub seconds: f64,
    /// Newton steps per cell, each one trajectory.
    pub steps_per_cell: f64,
}

/// Seconds that the last sample may take, as the one before it foretells.
const LONGEST: f64 = 2.0;

/// From one sample to the next: so many times as many push angles, and distances.
const DENSER: usize = 4;

/// Measures samples of `scene`, each [`DENSER`] than the one before, as far as there is time, and scales the last one to `plan`:
/// sheets by whiskers, sides and distances, the rest by cells.
pub fn estimate(scene: &Scene, plan: &Plan) -> Result<Estimate, Failure> {
    let mut lines = SAMPLE_LINES / DENSER.pow(2);
    loop {
        let start = Instant::now();
        let estimate = measured(scene, plan, lines)?;
        match denser(lines, start.elapsed().as_secs_f64()) {
            Some(denser) => lines = denser,
            None => return Ok(estimate),
        }
    }
}

/// The lines of the sample after one that took so many `seconds`; none where that is the last.
fn denser(lines: usize, seconds: f64) -> Option<usize> {
    let is_short = seconds * (DENSER * DENSER) as f64 <= LONGEST;
    (is_short && lines < SAMPLE_LINES).then_some(lines * DENSER)
}

/// Measures a sample of at most so many `lines` each way.
fn measured(scene: &Scene, plan: &Plan, lines: usize) -> Result<Estimate, Failure> {
    let small = scene.thinned(lines, SAMPLE_VALUES);
    let small_plan = Plan {
        method: plan.method,
        ..Plan::new(&small)?
    };
    let Ok(summary) = map::run(&small, &small_plan, None, &mut |_| Ok::<(), Infallible>(()));
    let rows = |scene: &Scene, plan: &Plan| {
        (plan.whiskers * plan.sides.len() * scene.grid.distance_mm.len()) as f64
    };
    let by_rows = rows(scene, plan) / rows(&small, &small_plan);
    let by_cells = plan.cells as f64 / small_plan.cells as f64;
    let seconds = Stage::ALL.map(|(stage, _)| match stage {
        Stage::Sheets => summary.seconds(stage) * by_rows,
        _ => summary.seconds(stage) * by_cells,
    });
    Ok(Estimate {
        seconds: seconds.iter().sum(),
        steps_per_cell: summary.steps as f64 / summary.cells() as f64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_sample_is_the_last() {
        assert_eq!(denser(8, 0.01), Some(32));
        assert_eq!(denser(32, 0.01), Some(SAMPLE_LINES));
        assert_eq!(denser(SAMPLE_LINES, 0.01), None);
        assert_eq!(denser(8, 0.2), None);
    }
}

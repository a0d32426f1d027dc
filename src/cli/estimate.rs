//! What a map would take, measured: a sample of it is computed on the CPU engine and thrown away.

use super::failure::Failure;
use std::convert::Infallible;
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

/// Measures a sample of `scene` and scales it to `plan`: sheets by whiskers, sides and distances, the rest by cells.
pub fn estimate(scene: &Scene, plan: &Plan) -> Result<Estimate, Failure> {
    let small = scene.thinned(SAMPLE_LINES, SAMPLE_VALUES);
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

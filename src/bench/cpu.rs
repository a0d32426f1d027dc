//! Measurements of the CPU engine: scalar, SIMD vectors on one thread, and on all threads.

use super::solver::{Hit, Solver};
use super::task::{Task, places};
use super::timing::timed;
use super::{BenchEngine, Measurement, Report, Rung, pool};
use crate::engine::EngineError;
use std::convert::Infallible;
use std::time::Instant;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::shooting::Resolution;

/// Residual, in whisker lengths, below which one more Newton step reaches rounding, next to a fold too: with 1e-7, a state of the paper's cone there
/// is left with 4e-9 degrees.
const TOLERANCE: f64 = 1e-8;

/// Adds the measurements of the CPU engine to `report`.
pub fn measure(
    task: &Task,
    runs: usize,
    report: &mut Report,
    on_step: &mut dyn FnMut(&str),
) -> Result<(), EngineError> {
    let all = rayon::current_num_threads();
    let vectors = Unit::detect();
    let mut engines = vec![(Unit::scalar(), 1), (vectors, 1)];
    if all > 1 {
        engines.push((vectors, all));
    }
    for (unit, threads) in engines {
        let name = format!("cpu {unit}");
        on_step(&format!("{name}, {threads} threads"));
        let pool = pool(threads)?;
        let solver = |resolution| Solver { unit, resolution, tolerance: TOLERANCE };
        let start = Instant::now();
        pool.install(|| {
            solver(Resolution::FINE).solve(task.effects, &task.rods, &task.targets[..1])
        });
        let first_result_s = start.elapsed().as_secs_f64();
        let engine =
            BenchEngine { name, threads: Some(threads), adapter: unit.to_string(), first_result_s };
        let row = |resolution| row(task, runs, &engine, solver(resolution));
        let rows = Resolution::LADDER.map(|resolution| pool.install(|| row(resolution)));
        report.rows.extend(rows);
        report.engines.push(engine);
    }
    Ok(())
}

/// Measures a row of `engine` on the threads of the current pool.
fn row(task: &Task, runs: usize, engine: &BenchEngine, solver: Solver) -> Measurement {
    let Ok((seconds, hits)) = timed(runs, || {
        let hits = solver.solve(task.effects, &task.rods, &task.targets);
        Ok::<Vec<Hit>, Infallible>(hits)
    });
    let resolution = solver.resolution;
    let trajectories = hits.iter().map(|hit| f64::from(hit.steps)).sum();
    let rung = Rung { integrator: "nystrom8", steps: resolution.least };
    let stages = [0.0, 1e3 * seconds.median, 0.0, 0.0];
    let errors = task.errors(&places(&hits));
    Measurement::new(engine, rung, seconds, stages, Some(trajectories), errors)
}

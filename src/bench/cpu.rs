//! The CPU: scalar, vectors on one thread, vectors on all.

use super::solver::{Hit, Solver};
use super::task::{Task, places};
use super::watch::watch;
use super::{Engine, Measurement, Report, Rung, Stages};
use crate::integrate::EngineError;
use crate::numerics::{MultiplyAndAdd, Unit};
use crate::shooting::Resolution;
use crate::shooting::batch::flops_of_nystrom8;
use std::convert::Infallible;
use std::time::Instant;

/// After a residual below this, in whisker lengths, one more Newton step reaches the rounding.
const TOLERANCE: f64 = 1e-7;

/// Rounds of the peak's kernel: milliseconds.
const ROUNDS: u32 = 1 << 20;

/// Adds the rows of the CPU engine to `report`.
pub fn measure(
    task: &Task,
    runs: usize,
    report: &mut Report,
    said: &mut dyn FnMut(&str),
) -> Result<(), EngineError> {
    let all = rayon::current_num_threads();
    let vectors = Unit::detect();
    let mut engines = vec![(Unit::scalar(), 1), (vectors, 1)];
    if all > 1 {
        engines.push((vectors, all));
    }
    for (unit, threads) in engines {
        let name = format!("cpu {unit}");
        said(&format!("{name}, {threads} threads"));
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| EngineError::Device(error.to_string()))?;
        let solver = |resolution| Solver {
            unit,
            resolution,
            tolerance: TOLERANCE,
        };
        let start = Instant::now();
        pool.install(|| solver(Resolution::FINE).solve(task.effects, &task.rods, &task.shots[..1]));
        let first_result_s = start.elapsed().as_secs_f64();
        let peak_gflops = pool.install(|| peak(unit, runs));
        let engine = Engine {
            name,
            threads: Some(threads),
            adapter: unit.to_string(),
            peak_gflops,
            first_result_s,
        };
        let row = |resolution| row(task, runs, &engine, solver(resolution));
        report
            .rows
            .extend(pool.install(|| Resolution::LADDER.map(row)));
        report.engines.push(engine);
    }
    Ok(())
}

/// The row of `engine`, on the threads of the current pool.
fn row(task: &Task, runs: usize, engine: &Engine, solver: Solver) -> Measurement {
    let Ok((seconds, hits)) = watch(runs, || {
        let hits = solver.solve(task.effects, &task.rods, &task.shots);
        Ok::<Vec<Hit>, Infallible>(hits)
    });
    let resolution = solver.resolution;
    let work = task.work(&hits, |condition| {
        let steps = resolution.steps(condition.rod, condition.tau, condition.load);
        flops_of_nystrom8(task.effects, steps, condition)
    });
    let rung = Rung {
        integrator: "nystrom8",
        steps: resolution.least,
    };
    let stages = Stages {
        dispatch: 1e3 * seconds.median,
        ..Stages::default()
    };
    let errors = task.errors(&places(&hits));
    Measurement::new(engine, rung, seconds, stages, Some(work), errors)
}

/// Billions of operations per second of all threads of the pool at once.
fn peak(unit: Unit, runs: usize) -> f64 {
    let work = || {
        let each = rayon::broadcast(|_| unit.run(MultiplyAndAdd { rounds: ROUNDS }));
        Ok::<u64, Infallible>(each.iter().sum())
    };
    let Ok((seconds, operations)) = watch(runs, work);
    1e-9 * operations as f64 / seconds.median
}

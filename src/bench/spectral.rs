//! Measurements of the spectral engine at several bounds: cells of expanded rows, and the one-time cost of the expansions.

use super::request::{Points, SideRequest, loads};
use super::task::Task;
use super::timing::{Timing, timed};
use super::{BenchEngine, Measurement, Report, Rung, pool};
use crate::engine::{EngineError, Spectral, WhiskerSide};
use crate::scene::Scene;
use serde::Serialize;
use std::convert::Infallible;
use std::hint::black_box;
use std::time::Instant;
use whiskmap_mechanics::numerics::Unit;

/// Name of the spectral engine in measurements and maps.
pub const SPECTRAL: &str = "spectral";

/// Maximum bounds on the residual in whisker lengths, from coarse to the smallest that refined states allow.
const BOUNDS: [f64; 5] = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11];

/// Measurement of expansions with one bound on the residual: their time on one thread, beside the time of trajectories.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Expansions {
    /// Maximum bound on the residual of a state, in whisker lengths.
    pub bound: f64,
    /// Number of loads at each contact of a net.
    pub states: usize,
    /// Part of the sample's states that are certified, from 0 to 1.
    pub certified: f64,
    /// Times to expand all whisker sides, in seconds.
    pub seconds: Timing,
    /// Time to expand one whisker side, in milliseconds, spent once for all its states.
    pub ms_per_side: f64,
    /// Time for one state with the work of its row, in microseconds.
    pub us_per_state: f64,
    /// Time for one state by trajectories, in microseconds: the cheapest that are as accurate, or the most accurate ones.
    pub us_by_trajectories: f64,
    /// Number of states of a whisker side from which on expansions are cheaper than trajectories; `None` if they never are.
    pub pays_from: Option<f64>,
}

/// Adds the rows of the spectral engine to `report`, on one thread and on all threads. The rows of trajectories must be there.
pub fn measure(
    scene: &Scene,
    task: &Task,
    runs: usize,
    report: &mut Report,
    on_step: &mut dyn FnMut(&str),
) -> Result<(), EngineError> {
    if task.effects.profile {
        let failure = "spectral: measured radii have no expansions";
        report.failures.push(failure.to_owned());
        return Ok(());
    }
    let all = rayon::current_num_threads();
    let plain = SideRequest::all(scene, task, |side| side);
    let mut engines = vec![1];
    engines.extend((all > 1).then_some(all));
    for threads in engines {
        let name = SPECTRAL.to_owned();
        on_step(&format!("{name}, {threads} threads"));
        let pool = pool(threads)?;
        let mut engine = BenchEngine {
            name,
            threads: Some(threads),
            adapter: Unit::detect().to_string(),
            first_result_s: 0.0,
        };
        let begun = Instant::now();
        let mut rows = Vec::new();
        for bound in BOUNDS {
            let Some(row) = pool.install(|| row(scene, task, runs, &engine, bound)) else {
                continue;
            };
            if rows.is_empty() {
                engine.first_result_s = begun.elapsed().as_secs_f64();
            }
            if threads == 1 {
                let seconds = pool.install(|| one_time(&plain, runs, bound));
                let expansions = expansions(&row, seconds, bound, task, report);
                report.expansions.push(expansions);
            }
            rows.push(row);
        }
        if rows.is_empty() {
            let few = "spectral: no whisker side has enough cells for expansions";
            report.failures.push(few.to_owned());
            return Ok(());
        }
        report.rows.extend(rows);
        report.engines.push(engine);
    }
    Ok(())
}

/// Measures the evaluation of expansions with this `bound` on the threads of the current pool; `None` if no state is certified.
fn row(
    scene: &Scene,
    task: &Task,
    runs: usize,
    engine: &BenchEngine,
    bound: f64,
) -> Option<Measurement> {
    let expand = |side: WhiskerSide| side.with_net(bound);
    let requests = SideRequest::all(scene, task, expand);
    let solver = Spectral::new(bound);
    let Ok((seconds, cells)) = timed(runs, || {
        let cells = requests.iter().map(|request| {
            let batch = request.batch.clone().with_nets(bound);
            solver.solve(&batch)
        });
        Ok::<_, Infallible>(cells.collect::<Vec<_>>())
    });
    let points: Points =
        requests.iter().zip(&cells).flat_map(|(request, cells)| request.solved(cells)).collect();
    if points.is_empty() {
        return None;
    }
    let (targets, points): (Vec<usize>, Vec<(f64, f64)>) = points.into_iter().unzip();
    let rung = Rung { integrator: "chebyshev", steps: loads(&requests) as u32 };
    let stages = [0.0, 1e3 * seconds.median, 0.0, 0.0];
    let errors = task.only(&targets).errors(&points);
    Some(Measurement::new(engine, rung, seconds, stages, None, errors))
}

/// Times the expansions of all whisker sides.
fn one_time(requests: &[SideRequest], runs: usize, bound: f64) -> Timing {
    let sides = || requests.iter().flat_map(|request| request.batch.sides.iter());
    let Ok((seconds, ())) = timed(runs, || {
        for side in sides() {
            black_box(side.net(bound));
        }
        Ok::<_, Infallible>(())
    });
    seconds
}

/// Compares a `row` of expansions that took these `seconds` to make with the trajectories of the report.
fn expansions(
    row: &Measurement,
    seconds: Timing,
    bound: f64,
    task: &Task,
    report: &Report,
) -> Expansions {
    let error = |row: &Measurement| row.errors.angle_deg.worst;
    let time = |row: &Measurement| row.us_per_state;
    let vectors = format!("cpu {}", Unit::detect());
    let is_by_trajectories =
        |other: &&Measurement| other.engine == vectors && other.threads == row.threads;
    let trajectories = || report.rows.iter().filter(is_by_trajectories);
    let accurate = trajectories().filter(|other| error(other) <= error(row));
    let cheapest = accurate.min_by(|a, b| time(a).total_cmp(&time(b)));
    let best = || trajectories().min_by(|a, b| error(a).total_cmp(&error(b)));
    let us_by_trajectories = cheapest.or_else(best).map_or(f64::NAN, time);
    let per_side = seconds.median / task.rods.len() as f64;
    let saved = us_by_trajectories - row.us_per_state;
    Expansions {
        bound,
        states: row.rung.steps as usize,
        certified: row.errors.states as f64 / task.targets.len() as f64,
        seconds,
        ms_per_side: 1e3 * per_side,
        us_per_state: row.us_per_state,
        us_by_trajectories,
        pays_from: (saved > 0.0).then(|| 1e6 * per_side / saved),
    }
}

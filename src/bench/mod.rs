//! Error against time for every engine of this machine, on the states of a scene, and times of whole maps.
//!
//! The CPU solves targets from the guesses of the net. The spectral engine and a GPU solve the cells whose rows have
//! expansions; nets are made beforehand. Errors are differences from much finer steps. Times are medians, without the first run, which warms up.

mod cpu;
mod detachment;
mod gpu;
mod measurement;
mod peers;
mod request;
mod solver;
mod spectral;
mod task;
mod timing;
mod trajectories;
mod verdict;
mod whole;

pub use detachment::Detachments;
pub use measurement::{Measurement, Rung, StageTimes};
pub use peers::{Peer, Peers, PeersError};
pub use solver::Solver;
pub use spectral::Expansions;
pub use task::{Errors, Spread};
pub use timing::{NOISY, Timing};
pub use trajectories::Trajectories;
pub use verdict::Verdict;
pub use whole::WholeMap;

use crate::engine::EngineError;
use crate::plan::SAMPLE_VALUES;
use crate::scene::Scene;
use serde::Serialize;
use task::Task;

/// Measured engine.
#[derive(Clone, Debug, Serialize)]
pub struct BenchEngine {
    /// Name of the engine, as in [`Measurement::engine`].
    pub name: String,
    /// Number of threads of the CPU engine; `None` for other engines.
    pub threads: Option<usize>,
    /// Hardware of the engine: processor or adapter, with driver.
    pub adapter: String,
    /// Time from the start of the engine to its first result, in seconds: opening, compiling, one cell.
    pub first_result_s: f64,
}

/// Report of all measurements of a scene.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Title of the measured scene.
    pub scene: String,
    /// Number of states of the scene that every engine solved.
    pub states: usize,
    /// Number of timed runs of each measurement.
    pub runs: usize,
    /// Engines that were measured, `[engine]`.
    pub engines: Vec<BenchEngine>,
    /// Measurements of the report, engine by engine, `[measurement]`.
    pub rows: Vec<Measurement>,
    /// Expansions of the spectral engine, from coarse to fine bounds: `[bound]`.
    pub expansions: Vec<Expansions>,
    /// Plain trajectories by the CPU, then by each GPU: `[engine]`.
    pub trajectories: Vec<Trajectories>,
    /// Measurements of detachment curves, from coarse to fine steps: `[rung]`.
    pub detachments: Vec<Detachments>,
    /// Number of cells of each whole map.
    pub map_cells: usize,
    /// Whole maps on all threads, `[engine]`: of the CPU engine, of the spectral engine, then of each GPU engine.
    pub maps: Vec<WholeMap>,
    /// Comparisons of engines, `[pair]`: the fastest two on the CPU, then each GPU engine with the fastest engine on the CPU.
    pub verdicts: Vec<Verdict>,
    /// Names of engines that could not be measured, each with the reason: `[engine]`.
    pub failures: Vec<String>,
}

/// Effort of a measurement: size of the sample, and number of runs.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Maximum number of push angles, and maximum number of distances, of the sample of cells: `[push angles, distances]`. Engines share
    /// work along a row, so rows are as long as in maps.
    pub sample: [usize; 2],
    /// Maximum number of push angles, and of distances, of whole maps.
    pub map_lines: usize,
    /// Number of timed runs of each measurement.
    pub runs: usize,
}

impl Effort {
    /// Effort of measurements whose numbers are quoted.
    pub const FULL: Self = Self { sample: [512, 128], map_lines: 1024, runs: 7 };

    /// Effort of quick measurements.
    pub const QUICK: Self = Self { sample: [256, 64], map_lines: 256, runs: 5 };
}

/// Measures every engine on a sample of `scene`, and calls `on_step` with the name of each next step. `None` if no cell of the sample has a
/// state.
///
/// # Errors
/// If threads cannot be started.
pub fn run(
    scene: &Scene,
    effort: Effort,
    on_step: &mut dyn FnMut(&str),
) -> Result<Option<Report>, EngineError> {
    let of_maps = scene.thinned(effort.map_lines, SAMPLE_VALUES);
    let scene = scene.thinned_to(effort.sample, SAMPLE_VALUES);
    on_step("the exact states");
    let task = Task::new(&scene);
    if task.targets.is_empty() {
        return Ok(None);
    }
    let mut report = Report {
        scene: scene.title.clone(),
        states: task.targets.len(),
        runs: effort.runs,
        ..Report::default()
    };
    cpu::measure(&task, effort.runs, &mut report, on_step)?;
    spectral::measure(&scene, &task, effort.runs, &mut report, on_step)?;
    gpu::measure(&scene, &task, effort.runs, &mut report, on_step);
    trajectories::measure(&task, effort.runs, &mut report, on_step);
    on_step("detachments");
    report.detachments = detachment::measure(&scene, effort.runs);
    mark_pareto(&mut report.rows);
    whole::measure(&of_maps, effort.runs, &mut report, on_step)?;
    report.verdicts = Verdict::all(&report.maps);
    Ok(Some(report))
}

/// Returns the name of an engine in tables, with its number of threads if it has one.
#[must_use]
pub fn named(engine: &str, threads: Option<usize>) -> String {
    match threads {
        Some(threads) => format!("{engine} x {threads}"),
        None => engine.to_owned(),
    }
}

/// Starts `threads` threads.
fn pool(threads: usize) -> Result<rayon::ThreadPool, EngineError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| EngineError::Device(error.to_string()))
}

/// Marks the rows that no other row beats in both time and worst push-angle error.
fn mark_pareto(rows: &mut [Measurement]) {
    let place = |row: &Measurement| [row.us_per_state, row.errors.angle_deg.worst];
    let places: Vec<[f64; 2]> = rows.iter().map(place).collect();
    for (row, here) in rows.iter_mut().zip(&places) {
        let beats = |other: &[f64; 2]| other[0] <= here[0] && other[1] <= here[1] && other != here;
        row.pareto = !places.iter().any(beats);
    }
}

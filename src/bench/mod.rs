//! Error against time for every engine of this machine, on the states of a scene; times of whole maps, measured here and computed for
//! other machines.
//!
//! The CPU solves targets from the guesses of the lattice. A GPU solves those of the same cells whose rows have base points, and the spectral
//! engine those whose rows have expansions, both of which are found beforehand. Errors are differences from much finer steps. Times are medians, without the first run, which warms up.

mod cell_work;
mod cpu;
mod detachment;
mod gpu;
mod machine;
mod model;
mod peak;
mod peers;
mod request;
mod solver;
mod spectral;
mod task;
mod timing;
mod verdict;
mod whole;

pub use cell_work::{CellWork, SolvedOn};
pub use detachment::Detachments;
pub use machine::{MACHINES, Machine};
pub use model::{CELLS, ComputedMap, MapParts};
pub use peers::{Peer, Peers, PeersError};
pub use solver::Solver;
pub use spectral::Expansions;
pub use task::{Errors, Spread};
pub use timing::{NOISY, Timing};
pub use verdict::Verdict;
pub use whole::WholeMap;

use crate::engine::EngineError;
use crate::plan::SAMPLE_VALUES;
use crate::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use task::{Task, Work};
use timing::median;

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
    /// Wall milliseconds of the engine's stages, medians of the runs; 0 where the engine has no such stage. `upload`: trajectories of
    /// base points, packing and submitting; `dispatch`: solving, by the device's clock on a GPU that has one; `waiting`: for the device;
    /// `readback`: unpacking.
    pub stages_ms: StageTimes,
    /// Time for one state, in microseconds.
    pub us_per_state: f64,
    /// Rate of the engine in states per second.
    pub states_per_s: f64,
    /// Rate of the engine in trajectories per second.
    pub trajectories_per_s: f64,
    /// Rate of the integration in billions of floating-point operations per second, counted on the CPU only; `None` for other engines.
    pub gflops: Option<f64>,
    /// Rate of floating-point operations over the engine's peak rate, dimensionless; `None` if it is not counted.
    pub of_peak: Option<f64>,
    /// Errors of the states that the engine found.
    pub errors: Errors,
    /// True if no other measurement is both faster and more accurate.
    pub pareto: bool,
}

impl Measurement {
    fn new(
        engine: &BenchEngine,
        rung: Rung,
        seconds: Timing,
        stages_ms: [f64; 4],
        work: Option<Work>,
        errors: Errors,
    ) -> Self {
        let states = errors.states as f64;
        let trajectories = work.as_ref().map_or(states, |work| work.trajectories);
        let gflops = work.map(|work| 1e-9 * work.operations / seconds.median);
        Self {
            engine: engine.name.clone(),
            threads: engine.threads,
            rung,
            seconds,
            stages_ms: STAGES
                .map(str::to_owned)
                .into_iter()
                .zip(stages_ms)
                .collect(),
            us_per_state: 1e6 * seconds.median / states,
            states_per_s: states / seconds.median,
            trajectories_per_s: trajectories / seconds.median,
            gflops,
            of_peak: None,
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
    /// Steps of a trajectory at the fold of a cylinder, fewer under less load; of expansions, states along a row.
    pub steps: u32,
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x{}", self.integrator, self.steps)
    }
}

/// Returns the median of each stage in several runs.
fn medians(runs: &[StageTimes]) -> StageTimes {
    let stages = runs.first().into_iter().flat_map(BTreeMap::keys);
    let of_runs = |stage: &String| median(runs.iter().map(|run| run[stage]));
    stages
        .map(|stage| (stage.clone(), of_runs(stage)))
        .collect()
}

/// Measured engine and its peak rate.
#[derive(Clone, Debug, Serialize)]
pub struct BenchEngine {
    /// Name of the engine, as in [`Measurement::engine`].
    pub name: String,
    /// Number of threads of the CPU engine; `None` for other engines.
    pub threads: Option<usize>,
    /// Hardware of the engine: processor or adapter, with driver.
    pub adapter: String,
    /// Peak rate of the engine in billions of multiplications and additions per second: the largest one measured.
    pub peak_gflops: f64,
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
    /// Measurements of detachment curves, from coarse to fine steps: `[rung]`.
    pub detachments: Vec<Detachments>,
    /// Number of cells of each whole map.
    pub map_cells: usize,
    /// Whole maps on all threads, `[engine]`: of the CPU engine, of the spectral engine, then of each GPU engine.
    pub maps: Vec<WholeMap>,
    /// Comparisons of engines, `[pair]`: the fastest two on the CPU, then each GPU engine with the fastest engine on the CPU.
    pub verdicts: Vec<Verdict>,
    /// Large maps on other machines, computed and not measured: `[map]`.
    pub computed: Vec<ComputedMap>,
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
    pub const FULL: Self = Self {
        sample: [512, 128],
        map_lines: 1024,
        runs: 7,
    };

    /// Effort of quick measurements.
    pub const QUICK: Self = Self {
        sample: [256, 64],
        map_lines: 256,
        runs: 5,
    };
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
    on_step("detachments");
    report.detachments = detachment::measure(&scene, effort.runs);
    mark_pareto(&mut report.rows);
    whole::measure(&of_maps, effort.runs, &mut report, on_step)?;
    report.verdicts = Verdict::all(&report.maps);
    let cells =
        scene.grid.push_angle_deg.len() * scene.grid.distance_mm.len() * scene.whisker_count();
    let states = task.targets.len() as f64 / cells as f64;
    report.computed = model::computed(&task, states, rayon::current_num_threads(), &report);
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

//! What accuracy costs in time: every engine of this machine, from coarse to exact, on the states of a scene; and what whole maps take.
//!
//! The CPU is given shots, which start from the guesses of the lattice, a GPU those of the same cells whose rows have references, which
//! are found before. Errors are those of the engine's
//! answers as far finer steps see them; times are medians, without the first run, which warms up.

mod cpu;
mod detachment;
mod gpu;
mod pareto;
mod peak;
mod solver;
mod task;
mod watch;
mod whole;

pub use detachment::Detachments;
pub use solver::Solver;
pub use task::{Errors, Spread};
pub use watch::{NOISY, Timing};
pub use whole::{MapStages, Verdict, WholeMap};

use crate::engine::EngineError;
use crate::plan::SAMPLE_VALUES;
use crate::scene::Scene;
use serde::Serialize;
use std::fmt;
use task::{Task, Work};

/// One engine at one accuracy.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// Which engine.
    pub engine: String,
    /// Threads of the CPU engine.
    pub threads: Option<usize>,
    /// How accurate it was asked to be.
    pub rung: Rung,
    /// Seconds for all states.
    pub seconds: Timing,
    /// Milliseconds of the stages.
    pub stages_ms: Stages,
    /// Microseconds per state.
    pub us_per_state: f64,
    /// States per second.
    pub states_per_s: f64,
    /// Trajectories per second.
    pub trajectories_per_s: f64,
    /// Billions of floating-point operations per second in the integration, where they are counted: on the CPU.
    pub gflops: Option<f64>,
    /// Floating-point rate as a part of the engine's peak.
    pub of_peak: Option<f64>,
    /// How far off the answers are.
    pub errors: Errors,
    /// Whether no other row is both faster and closer.
    pub pareto: bool,
}

impl Measurement {
    fn new(
        engine: &Engine,
        rung: Rung,
        seconds: Timing,
        stages_ms: Stages,
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
            stages_ms,
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

/// How accurate a row was asked to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rung {
    /// The integrator of the engine.
    pub integrator: &'static str,
    /// Its steps at the fold of a cylinder, fewer under less load.
    pub steps: u32,
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x{}", self.integrator, self.steps)
    }
}

/// Milliseconds per stage, medians of the runs; 0 where an engine has no such stage.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Stages {
    /// Trajectories of references, packing and handing to the device.
    pub upload: f64,
    /// Solving: by the device's own clock on a GPU that has one.
    pub dispatch: f64,
    /// Waiting for the device.
    pub waiting: f64,
    /// Unpacking.
    pub readback: f64,
}

impl Stages {
    /// The medians of the stages in several runs.
    fn medians(runs: &[Self]) -> Self {
        let median = |stage: fn(&Self) -> f64| watch::median(runs.iter().map(stage));
        Self {
            upload: median(|run| run.upload),
            dispatch: median(|run| run.dispatch),
            waiting: median(|run| run.waiting),
            readback: median(|run| run.readback),
        }
    }
}

/// An engine by itself.
#[derive(Clone, Debug, Serialize)]
pub struct Engine {
    /// Its name in the rows.
    pub name: String,
    /// Threads of the CPU engine.
    pub threads: Option<usize>,
    /// Processor or adapter, with driver.
    pub adapter: String,
    /// Billions of multiplications and additions per second: the most that was measured.
    pub peak_gflops: f64,
    /// Seconds from nothing to the first answer: opening, compiling, one shot.
    pub first_result_s: f64,
}

/// Everything that was measured.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Title of the scene.
    pub scene: String,
    /// States that every engine solved.
    pub states: usize,
    /// Timed runs of each row.
    pub runs: usize,
    /// The engines.
    pub engines: Vec<Engine>,
    /// The rows, engine by engine.
    pub rows: Vec<Measurement>,
    /// The curve of detachment, from coarse to exact.
    pub detachments: Vec<Detachments>,
    /// Cells of each whole map.
    pub map_cells: usize,
    /// Whole maps: that of the CPU engine on all threads, then one of each GPU engine.
    pub maps: Vec<WholeMap>,
    /// Which of them is done first, where there is a GPU engine.
    pub verdict: Option<Verdict>,
    /// Engines that could not be measured, and why.
    pub failures: Vec<String>,
}

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Push angles, and distances, of the sample.
    pub lines: usize,
    /// Push angles, and distances, of whole maps at most.
    pub map_lines: usize,
    /// Timed runs of each row.
    pub runs: usize,
}

impl Effort {
    /// For numbers to be quoted.
    pub const FULL: Self = Self {
        lines: 128,
        map_lines: 1024,
        runs: 7,
    };

    /// For a first look.
    pub const QUICK: Self = Self {
        lines: 48,
        map_lines: 256,
        runs: 5,
    };
}

/// Measures every engine on a sample of `scene`; `said` is told what comes next. `None` if no cell of the sample has a state.
///
/// # Errors
/// When not even the CPU's threads can be had.
pub fn run(
    scene: &Scene,
    effort: Effort,
    said: &mut dyn FnMut(&str),
) -> Result<Option<Report>, EngineError> {
    let of_maps = scene.thinned(effort.map_lines, SAMPLE_VALUES);
    let scene = scene.thinned(effort.lines, SAMPLE_VALUES);
    said("the exact answers");
    let task = Task::new(&scene);
    if task.shots.is_empty() {
        return Ok(None);
    }
    let mut report = Report {
        scene: scene.title.clone(),
        states: task.shots.len(),
        runs: effort.runs,
        ..Report::default()
    };
    cpu::measure(&task, effort.runs, &mut report, said)?;
    gpu::measure(&scene, &task, effort.runs, &mut report, said);
    said("detachments");
    report.detachments = detachment::measure(&scene, effort.runs);
    pareto::mark(&mut report.rows);
    whole::measure(&of_maps, effort.runs, &mut report, said)?;
    Ok(Some(report))
}

/// An engine with its threads.
#[must_use]
pub fn named(engine: &str, threads: Option<usize>) -> String {
    match threads {
        Some(threads) => format!("{engine} x {threads}"),
        None => engine.to_owned(),
    }
}

/// So many threads.
fn pool(threads: usize) -> Result<rayon::ThreadPool, EngineError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| EngineError::Device(error.to_string()))
}

//! Plain trajectories, thousands at once: the CPU against every GPU.

use super::gpu::candidates;
use super::task::Task;
use super::timing::{Timing, timed};
use super::{Report, named};
use crate::engine::gpu::{Gpu, shoots};
use crate::engine::{Engine as _, EngineError};
use crate::sheet::net::larger;
use serde::Serialize;
use std::convert::Infallible;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::shooting::PlainState;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};

/// Smallest number of trajectories of a run: enough to fill every lane of a device.
const AT_LEAST: usize = 1 << 17;

/// Measurement of trajectories from the contacts and loads of the sample's states, without derivatives, at the resolution of maps.
#[derive(Clone, Debug, Serialize)]
pub struct Trajectories {
    /// Name of the engine that integrates, with its threads unless it is a GPU.
    pub engine: String,
    /// Adapter of a GPU, with its driver; `None` for the CPU.
    pub adapter: Option<String>,
    /// Number of trajectories of a run.
    pub count: usize,
    /// Times of a run, with the transfers of a GPU, in seconds.
    pub seconds: Timing,
    /// Rate in trajectories per second.
    pub per_s: f64,
    /// Largest distance of the pole from the pole that the CPU finds, in whisker lengths.
    pub apart: f64,
}

/// Adds the trajectories of the CPU on all threads, and of every GPU, to `report`.
pub fn measure(task: &Task, runs: usize, report: &mut Report, on_step: &mut dyn FnMut(&str)) {
    let method = Method::fine().with_effects(task.effects);
    let exact = task.exact_conditions();
    let conditions = exact.iter().cycle().take(AT_LEAST.max(exact.len()));
    let conditions: Vec<InitialCondition> = conditions.copied().collect();
    let cpu = named(&format!("cpu {}", Unit::detect()), Some(rayon::current_num_threads()));
    on_step(&format!("trajectories by {cpu}"));
    let Ok((seconds, wanted)) =
        timed(runs, || Ok::<_, Infallible>(Batch::new(method).shoot::<PlainState>(&conditions)));
    let row = |engine: &str, adapter, seconds: Timing, apart| Trajectories {
        engine: engine.to_owned(),
        adapter,
        count: conditions.len(),
        per_s: conditions.len() as f64 / seconds.median,
        seconds,
        apart,
    };
    report.trajectories.push(row(&cpu, None, seconds, 0.0));
    if let Err(why) = shoots(task.effects) {
        report.failures.push(format!("GPU: {why}"));
        return;
    }
    for one in candidates() {
        on_step(&format!("trajectories by {}", one.name));
        let measured = Gpu::open(Some(one.adapter), one.precision).and_then(|mut gpu| {
            let (seconds, found) = timed(runs, || gpu.shoot(method, &conditions))?;
            let pairs = found.iter().zip(&wanted);
            let distances = pairs.map(|(state, wanted)| state.pole.distance(wanted.pole));
            let apart = distances.fold(0.0, larger);
            Ok::<_, EngineError>(row(&one.name, Some(gpu.describe().adapter), seconds, apart))
        });
        match measured {
            Ok(row) => report.trajectories.push(row),
            Err(why) => report.failures.push(format!("trajectories by {}: {why}", one.name)),
        }
    }
}

//! Measurements of whole maps by engine and stage.

use super::gpu::{Candidate, candidates};
use super::measurement::medians;
use super::spectral::SPECTRAL;
use super::timing::Timing;
use super::{Report, StageTimes, named, pool};
use crate::engine::gpu::Gpu;
use crate::engine::{Engine, EngineError, Spectral, on_gpu};
use crate::map::{self, Stage};
use crate::plan::Plan;
use crate::quantile::median;
use crate::scene::Scene;
use crate::store::MapWriter;
use serde::Serialize;
use whiskmap_mechanics::numerics::Unit;

/// Measurement of a whole map by one engine, packed but not written.
#[derive(Clone, Debug, Serialize)]
pub struct WholeMap {
    /// Name of the engine, with its threads unless it is a GPU.
    pub engine: String,
    /// Adapter of a GPU engine, with its driver; `None` for engines on the CPU.
    pub adapter: Option<String>,
    /// Times from the plan to the last panel packed, in seconds.
    pub seconds: Timing,
    /// Wall milliseconds of the map by stage, medians of the runs: `sheets`, `rows`, `cells`, `guesses`, `refinement` and
    /// `classification` in sequence. Beside them are `packing`, `device` (the busy engine) and `waiting` for it.
    pub stages_ms: StageTimes,
    /// CPU time of the process for one cell, in microseconds; 0 where the system has no such clock. A software adapter's threads are
    /// included.
    pub host_us_per_cell: f64,
    /// CPU seconds of the host's own stages over the CPU seconds with the CPU engine: one thread, from the sheets to the classification, without
    /// packing and without the engine; 0 where the system has no such clock.
    pub host_share: f64,
    /// Stage times of cells, guesses and refinement over the sum of all stage times, from 0 to 1: the part that an engine can take over.
    pub device_can_take: f64,
    /// Number of cells of the map that fell back to the CPU.
    pub fallback: u64,
    /// Bytes of a packed cell, with all channels.
    pub packed_bytes_per_cell: f64,
}

/// Times of one run: wall and CPU seconds, and milliseconds by stage.
struct MapRun {
    seconds: f64,
    host: f64,
    /// CPU seconds of the host's own stages on one thread.
    on_one_thread: f64,
    stages_ms: StageTimes,
    fallback: u64,
    packed_bytes: u64,
}

/// Name of an engine, the engine itself (`None` for the CPU engine), and its runs.
type MeasuredEngine = (String, Option<Box<dyn Engine>>, Vec<MapRun>);

/// Adds maps of `scene` by every engine of the report, on all threads. The engines take turns, so that a busy machine is one for all.
pub fn measure(
    scene: &Scene,
    runs: usize,
    report: &mut Report,
    on_step: &mut dyn FnMut(&str),
) -> Result<(), EngineError> {
    let plan = match Plan::new(scene) {
        Ok(plan) => plan,
        Err(error) => {
            report.failures.push(format!("whole maps: {error}"));
            return Ok(());
        }
    };
    let threads = rayon::current_num_threads();
    let (one, pool) = (pool(1)?, pool(threads)?);
    report.map_cells = plan.cells;
    let cpu = named(&format!("cpu {}", Unit::detect()), Some(threads));
    let mut engines: Vec<MeasuredEngine> = vec![(cpu, None, Vec::new())];
    if !plan.method.effects.profile {
        let spectral = named(SPECTRAL, Some(threads));
        engines.push((spectral, Some(Box::new(Spectral::default())), Vec::new()));
    }
    if on_gpu(plan.method.effects).is_ok() {
        let measured =
            |one: &Candidate| report.engines.iter().any(|engine| engine.name == one.name);
        for one in candidates().into_iter().filter(measured) {
            match Gpu::open(Some(one.adapter), one.precision) {
                Ok(gpu) => engines.push((one.name, Some(Box::new(gpu)), Vec::new())),
                Err(why) => report.failures.push(format!("map by {}: {why}", one.name)),
            }
        }
    }
    // The first round warms up.
    for round in 0..=runs {
        let mut working = Vec::new();
        for (name, mut engine, mut samples) in engines {
            on_step(&format!("map {round} of {runs} by {name}"));
            let sample = pool.install(|| run(scene, &plan, &mut engine));
            let sample = sample.and_then(|sample| {
                let on_one_thread =
                    one.install(|| one_thread_seconds(scene, &plan, &mut engine))?;
                Ok(MapRun { on_one_thread, ..sample })
            });
            match sample {
                Ok(sample) => {
                    samples.extend((round > 0).then_some(sample));
                    working.push((name, engine, samples));
                }
                Err(why) => report.failures.push(format!("map by {name}: {why}")),
            }
        }
        engines = working;
    }
    let maps = engines.into_iter();
    let adapter = |name: &str| {
        let mut engines = report.engines.iter();
        let engine = engines.find(|engine| engine.name == name && engine.threads.is_none());
        engine.map(|engine| engine.adapter.clone())
    };
    let maps = maps.map(|(name, _, samples)| WholeMap {
        adapter: adapter(&name),
        ..summed_up(name, plan.cells, &samples)
    });
    report.maps = maps.collect();
    if let Some(cpu) = report.maps.first().map(|cpu| cpu.host_share) {
        for map in &mut report.maps {
            map.host_share = if cpu > 0.0 { map.host_share / cpu } else { 0.0 };
        }
    }
    Ok(())
}

/// CPU seconds of this thread, the only one of its pool, for one map that is not packed.
fn one_thread_seconds(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
) -> Result<f64, EngineError> {
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let begun = map::thread_seconds();
    let summary = map::run_to_end(scene, plan, engine, |_| ());
    let ended = map::thread_seconds();
    let seconds = ended.zip(begun).map_or(0.0, |(ended, begun)| ended - begun);
    summary.engine_failure.map_or(Ok(seconds), Err)
}

/// Computes one map.
fn run(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
) -> Result<MapRun, EngineError> {
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let mut packed_bytes = 0;
    let summary = map::run_to_end(scene, plan, engine, |panels| {
        packed_bytes += MapWriter::sample(&scene.grid, plan, panels);
    });
    if let Some(failure) = summary.engine_failure {
        return Err(failure);
    }
    let stages = Stage::ALL.map(|(stage, name)| (name, summary.stage_seconds(stage)));
    let engine = [("device", summary.device_seconds), ("waiting", summary.waiting_seconds)];
    let stages = stages.into_iter().chain(engine);
    Ok(MapRun {
        seconds: summary.wall_seconds,
        host: summary.cpu_seconds.unwrap_or_default(),
        on_one_thread: 0.0,
        stages_ms: stages.map(|(name, s)| (name.to_owned(), 1e3 * s)).collect(),
        fallback: summary.engine_cells.fallback(),
        packed_bytes,
    })
}

fn summed_up(engine: String, cells: usize, samples: &[MapRun]) -> WholeMap {
    let stages_ms: Vec<StageTimes> = samples.iter().map(|run| run.stages_ms.clone()).collect();
    let stages_ms = medians(&stages_ms);
    let sum = |names: &[&str]| names.iter().filter_map(|name| stages_ms.get(*name)).sum();
    let for_devices: f64 = sum(&["cells", "guesses", "refinement"]);
    let for_cpus: f64 = sum(&["sheets", "rows", "classification", "packing"]);
    WholeMap {
        engine,
        adapter: None,
        seconds: Timing::of(samples.iter().map(|run| run.seconds)),
        host_us_per_cell: 1e6 * median(samples.iter().map(|run| run.host)) / cells as f64,
        host_share: median(samples.iter().map(|run| run.on_one_thread)),
        device_can_take: for_devices / (for_devices + for_cpus),
        fallback: samples.last().map_or(0, |run| run.fallback),
        packed_bytes_per_cell: samples
            .last()
            .map_or(0.0, |run| run.packed_bytes as f64 / cells as f64),
        stages_ms,
    }
}

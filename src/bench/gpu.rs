//! Measurements of every GPU adapter, in `f32` and, if supported, in `f64`.

use super::request::{Points, SideRequest, loads};
use super::task::Task;
use super::timing::timed;
use super::{BenchEngine, Measurement, Report, Rung};
use crate::engine::gpu::{Gpu, Precision, adapters};
use crate::engine::{Cells, Engine as _, EngineError, RowBatch, on_gpu};
use crate::quantile::median;
use crate::scene::Scene;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A GPU engine that can be measured.
pub struct Candidate {
    /// Name of the GPU engine in the measurements.
    pub name: String,
    /// Index of the GPU engine's adapter among the [`adapters`].
    pub adapter: usize,
    pub precision: Precision,
}

/// Returns the GPU engines to measure, `[engine]`: every adapter in `f32` and, if supported, in `f64`.
pub fn candidates() -> Vec<Candidate> {
    let all = adapters();
    let mut candidates = Vec::new();
    for (adapter, report) in all.iter().enumerate() {
        let f64 = report.shader_f64.then_some(Precision::F64);
        for precision in std::iter::once(Precision::F32).chain(f64) {
            let name = match all.len() {
                1 => format!("gpu {precision}"),
                _ => format!("gpu {adapter} {precision}"),
            };
            candidates.push(Candidate { name, adapter, precision });
        }
    }
    candidates
}

/// Adds the measurements of every adapter to `report`; one that fails is named with its reason.
pub fn measure(
    scene: &Scene,
    task: &Task,
    runs: usize,
    report: &mut Report,
    on_step: &mut dyn FnMut(&str),
) {
    if let Err(why) = on_gpu(task.effects) {
        report.failures.push(format!("GPU: {why}"));
        return;
    }
    let all = adapters();
    let without = all.iter().filter(|adapter| !adapter.shader_f64);
    let without = without.map(|adapter| format!("{}: no f64 in shaders", adapter.info.name));
    report.failures.extend(without);
    for one in candidates() {
        let adapter = &all[one.adapter].info.name;
        on_step(&format!("gpu {}, {adapter}", one.precision));
        if let Err(why) = measure_one(scene, task, runs, report, &one) {
            let failure = format!("{adapter}, {}: {why}", one.precision);
            report.failures.push(failure);
        }
    }
}

/// Solves `batch`, the cells of a request without the expansions of their rows. Returns the cells and the milliseconds of the stages.
fn solve(gpu: &mut Gpu, batch: &RowBatch) -> Result<(Cells, [f64; 4]), EngineError> {
    let begun = Instant::now();
    let batch = batch.clone().with_nets(gpu.row_residual());
    let rows = begun.elapsed();
    gpu.submit(Arc::new(batch))?;
    let cells = gpu.collect()?;
    let times = std::mem::take(&mut gpu.times);
    let upload = rows + times.upload;
    let stages = [upload, times.dispatch, times.waiting, times.readback];
    let ms = |duration: Duration| 1e3 * duration.as_secs_f64();
    Ok((cells, stages.map(ms)))
}

fn measure_one(
    scene: &Scene,
    task: &Task,
    runs: usize,
    report: &mut Report,
    one: &Candidate,
) -> Result<(), EngineError> {
    let start = Instant::now();
    let mut gpu = Gpu::open(Some(one.adapter), one.precision)?;
    gpu.is_timed = true;
    let requests = SideRequest::all(scene, task, |side| side.with_net(gpu.row_residual()));
    let mut first_result_s = None;
    let mut of_runs: [Vec<f64>; 4] = Default::default();
    let mut run = || {
        let (mut points, mut stages) = (Points::new(), [0.0; 4]);
        for request in &requests {
            let (cells, ms) = solve(&mut gpu, &request.batch)?;
            points.extend(request.solved(&cells));
            stages = std::array::from_fn(|i| stages[i] + ms[i]);
        }
        first_result_s.get_or_insert(start.elapsed().as_secs_f64());
        for (all, ms) in of_runs.iter_mut().zip(stages) {
            all.push(ms);
        }
        Ok::<_, EngineError>(points)
    };
    run()?;
    let (seconds, points) = timed(runs, run)?;
    let (targets, points): (Vec<usize>, Vec<(f64, f64)>) = points.into_iter().unzip();
    let engine = BenchEngine {
        name: one.name.clone(),
        threads: None,
        adapter: gpu.describe().adapter,
        first_result_s: first_result_s.unwrap_or_default(),
    };
    if points.is_empty() {
        let failure = format!("{}: no state of a row of a net", engine.name);
        report.failures.push(failure);
        return Ok(());
    }
    // The first two runs warm up.
    let stages = of_runs.map(|ms| median(ms.into_iter().skip(2)));
    let rung = Rung { integrator: "chebyshev", steps: loads(&requests) as u32 };
    let errors = task.only(&targets).errors(&points);
    let row = Measurement::new(&engine, rung, seconds, stages, None, errors);
    report.engines.push(engine);
    report.rows.push(row);
    Ok(())
}

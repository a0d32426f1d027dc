//! Every GPU adapter, in `f32` and, where it can, in `f64`: the cells of the scene as differences from references of their rows.

use super::task::{Task, faces};
use super::watch::watch;
use super::{Engine, Measurement, Report, Rung, Stages};
use crate::engine::gpu::{Gpu, Precision, adapters};
use crate::engine::{
    Engine as _, EngineError, Outcome, RowBatch, SideColumns, WhiskerSide, on_gpu,
};
use crate::scene::Scene;
use crate::sheet::Sheet;
use crate::shooting::batch::Method;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A GPU engine that may be measured.
pub struct Candidate {
    /// In the rows.
    pub name: String,
    /// Index among the [`adapters`].
    pub adapter: usize,
    pub precision: Precision,
}

/// Every adapter in `f32` and, where it can, in `f64`.
pub fn candidates() -> impl Iterator<Item = Candidate> {
    let all = adapters();
    let is_alone = all.len() == 1;
    all.into_iter()
        .enumerate()
        .flat_map(move |(adapter, report)| {
            let precisions = [Precision::F32, Precision::F64].into_iter();
            let has =
                move |precision: &Precision| *precision == Precision::F32 || report.shader_f64;
            precisions.filter(has).map(move |precision| Candidate {
                name: match is_alone {
                    true => format!("gpu {precision}"),
                    false => format!("gpu {adapter} {precision}"),
                },
                adapter,
                precision,
            })
        })
}

/// Adds the rows of every adapter to `report`; one that fails is named with its reason.
pub fn measure(
    scene: &Scene,
    task: &Task,
    runs: usize,
    report: &mut Report,
    said: &mut dyn FnMut(&str),
) {
    if let Err(why) = on_gpu(task.effects) {
        report.failures.push(format!("GPU: {why}"));
        return;
    }
    let sides = Sides::of(scene, task);
    let all = adapters();
    let without = all.iter().filter(|adapter| !adapter.shader_f64);
    let without = without.map(|adapter| format!("{}: no f64 in shaders", adapter.info.name));
    report.failures.extend(without);
    for one in candidates() {
        let adapter = &all[one.adapter].info.name;
        said(&format!("gpu {}, {adapter}", one.precision));
        if let Err(why) = engine(&sides, task, runs, report, &one) {
            let failure = format!("{adapter}, {}: {why}", one.precision);
            report.failures.push(failure);
        }
    }
}

/// The requests to the engines.
struct Sides {
    method: Method,
    all: Vec<Side>,
}

/// A shot of the task, and `(tau, load)` of its state.
type Point = (usize, (f64, f64));

/// A whisker on one side.
struct Side {
    batch: RowBatch,
    /// The shot in the task of each cell, if it has one.
    shots: Vec<Option<usize>>,
}

impl Sides {
    fn of(scene: &Scene, task: &Task) -> Self {
        let method = Method::fine().with_effects(task.effects);
        let push_angle_deg = &scene.grid.push_angle_deg;
        let all = faces(scene).into_iter().zip(&task.rods).enumerate();
        let all = all.map(|(index, ((own, side), rod))| {
            let distances = scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / own.whisker.length_mm).collect();
            let sheet = Sheet::new(method, rod, side, &distances);
            let columns = SideColumns::new(push_angle_deg, side, 0);
            let pushes: Vec<f64> = columns.columns.iter().map(|own| own.push).collect();
            let poles = sheet
                .rows
                .iter()
                .flat_map(|row| pushes.iter().map(|push| row.pole(*push)));
            let shots = poles.map(|pole| task.shot(index as u32, pole)).collect();
            let rows = (0..distances.len()).map(|row| (0, row));
            let side = WhiskerSide::new(Arc::new(columns), own.whisker.units(), sheet);
            let mut batch = RowBatch::new(method, [side].into(), pushes.into(), rows);
            (batch.has_values, batch.has_points) = (true, true);
            Side { batch, shots }
        });
        Self {
            method,
            all: all.collect(),
        }
    }

    /// Adds base points for `gpu`.
    fn with_base_points(&self, gpu: &Gpu) -> Vec<RowBatch> {
        let resolution = gpu.resolution(self.method.resolution);
        let batches = self.all.iter().map(|side| side.batch.clone());
        batches
            .map(|batch| batch.with_base_points(resolution))
            .collect()
    }

    /// The states that `gpu` solves, and the times of its stages.
    fn solve(
        &self,
        gpu: &mut Gpu,
        batches: &[RowBatch],
    ) -> Result<(Vec<Point>, Stages), EngineError> {
        let (mut points, mut stages) = (Vec::new(), Stages::default());
        for (side, batch) in self.all.iter().zip(batches) {
            let begun = Instant::now();
            let mut batch = batch.clone();
            let base_points = std::mem::take(&mut batch.base_points);
            batch.set_base_points(base_points, gpu.resolution(self.method.resolution));
            let trajectories = begun.elapsed();
            gpu.submit(Arc::new(batch))?;
            let cells = gpu.collect()?;
            let times = std::mem::take(&mut gpu.times);
            let ms = |duration: Duration| 1e3 * duration.as_secs_f64();
            stages.upload += ms(trajectories + times.upload);
            stages.dispatch += ms(times.dispatch);
            stages.waiting += ms(times.waiting);
            stages.readback += ms(times.readback);
            let found = cells.outcome.iter().zip(&cells.points).zip(&side.shots);
            points.extend(found.filter_map(|((outcome, point), shot)| {
                let shot = shot.filter(|_| *outcome == Outcome::Solved)?;
                Some((shot, (point.x, point.y)))
            }));
        }
        Ok((points, stages))
    }
}

fn engine(
    sides: &Sides,
    task: &Task,
    runs: usize,
    report: &mut Report,
    one: &Candidate,
) -> Result<(), EngineError> {
    let start = Instant::now();
    let mut gpu = Gpu::open(Some(one.adapter), one.precision)?;
    gpu.is_timed = true;
    let batches = sides.with_base_points(&gpu);
    sides.solve(&mut gpu, &batches)?;
    let first_result_s = start.elapsed().as_secs_f64();
    let engine = Engine {
        name: one.name.clone(),
        threads: None,
        adapter: gpu.describe().adapter,
        peak_gflops: 1e-9 * gpu.peak(runs)?,
        first_result_s,
    };
    let mut stages = Vec::new();
    let (seconds, points) = watch(runs, || {
        let (points, of_run) = sides.solve(&mut gpu, &batches)?;
        stages.push(of_run);
        Ok::<_, EngineError>(points)
    })?;
    // The first run warms up.
    let stages = Stages::medians(&stages[1..]);
    let rung = Rung {
        integrator: "differences",
        steps: one.precision.resolution(sides.method.resolution).least,
    };
    let (shots, points): (Vec<usize>, Vec<(f64, f64)>) = points.into_iter().unzip();
    if points.is_empty() {
        let failure = format!("{}: no state beside a base point", engine.name);
        report.failures.push(failure);
        return Ok(());
    }
    report.engines.push(engine.clone());
    let errors = task.only(&shots).errors(&points);
    let row = Measurement::new(&engine, rung, seconds, stages, None, errors);
    report.rows.push(row);
    Ok(())
}

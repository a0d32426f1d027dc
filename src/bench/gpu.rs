//! Every GPU adapter, in `f32` and, where it can, in `f64`: the cells of the scene as differences from references of their rows.

use super::task::{Task, faces, magnitudes};
use super::watch::watch;
use super::{Engine, Measurement, Report, Rung, Stages};
use crate::engine::gpu::{Gpu, Precision, adapters};
use crate::engine::{BasePoint, Engine as _, EngineError, Outcome, Question, on_gpu};
use crate::refine::{RowOfCells, references};
use crate::rod::Rod;
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

/// What the engines are asked for.
struct Sides {
    method: Method,
    all: Vec<Side>,
}

/// Its shot, and `(tau, load)`, of a state.
type Point = (usize, (f64, f64));

/// A whisker on one side.
struct Side {
    rods: [Rod; 1],
    pushes: Arc<[f64]>,
    references: Vec<BasePoint>,
    /// Of each cell of the references, its shot in the task, if it has one.
    shots: Vec<Option<usize>>,
}

impl Sides {
    fn of(scene: &Scene, task: &Task) -> Self {
        let method = Method::fine().with_effects(task.effects);
        let all = faces(scene).into_iter().zip(&task.rods).enumerate();
        let all = all.map(|(index, ((own, side), rod))| {
            let distances = scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / own.whisker.length_mm).collect();
            let sheet = Sheet::new(method, rod, side, &distances);
            let magnitudes = magnitudes(scene, side);
            let rows = (0..distances.len()).map(|row| RowOfCells {
                sheet: 0,
                row,
                pushes: &magnitudes,
                first: 0,
            });
            let rows: Vec<RowOfCells> = rows.collect();
            let by_row = references(method, &[&sheet], &rows);
            let pushes: Vec<f64> = magnitudes.iter().map(|push| side.sign() * push).collect();
            let shots = by_row.iter().enumerate().flat_map(|(row, references)| {
                let cells = references
                    .iter()
                    .flat_map(|reference| reference.cells.clone());
                let pole = |cell: u32| sheet.rows[row].pole(pushes[cell as usize]);
                cells
                    .map(|cell| task.shot(index as u32, pole(cell)))
                    .collect::<Vec<_>>()
            });
            Side {
                rods: [rod.clone()],
                shots: shots.collect(),
                references: by_row.into_iter().flatten().collect(),
                pushes: pushes.into(),
            }
        });
        Self {
            method,
            all: all.collect(),
        }
    }

    /// The states that `gpu` vouches for, and what its stages took.
    fn solve(&self, gpu: &mut Gpu) -> Result<(Vec<Point>, Stages), EngineError> {
        let (mut points, mut stages) = (Vec::new(), Stages::default());
        for side in &self.all {
            let begun = Instant::now();
            let question = Question::new(
                self.method.effects,
                gpu.resolution(self.method.resolution),
                side.rods.to_vec(),
                Arc::clone(&side.pushes),
                side.references.clone(),
            );
            let trajectories = begun.elapsed();
            let cells = gpu.solve(Arc::new(question))?;
            let times = gpu.take_times();
            let ms = |duration: Duration| 1e3 * duration.as_secs_f64();
            stages.upload += ms(trajectories + times.upload);
            stages.dispatch += ms(times.dispatch);
            stages.waiting += ms(times.waiting);
            stages.readback += ms(times.readback);
            let references = side.references.iter();
            let each = references.flat_map(|own| own.cells.clone().map(move |_| own));
            for ((cell, reference), shot) in cells.iter().zip(each).zip(&side.shots) {
                if let (Outcome::Solved, Some(shot)) = (cell.outcome, shot) {
                    points.push((*shot, cell.point(&side.rods[0], reference)));
                }
            }
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
    let mut gpu = Gpu::timed(one.adapter, one.precision)?;
    sides.solve(&mut gpu)?;
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
        let (points, of_run) = sides.solve(&mut gpu)?;
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
        let failure = format!("{}: no state beside a reference", engine.name);
        report.failures.push(failure);
        return Ok(());
    }
    report.engines.push(engine.clone());
    let errors = task.only(&shots).errors(&points);
    let row = Measurement::new(&engine, rung, seconds, stages, None, errors);
    report.rows.push(row);
    Ok(())
}

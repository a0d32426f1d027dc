//! Every GPU adapter, in `f32` and, where it can, in `f64`, alone and with Newton steps in `f64` after it.

use super::task::{Task, places};
use super::watch::watch;
use super::{Engine, Measurement, Report, Rung, Stages};
use crate::integrate::gpu::{Gpu, Precision, adapters};
use crate::integrate::{Engine as _, EngineError};
use crate::rod::arclength;
use crate::shooting::ShootingMap;
use crate::shooting::batch::{Batch, InitialCondition, Method, flops_of_rk4};
use std::time::Instant;

/// Most Newton steps in `f64` after the shader's.
const NEWTON: usize = 2;

/// Adds the rows of every adapter to `report`; one that fails is named with its reason.
pub fn measure(task: &Task, runs: usize, report: &mut Report, said: &mut dyn FnMut(&str)) {
    let all = adapters();
    for (index, adapter) in all.iter().enumerate() {
        for precision in [Precision::F32, Precision::F64] {
            if precision == Precision::F64 && !adapter.shader_f64 {
                let failure = format!("{}: no f64 in shaders", adapter.info.name);
                report.failures.push(failure);
                continue;
            }
            said(&format!("gpu {precision}, {}", adapter.info.name));
            let name = match all.len() {
                1 => format!("gpu {precision}"),
                _ => format!("gpu {index} {precision}"),
            };
            if let Err(error) = engine(task, runs, report, name, (index, precision)) {
                let failure = format!("{}, {precision}: {error}", adapter.info.name);
                report.failures.push(failure);
            }
        }
    }
}

fn engine(
    task: &Task,
    runs: usize,
    report: &mut Report,
    name: String,
    (index, precision): (usize, Precision),
) -> Result<(), EngineError> {
    let start = Instant::now();
    let mut gpu = Gpu::timed(index, precision)?;
    gpu.shoot(task.effects, &task.rods, &task.shots[..1])?;
    let first_result_s = start.elapsed().as_secs_f64();
    let engine = Engine {
        name,
        threads: None,
        adapter: gpu.describe().adapter,
        peak_gflops: 1e-9 * gpu.peak(runs)?,
        first_result_s,
    };
    report.engines.push(engine.clone());
    for newton_f64 in 0..=NEWTON {
        let mut stages = Vec::new();
        let (seconds, (hits, points)) = watch(runs, || {
            let hits = gpu.shoot(task.effects, &task.rods, &task.shots)?;
            let times = gpu.times().unwrap_or_default();
            let start = Instant::now();
            let mut points = places(&hits);
            for _ in 0..newton_f64 {
                newton(task, &mut points);
            }
            let ms = |duration: std::time::Duration| 1e3 * duration.as_secs_f64();
            stages.push(Stages {
                upload: ms(times.upload),
                dispatch: ms(times.dispatch),
                readback: ms(times.readback),
                refine: ms(start.elapsed()),
            });
            Ok::<_, EngineError>((hits, points))
        })?;
        // The first run warms up.
        let stages = Stages::medians(&stages[1..]);
        let steps = |condition: &InitialCondition| {
            let measured = Some(condition.rod).filter(|_| task.effects.profile);
            precision.steps(measured, condition.tau, condition.load)
        };
        let rung = Rung {
            integrator: "rk4",
            steps: precision.least_steps(),
            newton_f64,
        };
        let mut work = task.work(&hits, |condition| {
            flops_of_rk4(task.effects, steps(condition), condition)
        });
        // Only the shader's work counts against the shader's peak.
        let on_device = if stages.dispatch > 0.0 {
            1e-3 * stages.dispatch
        } else {
            seconds.median - 1e-3 * stages.refine
        };
        work.operations *= seconds.median / on_device;
        work.trajectories += (newton_f64 * points.len()) as f64;
        let errors = task.errors(&points);
        let row = Measurement::new(&engine, rung, seconds, stages, work, errors);
        report.rows.push(row);
    }
    Ok(())
}

/// A Newton step in `f64` for every state.
fn newton(task: &Task, points: &mut [(f64, f64)]) {
    let conditions = task.conditions(points);
    let shot =
        Batch::new(Method::fine().with_effects(task.effects)).shoot::<ShootingMap>(&conditions);
    for (((point, map), condition), shot) in points
        .iter_mut()
        .zip(shot)
        .zip(&conditions)
        .zip(&task.shots)
    {
        let s = arclength(condition.rod, condition.tau);
        let step = map.newton_step(shot.pole, s, condition.load);
        *point = (condition.tau + step.x, condition.load + step.y);
    }
}

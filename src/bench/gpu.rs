//! Every GPU adapter, in `f32` and, where it can, in `f64`, alone and with Newton steps in `f64` after it.

use super::cpu::{Work, operations, trajectories};
use super::task::Task;
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
                report
                    .failures
                    .push(format!("{}: no f64 in shaders", adapter.info.name));
                continue;
            }
            said(&format!("gpu {precision}, {}", adapter.info.name));
            let name = match all.len() {
                1 => format!("gpu {precision}"),
                _ => format!("gpu {index} {precision}"),
            };
            if let Err(error) = engine(task, runs, report, &name, index, precision) {
                let name = &adapter.info.name;
                report
                    .failures
                    .push(format!("{name}, {precision}: {error}"));
            }
        }
    }
}

fn engine(
    task: &Task,
    runs: usize,
    report: &mut Report,
    name: &str,
    index: usize,
    precision: Precision,
) -> Result<(), EngineError> {
    let start = Instant::now();
    let mut gpu = Gpu::timed(index, precision)?;
    gpu.shoot(
        task.effects,
        &task.rods,
        task.shots.get(..1).unwrap_or_default(),
    )?;
    let first_result_s = start.elapsed().as_secs_f64();
    let about = gpu.describe();
    let peak_gflops = 1e-9 * gpu.peak(runs)?;
    report.engines.push(Engine {
        name: name.to_owned(),
        threads: None,
        adapter: about.adapter,
        peak_gflops,
        first_result_s,
    });
    for newton_f64 in 0..=NEWTON {
        let mut stages = Vec::new();
        let (seconds, (hits, points)) = watch(runs, || {
            let hits = gpu.shoot(task.effects, &task.rods, &task.shots)?;
            let times = gpu.times().unwrap_or_default();
            let start = Instant::now();
            let mut points: Vec<(f64, f64)> = hits.iter().map(|hit| (hit.tau, hit.load)).collect();
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
        let work = operations(task, &hits, |condition| {
            flops_of_rk4(task.effects, steps(condition), condition)
        });
        // Only the shader's work counts against the shader's peak.
        let on_device = if stages.dispatch > 0.0 {
            1e-3 * stages.dispatch
        } else {
            seconds.median - 1e-3 * stages.refine
        };
        let mut row = Measurement::new(
            name,
            None,
            rung,
            seconds,
            stages,
            Work {
                trajectories: trajectories(&hits),
                operations: work * seconds.median / on_device,
                peak_gflops,
            },
            task.errors(&points),
        );
        row.trajectories_per_s += (newton_f64 * points.len()) as f64 / seconds.median;
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

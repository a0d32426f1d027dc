//! Measurements of whiskmap for `benches/peers/run.sh`: `cargo bench --bench peers -- --json FILE --ensemble FILE`.
//!
//! It measures trajectories with first derivatives by number of steps and threads, detachment points, and cells of a map. It writes the
//! ensemble of trajectories with its exact results for the peers. Times are of the fastest run, for whiskmap and for peers.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark that fails panics, and it prints its results"
)]

#[path = "../tests/support/random_rods.rs"]
mod random_rods;

use random_rods::Random;
use rayon::ThreadPool;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Instant;
use whiskmap::accuracy;
use whiskmap::map::{self, Stage};
use whiskmap::mechanics::numerics::Unit;
use whiskmap::mechanics::rod::{Effects, Rod, Side, arclength};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{Resolution, ShootingMap};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::trace::curve_at;

const TRAJECTORIES: usize = 20_000;
const RUNS: usize = 15;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| {
        let place = arguments.iter().position(|argument| argument == name);
        place.and_then(|place| arguments.get(place + 1))
    };
    let conditions = ensemble();
    let exact = shoot(Unit::detect(), Resolution::of(128), &conditions);
    if let Some(path) = value("--ensemble") {
        std::fs::write(path, table(&conditions, &exact)).unwrap();
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(2);
    let [one, two] = [1, threads].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap()
    });
    let results = json!({
        "machine": processor(),
        "unit": Unit::detect().to_string(),
        "threads": threads,
        "trajectories": trajectories(&one, &two, &conditions, &exact),
        "detachment": detachment(&one),
        "cell": cell(&one),
    });
    let text = serde_json::to_string_pretty(&results).unwrap();
    match value("--json") {
        Some(path) => std::fs::write(path, text).unwrap(),
        None => println!("{text}"),
    }
}

/// Model name of the processor, or its architecture.
fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name"));
    let name = model.and_then(|line| line.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// Random trajectories: taper up to 0.95, contacts from 0.05 to 0.999 of the length, `q` up to 9. The first half of the rods is
/// straight, the second half has `A*` of 0.4.
fn ensemble() -> Vec<InitialCondition<'static>> {
    let mut random = Random::new(1);
    (0..TRAJECTORIES)
        .map(|i| {
            let rod = Rod {
                taper: random.between(0.0, 0.95),
                bend: if i < TRAJECTORIES / 2 { 0.0 } else { 0.4 },
                ..Rod::default()
            };
            let s = random.between(0.05, 0.999);
            let load = random.between(0.0, 9.0) / (s * s);
            let tau = rod.tau(s);
            let rod = Box::leak(Box::new(rod));
            InitialCondition { rod, tau, load }
        })
        .collect()
}

/// Shooting maps of `conditions`; straight and curved rods are integrated separately, each with their own effects.
fn shoot(unit: Unit, resolution: Resolution, conditions: &[InitialCondition]) -> Vec<ShootingMap> {
    let scenes = conditions.chunk_by(|a, b| a.rod.bend == b.rod.bend);
    let shot = scenes.flat_map(|conditions| {
        let effects = Effects::of(conditions.iter().map(|condition| condition.rod));
        let method = Method::new(resolution).with_effects(effects);
        Batch::new(method).on(unit).shoot::<ShootingMap>(conditions)
    });
    shot.collect()
}

/// Position of the pole, then the derivatives of `(ln D, phi)` by the arclength of the contact at constant force, then those by the
/// force.
fn observables(condition: &InitialCondition, map: &ShootingMap) -> [f64; 6] {
    let InitialCondition { rod, tau, load } = condition;
    let rho = rod.radius(*tau);
    let by_f = map.by_load / (rho * rho);
    let by_s = (map.by_tau + 2.0 * rod.taper * load * rho * rho * by_f) / rho;
    let pole = map.pole;
    [pole.x, pole.y, by_s.x, by_s.y, by_f.x, by_f.y]
}

/// The ensemble with its exact observables as CSV.
fn table(conditions: &[InitialCondition], exact: &[ShootingMap]) -> String {
    let mut text =
        String::from("taper,bend,arclength,force,x,y,ln_d_by_s,phi_by_s,ln_d_by_f,phi_by_f\n");
    for (condition, map) in conditions.iter().zip(exact) {
        let InitialCondition { rod, tau, load } = condition;
        let rho = rod.radius(*tau);
        let (s, force) = (arclength(rod, *tau), load * rho * rho);
        let _ = write!(text, "{},{},{s},{force}", rod.taper, rod.bend);
        for number in observables(condition, map) {
            let _ = write!(text, ",{number}");
        }
        text.push('\n');
    }
    text
}

/// Largest difference of the observables, each relative to its own scale.
fn error(condition: &InitialCondition, found: &ShootingMap, exact: &ShootingMap) -> f64 {
    let rho = condition.rod.radius(condition.tau);
    let s = arclength(condition.rod, condition.tau);
    let by_force = rho * rho / (s * s);
    let sizes = [1.0 / s, 1.0 / s, s, s, by_force, by_force];
    let (found, exact) = (observables(condition, found), observables(condition, exact));
    (0..6).fold(0.0, |worst, i| f64::max(worst, sizes[i] * (found[i] - exact[i]).abs()))
}

/// Seconds of the fastest of [`RUNS`] runs of `work` in `pool`: other processes can only make a run slower.
fn seconds(pool: &ThreadPool, mut work: impl FnMut() + Send) -> f64 {
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        pool.install(&mut work);
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

fn trajectories(
    one: &ThreadPool,
    two: &ThreadPool,
    conditions: &[InitialCondition],
    exact: &[ShootingMap],
) -> Vec<Value> {
    let vectors = Unit::detect();
    let kernels = [("simd", vectors, one), ("simd", vectors, two), ("scalar", Unit::scalar(), one)];
    let mut rows = Vec::new();
    for (kernel, unit, pool) in kernels {
        for least in [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 24, 30] {
            let resolution = Resolution::of(least);
            let seconds = seconds(pool, || {
                std::hint::black_box(shoot(unit, resolution, conditions));
            });
            let found = shoot(unit, resolution, conditions);
            let mut errors: Vec<f64> = (0..conditions.len())
                .map(|i| error(&conditions[i], &found[i], &exact[i]))
                .collect();
            errors.sort_by(f64::total_cmp);
            rows.push(json!({
                "kernel": kernel,
                "threads": pool.current_num_threads(),
                "steps": least,
                "microseconds": 1e6 * seconds / conditions.len() as f64,
                "error_max": errors[errors.len() - 1],
                "error_99": errors[errors.len() * 99 / 100],
            }));
        }
    }
    rows
}

fn scene() -> Scene {
    let text = include_str!("../scenes/cone.toml");
    Scene::parse(text, "cone.toml").unwrap()
}

/// Detachment points of the cone by number of steps, at 1024 distances on each side.
fn detachment(pool: &ThreadPool) -> Vec<Value> {
    const POINTS: usize = 1024;
    let scene = scene();
    let distances: Vec<f64> =
        (0..POINTS).map(|i| 2.0 + 18.0 * i as f64 / (POINTS - 1) as f64).collect();
    let curves = |resolution| {
        Side::BOTH.map(|side| curve_at(resolution, &scene.whisker, &scene.pole, side, &distances))
    };
    let exact = curves(Resolution::of(128));
    let row = |resolution: Resolution| {
        let seconds = seconds(pool, || {
            std::hint::black_box(curves(resolution));
        });
        let found = curves(resolution);
        let pairs = found.iter().flatten().zip(exact.iter().flatten());
        let apart = pairs.filter_map(|(a, b)| Some((a.push_angle_deg? - b.push_angle_deg?).abs()));
        json!({
            "steps": resolution.least,
            "microseconds": 1e6 * seconds / (2 * POINTS) as f64,
            "error_max": apart.fold(0.0, f64::max).to_radians(),
            "points": 2 * POINTS,
        })
    };
    Resolution::LADDER.map(row).to_vec()
}

/// Cells of the cone's map and cells with a state, with the steps that a tolerance of 1e-9 radians selects.
fn cell(pool: &ThreadPool) -> Value {
    const TOLERANCE: f64 = 1e-9;
    let scene = scene();
    let steps = accuracy::cheapest(&scene, &Side::BOTH, TOLERANCE.to_degrees()).unwrap();
    let mut plan = Plan::new(&scene).unwrap();
    plan.method.resolution = steps.resolution;
    let mut summary = None;
    let seconds = seconds(pool, || {
        summary = Some(map::run_to_end(&scene, &plan, None, |_| ()));
    });
    let summary = summary.unwrap();
    json!({
        "microseconds": 1e6 * seconds / summary.cells() as f64,
        "microseconds_by_state": 1e6 * seconds / summary.refined as f64,
        "residual": summary.worst_residual,
        "estimate": steps.error_deg.to_radians(),
        "steps": steps.resolution.least,
        "cells": summary.cells(),
        "states": summary.refined,
        "stage_seconds": Stage::ALL.map(|(stage, name)| json!({name: summary.stage_seconds(stage)})),
    })
}

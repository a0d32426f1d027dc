//! Kernels that are spoilt.

use crate::compute::{Watched, compute, open_with};
use crate::{assert_identical, assert_same, cone, sound};
use whiskmap::integrate::Outcome;
use whiskmap::integrate::gpu::{Precision, shaders};
use whiskmap::map::Shots;
use whiskmap::rod::Effects;

/// The shader of the engine with the last line of its entry point replaced.
fn spoilt(precision: Precision, with: &str) -> String {
    let text = shaders::shoot(precision, Effects::default());
    let last = "hits[id.x] = solve(rods[shot.rod], shot);";
    assert_eq!(text.matches(last).count(), 1);
    let numbers = "let nan = real(bitcast<f32>(0x7fc00000u | (id.x >> 31u)));
        let infinite = real(bitcast<f32>(0x7f800000u | (id.x >> 31u)));";
    text.replace(last, &format!("{numbers}\n{with}"))
}

/// Claims of having converged on a number that is none, and trajectories that start from one.
const SPOILT: [&str; 2] = [
    "var hit = solve(rods[shot.rod], shot);
     if id.x % 7u == 0u { hit.tau = nan; }
     if id.x % 11u == 0u { hit.load = infinite; }
     hits[id.x] = hit;",
    "var start = shot;
     if id.x % 7u == 0u { start.tau = nan; }
     if id.x % 11u == 0u { start.load = infinite; }
     hits[id.x] = solve(rods[shot.rod], start);",
];

/// The part of the shots that a sound kernel finishes at least: of 128 x 128 cells at most 2 of 9,151 shots were restarted.
const FINISHED: f64 = 0.998;

/// 64 x 64 cells go out in a single dispatch, so that the shader's index is the index of the shot. Next to the tip and
/// the fold a few shots stall without any fault.
#[test]
fn numbers_that_are_none_are_restarted_in_f64_and_counted() {
    let scene = cone(64);
    let (_, cpu) = compute(&scene, None);
    for precision in [Precision::F32, Precision::F64] {
        let Some(gpu) = sound(precision) else {
            continue;
        };
        let mut gpu = Watched::new(gpu);
        let (summary, _) = compute(&scene, Some(&mut gpu));
        gpu.works(summary.shots.restarted, FINISHED).unwrap();
        assert!((1000..=4096).contains(&gpu.hits.len()));
        let spoilt_or_stalled = |(i, outcome): (usize, Outcome)| {
            i % 7 == 0 || i % 11 == 0 || outcome != Outcome::Converged
        };
        let outcomes = gpu.hits.iter().map(|hit| hit.outcome).enumerate();
        let wanted = Shots {
            all: gpu.hits.len() as u64,
            restarted: outcomes.filter(|&shot| spoilt_or_stalled(shot)).count() as u64,
            on_cpu_instead: 0,
        };
        for with in SPOILT {
            let mut gpu = open_with(precision, spoilt(precision, with)).unwrap();
            let (summary, panels) = compute(&scene, Some(&mut gpu));
            assert!(summary.engine_failure.is_none(), "{summary:?}");
            assert_eq!(summary.shots, wanted, "{with}");
            assert_same(&cpu, &panels);
        }
    }
}

#[test]
fn a_kernel_that_answers_nothing_but_nan_costs_time_only() {
    let scene = cone(64);
    let shader = spoilt(
        Precision::F32,
        "var hit = solve(rods[shot.rod], shot); hit.tau = nan; hits[id.x] = hit;",
    );
    let Some(mut gpu) = open_with(Precision::F32, shader) else {
        return;
    };
    let (summary, panels) = compute(&scene, Some(&mut gpu));
    assert!(summary.engine_failure.is_none(), "{summary:?}");
    assert_eq!(summary.shots.restarted, summary.shots.all);
    assert_same(&compute(&scene, None).1, &panels);
}

/// The map is right, so only what the engine did for it tells.
#[test]
fn a_kernel_that_does_nothing_is_noticed() {
    let scene = cone(64);
    let (_, cpu) = compute(&scene, None);
    for (does, restarted) in [
        ("", true),
        (
            "hits[id.x] = Hit(shot.tau, shot.load, 0.0, 1u, CONVERGED);",
            false,
        ),
    ] {
        let keeps_bindings = format!(
            "if shot.rod > 999u {{ hits[id.x] = solve(rods[shot.rod], shot); }} else {{ {does} }}"
        );
        let shader = spoilt(Precision::F32, &keeps_bindings);
        let Some(gpu) = open_with(Precision::F32, shader) else {
            return;
        };
        let mut gpu = Watched::new(gpu);
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        assert_same(&cpu, &panels);
        let shots = summary.shots;
        assert_eq!(shots.restarted, if restarted { shots.all } else { 0 });
        assert!(gpu.works(shots.restarted, FINISHED).is_err());
    }
}

#[test]
fn a_kernel_that_the_driver_refuses_leaves_all_to_the_cpu() {
    let scene = cone(64);
    if sound(Precision::F32).is_none() {
        return;
    }
    for (shader, why) in [("fn shoot() {", "expected"), ("fn other() {}", "shoot")] {
        let mut gpu = open_with(Precision::F32, shader.to_owned()).unwrap();
        let (summary, panels) = compute(&scene, Some(&mut gpu));
        let failure = summary.engine_failure.unwrap().to_string();
        assert!(failure.contains(why), "{failure}");
        assert_eq!(summary.shots.on_cpu_instead, summary.shots.all);
        assert_identical(&compute(&scene, None).1, &panels);
    }
}

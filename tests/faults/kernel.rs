//! Kernels that are spoilt.

use crate::compute::compute;
use crate::{assert_identical, assert_same, cone, open, sound};
use whiskmap::integrate::gpu::{Gpu, Precision, shaders};
use whiskmap::integrate::{Cpu, Description, Engine, EngineError, Hit, Outcome, Shot};
use whiskmap::rod::{Effects, Rod};
use whiskmap::store::Shots;

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

/// An engine whose outcomes are written down.
struct Recorded(Gpu, Vec<Outcome>);

impl Engine for Recorded {
    fn describe(&self) -> Description {
        self.0.describe()
    }

    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        let hits = self.0.shoot(effects, rods, shots)?;
        self.1.extend(hits.iter().map(|hit| hit.outcome));
        Ok(hits)
    }
}

/// 64 x 64 cells go out in a single dispatch, so that the shader's index is the index of the shot. Next to the tip and
/// the fold a few shots stall without any fault.
#[test]
fn numbers_that_are_none_are_restarted_in_f64_and_counted() {
    let scene = cone(64);
    let (_, cpu) = compute(&scene, &mut Cpu);
    for precision in [Precision::F32, Precision::F64] {
        let Some(gpu) = open(precision, shaders::shoot(precision, Effects::default())) else {
            continue;
        };
        let mut sound = Recorded(gpu, Vec::new());
        let all = compute(&scene, &mut sound).0.shots.all;
        assert!((1000..=4096).contains(&all) && all == sound.1.len() as u64);
        let restarted =
            sound.1.iter().enumerate().filter(|&(i, outcome)| {
                i % 7 == 0 || i % 11 == 0 || *outcome != Outcome::Converged
            });
        let wanted = Shots {
            all,
            restarted: restarted.count() as u64,
            on_cpu_instead: 0,
        };
        for with in SPOILT {
            let mut gpu = open(precision, spoilt(precision, with)).unwrap();
            let (summary, panels) = compute(&scene, &mut gpu);
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
    let Some(mut gpu) = open(Precision::F32, shader) else {
        return;
    };
    let (summary, panels) = compute(&scene, &mut gpu);
    assert!(summary.engine_failure.is_none(), "{summary:?}");
    assert_eq!(summary.shots.restarted, summary.shots.all);
    assert_same(&compute(&scene, &mut Cpu).1, &panels);
}

#[test]
fn a_kernel_that_the_driver_refuses_leaves_all_to_the_cpu() {
    let scene = cone(64);
    if sound().is_none() {
        return;
    }
    for (shader, why) in [("fn shoot() {", "expected"), ("fn other() {}", "shoot")] {
        let mut gpu = open(Precision::F32, shader.to_owned()).unwrap();
        let (summary, panels) = compute(&scene, &mut gpu);
        let failure = summary.engine_failure.unwrap().to_string();
        assert!(failure.contains(why), "{failure}");
        assert_eq!(summary.shots.on_cpu_instead, summary.shots.all);
        assert_identical(&compute(&scene, &mut Cpu).1, &panels);
    }
}

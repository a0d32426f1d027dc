//! Cost of each set of effects: `cargo bench --bench effects -- [trajectories]`.
//!
//! For each set: the time per trajectory with first derivatives on one CPU thread, at the resolution of maps. Times are medians of seven
//! interleaved runs.
#![allow(clippy::print_stdout, reason = "the program prints a table")]
#![allow(clippy::expect_used, reason = "a benchmark that cannot start panics")]

use std::time::Instant;
use whiskmap::mechanics::rod::Effects;
use whiskmap::mechanics::shooting::ShootingMap;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};

#[path = "../tests/support/effect_sets.rs"]
mod effect_sets;
#[path = "../tests/support/random_rods.rs"]
mod random_rods;

use random_rods::{Random, condition, rod};

const RUNS: usize = 7;

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(20_000);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build_global().expect("the global pool is not built yet");

    let sets: Vec<(Effects, Vec<InitialCondition<'static>>)> = effect_sets::all()
        .map(|effects| {
            let mut random = Random::new(31);
            let conditions = (0..count).map(|_| {
                let rod = Box::leak(Box::new(rod(effects, &mut random)));
                condition(rod, 6.5, &mut random)
            });
            (effects, conditions.collect())
        })
        .collect();
    let mut times = vec![Vec::new(); sets.len()];
    for _ in 0..RUNS {
        for ((effects, conditions), times) in sets.iter().zip(&mut times) {
            times.push(microseconds(*effects, conditions));
        }
    }
    let medians: Vec<f64> = times
        .iter_mut()
        .map(|times| {
            times.sort_by(f64::total_cmp);
            times[RUNS / 2]
        })
        .collect();
    println!("us/trajectory  ratio  spread  effects");
    for (i, (effects, _)) in sets.iter().enumerate() {
        println!(
            "{:13.3}  {:5.2}  {:5.0} %  {}",
            medians[i],
            medians[i] / medians[0],
            100.0 * (times[i][RUNS - 1] / times[i][0] - 1.0),
            name(*effects),
        );
    }
}

fn microseconds(effects: Effects, conditions: &[InitialCondition]) -> f64 {
    let method = Method::fine().with_effects(effects);
    let start = Instant::now();
    let maps = Batch::new(method).shoot::<ShootingMap>(conditions);
    let micros = start.elapsed().as_secs_f64() * 1e6;
    assert!(maps.iter().all(|map| map.pole.is_finite()));
    micros / conditions.len() as f64
}

fn name(effects: Effects) -> String {
    let names = [
        (effects.taper && !effects.profile, "taper"),
        (effects.profile, "profile"),
        (effects.curvature, "parabola"),
        (effects.spiral, "euler spiral"),
        (effects.polynomial, "traced shape"),
        (effects.gradient, "modulus gradient"),
    ];
    let on: Vec<&str> = names.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
    if on.is_empty() { "none: a straight cylinder".to_owned() } else { on.join(", ") }
}
